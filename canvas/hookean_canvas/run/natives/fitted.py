"""Natives that fit lines, circles and curves to points, tangents and planes."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from hookean_canvas.run.natives import shapes
from hookean_canvas.run.natives.declare import Unfit, native
from hookean_canvas.run.natives.meetings import line_plane
from hookean_canvas.run.natives.primitives import _MADE, _arc, _measured, _nurbs
from hookean_canvas.run.rhino import rhino3dm

_STYLE = "KnotStyle (K): integer = 2"


@native("1f798a28-9de6-47b5-8201-cac57256b777", "Fit Line", "FLine", "Points (P): point list", "Line (L)",
        remark="it runs from the first to the last point, as far as the points do")  # fmt: skip
def fit_line(places: list[Any]) -> Any:
    """The line with the least squares of the distances from points."""
    rows = _rows(places, 2)
    centre = rows.mean(axis=0)
    way = np.linalg.svd(rows - centre)[2][0]
    along = (rows - centre) @ way
    if along[-1] < along[0]:
        way, along = -way, -along
    return rhino3dm.Line(shapes.point(centre + along.min() * way), shapes.point(centre + along.max() * way))


@native("be52336f-a2e1-43b1-b5f5-178ba489508a", "Circle Fit", "FCircle", "Points (P): point list",
        "Circle (C); Radius (R); Deviation (D)",
        remark="in the plane nearest to the points, by least squares of the squares of the radii")  # fmt: skip
def fit_circle(places: list[Any]) -> tuple[Any, float, float]:
    """A circle nearest to points, its radius, and the largest distance of a point from it."""
    rows = _rows(places, 3)
    frame = shapes.fitted_plane(rows)
    flat = shapes.coordinates(frame, rows)
    known = np.column_stack([2.0 * flat[:, :2], np.ones(len(flat))])
    (u, v, rest), _, rank, _ = np.linalg.lstsq(known, (flat[:, :2] ** 2).sum(axis=1), rcond=None)
    if rank < 3:
        raise Unfit("the points are on a line")
    radius = math.sqrt(rest + u * u + v * v)
    off = np.hypot(np.hypot(flat[:, 0] - u, flat[:, 1] - v) - radius, flat[:, 2])
    frame = rhino3dm.Plane(frame.PointAt(float(u), float(v)), frame.XAxis, frame.YAxis)
    return _arc(frame, radius, 0.0, 2.0 * math.pi), radius, float(off.max())


@native("28b1c4d4-ab1c-4309-accd-1b7a954ed948", "InCircle", "InCircle",
        "Point A (A): point; Point B (B): point; Point C (C): point", "Circle (C); Plane (P); Radius (R)")  # fmt: skip
def inscribed(a: Any, b: Any, c: Any) -> tuple[Any, Any, float]:
    """The circle that touches the three sides of a triangle from within."""
    rows = shapes.rows([a, b, c])
    sides = np.linalg.norm(np.roll(rows, -1, axis=0) - np.roll(rows, 1, axis=0), axis=1)
    around = float(sides.sum())
    double = float(np.linalg.norm(np.cross(rows[1] - rows[0], rows[2] - rows[0])))
    if double <= 1e-12 * around * around:
        raise Unfit("the points are on a line")
    side = rows[1] - rows[0]
    frame = shapes.plane(sides @ rows / around, side, rows[2] - rows[0] - side * ((rows[2] - rows[0]) @ side)
                         / (side @ side))  # fmt: skip
    return _arc(frame, double / around, 0.0, 2.0 * math.pi), frame, double / around


@native("b9fde5fa-d654-4306-8ee1-6b69e6757604", "Line 4Pt", "Ln4Pt",
        "Line (L): line; Point A (A): point; Point B (B): point", "Line (L)")  # fmt: skip
def line_by_points(guide: Any, a: Any, b: Any) -> Any:
    """The part of a line between the points of it that are nearest to two points."""
    start, way = shapes.xyz(guide.From), shapes.unit(shapes.xyz(guide.To) - shapes.xyz(guide.From))
    if not way.any():
        raise Unfit("the line has no length")
    return rhino3dm.Line(*(shapes.point(start + ((shapes.xyz(one) - start) @ way) * way) for one in (a, b)))


@native("510c4a63-b9bf-42e7-9d07-9d71290264da", "Line 2Plane", "Ln2Pl",
        "Line (L): line; Plane A (A): plane; Plane B (B): plane", "Line (L)")  # fmt: skip
def line_between_planes(guide: Any, a: Any, b: Any) -> Any:
    """The part of a line between two planes."""
    return rhino3dm.Line(line_plane(guide, a)[0], line_plane(guide, b)[0])


@native("75eb156d-d023-42f9-a85e-2f2456b8bcce", "Interpolate (t)", "IntCrv(t)",
        f"Vertices (V): point list; Tangent Start (Ts): vector; Tangent End (Te): vector; {_STYLE}", _MADE,
        remark="a cubic curve, which may differ from Rhino's between its points")  # fmt: skip
def interpolate_between_tangents(vertices: list[Any], start: Any, end: Any, style: int) -> tuple[Any, float, Any]:
    """A smooth curve through points with given directions at its ends; its length and domain."""
    from scipy.interpolate import make_interp_spline

    rows = _rows(vertices, 2)
    apart = np.linalg.norm(np.diff(rows, axis=0), axis=1)
    ways = [shapes.unit(shapes.xyz(one)) for one in (start, end)]
    if not apart.all() or not all(way.any() for way in ways):
        raise Unfit("two points in a row are the same, or a tangent has no length")
    steps = {0: np.ones_like(apart), 1: apart}.get(style, np.sqrt(apart))
    ends = [[(1, way * speed)] for way, speed in zip(ways, (apart / steps)[[0, -1]], strict=True)]
    spline = make_interp_spline(np.concatenate([[0.0], np.cumsum(steps)]), rows, k=3, bc_type=tuple(ends))
    return _measured(_nurbs(spline.c, spline.t, 3))


@native("1f8e1ff7-8278-4421-b39d-350e71d85d37", "Nurbs Curve PWK", "NurbCrv",
        "Points (P): point list; Weights (W): number list; Knots (K): number list", _MADE)  # fmt: skip
def nurbs_by_knots(places: list[Any], weights: list[float], knots: list[float]) -> tuple[Any, float, Any]:
    """The curve of control points, weights and knots; its length and domain."""
    rows = _rows(places, 2)
    degree = len(knots) - len(rows) + 1
    if not 1 <= degree < len(rows) or len(weights) != len(rows):
        raise Unfit("as many weights as points are needed, and as many knots as points and the degree less one")
    made = rhino3dm.NurbsCurve(3, True, degree + 1, len(rows))
    for i, (row, weight) in enumerate(zip(rows.tolist(), weights, strict=True)):
        made.Points[i] = rhino3dm.Point4d(*(x * weight for x in row), weight)
    for i, knot in enumerate(knots):
        made.Knots[i] = knot
    if not made.IsValid:
        raise Unfit("these are not the knots of a curve; they must not decrease")
    return _measured(made)


def _rows(places: list[Any], least: int) -> shapes.Array:
    rows = shapes.rows(place for place in places if place is not None)
    if len(rows) < least:
        raise Unfit(f"{least} points or more are needed")
    return rows
