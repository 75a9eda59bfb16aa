"""Quads with one direction, the strips they make, and strips unrolled into a plane."""

from __future__ import annotations

from collections import deque
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.discretize.adjacency import sides_of_edges
from hookean.discretize.meshes import as_mesh, edges
from hookean.discretize.warpweft import warp_weft
from hookean.errors import InputError
from hookean.values.mesh import Mesh

Array = NDArray[np.float64]
Index = NDArray[np.int64]


def align_quads(mesh: Any, strict: bool = True) -> Mesh:
    """The mesh with the corners of each quad turned round so that quads beside each other have the same direction.

    The direction of a quad is that of its first side, from its first corner to its second. The first face of each
    connected part keeps its own; the others follow over shared edges, breadth first. Triangles stay, and directions do
    not pass them. Raises InputError where an inner vertex has other than four quads, so that no directions agree, or
    neighbours run round in different directions; with `strict=False` each quad takes the direction that reaches it
    first.
    """
    m = as_mesh(mesh)
    left, right = sides_of_edges(m)
    quad = m.faces[:, 2] != m.faces[:, 3]
    shared = (right[:, 0] >= 0) & quad[left[:, 0]] & quad[right[:, 0]]
    beside: list[list[tuple[int, int, int]]] = [[] for _ in m.faces]
    for (a, i), (b, j) in zip(left[shared].tolist(), right[shared].tolist(), strict=True):
        beside[a].append((b, i, j))
        beside[b].append((a, j, i))
    turns = np.full(len(m.faces), -1)
    for seed in range(len(m.faces)):
        queue = deque([seed] if turns[seed] < 0 else [])
        turns[seed] = max(turns[seed], 0)
        while queue:
            face = queue.popleft()
            for other, own, there in beside[face]:
                wanted = (there - own + turns[face] + 2) % 4  # opposite sides follow each other
                if turns[other] < 0:
                    turns[other] = wanted
                    queue.append(other)
                elif strict and turns[other] != wanted:
                    said = f"its direction cannot agree with that of face {other}; an inner vertex without four quads, "
                    said += "or a face that runs round the other way, prevents it: mend it, or pass strict=False"
                    raise InputError(f"mesh/faces/{face}", said)
    return Mesh(m.vertices, _rolled(m.faces, turns, quad))


def turn_quads(mesh: Any, turns: int = 1) -> Mesh:
    """The mesh with the direction of each quad turned by a number of right angles: its second side becomes the first.
    Triangles stay."""
    m = as_mesh(mesh)
    if isinstance(turns, bool) or int(turns) != turns:
        raise InputError("turns", f"{turns!r} given; give a whole number")
    quad = m.faces[:, 2] != m.faces[:, 3]
    return Mesh(m.vertices, _rolled(m.faces, np.full(len(m.faces), int(turns) % 4), quad))


def strips(mesh: Any, direction: str = "warp") -> Index:
    """The number of the strip of each face `(m,)`, from 0 in the order of their first faces.

    Faces are in one strip where they share an edge of the family `direction`, "warp" or "weft", of `warp_weft`: the
    rungs of a ladder. Raises InputError as `warp_weft` does, and for another direction.
    """
    m = as_mesh(mesh)
    number = np.full(len(m.faces), -1)
    for count, chain in enumerate(_chains(m, direction)):
        number[[face for face, _, _ in chain]] = count
    return number


def unroll_strips(mesh: Any, direction: str = "warp", gap: float = 0.0) -> Mesh:
    """The strips of a mesh (see `strips`) laid out in the plane z = 0, one above the other.

    Each face keeps its place in the list of faces and the lengths of its sides, and of a quad the shorter diagonal, on
    which it is folded flat; each strip has vertices of its own. A strip begins with its first rung on the y axis and
    runs along x; a closed one is cut at a rung. `gap` [length] is left between strips. The distances of vertices that
    share a triangle stay, so a strip of a developable surface keeps its shape. Raises InputError as `strips` does, for
    faces without area along a strip, and for neighbours that run round in different directions.
    """
    m = as_mesh(mesh)
    if not (np.isfinite(gap) and gap >= 0.0):
        raise InputError("gap", f"it is {gap!r}; give a length of at least 0")
    faces, vertices, count, base = np.zeros_like(m.faces), [], 0, 0.0
    for chain in _chains(m, direction):
        flat, corners = _laid(m, chain)
        low, high = flat.min(axis=0), flat.max(axis=0)
        vertices.append(flat + [0.0, base - low[1]])
        base += high[1] - low[1] + gap
        for (face, _, _), own in zip(chain, corners, strict=True):
            faces[face] = np.array(own) + count
        count += len(flat)
    plane = np.concatenate(vertices) if vertices else np.zeros((0, 2))
    return Mesh(np.column_stack([plane, np.zeros(len(plane))]), faces)


