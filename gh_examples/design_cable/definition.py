"""The cable of a given sag on the canvas: move the slider, and the lengths of its links follow."""

from hookean.commands.examples import defaults, figure
from hookean_canvas.definitions.write import Definition, flat

GIVEN = defaults(figure("design_cable").scene)

DRAWN = """
import Rhino

count = int(links)
joints = []
for i in range(count + 1):
    t = i / count
    joints.append(Rhino.Geometry.Point3d(span * t, 0, -4 * sag * t * (1 - t)))
lines = [Rhino.Geometry.Line(joints[i], joints[i + 1]) for i in range(count)]
inner, ends = joints[1:-1], [joints[0], joints[-1]]
steps = [p.X for p in inner]
middle = [joints[count // 2]]
depth = -sag
slack = 1.03 * span / count
"""
NUMBERS = """
count = len(particles) - 1
span = particles[-1].X - particles[0].X
lengths, pulls = list(values.Branch(0)), list(forces.Branch(0))
sag = -min(p.Z for p in particles)
thrust = abs(reactions[0].X)
off = max(abs(p.X - span * i / count) for i, p in enumerate(particles))
parabola = max(abs(p.Z + 4 * 1.5 * (p.X / span) * (1 - p.X / span)) for p in particles)
first, middle = lengths[0], lengths[9]
greatest = max(pulls)
"""
NAMES = {
    "sag": "sag", "thrust": "horizontal thrust", "off": "joints off equal steps, most",
    "parabola": "joints off the parabola, most", "first": "rest length of the first link",
    "middle": "rest length of a link in the middle", "greatest": "greatest force",
}  # fmt: skip


def definition() -> Definition:
    d = Definition(
        "design_cable",
        "A cable of a given sag",
        "Design finds the length of each link, so that the joints hang in equal steps and the middle one at the sag.",
    )
    with d.group("Drawn", "Joints on a parabola."):
        given = {
            "span": d.slider("Span [m]", GIVEN["span"], 2, 40), "sag": d.slider("Sag [m]", GIVEN["sag"], 0.5, 4, 2),
            "links": d.slider("Links [-]", GIVEN["links"], 4, 40),
        }  # fmt: skip
        outputs = ["lines", "inner", "ends", "steps", "middle", "depth", "slack"]
        drawn = d.script("Cable", DRAWN, given, outputs)
    with d.group("Forces"):
        springs = d.component(
            "Springs", "Cable", connection=drawn["lines"], stiffness=d.text("Stiffness [kN/m]", "1e4"),
            rest_length=drawn["slack"],
        )  # fmt: skip
        weight = d.native("Unit Z", factor=d.slider("Load [kN]", -GIVEN["load"], -10, 0, 1))
        load = d.component("Unary", "Load", point=drawn["inner"], force=weight)
        unit = d.component("Settings", force_unit=d.text("Force", "kN"))
    with d.group("Problem", "Lengths vary; steps and sag are the goals."):
        varied = d.component(
            "Variables", force=springs, field=d.text("Field", "rest_length"), lower=d.slider("Lower [m]", 0, 0, 1)
        )
        position = d.text("Kind", "position")
        steps = d.component(
            "Goals", "Steps", kind=position, points=drawn["inner"], axes=d.text("Along", "x"), target=drawn["steps"]
        )
        sag = d.component(
            "Goals", "Sag", kind=position, points=drawn["middle"], axes=d.text("Down", "z"), target=drawn["depth"]
        )
    with d.group("Design"):
        found = d.component(
            "Design", forces=flat(springs, load), anchors=drawn["ends"], settings=unit, geometry=drawn["lines"],
            variables=varied, goals=flat(steps, sag),
        )  # fmt: skip
    with d.group("Numbers", "What expected.json holds it to."):
        given = {name: found[name] for name in ("particles", "values", "forces", "reactions")}
        d.numbers(NUMBERS, given, NAMES, lists=["particles", "reactions"], trees=["values", "forces"])
    return d
