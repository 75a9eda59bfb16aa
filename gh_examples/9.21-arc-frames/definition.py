"""Figure 9.21 on the canvas: an arc of 20 m comes down to the catenary, seen at five moments and at rest."""

from hookean.commands.examples import defaults, figure
from hookean_canvas.definitions import parts
from hookean_canvas.definitions.write import Definition, flat

GIVEN = defaults(figure("9.21-arc-frames").scene)

MOTION = """
rows = [list(particles.Branch(path)) for path in particles.Paths]
heights = [row[len(row) // 2].Z for row in rows]
nearest = [min(range(len(times)), key=lambda i: abs(times[i] - t)) for t in (4, 8, 12, 16, 20)]
after_4, after_8, after_12, after_16, after_20 = [heights[i] for i in nearest]
"""
NUMBERS = """
height = particles[len(particles) // 2].Z
length = sum(a.DistanceTo(b) for a, b in zip(particles, particles[1:]))
"""


def definition() -> Definition:
    d = Definition(
        "9.21-arc-frames",
        "Figure 9.21: an arc comes down to the catenary",
        "An arc of 20 m over a chord of 10 m, 50 springs, 1 N on every particle of 1 kg. Moments shows the positions "
        "that the arc passes through; the engine shows it on its way, and at rest.",
    )
    with d.group("Drawn in Rhino", "The arc in model.3dm beside this file."):
        drawn = d.component("RhinoFile", file=d.text("File", "model.3dm"), layer=d.text("Layer", "arc"))
        arc = drawn["curves"]
        count = d.slider("Springs [-]", GIVEN["pieces"], 2, 100)
        pieces = d.component("Shatter", curve=arc, count=count)
        points = d.component("Divide", curve=arc, count=count)
        ends = d.native("End Points", curve=arc)
    with d.group("Forces"):
        springs = d.component(
            "Springs", connection=pieces["lines"],
            stiffness=d.slider("Stiffness [N/m]", GIVEN["stiffness"], 100, 10000),
            rest_factor=d.slider("Rest factor [-]", GIVEN["rest_factor"], 0.9, 1.1, decimals=3),
        )  # fmt: skip
        load = d.component("Unary", point=points, force=parts.down(d, GIVEN, 10))
    given = {"forces": flat(springs, load), "anchors": flat(ends["Start"], ends["End"]), "geometry": pieces["lines"]}
    with d.group("Motion", "In physical time: the step [s], and the drag [N s/m] on every particle."):
        drag = d.slider("Drag [N s/m]", GIVEN["drag"], 0, 10, decimals=1)
        settings = d.component("Settings", time_step=d.text("Time step [s]", str(GIVEN["time_step"])), drag=drag)
        times = d.native(
            "Series",
            start=0,
            step=d.slider("Every [s]", 2, 0.5, 4, decimals=1),
            count=d.slider("Moments [-]", 11, 1, 30),
        )
        moments = d.component("Moments", settings=settings, times=times, **given)
    with d.group("Equilibrium"):
        settings = parts.solving(d, "newton", "1e-12")
        engine = d.component("Engine", settings=settings, reset=d.toggle("Reset", True), **given)
    with d.group("Numbers", "What expected.json holds the figure to."):
        d.panel("report", engine["report"])
        names = {f"after_{t}": f"height of the middle after {t} s" for t in (4, 8, 12, 16, 20)}
        inputs = {"particles": moments["particles"], "times": moments["times"]}
        d.numbers(MOTION, inputs, names, lists=["times"], trees=["particles"])
        names = {"height": "equilibrium: height of the middle", "length": "equilibrium: length"}
        d.numbers(NUMBERS, {"particles": engine["particles"]}, names, lists=["particles"])
    return d
