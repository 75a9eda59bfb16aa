"""Natives of the tab Mesh that take meshes apart and change them; components of MeshEdit, by name.

Colours are not kept: they only show.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import KDTree

from hookean_canvas.run.natives import shapes
from hookean_canvas.run.natives.declare import Unfit, bounded, native
from hookean_canvas.run.natives.meshes import MeshPlace, _compact, edges, normals, vertex_normals
from hookean_canvas.run.natives.shapes import Array, Faces

_MESH = "Mesh (M): mesh"


@native("b2dc090f-b022-4264-8889-87e22979336e", "Mesh Eval", "MEval", f"{_MESH}; Parameter (P): any",
        "Point (P); Normal (N); Colour (C)", remark="colours are null")  # fmt: skip
def mesh_eval(mesh: Any, parameter: Any) -> tuple[Any, Any, None]:
    """The point of a mesh parameter and the normal there, between those of the vertices of its face."""
    if not isinstance(parameter, MeshPlace):
        raise Unfit("Parameter is not of Mesh Closest Point")
    vertices, faces = shapes.mesh_parts(mesh)
    at = np.array(parameter.place)
    face = faces[parameter.face]
    ways = vertex_normals(vertices, faces)
    best: tuple[float, Array] | None = None
    for k in range(1, len(face) - 1):
        rows = [face[0], face[k], face[k + 1]]
        a, b, c = vertices[rows]
        weights, _, _, _ = np.linalg.lstsq(np.array([b - a, c - a]).T, at - a, rcond=None)
        w = np.array([1.0 - weights.sum(), *weights])
        if best is None or -float(w.min()) < best[0]:
            best = -float(w.min()), w @ ways[rows]
    return shapes.point(at), shapes.vector(shapes.unit(best[1] if best else ways[face[0]])), None


@native("", "Face Circles", "FaceC", _MESH, "Center (C): list; Ratio (R): list")
def face_circles(mesh: Any) -> tuple[list[Any], list[float]]:
    """The centre of the circle round each triangle, and the ratio of the circle's radius to the longest side; quads are
    null."""
    vertices, faces = shapes.mesh_parts(mesh)
    centres: list[Any] = []
    ratios: list[Any] = []
    for face in faces:
        p, q = vertices[face[1]] - vertices[face[0]], vertices[face[2]] - vertices[face[0]]
        normal = np.cross(p, q)
        square = float(normal @ normal)
        if len(face) > 3 or square == 0.0:
            centres.append(None)
            ratios.append(None)
            continue
        to = (float(q @ q) * np.cross(normal, p) + float(p @ p) * np.cross(q, normal)) / (2.0 * square)
        centres.append(shapes.point(vertices[face[0]] + to))
        longest = max(float(np.linalg.norm(one)) for one in (p, q, q - p))
        ratios.append(float(np.linalg.norm(to)) / longest)
    return centres, ratios


@native("76f85ee4-5a88-4511-8ba7-30df07e50533", "Mesh Sphere Ex", "MSphereEx",
        "Base (B): plane; Radius (R): number = 1.0; Count (C): integer = 10", "Mesh (M)")  # fmt: skip
def mesh_sphere_ex(frame: Any, radius: float, count: int) -> Any:
    """A sphere of six square patches of quads, which are equal angles wide along the middle of each."""
    if radius <= 0.0 or count < 1:
        raise Unfit("Radius must be above 0, and Count at least 1")
    bounded(6 * count * count)
    turns = np.tan(np.linspace(-0.25 * np.pi, 0.25 * np.pi, count + 1))
    u, v = (one.ravel() for one in np.meshgrid(turns, turns, indexing="ij"))
    one = np.ones_like(u)
    sides = [(one, u, v), (-one, -u, v), (-u, one, v), (u, -one, v), (-v, u, one), (v, u, -one)]
    rows = np.concatenate([np.column_stack(side) for side in sides])
    rows *= radius / np.linalg.norm(rows, axis=1)[:, None]
    quads = [(i * (count + 1) + j, (i + 1) * (count + 1) + j) for i in range(count) for j in range(count)]
    faces = [tuple(int(f) * (count + 1) ** 2 + k for k in (a, b, b + 1, a + 1)) for f in range(6) for a, b in quads]
    _, first, which = np.unique(np.round(rows / radius, 9), axis=0, return_index=True, return_inverse=True)
    which = which.ravel()
    made = [tuple(int(which[k]) for k in face) for face in faces]
    return shapes.mesh(shapes.in_plane(frame, rows[first]), made)


@native("9266a2bb-918f-4675-9c91-f67d0dd33eac", "Quadrangulate", "Quad",
        f"{_MESH}; Angle (A): number = 0.0349; Ratio (R): number = 0.875", "Mesh (M); Count (N)",
        remark="which triangles become quads first may differ")  # fmt: skip
def quadrangulate(mesh: Any, angle: float, ratio: float) -> tuple[Any, int]:
    """Quads of pairs of triangles within an angle of each other whose diagonals differ by no more than a ratio, those
    with the most equal diagonals first."""
    vertices, faces = shapes.mesh_parts(mesh)
    ways = normals(vertices, faces)
    found = []
    for (i, j), beside in edges(vertices, faces).items():
        if len(beside) != 2 or any(len(faces[k]) != 3 for k in beside):
            continue
        a, b = beside
        if float(ways[a] @ ways[b]) < np.cos(angle) - 1e-12:
            continue
        tips = [next(k for k in faces[f] if not _in(vertices, k, (i, j))) for f in beside]
        diagonals = sorted(float(np.linalg.norm(vertices[p] - vertices[q])) for p, q in ((i, j), tips))
        if diagonals[1] > 0.0 and diagonals[0] / diagonals[1] >= ratio:
            found.append((-diagonals[0] / diagonals[1], a, b, tips))
    used: set[int] = set()
    quads: Faces = []
    for _, a, b, tips in sorted(found, key=lambda row: row[:3]):
        if not {a, b} & used:
            used |= {a, b}
            k = faces[a].index(tips[0])
            quads.append((faces[a][k], faces[a][(k + 1) % 3], tips[1], faces[a][(k + 2) % 3]))
    kept = [face for k, face in enumerate(faces) if k not in used]
    return shapes.mesh(vertices, [*kept, *quads]), len(used)


def _in(vertices: Array, k: int, ends: tuple[int, int]) -> bool:
    """Whether a vertex is one of two, or in the place of one."""
    return k in ends or any(np.array_equal(vertices[k], vertices[end]) for end in ends)


@native("db661dd7-63a4-44c6-91f2-6faab2471383", "Align Vertices", "AlignVert", f"{_MESH}; Distance (T): number",
        "Mesh (R); Count (N)")  # fmt: skip
def align_vertices(mesh: Any, distance: float) -> tuple[Any, int]:
    """A mesh with vertices within a distance of each other moved to their middle, and how many moved."""
    vertices, faces = shapes.mesh_parts(mesh)
    pairs = KDTree(vertices).query_pairs(max(distance, 0.0), output_type="ndarray")
    net = coo_array((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(len(vertices), len(vertices)))
    count, group = connected_components(net, directed=False)
    members = np.bincount(group, minlength=count)
    sums = np.stack([np.bincount(group, column, minlength=count) for column in vertices.T], axis=1)
    rows = np.where((members[group] > 1)[:, None], (sums / members[:, None])[group], vertices)
    moved = int((np.abs(rows - vertices).max(axis=1) > 0.0).sum())
    return shapes.mesh(rows, faces), moved


def _without(mesh: Any, gone: set[int], shrink: bool) -> Any:
    """A mesh without vertices; quads that lose one become triangles with `shrink`, other faces go."""
    vertices, faces = shapes.mesh_parts(mesh)
    left = [tuple(k for k in face if k not in gone) for face in faces]
    kept = [
        new for new, face in zip(left, faces, strict=True) if len(new) == len(face) or (shrink and len(new) == 3)
    ]  # fmt: skip
    if not kept:
        raise Unfit("no face is left")
    return _compact(vertices, kept)


@native("23d715f7-4bc6-4e69-b76d-7c04ca2ebf5f", "Delete Vertices", "DeleteV",
        f"{_MESH}; Indices (I): integer list; Shrink (S): boolean = True", "Mesh (M)")  # fmt: skip
def delete_vertices(mesh: Any, indices: list[int], shrink: bool) -> Any:
    """A mesh without vertices of some numbers, and without their faces."""
    return _without(mesh, set(indices), shrink)


@native("9d50bf9b-46bc-403a-9ec9-1052f51dd6b6", "Cull Vertices", "CullV",
        f"{_MESH}; Pattern (P): boolean list; Shrink (S): boolean = True", "Mesh (M)")  # fmt: skip
def cull_vertices(mesh: Any, pattern: list[bool], shrink: bool) -> Any:
    """A mesh without the vertices for which a repeated pattern is False, and without their faces."""
    count = len(mesh.Vertices)
    if not pattern:
        raise Unfit("the pattern is empty")
    return _without(mesh, {k for k in range(count) if not pattern[k % len(pattern)]}, shrink)


@native("edcf10e1-02a0-48a4-ae2d-70c50d903dc8", "Mesh Spray", "MSpray",
        f"{_MESH}; Points (P): point list optional; Colours (C): any list optional", "Mesh (M)")  # fmt: skip
def mesh_spray(mesh: Any, places: Any, colours: Any) -> Any:
    """A mesh as it is: colours only show."""
    return mesh


@native("48a9fa10-8d3c-4767-aca6-81232271f6e0", "Blur Mesh", "MBlur", f"{_MESH}; Iterations (I): integer = 1",
        "Mesh (M)")  # fmt: skip
def blur_mesh(mesh: Any, rounds: int) -> Any:
    """A mesh as it is: colours only show."""
    return mesh


@native("330eb9c9-0098-4375-9078-e00a419d49fb", "Mesh Split Plane", "MSplit", f"{_MESH}; Plane (P): plane",
        "Above (A): list; Below (B): list")  # fmt: skip
def mesh_split_plane(mesh: Any, frame: Any) -> tuple[list[Any], list[Any]]:
    """The parts of a mesh above a plane and below it, each as one mesh; faces that it cuts become triangles."""
    vertices, faces = shapes.mesh_parts(mesh)
    heights = shapes.coordinates(frame, vertices)[:, 2]
    heights[np.abs(heights) <= 1e-12 * max(float(np.abs(heights).max()), 1e-300)] = 0.0
    rows: list[Array] = list(vertices)
    cuts: dict[tuple[int, int], int] = {}

    def cut(i: int, j: int) -> int:
        key = min(i, j), max(i, j)
        if key not in cuts:
            t = heights[key[0]] / (heights[key[0]] - heights[key[1]])
            cuts[key] = len(rows)
            rows.append(vertices[key[0]] + t * (vertices[key[1]] - vertices[key[0]]))
        return cuts[key]

    sides: tuple[Faces, Faces] = ([], [])
    for face in faces:
        signs = np.sign(heights[list(face)])
        if not ((signs > 0).any() and (signs < 0).any()):
            sides[0 if (signs > 0).any() or not (signs < 0).any() else 1].append(face)
            continue
        for k in range(1, len(face) - 1):
            for part, side in _halves((face[0], face[k], face[k + 1]), heights, cut):
                sides[side].append(part)
    made = np.array(rows)
    above, below = ([_compact(made, side)] if side else [] for side in sides)
    return above, below


def _halves(face: tuple[int, int, int], heights: Array, cut: Any) -> list[tuple[tuple[int, ...], int]]:
    """The parts of a triangle on both sides of height 0, each with 0 for above and 1 for below."""
    found = []
    for side, sign in ((0, 1.0), (1, -1.0)):
        ring: list[int] = []
        for i, j in zip(face, (*face[1:], face[0]), strict=True):
            if sign * heights[i] >= 0.0:
                ring.append(i)
            if heights[i] * heights[j] < 0.0:
                ring.append(cut(i, j))
        if len(ring) > 2 and any(sign * heights[k] > 0.0 for k in face):
            found.append((tuple(ring[:4]), side))
    return found


@native("", "Mesh Explode", "Explode", _MESH, "Faces (F): list", plugin=True)
def mesh_explode(mesh: Any) -> list[Any]:
    """Each face as a mesh of its own."""
    vertices, faces = shapes.mesh_parts(mesh)
    bounded(len(faces))
    return [shapes.mesh(vertices[list(face)], [tuple(range(len(face)))]) for face in faces]


@native("", "Mesh WeldVertices", "WeldVertices", f"{_MESH}; Tolerance (T): number = 0.01", "Mesh (M)", plugin=True)
def weld_vertices(mesh: Any, tolerance: float) -> Any:
    """Vertices within a tolerance of each other made one."""
    moved, _ = align_vertices(mesh, tolerance)
    vertices, faces = shapes.mesh_parts(moved)
    size = float(np.ptp(vertices, axis=0).max()) or 1.0
    _, first, which = np.unique(np.round(vertices / size, 12), axis=0, return_index=True, return_inverse=True)
    order = np.argsort(first)
    place = np.empty_like(order)
    place[order] = np.arange(len(order))
    new = [tuple(dict.fromkeys(int(place[which.ravel()[k]]) for k in face)) for face in faces]
    return shapes.mesh(vertices[first[order]], [face for face in new if len(face) > 2])


@native("", "Mesh CullUnused Vertices", "CullUnused", _MESH, "Mesh (M)", plugin=True)
def cull_unused(mesh: Any) -> Any:
    """A mesh without vertices that no face has."""
    return _compact(*shapes.mesh_parts(mesh))
