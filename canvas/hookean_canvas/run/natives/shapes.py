"""Geometry of rhino3dm as numbers and back: points, vectors, planes, polylines, rectangles, meshes."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hookean.discretize.pieces import bezier_pieces
from hookean_canvas.run.rhino import rhino3dm

Array = NDArray[np.float64]
Faces = list[tuple[int, ...]]


@dataclass(frozen=True, eq=False)
class Group:
    """Geometry that is moved as one."""

    members: tuple[Any, ...]


@dataclass(frozen=True, eq=False)
class TiltedBox:
    """A box along the axes of a plane at its least corner, which are not the world's; `size` along them."""

    frame: Any
    size: tuple[float, float, float]

    def ToBrep(self) -> Any:
        """The six faces."""
        found = rhino3dm.BoundingBox(0.0, 0.0, 0.0, *self.size).ToBrep()
        found.Transform(rhino3dm.Transform.PlaneToPlane(plane((0, 0, 0), (1, 0, 0), (0, 1, 0)), self.frame))
        return found


def box_in(frame: Any, low: ArrayLike, high: ArrayLike) -> Any:
    """The box between two corners in the coordinates of a plane: a BoundingBox along the world's axes, or tilted."""
    ends = np.sort(np.array([low, high], dtype=float), axis=0)
    three = axes(frame)[1:]
    if np.allclose(np.abs(three).max(axis=1), 1.0, rtol=0.0, atol=1e-12):
        corners = in_plane(frame, ends)
        return rhino3dm.BoundingBox(point(corners.min(axis=0)), point(corners.max(axis=0)))
    start = plane(in_plane(frame, ends[:1])[0], three[0], three[1])
    a, b, c = (ends[1] - ends[0]).tolist()
    return TiltedBox(start, (a, b, c))


def box_axes(box: Any) -> tuple[Array, Array, Array]:
    """The least corner of a box, its unit axes (rows), and its size along them."""
    if isinstance(box, TiltedBox):
        origin, *three = axes(box.frame)
        return origin, np.array(three), np.array(box.size)
    low = xyz(box.Min)
    return low, np.eye(3), xyz(box.Max) - low


def xyz(place: Any) -> Array:
    """Coordinates `(3,)` of a point or vector."""
    return np.array([place.X, place.Y, place.Z])


def rows(places: Iterable[Any]) -> Array:
    """Coordinates `(n, 3)` of points or vectors."""
    return np.array([[p.X, p.Y, p.Z] for p in places], dtype=float).reshape(-1, 3)


def point(place: ArrayLike) -> Any:
    """A Point3d of three numbers."""
    return rhino3dm.Point3d(*map(float, np.asarray(place)))


def vector(direction: ArrayLike) -> Any:
    """A Vector3d of three numbers."""
    return rhino3dm.Vector3d(*map(float, np.asarray(direction)))


def points(places: ArrayLike) -> list[Any]:
    """Points of rows `(n, 3)`."""
    return [point(row) for row in np.asarray(places, dtype=float).reshape(-1, 3)]


def unit(direction: Array) -> Array:
    """The direction with length 1; zero stays zero."""
    length = float(np.linalg.norm(direction))
    return direction / length if length > 0.0 else direction


def axes(plane: Any) -> tuple[Array, Array, Array, Array]:
    """Origin and the three unit axes of a plane."""
    return xyz(plane.Origin), xyz(plane.XAxis), xyz(plane.YAxis), xyz(plane.ZAxis)


def plane(origin: ArrayLike, x: ArrayLike, y: ArrayLike) -> Any:
    """A plane; the y axis is made perpendicular to x."""
    return rhino3dm.Plane(point(origin), vector(x), vector(y))


def in_plane(frame: Any, places: ArrayLike) -> Array:
    """World coordinates `(n, 3)` of coordinates `(n, 2 or 3)` in a plane."""
    local = np.asarray(places, dtype=float)
    origin, *three = axes(frame)
    found: Array = origin + local @ np.array(three[: local.shape[1]])
    return found


def coordinates(frame: Any, places: ArrayLike) -> Array:
    """Coordinates `(n, 3)` in a plane of world coordinates `(n, 3)`."""
    origin, *three = axes(frame)
    found: Array = (np.asarray(places, dtype=float) - origin) @ np.array(three).T
    return found


def fitted_plane(places: Array) -> Any:
    """The plane through the mean of points with the least sum of squared distances."""
    centre = places.mean(axis=0)
    directions = np.linalg.svd(places - centre)[2]
    x, y = directions[0], directions[1]
    return plane(centre, x, y if np.cross(x, y)[2] >= 0.0 else -y)


