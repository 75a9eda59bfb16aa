"""Curves of every source as one form: rational Bezier pieces, exact in shape.

A curve becomes an array `(s, p + 1, 4)`: s pieces of degree p, each control point homogeneous
`(w x, w y, w z, w)` in length units. Lines, arcs, polylines and NURBS are then all treated alike.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.errors import InputError

Array = NDArray[np.float64]

_KINDS = (
    "a rhino3dm curve, Line, Arc, Circle or Polyline, a COMPAS Line, Polyline, Polygon, Arc, Circle, Ellipse, "
    "Bezier or NurbsCurve, or points of shape (n, 3)"
)


def bezier_pieces(curve: Any) -> Array:
    """The pieces `(s, p + 1, 4)` of a curve, those of zero size left out.

    Raises InputError where the type is unknown, a number is not finite, a weight is not positive,
    the curve has a gap or no length.
    """
    pieces = _check(_read(curve))
    points = pieces[..., :3] / pieces[..., 3:]
    with np.errstate(over="ignore"):
        size = float(np.ptp(points.reshape(-1, 3), axis=0).max())
    if not math.isfinite(size):
        raise InputError("curve", "it is too large for float64 arithmetic; use larger units")
    if size <= 1e-14 * float(np.abs(points).max()):
        at = ", ".join(f"{c:g}" for c in points[0, 0])
        raise InputError("curve", f"it has zero length (all of it is at {at}); give a curve with length")
    gaps = np.abs(points[1:, 0] - points[:-1, -1]).max(axis=1, initial=0.0)
    if len(gaps) and gaps.max() > 1e-6 * size:
        where = int(gaps.argmax())
        raise InputError(
            "curve",
            f"it has a gap of {gaps[where]:g} after piece {where}; join its parts or divide them one by one",
        )
    keep = np.ptp(points, axis=1).max(axis=1) > 0.0
    out: Array = pieces[keep]
    return out


def nurbs_pieces(points: Array, knots: Array, degree: int) -> Array:
    """Bezier pieces `(s, p + 1, 4)` of a B-spline with homogeneous `points` `(n, 4)`.

    `knots` has n + p + 1 entries (the convention with the end knots repeated p + 1 times). Control
    point k of the piece over [a, b] is the blossom of the spline at a (p - k times) and b (k times).
    """
    n = len(points)
    if len(knots) != n + degree + 1 or degree < 1 or n <= degree:
        raise InputError(
            "curve",
            f"{n} control points of degree {degree} with {len(knots)} knots do not make a curve; "
            "knots must be points + degree + 1 and points more than the degree",
        )
    if not np.isfinite(knots).all() or (np.diff(knots) < 0).any():
        raise InputError("curve", "its knots are not finite or not in ascending order; rebuild the curve")
    spans = np.flatnonzero(knots[degree:n] < knots[degree + 1 : n + 1]) + degree
    out = np.empty((len(spans), degree + 1, 4))
    ends = np.stack([knots[spans], knots[spans + 1]])
    for k in range(degree + 1):
        d = points[spans[:, None] + np.arange(-degree, 1)]
        for r in range(1, degree + 1):
            at = ends[0 if r <= degree - k else 1][:, None]
            j = np.arange(r, degree + 1)
            low = knots[spans[:, None] + j - degree]
            high = knots[spans[:, None] + j + 1 - r]
            f = ((at - low) / (high - low))[..., None]
            d = (1.0 - f) * d[:, :-1] + f * d[:, 1:]
        out[:, k] = d[:, 0]
    return out


def polyline_pieces(points: Any) -> Array:
    """Degree 1 pieces `(n - 1, 2, 4)` of the polyline through `points` `(n, 3)`."""
    try:
        xyz = np.asarray(points, dtype=np.float64)
        if xyz.ndim == 0 or points is None:
            raise TypeError
    except (TypeError, ValueError):
        raise InputError("curve", f"{type(points).__name__} is not a curve; allowed is {_KINDS}") from None
    if xyz.ndim != 2 or xyz.shape[1] != 3 or len(xyz) < 2:
        raise InputError("curve", f"points of shape {xyz.shape} are not a polyline; give (n, 3) with n >= 2")
    four = np.concatenate([xyz, np.ones((len(xyz), 1))], axis=1)
    return np.stack([four[:-1], four[1:]], axis=1)


def arc_pieces(frame: Any, a: float, b: float, start: float, end: float) -> Array:
    """Rational quadratic pieces of `C(t) = origin + a cos t X + b sin t Y`, start <= t <= end (radians).

    The middle control point of a piece of half angle h has weight cos h and lies at distance 1 / cos h.
    """
    o, x, y = (np.array([float(c) for c in v]) for v in (frame.point, frame.xaxis, frame.yaxis))
    span = end - start
    if not math.isfinite(span):
        raise InputError("curve", f"its angles {start} to {end} are not finite; give finite radians")
    s = max(1, math.ceil(abs(span) / (math.pi / 2) - 1e-12))
    t = start + span * np.arange(2 * s + 1) / (2 * s)
    w = np.ones(2 * s + 1)
    w[1::2] = math.cos(span / (2 * s))
    xyz = o * w[:, None] + a * np.cos(t)[:, None] * x + b * np.sin(t)[:, None] * y
    four = np.concatenate([xyz, w[:, None]], axis=1)
    # the homogeneous middle point is (cos t, sin t): w times the point at distance 1 / w
    out: Array = four[2 * np.arange(s)[:, None] + np.arange(3)]
    return out


def _check(pieces: Array) -> Array:
    bad = np.argwhere(~np.isfinite(pieces))
    if len(bad):
        raise InputError(
            "curve",
            f"control point {bad[0][1]} of piece {bad[0][0]} is not finite; give finite coordinates and weights",
        )
    if (pieces[..., 3] <= 0).any():
        least = pieces[..., 3].min()
        raise InputError("curve", f"a weight is {least:g}; weights must be positive, rebuild the curve")
    if not len(pieces):
        raise InputError("curve", "it has zero length (no span between its knots); give a curve with length")
    return pieces


def _read(curve: Any) -> Array:
    if hasattr(curve, "ToNurbsCurve"):
        return _read_rhino(curve)
    if hasattr(curve, "From") and hasattr(curve, "To"):
        return polyline_pieces([[p.X, p.Y, p.Z] for p in (curve.From, curve.To)])
    if type(curve).__module__.split(".")[0] == "rhino3dm":
        return _read_rhino_value(curve)
    if hasattr(curve, "degree") and hasattr(curve, "points"):
        return _read_compas_spline(curve)
    if hasattr(curve, "start") and hasattr(curve, "end"):
        return polyline_pieces([list(curve.start), list(curve.end)])
    if hasattr(curve, "points"):
        points = [list(p) for p in curve.points]
        # a COMPAS Polygon is closed without repeating its first point
        return polyline_pieces(points if hasattr(curve, "is_closed") else [*points, points[0]])
    if hasattr(curve, "frame"):
        return _read_compas_conic(curve)
    return polyline_pieces(curve)


def _read_rhino(curve: Any) -> Array:
    if hasattr(curve, "ToPolylineCurve"):  # the value type Polyline: exact as it is
        return polyline_pieces([[p.X, p.Y, p.Z] for p in curve])
    nurbs = curve.ToNurbsCurve()
    if nurbs is None or len(nurbs.Points) == 0:
        kind = type(curve).__name__
        raise InputError("curve", f"this {kind} has no NURBS form; it is empty or invalid, rebuild it")
    points = np.array([[p.X, p.Y, p.Z, p.W] for p in nurbs.Points])
    knots = np.array([float(k) for k in nurbs.Knots])
    # opennurbs leaves out the first and the last knot, which shape nothing
    knots = np.concatenate([knots[:1], knots, knots[-1:]])
    return nurbs_pieces(points, knots, int(nurbs.Degree))


def _read_rhino_value(curve: Any) -> Array:
    import rhino3dm

    ellipse = getattr(rhino3dm, "Ellipse", None)
    if ellipse is not None and isinstance(curve, ellipse):
        return _read_rhino(rhino3dm.NurbsCurve.CreateFromEllipse(curve))
    if isinstance(curve, rhino3dm.Point3dList):
        return polyline_pieces([[p.X, p.Y, p.Z] for p in (curve[i] for i in range(len(curve)))])
    raise InputError("curve", f"a rhino3dm {type(curve).__name__} is not a curve; allowed is {_KINDS}")


def _read_compas_spline(curve: Any) -> Array:
    degree = int(curve.degree)
    xyz = polyline_pieces([list(p) for p in curve.points])
    points = np.concatenate([xyz[:1, 0], xyz[:, 1]])
    weights = getattr(curve, "weights", None)
    if weights is not None:
        points *= np.array([float(w) for w in weights])[:, None]
    if not hasattr(curve, "knots"):  # a Bezier curve is its own single piece
        return points[None]
    knots = getattr(curve, "knotvector", None)
    if knots is None:
        knots = np.repeat([float(k) for k in curve.knots], [int(m) for m in curve.multiplicities])
    return nurbs_pieces(points, np.array([float(k) for k in knots]), degree)


def _read_compas_conic(curve: Any) -> Array:
    if hasattr(curve, "major"):
        return arc_pieces(curve.frame, float(curve.major), float(curve.minor), 0.0, 2 * math.pi)
    if hasattr(curve, "start_angle"):
        r = float(curve.radius)
        return arc_pieces(curve.frame, r, r, float(curve.start_angle), float(curve.end_angle))
    if hasattr(curve, "radius"):
        r = float(curve.radius)
        return arc_pieces(curve.frame, r, r, 0.0, 2 * math.pi)
    raise InputError("curve", f"a COMPAS {type(curve).__name__} has no ends; allowed is {_KINDS}")
