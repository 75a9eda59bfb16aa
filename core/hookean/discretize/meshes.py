"""What a mesh is made of: edges, boundary, corners, warp and weft, diagonals, triangles.

Every function takes a `hookean.values.mesh.Mesh`, a rhino3dm Mesh, a COMPAS Mesh or a pair (vertices, faces).
Edges are vertex pairs `(m, 2)`, the lower index first, in order of first appearance round the faces;
`as_mesh(mesh).vertices[edges(mesh)]` are the lines.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.discretize.duplicates import unique_points
from hookean.discretize.triangulate import newell, plane_coordinates, triangulate
from hookean.errors import InputError
from hookean.values.mesh import Mesh

Array = NDArray[np.float64]
Index = NDArray[np.int64]

_FARTHEST = 1e70  # fourth powers of larger lengths overflow


def as_mesh(obj: Any) -> Mesh:
    """Any mesh as a `Mesh`; vertices keep their order, nothing is welded.

    Faces of more than four corners (COMPAS) are cut into triangles by ears, in the plane across
    their vector area. A face that repeats a corner becomes the triangle it is, or is left out where
    fewer than three corners remain. Raises InputError for an unknown type, a vertex that is not
    finite or beyond 1e70, or a face that names no vertex or crosses itself.
    """
    vertices: Any
    faces: Any
    if isinstance(obj, Mesh):
        vertices, faces = obj.vertices, obj.faces
    elif hasattr(obj, "Vertices") and hasattr(obj, "Faces"):
        vertices = np.array([[p.X, p.Y, p.Z] for p in (obj.Vertices[i] for i in range(len(obj.Vertices)))])
        faces = [obj.Faces[i] for i in range(len(obj.Faces))]
    elif hasattr(obj, "to_vertices_and_faces"):
        vertices, faces = obj.to_vertices_and_faces()
    elif isinstance(obj, (tuple, list)) and len(obj) == 2:
        vertices, faces = obj
    elif isinstance(getattr(obj, "vertices", None), np.ndarray) and hasattr(obj, "faces"):
        vertices, faces = obj.vertices, obj.faces
    else:
        raise InputError(
            "mesh", f"{type(obj).__name__} is not a mesh; give a rhino3dm or COMPAS Mesh or (vertices, faces)"
        )
    try:
        points = np.array(vertices, dtype=np.float64)
    except (TypeError, ValueError):
        points = np.zeros(1)
    points = points.reshape(0, 3) if points.shape == (0,) else points
    if points.shape[1:] != (3,):
        raise InputError("mesh/vertices", "they are not numbers of shape (n, 3); give three coordinates for each")
    bad = np.flatnonzero(~np.isfinite(points).all(axis=1))
    if len(bad):
        raise InputError(f"mesh/vertices/{bad[0]}", "it is not finite; give finite coordinates")
    far = np.flatnonzero((np.abs(points) > _FARTHEST).any(axis=1))
    if len(far):
        raise InputError(f"mesh/vertices/{far[0]}", f"a coordinate of it is beyond {_FARTHEST:g}; use larger units")
    return Mesh(points, tidy_faces(_quads(points, faces)))


def vertices(mesh: Any) -> Array:
    """Vertices `(n, 3)` of a mesh, length units."""
    return as_mesh(mesh).vertices


def tidy_faces(faces: Index) -> Index:
    """Faces `(m, 4)` with each collapsed side turned to the end, `(a, b, c, c)`; those without area go.

    A quad with a collapsed side keeps its direction round: the side c-c is the collapsed one, so a-b
    is the side across from it.
    """
    f = faces.copy()
    for side in (0, 1, 3):
        turn = (f[:, side] == f[:, (side + 1) % 4]) & (f[:, 2] != f[:, 3])
        f[turn] = np.roll(f[turn], 2 - side, axis=1)
    a, b, c, d = f.T
    good = (a != b) & (b != c) & (a != c) & (a != d) & (b != d)
    out: Index = f[good]
    return out


def edges(mesh: Any) -> Index:
    """All edges `(m, 2)`, each once."""
    sides, first, _ = _edges(as_mesh(mesh))
    out: Index = sides[first]
    return out


def naked_edges(mesh: Any) -> Index:
    """Boundary edges `(m, 2)`: those of one face only."""
    sides, first, which = _edges(as_mesh(mesh))
    out: Index = sides[first][np.bincount(which[which >= 0], minlength=len(first)) == 1]
    return out


def naked_vertices(mesh: Any) -> Index:
    """Indices `(k,)`, ascending, of the vertices on boundary edges."""
    return np.unique(naked_edges(mesh))


def clothed_vertices(mesh: Any) -> Index:
    """Indices `(k,)`, ascending, of the inner vertices: in a face and on no boundary edge."""
    return boundary(mesh)[1]


def boundary(mesh: Any) -> tuple[Index, Index]:
    """Indices, ascending, of the naked vertices `(k,)`, those on boundary edges, and of the clothed ones within."""
    m = as_mesh(mesh)
    naked = naked_vertices(m)
    return naked, np.setdiff1d(np.unique(m.faces), naked)


def on_boundary(mesh: Any, pairs: Index) -> NDArray[np.bool_]:
    """Whether each of the edges `(k, 2)`, lower index first, is a boundary edge."""
    m = as_mesh(mesh)
    size = len(m.vertices)
    naked = naked_edges(m)
    found: NDArray[np.bool_] = np.isin(pairs[:, 0] * size + pairs[:, 1], naked[:, 0] * size + naked[:, 1])
    return found


def corners(mesh: Any, angle: float = 0.75 * np.pi, order: str = "index") -> Index:
    """Indices `(k,)` of boundary vertices whose inside angle is below `angle` (radians), 135 degrees by default.

    The inside angle is the sum of the angles of the faces that meet there. The order is ascending, or with "boundary"
    as they follow one another along each boundary, in the direction of its faces and from its lowest vertex. Raises
    InputError where `angle` is not a positive number or `order` is another word.
    """
    if not (np.isfinite(angle) and angle > 0):
        raise InputError("angle", f"it is {angle!r}; give a positive angle in radians")
    if order not in ("index", "boundary"):
        raise InputError("order", f'unknown order {order!r}; give "index" or "boundary"')
    m = as_mesh(mesh)
    inside = np.zeros(len(m.vertices))
    for corner, before, after in _corner_triples(m.faces):
        u, v = m.vertices[before] - m.vertices[corner], m.vertices[after] - m.vertices[corner]
        across = np.linalg.norm(np.cross(u, v), axis=1)
        np.add.at(inside, corner, np.arctan2(across, np.einsum("ij,ij->i", u, v)))
    naked = naked_vertices(m) if order == "index" else _along_boundaries(m)
    return naked[inside[naked] < angle]


def _along_boundaries(mesh: Mesh) -> Index:
    """The naked vertices along each boundary, in the direction of its faces and from its lowest vertex."""
    _, first, which = _edges(mesh)
    alone = np.bincount(which[which >= 0], minlength=len(first)) == 1
    beside: dict[int, list[tuple[int, int]]] = {}  # with the direction of the face first
    for start, end in face_sides(mesh.faces).reshape(-1, 2)[(which >= 0) & alone[which]].tolist():
        beside.setdefault(start, []).append((0, end))
        beside.setdefault(end, []).append((1, start))
    found: dict[int, None] = {}
    for vertex in sorted(beside):
        while vertex not in found:
            found[vertex] = None
            vertex = next((other for _, other in sorted(beside[vertex]) if other not in found), vertex)
    return np.fromiter(found, np.int64, len(found))


def diagonals(mesh: Any, pattern: str = "both") -> Index:
    """Diagonals `(k, 2)` of the quads `(a, b, c, d)`, in face order: a-c ("one"), b-d ("other"), or both.

    With "both" each quad gives a-c, then b-d. Triangles have none. Raises InputError for another pattern.
    """
    if pattern not in ("both", "one", "other"):
        raise InputError("pattern", f'unknown pattern {pattern!r}; give "both", "one" or "other"')
    f = as_mesh(mesh).faces
    quads = f[f[:, 2] != f[:, 3]]
    pairs = np.stack([quads[:, [0, 2]], quads[:, [1, 3]]], axis=1)
    take = {"both": slice(0, 2), "one": slice(0, 1), "other": slice(1, 2)}[pattern]
    return np.sort(pairs[:, take].reshape(-1, 2), axis=1)


def triangles(mesh: Any) -> Index:
    """Triangles `(t, 3)` in face order, each quad `(a, b, c, d)` split along its shorter diagonal.

    Equal diagonals split along a-c; equal to 1e-5, for meshes of Rhino have single precision.
    """
    m = as_mesh(mesh)
    a, b, c, d = m.faces.T
    one = np.linalg.norm(m.vertices[c] - m.vertices[a], axis=1)
    other = np.linalg.norm(m.vertices[d] - m.vertices[b], axis=1)
    first = one <= other * (1 + 1e-5)
    two = np.stack([np.stack([a, b, np.where(first, c, d)], 1), np.stack([np.where(first, a, b), c, d], 1)], 1)
    two[c == d, 0] = np.stack([a, b, c], axis=1)[c == d]
    keep = np.ones((len(m.faces), 2), bool)
    keep[c == d, 1] = False
    out: Index = two[keep]
    return out


def weld(mesh: Any, tolerance: float = 1e-6) -> Mesh:
    """The mesh with vertices nearer than `tolerance` (length units) made one; the first wins.

    Faces that lose their area go. Raises InputError for a negative tolerance.
    """
    m = as_mesh(mesh)
    kept, place = unique_points(m.vertices, tolerance)
    return Mesh(m.vertices[kept], tidy_faces(place[m.faces]))


def join(meshes: Iterable[Any], tolerance: float | None = None) -> Mesh:
    """Several meshes as one, in order; welded within `tolerance` (length units) if one is given."""
    parts = [as_mesh(m) for m in meshes]
    starts = np.cumsum([0] + [len(m.vertices) for m in parts])
    whole = Mesh(
        np.concatenate([np.zeros((0, 3))] + [m.vertices for m in parts]),
        np.concatenate([np.zeros((0, 4), np.int64)] + [m.faces + s for m, s in zip(parts, starts, strict=False)]),
    )
    return whole if tolerance is None else weld(whole, tolerance)


def face_sides(faces: Index) -> Index:
    """Sides `(m, 4, 2)` of faces: a-b, b-c, c-d, d-a; the collapsed side of a triangle is c-c."""
    return np.stack([faces, np.roll(faces, -1, axis=1)], axis=2)


def _edges(mesh: Mesh) -> tuple[Index, Index, Index]:
    """All sides in order `(4 m, 2)`; the first place of each edge; the edge of each side, -1 if collapsed."""
    sides = np.sort(face_sides(mesh.faces).reshape(-1, 2), axis=1)
    real = np.flatnonzero(sides[:, 0] != sides[:, 1])
    _, first, inverse = np.unique(
        sides[real, 0] * len(mesh.vertices) + sides[real, 1], return_index=True, return_inverse=True
    )
    rank = np.empty(len(first), np.int64)
    rank[np.argsort(first)] = np.arange(len(first))
    which = np.full(len(sides), -1)
    which[real] = rank[inverse]
    return sides, real[np.sort(first)], which


def _corner_triples(faces: Index) -> Iterable[tuple[Index, Index, Index]]:
    quad = faces[:, 2] != faces[:, 3]
    for k in range(4):
        f = faces[quad]
        yield f[:, k], f[:, k - 1], f[:, (k + 1) % 4]
    for k in range(3):
        t = faces[~quad][:, :3]
        yield t[:, k], t[:, k - 1], t[:, (k + 1) % 3]


def _quads(points: Array, faces: Iterable[Any]) -> Index:
    table = faces if isinstance(faces, np.ndarray) and faces.dtype == np.int64 else np.zeros(0, np.int64)
    if table.shape[1:] == (4,) and table.size and table.min() >= 0 and table.max() < len(points):
        return table.copy()
    if not isinstance(faces, Iterable):
        raise InputError("mesh/faces", f"{type(faces).__name__} is not a list of faces; give the vertices of each")
    rows: list[list[int]] = []
    for number, face in enumerate(faces):
        try:
            given = list(face)
            corner = [int(v) for v in given]
            whole = all(a == b for a, b in zip(corner, given, strict=True))
        except (TypeError, ValueError, OverflowError):
            whole = False
        if not whole:
            raise InputError(f"mesh/faces/{number}", "it is not a list of whole numbers; give its vertices")
        if len(corner) < 3 or min(corner) < 0 or max(corner) >= len(points):
            raise InputError(
                f"mesh/faces/{number}", f"{corner} must name 3 or more of the {len(points)} vertices, counted from 0"
            )
        if len(corner) <= 4:
            rows.append(corner if len(corner) == 4 else [*corner, corner[2]])
            continue
        loop = np.array(corner)
        area = newell(points[loop])
        if not area.any():
            raise InputError(f"mesh/faces/{number}", "it has zero area; remove it")
        cut = triangulate(plane_coordinates(points, area), [loop])
        rows.extend([a, b, c, c] for a, b, c in cut.tolist())
    return np.array(rows, dtype=np.int64).reshape(-1, 4)
