"""Figure 9.1 on the canvas: a square membrane of particles and springs, held at its corners."""

from hookean.commands.examples import defaults, figure
from hookean_canvas.definitions import parts
from hookean_canvas.definitions.write import Definition, flat

GIVEN = defaults(figure("9.1-square-membrane").scene)

GRID = """
import Rhino

mesh = Rhino.Geometry.Mesh()
for i in range(count + 1):
    for j in range(count + 1):
        mesh.Vertices.Add(side * i / count, side * j / count, 0.0)
for i in range(count):
    for j in range(count):
        a = (count + 1) * i + j
        mesh.Faces.AddFace(a, a + count + 1, a + count + 2, a + 1)
"""
NUMBERS = """
vertices = [membrane.Vertices.Point3dAt(i) for i in range(len(membrane.Vertices))]
size = int(round(len(vertices) ** 0.5))
heights = [[vertices[size * i + j].Z for j in range(size)] for i in range(size)]
springs = forces.Branch(0)
middle = -heights[size // 2][size // 2]
edge = -heights[0][size // 2]
largest = max(springs)
least = min(springs)
corner = reactions.Branch(0)[0].Z
both = [(i, j) for i in range(size) for j in range(size)]
mirrored = max(max(abs(heights[i][j] - heights[j][i]), abs(heights[i][j] - heights[-1 - i][j])) for i, j in both)
imbalance = residual * abs(load)
"""


def definition() -> Definition:
    d = Definition(
        "9.1-square-membrane",
        "Figure 9.1: a square membrane held at its corners",
        "81 particles, 144 springs of 1 m between them, 5 N down on every particle. "
        "Reset True reads what is drawn, False lets it move. Pull the sliders while it runs.",
    )
    with d.group("Membrane"):
        side = d.slider("Side [m]", GIVEN["size"], 1, 20, decimals=1)
        inputs = {"side": side, "count": d.slider("Faces along a side [-]", GIVEN["divisions"], 2, 30)}
        mesh = d.script("Grid", GRID, inputs, ["mesh"], description="A square mesh in the plane z = 0.")
        points = d.component("MeshVertices", mesh=mesh)
        corners = d.component("MeshCorners", mesh=mesh)
    with d.group("Forces"):
        springs = d.component(
            "Springs", connection=mesh, stiffness=d.slider("Stiffness [N/m]", GIVEN["stiffness"], 10, 5000)
        )
        load = d.slider("Load [N]", -GIVEN["load"], -50, 0, decimals=1)
        down = d.component("Unary", point=points, force=d.native("Unit Z", factor=load))
    with d.group("Engine"):
        engine = parts.engine(
            d, "newton", "1e-12", forces=flat(springs, down), anchors=flat(corners["corners"]), geometry=mesh
        )
    with d.group("Numbers", "What expected.json holds the figure to."):
        d.panel("report", engine["report"])
        given = {name: engine[name] for name in ("forces", "reactions", "residual")}
        d.numbers(
            NUMBERS,
            {"membrane": engine["geometry"], **given, "load": load},
            {
                "middle": "sag in the middle", "edge": "sag of an edge", "largest": "largest force in a spring",
                "least": "least force in a spring", "corner": "vertical reaction of a corner",
                "mirrored": "largest difference between mirror images",
                "imbalance": "largest imbalance of a particle",
            },
            trees=["forces", "reactions"],
        )  # fmt: skip
    return d
