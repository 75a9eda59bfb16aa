"""Warp and weft of a quad mesh: the two families of edges that cross like the threads of a cloth."""

from __future__ import annotations

from collections import deque
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.discretize.meshes import _edges, as_mesh, on_boundary
from hookean.errors import InputError

Index = NDArray[np.int64]


def warp_weft(mesh: Any, strict: bool = True, advice: str = "pass strict=False") -> tuple[Index, Index]:
    """Warp edges `(p, 2)` and weft edges `(q, 2)`; together all edges, each in order of first appearance.

    Opposite sides of a quad belong to one family, neighbouring sides to different ones. The first side
    of the first quad is warp; the rest follows from quad to quad over shared edges, breadth first, and
    each part of the mesh that no quad connects starts again. Then triangles: where a side borders a quad
    the other two take the opposite family, as meridians at a pole do. Triangles among themselves count
    as quads `(a, b, c, c)` with the side c-c collapsed: b-c and c-a are one family, a-b is the other.

    Such families exist only where every inner vertex has an even number of quads, strips that close
    do so untwisted, and no edge has conflicting neighbours. Elsewhere InputError names two quads that
    disagree, with `advice`; with `strict=False` the family reached first is kept, a deterministic answer.
    """
    m = as_mesh(mesh)
    sides, first, which = _edges(m)
    of = which.reshape(-1, 4)
    quad = of[:, 2] >= 0
    family = np.full(len(first), -1)
    neighbours = _neighbours(of, len(first))
    found, sides_of, is_quad = family.tolist(), of.tolist(), quad.tolist()  # numbers of Python: one by one, quicker
    for seed in np.flatnonzero(quad).tolist():
        if all(found[side] < 0 for side in sides_of[seed]):
            _spread(seed, sides_of, is_quad, neighbours, found)
    family = np.array(found, dtype=np.int64)
    if strict:
        _check(of, quad, family, advice)
    _triangles(of, quad, neighbours, family)
    every = sides[first]
    return every[family == 0], every[family == 1]


def threads(mesh: Any, strict: bool = True) -> tuple[Index, Index, NDArray[np.bool_], NDArray[np.bool_]]:
    """Warp and weft edges as `warp_weft` has them, and for each whether it is on the boundary."""
    m = as_mesh(mesh)
    warp, weft = warp_weft(m, strict)
    return warp, weft, on_boundary(m, warp), on_boundary(m, weft)


def _spread(seed: int, of: list[list[int]], quad: list[bool], neighbours: list[list[int]], family: list[int]) -> None:
    family[of[seed][0]] = 0
    queue, seen = deque([seed]), {seed}
    while queue:
        sides = of[queue.popleft()]
        known = next(s for s in range(4) if family[sides[s]] >= 0)
        start = family[sides[known]] - known
        for s, side in enumerate(sides):
            if family[side] < 0:
                family[side] = (start + s) % 2
            for other in neighbours[side]:
                if quad[other] and other not in seen:
                    seen.add(other)
                    queue.append(other)


def _check(of: Index, quad: NDArray[np.bool_], family: Index, advice: str) -> None:
    f = family[of]
    wrong = quad & ((f[:, 0] != f[:, 2]) | (f[:, 1] != f[:, 3]) | (f[:, 0] == f[:, 1]))
    if wrong.any():
        face = int(np.flatnonzero(wrong)[0])
        shared = np.isin(of, of[face]).any(axis=1) & quad
        shared[face] = False
        other = int(np.flatnonzero(shared)[0]) if shared.any() else face
        raise InputError(
            f"mesh/faces/{face}",
            f"warp and weft cannot agree between this quad and quad {other}; an inner vertex with an odd number "
            f"of quads or a twisted strip prevents it: remesh there, or {advice}",
        )


def _triangles(of: Index, quad: NDArray[np.bool_], neighbours: list[list[int]], family: Index) -> None:
    triangles = np.flatnonzero(~quad).tolist()
    given = family >= 0
    for face in triangles:
        base = [e for e in of[face, [0, 1, 3]].tolist() if given[e]]
        for edge in of[face, [0, 1, 3]].tolist() if base else ():
            if family[edge] < 0:
                family[edge] = 1 - family[base[0]]
    queue = deque(f for f in triangles if (family[of[f, [0, 1, 3]]] >= 0).any())
    for seed in triangles:
        queue.append(seed)
        while queue:
            ab, bc, ca = of[queue.popleft(), [0, 1, 3]].tolist()
            across = next((int(family[e]) for e in (bc, ca) if family[e] >= 0), -1)
            if across < 0:
                across = 1 - max(0, int(family[ab]))
            for edge, value in ((ab, 1 - across), (bc, across), (ca, across)):
                if family[edge] < 0:
                    family[edge] = value
                    queue.extend(f for f in neighbours[edge] if not quad[f])


def _neighbours(of: Index, count: int) -> list[list[int]]:
    out: list[list[int]] = [[] for _ in range(count)]
    for face, sides in enumerate(of.tolist()):
        for edge in sides:
            if edge >= 0:
                out[edge].append(face)
    return out
