"""How the faces of a Brep meet: which side of a face is which edge, and the points they share."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.discretize.curves import divide
from hookean.discretize.duplicates import unique_points
from hookean.discretize.surfaces import merged_ids
from hookean.errors import InputError

Array = NDArray[np.float64]
Index = NDArray[np.int64]

_SAME = 1e-6  # relative to the size of the whole
_LIKE = 1e-2  # side and edge differ by the modelling tolerance; other edges by far more


@dataclass(frozen=True)
class Side:
    """One side of a face's domain that is one whole edge."""

    direction: int  # 0: u runs along it, 1: v does
    last: bool  # at the end of the other direction
    edge: int
    reversed: bool  # runs against the edge


def face_sides(face: Any, edges: Any) -> list[Side]:
    """The sides of an untrimmed face that are whole edges; collapsed and divided ones are left out."""
    loop = face.Loops[0]
    indices = sorted({loop.Trims[i].EdgeIndex for i in range(loop.TrimCount)} - {-1})
    marks = {i: divide(edges[i], 8) for i in indices}
    out = []
    for direction in (0, 1):
        other = face.Domain(1 - direction)
        for last in (False, True):
            try:
                side = divide(face.IsoCurve(direction, other.T1 if last else other.T0), 8)
            except InputError:  # collapsed to a point
                continue
            near = _LIKE * np.linalg.norm(np.diff(side, axis=0), axis=1).sum()
            tries = [
                (float(np.abs(side - (m[::-1] if back else m)).max()), i, back)
                for i, m in marks.items()
                for back in (False, True)
            ]
            gap, edge, back = min(tries, default=(np.inf, -1, False))
            if gap <= near:
                out.append(Side(direction, last, edge, back))
    return out


def face_counts(sides: list[list[Side]], u: int, v: int) -> list[tuple[int, int]]:
    """Counts (along u, along v) of each face, equal along shared edges.

    Directions joined by shared edges form a class that takes one count. Breadth first from each first
    face: its u direction takes `u`, and across a face the class not yet met takes the other count.
    """
    root = list(range(2 * len(sides)))

    def find(i: int) -> int:
        while root[i] != i:
            root[i] = root[root[i]]
            i = root[i]
        return i

    at_edge: dict[int, int] = {}
    for face, some in enumerate(sides):
        for side in some:
            a, b = find(at_edge.setdefault(side.edge, 2 * face + side.direction)), find(2 * face + side.direction)
            root[max(a, b)] = min(a, b)
    members: dict[int, list[int]] = {}
    for node in range(2 * len(sides)):
        members.setdefault(find(node), []).append(node // 2)
    taken: dict[int, int] = {}
    for start in range(len(sides)):
        queue = deque([start])
        while queue:
            face = queue.popleft()
            a, b = find(2 * face), find(2 * face + 1)
            new = [c for c in (a, b) if c not in taken]
            if a not in taken:
                taken[a] = 1 - taken[b] if b in taken else 0
            if b not in taken:
                taken[b] = 1 - taken[a]
            queue.extend(f for c in new for f in members[c])
    size = (u, v)
    return [(size[taken[find(2 * f)]], size[taken[find(2 * f + 1)]]) for f in range(len(sides))]


def shared_ids(grids: list[Array], sides: list[list[Side]]) -> tuple[list[Index], Index, dict[int, Index]]:
    """Numbers of the points of each grid, what each number is the same as, and the numbers along each edge.

    Points are the same where a face is collapsed or closed, at the same step along a shared edge, and
    where other boundary points coincide. The first wins.
    """
    ids, offset = [], 0
    for grid in grids:
        ids.append(np.arange(offset, offset + grid[..., 0].size).reshape(grid.shape[:2]))
        offset += grid[..., 0].size
    pairs = [np.stack([i.ravel(), i.ravel()[merged_ids(g).ravel()]], 1) for g, i in zip(grids, ids, strict=True)]
    chains: dict[int, Index] = {}
    for i, some in zip(ids, sides, strict=True):
        for side in some:
            chain = (i if side.direction == 1 else i.T)[-1 if side.last else 0]
            chain = chain[::-1] if side.reversed else chain
            pairs.append(np.stack([chains.setdefault(side.edge, chain), chain], 1))
    points = np.concatenate([g.reshape(-1, 3) for g in grids])
    rim = np.concatenate([np.concatenate([i[0], i[-1], i[:, 0], i[:, -1]]) for i in ids])
    rim = np.unique(rim)
    kept, place = unique_points(points[rim], _SAME * float(np.ptp(points, axis=0).max()))
    pairs.append(np.stack([rim, rim[kept[place]]], 1))
    return ids, _lowest(np.concatenate(pairs), offset), chains


def _lowest(pairs: Index, count: int) -> Index:
    """For each of `count` items the lowest one it is tied to."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    ties = coo_array((np.ones(len(pairs), np.int8), (pairs[:, 0], pairs[:, 1])), shape=(count, count))
    label: Index = connected_components(ties, directed=False)[1].astype(np.int64)
    first = np.full(count, count)
    np.minimum.at(first, label, np.arange(count))
    out: Index = first[label]
    return out
