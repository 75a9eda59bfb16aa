"""Natives of the tab Curve that change curves: extended, rounded, rebuilt, smoothed, cut into dashes."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import numpy as np

from hookean.discretize import curves as arc_lengths
from hookean_canvas.run.natives import shapes
from hookean_canvas.run.natives.curves import _at_length, _joined, closed, segments
from hookean_canvas.run.natives.curves_at import point_in_curve
from hookean_canvas.run.natives.declare import Unfit, bounded, native
from hookean_canvas.run.natives.places import _closest, curve_curve
from hookean_canvas.run.rhino import rhino3dm

Array = shapes.Array
_CURVE = "Curve (C): curve"
PIECES = 100
"""Places at which curves are projected, pulled and blended."""


def _corners(curve: Any) -> Array:
    found = shapes.corners(curve)
    if found is None:
        raise Unfit("the curve is not a polyline")
    return found


def _looped(rows: Array) -> bool:
    return len(rows) > 3 and float(np.linalg.norm(rows[-1] - rows[0])) <= 1e-9 * float(np.ptp(rows, axis=0).max())


@native("62cc9684-6a39-422e-aefa-ed44643557b9", "Extend Curve", "Ext",
        f"{_CURVE}; Type (T): integer = 0; Start (L0): number = 0.0; End (L1): number = 0.0", "Curve (C)",
        remark="curves are extended by straight lines, whatever the type")  # fmt: skip
def extend_curve(curve: Any, kind: int, start: float, end: float) -> Any:
    """A curve that goes on straight by lengths at its start and its end."""
    if curve.IsClosed:
        raise Unfit("a closed curve has no ends")
    pieces = [curve]
    for length, first in ((start, True), (end, False)):
        at, way = (curve.PointAtStart, curve.TangentAtStart) if first else (curve.PointAtEnd, curve.TangentAtEnd)
        if length > 0.0:
            far = shapes.point(shapes.xyz(at) + (-length if first else length) * shapes.unit(shapes.xyz(way)))
            pieces.insert(0 if first else len(pieces), rhino3dm.LineCurve(*((far, at) if first else (at, far))))
    corners = shapes.corners(curve)
    if corners is not None and len(corners) == 2:  # a line stays one
        return rhino3dm.LineCurve(pieces[0].PointAtStart, pieces[-1].PointAtEnd)
    return _joined(pieces)


def _rounded(curve: Any, cut: Any) -> Any:
    """A polyline with an arc at each corner that begins at a distance `cut(half of the angle)` from it."""
    rows = _corners(curve)
    loop = _looped(rows)
    if loop:
        rows = rows[:-1]
    count = len(rows)
    pieces: list[Any] = []
    ends: list[tuple[Array, Array]] = []
    for i in range(count):
        p, at, q = rows[i - 1], rows[i], rows[(i + 1) % count]
        if not loop and i in (0, count - 1):
            ends.append((at, at))
            continue
        back, on = shapes.unit(p - at), shapes.unit(q - at)
        half = 0.5 * math.acos(float(np.clip(back @ on, -1.0, 1.0)))
        room = 0.5 * min(float(np.linalg.norm(p - at)), float(np.linalg.norm(q - at)))
        far = cut(half) if half < 0.5 * math.pi - 1e-9 else 0.0
        ends.append((at + far * back, at + far * on) if 0.0 < far <= room + 1e-12 else (at, at))
    for i in range(count):
        start, end = ends[i]
        if float(np.linalg.norm(end - start)) > 0.0:
            pieces.append(_arc(rows[i], start, end))
        following = ends[(i + 1) % count][0]
        if (loop or i < count - 1) and float(np.linalg.norm(following - end)) > 1e-12:
            pieces.append(rhino3dm.LineCurve(shapes.point(end), shapes.point(following)))
    return _joined(pieces)


def _arc(corner: Array, start: Array, end: Array) -> Any:
    """The arc at a corner that begins and ends along its sides at equal distances."""
    far = float(np.linalg.norm(start - corner))
    inward = 0.5 * (start + end) - corner
    deep = float(np.linalg.norm(inward))  # far cos(half); the centre is far / cos(half) from the corner
    radius = far * math.sqrt(max(far**2 - deep**2, 0.0)) / deep
    middle = corner + (far**2 / deep - radius) * shapes.unit(inward)
    return rhino3dm.ArcCurve.CreateFromArc(rhino3dm.Arc(*map(shapes.point, (start, middle, end))))


@native("2f407944-81c3-4062-a485-276454ec4b8c", "Fillet", "Fillet", f"{_CURVE}; Radius (R): number", "Curve (C)",
        remark="corners of polylines alone; those too near to the next corner stay sharp")  # fmt: skip
def fillet(curve: Any, radius: float) -> Any:
    """A polyline with its corners rounded by arcs of a radius."""
    return _rounded(curve, lambda half: radius / math.tan(half)) if radius > 0.0 else curve


@native("6fb21315-a032-400e-a80f-248687f5507f", "Fillet Distance", "Fillet", f"{_CURVE}; Distance (D): number",
        "Curve (C)", remark="corners of polylines alone; those too near to the next corner stay sharp")  # fmt: skip
def fillet_distance(curve: Any, distance: float) -> Any:
    """A polyline with its corners rounded by arcs that begin at a distance from them."""
    return _rounded(curve, lambda half: distance) if distance > 0.0 else curve


@native("9333c5b3-11f9-423c-bbb5-7e5156430219", "Rebuild Curve", "ReB",
        f"{_CURVE}; Degree (D): integer optional; Count (N): integer = 10; Tangents (T): boolean = False", "Curve (C)",
        remark="by least squares at 400 places of equal lengths; Rhino's control points differ a little")  # fmt: skip
def rebuild_curve(curve: Any, degree: int | None, count: int, tangents: bool) -> Any:
    """A curve with so many control points, nearest to a curve."""
    k = min(degree or curve.Degree, count - 1)
    if count < 2 or k < 1:
        raise Unfit("Count must be at least 2, and Degree at least 1")
    bounded(count)
    return fitted(shapes.rows(curve.PointAt(_at_length(curve, s)) for s in _along(curve, 400)), count, k)


def _along(curve: Any, pieces: int) -> list[float]:
    lengths: list[float] = np.linspace(0.0, arc_lengths.length(curve), pieces + 1).tolist()
    return lengths


def fitted(rows: Array, count: int, degree: int) -> Any:
    """The NURBS curve of `count` control points nearest to points by their chords, which meets the first and last."""
    from scipy.interpolate import make_lsq_spline

    at = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(rows, axis=0), axis=1))])
    inner = np.linspace(0.0, at[-1], count - degree + 1)[1:-1]
    knots = np.concatenate([[0.0] * (degree + 1), inner, [at[-1]] * (degree + 1)])
    weights = np.ones(len(rows))
    weights[[0, -1]] = 1e6
    places = make_lsq_spline(at, rows, knots, degree, w=weights).c
    places[0], places[-1] = rows[0], rows[-1]
    found = rhino3dm.NurbsCurve(3, False, degree + 1, count)
    for i, (x, y, z) in enumerate(places.tolist()):
        found.Points[i] = rhino3dm.Point4d(x, y, z, 1.0)
    for i, knot in enumerate(knots[1:-1].tolist()):
        found.Knots[i] = knot
    return found


@native("a3f9f19e-3e6c-4ac7-97c3-946de32c3e8e", "Fit Curve", "Fit",
        f"{_CURVE}; Degree (D): integer optional; Tolerance (Ft): number optional", "Curve (C)")  # fmt: skip
def fit_curve(curve: Any, degree: int | None, tolerance: float | None) -> Any:
    """The curve of the fewest control points that stays within a tolerance, or 0.001, of a curve at 400 places."""
    k, near = max(degree or curve.Degree, 1), tolerance or 1e-3
    rows = shapes.rows(curve.PointAt(_at_length(curve, s)) for s in _along(curve, 400))
    for count in (*range(k + 1, 20), 25, 30, 40, 60, 80, 120):
        made = fitted(rows, count, k)
        ends = np.linspace(made.Domain.T0, made.Domain.T1, 401).tolist()
        if float(np.linalg.norm(shapes.rows(map(made.PointAt, ends)) - rows, axis=1).max()) <= near:
            return made
    return curve


@native("42ad8dc1-b0c0-40df-91f5-2c46e589e6c2", "Seam", "Seam", f"{_CURVE}; Seam (t): number", "Curve (C)")
def seam(curve: Any, t: float) -> Any:
    """A closed curve that starts at another parameter."""
    if not closed(curve)[0]:
        raise Unfit("the curve is not closed")
    domain = curve.Domain
    if not domain.T0 < t < domain.T1:
        return curve
    first, rest = curve.Split(t)
    return _joined([rest, first])


@native("884646c3-0e70-4ad1-90c5-42601ee26450", "Reduce", "RedPLine",
        "Polyline (P): curve; Tolerance (T): number", "Polyline (P); Reduction (R)")  # fmt: skip
def reduce_polyline(curve: Any, tolerance: float) -> tuple[Any, int]:
    """A polyline without corners that are within a tolerance of it without them, and how many went.

    Source: D. H. Douglas and T. K. Peucker, 1973.
    """
    rows = _corners(curve)
    kept = sorted(_needed(rows, 0, len(rows) - 1, tolerance) | {0, len(rows) - 1})
    return shapes.polyline(rows[kept]), len(rows) - len(kept)


def _needed(rows: Array, first: int, last: int, tolerance: float) -> set[int]:
    if last - first < 2:
        return set()
    start, way = rows[first], rows[last] - rows[first]
    square = float(way @ way)
    between = rows[first + 1 : last] - start
    t = np.clip(between @ way / square, 0.0, 1.0) if square > 0.0 else np.zeros(len(between))
    apart = np.linalg.norm(between - t[:, None] * way, axis=1)
    k = first + 1 + int(apart.argmax())
    if apart.max() <= tolerance:
        return set()
    return {k} | _needed(rows, first, k, tolerance) | _needed(rows, k, last, tolerance)


@native("922dc7e5-0f0e-4c21-ae4b-f6a8654e63f6", "Simplify Curve", "Simplify",
        f"{_CURVE}; Tolerance (t): number optional; Angle Tolerance (a): number optional",
        "Curve (C); Simplified (S)", remark="corners of polylines alone")  # fmt: skip
def simplify_curve(curve: Any, tolerance: float | None, angle: float | None) -> tuple[Any, bool]:
    """A polyline without corners that are on the line between their neighbours."""
    if shapes.corners(curve) is None:
        return curve, False
    made, gone = reduce_polyline(curve, tolerance or 1e-3)
    return made, gone > 0


@native("5c5fbc42-3e1d-4081-9cf1-148d0b1d9610", "Smooth Polyline", "SmoothPLine",
        "Polyline (P): curve; Strength (S): number = 0.5; Times (T): integer = 1", "Polyline (P)")  # fmt: skip
def smooth_polyline(curve: Any, strength: float, times: int) -> Any:
    """A polyline whose corners move so far to the middle of their neighbours, so often; open ends stay."""
    rows = _corners(curve).copy()
    loop = _looped(rows)
    bounded(times * len(rows))
    for _ in range(times):
        if loop:
            ring = rows[:-1]
            ring = ring + strength * (0.5 * (np.roll(ring, 1, axis=0) + np.roll(ring, -1, axis=0)) - ring)
            rows = np.concatenate([ring, ring[:1]])
        else:
            rows[1:-1] += strength * (0.5 * (rows[:-2] + rows[2:]) - rows[1:-1])
    return shapes.polyline(rows)


@native("be298882-28c9-45b1-980d-7192a531c9a9", "Polyline Collapse", "PCol",
        "Polyline (P): curve; Tolerance (t): number", "Polyline (Pl); Count (N)")  # fmt: skip
def polyline_collapse(curve: Any, tolerance: float) -> tuple[Any, int]:
    """A polyline without pieces shorter than a tolerance, each end of which goes to the corner before."""
    rows = _corners(curve)
    kept = [rows[0]]
    for row in rows[1:]:
        if float(np.linalg.norm(row - kept[-1])) >= tolerance:
            kept.append(row)
    if len(kept) < 2:
        raise Unfit("all pieces are shorter than the tolerance")
    kept[-1] = rows[-1]
    return shapes.polyline(np.array(kept)), len(rows) - len(kept)


@native("95866bbe-648e-4e2b-a97c-7d04679e94e0", "Dash Pattern", "Dash", f"{_CURVE}; Pattern (Pt): number list",
        "Dashes (D): list; Gaps (G): list")  # fmt: skip
def dash_pattern(curve: Any, pattern: list[float]) -> tuple[list[Any], list[Any]]:
    """A curve cut into lengths of a pattern that is repeated: dashes and gaps in turn."""
    if not pattern or min(pattern) < 0.0 or sum(pattern) <= 0.0:
        raise Unfit("the pattern must hold lengths above 0")
    whole, at = arc_lengths.length(curve), 0.0
    found: tuple[list[Any], list[Any]] = ([], [])
    bounded(whole / sum(pattern) * len(pattern))
    number = 0
    while at < whole * (1.0 - 1e-12):
        end = min(at + pattern[number % len(pattern)], whole)
        if end > at:
            found[number % 2].append(curve.Trim(_at_length(curve, at), _at_length(curve, end)))
        at, number = end, number + 1
    return found


@native("139619d2-8b18-47b6-b3b9-bf4fec0d6eb1", "Tween Curve", "TweenCrv",
        "Curve A (A): curve; Curve B (B): curve; Factor (F): number = 0.5", "Tween (T)",
        remark="a polyline of 100 pieces between curves that are not polylines of as many corners")  # fmt: skip
def tween_curve(a: Any, b: Any, factor: float) -> Any:
    """The curve between two curves, at a part of the way from the first to the second."""
    rows = [shapes.corners(one) for one in (a, b)]
    if rows[0] is None or rows[1] is None or len(rows[0]) != len(rows[1]):
        rows = [np.array(arc_lengths.divide(one, PIECES)) for one in (a, b)]
    return shapes.polyline((1.0 - factor) * np.asarray(rows[0]) + factor * np.asarray(rows[1]))


@native("6b5812f5-bb36-4d74-97fc-5a1f2f77452d", "Pull Curve", "Pull", f"{_CURVE}; Surface (S): surface", "Curve (C)",
        remark="a polyline through the nearest points of 101 places")  # fmt: skip
def pull_curve(curve: Any, surface: Any) -> Any:
    """A curve moved to the nearest points of a surface."""
    places = shapes.points(arc_lengths.divide(curve, PIECES))
    return shapes.polyline(shapes.rows(_closest(place, surface) for place in places))


@native("3092caf0-7cf9-4885-bcc0-e635d878832a 26949c81-9b50-43b7-ac49-3203deb6eec7", "Trim with Region", "Trim",
        f"{_CURVE}; Region (R): curve list; Plane (P): plane optional",
        "Curve Inside (Ci): list; Curve Outside (Co): list")  # fmt: skip
def trim_with_regions(curve: Any, regions: list[Any], frame: Any) -> tuple[list[Any], list[Any]]:
    """The pieces of a curve inside closed curves in its plane, and those outside."""
    domain = curve.Domain
    cuts = sorted({t for region in regions for t in curve_curve(curve, region)[1]})
    ends = [domain.T0, *(t for t in cuts if domain.T0 + 1e-9 < t < domain.T1 - 1e-9), domain.T1]
    found: tuple[list[Any], list[Any]] = ([], [])
    for start, end in pairwise(ends):
        piece = curve.Trim(start, end) if len(ends) > 2 else curve
        middle = curve.PointAt(0.5 * (start + end))
        within = any(point_in_curve(middle, region)[0] == 2 for region in regions)
        found[0 if within else 1].append(piece)
    return found


@native("d0a1b843-873d-4d1d-965c-b5423b35f327", "Connect Curves", "Connect",
        "Curves (C): curve list; Continuity (G): integer = 1; Loop (L): boolean = False; Bulge (B): number = 0.5",
        "Curve (C)", remark="connected by straight lines with continuity 0, else by Bézier curves along the tangents",
        )  # fmt: skip
def connect_curves(curves: list[Any], continuity: int, loop: bool, bulge: float) -> Any:
    """Curves one after the other with pieces between them."""
    pairs = list(pairwise([*curves, *curves[:1]] if loop else curves))
    pieces = [piece for a, b in pairs for piece in (a, blend_curve(a, b, bulge, bulge, continuity))]
    return _joined([one for whole in (pieces if loop else [*pieces, curves[-1]]) for one in segments(whole)])


@native("5909dbcb-4950-4ce4-9433-7cf9e62ee011", "Blend Curve", "BlendC",
        "Curve A (A): curve; Curve B (B): curve; Bulge A (Fa): number = 1.0; Bulge B (Fb): number = 1.0; "
        "Continuity (C): integer = 1", "Blend (B)",
        remark="a cubic Bézier curve along both tangents, also with continuity 2; its bulge may differ")  # fmt: skip
def blend_curve(a: Any, b: Any, first: float, second: float, continuity: int) -> Any:
    """A curve from the end of one curve to the start of another."""
    start, end = shapes.xyz(a.PointAtEnd), shapes.xyz(b.PointAtStart)
    if continuity < 1:
        return rhino3dm.LineCurve(shapes.point(start), shapes.point(end))
    reach = float(np.linalg.norm(end - start)) / 3.0
    rows = [start, start + first * reach * shapes.unit(shapes.xyz(a.TangentAtEnd)),
            end - second * reach * shapes.unit(shapes.xyz(b.TangentAtStart)), end]  # fmt: skip
    return bezier(np.array(rows))


def bezier(rows: Array) -> Any:
    """The Bézier curve of its control points, with parameters from 0 to 1."""
    order = len(rows)
    found = rhino3dm.NurbsCurve(3, False, order, order)
    for i, (x, y, z) in enumerate(rows.tolist()):
        found.Points[i] = rhino3dm.Point4d(x, y, z, 1.0)
    for i in range(2 * order - 2):
        found.Knots[i] = 0.0 if i < order - 1 else 1.0
    return found
