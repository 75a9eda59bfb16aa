"""Figure 9.30 on the canvas: a sheet of edges and diagonals; shorter diagonals fold its faces."""

from hookean.commands.examples import defaults, figure
from hookean_canvas.definitions import parts
from hookean_canvas.definitions.write import Definition, flat

GIVEN = defaults(figure("9.30-creases").scene)

NUMBERS = """
import math


def cross(p, a, b):
    u, v = (a.X - p.X, a.Y - p.Y, a.Z - p.Z), (b.X - p.X, b.Y - p.Y, b.Z - p.Z)
    return u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]


points = [membrane.Vertices.Point3dAt(i) for i in range(len(membrane.Vertices))]
size = int(round(len(points) ** 0.5))
folds = []
for i in range(size - 1):
    for j in range(size - 1):
        k = size * i + j
        a, b, c, d = [points[n] for n in (k, k + size, k + size + 1, k + 1)]
        one, other = cross(a, b, d), cross(c, d, b)
        cosine = sum(p * q for p, q in zip(one, other)) / math.sqrt(sum(p * p for p in one) * sum(q * q for q in other))
        folds.append(math.degrees(math.acos(max(-1.0, min(1.0, cosine)))))
start = [drawn.Vertices.Point3dAt(i) for i in range(len(drawn.Vertices))]
lost = sum(load * (p.Z - q.Z) for p, q in zip(points, start))
springs = energy + lost
deepest = -min(p.Z for p in points)
fold = sum(folds) / len(folds)
upward = sum(reaction.Z for reaction in reactions.Branch(0))
"""
NAMES = {
    "springs": "energy of the springs", "deepest": "deepest sag", "fold": "mean fold of the faces",
    "upward": "upward reactions together",
}  # fmt: skip


def definition() -> Definition:
    d = Definition(
        "9.30-creases",
        "Figure 9.30: a sheet, and its creases",
        "Edges and diagonals are two components of springs. With diagonals as long as drawn the sheet hangs smoothly; "
        "with shorter ones its faces fold. Pull the factors: the more, the sharper.",
    )
    with d.group("Drawn in Rhino", "The surface in model.3dm beside this file."):
        _, mesh = parts.surface(d, GIVEN, 40)
        lines = d.component("Diagonals", mesh=mesh)
        corners = d.component("MeshCorners", mesh=mesh)
        vertices = d.component("MeshVertices", mesh=mesh)
    with d.group("Forces"):
        stiffness = d.slider("Stiffness [N/m]", GIVEN["stiffness"], 10, 5000)
        edges = d.component("Springs", "Edges", connection=mesh, stiffness=stiffness)
        weight = d.slider("Load [N]", -GIVEN["load"], -20, 0, decimals=1)
        load = d.component("Unary", point=vertices, force=d.native("Unit Z", factor=weight))
    with d.group("Settings"):
        settings = parts.solving(d, "relaxation", "1e-10")
        reset = d.toggle("Reset", True)
    for name, factor in (("smooth", "1"), ("creased", "0.95"), ("sharper", "0.9")):
        with d.group(f"Diagonals: {name}"):
            slider = d.slider(f"Rest factor, {name} [-]", float(factor), 0.5, 1.5, decimals=2)
            diagonals = d.component(
                "Springs", f"Diagonals {name}", connection=lines, stiffness=stiffness, rest_factor=slider
            )
            engine = d.component(
                "Engine", f"Engine {name}", forces=flat(edges, diagonals, load), anchors=flat(corners["corners"]),
                settings=settings, geometry=mesh, reset=reset,
            )  # fmt: skip
            given = {key: engine[key] for key in ("energy", "reactions")}
            given |= {"membrane": engine["geometry"], "drawn": mesh, "load": weight}
            names = {variable: f"diagonals {factor}: {said}" for variable, said in NAMES.items()}
            d.numbers(NUMBERS, given, names, trees=["reactions"])
    return d
