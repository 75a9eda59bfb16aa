"""Lines between points: every pair of points, and points in two groups with lines only between these."""

from __future__ import annotations

from collections import deque

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hookean.discretize.duplicates import _checked, unique_points
from hookean.errors import InputError

Array = NDArray[np.float64]


def interconnect_points(points: ArrayLike) -> Array:
    """A line `(k, 2, 3)` between every two of points `(n, 3)`, k = n (n - 1) / 2: from each to all later ones."""
    xyz = _checked("points", points, (3,))
    first, second = np.triu_indices(len(xyz), 1)
    return np.stack([xyz[first], xyz[second]], axis=1)


def expected_lines(points: ArrayLike) -> int:
    """How many lines `interconnect_points` makes."""
    count = len(_checked("points", points, (3,)))
    return count * (count - 1) // 2


def bipartite(lines: ArrayLike, tolerance: float = 1e-6) -> tuple[Array, Array]:
    """The ends of lines `(m, 2, 3)` in two groups `(k, 3)`, so that every line goes from one group to the other.

    Ends that are nearer than `tolerance` [length] are one point. The first end of each connected part is in the first
    group; both are in the order of first appearance. Raises InputError, with one of its lines, where a ring of an odd
    number of lines allows no such groups.
    """
    ends = _checked("lines", lines, (2, 3))
    kept, place = unique_points(ends.reshape(-1, 3), tolerance)
    pairs = place.reshape(-1, 2)
    beside: list[list[int]] = [[] for _ in range(len(kept))]
    for a, b in pairs.tolist():
        beside[a].append(b)
        beside[b].append(a)
    group = np.full(len(kept), -1)
    for seed in range(len(kept)):
        queue = deque([seed] if group[seed] < 0 else [])
        group[seed] = max(group[seed], 0)
        while queue:
            point = queue.popleft()
            for other in beside[point]:
                if group[other] < 0:
                    group[other] = 1 - group[point]
                    queue.append(other)
    odd = np.flatnonzero(group[pairs[:, 0]] == group[pairs[:, 1]])
    if len(odd):
        said = "it closes a ring of an odd number of lines, whose ends are in no two groups; divide it, or leave it out"
        raise InputError(f"lines/{odd[0]}", said)
    points = ends.reshape(-1, 3)[kept]
    return points[group == 0], points[group == 1]
