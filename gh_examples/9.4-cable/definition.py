"""Figures 9.4 and 9.5 on the canvas: a line cut into springs, loads on its points, its ends held."""

from hookean_canvas.definitions.write import Definition, flat

NUMBERS = """
lengths = [a.DistanceTo(b) for a, b in zip(particles, particles[1:])]
middle = len(lengths) // 2 - 1
springs = len(lengths)
length = sum(lengths)
first = lengths[0]
inner = lengths[middle]
longer = first - inner
force = forces.Branch(0)[0]
sag = -min(p.Z for p in particles)
lift = reactions.Branch(0)[0].Z
"""


def definition() -> Definition:
    d = Definition(
        "9.4-cable",
        "Figure 9.4: a cable under its loads",
        "A line of 10 m in ten springs, 10 N down on every particle, held at its ends. "
        "Reset True reads what is drawn, False lets it move. Pull the sliders while it runs.",
    )
    with d.group("Line"):
        end = d.point(d.slider("Span [m]", 10, 1, 20, decimals=1), 0, 0)
        line = d.native("Line", start_point=d.point(0, 0, 0), end_point=end)
        ends = d.native("End Points", curve=line)
        count = d.slider("Springs [-]", 10, 1, 50)
        pieces = d.component("Shatter", curve=line, count=count)
        points = d.component("Divide", curve=line, count=count)
    with d.group("Forces"):
        springs = d.component(
            "Springs", connection=pieces["lines"], stiffness=d.slider("Stiffness [N/m]", 1000, 10, 5000)
        )
        down = d.native("Unit Z", factor=d.slider("Load [N]", -10, -100, 0, decimals=1))
        load = d.component("Unary", point=points, force=down)
    with d.group("Engine"):
        settings = d.component("Settings", residual=d.text("Residual [-]", "1e-12"), fast=d.toggle("Fast", True))
        engine = d.component(
            "Engine", forces=flat(springs, load), anchors=flat(ends["Start"], ends["End"]), settings=settings,
            geometry=pieces["lines"], reset=d.toggle("Reset", True),
        )  # fmt: skip
    with d.group("Numbers", "What expected.json holds the figure to."):
        d.panel("report", engine["report"])
        d.numbers(
            NUMBERS,
            {"particles": engine["particles"], "forces": engine["forces"], "reactions": engine["reactions"]},
            {
                "springs": "springs", "length": "length", "first": "length of the first spring",
                "inner": "length of a middle spring", "longer": "first spring longer than a middle one",
                "force": "force in the first spring", "sag": "sag", "lift": "lift of an anchor",
            },
            lists=["particles"], trees=["forces", "reactions"],
        )  # fmt: skip
    return d