def polyline(places: ArrayLike, closed: bool = False) -> Any:
    """A PolylineCurve through points; closed ones repeat the first at the end."""
    found = points(places)
    return rhino3dm.PolylineCurve(found + found[:1] if closed else found)


def corners(curve: Any) -> Array | None:
    """Corners `(n, 3)` of a curve of straight pieces; None for a curved one."""
    if isinstance(curve, rhino3dm.Line):
        return rows([curve.From, curve.To])
    if isinstance(curve, rhino3dm.LineCurve):
        return rows([curve.PointAtStart, curve.PointAtEnd])
    if isinstance(curve, rhino3dm.PolylineCurve):
        return rows(curve.Point(i) for i in range(curve.PointCount))
    found = curve.TryGetPolyline()
    if found is None or not len(found):
        pieces = bezier_pieces(curve)
        if pieces.shape[1] != 2:
            return None
        return np.concatenate([pieces[:1, 0, :3] / pieces[:1, 0, 3:], pieces[:, 1, :3] / pieces[:, 1, 3:]])
    return rows(found)


def rectangle(curve: Any) -> tuple[Any, float, float] | None:
    """The plane at the first corner, the width and the height of a rectangle; None for another curve."""
    found = corners(curve)
    if found is None or len(found) != 5 or not np.allclose(found[0], found[4]):
        return None
    a, b, c, d = found[:4]
    size = float(np.ptp(found, axis=0).max())
    square = abs(np.dot(unit(b - a), unit(d - a))) < 1e-6
    if not square or np.abs(a + c - b - d).max() > 1e-6 * size:
        return None
    return plane(a, b - a, d - a), float(np.linalg.norm(b - a)), float(np.linalg.norm(d - a))


def mesh(vertices: ArrayLike, faces: Iterable[Sequence[int]]) -> Any:
    """A rhino3dm Mesh in double precision, with normals; faces name 3 or 4 vertices."""
    made = rhino3dm.Mesh()
    for x, y, z in np.asarray(vertices, dtype=float).reshape(-1, 3):
        made.Vertices.AddPoint3d(float(x), float(y), float(z))
    for face in faces:
        distinct = [int(i) for i in face]
        made.Faces.AddFace(*(distinct[:3] if len(distinct) == 4 and distinct[2] == distinct[3] else distinct))
    made.Normals.ComputeNormals()
    return made


_kept: dict[int, list[Any]] = {}
"""Meshes by their ids, each with its vertices and faces once they are read."""


@contextmanager
def kept(geometry: Iterable[Any]) -> Iterator[None]:
    """As long as this lasts the meshes of some geometry are read once; they must not be changed."""
    _kept.update((id(one), [one]) for one in geometry if isinstance(one, rhino3dm.Mesh))
    try:
        yield
    finally:
        _kept.clear()


def mesh_parts(made: Any) -> tuple[Array, Faces]:
    """Vertices `(n, 3)` and faces of 3 or 4 vertices."""
    known = _kept.get(id(made), [made])
    if len(known) == 1:
        faces = [tuple(map(int, made.Faces[i])) for i in range(len(made.Faces))]
        known += [rows(made.Vertices.ToPoint3dArray()), [f[:3] if f[2] == f[3] else f for f in faces]]
    return known[1].copy(), list(known[2])


def transformed(geometry: Any, change: Any) -> Any:
    """A copy of geometry after a transformation; points, lines, vectors, planes and groups have no method for it."""
    if isinstance(geometry, TiltedBox):
        return transformed(geometry.ToBrep(), change)
    if isinstance(geometry, rhino3dm.BoundingBox):
        return transformed(geometry.ToBrep(), change)
    if isinstance(geometry, Group):
        return Group(tuple(transformed(one, change) for one in geometry.members))
    if isinstance(geometry, (rhino3dm.Point3d, rhino3dm.Point)):
        place = geometry.Location if isinstance(geometry, rhino3dm.Point) else geometry
        return rhino3dm.Point3d(place.X, place.Y, place.Z).Transform(change)
    if isinstance(geometry, rhino3dm.Vector3d):
        return vector(_matrix(change)[:3, :3] @ xyz(geometry))
    if isinstance(geometry, rhino3dm.Line):
        return rhino3dm.Line(transformed(geometry.From, change), transformed(geometry.To, change))
    if isinstance(geometry, rhino3dm.Plane):
        linear = _matrix(change)[:3, :3]
        origin, x, y, _ = axes(geometry)
        return plane(xyz(transformed(point(origin), change)), linear @ x, linear @ y)
    copy = geometry.Duplicate()
    copy.Transform(change)
    return copy


def _matrix(change: Any) -> Array:
    return np.array([[getattr(change, f"M{i}{j}") for j in range(4)] for i in range(4)])
