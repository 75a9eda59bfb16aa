"""The gridshell of flat glass and laths in stock on the canvas: move the lengths in stock, and the nodes follow."""

from hookean.commands.examples import defaults, figure
from hookean_canvas.definitions.write import Definition, flat

GIVEN = defaults(figure("design_gridshell").scene)

DRAWN = """
import Rhino

count = int(along)
mesh = Rhino.Geometry.Mesh()
nodes = []
for i in range(count + 1):
    for j in range(count + 1):
        x, y = 2 * i / count - 1, 2 * j / count - 1
        z = rise * (1 - 0.6 * x * x) * (1 - 0.5 * y * y) + twist * x * y * y
        nodes.append(Rhino.Geometry.Point3d(x * size / 2, y * size / 2, z))
        mesh.Vertices.Add(nodes[-1].X, nodes[-1].Y, z)
wide = count + 1
lines = []
for i in range(wide):
    for j in range(count):
        lines.append(Rhino.Geometry.Line(nodes[wide * i + j], nodes[wide * i + j + 1]))
        lines.append(Rhino.Geometry.Line(nodes[wide * j + i], nodes[wide * (j + 1) + i]))
for i in range(count):
    for j in range(count):
        first = wide * i + j
        mesh.Faces.AddFace(first, first + wide, first + wide + 1, first + 1)
"""
NUMBERS = """
import math


def minus(a, b):
    return (a.X - b.X, a.Y - b.Y, a.Z - b.Z)


def apart(points):
    most = 0.0
    for i in range(6):
        for j in range(6):
            a, b, c, d = [points[k] for k in (7 * i + j, 7 * i + j + 7, 7 * i + j + 8, 7 * i + j + 1)]
            p, q, r = minus(c, a), minus(d, b), minus(b, a)
            n = (p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0])
            most = max(most, abs(sum(s * t for s, t in zip(n, r))) / math.sqrt(sum(s * s for s in n)))
    return 1000 * most


def laths(points):
    pairs = [(7 * i + j, 7 * i + j + 1) for i in range(7) for j in range(6)]
    pairs += [(7 * j + i, 7 * j + 7 + i) for i in range(7) for j in range(6)]
    return [points[a].DistanceTo(points[b]) for a, b in pairs]


drawn_apart, drawn_lengths = apart(nodes), laths(nodes)
drawn_longest, drawn_shortest = max(drawn_lengths), min(drawn_lengths)
flat, lengths = apart(moved), laths(moved)
longest, shortest = max(lengths), min(lengths)
gone = max(a.DistanceTo(b) for a, b in zip(nodes, moved))
"""
NAMES = {
    "drawn_apart": "drawn: diagonals of a face apart, most", "drawn_longest": "drawn: longest lath",
    "drawn_shortest": "drawn: shortest lath", "flat": "diagonals of a face apart, most", "longest": "longest lath",
    "shortest": "shortest lath", "gone": "a node is moved by, most",
}  # fmt: skip


def definition() -> Definition:
    d = Definition(
        "design_gridshell",
        "A gridshell of flat glass and laths in stock",
        "Every node is held and may be moved. Design keeps the nodes near the surface, makes every face flat and every "
        "lath a length in stock.",
    )
    with d.group("Drawn", "A surface of double curvature."):
        given = {
            "size": d.slider("Side [m]", GIVEN["size"], 2, 20, 1),
            "rise": d.slider("Rise [m]", GIVEN["rise"], 0, 5, 1),
            "twist": d.slider("Twist [m]", GIVEN["twist"], 0, 1, 2),
            "along": d.slider("Faces [-]", GIVEN["along"], 2, 12),
        }
        drawn = d.script("Surface", DRAWN, given, ["mesh", "nodes", "lines"])
    with d.group("Forces", "Lines without force, which have lengths; and the mesh, which has faces."):
        none = d.slider("Tension [N]", 0, 0, 1)
        laths = d.component("ConstantTension", "Laths", connection=drawn["lines"], tension=none)
    with d.group("Problem"):
        varied = d.component("Variables", "Nodes", anchors=drawn["nodes"])
        near = d.component(
            "Goals", "Near", kind=d.text("Kind", "position"), points=drawn["nodes"], target=drawn["nodes"]
        )
        great = d.text("Weight [-]", "1e6")
        flat_faces = d.component(
            "Goals",
            "Flat",
            kind=d.text("Faces", "planarity"),
            meshes=drawn["mesh"],
            target=d.slider("Apart [m]", 0, 0, 1),
            weight=great,
        )
        stock = d.component(
            "Goals", "Stock", kind=d.text("Laths", "length"), forces=laths, weight=great,
            lower=d.slider("Shortest [m]", 1.1, 0.5, 2, 2), upper=d.slider("Longest [m]", 1.35, 0.5, 2, 2),
        )  # fmt: skip
    with d.group("Design"):
        found = d.component(
            "Design", forces=laths, anchors=drawn["nodes"], geometry=drawn["mesh"], variables=varied,
            goals=flat(near, flat_faces, stock),
        )  # fmt: skip
        vertices = d.component("MeshVertices", mesh=found["geometry"])
    with d.group("Numbers", "What expected.json holds it to."):
        given = {"nodes": drawn["nodes"], "moved": vertices["points"]}
        d.numbers(NUMBERS, given, NAMES, lists=["nodes", "moved"])
    return d
