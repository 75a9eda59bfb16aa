"""Strips of a mesh: its faces in rows along warp or weft, several rows to a strip."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from hookean.discretize.meshes import as_mesh
from hookean.discretize.warpweft import warp_weft
from hookean.errors import InputError

Index = NDArray[np.int64]


def row_edges(mesh: Any, along: Literal["warp", "weft"] = "warp") -> Index:
    """The edges (k, 2) that run along the rows of `face_rows`. Raises InputError for another direction, or where warp
    and weft cannot agree."""
    if along not in ("warp", "weft"):
        raise InputError("along", f"{along!r} given; warp or weft is expected")
    return warp_weft(as_mesh(mesh))[0 if along == "warp" else 1]


def face_rows(mesh: Any, along: Literal["warp", "weft"] = "warp") -> Index:
    """The row (m,) of each face: rows run along warp or weft edges, which are their long sides, and are numbered from
    one side of the mesh to the other. Raises InputError where warp and weft cannot agree (see `warp_weft`)."""
    m = as_mesh(mesh)
    warp, weft = warp_weft(m)
    inner, outer = (weft, warp) if along == "warp" else (warp, weft)
    sides: dict[tuple[int, int], list[int]] = {}
    for number, face in enumerate(m.faces.tolist()):
        corners = face[:3] if face[2] == face[3] else face
        for a, b in zip(corners, [*corners[1:], corners[0]], strict=True):
            sides.setdefault((min(a, b), max(a, b)), []).append(number)

    def pairs(edges: Index) -> list[tuple[int, int]]:
        found = [sides[min(a, b), max(a, b)] for a, b in edges.tolist()]
        return [(near[0], near[1]) for near in found if len(near) == 2]

    root = _joined(len(m.faces), pairs(inner))
    beside: dict[int, set[int]] = {row: set() for row in sorted(set(root.tolist()))}
    for a, b in pairs(outer):
        if root[a] != root[b]:
            beside[root[a]].add(int(root[b]))
            beside[root[b]].add(int(root[a]))
    order = _in_order(beside)
    place = {row: number for number, row in enumerate(order)}
    return np.array([place[row] for row in root.tolist()], dtype=np.int64)


def strips(mesh: Any, along: Literal["warp", "weft"] = "warp", rows: int = 1) -> Index:
    """The strip (m,) of each face: `rows` rows that lie side by side make a strip."""
    if not (isinstance(rows, int) and rows >= 1):
        raise InputError("rows", f"{rows!r} given; a whole number from 1 is expected")
    return np.asarray(face_rows(mesh, along) // rows)


def _joined(count: int, pairs: list[tuple[int, int]]) -> Index:
    """The lowest member of each one's group (count,), of pairs that belong together."""
    root = list(range(count))

    def find(i: int) -> int:
        while root[i] != i:
            root[i] = root[root[i]]
            i = root[i]
        return i

    for a, b in pairs:
        a, b = find(a), find(b)
        root[max(a, b)] = min(a, b)
    return np.array([find(i) for i in range(count)], dtype=np.int64)


def _in_order(beside: dict[int, set[int]]) -> list[int]:
    """Rows from neighbour to neighbour, each part from an end that has one neighbour, if there is one."""
    order: list[int] = []
    left = dict.fromkeys(sorted(beside, key=lambda row: (len(beside[row]) > 1, row)))
    while left:
        row = next(iter(left))
        while True:
            order.append(row)
            del left[row]
            following = sorted(near for near in beside[row] if near in left)
            if not following:
                break
            row = following[0]
    return order
