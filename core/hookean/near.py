"""Which points are near: a tree of scipy's, and for few points plain distances, as scipy takes longer to import."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

FEW = 300


def tree(points: Floats) -> Any:
    """What answers `query` and `query_ball_point` as a cKDTree of `points` (n, 3) does, for n of at least 1."""
    if len(points) <= FEW:
        return Few(points)
    from scipy.spatial import cKDTree

    return cKDTree(points)


class Few:
    """Points that are compared one by one."""

    def __init__(self, points: Floats) -> None:
        self.points = points

    def query(self, places: Floats, k: int, distance_upper_bound: float = np.inf) -> tuple[Floats, Ints]:
        """Distances (m, k) of the nearest points to each place, nearest first, and which they are.

        Beyond the last point the distance is infinite and the number that of all points. A bound makes nothing quicker
        here, and points beyond it are told.
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
