"""Parameters of curves at lengths and at places: of straight ones at once, of curved ones by a search."""

from __future__ import annotations

from typing import Any

import numpy as np

from hookean.discretize import curves as arc_lengths
from hookean_canvas.run.natives import shapes
from hookean_canvas.run.rhino import rhino3dm

SAMPLES = 400
"""Parts of a curve, at least, between which a place is sought."""


class Straight:
    """A line or a polyline whose parameter grows by as much on each segment: its corners, and lengths up to them."""

    def __init__(self, at: shapes.Array, ends: tuple[float, float]) -> None:
        self.at = at
        self.parameters = np.linspace(*ends, len(at))
        self.lengths = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(at, axis=0), axis=1))])

    def at_lengths(self, along: Any) -> list[float]:
        """The parameters at lengths from the start."""
        found: list[float] = np.interp(along, self.lengths, self.parameters).tolist()
        return found

    def nearest(self, place: shapes.Array) -> float:
        """The parameter of the point that is nearest to a place."""
        start, way = self.at[:-1], np.diff(self.at, axis=0)
        part = np.clip(((place - start) * way).sum(axis=1) / (way * way).sum(axis=1), 0.0, 1.0)
        k = int(np.argmin(np.linalg.norm(start + part[:, None] * way - place, axis=1)))
        return float(self.parameters[k] + part[k] * (self.parameters[k + 1] - self.parameters[k]))


def straight(curve: Any) -> Straight | None:
    """A line or a polyline, for what can be had at once; None for other curves."""
    if not isinstance(curve, (rhino3dm.LineCurve, rhino3dm.PolylineCurve)):
        return None
    found = Straight(shapes.corners(curve), (curve.Domain.T0, curve.Domain.T1))  # type: ignore[arg-type]
    inner = shapes.rows(curve.PointAt(t) for t in found.parameters[1:-1].tolist()) if len(found.at) > 2 else found.at
    uneven = len(found.at) > 2 and np.abs(inner - found.at[1:-1]).max() > 1e-9 * np.ptp(found.at, axis=0).max()
    return None if uneven or not np.diff(found.lengths).all() else found


def length(curve: Any) -> float:
    """The length of a curve."""
    run = straight(curve)
    return arc_lengths.length(curve) if run is None else float(run.lengths[-1])


def divided(curve: Any, count: int) -> list[float]:
    """Parameters at equal lengths along a curve, of its ends too."""
    domain = curve.Domain
    run = straight(curve)
    if run is not None:
        return run.at_lengths(np.linspace(0.0, run.lengths[-1], count + 1))
    places = np.array(arc_lengths.divide(curve, count))
    samples = np.linspace(domain.T0, domain.T1, max(SAMPLES, 4 * count) + 1)
    known = shapes.rows(curve.PointAt(t) for t in samples.tolist())
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(known, axis=0), axis=1))])
    near = np.searchsorted(along, np.arange(count + 1) / count * along[-1])
    size = float(np.ptp(known, axis=0).max())
    found = [_refined(curve, samples[max(k - 3, 0)], samples[min(k + 2, len(samples) - 1)], place, size)
             for k, place in zip(near.tolist(), places, strict=False)]  # fmt: skip
    return [float(domain.T0), *found[1:count], float(domain.T1)]


def _refined(curve: Any, low: float, high: float, place: shapes.Array, size: float) -> float:
    """The parameter of a point on a curve between two others; where it is not between them, anywhere."""
    t = _least(curve, float(low), float(high), place)
    if float(np.linalg.norm(shapes.xyz(curve.PointAt(t)) - place)) <= 1e-6 * size:
        return t
    ends = np.linspace(curve.Domain.T0, curve.Domain.T1, SAMPLES + 1).tolist()
    k = int(np.argmin(np.linalg.norm(shapes.rows(curve.PointAt(end) for end in ends) - place, axis=1)))
    return _least(curve, ends[max(k - 1, 0)], ends[min(k + 1, SAMPLES)], place)


def _least(curve: Any, low: float, high: float, place: shapes.Array) -> float:
    """The parameter between two others of the point that is nearest to a place."""
    from scipy.optimize import brentq, minimize_scalar

    tiny = 1e-14 * (curve.Domain.T1 - curve.Domain.T0)

    def ahead(t: float) -> float:
        return float((shapes.xyz(curve.PointAt(t)) - place) @ shapes.xyz(curve.TangentAt(t)))

    def apart(t: float) -> float:
        return float(np.sum((shapes.xyz(curve.PointAt(float(t))) - place) ** 2))

    if ahead(low) < 0.0 < ahead(high):
        return float(brentq(ahead, low, high, xtol=tiny))
    return float(minimize_scalar(apart, bounds=(low, high), method="bounded", options={"xatol": 10.0 * tiny}).x)
