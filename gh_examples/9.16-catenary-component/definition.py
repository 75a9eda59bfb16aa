"""Figure 9.16 on the canvas: catenaries from A, B, L and G, and chains of 60 links that hang on them."""

from hookean_canvas.definitions.write import Definition, flat, graft

LEGS = """
# A chain lifted against gravity to two straight legs: its points, links, rest length and the weight on each joint.
from Rhino.Geometry import Line, Point3d, Vector3d

a, b, g = [[p.X, p.Y, p.Z] for p in (start, end, gravity)]
size = sum(x * x for x in g) ** 0.5
g = [x / size for x in g]


def apex(h):
    return [(x + y) / 2 + h * z for x, y, z in zip(a, b, g)]


def apart(p, q):
    return sum((x - y) ** 2 for x, y in zip(p, q)) ** 0.5


low, high = 0.0, length
for _ in range(200):
    h = (low + high) / 2
    low, high = (low, h) if apart(a, apex(h)) + apart(b, apex(h)) > length else (h, high)
top = apex(low)
first = apart(a, top)
points = []
for i in range(count + 1):
    s = i * length / count
    p, q, t = (a, top, s / first) if s < first else (top, b, (s - first) / (length - first))
    points.append(Point3d(*[x + t * (y - x) for x, y in zip(p, q)]))
links = [Line(p, q) for p, q in zip(points, points[1:])]
rest = [length / count]
weight = [Vector3d(*[x * length / count for x in g])]
"""
REFUSED = '''
"""How many of three lengths below the distance of A and B the catenary refuses."""

from hookean_client import Problem, canvas_ask

A, B, G = [[p.X, p.Y, p.Z] for p in (start, end, gravity)]
least = sum((x - y) ** 2 for x, y in zip(A, B)) ** 0.5


def work(client):
    count = 0
    for part in (0.5, 0.9, 0.999999):
        body = {"lines": [[A, B]], "length": [part * least], "gravity": [G], "count": 10}
        try:
            client.post("/v1/discretize/catenary", body)
        except Problem as problem:
            if not 400 <= problem.status < 500:
                raise
            count += 1
    return count


refused = canvas_ask.ask(ghenv, "refused", repr((A, B, G)), work)
'''
CATENARY = """
# The catenary y = c + sqrt(a^2 + (s - s0)^2) through three of its points at equal arc lengths s: y^2 - s^2 is linear in
# y and s, with the unknowns c (its directrix), s0 and K = a^2 + s0^2 - c^2. Heights y are over A, against gravity.
size = (gravity.X**2 + gravity.Y**2 + gravity.Z**2) ** 0.5
heights = [
    -((p.X - drawn[0].X) * gravity.X + (p.Y - drawn[0].Y) * gravity.Y + (p.Z - drawn[0].Z) * gravity.Z) / size
    for p in drawn
]
n = len(drawn) - 1
rows = [(2 * heights[i], -2 * i * length / n, heights[i] ** 2 - (i * length / n) ** 2) for i in (0, n // 2, n)]
(p, q, r), (t, u, v) = [[x - y for x, y in zip(row, rows[0])] for row in rows[1:]]
c = (r * u - q * v) / (p * u - q * t)
s0 = (p * v - r * t) / (p * u - q * t)
a = ((heights[0] - c) ** 2 - s0**2) ** 0.5
depth = -c - a
tension = max(heights[0], heights[-1]) - c
joints = [links[0].From] + [line.To for line in links]
off = max(x.DistanceTo(y) for x, y in zip(joints, drawn))
"""
CASES = ("rising", "level", "nearly taut", "very slack", "gravity aslant", "gravity sideways")
ENDS = [(8.0, 0.0, 4.0), (10.0, 0.0, 0.0), (10.0, 0.0, 0.0), (3.0, 0.0, 1.0), (9.0, 0.0, 0.0), (0.0, 0.0, -8.0)]
LENGTHS = [12.0, 12.0, 60 * 0.168333333333, 18.0, 12.0, 12.0]  # the third of links rounded to 12 digits
GRAVITIES = [(0.0, 0.0, -1.0)] * 4 + [(0.6, 0.0, -0.8), (1.0, 0.0, 0.0)]
WHAT = {
    "a": "a", "depth": "depth below A", "tension": "largest tension", "off": "chain off the catenary",
}  # fmt: skip


def definition() -> Definition:
    d = Definition(
        "9.16-catenary-component",
        "Figure 9.16: the catenary from its ends",
        "Catenaries from the start A, the end B, the length L and the direction of gravity G, and chains of 60 links, "
        "let go from two straight legs, that land on them: " + ", ".join(CASES) + ".",
    )
    with d.group("Cables", "Six cables: A is one point, B, L and G are lists."):
        start = d.parameter("Point", "A", [(0.0, 0.0, 0.0)])
        end = d.parameter("Point", "B", ENDS)
        length = d.parameter("Number", "L [m]", LENGTHS)
        gravity = d.parameter("Vector", "G", GRAVITIES)
        count = d.slider("Links [-]", 60, 2, 100)
    with d.group("Catenary"):
        drawn = d.component("Catenary", start=start, end=end, length=length, gravity=gravity, count=count)
        refused = d.script("Refused", REFUSED, {"start": start, "end": end, "gravity": gravity}, ["refused"])
    with d.group("Chains"):
        legs = d.script(
            "Legs", LEGS, {"start": start, "end": end, "length": length, "gravity": gravity, "count": count},
            ["points", "links", "rest", "weight"],
        )  # fmt: skip
        springs = d.component(
            "Springs", connection=legs["links"], stiffness=d.text("Stiffness [N/m]", "1e7"), rest_length=legs["rest"]
        )
        load = d.component("Unary", point=legs["points"], force=legs["weight"])
        settings = d.component(
            "Settings",
            residual=d.text("Residual [-]", "1e-9"),
            solver=d.text("Solver", "relaxation"),
            fast=d.toggle("Fast", True),
        )
        engine = d.component(
            "Engine", forces=[springs, load], anchors=[start, end], settings=settings, geometry=legs["links"],
            reset=d.toggle("Reset", True),
        )  # fmt: skip
    with d.group("Numbers", "What expected.json holds the figure to."):
        d.panel("report", engine["report"])
        d.panel("status", engine["status"])
        found = d.script(
            "Catenary", CATENARY,
            {"drawn": drawn["points"], "links": engine["geometry"], "length": graft(length), "gravity": graft(gravity)},
            list(WHAT), lists=["drawn", "links"],
        )  # fmt: skip
        names = {f"{what}_{i}": f"{case}: {said}" for i, case in enumerate(CASES) for what, said in WHAT.items()}
        code = [f"{what}_{i} = {what}[{i}]" for i in range(len(CASES)) for what in WHAT]
        ready = f"if min(map(len, ({', '.join(WHAT)}))) == {len(CASES)}:\n    " + "\n    ".join(code)
        last = "\nlengths_refused = refused[-1]"
        d.numbers(
            ready + last, {**{what: flat(found[what]) for what in WHAT}, "refused": refused},
            {**names, "lengths_refused": "lengths refused"}, lists=[*WHAT, "refused"],
        )  # fmt: skip
    return d
