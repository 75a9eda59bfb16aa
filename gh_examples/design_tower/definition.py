"""The tower of least load path on the canvas: move its height, and the feet follow."""

from hookean.commands.examples import defaults, figure
from hookean_canvas.definitions.write import Definition, flat

GIVEN = defaults(figure("design_tower").scene)

DRAWN = """
import Rhino

feet = [Rhino.Geometry.Point3d(-base, 0, 0), Rhino.Geometry.Point3d(base, 0, 0)]
top = [Rhino.Geometry.Point3d(0, 0, height)]
legs = [Rhino.Geometry.Line(foot, top[0]) for foot in feet]
tensions = [pull, -pull]
load = Rhino.Geometry.Vector3d(pull, 0, 0)
left, right = feet
"""
NUMBERS = """
import math

path = list(goals.Branch(0))[0]
left, right = particles[0].X, particles[2].X
found = [list(values.Branch(i)) for i in range(values.BranchCount)]
force_left, force_right = [row for row in found if len(row) == 2][0]
hold = math.hypot(reactions[1].X, reactions[1].Z)
"""
NAMES = {
    "path": "load path", "left": "left foot", "right": "right foot", "force_left": "force in the left leg",
    "force_right": "force in the right leg", "hold": "hold that the top needs",
}  # fmt: skip


def definition() -> Definition:
    d = Definition(
        "design_tower",
        "A tower of least load path",
        "All joints are held; where the top needs no hold, the legs balance the pull. Design finds feet and forces of "
        "the least sum of |force| x length.",
    )
    with d.group("Drawn"):
        given = {
            "height": d.slider("Height [m]", GIVEN["height"], 2, 40),
            "pull": d.slider("Pull [kN]", GIVEN["pull"], 1, 99),
            "base": d.slider("Base [m]", GIVEN["base"], 1, 30),
        }
        outputs = ["legs", "feet", "top", "left", "right", "tensions", "load"]
        drawn = d.script("Tower", DRAWN, given, outputs)
    with d.group("Forces"):
        legs = d.component("ConstantTension", "Legs", connection=drawn["legs"], tension=drawn["tensions"])
        load = d.component("Unary", "Pull", point=drawn["top"], force=drawn["load"])
        unit = d.component("Settings", force_unit=d.text("Force", "kN"))
    with d.group("Problem", "Forces and feet vary; the load path is least, and the top needs no hold."):
        most, least = d.slider("Most [kN]", 1000, 0, 1000), d.slider("Least [kN]", -1000, -1000, 0)
        forces = d.component(
            "Variables", "Forces", force=legs, field=d.text("Field", "tension"), lower=least, upper=most
        )
        x = d.text("X", "x")
        left = d.component(
            "Variables", "Left foot", anchors=drawn["left"], axes=x, lower=d.slider("Left from [m]", -100, -100, 0),
            upper=d.slider("Left to [m]", -0.5, -10, 0, 1),
        )  # fmt: skip
        right = d.component(
            "Variables", "Right foot", anchors=drawn["right"], axes=x, lower=d.slider("Right from [m]", 0.5, 0, 10, 1),
            upper=d.slider("Right to [m]", 100, 0, 100),
        )  # fmt: skip
        goal = d.component("Goals", "Load path", kind=d.text("Goal", "load_path"), forces=legs)
        zero = d.slider("Hold [kN]", 0, 0, 10)
        held = d.component(
            "Constraints", "No hold", kind=d.text("Constraint", "reaction"), anchors=drawn["top"],
            axes=d.text("Plane", "xz"), lower=zero, upper=zero,
        )  # fmt: skip
    with d.group("Design"):
        found = d.component(
            "Design", forces=flat(legs, load), anchors=flat(drawn["feet"], drawn["top"]), settings=unit,
            geometry=drawn["legs"], variables=flat(forces, left, right), goals=goal, constraints=held,
        )  # fmt: skip
    with d.group("Numbers", "What expected.json holds it to."):
        given = {name: found[name] for name in ("particles", "values", "goals", "reactions")}
        d.numbers(NUMBERS, given, NAMES, lists=["particles", "reactions"], trees=["values", "goals"])
    return d
