"""Curves as targets: how far points are from them, and fine polylines along them."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hookean.discretize.curves import _check_count, _evaluate, end_points
from hookean.discretize.pieces import bezier_pieces

Array = NDArray[np.float64]

_SAMPLES = 65  # of every piece, its ends included
_NEAREST = 2  # samples a search starts from: where two pieces meet, their ends are the same point
_HALVINGS, _NEWTON = 26, 3


def distances(points: ArrayLike, curve: Any) -> Array:
    """Distances (n,) of points (n, 3) from a curve, in its length units.

    Between the neighbours of the nearest of 65 samples of each rational Bezier piece the interval in which
    |C(t) - p|^2 falls is halved, with Gauss-Newton steps at last, which make points on the curve exact to rounding.
    Curves are those of `divide`; raises InputError as it does.
    """
    from scipy.spatial import cKDTree

    p = np.asarray(points, dtype=np.float64).reshape(-1, 3)
    pieces = bezier_pieces(curve)
    steps = np.linspace(0.0, 1.0, _SAMPLES)
    samples = _evaluate(pieces, np.tile(steps, (len(pieces), 1)))[0].reshape(-1, 3)
    _, near = cKDTree(samples).query(p, k=_NEAREST)
    near = near.ravel()
    chosen, t = pieces[near // _SAMPLES], steps[near % _SAMPLES]
    towards = np.repeat(p, _NEAREST, axis=0)
    low, high = np.maximum(t - steps[1], 0.0), np.minimum(t + steps[1], 1.0)
    best = np.full(len(towards), np.inf)
    for step in range(_HALVINGS + _NEWTON):
        at, slope = (a[:, 0] for a in _evaluate(chosen, t[:, None]))
        apart = towards - at
        best = np.minimum(best, np.linalg.norm(apart, axis=1))
        ahead = (apart * slope).sum(axis=1)
        if step < _HALVINGS:
            low, high = np.where(ahead > 0.0, t, low), np.where(ahead > 0.0, high, t)
            t = 0.5 * (low + high)
        else:
            speed = (slope**2).sum(axis=1)
            t = np.clip(t + ahead / np.where(speed > 0.0, speed, np.inf), low, high)
    out: Array = best.reshape(-1, _NEAREST).min(axis=1)
    return out


def polyline(curve: Any, count: int) -> Array:
    """Corners of a polyline of `count` chords or a few more along a curve, kinks and ends kept.

    Every rational Bezier piece takes a share by its length, at least one chord, at even parameters: much quicker than
    equal arcs, and as good a target. Units and errors are those of `divide`; a closed curve ends where it starts.
    """
    pieces = bezier_pieces(curve)
    points = pieces[..., :3] / pieces[..., 3:]
    length = np.linalg.norm(np.diff(points, axis=1), axis=2).sum(axis=1)
    shares = np.maximum(np.ceil(_check_count(count) * length / length.sum() - 1e-9), 1.0).astype(np.int64)
    parts = [
        _evaluate(piece[None], np.linspace(0.0, 1.0, share + 1)[None])[0][0, :-1]
        for piece, share in zip(pieces, shares.tolist(), strict=True)
    ]
    out: Array = np.concatenate([*parts, end_points(curve)[1:]])
    return out
