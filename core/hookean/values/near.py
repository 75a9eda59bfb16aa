"""Which points are near: a tree of scipy's, and for few points plain distances, as scipy takes longer to import."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

FEW = 300
AT_ONCE = 2**22  # distances


def tree(points: Floats) -> Any:
    """What answers `query` and `query_ball_point` as a cKDTree of `points` (n, 3) does, for n of at least 1."""
    return Few(points) if len(points) <= FEW else _large(points)


def _large(points: Floats) -> Any:
    from scipy.spatial import cKDTree

    return cKDTree(points)


def first(points: Floats, places: Floats, radius: float) -> Ints:
    """For each place (m, 3) the first of `points` (n, 3) within `radius`; -1 if no point is that near.

    However many points are alike or near a place, the time grows as (n + m) log(n)^2: whether the first half of some
    points has a near one is asked before the points are.
    """
    found = np.full(len(places), -1, dtype=np.int64)
    if not len(points) or not len(places):
        return found
    _, kept = np.unique(points, axis=0, return_index=True)
    kept = np.sort(kept)
    distinct = points[kept]
    bound = max(radius * 1.001, 1e-150)  # also squared; what is farther need not be looked for
    distances, which = tree(distinct).query(places, k=2, distance_upper_bound=bound)
    near = distances <= radius
    found[near[:, 0]] = which[near[:, 0], 0]
    blocks = [(0, len(distinct), np.flatnonzero(near[:, 1]))]
    while blocks:
        start, stop, rows = blocks.pop()
        if not len(rows):
            continue
        if stop - start <= FEW:
            for some in np.array_split(rows, 1 + len(rows) * (stop - start) // AT_ONCE):
                apart = np.sqrt(sum((places[some, i, None] - distinct[None, start:stop, i]) ** 2 for i in range(3)))
                hits = apart <= np.maximum(radius, apart.min(axis=1))[:, None]  # there is one, whatever the rounding
                found[some] = start + np.argmax(hits, axis=1)
            continue
        middle = (start + stop) // 2
        nearest = _large(distinct[start:middle]).query(places[rows], k=1, distance_upper_bound=bound)[0]
        there = nearest <= radius
        blocks += [(start, middle, rows[there]), (middle, stop, rows[~there])]
    found[found >= 0] = kept[found[found >= 0]]
    return found


class Few:
    """Points that are compared one by one."""

    def __init__(self, points: Floats) -> None:
        self.points = points

    def query(self, places: Floats, k: int, distance_upper_bound: float = np.inf) -> tuple[Floats, Ints]:
        """Distances (m, k) of the nearest points to each place, nearest first, and which they are.

        Beyond the last point the distance is infinite and the number that of all points. A bound makes nothing quicker
        here, and points beyond it are reported.
        """
        n = len(self.points)
        near, which = np.full((len(places), k), np.inf), np.full((len(places), k), n, dtype=np.int64)
        found = min(k, n)
        for i, place in enumerate(places):
            distances = self._distances(place)
            which[i, :found] = np.argsort(distances, kind="stable")[:found]
            near[i, :found] = distances[which[i, :found]]
        return near, which

    def query_ball_point(self, place: Floats, radius: float) -> list[int]:
        """The points within `radius` of a place."""
        return [int(i) for i in np.flatnonzero(self._distances(place) <= radius)]

    def _distances(self, place: Floats) -> Floats:
        x, y, z = (self.points - place).T
        distances: Floats = np.sqrt(x * x + y * y + z * z)
        return distances
