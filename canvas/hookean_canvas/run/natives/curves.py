"""Natives of the tab Curve: what measures, divides and joins curves."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import numpy as np

from hookean.discretize import curves as arc_lengths
from hookean_canvas.run.natives import shapes
from hookean_canvas.run.natives.along import divided, straight
from hookean_canvas.run.natives.along import length as measured
from hookean_canvas.run.natives.declare import Unfit, bounded, native
from hookean_canvas.run.rhino import rhino3dm

_CURVE = "Curve (C): curve"
_AT = "Points (P): list; Tangents (T): list; Parameters (t): list"
JOINED = 1e-3  # ends within this distance are one [length], as in a document with this tolerance


@native("11bbd48b-bb0a-4f1b-8167-fa297590390d", "End Points", "End", _CURVE, "Start (S); End (E)")
def end_points(curve: Any) -> tuple[Any, Any]:
    """The start and the end point of a curve."""
    return curve.PointAtStart, curve.PointAtEnd


@native("c75b62fa-0a33-4da7-a5bd-03fd0068fd93", "Length", "Len", _CURVE, "Length (L)")
def length(curve: Any) -> float:
    """The length of a curve."""
    return measured(curve)


@native("ccc7b468-e743-4049-891f-299432545898", "Curve Middle", "MidPt", _CURVE, "Midpoint (M)")
def middle(curve: Any) -> Any:
    """The point that halves the length of a curve."""
    return shapes.point(arc_lengths.divide(curve, 2)[1])


@native("2162e72e-72fc-4bf8-9459-d4d82fa8aa14", "Divide Curve", "Divide",
        f"{_CURVE}; Count (N): integer = 10; Kinks (K): boolean = False", _AT)  # fmt: skip
def divide_curve(curve: Any, count: int, kinks: bool) -> tuple[list[Any], list[Any], list[float]]:
    """Points at equal lengths along a curve, its ends included, with tangents and parameters; one less where it is
    closed. With Kinks also the points where its direction jumps."""
    if count < 1:
        raise Unfit("Count must be at least 1")
    bounded(count)
    at, domain = divided(curve, count), curve.Domain
    if curve.IsClosed:
        del at[-1]
    if kinks:
        tiny = 1e-9 * (domain.T1 - domain.T0)
        at += [t for t in _kinks(curve) if all(abs(t - known) > tiny for known in at)]
    return _evaluated(curve, sorted(at))


@native("1e531c08-9c80-46d6-8850-1b50d1dae69f", "Divide Distance", "DivDist",
        f"{_CURVE}; Distance (D): number", _AT)  # fmt: skip
def divide_distance(curve: Any, apart: float) -> tuple[list[Any], list[Any], list[float]]:
    """Points along a curve with equal straight distances from each other, the first at its start."""
    if apart <= 0.0:
        raise Unfit("Distance must be above 0")
    bounded(measured(curve) / apart)
    domain = curve.Domain
    samples = np.linspace(domain.T0, domain.T1, 4001)
    places = shapes.rows(curve.PointAt(float(t)) for t in samples)
    at, k = [domain.T0], 0
    while True:
        here = shapes.xyz(curve.PointAt(at[-1]))
        far = np.linalg.norm(places[k:] - here, axis=1) >= apart
        if not far.any():
            return _evaluated(curve, at)
        k += int(far.argmax())
        low, high = max(at[-1], float(samples[max(k - 1, 0)])), float(samples[k])
        for _ in range(60):
            mid = 0.5 * (low + high)
            if float(np.linalg.norm(shapes.xyz(curve.PointAt(mid)) - here)) < apart:
                low = mid
            else:
                high = mid
        at.append(high)


@native("fdc466a9-d3b8-4056-852a-09dba0f74aca", "Divide Length", "DivLength", f"{_CURVE}; Length (L): number", _AT)
def divide_length(curve: Any, step: float) -> tuple[list[Any], list[Any], list[float]]:
    """Points along a curve at a preset length from each other, the first at its start."""
    if step <= 0.0:
        raise Unfit("Length must be above 0")
    bounded(measured(curve) / step)
    count = math.floor(measured(curve) / step * (1.0 + 1e-12))
    at = [curve.Domain.T0] + [_at_length(curve, step * i) for i in range(1, count + 1)]
    return _evaluated(curve, at)


@native("6b021f56-b194-4210-b9a1-6cef3b7d0848", "Evaluate Length", "Eval",
        f"{_CURVE}; Length (L): number = 0.5; Normalized (N): boolean = True",
        "Point (P); Tangent (T); Parameter (t)")  # fmt: skip
def evaluate_length(curve: Any, along: float, normalized: bool) -> tuple[Any, Any, float]:
    """The point of a curve at a length from its start, or with Normalized at a part of its length."""
    t = _at_length(curve, along * measured(curve) if normalized else along)
    return curve.PointAt(t), curve.TangentAt(t), t


@native("fc6979e4-7e91-4508-8e05-37c680779751", "Evaluate Curve", "Eval",
        f"{_CURVE}; Parameter (t): number = 0.5", "Point (P); Tangent (T); Angle (A)")  # fmt: skip
def evaluate_curve(curve: Any, t: float) -> tuple[Any, Any, float]:
    """The point and the tangent of a curve at a parameter, and the angle between the directions before and after."""
    domain = curve.Domain
    tiny = 1e-7 * (domain.T1 - domain.T0)
    before, after = (shapes.xyz(curve.TangentAt(min(max(t + d, domain.T0), domain.T1))) for d in (-tiny, tiny))
    turn = math.atan2(float(np.linalg.norm(np.cross(before, after))), float(before @ after))
    return curve.PointAt(t), curve.TangentAt(t), turn if turn > 1e-5 else 0.0


def _evaluated(curve: Any, at: list[float]) -> tuple[list[Any], list[Any], list[float]]:
    return [curve.PointAt(t) for t in at], [curve.TangentAt(t) for t in at], at


def _at_length(curve: Any, along: float) -> float:
    """The parameter at a length from the start."""
    from scipy.optimize import brentq

    domain = curve.Domain
    run, whole = straight(curve), measured(curve)
    if along <= 0.0:
        return float(domain.T0)
    if along >= whole * (1.0 - 1e-14):
        return float(domain.T1)
    if run is not None:
        return run.at_lengths([along])[0]
    return float(brentq(lambda t: _upto(curve, t) - along, domain.T0, domain.T1, xtol=1e-14 * abs(domain.T1) + 1e-300))


def _upto(curve: Any, t: float) -> float:
    domain = curve.Domain
    if t <= domain.T0:
        return 0.0
    return measured(curve if t >= domain.T1 else curve.Trim(domain.T0, t))


@native("afb96615-c59a-45c9-9cac-e27acb1c7ca0", "Explode", "Explode",
        f"{_CURVE}; Recursive (R): boolean = True", "Segments (S): list; Vertices (V): list")  # fmt: skip
def explode(curve: Any, recursive: bool) -> tuple[list[Any], list[Any]]:
    """The segments of a polyline or joined curve, split where the direction jumps, and the points between them."""
    found = segments(curve)
    vertices = [found[0].PointAtStart, *(one.PointAtEnd for one in found)]
    return found, vertices[:-1] if curve.IsClosed and len(found) > 1 else vertices


def segments(curve: Any) -> list[Any]:
    """The smooth pieces of a curve, in order; straight ones as LineCurve."""
    if isinstance(curve, rhino3dm.PolyCurve):
        return [piece for i in range(curve.SegmentCount) for piece in segments(curve.SegmentCurve(i))]
    places = shapes.corners(curve)
    if places is not None:
        ends = shapes.points(places)
        return [rhino3dm.LineCurve(a, b) for a, b in pairwise(ends)]
    pieces = [curve]
    for t in _kinks(curve):
        first, rest = pieces.pop().Split(t)
        pieces += [first, rest]
    return pieces


def _kinks(curve: Any) -> list[float]:
    """Parameters within a curve at which its direction jumps."""
    nurbs = curve.ToNurbsCurve()
    domain = curve.Domain
    knots = sorted({nurbs.Knots[i] for i in range(len(nurbs.Knots))})
    found = []
    for knot in knots[1:-1]:
        t = float(curve.GetCurveParameterFromNurbsFormParameter(knot)[1])
        tiny = 1e-7 * (domain.T1 - domain.T0)
        before, after = (shapes.xyz(curve.TangentAt(t + d)) for d in (-tiny, tiny))
        if float(before @ after) < math.cos(math.radians(0.01)):
            found.append(t)
    return found


@native("269eaa85-9997-4d77-a9ba-4c58cb45c9d3", "Discontinuity", "Disc",
        f"{_CURVE}; Level (L): integer = 1", "Points (P): list; Parameters (t): list",
        remark="only jumps of the direction are found")  # fmt: skip
def discontinuity(curve: Any, level: int) -> tuple[list[Any], list[float]]:
    """The points at which the direction of a curve jumps, and the ends of an open curve."""
    domain = curve.Domain
    at = _kinks(curve)
    if not curve.IsClosed:
        at = [domain.T0, *at, domain.T1]
    return [curve.PointAt(t) for t in at], at


@native("8073a420-6bec-49e3-9b18-367f6fd76ac3", "Join Curves", "Join",
        "Curves (C): curve list; Preserve (P): boolean = False", "Curves (C): list")  # fmt: skip
def join_curves(curves: list[Any], preserve: bool) -> list[Any]:
    """Curves joined where their ends meet within 0.001, as many as possible; straight ones become polylines."""
    rest = [curve for curve in curves if curve is not None]
    found = []
    while rest:
        chain = [rest.pop(0)]
        while (place := _next(chain, rest, preserve)) is not None:
            number, at_end, turned = place
            piece = rest.pop(number)
            if turned:
                piece = piece.Duplicate()
                piece.Reverse()
            chain.insert(len(chain) if at_end else 0, piece)
        found.append(_joined(chain))
    return found


def _next(chain: list[Any], rest: list[Any], preserve: bool) -> tuple[int, bool, bool] | None:
    """Which of the rest meets the chain, whether at its end, and whether it has to be turned round."""
    start, end = shapes.xyz(chain[0].PointAtStart), shapes.xyz(chain[-1].PointAtEnd)
    if len(chain) and np.linalg.norm(end - start) <= JOINED and (len(chain) > 1 or chain[0].IsClosed):
        return None
    for number, curve in enumerate(rest):
        first, last = shapes.xyz(curve.PointAtStart), shapes.xyz(curve.PointAtEnd)
        for at_end, place, near, far in ((True, end, first, last), (False, start, last, first)):
            if np.linalg.norm(near - place) <= JOINED:
                return number, at_end, False
            if not preserve and np.linalg.norm(far - place) <= JOINED:
                return number, at_end, True
    return None


def _joined(chain: list[Any]) -> Any:
    if len(chain) == 1:
        return chain[0]
    parts = [shapes.corners(curve) for curve in chain]
    if all(part is not None for part in parts):
        places = np.concatenate([parts[0], *(part[1:] for part in parts[1:] if part is not None)])
        if np.linalg.norm(places[-1] - places[0]) <= JOINED:
            places[-1] = places[0]
        return shapes.polyline(places)
    whole = rhino3dm.PolyCurve()
    for curve in chain:
        whole.Append(curve)
    return whole


@native("424eb433-2b3a-4859-beaf-804d8af0afd7", "Control Points", "CP",
        _CURVE, "Points (P): list; Weights (W): list; Knots (K): list")  # fmt: skip
def control_points(curve: Any) -> tuple[list[Any], list[float], list[float]]:
    """Control points, weights and knots of a curve as NURBS."""
    nurbs = curve.ToNurbsCurve()
    found = [nurbs.Points[i] for i in range(len(nurbs.Points))]
    places = [rhino3dm.Point3d(p.X / p.W, p.Y / p.W, p.Z / p.W) for p in found]
    return places, [p.W for p in found], [nurbs.Knots[i] for i in range(len(nurbs.Knots))]


@native("ccfd6ba8-ecb1-44df-a47e-08126a653c51", "Curve Domain", "CrvDom",
        f"{_CURVE}; Domain (D): domain optional", "Curve (C); Domain (D)")  # fmt: skip
def curve_domain(curve: Any, domain: Any) -> tuple[Any, Any]:
    """A curve, with another domain if one is given, and the domain it had."""
    before = curve.Domain
    if domain is None:
        return curve, before
    copy = curve.ToNurbsCurve()
    copy.Domain = domain
    return copy, before


@native("323f3245-af49-4489-8677-7a2c73664077", "Closed", "Cls", _CURVE, "Closed (C); Periodic (P)")
def closed(curve: Any) -> tuple[bool, bool]:
    """Whether a curve is closed, and whether it is periodic."""
    return bool(curve.IsClosed), bool(curve.IsPeriodic)


@native("22990b1f-9be6-477c-ad89-f775cd347105", "Flip Curve", "Flip",
        f"{_CURVE}; Guide (G): curve optional", "Curve (C); Flag (F)")  # fmt: skip
def flip_curve(curve: Any, guide: Any) -> tuple[Any, bool]:
    """A curve in the other direction; with a guide only where it runs against the guide."""
    if guide is not None:
        ways = [shapes.xyz(one.PointAtEnd) - shapes.xyz(one.PointAtStart) for one in (curve, guide)]
        if float(ways[0] @ ways[1]) >= 0.0:
            return curve, False
    copy = curve.Duplicate()
    copy.Reverse()
    return copy, True


@native("2ad2a4d4-3de1-42f6-a4b8-f71835f35710", "Shatter", "Shatter",
        f"{_CURVE}; Parameters (t): number list", "Segments (S): list")  # fmt: skip
def shatter(curve: Any, parameters: list[float]) -> list[Any]:
    """The pieces of a curve between some parameters."""
    domain = curve.Domain
    at = sorted({t for t in parameters if t is not None and domain.T0 < t < domain.T1})
    pieces = [curve]
    for t in at:
        pieces += list(pieces.pop().Split(t))
    return pieces


@native("429cbba9-55ee-4e84-98ea-876c44db879a", "Sub Curve", "SubCrv",
        "Base curve (C): curve; Domain (D): domain", "Curve (C)")  # fmt: skip
def sub_curve(curve: Any, domain: Any) -> Any:
    """The piece of a curve between two parameters."""
    found = curve.Trim(domain.T0, domain.T1)
    if found is None:
        raise Unfit("the domain is not within that of the curve")
    return found
