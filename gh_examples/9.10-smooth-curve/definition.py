"""Figure 9.10 on the canvas: a cable of four springs, and a smooth curve through its particles, for display only."""

from hookean_canvas.definitions.write import Definition, flat

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
    with d.group("Line"):
        end = d.point(d.slider("Span [m]", 10, 1, 20, decimals=1), 0, 0)
        line = d.native("Line", start_point=d.point(0, 0, 0), end_point=end)
        ends = d.native("End Points", curve=line)
        count = d.slider("Springs [-]", 4, 4, 50)
        pieces = d.component("Shatter", curve=line, count=count)
        points = d.component("Divide", curve=line, count=count)
    with d.group("Forces"):
        springs = d.component(
            "Springs", connection=pieces["lines"], stiffness=d.slider("Stiffness [N/m]", 200, 10, 5000)
        )
        down = d.native("Unit Z", factor=d.slider("Load [N]", -40, -100, 0, decimals=1))
        load = d.component("Unary", point=points, force=down)
    with d.group("Engine"):
        settings = d.component("Settings", residual=d.text("Residual [-]", "1e-12"), fast=d.toggle("Fast", True))
        engine = d.component(
            "Engine", forces=flat(springs, load), anchors=[ends["Start"], ends["End"]], settings=settings,
            geometry=pieces["lines"], reset=d.toggle("Reset", True),
        )  # fmt: skip
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
