"""Polylines taken apart where they turn."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.discretize.curves import explode
from hookean.errors import InputError

Array = NDArray[np.float64]


def split_at_corners(polyline: Any, turning_angle: float = 1.0) -> tuple[Array, list[Array]]:
    """Corners `(k, 3)` of a polyline, where it turns by more than `turning_angle` [rad], and the parts between them.

    Parts are polylines `(m, 3)` in their order; each starts where the one before ends. A closed polyline without
    corners is one part; with corners its first part starts at the first of them. The ends of an open polyline are not
    corners. Raises InputError where a piece is curved, or the angle is not
    between 0 and pi.
    """
    if not 0.0 <= turning_angle <= np.pi:
        raise InputError("turning_angle", f"it is {turning_angle!r}; give an angle from 0 to pi in radians")
    segments = explode(polyline)
    points = np.concatenate([segments[:1, 0], segments[:, 1]])
    size = np.ptp(points, axis=0).max()
    closed = len(segments) > 2 and np.abs(points[-1] - points[0]).max() <= 1e-12 * size
    along = segments[:, 1] - segments[:, 0]
    before = np.roll(along, 1, axis=0)  # of the corner at the start of each segment
    turn = np.arctan2(np.linalg.norm(np.cross(before, along), axis=1), (before * along).sum(axis=1))
    corners = np.flatnonzero(turn > turning_angle)
    corners = corners if closed else corners[corners > 0]
    if closed and len(corners):
        points = np.concatenate([np.roll(points[:-1], -corners[0], axis=0), points[corners[:1]]])
        corners = corners - corners[0]
    cuts = np.concatenate([[0], corners[corners > 0], [len(segments)]])
    parts = [points[i : j + 1] for i, j in pairwise(cuts.tolist())]
    return points[corners], parts
