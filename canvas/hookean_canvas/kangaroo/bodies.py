"""Scripts of the import for rigid bodies: their points, and the corners of solids that touch."""

from __future__ import annotations

from hookean_canvas.definitions.containers import Slot
from hookean_canvas.kangaroo.recipe import Recipe

BODIES = '''"""Points of each body in a branch: vertices of its mesh, what moves with it, the origin of its frame."""

from hookean_client import canvas


def nth(rows, number):
    return rows[min(number, len(rows) - 1)] if rows else []


def middle(mesh):
    """The centroid of a closed mesh; of one without volume, or of no faces, the mean of its vertices."""
    vertices, whole = mesh["vertices"], 0.0
    mean = [sum(column) / len(column) for column in zip(*vertices)]
    moment, size = [0.0, 0.0, 0.0], max(max(column) - min(column) for column in zip(*vertices))
    for a, b, c, d in mesh["faces"]:
        for corners in ((a, b, c), (a, c, d)):
            p, q, r = ([x - m for x, m in zip(vertices[corner], mean)] for corner in corners)
            part = p[0] * (q[1] * r[2] - q[2] * r[1]) + p[1] * (q[2] * r[0] - q[0] * r[2])
            part += p[2] * (q[0] * r[1] - q[1] * r[0])
            whole += part
            moment = [m + part * (x + y + z) / 4.0 for m, x, y, z in zip(moment, p, q, r)]
    if abs(whole) <= 1e-9 * size**3:
        return mean
    return [x + m / whole for x, m in zip(mean, moment)]


frames = [canvas.geometry.to_point([p.Origin.X, p.Origin.Y, p.Origin.Z]) for p in canvas.listed(frames_)]
extra = [[item for item in items if item is not None] for _, items in canvas.geometry.branches(points_)]
bodies, middles = [], []
for number, (path, items) in enumerate(canvas.geometry.branches(meshes_)):
    middles.append((path, []))
    for place, item in enumerate(items):
        mesh = canvas.geometry.mesh(item)
        corners = [canvas.geometry.to_point(one) for one in mesh["vertices"]]
        bodies.append(("%s;%d}" % (path.rstrip("}"), place), corners + nth(extra, number)))
        middles[-1][1].append(canvas.geometry.to_point(middle(mesh)))
if not bodies:
    bodies = list(zip([path for path, _ in canvas.geometry.branches(points_)], extra))
# a body without a frame has one at its centroid, along the axes of the world, as a point stands for
origins = frames or [place for _, items in middles for place in items]
rows = [(path, body + [nth(origins, i)] * bool(origins)) for i, (path, body) in enumerate(bodies)]
points = canvas.geometry.to_tree(rows)
planes = frames_ if frames else canvas.geometry.to_tree(middles)
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


def nth(frames, number):
    return frames[min(number, len(frames) - 1)] if frames else None


points, numbers, carriers, carried = [], [], [], []
given, more = canvas.listed(_meshes), canvas.listed(others_)
frames = [nth(canvas.listed(planes_), i) for i in range(len(given))]
frames += [nth(canvas.listed(planes_of_others_), i) for i in range(len(more))]
for number, (item, frame) in enumerate(zip(given + more, frames)):
    for place in corners_of(canvas.geometry.mesh(item)):
        points.append(canvas.geometry.to_point(place))
        numbers.append(number)
        if frame is not None:
            carriers.append(frame.Origin)
            carried.append(points[-1])
'''
CARRIED = '''"""Points of each body, with those that goals give together with the body's plane."""

from hookean_client import canvas


def distance(p, q):
    return sum((a - b) ** 2 for a, b in zip(p, q)) ** 0.5


frames = [[p.Origin.X, p.Origin.Y, p.Origin.Z] for p in canvas.listed(planes_)]
rows = [(path, canvas.geometry.points(items)) for path, items in canvas.geometry.branches(_points)]
everything = [place for _, body in rows for place in body] or [[0.0, 0.0, 0.0]]
reach = max(max(column) - min(column) for column in zip(*everything))
for carrier, place in zip(canvas.geometry.points(_carriers), canvas.geometry.points(_carried)):
    for number, (_, body) in enumerate(rows if frames else ()):
        if distance(frames[min(number, len(frames) - 1)], carrier) <= 1e-6 * reach:
            if all(distance(place, other) > 1e-9 * reach for other in body):
                body.append(place)
            break
points = canvas.geometry.to_tree([(path, [canvas.geometry.to_point(p) for p in body]) for path, body in rows])
'''
HELPERS = {
    "*carried": Recipe(
        "Carried Points",
        "Carried",
        "Points of bodies with those that goals join",
        CARRIED,
        (
            Slot("_points", "Points of each body", 2),
            Slot("planes_", "Their planes", 1, "plane"),
            Slot("_carriers", "Origin of the plane of the body of each point", 1, "point"),
            Slot("_carried", "Points that move with bodies", 1, "point"),
        ),
        (Slot("points", "Points of each body"),),
    ),
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
        (
            Slot("_meshes", "Meshes", 1, "mesh"),
            Slot("others_", "Other meshes", 1, "mesh"),
            Slot("planes_", "Planes of their bodies", 1, "plane"),
            Slot("planes_of_others_", "Planes of the bodies of the others", 1, "plane"),
        ),
        (
            Slot("points", "Corners"),
            Slot("numbers", "Number of the mesh of each"),
            Slot("carriers", "Origins of the planes of their bodies"),
            Slot("carried", "Corners that move with these"),
        ),
    ),
}
TOLD = {"*bodies": "a script for points", "*solids": "a script for corners"}
"""What the scripts are called in the table of the documentation."""
