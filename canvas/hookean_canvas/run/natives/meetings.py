"""Natives of the tab Intersect: where lines, curves, planes and meshes meet, and sections."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from hookean_canvas.run.natives import shapes
from hookean_canvas.run.natives.curves_at import nearest
from hookean_canvas.run.natives.declare import Unfit, bounded, native
from hookean_canvas.run.natives.measures import surface_mesh
from hookean_canvas.run.natives.places import curve_curve
from hookean_canvas.run.natives.points_more import ray_hits
from hookean_canvas.run.rhino import rhino3dm

Array = shapes.Array
STEPS = 64
"""Parts of each span of a curve in which a meeting is sought."""
_MESHED = "surfaces count as their meshes of 64 by 64 quads"


@native("75d0442c-1aa3-47cf-bd94-457b42c16e9f", "Line | Plane", "PLX", "Line (L): line; Plane (P): plane",
        "Point (P); Param L (t); Param P (uv)")  # fmt: skip
def line_plane(line: Any, frame: Any) -> tuple[Any, float, Any]:
    """Where a line without ends meets a plane, its parameter there, and the coordinates in the plane."""
    heights = shapes.coordinates(frame, shapes.rows([line.From, line.To]))[:, 2]
    rise = float(heights[1] - heights[0])
    if abs(rise) <= 1e-12 * max(np.abs(heights).max(), float(line.Length)):
        raise Unfit("the line is parallel to the plane")
    t = -float(heights[0]) / rise
    at = shapes.xyz(line.From) + t * (shapes.xyz(line.To) - shapes.xyz(line.From))
    u, v, _ = shapes.coordinates(frame, [at])[0].tolist()
    return shapes.point(at), t, rhino3dm.Point3d(u, v, 0.0)


@native("6d4b82a7-8c1d-4bec-af7b-ca321ba4beb1", "Line | Line", "LLX", "Line 1 (A): line; Line 2 (B): line",
        "Param A (tA); Param B (tB); Point A (pA); Point B (pB)")  # fmt: skip
def line_line(a: Any, b: Any) -> tuple[float, float, Any, Any]:
    """Where two lines without ends are nearest, by their parameters and on both."""
    p, q = shapes.xyz(a.From), shapes.xyz(b.From)
    along, other = shapes.xyz(a.To) - p, shapes.xyz(b.To) - q
    normal = np.cross(along, other)
    square = float(normal @ normal)
    if square <= 1e-24 * float(along @ along) * float(other @ other):
        raise Unfit("the lines are parallel")
    s, t = (float(np.cross(q - p, way) @ normal) / square for way in (other, along))
    return s, t, shapes.point(p + s * along), shapes.point(q + t * other)


@native("290cf9c4-0711-4704-851e-4c99e3343ac5", "Plane | Plane", "PPX", "Plane A (A): plane; Plane B (B): plane",
        "Line (L)")  # fmt: skip
def plane_plane(a: Any, b: Any) -> Any:
    """The line in which two planes meet."""
    (p, _, _, m), (q, _, _, n) = (shapes.axes(one) for one in (a, b))
    along = np.cross(m, n)
    if np.linalg.norm(along) < 1e-12:
        raise Unfit("the planes are parallel")
    middle = 0.5 * (p + q)
    foot = np.linalg.lstsq(np.array([m, n]), np.array([m @ (p - middle), n @ (q - middle)]), rcond=None)[0]
    return rhino3dm.Line(shapes.point(middle + foot), shapes.point(middle + foot + shapes.unit(along)))


@native("f1ea5a4b-1a4f-4cf4-ad94-1ecfb9302b6e", "Plane | Plane | Plane", "3PX",
        "Plane A (A): plane; Plane B (B): plane; Plane C (C): plane",
        "Point (Pt); Line AB (AB); Line AC (AC); Line BC (BC)")  # fmt: skip
def three_planes(a: Any, b: Any, c: Any) -> tuple[Any, Any, Any, Any]:
    """The point in which three planes meet, and the lines of each two."""
    origins, normals = (np.array([shapes.axes(one)[k] for one in (a, b, c)]) for k in (0, 3))
    if abs(np.linalg.det(normals)) < 1e-12:
        raise Unfit("the planes have no single point in common")
    at = np.linalg.solve(normals, np.einsum("ij,ij->i", normals, origins))
    return shapes.point(at), plane_plane(a, b), plane_plane(a, c), plane_plane(b, c)


@native("b7c12ed1-b09a-4e15-996f-3fa9f3f16b1c", "Curve | Plane", "PCX", "Curve (C): curve; Plane (P): plane",
        "Points (P): list; Params C (t): list; Params P (uv): list")  # fmt: skip
def curve_plane(curve: Any, frame: Any) -> tuple[list[Any], list[float], list[Any]]:
    """Where a curve crosses a plane, its parameters there, and the coordinates in the plane."""
    at = crossings(curve, frame)
    places = [curve.PointAt(t) for t in at]
    flat = shapes.coordinates(frame, shapes.rows(places)) if places else np.zeros((0, 3))
    return places, at, [rhino3dm.Point3d(float(u), float(v), 0.0) for u, v, _ in flat]


def crossings(curve: Any, frame: Any) -> list[float]:
    """Parameters at which a curve crosses or touches a plane with a corner or an end."""
    origin, _, _, normal = shapes.axes(frame)

    def height(t: float) -> float:
        return float((shapes.xyz(curve.PointAt(t)) - origin) @ normal)

    ends = np.unique([t for pair in _spans(curve) for t in np.linspace(*pair, STEPS + 1)]).tolist()
    heights = [height(t) for t in ends]
    tiny = 1e-12 * max(max(map(abs, heights)), 1e-300)
    found = [t for t, h in zip(ends, heights, strict=True) if abs(h) <= tiny]
    for (t0, t1), (h0, h1) in zip(pairwise(ends), pairwise(heights), strict=True):
        if min(abs(h0), abs(h1)) > tiny and h0 * h1 < 0.0:
            found.append(brentq(height, t0, t1, xtol=1e-14 * max(abs(t0), abs(t1), 1.0), rtol=1e-14))
    found.sort()
    same = curve.IsClosed and len(found) > 1 and found[0] == ends[0] and found[-1] == ends[-1]
    return found[:-1] if same else found


def _spans(curve: Any) -> Iterator[tuple[float, float]]:
    nurbs = curve.ToNurbsCurve()
    knots = [curve.GetCurveParameterFromNurbsFormParameter(nurbs.Knots[i])[1] for i in range(len(nurbs.Knots))]
    return pairwise(np.unique([curve.Domain.T0, *knots, curve.Domain.T1]).tolist())


@native("0e3173b6-91c6-4845-a748-e45d4fdbc262", "Curve | Line", "CLX", "Curve (C): curve; Line (L): line",
        "Points (P): list; Params (t): list; Count (N)")  # fmt: skip
def curve_on_line(curve: Any, line: Any) -> tuple[list[Any], list[float], int]:
    """Where a curve meets a line segment, and its parameters there."""
    places, at, _ = curve_curve(curve, rhino3dm.LineCurve(line.From, line.To))
    return places, at, len(places)


@native("931e6030-ccb3-4a7b-a89a-99dcce8770cd", "Multiple Curves", "MCX", "Curves (C): curve list",
        "Points (P): list; Index A (iA): list; Index B (iB): list; Param A (tA): list; Param B (tB): list")  # fmt: skip
def multiple_curves(curves: list[Any]) -> tuple[list[Any], ...]:
    """Where each two of some curves meet, their numbers and parameters."""
    met = [
        (place, i, j, s, t)
        for i, a in enumerate(curves)
        for j, b in enumerate(curves[i + 1 :], i + 1)
        for place, s, t in zip(*curve_curve(a, b), strict=True)
    ]
    return tuple(map(list, zip(*met, strict=True))) if met else ([], [], [], [], [])


@native("4c02a168-9aba-4f42-8951-2719f24d391f", "Mesh | Ray", "MeshRay",
        "Mesh (M): mesh; Point (P): point; Direction (D): vector", "Point (X); Hit (H)")  # fmt: skip
def mesh_ray(mesh: Any, place: Any, direction: Any) -> tuple[Any, bool]:
    """The first point in which a ray from a point meets a mesh; null where it meets none."""
    start, way = shapes.xyz(place), shapes.unit(shapes.xyz(direction))
    met = ray_hits(start, way, *surface_mesh(mesh))
    ahead = met[met >= 0.0]
    return (shapes.point(start + ahead[0] * way), True) if len(ahead) else (None, False)


@native("19632848-4b95-4e5e-9e86-b79b47987a46", "Mesh | Curve", "MCX", "Mesh (M): mesh; Curve (C): curve",
        "Points (X): list; Faces (F): list",
        remark="a curved line meets a mesh where its polyline does; faces are not numbered")  # fmt: skip
def mesh_curve(mesh: Any, curve: Any) -> tuple[list[Any], list[Any]]:
    """Where a curve meets a mesh."""
    found = shapes.points(_through(curve, *surface_mesh(mesh)))
    return found, [None] * len(found)


@native("20ef81e8-df15-4a0c-acf1-993a7607cafb", "Brep | Curve", "BCX", "Brep (B): brep; Curve (C): curve",
        "Curves (C): list; Points (P): list", remark=_MESHED)  # fmt: skip
def brep_curve(brep: Any, curve: Any) -> tuple[list[Any], list[Any]]:
    """Where a curve meets a Brep."""
    return [], shapes.points(_through(curve, *surface_mesh(brep)))


@native("ed0742f9-6647-4d95-9dfd-9ad17080ae9c", "Brep | Line", "BLX", "Brep (B): brep; Line (L): line",
        "Curves (C): list; Points (P): list", remark=_MESHED)  # fmt: skip
def brep_line(brep: Any, line: Any) -> tuple[list[Any], list[Any]]:
    """Where a line segment meets a Brep."""
    return [], shapes.points(_through(rhino3dm.LineCurve(line.From, line.To), *surface_mesh(brep)))


def _through(curve: Any, a: Array, b: Array, c: Array) -> Array:
    """Points in which the pieces of a curve meet triangles, in order, one for each place."""
    corners = shapes.corners(curve)
    if corners is None:
        ends = [t for pair in _spans(curve) for t in np.linspace(*pair, STEPS + 1)]
        corners = shapes.rows(curve.PointAt(float(t)) for t in np.unique(ends))
    found: list[Array] = []
    size = float(np.ptp(corners, axis=0).max())
    for p, q in pairwise(corners):
        for t in ray_hits(p, q - p, a, b, c):
            at = p + t * (q - p)
            if -1e-9 <= t <= 1.0 + 1e-9 and all(np.linalg.norm(at - one) > 1e-6 * size for one in found):
                found.append(at)
    return np.array(found).reshape(-1, 3)


@native("3b1ae469-0e9b-461d-8c30-fa5a7de8b7a9", "Mesh | Plane", "Sec", "Mesh (M): mesh; Plane (P): plane",
        "Curves (C): list")  # fmt: skip
def mesh_plane(mesh: Any, frame: Any) -> list[Any]:
    """The lines in which a plane cuts a mesh."""
    return section(*_welded(*surface_mesh(mesh)), frame)


@native("4fe828e8-fa95-4cc5-9a8c-c33856ecc783", "Brep | Plane", "Sec", "Brep (B): brep; Plane (P): plane",
        "Curves (C): list; Points (P): list", remark=_MESHED)  # fmt: skip
def brep_plane(brep: Any, frame: Any) -> tuple[list[Any], list[Any]]:
    """The lines in which a plane cuts a Brep."""
    return section(*_welded(*surface_mesh(brep)), frame), []


@native("3b112fb6-3eba-42d2-ba75-0f903c18faab", "Contour", "Contour",
        "Shape (S): geometry; Point (P): point; Direction (N): vector; Distance (D): number", "Contours (C): branches",
        remark=_MESHED)  # fmt: skip
def contour(shape: Any, start: Any, normal: Any, distance: float) -> list[list[Any]]:
    """The lines in which planes at equal distances cut a shape, a branch for each plane, one plane through a point."""
    way = shapes.unit(shapes.xyz(normal))
    if not way.any() or distance <= 0.0:
        raise Unfit("Direction must have a length, and Distance be above 0")
    vertices, faces = _welded(*surface_mesh(shape))
    heights = (vertices - shapes.xyz(start)) @ way
    first, last = np.ceil(heights.min() / distance - 1e-9), np.floor(heights.max() / distance + 1e-9)
    bounded(last - first)
    planes = (rhino3dm.Plane(shapes.point(shapes.xyz(start) + k * distance * way), shapes.vector(way))
              for k in range(int(first), int(last) + 1))  # fmt: skip
    return [section(vertices, faces, frame) for frame in planes]


def _welded(a: Array, b: Array, c: Array) -> tuple[Array, NDArray[np.intp]]:
    """Vertices (n, 3) and triangles (t, 3) of corners, equal places made one."""
    rows = np.stack([a, b, c], axis=1).reshape(-1, 3)
    size = float(np.ptp(rows, axis=0).max(initial=0.0)) or 1.0
    _, first, which = np.unique(np.round(rows / size, 9), axis=0, return_index=True, return_inverse=True)
    return rows[first], which.reshape(-1, 3)


def section(vertices: Array, triangles: NDArray[np.intp], frame: Any) -> list[Any]:
    """Polylines in which a plane cuts triangles; a vertex on the plane counts as above it."""
    heights = shapes.coordinates(frame, vertices)[:, 2]
    heights[np.abs(heights) <= 1e-12 * max(float(np.abs(heights).max(initial=0.0)), 1e-300)] = 0.0
    above = heights >= 0.0
    at: dict[tuple[int, int], Array] = {}
    links: dict[tuple[int, int], list[tuple[int, int]]] = {}
    for face in triangles[above[triangles].any(axis=1) & ~above[triangles].all(axis=1)].tolist():
        cut = [(min(i, j), max(i, j)) for i, j in pairwise([*face, face[0]]) if above[i] != above[j]]
        for i, j in cut:
            t = heights[i] / (heights[i] - heights[j])
            at[i, j] = vertices[i] + t * (vertices[j] - vertices[i])
        links.setdefault(cut[0], []).append(cut[1])
        links.setdefault(cut[1], []).append(cut[0])
    return [shapes.polyline(rows) for rows in _chained(at, links)]


def _chained(at: dict[Any, Array], links: dict[Any, list[Any]]) -> Iterator[Array]:
    """Rows of points along links: open chains from their ends, then closed ones; points in one place are one."""
    for start in [*(key for key, ends in links.items() if len(ends) == 1), *links]:
        chain = [start]
        while links[chain[-1]]:
            following = links[chain[-1]].pop()
            links[following].remove(chain[-1])
            chain.append(following)
        rows = np.array([at[key] for key in chain])
        moved = np.linalg.norm(np.diff(rows, axis=0), axis=1) > 1e-12 * float(np.ptp(rows, axis=0).max(initial=0.0))
        rows = rows[np.concatenate([[True], moved])]
        if len(rows) > 1:
            yield rows


@native("6b7ba278-5c9d-42f1-a61d-6209cbd44907", "Curve Proximity", "CrvProx", "Curve A (A): curve; Curve B (B): curve",
        "Point A (A); Point B (B); Distance (D)")  # fmt: skip
def curve_proximity(a: Any, b: Any) -> tuple[Any, Any, float]:
    """The points in which two curves are nearest, and their distance."""
    ends = [t for pair in _spans(a) for t in np.linspace(*pair, STEPS + 1).tolist()]
    rows = shapes.rows(map(b.PointAt, [t for pair in _spans(b) for t in np.linspace(*pair, STEPS + 1).tolist()]))
    gaps = [float(np.linalg.norm(rows - shapes.xyz(a.PointAt(t)), axis=1).min()) for t in ends]
    s = ends[int(np.argmin(gaps))]
    for _ in range(60):  # the nearest point of each curve to that of the other
        q = b.PointAt(nearest(b, shapes.xyz(a.PointAt(s))))
        moved = nearest(a, shapes.xyz(q))
        if abs(moved - s) <= 1e-12 * (a.Domain.T1 - a.Domain.T0):
            break
        s = moved
    p = a.PointAt(s)
    return p, q, float(np.linalg.norm(shapes.xyz(p) - shapes.xyz(q)))
