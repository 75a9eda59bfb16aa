"""Natives of the tab Curve that measure: curvature, sides, lengths between parameters, planes of curves."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from hookean.discretize import curves as arc_lengths
from hookean_canvas.run.natives import shapes
from hookean_canvas.run.natives.curves import _upto
from hookean_canvas.run.natives.curves_at import nearest, point_in_curve
from hookean_canvas.run.natives.declare import Unfit, native
from hookean_canvas.run.natives.places import _closest
from hookean_canvas.run.rhino import rhino3dm

Array = shapes.Array
_CURVE = "Curve (C): curve"
_AT = f"{_CURVE}; Parameter (t): number"
SAMPLES = 256
"""Places of a curve at which it is measured where there is no closed form."""


def _derivatives(curve: Any, t: float, count: int) -> list[Array]:
    """The point and derivatives of a curve by its parameter."""
    return [shapes.xyz(one) for one in curve.DerivativeAt(t, count)]


def _sampled(curve: Any) -> Array:
    """Corners of a curve; of a curved one points at even steps of its parameter."""
    corners = shapes.corners(curve)
    ends = np.linspace(curve.Domain.T0, curve.Domain.T1, SAMPLES + 1).tolist()
    return corners if corners is not None else shapes.rows(map(curve.PointAt, ends))


@native("aaa665bd-fd6e-4ccb-8d2c-c5b33072125d", "Curvature", "Curvature", _AT,
        "Point (P); Curvature (K); Curvature circle (C)")  # fmt: skip
def curvature(curve: Any, t: float) -> tuple[Any, Any, Any]:
    """The vector to the centre of curvature over its length squared, and the circle; null where the curve is straight.

    K = (r' x r'') x r' / |r'|^4.
    """
    at, first, second = _derivatives(curve, t, 2)
    k = np.cross(np.cross(first, second), first) / float(first @ first) ** 2
    size = float(np.linalg.norm(k))
    if size < 1e-12:
        return curve.PointAt(t), rhino3dm.Vector3d(0.0, 0.0, 0.0), None
    frame = shapes.plane(at + k / size**2, -k, first)
    circle = rhino3dm.ArcCurve.CreateFromCircle(rhino3dm.Circle(1.0 / size))
    circle.Transform(rhino3dm.Transform.PlaneToPlane(shapes.plane((0, 0, 0), (1, 0, 0), (0, 1, 0)), frame))
    return curve.PointAt(t), shapes.vector(k), circle


@native("ab14760f-87a6-462e-b481-4a2c26a9a0d7", "Derivatives", "CDiv", _AT,
        "Point (P); First derivative (1) ...", sees=True)  # fmt: skip
def derivatives(curve: Any, t: float, node: Any) -> tuple[Any, ...]:
    """The point of a curve, and its derivatives by the parameter, one for each output."""
    count = max(len(node.outputs) - 1, 1) if node is not None else 1
    return (curve.PointAt(t), *map(shapes.vector, _derivatives(curve, t, count)[1:]))


@native("dbe9fce4-b6b3-465f-9615-34833c4763bd", "Torsion", "Torsion", _AT, "Point (P); Torsion (T)")
def torsion(curve: Any, t: float) -> tuple[Any, float]:
    """The torsion of a curve, (r' x r'') . r''' / |r' x r''|^2; 0 where it is straight."""
    _, first, second, third = _derivatives(curve, t, 3)
    normal = np.cross(first, second)
    square = float(normal @ normal)
    return curve.PointAt(t), float(normal @ third) / square if square > 1e-24 else 0.0


@native("6b2a5853-07aa-4329-ba84-0a5d46b51dbd", "Curve Frame", "Frame", _AT, "Frame (F)",
        remark="where a curve is straight, the frame may be turned about it otherwise")  # fmt: skip
def curve_frame(curve: Any, t: float) -> Any:
    """The plane of a curve with x along it and y to the centre of its curvature."""
    at, first, second = _derivatives(curve, t, 2)
    x = shapes.unit(first)
    y = second - float(second @ x) * x
    if np.linalg.norm(y) < 1e-9 * max(float(np.linalg.norm(second)), 1e-300):
        level = np.cross([0.0, 0.0, 1.0], x)
        y = level if np.linalg.norm(level) > 1e-9 else np.array([0.0, 1.0, 0.0])
    return shapes.plane(at, x, y)


@native("188edd02-14a9-4828-a521-34995b0d1e4a", "Length Domain", "LenD", f"{_CURVE}; Domain (D): domain", "Length (L)")
def length_domain(curve: Any, domain: Any) -> float:
    """The length of a curve between two parameters."""
    return abs(_upto(curve, domain.T1) - _upto(curve, domain.T0))


@native("a1c16251-74f0-400f-9e7c-5e379d739963", "Length Parameter", "LenP", f"{_CURVE}; Parameter (P): number",
        "Length- (L-); Length+ (L+)")  # fmt: skip
def length_parameter(curve: Any, t: float) -> tuple[float, float]:
    """The lengths of a curve before and after a parameter."""
    before = _upto(curve, t)
    return before, arc_lengths.length(curve) - before


@native("5816ec9c-f170-4c59-ac44-364401ff84cd", "Planar", "Planar", _CURVE, "Planar (p); Plane (P); Deviation (D)")
def planar(curve: Any) -> tuple[bool, Any, float]:
    """Whether a curve is flat within 0.001, its plane, and how far it is from that."""
    rows = _sampled(curve)
    frame = shapes.fitted_plane(rows)
    apart = float(np.abs(shapes.coordinates(frame, rows)[:, 2]).max())
    return apart <= 1e-3, frame, apart


@native("ebd6c758-19ae-4d74-aed7-b8a0392ff743", "Extremes", "X-tremez", f"{_CURVE}; Plane (P): plane",
        "Highest (H): list; Lowest (L): list")  # fmt: skip
def extremes(curve: Any, frame: Any) -> tuple[list[Any], list[Any]]:
    """The highest and the lowest point of a curve over a plane, of equal ones the first."""
    from scipy.optimize import minimize_scalar

    origin, _, _, up = shapes.axes(frame)
    ends = np.linspace(curve.Domain.T0, curve.Domain.T1, SAMPLES + 1)
    heights = np.array([float((shapes.xyz(curve.PointAt(t)) - origin) @ up) for t in ends.tolist()])
    found = []
    for sign in (-1.0, 1.0):
        k = int(np.argmin(sign * heights))
        low, high = float(ends[max(k - 1, 0)]), float(ends[min(k + 1, SAMPLES)])
        best = minimize_scalar(
            lambda t, s=sign: s * float((shapes.xyz(curve.PointAt(float(t))) - origin) @ up), bounds=(low, high),
            method="bounded", options={"xatol": 1e-12 * (high - low)},
        )  # fmt: skip
        t = float(best.x) if float(best.fun) < sign * heights[k] else float(ends[k])
        found.append([curve.PointAt(t)])
    return found[0], found[1]


@native("bb2e13da-09ca-43fd-bef8-8d71f3653af9", "Curve Side", "Side",
        f"{_CURVE}; Point (P): point; Plane (Pl): plane optional", "Side (S); Left (L); Right (R)")  # fmt: skip
def curve_side(curve: Any, place: Any, frame: Any) -> tuple[int, bool, bool]:
    """On which side of a curve a point is, as seen from above its plane: -1 left, 0 on it, 1 right."""
    if frame is None:
        corners = _sampled(curve)
        rank = np.linalg.matrix_rank(corners - corners[0], tol=1e-9 * float(np.ptp(corners, axis=0).max()))
        frame = shapes.fitted_plane(corners) if rank > 1 else shapes.plane((0, 0, 0), (1, 0, 0), (0, 1, 0))
    t = nearest(curve, shapes.xyz(place))
    apart = shapes.xyz(place) - shapes.xyz(curve.PointAt(t))
    across = float(np.cross(shapes.xyz(curve.TangentAt(t)), apart) @ shapes.axes(frame)[3])
    side = 0 if abs(across) <= 1e-9 else -1 if across > 0.0 else 1
    return side, side < 0, side > 0


@native("0b04e8b9-00d7-47a7-95c3-0d51e654fe88", "Point in Curves", "InCurves",
        "Point (P): point; Curves (C): curve list", "Relationship (R); Index (I); Point (P')")  # fmt: skip
def point_in_curves(place: Any, curves: list[Any]) -> tuple[int, int, Any]:
    """Whether a point is in one of several closed curves: 0 outside all, 1 on one, 2 inside, and the number of it."""
    found = [(*point_in_curve(place, curve), i) for i, curve in enumerate(curves)]
    if not found:
        raise Unfit("there is no curve")
    relation, flat, number = next((one for one in found if one[0]), (0, found[0][1], -1))
    return relation, number, flat


@native("23862862-049a-40be-b558-2418aacbd916", "Deconstruct Arc", "DArc", "Arc (A): curve",
        "Base Plane (B); Radius (R); Angle (A)")  # fmt: skip
def deconstruct_arc(curve: Any) -> tuple[Any, float, Any]:
    """The plane of an arc or circle, its radius, and its angles in radians."""
    if not curve.IsArc():
        raise Unfit("the curve is not an arc")
    parts = (0.0, 1 / 3, 2 / 3) if curve.IsClosed else (0.0, 0.5, 1.0)
    t0, t1 = curve.Domain.T0, curve.Domain.T1
    start, middle, end = (shapes.xyz(curve.PointAt(t0 + part * (t1 - t0))) for part in parts)
    p, q = middle - start, end - start
    normal = np.cross(p, q)
    to_centre = float(q @ q) * np.cross(normal, p) + float(p @ p) * np.cross(q, normal)
    centre = start + to_centre / (2.0 * float(normal @ normal))
    frame = shapes.plane(centre, start - centre, np.cross(normal, start - centre))
    radius = float(np.linalg.norm(start - centre))
    turn = 2.0 * math.pi if curve.IsClosed else arc_lengths.length(curve) / radius
    return frame, radius, rhino3dm.Interval(0.0, turn)


@native("e5c33a79-53d5-4f2b-9a97-d3d45c780edc", "Deconstuct Rectangle", "DRec", "Rectangle (R): rectangle",
        "Base Plane (B); X Interval (X); Y Interval (Y)")  # fmt: skip
def deconstruct_rectangle(outline: tuple[Any, float, float]) -> tuple[Any, Any, Any]:
    """The plane of a rectangle at its first corner, and its sizes along both axes."""
    frame, x, y = outline
    return frame, rhino3dm.Interval(0.0, x), rhino3dm.Interval(0.0, y)


@native("66d2a68e-2f1d-43d2-a53b-c6a4d17e627b", "Control Polygon", "CPoly", _CURVE, "Polygon (C); Points (P): list")
def control_polygon(curve: Any) -> tuple[Any, list[Any]]:
    """The polyline through the control points of a curve as NURBS, and these."""
    nurbs = curve.ToNurbsCurve()
    found = [nurbs.Points[i] for i in range(len(nurbs.Points))]
    rows = np.array([[p.X / p.W, p.Y / p.W, p.Z / p.W] for p in found])
    return shapes.polyline(rows), shapes.points(rows)


@native("748f214a-bc64-4556-9da5-4fa59a30c5c7", "Curve Nearest Object", "CrvNear",
        f"{_CURVE}; Geometry (G): geometry list", "Point A (A); Point B (B); Index (I)",
        remark="the nearest of 257 places of the curve")  # fmt: skip
def curve_nearest(curve: Any, geometry: list[Any]) -> tuple[Any, Any, int]:
    """The places of a curve and of the nearest shape that are nearest to each other, and the number of that shape."""
    ends = np.linspace(curve.Domain.T0, curve.Domain.T1, SAMPLES + 1).tolist()
    best: tuple[float, Any, Any, int] | None = None
    for i, one in enumerate(geometry):
        for at in map(curve.PointAt, ends if one is not None else []):
            there = _closest(at, one)
            gap = float(np.linalg.norm(shapes.xyz(there) - shapes.xyz(at)))
            if best is None or gap < best[0]:
                best = gap, at, there, i
    if best is None:
        raise Unfit("there is no geometry")
    return best[1:]