def _rolled(faces: Index, turns: Index, quad: NDArray[np.bool_]) -> Index:
    at = (np.arange(4) + np.where(quad, turns, 0)[:, None]) % 4
    return np.take_along_axis(faces, at, axis=1)


def _chains(m: Mesh, direction: str) -> list[list[tuple[int, int, int]]]:
    """Strips as lists of faces in order, each with the sides by which it is entered and left, -1 where it is not."""
    if direction not in ("warp", "weft"):
        raise InputError("direction", f'unknown direction {direction!r}; give "warp" or "weft"')
    family = warp_weft(m)[0 if direction == "warp" else 1]
    rung = {tuple(sorted(pair)) for pair in family.tolist()}
    left, right = sides_of_edges(m)
    across: list[dict[int, tuple[int, int]]] = [{} for _ in m.faces]
    for pair, (a, i), (b, j) in zip(edges(m).tolist(), left.tolist(), right.tolist(), strict=True):
        if tuple(sorted(pair)) in rung:
            across[a][i] = (b, j)
            if b >= 0:
                across[b][j] = (a, i)
    seen = np.zeros(len(m.faces), bool)
    found: list[tuple[int, list[tuple[int, int, int]]]] = []
    for seed in range(len(m.faces)):
        if not seen[seed]:
            chain = _chain(seed, across)
            seen[[face for face, _, _ in chain]] = True
            found.append((seed, chain))
    return [chain for _, chain in found]


def _chain(seed: int, across: list[dict[int, tuple[int, int]]]) -> list[tuple[int, int, int]]:
    """The strip of a face from one end, or from the face itself where it is closed."""
    face, entry = seed, min(across[seed], default=-1)
    while entry >= 0:  # back to the end
        before, side = across[face][entry]
        if before < 0 or before == seed:
            break
        rest = [s for s in across[before] if s != side]
        face, entry = before, rest[0] if rest else -1
    start, chain = face, []
    while True:
        rest = [s for s in across[face] if s != entry]
        leave = rest[0] if rest else -1
        chain.append((face, entry, leave))
        after = across[face][leave] if leave >= 0 else (-1, -1)
        if after[0] < 0 or after[0] == start:
            return chain
        face, entry = after


def _laid(m: Mesh, chain: list[tuple[int, int, int]]) -> tuple[Array, list[list[int]]]:
    """Vertices (k, 2) of a strip in the plane, and of each face its corners among them."""
    flat: list[Array] = []
    corners: list[list[int]] = []
    last: dict[int, int] = {}
    for face, entry, _ in chain:
        row = m.faces[face].tolist()
        loop = row[:3] if row[2] == row[3] else row
        turn = max(entry, 0) % len(loop)
        around = loop[turn:] + loop[:turn]
        own = {vertex: last[vertex] for vertex in around[:2] if vertex in last}
        if len(own) < 2 and last:
            raise InputError(f"mesh/faces/{face}", "it runs round another way than its neighbour; turn one of them")
        if not last:
            length = float(np.linalg.norm(m.vertices[around[1]] - m.vertices[around[0]]))
            flat += [np.array([0.0, length]), np.zeros(2)]
            own = {around[0]: 0, around[1]: 1}
        for a, b, c in _triangles_from(m, around):
            flat.append(_apex(m, face, flat[own[a]], flat[own[b]], a, b, c))
            own[c] = len(flat) - 1
        corners.append([own[vertex] for vertex in row])
        last = own
    return np.array(flat), corners


def _triangles_from(m: Mesh, around: list[int]) -> list[tuple[int, int, int]]:
    """Triangles of a face whose first side is laid: two laid corners of each, and the new one to the left of them."""
    if len(around) == 3:
        return [(around[0], around[1], around[2])]
    p, q, r, s = around
    x = m.vertices
    if np.linalg.norm(x[r] - x[p]) <= np.linalg.norm(x[s] - x[q]):
        return [(p, q, r), (p, r, s)]
    return [(p, q, s), (s, q, r)]


def _apex(m: Mesh, face: int, start: Array, end: Array, a: int, b: int, c: int) -> Array:
    """Where the third corner of a triangle lies, to the left of the first two."""
    x = m.vertices
    side, other = x[b] - x[a], x[c] - x[a]
    size = float(np.linalg.norm(side))
    if not size > 0.0:
        raise InputError(f"mesh/faces/{face}", "a side or diagonal of it has no length; clean the mesh")
    along = float(other @ side) / size
    high = float(np.linalg.norm(np.cross(side, other))) / size
    u = (end - start) / np.linalg.norm(end - start)
    out: Array = start + along * u + high * np.array([-u[1], u[0]])
    return out
