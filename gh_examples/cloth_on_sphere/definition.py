"""A cloth on a ball on the canvas: springs, bending along threads, and a sphere that vertices collide with."""

from hookean.commands.examples import defaults, figure
from hookean_canvas.definitions.write import Definition, flat

GIVEN = defaults(figure("cloth_on_sphere").scene)

CLOTH = """
import Rhino

count = int(divisions)
wide, size = count + 1, side / count
point = Rhino.Geometry.Point3d
x = [[point(size * i - 0.5 * side, size * j - 0.5 * side, radius + 0.001) for j in range(wide)] for i in range(wide)]
mesh = Rhino.Geometry.Mesh()
for row in x:
    for p in row:
        mesh.Vertices.Add(p.X, p.Y, p.Z)
for i in range(count):
    for j in range(count):
        first = wide * i + j
        mesh.Faces.AddFace(first, first + wide, first + wide + 1, first + 1)
line = Rhino.Geometry.Line
turned = [[x[j][i] for j in range(wide)] for i in range(wide)]
threads = [line(p, q) for rows in (x, turned) for row in rows for p, q in zip(row, row[1:])]
diagonals = [line(x[i][j], x[i + 1][j + 1]) for i in range(count) for j in range(count)]
diagonals += [line(x[i + 1][j], x[i][j + 1]) for i in range(count) for j in range(count)]
corners = [row[i : i + 3] for rows in (x, turned) for row in rows for i in range(count - 1)]
corner_1, corner_2, corner_3 = [[corner[k] for corner in corners] for k in range(3)]
vertices = [p for row in x for p in row]
half = [0.5 if i in (0, count) else 1.0 for i in range(wide)]
loads = [Rhino.Geometry.Vector3d(0, 0, -weight * size**2 * one * other) for one in half for other in half]
centre, top = point(0, 0, 0), x[count // 2][count // 2]
spheres = vertices + [centre]
radii = [0.001] * len(vertices) + [radius]
groups = [1] * len(vertices) + [0]
"""
NUMBERS = """
import math

wide = int(divisions) + 1
x = [(p.X, p.Y, p.Z) for p in (mesh.Vertices.Point3dAt(i) for i in range(wide * wide))]
high = radius + 0.001
corner, edge = high - x[0][2], high - x[wide // 2][2]
across = math.dist(x[0], x[-1])
out = [math.sqrt(sum(c * c for c in p)) for p in x]
pushes = [[contact * max(high - d, 0.0) * c / d for c in p] for p, d in zip(x, out)]
deepest = high - min(out)
up = sum(push[2] for push in pushes) / (weight * side**2)
sideways = max(abs(sum(push[k] for push in pushes)) for k in (0, 1))
held = [v for path in reactions.Paths for v in reactions.Branch(path)][-1]
holder = math.hypot(held.X, held.Y)
turned = 0.0
for i in range(wide):
    for j in range(wide):
        p, q = x[wide * i + j], x[wide * (wide - 1 - j) + i]
        turned = max(turned, math.dist((-p[1], p[0], p[2]), q))
total = energy
"""
NAMES = {
    "corner": "depth of a corner under the top",
    "edge": "depth of the middle of an edge under the top",
    "across": "width of the cloth, corner to corner",
    "total": "energy of weight, threads, bending and contact",
    "deepest": "deepest vertex, below the surface of the ball",
    "up": "contact forces upwards, over the weight",
    "sideways": "contact forces sideways, largest sum",
    "holder": "force on the holder of the top",
    "turned": "difference after a quarter turn, largest",
}


def definition() -> Definition:
    d = Definition(
        "cloth_on_sphere",
        "A cloth on a ball",
        "A square cloth falls over a ball. Collide keeps its vertices out of a large sphere; one collision group lets "
        "them ignore each other. Set Reset to False and change weight, threads and ball.",
    )
    with d.group("Cloth"):
        given = {
            "divisions": d.slider("Squares a side, even [-]", GIVEN["divisions"], 4, 40),
            "side": d.slider("Side [m]", GIVEN["side"], 1, 4, decimals=1),
            "radius": d.slider("Radius of the ball [m]", GIVEN["radius"], 0.2, 1.5, decimals=2),
            "weight": d.slider("Weight [N/m2]", GIVEN["weight"], 0.5, 20, decimals=1),
        }
        cloth = d.script(
            "Cloth", CLOTH, given,
            ["mesh", "threads", "diagonals", "corner_1", "corner_2", "corner_3", "vertices", "loads", "centre", "top",
             "spheres", "radii", "groups"],
        )  # fmt: skip
    with d.group("Forces"):
        threads = d.component(
            "Springs", "Threads", connection=cloth["threads"],
            stiffness=d.slider("Threads [N/m]", GIVEN["stiffness"], 100, 10000),
        )  # fmt: skip
        shear = d.component(
            "Springs", "Diagonals", connection=cloth["diagonals"],
            stiffness=d.slider("Diagonals [N/m]", GIVEN["shear"], 1, 1000),
        )  # fmt: skip
        bend = d.component(
            "Bend", point_1=cloth["corner_1"], point_2=cloth["corner_2"], point_3=cloth["corner_3"],
            stiffness=d.slider("Bending [N m2]", GIVEN["bending"], 0, 0.1, decimals=3),
        )  # fmt: skip
        load = d.component("Unary", point=cloth["vertices"], force=cloth["loads"])
        contact = d.slider("Contact [N/m]", GIVEN["contact"], 100, 20000)
        ball = d.component(
            "Collide", point=cloth["spheres"], radius=cloth["radii"], strength=contact, collision_group=cloth["groups"]
        )
    with d.group("Anchors"):
        centre = d.component("Anchors", "Ball", point=cloth["centre"])
        top = d.component("Anchors", "Top", point=cloth["top"], z=d.toggle("Z", False))
    with d.group("Engine"):
        settings = d.component(
            "Settings", solver=d.text("Solver", "relaxation"), residual=d.text("Residual [-]", "1e-6"),
            fast=d.toggle("Fast", True), all_particles=d.toggle("All points are particles", True),
        )  # fmt: skip
        engine = d.component(
            "Engine", forces=flat(threads, shear, bend, load, ball), anchors=flat(centre, top), settings=settings,
            geometry=cloth["mesh"], reset=d.toggle("Reset", True),
        )  # fmt: skip
        d.panel("report", engine["report"])
    with d.group("Numbers", "What expected.json holds it to."):
        made = {"mesh": engine["geometry"], "reactions": engine["reactions"], "energy": engine["energy"]}
        d.numbers(NUMBERS, {**made, "contact": contact, **given}, NAMES, trees=["reactions"])
    return d
