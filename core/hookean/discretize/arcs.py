"""Arcs through three points or of a length, and smooth curves through particles for display."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hookean.errors import InputError

Array = NDArray[np.float64]

_STRAIGHT = 1e-9  # sine of the angle at a corner below which three points count as in a row


def arc(a: ArrayLike, b: ArrayLike, c: ArrayLike, count: int) -> Array:
    """Points (count + 1, 3) [length] at equal arc lengths on the circular arc from a through b to c.

    InputError where the points lie in a row or in one place.
    """
    x, y, z = _point(a, "a"), _point(b, "b"), _point(c, "c")
    _check_count(count)
    u, v = y - x, z - x
    normal = np.cross(u, v)
    sine = float(np.linalg.norm(normal))
    sides = [float(np.linalg.norm(s)) for s in (u, v, z - y)]
    # the sines of all three angles are this over two of the sides
    if not sine > _STRAIGHT * max(sides) * sorted(sides)[1]:
        raise InputError(
            "b", "the three points are in line or coincide; an arc needs three points that are not in line"
        )
    normal /= sine
    to_centre = np.cross(u @ u * v - v @ v * u, normal) / (2.0 * sine)
    radius = float(np.linalg.norm(to_centre))
    first = -to_centre / radius
    second = np.cross(normal, first)
    # counter-clockwise about the normal from a to c, past b: the chord and the side of the centre tell how far
    half = np.arctan2(0.5 * sides[1], float(to_centre @ np.cross(normal, v)) / sides[1])
    angle = 2.0 * half * np.arange(count + 1) / count
    # 1 - cos without loss, so that flat arcs keep their digits
    offset = np.outer(-2.0 * np.sin(0.5 * angle) ** 2, first) + np.outer(np.sin(angle), second)
    points = x + radius * offset
    points[0], points[-1] = x, z
    return np.asarray(points)


def arc_through(points: ArrayLike, count: int) -> Array:
    """Points (count + 1, 3) [length] of `arc`, through the three given as rows (3, 3)."""
    try:
        rows = np.array(points, dtype=float)
    except (TypeError, ValueError):
        raise InputError("points", "rows of x, y, z expected") from None
    if rows.shape != (3, 3):
        raise InputError("points", f"shape {list(rows.shape)} given; three rows of x, y, z expected")
    return arc(rows[0], rows[1], rows[2], count)


def arc_of_length(arc_length: float, span: float, count: int) -> Array:
    """Points (count + 1, 3) [length] at equal arc lengths on the arc of a length that stands over a span, from the
    origin along x, its middle up; a straight line where both are the same.

    Its half angle t solves arc_length sin(t) / t = span. InputError where the arc is shorter than the span or longer
    than 1000 times it.
    """
    if not span <= arc_length < 1e3 * span:
        said = f"{arc_length:g} given for a span of {span:g}; at least the span, at most 1000 times it allowed"
        raise InputError("arc_length", said)
    _check_count(count)
    if arc_length == span:
        return np.linspace((0.0, 0.0, 0.0), (span, 0.0, 0.0), count + 1)
    from scipy.optimize import brentq

    half = brentq(lambda t: arc_length * np.sin(t) / t - span, 1e-9, np.pi, xtol=1e-15, rtol=1e-15)
    radius = 0.5 * arc_length / half
    turn = np.linspace(-half, half, count + 1)
    height = radius * (np.cos(turn) - np.cos(half))
    return np.stack([0.5 * span + radius * np.sin(turn), np.zeros_like(turn), height], axis=1)


def interpolate(points: ArrayLike, count: int, degree: int = 3) -> Array:
    """Points (count + 1, 3) [length] on a smooth curve through points (n, 3), for display.

    A spline of odd or even `degree` over the lengths of the chords; it passes the given points, and ends at the first
    and last. It is not the physical shape: springs are straight between particles, and nothing between the particles
    of a bent rod was computed. With n points the degree is at most n - 1; points in one place are passed once.
    """
    try:
        x = np.array(points, dtype=float)
    except (TypeError, ValueError):
        raise InputError("points", "rows of x, y, z expected") from None
    if x.ndim != 2 or x.shape[1] != 3 or len(x) < 2 or not np.isfinite(x).all():
        raise InputError("points", f"shape {list(x.shape)} given; two or more finite rows of x, y, z expected")
    _check_count(count)
    if isinstance(degree, bool) or not isinstance(degree, int | np.integer) or not 1 <= degree <= 11:
        raise InputError("degree", f"{degree!r} given; a whole number from 1 to 11 allowed")
    chords = np.linalg.norm(np.diff(x, axis=0), axis=1)
    moved = np.concatenate([[True], chords > 1e-12 * chords.sum()])
    x = x[moved]
    if len(x) < 2:
        raise InputError("points", "all points coincide; a curve needs two different points")
    from scipy.interpolate import make_interp_spline

    reach = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(x, axis=0), axis=1))])
    spline = make_interp_spline(reach / reach[-1], x, k=min(int(degree), len(x) - 1))
    found = np.asarray(spline(np.linspace(0.0, 1.0, count + 1)), dtype=np.float64)
    found[0], found[-1] = x[0], x[-1]
    return found


def _check_count(count: Any) -> None:
    if isinstance(count, bool) or not isinstance(count, int | np.integer) or count < 1:
        raise InputError("count", f"{count!r} given; the number of pieces is a whole number from 1 on")


def _point(value: ArrayLike, name: str) -> Array:
    try:
        point = np.array(value, dtype=float)
    except (TypeError, ValueError):
        raise InputError(name, f"{value!r} given; x, y, z expected") from None
    if point.shape != (3,) or not np.isfinite(point).all():
        raise InputError(name, f"{value!r} given; x, y, z expected, all finite")
    return point
