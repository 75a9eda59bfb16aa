"""Outlines of flat pieces moved outwards: seam allowances."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

SHARP = 3.0  # the longest corner, as a part of the larger distance


def offset(outline: ArrayLike, distances: ArrayLike) -> Array:
    """A closed outline (k, 2) that runs counter-clockwise with each side moved outwards by a distance (k,) [length]:
    side i goes from point i to the next. Sharp corners are cut off at three times the distance; where a distance
    changes along a straight outline, the outline steps."""
    points = np.asarray(outline, dtype=float)
    far = np.broadcast_to(np.asarray(distances, dtype=float), len(points))
    along = np.roll(points, -1, axis=0) - points
    along = along / np.linalg.norm(along, axis=1)[:, None]
    out = np.stack([along[:, 1], -along[:, 0]], axis=1)
    moved: list[Array] = []
    for i in range(len(points)):
        before, after = i - 1, i
        first, second = points[i] + far[before] * out[before], points[i] + far[after] * out[after]
        turn = along[before][0] * along[after][1] - along[before][1] * along[after][0]
        if abs(turn) < 1e-9:
            moved += [first] if np.allclose(first, second, atol=1e-12) else [first, second]
            continue
        across = second - first
        reach = (across[0] * along[after][1] - across[1] * along[after][0]) / turn
        corner = first + reach * along[before]
        longest = SHARP * max(far[before], far[after])
        if np.linalg.norm(corner - points[i]) <= max(longest, 1e-300):
            moved.append(corner)
        else:
            moved += [first, second]
    return np.array(moved)
