"""Section 9.7 on the canvas: a mesh sphere falls onto the floor; with springs alone it crumples, with Shell not."""

from typing import Any

from hookean.commands.examples import defaults, figure
from hookean_canvas.definitions.write import Definition, flat

GIVEN = defaults(figure("sphere").scene)

OPPOSITE = """
import Rhino

lines = []
for i in range(mesh.Faces.Count):
    face = mesh.Faces[i]
    a, b, c, d = (face.A, face.B, face.C, face.D) if hasattr(face, "A") else tuple(face)
    for ends in ((a, c), (b, d)):  # of a triangle, d = c: lines that lie on its edges
        lines.append(Rhino.Geometry.Line(*[mesh.Vertices.Point3dAt(k) for k in ends]))
"""
SHAPE = """
def volume(mesh):  # by the divergence theorem; a quad is the mean of its two cuts
    points = [mesh.Vertices.Point3dAt(i) for i in range(len(mesh.Vertices))]
    points = [(p.X, p.Y, p.Z) for p in points]
    total = 0.0
    for i in range(mesh.Faces.Count):
        face = mesh.Faces[i]
        a, b, c, d = [points[k] for k in ((face.A, face.B, face.C, face.D) if hasattr(face, "A") else tuple(face))]
        for p, q, r in ((a, b, c), (a, c, d), (a, b, d), (b, c, d)):
            total += p[0] * (q[1] * r[2] - q[2] * r[1]) + p[1] * (q[2] * r[0] - q[0] * r[2])
            total += p[2] * (q[0] * r[1] - q[1] * r[0])
    return total / 12.0


def heights(mesh):
    return [mesh.Vertices.Point3dAt(i).Z for i in range(len(mesh.Vertices))]


def tall(mesh):
    return max(heights(mesh)) - min(heights(mesh))


"""
STEP = """
import math

# springs that are unstrained: the largest eigenvalue of B^T B, B the rate of each length by the positions, by Lanczos
places = {}
ends = [[places.setdefault((round(p.X, 5), round(p.Y, 5), round(p.Z, 5)), len(places)) for p in (line.From, line.To)]
        for line in lines]
units = [((line.To.X - line.From.X) / line.Length, (line.To.Y - line.From.Y) / line.Length,
          (line.To.Z - line.From.Z) / line.Length) for line in lines]


def times(x):
    y = [0.0] * len(x)
    for (a, b), (u, v, w) in zip(ends, units):
        a, b = 3 * a, 3 * b
        rate = u * (x[b] - x[a]) + v * (x[b + 1] - x[a + 1]) + w * (x[b + 2] - x[a + 2])
        y[a] -= u * rate
        y[a + 1] -= v * rate
        y[a + 2] -= w * rate
        y[b] += u * rate
        y[b + 1] += v * rate
        y[b + 2] += w * rate
    return y


x, before, beta = [math.cos(i) for i in range(3 * len(places))], None, 0.0
size = math.sqrt(sum(c * c for c in x))
x, diagonal, beside = [c / size for c in x], [], []
for _ in range(150):
    y = times(x)
    alpha = sum(p * q for p, q in zip(x, y))
    y = [q - alpha * p for p, q in zip(x, y)]
    if before is not None:
        y = [q - beta * p for p, q in zip(before, y)]
    beta = math.sqrt(sum(c * c for c in y))
    diagonal.append(alpha)
    beside.append(beta)
    before, x = x, [c / beta for c in y]


def above(value):  # whether an eigenvalue of the tridiagonal matrix is above a value
    pivot = 1.0
    for i, entry in enumerate(diagonal):
        pivot = entry - value - (beside[i - 1] ** 2 / pivot if i else 0.0)
        if pivot > 0.0:
            return True
    return False


low, high = 0.0, 2.0 * max(diagonal) + 4.0 * max(beside)
for _ in range(100):
    middle = 0.5 * (low + high)
    low, high = (middle, high) if above(middle) else (low, middle)
omega = math.sqrt(stiffness * low)
zeta = (10.0 * low + drag) / (2.0 * omega)  # springs have a damping of 10 N s/m
step = 2.0 / omega * (math.sqrt(1.0 + zeta ** 2) - zeta)
"""
NUMBERS = """
import re

shapes = sorted(zip(times, [fell.Branch(path)[0] for path in fell.Paths]), key=lambda pair: pair[0])
when = [pair[0] for pair in shapes]
bottoms = [min(heights(pair[1])) for pair in shapes]
end, still = shapes[-1][1], kept.Branch(0)[0]
start = min(heights(mesh))
springs = edges + diagonals
mass = 1.0 * len(mesh.Vertices)
left = len(once)
twice = total - left
drawn = volume(mesh)
fallen = start - bottoms[0]
near = next(i for i in range(len(bottoms) - 2) if bottoms[i + 2] - 2 * bottoms[i + 1] + bottoms[i] > 0.0) + 2
(p, q, r), (s, t, u) = bottoms[near - 3 : near], when[near - 3 : near]
contact = s * q * r / (p - q) / (p - r) + t * p * r / (q - p) / (q - r) + u * p * q / (r - p) / (r - q)
told = [[text for text in told if "stable in" in text] for told in (list(fast), list(fast_shell))]
warned = sum(bool(found) for found in told)
shell_step = float(re.search("([0-9.e-]+) s in small", told[1][0]).group(1))
exploded = sum(any(text.startswith("Diverged") for text in found) for found in (fast, fast_shell))
height = 100.0 * tall(end) / tall(mesh)
inside = 100.0 * volume(end) / drawn
height_shell = 100.0 * tall(still) / tall(mesh)
inside_shell = 100.0 * volume(still) / drawn
"""
NAMES = {
    "springs": "springs", "left": "lines left without duplicates", "twice": "duplicate lines", "mass": "mass",
    "drawn": "volume as drawn", "fallen": "fallen after 1 s", "contact": "first contact",
    "shell_step": "critical step, with Shell", "warned": "runs warned of a step of 0.01 s",
    "exploded": "runs that explode with it", "height": "height kept, springs alone",
    "inside": "volume kept, springs alone", "height_shell": "height kept, with Shell",
    "inside_shell": "volume kept, with Shell",
}  # fmt: skip


