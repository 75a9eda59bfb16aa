"""Moebius transformations of points: spheres and circles stay spheres and circles, angles stay."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hookean.discretize.duplicates import _checked
from hookean.errors import InputError

Array = NDArray[np.float64]

FARTHEST = 1e-12  # sine below which a point is sent to infinity


def moebius_transformation(
    points: ArrayLike,
    angle: float,
    axis: ArrayLike = (0.0, 0.0, 1.0),
    centre: ArrayLike = (0.0, 0.0, 0.0),
    radius: float = 1.0,
) -> Array:
    """Points `(n, 3)` moved by a rotation of the sphere of four dimensions, of which space is a projection.

    The stereographic projection with the sphere of `radius` [length] about `centre` sends p = (x - centre) / radius to
    (2 p, |p|^2 - 1) / (|p|^2 + 1). There a rotation by `angle` [rad] in the plane of `axis` and the fourth direction
    moves the points along circles about one that does not move, of `radius` about the centre and normal to the axis;
    pi / 2 sends the centre to centre + radius axis. Angles, circles and
    spheres stay (planes being spheres through infinity), and so do cross ratios of distances. Raises InputError for a
    point that goes to infinity, an axis of zero length, a radius that is not positive.
    """
    xyz = _checked("points", points, (3,))
    given = _checked("axis", np.atleast_2d(np.asarray(axis, float)), (3,))[0]
    middle = _checked("centre", np.atleast_2d(np.asarray(centre, float)), (3,))[0]
    if not np.linalg.norm(given) > 0.0:
        raise InputError("axis", "it has no length; give a direction")
    if not (np.isfinite(radius) and radius > 0.0):
        raise InputError("radius", f"it is {radius!r}; give a length above 0")
    along = given / np.linalg.norm(given)
    p = (xyz - middle) / radius
    square = (p * p).sum(axis=1)
    on, fourth = 2.0 * p / (square + 1.0)[:, None], (square - 1.0) / (square + 1.0)
    height = on @ along
    up = np.cos(angle) * height - np.sin(angle) * fourth
    fourth = np.sin(angle) * height + np.cos(angle) * fourth
    on = on + (up - height)[:, None] * along
    gone = np.flatnonzero(1.0 - fourth <= FARTHEST)
    if len(gone):
        raise InputError(f"points/{gone[0]}", "it would go to infinity; use another angle, or leave it out")
    out: Array = middle + radius * on / (1.0 - fourth)[:, None]
    return out
