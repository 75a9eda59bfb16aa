"""Scripts of the import for rigid bodies: their points, and the corners of solids that touch."""

from __future__ import annotations

from hookean_canvas.definitions.containers import Slot
from hookean_canvas.kangaroo.recipe import Recipe

BODIES = '''"""Points of each body in a branch: vertices of its mesh, what moves with it, the origin of its frame."""

from hookean_client import canvas


def nth(rows, number):
    return rows[min(number, len(rows) - 1)] if rows else []


frames = [canvas.geometry.to_point([p.Origin.X, p.Origin.Y, p.Origin.Z]) for p in canvas.listed(frames_)]
extra = [[item for item in items if item is not None] for _, items in canvas.geometry.branches(points_)]
bodies = []
for number, (path, items) in enumerate(canvas.geometry.branches(meshes_)):
    for place, item in enumerate(items):
        corners = [canvas.geometry.to_point(one) for one in canvas.geometry.mesh(item)["vertices"]]
        bodies.append(("%s;%d}" % (path.rstrip("}"), place), corners + nth(extra, number)))
if not bodies:
    bodies = list(zip([path for path, _ in canvas.geometry.branches(points_)], extra))
origins = [nth(frames, number) for number in range(len(bodies))]
rows = [(path, body + ([origin] if origin else [])) for (path, body), origin in zip(bodies, origins)]
points = canvas.geometry.to_tree(rows)
planes = frames_
'''
SOLIDS = '''"""The corners of meshes, and the number of the mesh of each."""

from hookean_client import canvas


def corners_of(mesh):
    """Vertices where faces of three directions meet; all, where there are fewer than four."""
    vertices, found = mesh["vertices"], {}
    size = max(max(column) - min(column) for column in zip(*vertices)) or 1.0
    for face in mesh["faces"]:
        p, q, r, s = [vertices[face[i % len(face)]] for i in range(4)]
        u, v = [b - a for a, b in zip(p, r)], [b - a for a, b in zip(q, s)]
        if len(face) == 3:
            v = [b - a for a, b in zip(p, q)]
        n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
        length = sum(c * c for c in n) ** 0.5
        for number in face if length > 0.0 else ():
            at = tuple(int(round(c / size * 1e6)) for c in vertices[number])
            ways = found.setdefault(at, (vertices[number], []))[1]
            if all(abs(sum(a * b for a, b in zip(n, way))) < (1.0 - 1e-6) * length for way in ways):
                ways.append([c / length for c in n])
    sharp = [place for place, ways in found.values() if len(ways) > 2]
    return sorted(sharp) if len(sharp) > 3 else vertices


points, numbers = [], []
for number, item in enumerate(canvas.listed(_meshes) + canvas.listed(others_)):
    for place in corners_of(canvas.geometry.mesh(item)):
        points.append(canvas.geometry.to_point(place))
        numbers.append(number)
'''
HELPERS = {
    "*bodies": Recipe(
        "Bodies",
        "Bodies",
        "Points of bodies",
        BODIES,
        (
            Slot("meshes_", "Meshes, one for each body", 2),
            Slot("points_", "Points that move with them", 2),
            Slot("frames_", "Planes, one for each body, whose origins move with it", 2),
        ),
        (Slot("points", "Points of each body"), Slot("planes", "The planes")),
    ),
    "*solids": Recipe(
        "Solids",
        "Solids",
        "Corners of meshes by their bodies",
        SOLIDS,
        (Slot("_meshes", "Meshes", 1, "mesh"), Slot("others_", "Other meshes", 1, "mesh")),
        (Slot("points", "Corners"), Slot("numbers", "Number of the mesh of each")),
    ),
}
TOLD = {"*bodies": "a script for points", "*solids": "a script for corners"}
"""What the scripts are called in the table of the documentation."""
