"""Natives that put points and frames on shapes, turn numbers into points, and move geometry onto planes."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import numpy as np

from hookean_canvas.run.natives import shapes
from hookean_canvas.run.natives.curves_at import nearest
from hookean_canvas.run.natives.declare import Unfit, bounded, native
from hookean_canvas.run.natives.meshes import mesh_closest_point
from hookean_canvas.run.natives.shapes import Array
from hookean_canvas.run.natives.surfaces_at import surface_closest_point
from hookean_canvas.run.rhino import rhino3dm

PIECES = 100
"""Pieces into which a curved line is cut to find where it meets another."""


@native("0ae07da9-951b-4b9b-98ca-d312c252374d", "Numbers to Points", "Num2Pt",
        "Numbers (N): number list; Mask (M): text = 'XYZ'", "Points (P): list")  # fmt: skip
def numbers_to_points(numbers: list[Any], mask: str) -> list[Any]:
    """Points of numbers in the order of a mask of x, y and z; coordinates that it lacks are 0."""
    axes = _axes(mask)
    if len(numbers) % len(axes):
        raise Unfit(f"{len(numbers)} numbers are not a multiple of {len(axes)}, the length of the mask")
    found = np.zeros((len(numbers) // len(axes), 3))
    found[:, axes] = np.array(numbers, dtype=float).reshape(-1, len(axes))
    return shapes.points(found)


@native("d24169cc-9922-4923-92bc-b9222efc413f", "Points to Numbers", "Pt2Num",
        "Points (P): point list; Mask (M): text = 'XYZ'", "Numbers (N): list")  # fmt: skip
def points_to_numbers(places: list[Any], mask: str) -> list[float]:
    """Coordinates of points in the order of a mask of x, y and z."""
    found: list[float] = shapes.rows(places)[:, _axes(mask)].reshape(-1).tolist()
    return found


def _axes(mask: str) -> list[int]:
    axes = ["xyz".find(letter) for letter in mask.strip().lower()]
    if not axes or -1 in axes or len(set(axes)) < len(axes):
        raise Unfit(f"the mask is {mask}; it is made of X, Y and Z, each at most once")
    return axes


@native("902289da-28dc-454b-98d4-b8f8aa234516", "Pull Point", "Pull",
        "Point (P): point; Geometry (G): geometry list", "Closest Point (P); Distance (D)")  # fmt: skip
def pull_point(place: Any, geometry: list[Any]) -> tuple[Any, float]:
    """The nearest point of all shapes to a point, and its distance."""
    found = [_closest(place, one) for one in geometry if one is not None]
    if not found:
        raise Unfit("there is no geometry")
    at = min(found, key=lambda one: float(np.linalg.norm(shapes.xyz(one) - shapes.xyz(place))))
    return at, float(np.linalg.norm(shapes.xyz(at) - shapes.xyz(place)))


def _closest(place: Any, geometry: Any) -> Any:
    """The nearest point of a shape."""
    if isinstance(geometry, rhino3dm.Mesh):
        return mesh_closest_point(place, geometry)[0]
    if isinstance(geometry, rhino3dm.Brep | rhino3dm.Surface):
        return brep_closest_point(place, geometry)[0]
    if isinstance(geometry, rhino3dm.Line):
        geometry = rhino3dm.LineCurve(geometry.From, geometry.To)
    if isinstance(geometry, rhino3dm.Curve):
        return geometry.PointAt(nearest(geometry, shapes.xyz(place)))
    if isinstance(geometry, rhino3dm.Plane):
        at = shapes.coordinates(geometry, [shapes.xyz(place)])[0]
        return shapes.point(shapes.in_plane(geometry, [at[:2]])[0])
    if hasattr(geometry, "Z"):
        return geometry
    raise Unfit(f"{type(geometry).__name__} has no nearest point here")


@native("4beead95-8aa2-4613-8bb9-24758a0f5c4c", "Brep Closest Point", "Brep CP",
        "Point (P): point; Brep (B): brep", "Point (P); Normal (N); Distance (D)",
        remark="trimmed faces count as whole surfaces")  # fmt: skip
def brep_closest_point(place: Any, brep: Any) -> tuple[Any, Any, float]:
    """The nearest point of the faces of a Brep to a point, the normal there, and the distance."""
    faces = [brep.Faces[i] for i in range(len(brep.Faces))] if isinstance(brep, rhino3dm.Brep) else [brep]
    found = [(surface_closest_point(place, face), face) for face in faces]
    if not found:
        raise Unfit("the Brep has no faces")
    (at, uv, distance), face = min(found, key=lambda one: one[0][2])
    return at, face.NormalAt(uv.X, uv.Y), distance


@native("332378f4-acb2-43fe-8593-ed22bfeb2721", "Surface Frames", "SFrames",
        "Surface (S): surface; U Count (U): integer = 10; V Count (V): integer = 10",
        "Frames (F): branches; Parameters (uv): branches")  # fmt: skip
def surface_frames(surface: Any, nu: int, nv: int) -> tuple[list[list[Any]], list[list[Any]]]:
    """Planes at even steps of the parameters of a surface, x along u and z along the normal, a branch for each u."""
    if min(nu, nv) < 1:
        raise Unfit("U Count and V Count must be at least 1")
    bounded(nu * nv)
    (u0, u1), (v0, v1) = ((one.T0, one.T1) for one in (surface.Domain(0), surface.Domain(1)))
    at = [[(u, v) for v in np.linspace(v0, v1, nv + 1).tolist()] for u in np.linspace(u0, u1, nu + 1).tolist()]
    return (
        [[_frame(surface, u, v, 1e-6 * (u1 - u0), u1) for u, v in row] for row in at],
        [[rhino3dm.Point3d(u, v, 0.0) for u, v in row] for row in at],
    )


def _frame(surface: Any, u: float, v: float, step: float, last: float) -> Any:
    """The plane of a surface at parameters; at its end the direction is that just before."""
    low = u if u + step <= last else u - step
    along = shapes.unit(shapes.xyz(surface.PointAt(low + step, v)) - shapes.xyz(surface.PointAt(low, v)))
    normal = shapes.xyz(surface.NormalAt(u, v))
    return shapes.plane(shapes.xyz(surface.PointAt(u, v)), along, np.cross(normal, along))


@native("4fe87ef8-49e4-4605-9859-87940d62e1de", "Move To Plane", "MoveToPlane",
        "Geometry (G): geometry; Plane (P): plane; Above (A): boolean = True; Below (B): boolean = True",
        "Geometry (G); Transform (X)")  # fmt: skip
def move_to_plane(geometry: Any, frame: Any, above: bool, below: bool) -> tuple[Any, Any]:
    """Geometry that lies above or below a plane moved along its normal until it touches; what crosses it stays."""
    heights = shapes.coordinates(frame, _extremes(geometry))[:, 2]
    way = -float(heights.min()) if above and heights.min() > 0.0 else 0.0
    way = -float(heights.max()) if below and heights.max() < 0.0 else way
    normal = shapes.xyz(frame.ZAxis)
    change = rhino3dm.Transform.Translation(*(way * normal).tolist())
    return shapes.transformed(geometry, change), change


def _extremes(geometry: Any) -> Array:
    """Points within which geometry lies: its vertices or corners, else the corners of its box."""
    if isinstance(geometry, rhino3dm.Mesh):
        return shapes.mesh_parts(geometry)[0]
    if isinstance(geometry, rhino3dm.Line | rhino3dm.Curve):
        found = shapes.corners(geometry)
        if found is not None:
            return found
    if hasattr(geometry, "Z"):
        return shapes.rows([geometry])
    box = geometry.GetBoundingBox()
    low, high = shapes.xyz(box.Min), shapes.xyz(box.Max)
    return np.array([[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])])


@native("5edaea74-32cb-4586-bd72-66694eb73160", "Rotate Direction", "Rotate",
        "Geometry (G): geometry; Center (C): point; From (F): vector; To (T): vector",
        "Geometry (G); Transform (X)")  # fmt: skip
def rotate_direction(geometry: Any, centre: Any, start: Any, end: Any) -> tuple[Any, Any]:
    """Geometry turned about a point, as one direction is turned into another on the shortest way."""
    if min(np.linalg.norm(shapes.xyz(start)), np.linalg.norm(shapes.xyz(end))) == 0.0:
        raise Unfit("a direction has no length")
    change = rhino3dm.Transform.Rotation(start, end, centre)
    return shapes.transformed(geometry, change), change


@native("84627490-0fb2-4498-8138-ad134ee4cb36", "Curve | Curve", "CCX",
        "Curve A (A): curve; Curve B (B): curve",
        "Points (P): list; Params A (tA): list; Params B (tB): list",
        remark=f"curved lines meet where polylines of {PIECES} pieces do")  # fmt: skip
def curve_curve(a: Any, b: Any) -> tuple[list[Any], list[float], list[float]]:
    """Where two curves meet, along the first, and their parameters there."""
    ends = [_pieces(curve) for curve in (a, b)]
    size = max(float(np.ptp(rows, axis=0).max()) for rows in ends)
    found: list[Array] = []
    for p, q in pairwise(ends[0]):
        for place in _meetings(p, q, ends[1], 1e-6 * size):
            if all(np.linalg.norm(place - other) > 1e-6 * size for other in found):
                found.append(place)
    return shapes.points(found), [nearest(a, one) for one in found], [nearest(b, one) for one in found]


def _pieces(curve: Any) -> Array:
    """Corners of a curve; of a curved one at even steps of its parameter."""
    corners = shapes.corners(curve)
    if corners is not None:
        return corners
    ends = np.linspace(curve.Domain.T0, curve.Domain.T1, PIECES + 1).tolist()
    return shapes.rows(curve.PointAt(t) for t in ends)


def _meetings(p: Array, q: Array, corners: Array, near: float) -> list[Array]:
    """Points of a piece from p to q that pieces of a polyline come nearer to than `near`, in order along it."""
    starts, ways = corners[:-1], np.diff(corners, axis=0)
    along = q - p
    # the nearest points of two lines: (along, -way) . (s, t) = start - p in least squares
    normal = np.cross(along, ways)
    square = np.einsum("ij,ij->i", normal, normal)
    safe = np.where(square > 1e-24 * max(float(along @ along), 1e-300) ** 2, square, np.inf)
    s = np.einsum("ij,ij->i", np.cross(starts - p, ways), normal) / safe
    t = np.einsum("ij,ij->i", np.cross(starts - p, along), normal) / safe
    gap = np.linalg.norm(p + s[:, None] * along - starts - t[:, None] * ways, axis=1)
    slack = 1e-9
    meets = np.isfinite(safe) & (gap < near) & (np.abs(s - 0.5) <= 0.5 + slack) & (np.abs(t - 0.5) <= 0.5 + slack)
    return [p + part * along for part in sorted(s[meets].tolist())]


@native("a4011be0-1c91-45bd-8280-17dd3a9f46f1", "Voronoi", "Voronoi",
        "Points (P): point list; Radius (R): number optional; Boundary (B): rectangle optional; Plane (Pl): plane",
        "Cells (C): list",
        remark="without a boundary cells end at the box of the points, widened by a tenth of its diagonal; a radius "
        "cuts cells by a polygon of 48 sides")  # fmt: skip
def voronoi(places: list[Any], radius: float | None, boundary: Any, frame: Any) -> list[Any]:
    """For each point the part of a plane that is nearer to it than to others."""
    rows = shapes.coordinates(frame, shapes.rows(places))[:, :2]
    bounded(len(rows) ** 2)
    if boundary is not None:
        corner, width, height = boundary
        square = shapes.in_plane(corner, [(0, 0), (width, 0), (width, height), (0, height)])
        outline = shapes.coordinates(frame, square)[:, :2]
    else:
        low, high = rows.min(axis=0), rows.max(axis=0)
        low, high = low - 0.1 * math.dist(low, high), high + 0.1 * math.dist(low, high)
        outline = np.array([low, (high[0], low[1]), high, (low[0], high[1])])
    cells = []
    for i, place in enumerate(rows):
        cell = outline
        if radius is not None:
            for angle in np.arange(48) * (math.pi / 24):
                way = np.array([math.cos(angle), math.sin(angle)])
                cell = _cut(cell, way, float(way @ place) + radius)
        for j, other in enumerate(rows):
            if j != i and np.any(other != place):
                cell = _cut(cell, other - place, float((other - place) @ (other + place)) / 2.0)
        cells.append(shapes.polyline(shapes.in_plane(frame, cell), closed=True) if len(cell) > 2 else None)
    return cells


def _cut(cell: Array, way: Array, most: float) -> Array:
    """The part of a convex polygon with way . x <= most."""
    beyond = cell @ way - most
    found = []
    for k in range(len(cell)):
        a, b = beyond[k - 1], beyond[k]
        if (a <= 0.0) != (b <= 0.0):
            found.append(cell[k - 1] + a / (a - b) * (cell[k] - cell[k - 1]))
        if b <= 0.0:
            found.append(cell[k])
    return np.array(found).reshape(-1, 2)
