"""Figures 9.14 and 9.15 on the canvas: y = a cosh(x / a) from the Catenary component, and a chain that hangs on it."""

from hookean_canvas.definitions.write import Definition, flat

LENGTH_OF = """
# The length between x = -X and x = X of the catenary of parameter a, and its ends.
import math

from Rhino.Geometry import Point3d

length = 2 * a * math.sinh(x / a)
start = Point3d(-x, 0, a * math.cosh(x / a))
end = Point3d(x, 0, a * math.cosh(x / a))
"""
LEGS = """
# A chain lifted to two straight legs: joints inside and at the ends, links, rest length, weight on each joint.
from Rhino.Geometry import Line, Point3d, Vector3d

half = (end.X - start.X) / 2
rise = ((length / 2) ** 2 - half**2) ** 0.5
joints = []
for i in range(count + 1):
    t = 2.0 * i / count - 1
    joints.append(Point3d(start.X + half * (1 + t), 0, start.Z - rise * (1 - abs(t))))
links = [Line(p, q) for p, q in zip(joints, joints[1:])]
inside = joints[1:-1]
ends = [joints[0], joints[-1]]
rest = length / count
weight = Vector3d(0, 0, -length / count)
half_weight = Vector3d(0, 0, -length / count / 2)
"""
NUMBERS = """
def catenary(points, length):
    # a, and the height of the directrix: y^2 - s^2 is linear in y and s, the arc length, for three points of it
    n = len(points) - 1
    z = [p.Z - points[0].Z for p in points]
    rows = [(2 * z[i], -2 * i * length / n, z[i] ** 2 - (i * length / n) ** 2) for i in (0, n // 2, n)]
    (p, q, r), (t, u, v) = [[x - y for x, y in zip(row, rows[0])] for row in rows[1:]]
    c = (r * u - q * v) / (p * u - q * t)
    s0 = (p * v - r * t) / (p * u - q * t)
    return (c * c - s0**2) ** 0.5, c, z


_, c, z = catenary(curve, curve_length)
at_0 = min(z) - c
at_3 = z[-1] - c
a, c, z = catenary(drawn, length)
sag = -min(z)
tension = max(z[0], z[-1]) - c
chain = [links[0].From] + [line.To for line in links]
chain_sag = chain[0].Z - min(p.Z for p in chain)
reaction = max((v.X**2 + v.Y**2 + v.Z**2) ** 0.5 for v in reactions.Branch(0))
off = max(p.DistanceTo(q) for p, q in zip(chain, drawn))
"""


def definition() -> Definition:
    d = Definition(
        "9.14-catenary-graph",
        "Figure 9.14: the graph of the catenary",
        "A cable that does not stretch hangs along y = a cosh(x / a). One is drawn for a = 2; a chain of 12 m and "
        "1 N/m between two points 10 m apart, let go from two straight legs, comes down on the curve with a = 4.695 m.",
    )
    with d.group("Curve of a parameter"):
        wanted = d.script(
            "Length", LENGTH_OF,
            {"a": d.slider("a [m]", 2, 0.5, 10, decimals=1), "x": d.slider("x [m]", 3, 0.5, 6, decimals=1)},
            ["length", "start", "end"],
        )  # fmt: skip
        curve = d.component(
            "Catenary",
            start=wanted["start"],
            end=wanted["end"],
            length=wanted["length"],
            count=d.slider("Pieces [-]", 60, 2, 200),
        )
    with d.group("Chain"):
        height = d.text("Height [m]", "7.61885321")
        start, end = d.point(-5, 0, height), d.point(5, 0, height)
        length = d.slider("Length [m]", 12, 10.5, 20, decimals=1)
        count = d.slider("Links [-]", 120, 2, 200)
        drawn = d.component("Catenary", start=start, end=end, length=length, count=count)
        legs = d.script(
            "Legs", LEGS, {"start": start, "end": end, "length": length, "count": count},
            ["links", "inside", "ends", "rest", "weight", "half_weight"],
        )  # fmt: skip
    with d.group("Engine"):
        springs = d.component(
            "Springs", connection=legs["links"], stiffness=d.text("Stiffness [N/m]", "1e7"), rest_length=legs["rest"]
        )
        load = d.component("Unary", point=legs["inside"], force=legs["weight"])
        at_ends = d.component("Unary", point=legs["ends"], force=legs["half_weight"])
        settings = d.component(
            "Settings", residual=d.text("Residual [-]", "1e-9"), solver=d.text("Solver", "relaxation"),
            fast=d.toggle("Fast", True),
        )  # fmt: skip
        engine = d.component(
            "Engine", forces=flat(springs, load, at_ends), anchors=legs["ends"], settings=settings,
            geometry=legs["links"], reset=d.toggle("Reset", True),
        )  # fmt: skip
    with d.group("Numbers", "What expected.json holds the figure to."):
        d.panel("report", engine["report"])
        d.numbers(
            NUMBERS,
            {"curve": curve["points"], "curve_length": wanted["length"], "drawn": drawn["points"], "length": length,
             "links": engine["geometry"], "reactions": engine["reactions"]},
            {
                "at_0": "a = 2: y at x = 0", "at_3": "a = 2: y at x = 3", "a": "span 10, length 12: a",
                "sag": "span 10, length 12: sag", "tension": "span 10, length 12: largest tension",
                "chain_sag": "chain: sag", "reaction": "chain: largest reaction", "off": "chain: off the catenary",
            },
            lists=["curve", "drawn", "links"], trees=["reactions"],
        )  # fmt: skip
    return d
