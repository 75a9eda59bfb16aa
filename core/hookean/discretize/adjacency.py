"""What lies beside what in a mesh: faces in two colours, hinges between triangles, neighbours of vertices."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hookean.discretize.duplicates import _checked
from hookean.discretize.meshes import _edges, as_mesh, triangles
from hookean.errors import InputError
from hookean.values.mesh import Mesh

Array = NDArray[np.float64]
Index = NDArray[np.int64]

_FLAT = 1e-8  # triangles lower than this part of their size have no normal, as for the force `hinge`


def checkerboard(mesh: Any, strict: bool = True) -> tuple[NDArray[np.bool_], Index, Index]:
    """Faces in two colours, no two beside each other alike: whether each is of the second, and the indices of both.

    The first face of each connected part has the first colour; the others follow over shared edges, breadth first.
    Such colours exist where no chain of neighbours returns to its start after an odd number of faces: elsewhere
    InputError names two faces; with `strict=False` each keeps the colour that reaches it first.
    """
    m = as_mesh(mesh)
    beside = _neighbours(m)
    second = np.zeros(len(m.faces), bool)
    seen = np.zeros(len(m.faces), bool)
    for seed in range(len(m.faces)):
        queue = deque([] if seen[seed] else [seed])
        seen[seed] = True
        while queue:
            face = queue.popleft()
            for other in beside[face]:
                if not seen[other]:
                    seen[other], second[other] = True, not second[face]
                    queue.append(other)
    for face, others in enumerate(beside) if strict else ():
        for other in others:
            if second[other] == second[face]:
                raise InputError(
                    f"mesh/faces/{face}",
                    f"two colours cannot separate this face from face {other}; an inner vertex with an odd number of "
                    "faces prevents it: remesh there, or pass strict=False",
                )
    return second, np.flatnonzero(~second), np.flatnonzero(second)


def hinge_points(mesh: Any) -> tuple[Index, Index, Index, Index]:
    """Vertices of the hinges of a mesh, `(k,)` each: fold start, fold end, tip 1, tip 2, the inputs of `hinge`.

    A hinge is an edge that two triangles share, start-end-tip 1 and end-start-tip 2, in the order of `edges`; quads
    are cut along their shorter diagonal, which is a hinge too. Raises InputError where an edge has more than two
    triangles.
    """
    m = as_mesh(mesh)
    t = triangles(m)
    left, right = sides_of_edges(Mesh(m.vertices, np.c_[t, t[:, 2]]))
    inner = right[:, 0] >= 0
    left, right = left[inner], right[inner]
    (face, side), (other, across) = left.T, right.T
    corner = np.where(side == 3, 2, side)  # the side c-a of a triangle (a, b, c, c) is its fourth
    beyond = np.where(across == 3, 2, across)
    start, end = t[face, corner], t[face, (corner + 1) % 3]
    return start, end, t[face, (corner + 2) % 3], t[other, (beyond + 2) % 3]


def fold_angle(points: ArrayLike, end: ArrayLike, tip_1: ArrayLike, tip_2: ArrayLike) -> Array:
    """Signed angles `(n,)` [rad] between the triangles start-end-tip 1 and end-start-tip 2, from -pi to pi.

    0 where flat, positive where the tips rise to the side of (end - start) x (tip 1 - start):
    atan2(|e| N2 . (tip 1 - start), N1 . N2) with e = end - start, N1 = e x (tip 1 - start) and
    N2 = (tip 2 - start) x e, as for the force `hinge`. `points` are the starts; all are `(n, 3)`, and one point counts
    for all rows. Raises InputError for other shapes, or a triangle without area.
    """
    given = {"points": points, "end": end, "tip_1": tip_1, "tip_2": tip_2}
    rows = {name: _checked(name, np.atleast_2d(np.asarray(value, float)), (3,)) for name, value in given.items()}
    count = max(map(len, rows.values()))
    for name, row in rows.items():
        if len(row) not in (1, count):
            raise InputError(name, f"it has {len(row)} points, and another has {count}; give the same number of each")
    a, b, c, d = np.broadcast_arrays(*rows.values())
    e, p, q = b - a, c - a, d - a
    first, second = np.cross(e, p), np.cross(q, e)
    for name, normal, side in (("tip_1", first, p), ("tip_2", second, q)):
        size = (e * e + side * side).sum(axis=1)
        flat = np.flatnonzero(~(np.linalg.norm(normal, axis=1) > _FLAT * size))
        if len(flat):
            raise InputError(f"{name}/{flat[0]}", "its triangle has no area; move the tip off the line of the fold")
    out: Array = np.arctan2(np.linalg.norm(e, axis=1) * (second * p).sum(axis=1), (first * second).sum(axis=1))
    return out


def vertex_neighbours(mesh: Any, vertices: Iterable[int] = ()) -> tuple[list[Index], Array]:
    """The neighbours of vertices (none: of all), and unit normals `(k, 3)` there.

    Neighbours are the vertices at the other ends of edges, counter-clockwise about the normal; at a boundary from its
    one edge to its other. The normal is that of the sum of the vector areas at the vertex, zero where they cancel.
    Raises InputError for a vertex that the mesh does not have.
    """
    m = as_mesh(mesh)
    try:
        wanted = np.asarray(list(vertices), dtype=np.int64).ravel()
    except (TypeError, ValueError, OverflowError):
        raise InputError("vertices", "they are not whole numbers; give numbers of vertices, counted from 0") from None
    wanted = wanted if len(wanted) else np.arange(len(m.vertices))
    bad = np.flatnonzero((wanted < 0) | (wanted >= len(m.vertices)))
    if len(bad):
        said = f"vertex {wanted[bad[0]]} does not exist; the mesh has {len(m.vertices)}, counted from 0"
        raise InputError(f"vertices/{bad[0]}", said)
    after: list[dict[int, int]] = [{} for _ in range(len(m.vertices))]
    beside: list[set[int]] = [set() for _ in range(len(m.vertices))]
    for face in m.faces.tolist():
        loop = face[:3] if face[2] == face[3] else face
        for i, vertex in enumerate(loop):
            onward, back = loop[(i + 1) % len(loop)], loop[i - 1]
            after[vertex].setdefault(onward, back)
            beside[vertex] |= {onward, back}
    rings = [_ring(after[v], beside[v]) for v in wanted.tolist()]
    normals = vertex_normals(m)[wanted]
    return rings, normals


def vertex_normals(mesh: Mesh) -> Array:
    """Unit normals `(n, 3)` of the sums of the vector areas of the faces at each vertex; zero where they cancel."""
    a, b, c, d = mesh.vertices[mesh.faces].transpose(1, 0, 2)
    area = np.cross(c - a, d - b)  # twice the vector area, of (a, b, c, c) too
    sums = np.zeros_like(mesh.vertices)
    for k in range(4):
        real = slice(None) if k < 3 else mesh.faces[:, 2] != mesh.faces[:, 3]
        np.add.at(sums, mesh.faces[real, k], area[real])
    size = np.linalg.norm(sums, axis=1, keepdims=True)
    out: Array = np.divide(sums, size, out=np.zeros_like(sums), where=size > 0.0)
    return out


def sides_of_edges(mesh: Mesh) -> tuple[Index, Index]:
    """Of each edge, in the order of `edges`, its first face and side `(m, 2)`, and the other ones, -1 if none.

    Raises InputError where an edge has more than two faces.
    """
    _, first, which = _edges(mesh)
    order = np.argsort(which, kind="stable")
    order = order[np.searchsorted(which[order], 0) :]
    count = np.bincount(which[order], minlength=len(first))
    if (count > 2).any():
        edge = int(np.flatnonzero(count > 2)[0])
        face = int(first[edge]) // 4
        raise InputError(f"mesh/faces/{face}", f"an edge of it has {count[edge]} faces; an edge may have two at most")
    start = np.cumsum(count) - count
    other = np.full(len(first), -1)
    other[count == 2] = order[start[count == 2] + 1]
    right = np.stack([np.where(other < 0, -1, other // 4), np.where(other < 0, -1, other % 4)], axis=1)
    return np.stack([first // 4, first % 4], axis=1), right


def _neighbours(mesh: Mesh) -> list[list[int]]:
    """The faces beside each face, over edges of any number of faces."""
    _, first, which = _edges(mesh)
    faces: list[list[int]] = [[] for _ in range(len(first))]
    for side, edge in enumerate(which.tolist()):
        if edge >= 0:
            faces[edge].append(side // 4)
    found: list[list[int]] = [[] for _ in range(len(mesh.faces))]
    for group in faces:
        for face in group:
            found[face] += [other for other in group if other != face]
    return found


def _ring(after: dict[int, int], beside: set[int]) -> Index:
    """Neighbours in order: chains from those that follow no other, then closed rings, from the lowest index."""
    followers = set(after.values())
    starts = sorted(set(after) - followers) + sorted(beside)
    found: list[int] = []
    seen: set[int] = set()
    for start in starts:
        at: int | None = start
        while at is not None and at not in seen:
            seen.add(at)
            found.append(at)
            at = after.get(at)
    return np.array(found, dtype=np.int64)
