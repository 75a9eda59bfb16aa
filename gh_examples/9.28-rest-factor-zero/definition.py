"""Figure 9.28 on the canvas: a net of rest factor 0, and the soap film in the same frame."""

from hookean.commands.examples import defaults, figure
from hookean_canvas.definitions.write import Definition, flat

GIVEN = defaults(figure("9.28-rest-factor-zero").scene)

GRID = """
def grid(mesh):
    points = [mesh.Vertices.Point3dAt(i) for i in range(len(mesh.Vertices))]
    size = int(round(len(points) ** 0.5))
    return [[(p.X, p.Y, p.Z) for p in points[size * i : size * i + size]] for i in range(size)]


def triangle(a, b, c):
    u, v = [q - p for p, q in zip(a, b)], [q - p for p, q in zip(a, c)]
    normal = u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]
    return 0.5 * sum(part * part for part in normal) ** 0.5


def area(rows):  # a quad is the mean of its two cuts
    total = 0.0
    for near, far in zip(rows, rows[1:]):
        for a, d, b, c in zip(near, near[1:], far, far[1:]):
            total += triangle(a, b, c) + triangle(a, c, d) + triangle(a, b, d) + triangle(b, c, d)
    return 0.5 * total


def every_second(rows):
    return [row[::2] for row in rows[::2]]


def without_error(fine, coarse):  # Richardson: half the size leaves a quarter of the error
    return (4.0 * fine - coarse) / 3.0


def height(rows, at):  # over (at, at): a natural cubic spline along the plane of symmetry
    x, z = [rows[i][i][0] for i in range(len(rows))], [rows[i][i][2] for i in range(len(rows))]
    n, h = len(x), [b - a for a, b in zip(x, x[1:])]
    slope = [(b - a) / w for a, b, w in zip(z, z[1:], h)]
    upper, right = [0.0] * n, [0.0] * n
    for i in range(1, n - 1):
        pivot = 2.0 * (h[i - 1] + h[i]) - h[i - 1] * upper[i - 1]
        upper[i], right[i] = h[i] / pivot, (6.0 * (slope[i] - slope[i - 1]) - h[i - 1] * right[i - 1]) / pivot
    bend = [0.0] * n
    for i in range(n - 2, 0, -1):
        bend[i] = right[i] - upper[i] * bend[i + 1]
    i = max(k for k in range(n - 1) if x[k] <= at + 1e-12)
    a, b = (x[i + 1] - at) / h[i], (at - x[i]) / h[i]
    curved = ((a ** 3 - a) * bend[i] + (b ** 3 - b) * bend[i + 1]) * h[i] ** 2 / 6.0
    return a * z[i] + b * z[i + 1] + curved


"""
NUMBERS = """
rows, wide, fine = grid(net), grid(film), grid(half)
saddle = max(abs(z - x * y) for row in rows for x, y, z in row)
net_area = without_error(area(rows), area(every_second(rows)))
film_area = without_error(area(fine), area(wide))
excess = 100.0 * (net_area / film_area - 1.0)
net_height = height(rows, 0.5)
film_height = without_error(height(fine, 0.5), height(wide, 0.5))
faces_area = area(wide)
"""


def definition() -> Definition:
    d = Definition(
        "9.28-rest-factor-zero",
        "Figure 9.28: a net of rest factor 0, and the soap film",
        "Springs of rest factor 0 make a force-density net, here the hypar z = x y between its edges. It is near the "
        "minimal surface of the same frame, but not it. The film is taken twice, the second time with faces half as "
        "wide, from which follows what their size adds to its area.",
    )
    with d.group("Drawn in Rhino", "The frame's surface in model.3dm beside this file, divided twice."):
        file, layer = d.text("File", "model.3dm"), d.text("Surface", "membrane")
        meshes, frames = [], []
        for name, count in (("Divisions [-]", GIVEN["divisions"]), ("Divisions, fine [-]", 64)):
            number = d.slider(name, count, 2, 64)
            meshes.append(d.component("RhinoFile", file=file, layer=layer, u=number, v=number)["meshes"])
            frames.append(d.component("NakedVertices", mesh=meshes[-1])["naked_points"])
    with d.group("Forces"):
        factor = d.slider("Rest factor [-]", GIVEN["rest_factor"], 0, 1, decimals=2)
        stiffness = d.slider("Stiffness [N/m]", GIVEN["tension"], 1, 1000)
        springs = d.component("Springs", connection=meshes[0], stiffness=stiffness, rest_factor=factor)
        tension = d.slider("Tension [N/m]", 1, 0.1, 10, decimals=1)
        films = [d.component("SoapFilm", mesh=mesh, tension=tension) for mesh in meshes]
    with d.group("Engines"):
        reset, fast = d.toggle("Reset", True), d.toggle("Fast", True)
        exact = d.component(
            "Settings", solver=d.text("Solver", "newton"), residual=d.text("Residual [-]", "1e-13"), fast=fast
        )
        relaxing = d.component(
            "Settings", solver=d.text("Solver of films", "relaxation"),
            residual=d.text("Residual of films [-]", "1e-9"), fast=fast,
        )  # fmt: skip
        moved = []
        cases = (("net", springs, 0, exact), ("film", films[0], 0, relaxing), ("fine film", films[1], 1, relaxing))
        for which, force, i, settings in cases:
            engine = d.component(
                "Engine", f"Engine {which}", forces=force, anchors=flat(frames[i]), settings=settings,
                geometry=meshes[i], reset=reset,
            )  # fmt: skip
            d.panel(f"status of the {which}", engine["status"])
            moved.append(engine["geometry"])
    with d.group("Numbers", "What expected.json holds the figure to."):
        d.numbers(
            GRID + NUMBERS,
            dict(zip(("net", "film", "half"), moved, strict=True)),
            {
                "saddle": "net: farthest from z = x y", "net_area": "net: area", "film_area": "film: area",
                "excess": "excess of the net's area", "net_height": "net: height over (0.5, 0.5)",
                "film_height": "film: height over (0.5, 0.5)", "faces_area": "film: area of its 32 x 32 faces",
            },
        )  # fmt: skip
    return d
