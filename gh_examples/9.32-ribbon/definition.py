"""Figure 9.32 on the canvas: a membrane stretched over two free-form beams and eleven arcs."""

from hookean.commands.examples import defaults, figure
from hookean_canvas.definitions.write import Definition, flat

GIVEN = defaults(figure("9.32-ribbon").scene)

FINE = """
import Rhino

polyline = Rhino.Geometry.Polyline()
for p in points:
    polyline.Add(p.X, p.Y, p.Z)
"""
WHERE = """
import System
from Grasshopper import DataTree
from Grasshopper.Kernel.Data import GH_Path


def tree(rows):
    made = DataTree[System.Object]()
    for i, row in enumerate(rows):
        for p in row:
            made.Add(p, GH_Path(i))
    return made


rows = [vertices[i : i + v + 1] for i in range(0, len(vertices), v + 1)]
arcs = rows[:: u // bays]
beams = tree([[row[0] for row in rows], [row[-1] for row in rows]])
inner = tree(arcs[1:-1])
ends = list(arcs[0]) + list(arcs[-1])
"""
NUMBERS = """
import math


def grid(mesh):
    points = [mesh.Vertices.Point3dAt(i) for i in range(len(mesh.Vertices))]
    rows = [points[i : i + v + 1] for i in range(0, len(points), v + 1)]
    return [[(p.X, p.Y, p.Z) for p in row] for row in rows]


def minus(a, b):
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def size(a):
    return math.sqrt(dot(a, a))


def triangle(a, b, c):
    p, q = minus(b, a), minus(c, a)
    return 0.5 * size((p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]))


def area(rows):  # a quad is the mean of its two cuts
    total = 0.0
    for near, far in zip(rows, rows[1:]):
        for a, d, b, c in zip(near, near[1:], far, far[1:]):
            total += triangle(a, b, c) + triangle(a, c, d) + triangle(a, b, d) + triangle(b, c, d)
    return 0.5 * total


def saddles(rows):  # part of the particles between the arcs whose four angles exceed 360 degrees [%]
    inside = [(i, j) for i in range(1, u) if i % (u // bays) for j in range(1, v)]
    found = 0
    for i, j in inside:
        around = [rows[i + 1][j], rows[i][j + 1], rows[i - 1][j], rows[i][j - 1]]
        arms = [minus(p, rows[i][j]) for p in around]
        pairs = zip(arms, arms[1:] + arms[:1])
        found += sum(math.acos(dot(p, q) / size(p) / size(q)) for p, q in pairs) > 2.0 * math.pi
    return 100.0 * found / len(inside)


start, end = grid(drawn), grid(membrane)
across, along = list(forces.Branch(0)), list(forces.Branch(1))
pulls = list(forces.Branch(2)) + list(forces.Branch(3))
moved = [[size(minus(p, q)) for p, q in zip(*rows)] for rows in zip(start, end)]
area_drawn = area(start)
area_now = area(end)
least_across = min(across)
most_across = max(across)
least_along = min(along)
most_along = max(along)
slack = sum(force <= 0.0 for force in across + along)
off = 1000.0 * max(size((f.X, f.Y, f.Z)) for f in pulls) / strength
farthest = max(max(row) for row in moved)
slid = max(max(row[0], row[-1]) for row in moved)
saddles_now = saddles(end)
saddles_drawn = saddles(start)
"""


def definition() -> Definition:
    d = Definition(
        "9.32-ribbon",
        "Figure 9.32: the concert hall ribbon",
        "A membrane of 60 x 20 quads whose edges slide along two beams, and which slides along nine arcs between those "
        "at its ends. No load: prestress alone makes a saddle of every bay.",
    )
    with d.group("Drawn in Rhino", "Layers of model.3dm beside this file."):
        file = d.text("File", "model.3dm")
        u, v = d.slider("U [-]", GIVEN["along"], 10, 120), d.slider("V [-]", GIVEN["across"], 2, 40)
        bays = d.slider("Bays [-]", 10, 1, 20)
        mesh = d.component("RhinoFile", file=file, layer=d.text("Surface", "membrane"), u=u, v=v)["meshes"]
        beams = d.component("RhinoFile", file=file, layer=d.text("Beams", "beams"))["curves"]
        arcs = d.component("RhinoFile", file=file, layer=d.text("Arcs between the ends", "arcs::inner"))["curves"]
        vertices = d.component("MeshVertices", mesh=mesh)
    with d.group("Curves", "As fine polylines, a branch for each; and the vertices that lie on them."):
        pieces = d.slider("Pieces [-]", 2000, 100, 5000)
        fine = [
            d.script("Polyline", FINE, {"points": d.component("Divide", curve=curves, count=pieces)}, ["polyline"],
                     lists=["points"])
            for curves in (beams, arcs)
        ]  # fmt: skip
        inputs = {"vertices": vertices, "u": u, "v": v, "bays": bays}
        where = d.script("On curves", WHERE, inputs, ["beams", "inner", "ends"], lists=["vertices"])
    with d.group("Forces"):
        stiffness = d.slider("Stiffness [kN/m]", GIVEN["stiffness"], 0.1, 20, decimals=1)
        factor = d.slider("Rest factor [-]", GIVEN["rest_factor"], 0, 1, decimals=2)
        springs = [
            d.component(
                "Springs", name, connection=mesh, edges=d.text(name, edges), stiffness=stiffness, rest_factor=factor
            )
            for name, edges in (("Across", "weft"), ("Along", "warp"))
        ]
        strength = d.slider("Strength [kN/m]", GIVEN["strength"], 100, 5000)
        pulls = [
            d.component("PullToCurve", f"To {name}", curve=curve, point=where[output], strength=strength)
            for name, curve, output in (("beams", fine[0], "beams"), ("arcs", fine[1], "inner"))
        ]
    with d.group("Engine"):
        settings = d.component(
            "Settings", solver=d.text("Solver", "relaxation"), residual=d.text("Residual [-]", "1e-9"),
            force_unit=d.text("Force", "kN"), fast=d.toggle("Fast", True),
        )  # fmt: skip
        engine = d.component(
            "Engine", forces=flat(*springs, *pulls), anchors=flat(where["ends"]), settings=settings, geometry=mesh,
            reset=d.toggle("Reset", True),
        )  # fmt: skip
    with d.group("Numbers", "What expected.json holds the figure to."):
        d.panel("report", engine["report"])
        given = {"drawn": mesh, "membrane": engine["geometry"], "forces": engine["forces"]}
        d.numbers(
            NUMBERS,
            {**given, "u": u, "v": v, "bays": bays, "strength": strength},
            {
                "area_drawn": "area of the surface drawn", "area_now": "area",
                "least_across": "smallest force across", "most_across": "largest force across",
                "least_along": "smallest force along", "most_along": "largest force along", "slack": "slack springs",
                "off": "farthest from its beam or arc", "farthest": "farthest from where it was drawn",
                "slid": "farthest slid along a beam", "saddles_now": "saddle-shaped between the arcs",
                "saddles_drawn": "saddle-shaped as drawn",
            },
            trees=["forces"],
        )  # fmt: skip
    return d
