"""Natives of the tab Curve: what makes curves."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from hookean.discretize import catenary as chains
from hookean_canvas.run.natives import shapes
from hookean_canvas.run.natives.along import length as measured
from hookean_canvas.run.natives.declare import Unfit, bounded, native
from hookean_canvas.run.rhino import rhino3dm

_PLANE = "Plane (P): plane"
_MADE = "Curve (C); Length (L); Domain (D)"
_POINTS = "Vertices (V): point list; Degree (D): integer = 3; Periodic (P): boolean = False"


@native("4c4e56eb-2f04-43f9-95a3-cc46a14f495a", "Line", "Ln",
        "Start Point (A): point; End Point (B): point", "Line (L)")  # fmt: skip
def line(start: Any, end: Any) -> Any:
    """A line between two points."""
    return rhino3dm.Line(start, end)


@native("4c619bc9-39fd-4717-82a6-1e07ea237bbe", "Line SDL", "Line",
        "Start (S): point; Direction (D): vector; Length (L): number = 1.0", "Line (L)")  # fmt: skip
def line_along(start: Any, direction: Any, length: float) -> Any:
    """A line from a point along a direction, of a length."""
    way = shapes.unit(shapes.xyz(direction))
    if not way.any():
        raise Unfit("a direction of length zero")
    return rhino3dm.Line(start, shapes.point(shapes.xyz(start) + length * way))


@native("71b5b089-500a-4ea6-81c5-2f960441a0e8", "PolyLine", "PLine",
        "Vertices (V): point list; Closed (C): boolean = False", "Polyline (Pl)")  # fmt: skip
def polyline(vertices: list[Any], closed: bool) -> Any:
    """Straight pieces between points, with Closed also from the last one to the first."""
    found = shapes.rows(place for place in vertices if place is not None)
    if len(found) < 2:
        raise Unfit("a polyline needs at least two points")
    return shapes.polyline(found, closed and not np.array_equal(found[0], found[-1]))


@native("807b86e3-be8d-4970-92b5-f8cdcb45b06b", "Circle", "Cir", f"{_PLANE}; Radius (R): number = 1.0", "Circle (C)")
def circle(frame: Any, radius: float) -> Any:
    """A circle about the origin of a plane."""
    return _arc(frame, radius, 0.0, 2.0 * math.pi)


@native("d114323a-e6ee-4164-946b-e4ca0ce15efa", "Circle CNR", "Circle",
        "Center (C): point; Normal (N): vector; Radius (R): number = 1.0", "Circle (C)")  # fmt: skip
def circle_about(centre: Any, normal: Any, radius: float) -> Any:
    """A circle about a point, perpendicular to a vector."""
    return _arc(rhino3dm.Plane(centre, normal), radius, 0.0, 2.0 * math.pi)


@native("47886835-e3ff-4516-a3ed-1b419f055464", "Circle 3Pt", "Circle",
        "Point A (A): point; Point B (B): point; Point C (C): point", "Circle (C); Plane (P); Radius (R)")  # fmt: skip
def circle_through(a: Any, b: Any, c: Any) -> tuple[Any, Any, float]:
    """The circle through three points."""
    arc = rhino3dm.Arc(a, b, c)
    if not arc.IsValid:
        raise Unfit("the points are on a line")
    return _arc(arc.Plane, arc.Radius, 0.0, 2.0 * math.pi), arc.Plane, arc.Radius


@native("bb59bffc-f54c-4682-9778-f6c3fe74fce3", "Arc", "Arc",
        f"{_PLANE}; Radius (R): number = 1.0; Angle (A): domain", "Arc (A); Length (L)")  # fmt: skip
def arc(frame: Any, radius: float, angles: Any) -> tuple[Any, float]:
    """An arc about the origin of a plane between two angles in radians, and its length."""
    return _arc(frame, radius, angles.T0, angles.T1), abs(angles.T1 - angles.T0) * radius


@native("9fa1b081-b1c7-4a12-a163-0aa8da9ff6c4", "Arc 3Pt", "Arc",
        "Point A (A): point; Point B (B): point; Point C (C): point", "Arc (A); Plane (P); Radius (R)")  # fmt: skip
def arc_through(a: Any, b: Any, c: Any) -> tuple[Any, Any, float]:
    """The arc from A through B to C."""
    found = rhino3dm.Arc(a, b, c)
    if not found.IsValid:
        raise Unfit("the points are on a line")
    return rhino3dm.ArcCurve.CreateFromArc(found), found.Plane, found.Radius


@native("9d2583dd-6cf5-497c-8c40-c9a290598396", "Arc SED", "Arc",
        "Start (S): point; End (E): point; Direction (D): vector", "Arc (A); Plane (P); Radius (R)")  # fmt: skip
def arc_along(start: Any, end: Any, direction: Any) -> tuple[Any, Any, float]:
    """The arc from a point along a direction to another point."""
    found = rhino3dm.Arc(start, direction, end)
    if not found.IsValid:
        raise Unfit("the direction runs along the chord")
    return rhino3dm.ArcCurve.CreateFromArc(found), found.Plane, found.Radius


def _arc(frame: Any, radius: float, start: float, end: float) -> Any:
    """An arc in a plane; the parameter 0 is at the start angle from the x axis."""
    if radius <= 0.0 or start == end:
        raise Unfit("a circle or arc needs a radius and an angle above 0")
    origin = rhino3dm.Point3d(0, 0, 0)
    if abs(end - start) >= 2.0 * math.pi - 1e-12:
        found = rhino3dm.ArcCurve.CreateFromCircle(rhino3dm.Circle(origin, radius))
    else:
        found = rhino3dm.ArcCurve.CreateFromArc(rhino3dm.Arc(origin, radius, end - start))
    found.Transform(rhino3dm.Transform.Rotation(start, rhino3dm.Vector3d(0, 0, 1), origin))
    found.Transform(rhino3dm.Transform.PlaneToPlane(shapes.plane((0, 0, 0), (1, 0, 0), (0, 1, 0)), frame))
    return found


@native("d93100b6-d50b-40b2-831a-814659dc38e3", "Rectangle", "Rectangle",
        f"{_PLANE}; X Size (X): domain; Y Size (Y): domain; Radius (R): number = 0.0",
        "Rectangle (R); Length (L)")  # fmt: skip
def rectangle(frame: Any, x: Any, y: Any, radius: float) -> tuple[Any, float]:
    """A rectangle over two domains along the axes of a plane, and the length of its outline."""
    _square(radius)
    return _rectangle(frame, x.T0, x.T1, y.T0, y.T1)


@native("575660b1-8c79-4b8d-9222-7ab4a6ddb359", "Rectangle 2Pt", "Rec 2Pt",
        f"{_PLANE}; Point A (A): point; Point B (B): point; Radius (R): number = 0.0",
        "Rectangle (R); Length (L)")  # fmt: skip
def rectangle_between(frame: Any, a: Any, b: Any, radius: float) -> tuple[Any, float]:
    """A rectangle along the axes of a plane between two opposite corners."""
    _square(radius)
    (x0, y0, _), (x1, y1, _) = shapes.coordinates(frame, shapes.rows([a, b]))
    return _rectangle(frame, x0, x1, y0, y1)


def _square(radius: float) -> None:
    if radius > 0.0:
        raise Unfit("corners are not rounded here; set the radius to 0")


def _rectangle(frame: Any, x0: float, x1: float, y0: float, y1: float) -> tuple[Any, float]:
    places = shapes.in_plane(frame, [(x0, y0), (x1, y0), (x1, y1), (x0, y1)])
    return shapes.polyline(places, closed=True), 2.0 * (abs(x1 - x0) + abs(y1 - y0))


@native("845527a6-5cea-4ae9-a667-96ae1667a4e8", "Polygon", "Polygon",
        f"{_PLANE}; Radius (R): number = 1.0; Segments (S): integer = 5; Fillet Radius (Rf): number = 0.0",
        "Polygon (P); Length (L)")  # fmt: skip
def polygon(frame: Any, radius: float, count: int, fillet: float) -> tuple[Any, float]:
    """A regular polygon in a plane, its first corner on the x axis, and the length of its outline."""
    _square(fillet)
    if count < 3:
        raise Unfit("a polygon needs at least three segments")
    bounded(count)
    turns = 2.0 * math.pi * np.arange(count) / count
    places = shapes.in_plane(frame, radius * np.stack([np.cos(turns), np.sin(turns)], axis=1))
    return shapes.polyline(places, closed=True), 2.0 * count * radius * math.sin(math.pi / count)


@native("2b2a4145-3dff-41d4-a8de-1ea9d29eef33", "Interpolate", "IntCrv",
        f"{_POINTS}; KnotStyle (K): integer = 2", _MADE,
        remark="the end conditions differ from Rhino's, so that the curve differs between its points")  # fmt: skip
def interpolate(vertices: list[Any], degree: int, periodic: bool, style: int) -> tuple[Any, float, Any]:
    """A smooth curve through points, parameters by even steps, chords or roots of chords; its length and domain."""
    from scipy.interpolate import make_interp_spline

    places = shapes.rows(vertices)
    if len(places) < 2:
        raise Unfit("a curve needs at least two points")
    if periodic:
        places = np.concatenate([places, places[:1]])
    apart = np.linalg.norm(np.diff(places, axis=0), axis=1)
    if not apart.all():
        raise Unfit("two points in a row are the same")
    steps = {0: np.ones_like(apart), 1: apart}.get(style, np.sqrt(apart))
    at = np.concatenate([[0.0], np.cumsum(steps)])
    k = min(degree, len(places) - 1)
    ends = {"bc_type": "periodic"} if periodic and k % 2 else {"bc_type": "natural"} if k == 3 else {}
    spline = make_interp_spline(at, places, k=k, **ends)
    return _measured(_nurbs(spline.c, spline.t, k))


@native("dde71aef-d6ed-40a6-af98-6b0673983c82", "Nurbs Curve", "Nurbs", _POINTS, _MADE)
def nurbs_curve(vertices: list[Any], degree: int, periodic: bool) -> tuple[Any, float, Any]:
    """A curve with points as its control points, and its length and domain."""
    places = [place for place in vertices if place is not None]
    if len(places) < 2:
        raise Unfit("a curve needs at least two points")
    found = rhino3dm.NurbsCurve.Create(periodic, min(degree, len(places) - 1), places)
    if found is None:
        raise Unfit("these points are not the control points of a curve of this degree")
    return _measured(found)


def _nurbs(places: shapes.Array, knots: shapes.Array, degree: int) -> Any:
    """A NURBS curve of a B-spline; Rhino leaves out the first and the last knot."""
    found = rhino3dm.NurbsCurve(3, False, degree + 1, len(places))
    for i, (x, y, z) in enumerate(places.tolist()):
        found.Points[i] = rhino3dm.Point4d(x, y, z, 1.0)
    for i, knot in enumerate(knots[1:-1].tolist()):
        found.Knots[i] = knot
    return found


def _measured(curve: Any) -> tuple[Any, float, Any]:
    return curve, measured(curve), curve.Domain


@native("275671d4-3e87-40bd-8aff-8e6a5fdbb892", "Catenary", "Cat",
        "Point A (A): point; Point B (B): point; Length (L): number; Gravity (G): vector = (0.0, 0.0, -1.0)",
        "Catenary (C)", remark="a polyline of 50 pieces, whose corners are on the catenary")  # fmt: skip
def catenary(a: Any, b: Any, length: float, gravity: Any) -> Any:
    """The shape of a chain of a length between two points."""
    return shapes.polyline(chains.catenary(shapes.xyz(a), shapes.xyz(b), length, gravity=shapes.xyz(gravity)))
