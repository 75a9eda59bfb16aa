"""Curves to points and lines at equal arc lengths.

Every function takes a rhino3dm curve of any class (also the value types Line, Arc, Circle, Ellipse,
Polyline), a COMPAS Line, Polyline, Polygon, Arc, Circle, Ellipse, Bezier or NurbsCurve, or points
`(n, 3)` of a polyline.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.discretize.pieces import bezier_pieces
from hookean.errors import InputError

Array = NDArray[np.float64]

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(16)
_NODES, _WEIGHTS = 0.5 * (_NODES + 1.0), 0.5 * _WEIGHTS
_CLOSED = 1e-9  # ends nearer than this, relative to the size, are one point
_ACCURACY = 1e-13  # of one interval's integral, relative to the whole length
_DEEPEST = 60


def divide(curve: Any, count: int) -> Array:
    """Points `(count + 1, 3)` that cut a curve into `count` pieces of equal arc length.

    Point k lies at arc length k L / count with L the integral of |C'(t)|; the first and the last are
    the curve's ends. A closed curve gives `count` distinct points and its first point again at the
    end, the same to the bit; drop the last row for the distinct ones. Length units of the curve.

    Raises InputError where `count` is not a whole number >= 1, or the curve is unknown, has no
    length, a gap, or a number that is not finite.
    """
    n = _check_count(count)
    pieces = bezier_pieces(curve)
    first, last = _ends(pieces)
    unit = _normalised(pieces)[0]
    piece, a, b, lengths = _intervals(unit)
    upto = np.concatenate([[0.0], np.cumsum(lengths)])
    target = upto[-1] * np.arange(1, n) / n
    k = np.clip(np.searchsorted(upto, target, side="right") - 1, 0, len(lengths) - 1)
    t = _invert(unit[piece[k]], a[k], b[k], target - upto[k], lengths[k])
    inner = _evaluate(pieces[piece[k]], t[:, None])[0][:, 0]
    return np.concatenate([first[None], inner, last[None]])


def shatter(curve: Any, count: int) -> Array:
    """Lines `(count, 2, 3)` between neighbouring points of `divide(curve, count)`.

    Raises what `divide` raises.
    """
    points = divide(curve, count)
    return np.stack([points[:-1], points[1:]], axis=1)


def end_points(curve: Any) -> Array:
    """First and last point `(2, 3)` of a curve; the same point twice if it is closed.

    Raises InputError where the curve is not one `divide` accepts.
    """
    return np.stack(_ends(bezier_pieces(curve)))


def length(curve: Any) -> float:
    """Arc length, the integral of |C'(t)| over the curve, to about 1e-12 relative.

    Raises InputError where the curve is not one `divide` accepts.
    """
    unit, scale = _normalised(bezier_pieces(curve))
    return float(_intervals(unit)[3].sum()) * scale


def explode(polyline: Any) -> Array:
    """The straight segments `(m, 2, 3)` of a polyline, in order, those of no length left out.

    Accepts every curve made of straight pieces, whatever its class or degree. Raises InputError where
    a piece is curved, or the curve is not one `divide` accepts.
    """
    pieces = bezier_pieces(polyline)
    points = pieces[..., :3] / pieces[..., 3:]
    chord = np.linalg.norm(points[:, -1] - points[:, 0], axis=1)
    hull = np.linalg.norm(np.diff(points, axis=1), axis=2).sum(axis=1)
    bent = np.flatnonzero(hull - chord > 1e-12 * hull)
    if len(bent):
        raise InputError(
            "polyline",
            f"its piece {bent[0]} is curved; explode accepts straight pieces only; use shatter(curve, count)",
        )
    return np.stack([points[:, 0], points[:, -1]], axis=1)


def _check_count(count: Any) -> int:
    whole = isinstance(count, (int, np.integer)) or (isinstance(count, float) and count.is_integer())
    if isinstance(count, bool) or not whole or count < 1:
        raise InputError("count", f"{count!r} pieces were asked for; give a whole number of at least 1")
    return int(count)


def _ends(pieces: Array) -> tuple[Array, Array]:
    points = pieces[..., :3] / pieces[..., 3:]
    first, last = points[0, 0], points[-1, -1]
    size = np.ptp(points.reshape(-1, 3), axis=0).max()
    return first, first if np.abs(last - first).max() <= _CLOSED * size else last


def _normalised(pieces: Array) -> tuple[Array, float]:
    """The pieces moved to the origin and scaled to size 1, so that squares neither overflow nor cancel."""
    points = (pieces[..., :3] / pieces[..., 3:]).reshape(-1, 3)
    low, high = points.min(axis=0), points.max(axis=0)
    centre = 0.5 * low + 0.5 * high
    scale = 2.0 ** np.floor(np.log2((high - low).max()))  # a power of two keeps round numbers round
    unit = pieces.copy()
    unit[..., :3] = (points.reshape(*pieces.shape[:2], 3) - centre) / scale * pieces[..., 3:]
    return unit, float(scale)


def _evaluate(pieces: Array, t: Array) -> tuple[Array, Array]:
    """Points and derivatives `(m, q, 3)` of pieces `(m, p + 1, 4)` at parameters `(m, q)` in [0, 1].

    de Casteljau; with homogeneous C = (A, w): C' = (A' - (A / w) w') / w.
    """
    s = t[..., None]
    d = np.broadcast_to(pieces[:, :, None, :], (*pieces.shape[:2], t.shape[1], 4))
    while d.shape[1] > 2:
        d = (1.0 - s[:, None]) * d[:, :-1] + s[:, None] * d[:, 1:]
    value = (1.0 - s) * d[:, 0] + s * d[:, 1]
    slope = (pieces.shape[1] - 1) * (d[:, 1] - d[:, 0])
    point = value[..., :3] / value[..., 3:]
    return point, (slope[..., :3] - point * slope[..., 3:]) / value[..., 3:]


def _integral(pieces: Array, a: Array, b: Array) -> Array:
    """Arc length of each piece from `a` to `b` by 16-point Gauss-Legendre."""
    t = a[:, None] + (b - a)[:, None] * _NODES
    speed = np.linalg.norm(_evaluate(pieces, t)[1], axis=2)
    out: Array = (b - a) * (speed @ _WEIGHTS)
    return out


def _intervals(pieces: Array) -> tuple[NDArray[np.int64], Array, Array, Array]:
    """Parameter intervals, in order along the curve, each short enough for one Gauss rule.

    An interval is halved until its integral and the sum over its halves agree.
    """
    piece = np.arange(len(pieces))
    a, b = np.zeros(len(pieces)), np.ones(len(pieces))
    if pieces.shape[1] == 2 and (pieces[:, 0, 3] == pieces[:, 1, 3]).all():  # straight, at even speed
        chords = np.diff(pieces[..., :3] / pieces[..., 3:], axis=1)[:, 0]
        return piece, a, b, np.linalg.norm(chords, axis=1)
    whole = _integral(pieces, a, b)
    allowed = _ACCURACY * whole.sum()
    done: list[tuple[NDArray[np.int64], Array, Array, Array]] = []
    for depth in range(_DEEPEST + 1):
        m = 0.5 * (a + b)
        left, right = _integral(pieces[piece], a, m), _integral(pieces[piece], m, b)
        ok = (np.abs(left + right - whole) <= allowed) | (depth == _DEEPEST)
        done.append((np.repeat(piece[ok], 2), _mix(a, m, ok), _mix(m, b, ok), _mix(left, right, ok)))
        if ok.all():
            break
        piece = np.repeat(piece[~ok], 2)
        a, b, whole = _mix(a, m, ~ok), _mix(m, b, ~ok), _mix(left, right, ~ok)
    p, lo, hi, lengths = (np.concatenate(c) for c in zip(*done, strict=True))
    order = np.lexsort((lo, p))
    return p[order], lo[order], hi[order], lengths[order]


def _mix(first: Array, second: Array, keep: NDArray[np.bool_]) -> Array:
    return np.stack([first[keep], second[keep]], axis=1).ravel()


def _invert(pieces: Array, a: Array, b: Array, target: Array, whole: Array) -> Array:
    """Parameters t in [a, b] with arc length `target` from a: Newton, kept inside by bisection."""
    low, high = a.copy(), b.copy()
    with np.errstate(divide="ignore", invalid="ignore"):
        t = a + (b - a) * np.clip(np.nan_to_num(target / whole), 0.0, 1.0)
    for _ in range(100):
        miss = _integral(pieces, a, t) - target
        if (np.abs(miss) <= 1e-15 * whole).all():
            break
        low, high = np.where(miss < 0, t, low), np.where(miss < 0, high, t)
        speed = np.linalg.norm(_evaluate(pieces, t[:, None])[1][:, 0], axis=1)
        with np.errstate(divide="ignore", invalid="ignore"):
            newton = t - miss / speed
        inside = (newton >= low) & (newton <= high)
        new = np.where(inside, newton, 0.5 * (low + high))
        if (np.abs(new - t) <= 4e-16 * (b - a)).all():
            break
        t = new
    return t
