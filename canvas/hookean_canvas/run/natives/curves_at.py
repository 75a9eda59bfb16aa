"""Natives of the tab Curve that give planes along curves, and tell where points are."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import numpy as np

from hookean.discretize import curves as arc_lengths
from hookean_canvas.run.natives import shapes
from hookean_canvas.run.natives.along import divided, straight
from hookean_canvas.run.natives.declare import Unfit, bounded, native
from hookean_canvas.run.rhino import rhino3dm

SAMPLES = 400
"""Places of a curve from which the closest one is sought."""
_FRAMES = "Frames (F): list; Parameters (t): list"


@native("983c7600-980c-44da-bc53-c804067f667f", "Perp Frames", "PFrames",
        "Curve (C): curve; Count (N): integer = 10; Align (A): boolean = True", _FRAMES,
        remark="the first frame, and with it the others, may be turned about the curve otherwise")  # fmt: skip
def perp_frames(curve: Any, count: int, align: bool) -> tuple[list[Any], list[float]]:
    """Planes across a curve at equal lengths, turned as little as possible from one to the next."""
    at = _at(curve, count)
    places, tangents = _along(curve, at)
    x = _across(tangents[0])
    frames = []
    for i, (place, t) in enumerate(zip(places, tangents, strict=True)):
        if i:
            x = _carried(x, places[i - 1], tangents[i - 1], place, t)
        frames.append(shapes.plane(place, x, np.cross(t, x)))
    return frames, at


@native("69f3e5ee-4770-44b3-8851-ae10ae555398", "Perp Frame", "PFrame", "Curve (C): curve; Parameter (t): number",
        "Frame (F)", remark="the frame may be turned about the curve otherwise")  # fmt: skip
def perp_frame(curve: Any, t: float) -> Any:
    """The plane across a curve at a parameter."""
    places, tangents = _along(curve, [t])
    x = _across(tangents[0])
    return shapes.plane(places[0], x, np.cross(tangents[0], x))


@native(
    "8d058945-ce47-4e7c-82af-3269295d7890",
    "Horizontal Frames",
    "HFrames",
    "Curve (C): curve; Count (N): integer = 10",
    _FRAMES,
)
def horizontal_frames(curve: Any, count: int) -> tuple[list[Any], list[float]]:
    """Horizontal planes at equal lengths of a curve, x along its direction in plan."""
    at = _at(curve, count)
    return [_level(place, t) for place, t in zip(*_along(curve, at), strict=True)], at


@native(
    "c048ad76-ffcd-43b1-a007-4dd1b2373326",
    "Horizontal Frame",
    "HFrame",
    "Curve (C): curve; Parameter (t): number",
    "Frame (F)",
)
def horizontal_frame(curve: Any, t: float) -> Any:
    """The horizontal plane at a parameter of a curve, x along its direction in plan."""
    places, tangents = _along(curve, [t])
    return _level(places[0], tangents[0])


def _at(curve: Any, count: int) -> list[float]:
    """Parameters at equal lengths; one less where the curve is closed."""
    if count < 1:
        raise Unfit("Count must be at least 1")
    bounded(count)
    at = divided(curve, count)
    return at[:-1] if curve.IsClosed else at


def _along(curve: Any, at: list[float]) -> tuple[shapes.Array, shapes.Array]:
    """Places and unit tangents (n, 3) at parameters."""
    return shapes.rows(map(curve.PointAt, at)), shapes.rows(map(curve.TangentAt, at))


def _across(tangent: shapes.Array) -> shapes.Array:
    """A unit vector across a tangent: horizontal where that is one direction."""
    level = np.cross(tangent, [0.0, 0.0, 1.0])
    return shapes.unit(level if np.linalg.norm(level) > 1e-9 else np.array([1.0, 0.0, 0.0]))


def _carried(x: shapes.Array, p: shapes.Array, t: shapes.Array, q: shapes.Array, u: shapes.Array) -> shapes.Array:
    """A vector across a curve at p carried to q with the least twist, by two reflections (Wang et al. 2008)."""
    first = q - p
    square = float(first @ first) or 1.0
    mirrored, turned = (one - 2.0 * float(first @ one) / square * first for one in (x, t))
    second = u - turned
    across = float(second @ second)
    carried = mirrored - (2.0 * float(second @ mirrored) / across * second if across > 1e-24 else 0.0)
    return shapes.unit(carried - float(carried @ u) * u)


def _level(place: shapes.Array, tangent: shapes.Array) -> Any:
    x = np.array([tangent[0], tangent[1], 0.0])
    x = shapes.unit(x) if np.linalg.norm(x) > 1e-9 else np.array([1.0, 0.0, 0.0])
    return shapes.plane(place, x, np.cross([0.0, 0.0, 1.0], x))


@native("2dc44b22-b1dd-460a-a704-6462d6e91096", "Curve Closest Point", "Crv CP", "Point (P): point; Curve (C): curve",
        "Point (P); Parameter (t); Distance (D)")  # fmt: skip
def curve_closest_point(place: Any, curve: Any) -> tuple[Any, float, float]:
    """The point of a curve that is nearest to a point, its parameter, and the distance."""
    t = nearest(curve, shapes.xyz(place))
    at = curve.PointAt(t)
    return at, t, float(np.linalg.norm(shapes.xyz(at) - shapes.xyz(place)))


def nearest(curve: Any, place: shapes.Array) -> float:
    """The parameter of the point of a curve that is nearest to a place."""
    from scipy.optimize import minimize_scalar

    run = straight(curve)
    if run is not None:
        return run.nearest(place)

    def distance(t: float) -> float:
        return float(np.linalg.norm(shapes.xyz(curve.PointAt(t)) - place))

    nurbs = curve.ToNurbsCurve()
    breaks = {curve.GetCurveParameterFromNurbsFormParameter(nurbs.Knots[i])[1] for i in range(len(nurbs.Knots))}
    ends = np.unique([*np.linspace(curve.Domain.T0, curve.Domain.T1, SAMPLES + 1), *breaks])
    best = int(np.argmin([distance(t) for t in ends]))
    around = ends[max(best - 1, 0) : best + 2]
    tries = [
        float(minimize_scalar(distance, bounds=(a, b), method="bounded", options={"xatol": 1e-12 * (b - a)}).x)
        for a, b in pairwise(around)
    ]
    return min([float(ends[best]), *tries], key=distance)


@native("a72b0bd3-c7a7-458e-875d-09ae1624638c", "Point In Curve", "InCurve", "Point (P): point; Curve (C): curve",
        "Relationship (R); Point (P')")  # fmt: skip
def point_in_curve(place: Any, curve: Any) -> tuple[int, Any]:
    """0, 1 or 2: a point, projected into the plane of a closed curve, is outside, on it, or inside; and that point."""
    at = shapes.corners(curve)
    if not curve.IsClosed or not curve.IsPlanar():
        raise Unfit("the curve is not closed or not planar")
    outline = at if at is not None else np.array(arc_lengths.divide(curve, SAMPLES))
    frame = shapes.fitted_plane(outline[:-1])
    x, y, _ = shapes.coordinates(frame, [shapes.xyz(place)])[0]
    flat = shapes.point(shapes.in_plane(frame, [(x, y)])[0])
    on = curve.PointAt(nearest(curve, shapes.xyz(flat)))
    if np.linalg.norm(shapes.xyz(on) - shapes.xyz(flat)) < 1e-6:
        return 1, flat
    local = shapes.coordinates(frame, outline)[:, :2]
    turns = np.diff(np.unwrap(np.arctan2(local[:, 1] - y, local[:, 0] - x)))
    return (2 if abs(turns.sum()) > math.pi else 0), flat


@native("59e94548-cefd-4774-b3de-48142fc783fb", "Polygon Center", "PCen", "Polyline (P): curve",
        "Center(V) (Cv); Center(E) (Ce); Center(A) (Ca)")  # fmt: skip
def polygon_center(outline: Any) -> tuple[Any, Any, Any]:
    """The mean of the corners of a polyline, the centre of its edges, and that of its area."""
    at = shapes.corners(outline)
    if at is None or len(at) < 3:
        raise Unfit("a polyline with two edges or more is needed")
    closed = bool(np.linalg.norm(at[0] - at[-1]) < 1e-9)
    distinct = at[:-1] if closed else at
    lengths = np.linalg.norm(np.diff(at, axis=0), axis=1)
    edges = ((at[:-1] + at[1:]) / 2.0 * lengths[:, None]).sum(axis=0) / (lengths.sum() or 1.0)
    centre = distinct.mean(axis=0)
    spokes = distinct - centre
    turns = np.cross(spokes, np.roll(spokes, -1, axis=0))
    whole = turns.sum(axis=0)
    areas = turns @ shapes.unit(whole)
    middles = centre + (spokes + np.roll(spokes, -1, axis=0)) / 3.0
    area = (middles * areas[:, None]).sum(axis=0) / areas.sum() if areas.sum() > 0.0 else centre
    return shapes.point(centre), shapes.point(edges), shapes.point(area)


@native("2956d989-3599-476f-bc92-1d847aff98b6", "Curve To Polyline", "ToPoly",
        "Curve (C): curve; Tolerance (distance) (Td): any optional; Tolerance (angle) (Ta): any optional; "
        "MinEdge (E-): any optional; MaxEdge (E+): any optional", "Polyline (P); Segments (S)",
        remark="curved ones become 100 pieces of equal length, whatever the tolerances")  # fmt: skip
def curve_to_polyline(curve: Any, distance: Any, angle: Any, least: Any, most: Any) -> tuple[Any, int]:
    """A curve as polyline, and the number of its pieces."""
    at = shapes.corners(curve)
    found = at if at is not None else np.array(arc_lengths.divide(curve, 100))
    return shapes.polyline(found), len(found) - 1


@native("46b5564d-d3eb-4bf1-ae16-15ed132cfd88", "Ellipse", "Ellipse",
        "Plane (P): plane; Radius 1 (R1): number = 1.0; Radius 2 (R2): number = 0.5",
        "Ellipse (E); Focus 1 (F1); Focus 2 (F2)")  # fmt: skip
def ellipse(frame: Any, a: float, b: float) -> tuple[Any, Any, Any]:
    """An ellipse with its radii along the axes of a plane, and its foci."""
    if min(a, b) <= 0.0:
        raise Unfit("both radii must be positive")
    found = rhino3dm.ArcCurve.CreateFromCircle(rhino3dm.Circle(1.0)).ToNurbsCurve()
    stretch = rhino3dm.Transform.Scale(shapes.plane((0, 0, 0), (1, 0, 0), (0, 1, 0)), a, b, 1.0)
    found.Transform(stretch)
    found.Transform(rhino3dm.Transform.PlaneToPlane(shapes.plane((0, 0, 0), (1, 0, 0), (0, 1, 0)), frame))
    far = math.sqrt(abs(a * a - b * b))
    at = [(far, 0.0), (-far, 0.0)] if a >= b else [(0.0, far), (0.0, -far)]
    return found, *shapes.points(shapes.in_plane(frame, at))


@native("9bc98a1d-2ecc-407e-948a-09a09ed3e69d", "Rectangle 3Pt", "Rec 3Pt",
        "Point A (A): point; Point B (B): point; Point C (C): point", "Rectangle (R); Length (L)")  # fmt: skip
def rectangle_three_points(a: Any, b: Any, c: Any) -> tuple[Any, float]:
    """The rectangle with an edge from A to B whose opposite edge passes through C, and the length round it."""
    p, q, r = (shapes.xyz(one) for one in (a, b, c))
    along = q - p
    across = (r - p) - float((r - p) @ along) / (float(along @ along) or 1.0) * along
    if not np.linalg.norm(along) * np.linalg.norm(across) > 0.0:
        raise Unfit("the three points are on one line")
    length = 2.0 * float(np.linalg.norm(along) + np.linalg.norm(across))
    return shapes.polyline([p, q, q + across, p + across], closed=True), length
