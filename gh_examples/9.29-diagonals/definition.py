"""Figure 9.29 on the canvas: the same membrane without diagonals, with one and with both in every face."""

from hookean.commands.examples import defaults, figure
from hookean_canvas.definitions import parts
from hookean_canvas.definitions.write import Definition, flat

GIVEN = defaults(figure("9.29-diagonals").scene)

NUMBERS = """
import math

points = [membrane.Vertices.Point3dAt(i) for i in range(len(membrane.Vertices))]
size = int(round(len(points) ** 0.5))
skews = []
for i in range(size - 1):
    for j in range(size - 1):
        a = size * i + j
        face = [points[k] for k in (a, a + size, a + size + 1, a + 1)]
        worst = 0.0
        for k in range(4):
            here, before, after = face[k], face[k - 1], face[(k + 1) % 4]
            u = before.X - here.X, before.Y - here.Y, before.Z - here.Z
            v = after.X - here.X, after.Y - here.Y, after.Z - here.Z
            cosine = sum(p * q for p, q in zip(u, v)) / math.sqrt(sum(p * p for p in u) * sum(q * q for q in v))
            worst = max(worst, abs(90.0 - math.degrees(math.acos(cosine))))
        skews.append(worst)
sag = -min(p.Z for p in points)
largest = max(skews)
mean = sum(skews) / len(skews)
edge = max(forces.Branch(0))
upward = sum(reaction.Z for reaction in reactions.Branch(0))
diagonal = max(forces.Branch(1)) if forces.BranchCount > 2 else 0.0
"""
NAMES = {
    "sag": "sag", "largest": "largest skew of a face", "mean": "mean skew of the faces",
    "edge": "largest force in an edge", "upward": "upward reactions together",
}  # fmt: skip


def definition() -> Definition:
    d = Definition(
        "9.29-diagonals",
        "Figure 9.29: diagonals keep faces from becoming diamonds",
        "A square of 10 x 10 faces under 20 N on every particle, held at its corners: without diagonals, with those "
        "drawn in Rhino, and with both in every face.",
    )
    with d.group("Drawn in Rhino", "Layers of model.3dm beside this file."):
        file, mesh = parts.surface(d, GIVEN, 30)
        one = d.component("RhinoFile", file=file, layer=d.text("Diagonals", "one way"))
        both = d.component("Diagonals", mesh=mesh)
        corners = d.component("MeshCorners", mesh=mesh)
        vertices = d.component("MeshVertices", mesh=mesh)
    with d.group("Forces"):
        edges = d.component(
            "Springs", "Edges", connection=mesh, stiffness=d.slider("Edges [N/m]", GIVEN["stiffness"], 10, 5000)
        )
        stiffness = d.slider("Diagonals [N/m]", GIVEN["diagonal_stiffness"], 10, 5000)
        lines = {"one": one["lines"], "both": both}
        diagonals = {
            name: d.component("Springs", f"Diagonals {name}", connection=given, stiffness=stiffness)
            for name, given in lines.items()
        }
        load = d.component("Unary", point=vertices, force=parts.down(d, GIVEN))
    with d.group("Settings"):
        settings = parts.solving(d, "relaxation", "1e-10")
        reset = d.toggle("Reset", True)
    for which in ("none", "one", "both"):
        with d.group(f"Diagonals: {which}"):
            forces = [edges, diagonals[which], load] if which in diagonals else [edges, load]
            engine = d.component(
                "Engine", f"Engine {which}", forces=flat(*forces), anchors=flat(corners["corners"]), settings=settings,
                geometry=mesh, reset=reset,
            )  # fmt: skip
            names = {variable: f"{which}: {name}" for variable, name in NAMES.items()}
            if which in diagonals:
                names["diagonal"] = f"{which}: largest force in a diagonal"
            given = {"membrane": engine["geometry"], "forces": engine["forces"], "reactions": engine["reactions"]}
            d.numbers(NUMBERS, given, names, trees=["forces", "reactions"])
    return d
