"""Figure 9.10 on the canvas: a cable of four springs, and a smooth curve through its particles, for display only."""

from hookean.commands.examples import defaults, figure
from hookean_canvas.definitions import parts
from hookean_canvas.definitions.write import Definition

GIVEN = defaults(figure("9.10-smooth-curve").scene)

NUMBERS = """
import math


def apart(p, a, b):
    # distance of a point from a straight line between two others
    d = [b.X - a.X, b.Y - a.Y, b.Z - a.Z]
    e = [p.X - a.X, p.Y - a.Y, p.Z - a.Z]
    t = sum(x * y for x, y in zip(d, e)) / sum(x * x for x in d)
    t = min(1.0, max(0.0, t))
    return math.sqrt(sum((y - t * x) ** 2 for x, y in zip(d, e)))


def furthest(points, corners):
    return max(min(apart(p, a, b) for a, b in zip(corners, corners[1:])) for p in points)


def length(points):
    return sum(a.DistanceTo(b) for a, b in zip(points, points[1:]))


cable = particles
smooth = [curve.Point(i) for i in range(curve.PointCount)]
off_particles = furthest(cable, smooth)
off_cable = furthest(smooth, cable)
length_cable = length(cable)
length_curve = length(smooth)
u, v = [[b.X - a.X, b.Y - a.Y, b.Z - a.Z] for a, b in zip(cable[1:3], cable[2:4])]
cross = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
turn = math.degrees(math.atan2(math.sqrt(sum(x * x for x in cross)), sum(x * y for x, y in zip(u, v))))
"""


def definition() -> Definition:
    d = Definition(
        "9.10-smooth-curve",
        "Figure 9.10: a smooth curve through the particles",
        "A cable of four springs under 40 N on every particle, and a curve interpolated through them. The curve is for "
        "display only: between the particles it is 18 cm away from the springs, and it does not turn at B as they do.",
    )
    line = parts.line(d, GIVEN["pieces"], least=4)
    forces, _ = parts.hung(d, line, GIVEN)
    engine = parts.at_rest(d, forces, line, [line.ends["Start"], line.ends["End"]])
    with d.group("Curve", "To look at; nothing pulls on it."):
        curve = d.component("Interpolate", points=engine["particles"], count=d.slider("Pieces [-]", 4000, 10, 4000))
    with d.group("Numbers", "What expected.json holds the figure to."):
        d.panel("report", engine["report"])
        d.numbers(
            NUMBERS, {"particles": engine["particles"], "curve": curve},
            {
                "off_particles": "largest distance of a particle from the curve",
                "off_cable": "largest distance of the curve from the cable", "length_cable": "length of the cable",
                "length_curve": "length of the curve", "turn": "turn of the cable at B",
            },
            lists=["particles"],
        )  # fmt: skip
    return d