def definition() -> Definition:
    d = Definition(
        "sphere",
        "Section 9.7: a falling sphere crumples, and keeps its shape with Shell",
        "A mesh sphere falls onto the floor in physical time. With springs on edges and diagonals alone it crumples; "
        "Shell gives it bending stiffness. Set Reset to False and watch; Moments tells how it stands after 8 s.",
    )
    with d.group("Drawn in Rhino", "The mesh in model.3dm beside this file."):
        mesh = d.component("RhinoFile", file=d.text("File", "model.3dm"), layer=d.text("Layer", "sphere"))["meshes"]
        edges = d.component("MeshEdges", mesh=mesh)["edges"]
        diagonals = d.component("Diagonals", mesh=mesh)
        vertices = d.component("MeshVertices", mesh=mesh)
        opposite = d.script("Opposite corners", OPPOSITE, {"mesh": mesh}, ["lines"])
        once = d.component("RemoveDuplicateLines", lines=flat(edges, opposite))
    with d.group("Forces"):
        stiffness = d.slider("Stiffness [N/m]", GIVEN["stiffness"], 100, 10000)
        springs = [
            d.component("Springs", name, connection=lines, stiffness=stiffness)
            for name, lines in (("Edges", edges), ("Diagonals", diagonals))
        ]
        down = d.native("Unit Z", factor=d.slider("Gravity [N]", -GIVEN["weight"], -20, 0, decimals=2))
        gravity = d.component("Unary", "Gravity", point=vertices, force=down)
        shell = d.component("Shell", mesh=mesh, strength=d.slider("Bending stiffness [N m]", GIVEN["shell"], 0, 2000))
        alone, with_shell = flat(*springs, gravity), flat(*springs, gravity, shell)
    with d.group("Motion", "A step of 0.01 s is too large: it is warned of, and the sphere explodes."):
        drag, floor = d.slider("Drag [N s/m]", GIVEN["drag"], 0, 10, decimals=1), d.toggle("Floor", True)
        more: dict[str, Any] = {"drag": drag, "floor": floor}
        settings = d.component(
            "Settings", time_step=d.text("Time step [s]", "0.004"),
            sub_iterations=d.slider("Steps a picture [-]", 5, 1, 50),
            residual=d.text("Residual [-]", "1e-3"), **more,
        )  # fmt: skip
        too_fast = d.component("Settings", "Too fast", time_step=d.text("Too large a step [s]", "0.01"), **more)
        last = d.slider("Last moment [s]", 8, 1, 10, decimals=1)
        series = d.native("Series", start=1.0, step=d.slider("Every [s]", 0.02, 0.01, 0.1, decimals=2), count=21)
        fell, kept, fast, fast_shell = (
            d.component("Moments", name, forces=forces, settings=setting, geometry=mesh, times=times)
            for name, forces, setting, times in (
                ("Springs alone", alone, settings, flat(series, last)), ("With Shell", with_shell, settings, last),
                ("Springs, too fast", alone, too_fast, d.slider("Moment [s]", 1, 0, 8)),
                ("Shell, too fast", with_shell, too_fast, d.slider("Moment, Shell [s]", 1, 0, 8)),
            )
        )  # fmt: skip
    with d.group("Engine"):
        engine = d.component(
            "Engine", forces=with_shell, settings=settings, geometry=mesh, reset=d.toggle("Reset", True)
        )
        d.panel("status", engine["status"])
    with d.group("Numbers", "What expected.json holds it to."):
        counts = {
            name: d.native("List Length", list=given) for name, given in (("edges", edges), ("diagonals", diagonals))
        }
        total = d.native("List Length", list=flat(edges, opposite))
        trees = {"fell": fell["geometry"], "kept": kept["geometry"]}
        lists = {"once": once, "times": fell["times"], "fast": fast["report"], "fast_shell": fast_shell["report"]}
        d.numbers(
            SHAPE + NUMBERS, {"mesh": mesh, **counts, "total": total, **lists, **trees}, NAMES, lists=list(lists),
            trees=list(trees),
        )  # fmt: skip
        given = {"lines": flat(edges, diagonals), "stiffness": stiffness, "drag": drag}
        d.numbers(STEP, given, {"step": "critical step, springs alone"}, lists=["lines"])
    return d
