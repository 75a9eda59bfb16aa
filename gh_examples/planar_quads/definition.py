"""Quads that become flat on the canvas: with the drawing, near it, and without it."""

from hookean.commands.examples import defaults, figure
from hookean_canvas.definitions import parts
from hookean_canvas.definitions.write import Definition, flat

GIVEN = defaults(figure("planar_quads").scene)

MESHES = """
import math

import Rhino

count = int(divisions)
wide = count + 1


def surface(place):
    mesh = Rhino.Geometry.Mesh()
    for i in range(wide):
        for j in range(wide):
            mesh.Vertices.Add(*place(2.0 * i / count - 1.0, 2.0 * j / count - 1.0))
    for i in range(count):
        for j in range(count):
            first = wide * i + j
            mesh.Faces.AddFace(first, first + wide, first + wide + 1, first + 1)
    return mesh


def roof_at(u, v):
    return 6.0 * u, 6.0 * v * (1.0 + 0.2 * u), 3.2 - 2.0 * u * u - 1.2 * v * v + 1.2 * u * v


def slid(u, v):
    return 6.0 * u + 15.0, 6.0 * v, 3.2 - 2.0 * u * u + 0.6 * math.cos(3.0 * v)


roof = surface(roof_at)
shift = surface(slid)
quad = Rhino.Geometry.Mesh()
for x, y, z in ((-2.0, -2.0, 0.5), (2.0, -2.0, -0.5), (2.0, 2.0, 0.5), (-2.0, 2.0, -0.5)):
    quad.Vertices.Add(x + 26.25, y, z)
quad.Faces.AddFace(0, 1, 2, 3)
meshes = [roof, shift, quad]
points = [roof.Vertices.Point3dAt(i) for i in range(wide * wide)]
"""
NUMBERS = """
import math


def places(mesh):
    return [(p.X, p.Y, p.Z) for p in (mesh.Vertices.Point3dAt(i) for i in range(len(mesh.Vertices)))]


def less(p, q):
    return [a - b for a, b in zip(p, q)]


def cross(p, q):
    return [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]]


def dot(p, q):
    return sum(a * b for a, b in zip(p, q))


def quads(mesh):
    x = places(mesh)
    wide = int(round(math.sqrt(len(x))))
    for i in range(wide - 1):
        for j in range(wide - 1):
            first = wide * i + j
            yield [x[k] for k in (first, first + wide, first + wide + 1, first + 1)]


def apart(corners):
    a, b, c, d = corners
    normal = cross(less(c, a), less(d, b))
    return abs(dot(less(b, a), normal)) / math.sqrt(dot(normal, normal))


def angles(corners):
    total = 0.0
    for k in range(4):
        one, other = less(corners[k - 3], corners[k]), less(corners[k - 1], corners[k])
        normal = cross(one, other)
        total += math.atan2(math.sqrt(dot(normal, normal)), dot(one, other))
    return math.degrees(total)


def moved(one, other):
    return max(math.dist(p, q) for p, q in zip(places(one), places(other)))


def around(mesh):
    # a quad by itself: its vertices are numbered round it
    return places(mesh)


before = max(apart(corners) for corners in quads(drawn[0]))
near_apart, near_moved = max(apart(corners) for corners in quads(near[0])), moved(near[0], drawn[0])
free_apart = max(apart(corners) for corners in quads(free[0]))
turned = [angles(corners) for mesh in free[:2] for corners in quads(mesh)] + [angles(around(free[2]))]
off = max(abs(angle - 360.0) for angle in turned)
shift_apart, shift_moved = max(apart(corners) for corners in quads(result[1])), moved(result[1], drawn[1])
quad_apart, quad_moved = apart(around(drawn[2])), moved(result[2], drawn[2])
"""
NAMES = {
    "before": "as drawn: largest distance of diagonals",
    "near_apart": "near the drawing: largest distance of diagonals",
    "near_moved": "near the drawing: largest movement",
    "free_apart": "without the drawing: largest distance of diagonals",
    "off": "without the drawing: angles of a quad, furthest from 360",
    "shift_apart": "translation: largest distance of diagonals",
    "shift_moved": "translation: largest movement",
    "quad_apart": "single quad: distance of diagonals as drawn",
    "quad_moved": "single quad: movement of a corner",
}


def definition() -> Definition:
    d = Definition(
        "planar_quads",
        "Quads become flat",
        "Planarize makes the quads of a roof flat, and springs keep its vertices near their drawing: with the strength "
        "of the slider, with 0.03 N/m, and without. Set Reset to False and change the strength.",
    )
    with d.group("Meshes"):
        made = d.script(
            "Meshes", MESHES, {"divisions": d.slider("Quads a side [-]", GIVEN["divisions"], 2, 20)},
            ["meshes", "points"],
        )  # fmt: skip
    with d.group("Forces"):
        flatness = d.slider("Flatness [N/m]", GIVEN["flatness"], 0.1, 10, decimals=1)
        nearness = d.slider("Nearness [N/m]", GIVEN["nearness"], 0, 1, decimals=4)
        planar = d.component("Planarize", mesh=made["meshes"], stiffness=flatness)
        drawing = d.component("AnchorSpring", point=made["points"], strength=nearness)
        stiffer = d.component("AnchorSpring", "Nearer", point=made["points"], strength=d.text("0.03", "0.03"))
    with d.group("Engines"):
        settings = parts.solving(d, "relaxation", "1e-9")
        common = {"settings": settings, "geometry": made["meshes"], "reset": d.toggle("Reset", True)}
        engine = d.component("Engine", forces=flat(planar, drawing), **common)
        near = d.component("Engine", "Near", forces=flat(planar, stiffer), **common)
        free = d.component("Engine", "Free", forces=flat(planar), **common)
        d.panel("report", engine["report"])
    with d.group("Numbers", "What expected.json holds it to."):
        shapes = {"drawn": made["meshes"], "result": engine["geometry"], "near": near["geometry"],
                  "free": free["geometry"]}  # fmt: skip
        d.numbers(NUMBERS, shapes, NAMES, lists=list(shapes))
    return d
