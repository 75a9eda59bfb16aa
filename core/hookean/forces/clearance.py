"""How far from a solid a point is at least and at most, by a grid of signed distances at the middles of cubes.

A distance to something changes by no more than the way: with s at a middle, a point that is w away from it is between
s - w and s + w from the solid. Most points that touch nothing need no search for the closest part of it then.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from hookean.compiled.dispatch import keep, rows
from hookean.compiled.marks import device
from hookean.forces.base import Floats

HEAD = 7  # of the table: the first middle, width of the cubes, how many there are along x y z
FEWEST, MOST = 4, 16  # cubes along the longest side
EACH = 3.0  # so many cubes along a side for each particle along one
ROUNDING = 1e-9  # of the width: bounds are that much wider


def middles(corners: Floats, count: int) -> tuple[Floats, Floats]:
    """Head of the table, and the middles (n, 3) of cubes about corners (m, 3, 3) for a number of particles."""
    low, high = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
    width = float((high - low).max()) / min(max(round(EACH * count ** (1.0 / 3.0)), FEWEST), MOST)
    number = np.ceil((high - low) / width).astype(np.int64) + 2
    first = 0.5 * (low + high - (number - 1) * width)
    place = np.stack(np.meshgrid(*map(np.arange, number), indexing="ij"), axis=-1).reshape(-1, 3)
    return np.array([*first, width, *number], np.float64), np.ascontiguousarray(first + place * width)


def kept(head: Floats, distances: Floats) -> float:
    """The address of the table of signed distances (n,) at the middles."""
    return keep(np.concatenate([head, distances])[:, None])


@device
def bounds(address: Any, p: Any) -> Any:
    """The signed distance at the middle of the cube nearest to a point, how far away that is, and the width of it."""
    head = rows(address, HEAD, 1)
    width, place, away, size = head[3, 0], 0, 0.0, 1
    for c in range(3):
        at, number = (p[c] - head[c, 0]) / width, int(head[4 + c, 0])
        near = 0 if not at > 0.0 else number - 1 if at >= number - 1 else int(at + 0.5)
        place = place * number + near
        size *= number
        away += (at - near) * (at - near)
    distance = rows(address + 8.0 * HEAD, size, 1)[place, 0]
    return distance, np.sqrt(away) * width + ROUNDING * width, width
