"""Figure 9.31 on the canvas: diagonals one way (A), the other way (B), and warp and weft that differ (C)."""

from hookean.commands.examples import defaults, figure
from hookean_canvas.definitions import parts
from hookean_canvas.definitions.write import Definition, flat

PATTERNS = figure("9.31-diagonal-patterns")
GIVEN, WOVEN = defaults(PATTERNS.scene), defaults(PATTERNS.warp_and_weft)

NUMBERS = """
def grid(mesh):
    points = [mesh.Vertices.Point3dAt(i) for i in range(len(mesh.Vertices))]
    size = int(round(len(points) ** 0.5))
    return [[(p.X, p.Y, p.Z) for p in points[size * i : size * i + size]] for i in range(size)]


def reaction(tree, x):  # size of the reaction at the corner (x, 0)
    found = zip(corners, tree.Branch(0))
    force = min(found, key=lambda pair: abs(pair[0].X - x) + abs(pair[0].Y))[1]
    return (force.X ** 2 + force.Y ** 2 + force.Z ** 2) ** 0.5


one, other, woven = grid(a), grid(b), grid(c)
mirror = [[(10.0 - x, y, z) for x, y, z in row] for row in one[::-1]]
pairs = [(p, q) for rows in zip(other, mirror) for p, q in zip(*rows)]
deepest = -min(z for row in one for _, _, z in row)
near = reaction(reactions_a, 0.0)
far = reaction(reactions_a, 10.0)
diagonal = max(forces_a.Branch(1))
near_b = reaction(reactions_b, 0.0)
mirrored = max(abs(s - t) for p, q in pairs for s, t in zip(p, q))
half = len(woven) // 2
middle = -woven[half][half][2]
warp_rim = -woven[half][0][2]
weft_rim = -woven[0][half][2]
warp = max(forces_c.Branch(0))
weft = max(forces_c.Branch(1))
"""


def definition() -> Definition:
    d = Definition(
        "9.31-diagonal-patterns",
        "Figure 9.31: patterns of diagonals, and warp and weft",
        "A square of 10 x 10 faces under 20 N on every particle, held at its corners: with one diagonal in every face, "
        "all one way (A) or all the other way (B), and with edges that differ along x and y (C).",
    )
    with d.group("Drawn in Rhino", "Layers of model.3dm beside this file."):
        file, mesh = parts.surface(d, GIVEN, 30)
        ways = [
            d.component("RhinoFile", file=file, layer=d.text(f"Diagonals {key}", layer))["lines"]
            for key, layer in (("A", "one way"), ("B", "other way"))
        ]
        woven = d.component("WarpWeft", mesh=mesh)
        corners = d.component("MeshCorners", mesh=mesh)["corners"]
        vertices = d.component("MeshVertices", mesh=mesh)
    with d.group("Forces"):
        load = d.component("Unary", point=vertices, force=parts.down(d, GIVEN))
        edges = d.component(
            "Springs", "Edges", connection=mesh, stiffness=d.slider("Edges [N/m]", GIVEN["stiffness"], 10, 5000)
        )
        stiffness = d.slider("Diagonals [N/m]", GIVEN["diagonal_stiffness"], 10, 5000)
        tables = [
            [edges, d.component("Springs", f"Diagonals {key}", connection=lines, stiffness=stiffness), load]
            for key, lines in zip("AB", ways, strict=True)
        ]
        threads = [
            d.component(
                "Springs", name, connection=woven[name.lower()],
                stiffness=d.slider(f"{name} [N/m]", WOVEN[f"{name.lower()}_stiffness"], 10, 5000),
                rest_factor=d.slider(f"{name} factor [-]", WOVEN[f"{name.lower()}_factor"], 0.5, 1.5, decimals=2),
            )
            for name in ("Warp", "Weft")
        ]  # fmt: skip
        tables.append([*threads, load])
    with d.group("Engines"):
        settings = parts.solving(d, "relaxation", "1e-10")
        reset = d.toggle("Reset", True)
        engines = [
            d.component(
                "Engine", f"Engine {key}", forces=flat(*forces), anchors=flat(corners), settings=settings,
                geometry=mesh, reset=reset,
            )
            for key, forces in zip("ABC", tables, strict=True)
        ]  # fmt: skip
    with d.group("Numbers", "What expected.json holds the figure to."):
        given = {key: engine["geometry"] for key, engine in zip("abc", engines, strict=True)}
        trees = {f"{name}_{key}": engine[name] for name in ("forces", "reactions")
                 for key, engine in zip("abc", engines, strict=True)}  # fmt: skip
        del trees["reactions_c"], trees["forces_b"]
        d.numbers(
            NUMBERS,
            {**given, **trees, "corners": corners},
            {
                "deepest": "A: deepest sag", "near": "A: reaction at (0, 0)", "far": "A: reaction at (10, 0)",
                "diagonal": "A: largest force in a diagonal", "near_b": "B: reaction at (0, 0)",
                "mirrored": "B: difference from the mirror image of A", "middle": "C: sag in the middle",
                "warp_rim": "C: sag of the rim along the warp", "weft_rim": "C: sag of the rim along the weft",
                "warp": "C: largest force in the warp", "weft": "C: largest force in the weft",
            },
            lists=["corners"], trees=list(trees),
        )  # fmt: skip
    return d
