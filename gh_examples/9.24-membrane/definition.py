"""Figures 9.23 to 9.25 on the canvas: a surface becomes a net of springs, held at its corners; its mesh rides along."""

from hookean.commands.examples import defaults, figure
from hookean_canvas.definitions.write import Definition, flat

GIVEN = defaults(figure("9.24-membrane").scene)

NUMBERS = """
points = [mesh.Vertices.Point3dAt(i) for i in range(len(vertices))]
z = [p.Z for p in points]
side = int(round(len(z) ** 0.5))
rows = [z[side * i : side * (i + 1)] for i in range(side)]
turned = [row for row in reversed(rows)]
vertices_of_the_mesh = len(vertices)
edges_of_the_mesh = len(edges)
sag = -z[len(z) // 2]
tensions = list(forces.Branch(0))
largest = max(tensions)
least = min(tensions)
length = sum(a.DistanceTo(b) for a, b in pairs(points, edges))
upward = sum(v.Z for v in reactions.Branch(0))
mirror = max(abs(rows[i][j] - other) for i in range(side) for j in range(side) for other in (turned[i][j], rows[j][i]))
"""
FRONT = """
def pairs(points, lines):
    # where the ends of the edges as they were drawn are now
    drawn = {(p.X, p.Y, p.Z): i for i, p in enumerate(vertices)}
    for line in lines:
        yield [points[drawn[(p.X, p.Y, p.Z)]] for p in (line.From, line.To)]

"""


def definition() -> Definition:
    d = Definition(
        "9.24-membrane",
        "Figure 9.24: a membrane held at its corners",
        "The square drawn in model.3dm becomes a mesh; its edges are springs, its corners anchors, and every particle "
        "carries 20 N. Edges out: the springs. Faces out: the mesh that rides along.",
    )
    with d.group("Surface"):
        drawn = d.component("RhinoFile", file=d.text("File", "model.3dm"), layer=d.text("Layer", "membrane"))
        mesh = d.component(
            "MeshSurface", surface=drawn["surfaces"], u=d.slider("Faces U [-]", GIVEN["divisions"], 2, 60),
            v=d.slider("Faces V [-]", GIVEN["divisions"], 2, 60),
        )  # fmt: skip
        vertices = d.component("MeshVertices", mesh=mesh)
        edges = d.component("MeshEdges", mesh=mesh)
        corners = d.component("MeshCorners", mesh=mesh)
    with d.group("Forces"):
        springs = d.component(
            "Springs", connection=edges["edges"], stiffness=d.slider("Stiffness [N/m]", GIVEN["stiffness"], 10, 5000)
        )
        load = d.component(
            "Unary", point=vertices, force=d.native("Unit Z", factor=d.slider("Load [N]", -GIVEN["load"], -100, 100))
        )
    with d.group("Engine"):
        settings = d.component("Settings", residual=d.text("Residual [-]", "1e-9"), fast=d.toggle("Fast", True))
        engine = d.component(
            "Engine", forces=flat(springs, load), anchors=corners["corners"], settings=settings, geometry=mesh,
            reset=d.toggle("Reset", True),
        )  # fmt: skip
    with d.group("Numbers", "What expected.json holds the figure to."):
        d.panel("report", engine["report"])
        d.numbers(
            FRONT + NUMBERS.strip(),
            {
                "vertices": vertices, "edges": edges["edges"], "mesh": engine["geometry"],
                "forces": engine["forces"], "reactions": engine["reactions"],
            },
            {
                "vertices_of_the_mesh": "vertices of the mesh", "edges_of_the_mesh": "edges of the mesh",
                "sag": "sag in the middle", "largest": "largest force", "least": "least force",
                "length": "length of all springs", "upward": "upward reactions together",
                "mirror": "difference between mirror images",
            },
            lists=["vertices", "edges"], trees=["forces", "reactions"],
        )  # fmt: skip
    return d
