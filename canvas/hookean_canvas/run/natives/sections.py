"""Natives that cut by many planes, and draw spans and polygons on edges."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

import numpy as np

from hookean.discretize import curves as arc_lengths
from hookean_canvas.run.natives import shapes
from hookean_canvas.run.natives.curves_changed import bezier
from hookean_canvas.run.natives.declare import Unfit, bounded, native
from hookean_canvas.run.natives.measures import surface_mesh
from hookean_canvas.run.natives.meetings import _welded, crossings, section
from hookean_canvas.run.rhino import rhino3dm

PIECES = 64
_STEPS = "Plane (P): plane; Offsets (O): number list optional; Distances (D): number list optional"
_AT = "Contours (C): branches; Parameters (t): branches"
_MESHED = "surfaces count as their meshes of 64 by 64 quads"


def _planes(frame: Any, offsets: list[float] | None, distances: list[float] | None) -> list[Any]:
    """Planes at offsets, or one after the other at distances."""
    if not offsets and not distances:
        raise Unfit("Offsets and Distances are missing; give one of them")
    heights = np.array(offsets) if offsets else np.cumsum(distances or [])
    origin, x, y, normal = shapes.axes(frame)
    return [shapes.plane(origin + height * normal, x, y) for height in heights.tolist()]


@native("246cda78-5e88-4087-ba09-ae082bbc4af8", "Contour (ex)", "Contour", f"Shape (S): geometry; {_STEPS}",
        "Contours (C): branches", remark=_MESHED)  # fmt: skip
def contours_at(shape: Any, frame: Any, offsets: list[float] | None, distances: list[float] | None) -> list[list[Any]]:
    """The lines in which planes at offsets cut a shape, a branch for each plane."""
    vertices, faces = _welded(*surface_mesh(shape))
    return [section(vertices, faces, plane) for plane in _planes(frame, offsets, distances)]


def _met(curve: Any, planes: Iterable[Any]) -> tuple[list[list[Any]], list[list[float]]]:
    at = [crossings(curve, plane) for plane in planes]
    return [[curve.PointAt(t) for t in row] for row in at], at


@native("3e7e4827-6edd-4e10-93ac-cc234414d2b9", "Contour (ex)", "Contour", f"Curve (C): curve; {_STEPS}", _AT)
def crossings_at(
    curve: Any, frame: Any, offsets: list[float] | None, distances: list[float] | None
) -> tuple[list[list[Any]], list[list[float]]]:
    """The points in which planes at offsets cut a curve, a branch for each plane, and its parameters there."""
    return _met(curve, _planes(frame, offsets, distances))


@native("88cff285-7f5e-41b3-96d5-9588ff9a52b1", "Contour", "Contour",
        "Curve (C): curve; Point (P): point; Direction (N): vector; Distance (D): number", _AT)  # fmt: skip
def curve_contour(curve: Any, start: Any, normal: Any, distance: float) -> tuple[list[list[Any]], list[list[float]]]:
    """The points in which planes at equal distances cut a curve, a branch for each plane, one plane through a point."""
    way = shapes.unit(shapes.xyz(normal))
    if not way.any() or distance <= 0.0:
        raise Unfit("Direction must have a length, and Distance be above 0")
    along = (np.linspace(curve.Domain.T0, curve.Domain.T1, PIECES * 4 + 1)).tolist()
    heights = (shapes.rows(curve.PointAt(t) for t in along) - shapes.xyz(start)) @ way
    first, last = np.ceil(heights.min() / distance - 1e-9), np.floor(heights.max() / distance + 1e-9)
    bounded(last - first)
    origins = (shapes.xyz(start) + k * distance * way for k in range(int(first), int(last) + 1))
    return _met(curve, (rhino3dm.Plane(shapes.point(one), shapes.vector(way)) for one in origins))


@native("30ce59ce-22a1-49ee-9e21-e6d16b3684a8", "Bezier Span", "BzSpan",
        "Start (A): point; Start Tangent (At): vector; End (B): point; End Tangent (Bt): vector",
        "Curve (C); Length (L); Domain (D)")  # fmt: skip
def bezier_span(a: Any, first: Any, b: Any, last: Any) -> tuple[Any, float, Any]:
    """The cubic Bézier curve with tangents at its ends; its control points are a third of them away."""
    start, end = shapes.xyz(a), shapes.xyz(b)
    made = bezier(np.array([start, start + shapes.xyz(first) / 3.0, end - shapes.xyz(last) / 3.0, end]))
    return made, arc_lengths.length(made), made.Domain


@native("f4568ce6-aade-4511-8f32-f27d8a6bf9e9", "Polygon Edge", "PolEdge",
        "Edge Start (E0): point; Edge End (E1): point; Plane Point (P): point; Segments (S): integer = 5",
        "Polygon (P); Centre (C); Corner Radius (Rc); Edge Radius (Re)")  # fmt: skip
def polygon_edge(a: Any, b: Any, beside: Any, count: int) -> tuple[Any, Any, float, float]:
    """The regular polygon on an edge, on the side of a point; its centre, and the circles round and in it."""
    start, end = shapes.xyz(a), shapes.xyz(b)
    if count < 3:
        raise Unfit("Segments must be at least 3")
    bounded(count)
    x = shapes.unit(end - start)
    y = shapes.xyz(beside) - start
    y = shapes.unit(y - (y @ x) * x)
    if not x.any() or not y.any():
        raise Unfit("the edge has no length, or the point is on its line")
    half = 0.5 * float(np.linalg.norm(end - start))
    outer, inner = half / math.sin(math.pi / count), half / math.tan(math.pi / count)
    centre = 0.5 * (start + end) + inner * y
    angles = -0.5 * math.pi - math.pi / count + 2.0 * math.pi * np.arange(count) / count
    rows = centre + outer * (np.cos(angles)[:, None] * x + np.sin(angles)[:, None] * y)
    return shapes.polyline(rows, closed=True), shapes.point(centre), outer, inner
