"""A gridshell on the canvas: rods that bend, and anchors with targets that bring their ends together."""

from hookean.commands.examples import defaults, figure
from hookean_canvas.definitions import parts
from hookean_canvas.definitions.write import Definition, flat

GIVEN = defaults(figure("bending_gridshell").scene)

RODS = """
import math

import Rhino

point = Rhino.Geometry.Point3d
count = 4 * (int(rods) + 1)
step = length / count


def up(i):
    return math.sin(math.pi * i / count)


def at(i, j):
    return point(step * i - 0.5 * length, step * j - 0.5 * length, bump * length * up(i) * up(j))


lines = [[at(i, 4 * k) for i in range(count + 1)] for k in range(1, int(rods) + 1)]
lines += [[at(4 * k, j) for j in range(count + 1)] for k in range(1, int(rods) + 1)]
lines.append([point(step * i - 0.5 * length, -0.5 * length - 2.0, bump * length * up(i)) for i in range(count + 1)])
pieces = [Rhino.Geometry.Line(p, q) for x in lines for p, q in zip(x, x[1:])]
corners = [x[i : i + 3] for x in lines for i in range(count - 1)]
corner_1, corner_2, corner_3 = [[corner[k] for corner in corners] for k in range(3)]
ends = [p for x in lines for p in (x[0], x[-1])]
single = lines[-1][count // 2]
stiffness = axial / step


def moved(part):
    found = []
    for x in lines:
        a, b = x[0], x[-1]
        half = 0.5 * part
        for p, q in ((a, b), (b, a)):
            found.append(point(p.X + half * (q.X - p.X), p.Y + half * (q.Y - p.Y), 0))
    return found


targets, less, more = moved(shortened), moved(shortened - 0.001), moved(shortened + 0.001)
"""
NUMBERS = """
import math

count = 4 * (int(rods) + 1)
step = length / count
places = [[line.From for line in lines[k : k + count]] + [lines[k + count - 1].To] for k in range(0, len(lines), count)]
rise = max(p.Z for p in places[-1])
held = [v for path in reactions.Paths for v in reactions.Branch(path)]
thrusts = []
for number, rod in enumerate(places):
    # the slope of the energy of the first piece and the first corner, along the rod
    a, b, c, last = [(p.X, p.Y, p.Z) for p in (rod[0], rod[1], rod[2], rod[-1])]
    near, far, chord = math.dist(a, b), math.dist(b, c), math.dist(a, last)
    u, v = [(q - p) / near for p, q in zip(a, b)], [(q - p) / far for p, q in zip(b, c)]
    along = [(q - p) / chord for p, q in zip(a, last)]
    cosine = sum(p * q for p, q in zip(u, v))
    sine = math.sqrt(sum((q - cosine * p) ** 2 for p, q in zip(u, v)))
    size = 0.5 * sum(line.From.DistanceTo(line.To) for line in drawn[count * number : count * number + 2])
    slope = bending / size * math.atan2(sine, cosine) / sine / near
    pull = stiffness * (near - step)
    thrusts.append(sum(d * (slope * (q - cosine * p) - pull * p) for d, p, q in zip(along, u, v)))
thrust = thrusts[-1]


def integrals(m):
    # complete elliptic integrals K and E by means of Gauss
    a, b, total, power = 1.0, math.sqrt(1.0 - m), 0.5 * m, 0.5
    while abs(a - b) > 1e-15:
        a, b, c = 0.5 * (a + b), math.sqrt(a * b), 0.5 * (a - b)
        power *= 2.0
        total += power * c * c
    k = 0.5 * math.pi / a
    return k, k * (1.0 - total)


low, high = 1e-9, 0.9
for _ in range(100):
    m = 0.5 * (low + high)
    k, e = integrals(m)
    low, high = (m, high) if 2.0 * e / k - 1.0 > 1.0 - shortened else (low, m)
over_rise = rise / (math.sqrt(m) * length / k)
over_thrust = thrust / (4.0 * k * k * bending / length**2)
work = (energy_more - energy_less) / (0.002 * length) / sum(thrusts)
balance = sum(v.Z for v in held)
net = [p for rod in places[:-1] for p in rod]
turned = max(min(math.dist((-p.Y, p.X, p.Z), (q.X, q.Y, q.Z)) for q in net) for p in net)
"""
NAMES = {
    "rise": "rod: rise",
    "thrust": "rod: thrust",
    "over_rise": "rod: rise over that of the elastica",
    "over_thrust": "rod: thrust over that of the elastica",
    "work": "rods: energy by movement, over their thrusts",
    "balance": "net: reactions upwards, sum",
    "turned": "net: difference after a quarter turn, largest",
}


def definition() -> Definition:
    d = Definition(
        "bending_gridshell",
        "A gridshell of bent rods",
        "Flat rods rise while anchors with targets bring their ends together. Two more engines, with ends a little "
        "further apart and closer, give the energy by movement. Set Reset to False and change Shortened.",
    )
    with d.group("Rods"):
        given = {
            "rods": d.slider("Rods each way [-]", GIVEN["rods"], 1, 12),
            "length": d.slider("Length [m]", GIVEN["length"], 5, 30, decimals=1),
            "shortened": d.slider("Shortened [-]", GIVEN["shortened"], 0.01, 0.4, decimals=2),
        }
        bending = d.slider("EI [N m2]", GIVEN["bending"], 10, 10000)
        names = ["pieces", "corner_1", "corner_2", "corner_3", "ends", "single", "step", "stiffness", "targets", "less",
                 "more"]  # fmt: skip
        made = d.script(
            "Rods", RODS,
            {**given, "axial": d.slider("EA [N]", GIVEN["axial"], 10000, 10000000),
             "bump": d.slider("Bump [-]", GIVEN["bump"], 0, 0.1, decimals=3)},
            names,
        )  # fmt: skip
    with d.group("Forces"):
        springs = d.component(
            "Springs", connection=made["pieces"], stiffness=made["stiffness"], rest_length=made["step"]
        )
        bend = d.component(
            "Bend", point_1=made["corner_1"], point_2=made["corner_2"], point_3=made["corner_3"], stiffness=bending,
            rest_angle=d.text("Rest angle [rad]", "0"),
        )  # fmt: skip
    with d.group("Anchors"):
        hold = {"x": d.toggle("X", False), "z": d.toggle("Z", False)}
        single = d.component("Anchors", "Single rod", point=made["single"], **hold)
        anchors = [
            d.component("Anchors", f"Ends: {name}", point=made["ends"], targets=made[name])
            for name in ("targets", "less", "more")
        ]
    with d.group("Engines"):
        settings = parts.solving(d, "relaxation", "1e-9")
        common = {"settings": settings, "geometry": made["pieces"], "reset": d.toggle("Reset", True)}
        engine, less, more = (
            d.component("Engine", forces=flat(springs, bend), anchors=flat(ends, single), **common) for ends in anchors
        )
        d.panel("report", engine["report"])
    with d.group("Numbers", "What expected.json holds it to."):
        found = {
            "lines": engine["geometry"], "drawn": made["pieces"], "reactions": engine["reactions"], "bending": bending,
            "stiffness": made["stiffness"], "energy_less": less["energy"], "energy_more": more["energy"],
        }  # fmt: skip
        d.numbers(NUMBERS, {**found, **given}, NAMES, lists=["lines", "drawn"], trees=["reactions"])
    return d
