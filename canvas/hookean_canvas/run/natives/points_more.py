"""Natives of the tab Vector beside the usual ones: neighbours, other coordinates, and planes that are turned."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import ConvexHull, KDTree, QhullError

from hookean_canvas.run.natives import shapes
from hookean_canvas.run.natives.curves_at import nearest
from hookean_canvas.run.natives.declare import Unfit, native
from hookean_canvas.run.natives.measures import surface_mesh
from hookean_canvas.run.rhino import rhino3dm

Array = shapes.Array
_LINKS = "Links (L): branches; Topology (T): branches"
_RADII = "Group (G): integer = 1; Min Radius (R-): number optional; Max Radius (R+): number optional"


def _linked(rows: Array, places: list[Any], count: int, least: float | None, most: float | None) -> tuple[Any, Any]:
    """Lines from each point to its nearest others, and their numbers."""
    tree = KDTree(rows)
    apart, who = tree.query(rows, min(count + 1, len(rows)) if most is not None or count < len(rows) else len(rows))
    lines, numbers = [], []
    for i, (gaps, others) in enumerate(zip(np.atleast_2d(apart), np.atleast_2d(who), strict=True)):
        kept = [
            int(k)
            for gap, k in zip(gaps, others, strict=True)
            if k != i and (least is None or gap >= least) and (most is None or gap <= most)
        ][:count]
        lines.append([rhino3dm.Line(places[i], places[k]) for k in kept])
        numbers.append(kept)
    return lines, numbers


@native("e504d619-4467-437a-92fa-c6822d16b066", "Proximity 3D", "Prox", f"Points (P): point list; {_RADII}", _LINKS)
def proximity_3d(places: list[Any], count: int, least: float | None, most: float | None) -> tuple[Any, Any]:
    """Lines from each point to the nearest others, at most so many and within two radii, and their numbers."""
    if count < 1 or len(places) < 2:
        raise Unfit("Group must be at least 1, and there must be two points")
    return _linked(shapes.rows(places), places, count, least, most)


@native("458ed0e0-19a3-419b-8ead-f524925b8a35", "Proximity 2D", "Prox",
        f"Points (P): point list; Plane (Pl): plane optional; {_RADII}", _LINKS)  # fmt: skip
def proximity_2d(
    places: list[Any], frame: Any, count: int, least: float | None, most: float | None
) -> tuple[Any, Any]:  # fmt: skip
    """Lines from each point to those that are nearest in a plane, and their numbers."""
    if count < 1 or len(places) < 2:
        raise Unfit("Group must be at least 1, and there must be two points")
    rows = shapes.rows(places)
    flat = shapes.coordinates(frame if frame is not None else shapes.fitted_plane(rows), rows)[:, :2]
    return _linked(flat, places, count, least, most)


@native("81f6afc9-22d9-49f0-8579-1fd7e0df6fa6", "Point Groups", "PGroups",
        "Points (P): point list; Distance (D): number = 1.0",
        "Groups (G): branches; Indices (I): branches")  # fmt: skip
def point_groups(places: list[Any], distance: float) -> tuple[Any, Any]:
    """Points within a distance of another one of their group, and their numbers."""
    rows = shapes.rows(places)
    pairs = KDTree(rows).query_pairs(distance, output_type="ndarray")
    net = coo_array((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(len(rows), len(rows)))
    count, group = connected_components(net, directed=False)
    numbers = [np.flatnonzero(group == k).tolist() for k in range(count)]
    return [[places[i] for i in one] for one in numbers], numbers


@native("5184b8cb-b71e-4def-a590-cd2c9bc58906", "Project Point", "Project",
        "Point (P): point; Direction (D): vector; Geometry (G): geometry list",
        "Point (P); Index (I)",
        remark="surfaces are met where their mesh of 64 by 64 quads is")  # fmt: skip
def project_point(place: Any, direction: Any, geometry: list[Any]) -> tuple[Any, int]:
    """Where the line through a point along a direction meets shapes, the nearest place; and the number of the shape."""
    start, way = shapes.xyz(place), shapes.unit(shapes.xyz(direction))
    if not way.any():
        raise Unfit("the direction has no length")
    met = [
        (abs(t), i, t)
        for i, one in enumerate(geometry)
        if one is not None
        for t in ray_hits(start, way, *surface_mesh(one)).tolist()
    ]
    if not met:
        raise Unfit("the line meets no shape")
    _, index, t = min(met)
    return shapes.point(start + t * way), index


def ray_hits(start: Array, way: Array, a: Array, b: Array, c: Array) -> Array:
    """Parameters along a line of its meetings with triangles, in order (Moeller and Trumbore, 1997)."""
    first, second = b - a, c - a
    cross = np.cross(way, second)
    scale = np.einsum("ij,ij->i", first, cross)
    size = np.linalg.norm(first, axis=1) * np.linalg.norm(second, axis=1)
    flat = np.abs(scale) <= 1e-12 * size
    over = 1.0 / np.where(flat, 1.0, scale)
    from_a = start - a
    u = np.einsum("ij,ij->i", from_a, cross) * over
    turned = np.cross(from_a, first)
    v = turned @ way * over
    slack = 1e-9
    inside = ~flat & (u >= -slack) & (v >= -slack) & (u + v <= 1.0 + slack)
    found: Array = np.sort((np.einsum("ij,ij->i", second, turned) * over)[inside])
    return found


@native("aa333235-5922-424c-9002-1e0b866a854b", "Point Oriented", "Pt",
        "Plane (P): plane; U (U): number = 0.0; V (V): number = 0.0; W (W): number = 0.0", "Point (Pt)")  # fmt: skip
def point_oriented(frame: Any, u: float, v: float, w: float) -> Any:
    """The point with coordinates u, v, w in a plane."""
    return shapes.point(shapes.in_plane(frame, [(u, v, w)])[0])


@native("23603075-be64-4d86-9294-c3c125a12104", "Point Cylindrical", "Pt",
        "Plane (P): plane; Angle (A): number; Radius (R): number = 1.0; Elevation (E): number = 0.0",
        "Point (Pt)")  # fmt: skip
def point_cylindrical(frame: Any, angle: float, radius: float, height: float) -> Any:
    """The point at an angle, a radius and a height in a plane."""
    return shapes.point(shapes.in_plane(frame, [(radius * math.cos(angle), radius * math.sin(angle), height)])[0])


@native("a435f5c8-28a2-43e8-a52a-0b6e73c2e300", "Point Polar", "Pt",
        "Plane (P): plane; Angle xy (xy): number; Angle z (z): number; Offset (d): number = 1.0",
        "Point (Pt)")  # fmt: skip
def point_polar(frame: Any, phi: float, theta: float, distance: float) -> Any:
    """The point at an angle in a plane, an angle over it, and a distance."""
    level = distance * math.cos(theta)
    row = (level * math.cos(phi), level * math.sin(phi), distance * math.sin(theta))
    return shapes.point(shapes.in_plane(frame, [row])[0])


@native("61647ba2-31eb-4921-9632-df81e3286f7d", "To Polar", "Polar", "Point (P): point; System (S): plane",
        "Phi (P); Theta (T); Radius (R)")  # fmt: skip
def to_polar(place: Any, frame: Any) -> tuple[float, float, float]:
    """The angle of a point in a plane from 0 to 2 pi, its angle over the plane, and its distance from the origin."""
    x, y, z = shapes.coordinates(frame, [shapes.xyz(place)])[0].tolist()
    return math.atan2(y, x) % (2.0 * math.pi), math.atan2(z, math.hypot(x, y)), math.hypot(x, y, z)


@native("9adffd61-f5d1-4e9e-9572-e8d9145730dc", "Barycentric", "BCentric",
        "Point A (A): point; Point B (B): point; Point C (C): point; Coordinate U (U): number; "
        "Coordinate V (V): number; Coordinate W (W): number", "Point (P)")  # fmt: skip
def barycentric(a: Any, b: Any, c: Any, u: float, v: float, w: float) -> Any:
    """The mean of three points with weights."""
    total = u + v + w
    if total == 0.0:
        raise Unfit("the weights sum to 0")
    return shapes.point(np.array([u, v, w]) @ shapes.rows([a, b, c]) / total)


@native("59aaebf8-6654-46b7-8386-89223c773978", "Sort Along Curve", "AlongCrv",
        "Points (P): point list; Curve (C): curve", "Points (P): list; Indices (I): list")  # fmt: skip
def sort_along_curve(places: list[Any], curve: Any) -> tuple[list[Any], list[int]]:
    """Points in the order of their nearest points along a curve, and their numbers."""
    at = [nearest(curve, shapes.xyz(place)) for place in places]
    order = sorted(range(len(places)), key=at.__getitem__)
    return [places[i] for i in order], order


@native("9d0c5284-ea24-4f9f-a183-ef57fc48b5b8", "Convex Hull", "Hull",
        "Points (P): point list; Plane (Pl): plane optional",
        "Hull (H); Hull (z) (Hz); Indices (I): list")  # fmt: skip
def convex_hull(places: list[Any], frame: Any) -> tuple[Any, Any, list[int]]:
    """The convex outline of points in a plane, the same through the points, and their numbers."""
    rows = shapes.rows(places)
    plane = frame if frame is not None else shapes.fitted_plane(rows)
    flat = shapes.coordinates(plane, rows)[:, :2]
    try:
        order = ConvexHull(flat).vertices.tolist()
    except QhullError:
        raise Unfit("the points are on a line") from None
    return shapes.polyline(shapes.in_plane(plane, flat[order]), True), shapes.polyline(rows[order], True), order
