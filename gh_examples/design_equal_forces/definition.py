"""The net of equal forces on the canvas: one goal for all lines."""

from hookean.commands.examples import defaults, figure
from hookean_canvas.definitions.write import Definition, flat

GIVEN = defaults(figure("design_equal_forces").scene)

DRAWN = """
import math

import Rhino

count, places, pairs = int(rings), {}, set()
for q in range(-count, count + 1):
    for r in range(-count, count + 1):
        if abs(q + r) > count:
            continue
        corners = []
        for k in range(6):
            angle = math.pi / 6 + k * math.pi / 3
            x = math.sqrt(3.0) * (q + r / 2) + math.cos(angle)
            y = 1.5 * r + math.sin(angle)
            corners.append(places.setdefault((round(x, 6), round(y, 6)), len(places)))
        for a, b in zip(corners, corners[1:] + corners[:1]):
            pairs.add((min(a, b), max(a, b)))
points = [Rhino.Geometry.Point3d(x, y, 0) for x, y in places]
near = {i: [b if a == i else a for a, b in pairs if i in (a, b)] for i in range(len(points))}
lines = [Rhino.Geometry.Line(points[a], points[b]) for a, b in sorted(pairs)]
inner, rim = list(points), []
for i, others in near.items():
    if len(others) == 2:
        x = 2 * points[i].X - sum(points[j].X for j in others)
        y = 2 * points[i].Y - sum(points[j].Y for j in others)
        size = math.hypot(x, y)
        x, y = points[i].X + x / size, points[i].Y + y / size
        swell = 1 + wave * math.cos(3 * math.atan2(y, x))
        end = Rhino.Geometry.Point3d(1.15 * swell * x, 0.95 * swell * y, 0)
        rim.append(end)
        lines.append(Rhino.Geometry.Line(points[i], end))
"""
NUMBERS = """
import math

pulls = list(forces.Branch(0))
before = list(start.Branch(0))
ratio = max(before) / min(before)
least, greatest = min(pulls), max(pulls)
ends = [v for v in reactions if abs(v.X) + abs(v.Y) > 1e-6]
pull = max(math.hypot(v.X, v.Y) for v in ends)
ways = {}
shortest = 1e9
for line in lines:
    a, b = line.From, line.To
    shortest = min(shortest, line.Length)
    for one, other in ((a, b), (b, a)):
        key = (round(one.X, 5), round(one.Y, 5))
        ways.setdefault(key, []).append(math.atan2(other.Y - one.Y, other.X - one.X))
off = 0.0
for angles in ways.values():
    if len(angles) == 3:
        angles.sort()
        turns = [angles[1] - angles[0], angles[2] - angles[1], angles[0] - angles[2] + 2 * math.pi]
        off = max([off] + [abs(math.degrees(turn) - 120) for turn in turns])
"""
NAMES = {
    "ratio": "equal densities: greatest force / least", "least": "least force", "greatest": "greatest force",
    "pull": "pull at an outer end", "off": "angle between two lines off 120 degrees, most",
    "shortest": "shortest line",
}  # fmt: skip


def definition() -> Definition:
    d = Definition(
        "design_equal_forces",
        "A net of equal forces",
        "Design finds the force density of each line with which all have the same force: three lines meet at 120 "
        "degrees.",
    )
    with d.group("Drawn", "A honeycomb, its outer ends in an oval."):
        given = {
            "rings": d.slider("Rings [-]", GIVEN["rings"], 1, 4),
            "wave": d.slider("Wave [-]", GIVEN["wave"], 0, 0.2, 2),
        }
        drawn = d.script("Honeycomb", DRAWN, given, ["lines", "inner", "rim"])
    with d.group("Forces"):
        net = d.component(
            "Springs", "Net", connection=drawn["lines"], stiffness=d.slider("Density [kN/m]", GIVEN["density"], 1, 20),
            rest_factor=d.slider("Rest factor [-]", 0, 0, 1),
        )  # fmt: skip
        unit = d.component("Settings", force_unit=d.text("Force", "kN"), solver=d.text("Solver", "newton"))
        no = d.toggle("Free in plan", False)
        plane = d.component("Anchors", "Plane", point=drawn["inner"], x=no, y=no)
        held = flat(drawn["rim"], plane)
    with d.group("Problem"):
        varied = d.component(
            "Variables", force=net, field=d.text("Field", "stiffness"), lower=d.slider("Lower [kN/m]", 0.05, 0, 1, 2)
        )
        goal = d.component(
            "Goals", "Equal", kind=d.text("Kind", "force"), forces=net, target=d.slider("Force [kN]", 10, 1, 50)
        )
    with d.group("Start and design", "The net with equal densities, and with equal forces."):
        start = d.component("Engine", "Start", forces=net, anchors=held, settings=unit, reset=d.toggle("Reset", True))
        found = d.component(
            "Design", forces=net, anchors=held, settings=unit, geometry=drawn["lines"], variables=varied, goals=goal
        )
    with d.group("Numbers", "What expected.json holds it to."):
        given = {
            "forces": found["forces"], "reactions": found["reactions"], "lines": found["geometry"],
            "start": start["forces"],
        }  # fmt: skip
        d.numbers(NUMBERS, given, NAMES, lists=["reactions", "lines"], trees=["forces", "start"])
    return d
