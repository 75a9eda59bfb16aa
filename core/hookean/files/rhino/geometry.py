"""From arrays and meshes to rhino3dm geometry that Rhino accepts, coordinates to the last bit."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hookean.errors import InputError
from hookean.files.rhino.model import rhino
from hookean.values.mesh import Mesh


@dataclass(frozen=True, eq=False)
class Points:
    """A set of points `(n, 3)` in length units, written as one point cloud."""

    points: ArrayLike


@dataclass(frozen=True, slots=True, eq=False)
class Built:
    """A rhino3dm geometry, a digest of its content, and what had to be changed (empty: nothing)."""

    geometry: Any
    digest: str
    note: str = ""


def build(geometry: object, colours: ArrayLike | None, pointer: str) -> Built:
    """The rhino3dm geometry for what a caller gave.

    `geometry` is a rhino3dm geometry (kept as it is), a `Mesh`, `Points`, or coordinates: `(3,)` a point,
    `(2, 3)` a line, `(k, 3)` a polyline. `colours` `(n, 3 or 4)` 0-255 colours a mesh's or point set's n
    points. Lines and faces without extent are kept as points or left out, and `note` reports this: Rhino
    discards them. Raises InputError at `pointer` for anything else, and for coordinates not finite.
    """
    if isinstance(geometry, rhino.GeometryBase):
        return _given(geometry, colours, pointer)
    if isinstance(geometry, Mesh):
        return _mesh(geometry, colours, pointer)
    if isinstance(geometry, Points):
        points = _coordinates(geometry.points, pointer)
        if points.ndim != 2 or not len(points):
            raise InputError(pointer, f"a point set has shape {points.shape}; give (n, 3) with n at least 1.")
        return Built(_cloud(points, _colours(colours, len(points), pointer)), _digest(b"points", points, colours))
    if colours is not None:
        raise InputError(
            pointer, "colours are given for a point, line or polyline; only meshes and Points support them."
        )
    points = _coordinates(geometry, pointer)
    digest = _digest(b"curve", points)
    if points.shape == (3,):
        return Built(rhino.Point(_point(points)), digest)
    if points.ndim != 2 or len(points) < 2:
        raise InputError(
            pointer, f"coordinates of shape {points.shape}; give (3,) a point, (2, 3) a line or (k, 3) a polyline."
        )
    return _curve(points, digest, pointer)


def _given(geometry: Any, colours: ArrayLike | None, pointer: str) -> Built:
    if colours is not None:
        raise InputError(pointer, "colours are given for a rhino3dm geometry; set them on the geometry itself.")
    if isinstance(geometry, rhino.InstanceReference):
        raise InputError(pointer, "a block instance cannot be added; expand it and add its members.")
    valid, why = geometry.IsValidWithLog
    box = geometry.GetBoundingBox()
    corners = [getattr(corner, axis) for corner in (box.Min, box.Max) for axis in "XYZ"]
    if not np.isfinite(corners).all():
        raise InputError(pointer, f"{type(geometry).__name__} has coordinates that are not finite; remove it.")
    if not valid:
        reason = " ".join(why.split()) or "it is empty or has no extent"
        raise InputError(pointer, f"{type(geometry).__name__} is not valid in Rhino: {reason}; remove or repair it.")
    return Built(geometry, hashlib.sha256(geometry.Encode()["data"].encode()).hexdigest())


def _curve(points: NDArray[np.float64], digest: str, pointer: str) -> Built:
    # Rhino discards curves with repeated points; what counts as the same point grows with the coordinates
    near = 1e-9 + 1e-14 * float(np.abs(points).max())
    kept = [points[0]]
    for point in points[1:]:
        if float(np.abs(point - kept[-1]).max()) > near:
            kept.append(point)
    if len(kept) == 1:
        return Built(rhino.Point(_point(kept[0])), digest, "a line of zero length is written as a point")
    if len(kept) == 2 and len(points) == 2:
        curve = rhino.LineCurve(_point(kept[0]), _point(kept[1]))
    else:
        curve = rhino.PolylineCurve([_point(point) for point in kept])
    if not curve.IsValid:
        if len(points) == 2:
            return Built(rhino.Point(_point(kept[0])), digest, "a line of zero length is written as a point")
        raise InputError(pointer, "a polyline has points too close together for Rhino; remove repeated points.")
    note = "" if len(kept) == len(points) else "repeated points of a polyline are left out"
    return Built(curve, digest, note)


def _mesh(mesh: Mesh, colours: ArrayLike | None, pointer: str) -> Built:
    vertices = _coordinates(mesh.vertices, pointer)
    faces = np.asarray(mesh.faces)
    if vertices.ndim != 2 or faces.ndim != 2 or faces.shape[1] not in (3, 4) or faces.dtype.kind not in "iu":
        raise InputError(
            pointer,
            f"a mesh with vertices {vertices.shape} and faces {faces.shape} {faces.dtype}; "
            "give vertices (n, 3) and whole-number faces (m, 3) or (m, 4).",
        )
    if faces.size and not (int(faces.min()) >= 0 and int(faces.max()) < len(vertices)):
        raise InputError(pointer, f"a face refers to a vertex outside 0..{len(vertices) - 1}; correct the faces.")
    corners, dropped = _faces(vertices, faces)
    if not corners:
        raise InputError(pointer, "a mesh has only faces of zero area; give at least one with an area.")
    made = rhino.Mesh()
    made.Vertices.UseDoublePrecisionVertices = True  # the default rounds to float32
    for x, y, z in vertices.tolist():
        made.Vertices.AddPoint3d(x, y, z)
    for face in corners:
        made.Faces.AddFace(*face)
    for red, green, blue, _ in _colours(colours, len(vertices), pointer):
        made.VertexColors.Add(red, green, blue)
    valid, why = made.IsValidWithLog
    if not valid:
        raise InputError(pointer, f"a mesh is not valid in Rhino: {' '.join(why.split())}; repair it.")
    note = f"{dropped} faces of zero area of a mesh are left out" if dropped else ""
    return Built(made, _digest(b"mesh", vertices, faces, colours), note)


def _faces(vertices: NDArray[np.float64], faces: NDArray[Any]) -> tuple[list[list[int]], int]:
    """Faces as 3 or 4 corners at distinct places, and how many have fewer than three."""
    place = np.unique(vertices, axis=0, return_inverse=True)[1].reshape(-1)
    corners, dropped = [], 0
    for face, at in zip(faces.tolist(), place[faces].tolist(), strict=True):
        distinct = list(dict(zip(reversed(at), reversed(face), strict=True)).values())[::-1]
        if len(distinct) < 3:
            dropped += 1
        else:
            corners.append(distinct)
    return corners, dropped


def _cloud(points: NDArray[np.float64], colours: list[tuple[int, int, int, int]]) -> Any:
    cloud = rhino.PointCloud()
    every = [_point(point) for point in points]
    if colours:
        cloud.AddRange(every, colours)
    else:
        cloud.AddRange(every)
    return cloud


def _coordinates(values: object, pointer: str) -> NDArray[np.float64]:
    try:
        array = np.array(values, dtype=np.float64)
    except (TypeError, ValueError):
        raise InputError(
            pointer,
            f"a geometry of type {type(values).__name__}; give coordinates, a Mesh, Points or a rhino3dm geometry.",
        ) from None
    if array.ndim not in (1, 2) or array.shape[-1] != 3:
        raise InputError(pointer, f"coordinates of shape {array.shape}; the last axis must be 3 long.")
    if not np.isfinite(array).all():
        raise InputError(pointer, "coordinates that are not finite; give finite numbers.")
    return array


def _colours(values: ArrayLike | None, count: int, pointer: str) -> list[tuple[int, int, int, int]]:
    if values is None:
        return []
    array = np.asarray(values)
    if array.ndim != 2 or array.shape[0] != count or array.shape[1] not in (3, 4) or array.dtype.kind not in "iu":
        raise InputError(pointer, f"colours of shape {array.shape}; give ({count}, 3) whole numbers 0-255.")
    if array.size and not (int(array.min()) >= 0 and int(array.max()) <= 255):
        raise InputError(pointer, "a colour outside 0-255; give whole numbers 0-255.")
    opaque = np.full((count, 4), 255)
    opaque[:, : array.shape[1]] = array
    return [(int(r), int(g), int(b), int(a)) for r, g, b, a in opaque.tolist()]


def _point(values: NDArray[np.float64]) -> Any:
    x, y, z = values.tolist()
    return rhino.Point3d(x, y, z)


def _digest(kind: bytes, *parts: object) -> str:
    hashed = hashlib.sha256(kind)
    for part in parts:
        array = np.ascontiguousarray(part if part is not None else ())
        hashed.update(f"{array.shape}".encode())
        hashed.update(array.astype("<f8" if array.dtype.kind == "f" else "<i8").tobytes())
    return hashed.hexdigest()
