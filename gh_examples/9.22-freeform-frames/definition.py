"""Figure 9.22 on the canvas: chains between two free-form frames, and the catenaries drawn from their ends."""

from hookean.commands.examples import defaults, figure
from hookean_canvas.definitions import parts
from hookean_canvas.definitions.write import Definition, flat

GIVEN = defaults(figure("9.22-freeform-frames").scene)

LENGTHS = """
lengths = [factor * a.DistanceTo(b) for a, b in zip(starts, ends)]
"""
NUMBERS = """
links = count + 1
rows = [particles[i : i + links] for i in range(0, len(particles), links)]
lengths = [sum(a.DistanceTo(b) for a, b in zip(row, row[1:])) for row in rows]
chains = len(rows)
parts = [list(frames.Branch(path)) for path in frames.Paths]
firsts = [(row[0], part) for row, part in zip(rows, parts[0])]
lasts = [(row[-1], part) for row, part in zip(rows, parts[1])]
off = max(a.DistanceTo(b) for a, b in firsts + lasts)
total = sum(lengths)
shortest = min(lengths)
longest = max(lengths)
sag = max(row[0].Z + (row[-1].Z - row[0].Z) * i / count - row[i].Z for row in rows for i in range(links))
largest = max(forces.Branch(0))
drawn = [list(catenaries.Branch(path)) for path in catenaries.Paths]
apart = max(a.DistanceTo(b) for row, curve in zip(rows, drawn) for a, b in zip(row, curve))
"""


def definition() -> Definition:
    d = Definition(
        "9.22-freeform-frames",
        "Figure 9.22: chains between two free-form frames",
        "A chain between each pair of points on two frames, 1.2 times as long as they are apart. Beside the relaxed "
        "chains stand the catenaries drawn from the same ends and lengths alone.",
    )
    with d.group("Drawn in Rhino", "Layers of model.3dm beside this file."):
        file = d.text("File", "model.3dm")
        chains = d.component("RhinoFile", file=file, layer=d.text("Chains", "chains"))["curves"]
        frames = d.component("RhinoFile", file=file, layer=d.text("Frames", "frames"))["curves"]
        ends = d.native("End Points", curve=chains)
        count = d.slider("Links of a chain [-]", GIVEN["links"], 2, 60)
        pieces = d.component("Shatter", curve=chains, count=count)
        points = d.component("Divide", curve=chains, count=count)
    with d.group("Forces"):
        factor = d.slider("Length of a chain [-]", GIVEN["length_factor"], 1, 2, decimals=2)
        springs = d.component(
            "Springs", connection=flat(pieces["lines"]), stiffness=d.text("Stiffness [N/m]", "1e6"), rest_factor=factor
        )
        load = d.component("Unary", point=flat(points), force=parts.down(d, GIVEN, 10))
    with d.group("Engine"):
        engine = parts.engine(
            d, "newton", "1e-9", forces=flat(springs, load), anchors=flat(ends["Start"], ends["End"]), geometry=chains
        )
    with d.group("Catenaries", "By their formula, from ends and lengths."):
        given = {"starts": ends["Start"], "ends": ends["End"], "factor": factor}
        lengths = d.script("Lengths", LENGTHS, given, ["lengths"], lists=["starts", "ends"])
        drawn = d.component("Catenary", start=ends["Start"], end=ends["End"], length=lengths, count=count)
        number = d.native("List Length", list=chains)
        equal = d.component("Divide", "Equal parts", curve=frames, count=number)
    with d.group("Numbers", "What expected.json holds the figure to."):
        d.panel("report", engine["report"])
        d.numbers(
            NUMBERS,
            {"particles": engine["particles"], "forces": engine["forces"], "count": count, "frames": equal,
             "catenaries": drawn["points"]},
            {
                "chains": "chains", "off": "ends off equal parts of the frames", "total": "total length",
                "shortest": "shortest chain", "longest": "longest chain", "sag": "largest sag",
                "largest": "largest force", "apart": "chains off the catenaries",
            },
            lists=["particles"], trees=["forces", "frames", "catenaries"],
        )  # fmt: skip
    return d
