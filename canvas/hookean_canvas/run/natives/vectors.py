"""Natives of the tab Vector: points, vectors, planes, grids."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from hookean_canvas.run.natives import shapes
from hookean_canvas.run.natives.declare import Unfit, bounded, native
from hookean_canvas.run.rhino import rhino3dm

_XYZ = ("X", "Y", "Z")
_AXES = (
    ("79f9fbb3-8f1d-4d9a-88a9-f7961b1012cd", "Unit X"),
    ("d3d195ea-2d59-4ffa-90b1-8b7ff3369f69", "Unit Y"),
    ("9103c240-a6a9-4223-9b42-dbd19bf38e2b", "Unit Z"),
)
_COORDINATES = "; ".join(f"{axis} coordinate ({axis}): number = 0.0" for axis in _XYZ)
_COMPONENTS = "; ".join(f"{axis} component ({axis}): number = 0.0" for axis in _XYZ)
_PARTS = "; ".join(f"{axis} component ({axis})" for axis in _XYZ)
_TWO = "Vector A (A): vector; Vector B (B): vector"
_UNIT = "Unitize (U): boolean = False"
_LONG = "Vector (V); Length (L)"


@native("3581f42a-9592-4549-bd6b-1c0fc39d067b", "Construct Point", "Pt", _COORDINATES, "Point (Pt)")
def point(x: float, y: float, z: float) -> Any:
    """A point from its {xyz} coordinates; a coordinate without data is 0."""
    return rhino3dm.Point3d(x, y, z)


@native("9abae6b7-fa1d-448c-9209-4a8155345841", "Deconstruct", "pDecon", "Point (P): point", _PARTS)
def deconstruct(place: Any) -> tuple[float, float, float]:
    """The coordinates of a point."""
    return place.X, place.Y, place.Z


@native("56b92eab-d121-43f7-94d3-6cd8f0ddead8", "Vector XYZ", "Vec", _COMPONENTS, _LONG)
def vector(x: float, y: float, z: float) -> tuple[Any, float]:
    """A vector from its {xyz} components, and its length."""
    return _long(np.array([x, y, z]))


@native("a50fcd4a-cf42-4c3f-8616-022761e6cc93", "Deconstruct Vector", "DeVec", "Vector (V): vector", _PARTS)
def deconstruct_vector(direction: Any) -> tuple[float, float, float]:
    """The components of a vector."""
    return direction.X, direction.Y, direction.Z


def _along(guid: str, name: str, axis: int) -> None:
    def run(factor: float) -> Any:
        return rhino3dm.Vector3d(*(factor if i == axis else 0.0 for i in range(3)))

    run.__doc__ = f"A vector parallel to the world's {_XYZ[axis].lower()} axis, the unit times the factor."
    native(guid, name, _XYZ[axis], "Factor (F): number = 1.0", "Unit vector (V)")(run)


for _number, _row in enumerate(_AXES):
    _along(*_row, _number)


def _long(direction: shapes.Array) -> tuple[Any, float]:
    return shapes.vector(direction), float(np.linalg.norm(direction))


def _scaled(direction: shapes.Array, unitize: bool) -> tuple[Any, float]:
    return _long(shapes.unit(direction) if unitize else direction)


@native("934ede4a-924a-4973-bb05-0dc4b36fae75", "Vector 2Pt", "Vec2Pt",
        f"Point A (A): point; Point B (B): point; {_UNIT}", _LONG)  # fmt: skip
def vector_between(a: Any, b: Any, unitize: bool) -> tuple[Any, float]:
    """The vector from A to B, with length 1 if Unitize is True, and its length."""
    return _scaled(shapes.xyz(b) - shapes.xyz(a), unitize)


@native("675e31bf-1775-48d7-bb8d-76b77786dd53", "Vector Length", "VLen", "Vector (V): vector", "Length (L)")
def vector_length(direction: Any) -> float:
    """The length of a vector."""
    return float(np.linalg.norm(shapes.xyz(direction)))


@native("6ec39468-dae7-4ffa-a766-f2ab22a2c62e", "Amplitude", "Amp",
        "Vector (V): vector; Amplitude (A): number", "Vector (V)")  # fmt: skip
def amplitude(direction: Any, length: float) -> Any:
    """A vector with another length."""
    return shapes.vector(_unit(direction) * length)


@native("d2da1306-259a-4994-85a4-672d8a4c7805", "Unit Vector", "Unit", "Vector (V): vector", "Vector (V)")
def unit_vector(direction: Any) -> Any:
    """A vector with length 1."""
    return shapes.vector(_unit(direction))


def _unit(direction: Any) -> shapes.Array:
    found = shapes.unit(shapes.xyz(direction))
    if not found.any():
        raise Unfit("a vector of length zero has no direction")
    return found


@native("d5788074-d75d-4021-b1a3-0bf992928584", "Reverse", "Rev", "Vector (V): vector", "Vector (V)")
def reverse(direction: Any) -> Any:
    """A vector times -1."""
    return shapes.vector(-shapes.xyz(direction))


@native("fb012ef9-4734-4049-84a0-b92b85bb09da", "Addition", "VAdd", f"{_TWO}; {_UNIT}", _LONG)
def add(a: Any, b: Any, unitize: bool) -> tuple[Any, float]:
    """The sum of two vectors, with length 1 if Unitize is True, and its length."""
    return _scaled(shapes.xyz(a) + shapes.xyz(b), unitize)


@native("63fff845-7c61-4dfb-ba12-44d481b4bf0f", "Multiply", "VMul",
        "Vector (V): vector; Factor (F): number = 1.0", _LONG)  # fmt: skip
def multiply(direction: Any, factor: float) -> tuple[Any, float]:
    """A vector times a number, and its length."""
    return _long(shapes.xyz(direction) * factor)


@native("310e1065-d03a-4858-bcd1-809d39c042af", "Divide", "VDiv",
        "Vector (V): vector; Factor (F): number = 1.0", _LONG)  # fmt: skip
def divide(direction: Any, factor: float) -> tuple[Any, float]:
    """A vector divided by a number, and its length."""
    if factor == 0.0:
        raise Unfit("Division by zero")
    return _long(shapes.xyz(direction) / factor)


@native("2a5cfb31-028a-4b34-b4e1-9b20ae15312e", "Cross Product", "XProd", f"{_TWO}; {_UNIT}", _LONG)
def cross_product(a: Any, b: Any, unitize: bool) -> tuple[Any, float]:
    """The cross product of two vectors, with length 1 if Unitize is True, and its length."""
    return _scaled(np.cross(shapes.xyz(a), shapes.xyz(b)), unitize)


@native("43b9ea8f-f772-40f2-9880-011a9c3cbbb0", "Dot Product", "DProd", f"{_TWO}; {_UNIT}", "Dot product (D)")
def dot_product(a: Any, b: Any, unitize: bool) -> float:
    """The dot product of two vectors, of length 1 each if Unitize is True."""
    first, second = (shapes.unit(shapes.xyz(one)) if unitize else shapes.xyz(one) for one in (a, b))
    return float(first @ second)


@native("b464fccb-50e7-41bd-9789-8438db9bea9f", "Angle", "Angle",
        f"{_TWO}; Plane (P): plane optional", "Angle (A); Reflex (R)")  # fmt: skip
def angle(a: Any, b: Any, frame: Any) -> tuple[float, float]:
    """The angle between two vectors in radians and its rest to a full turn; with a plane, counter-clockwise in it."""
    first, second = shapes.xyz(a), shapes.xyz(b)
    if frame is None:
        found = math.atan2(float(np.linalg.norm(np.cross(first, second))), float(first @ second))
    else:
        _, x, y, _ = shapes.axes(frame)
        turns = [math.atan2(one @ y, one @ x) for one in (first, second)]
        found = (turns[1] - turns[0]) % (2.0 * math.pi)
    return found, 2.0 * math.pi - found


@native("b6d7ba20-cf74-4191-a756-2216a36e30a7", "Rotate", "VRot",
        "Vector (V): vector; Axis (X): vector; Angle (A): number", "Vector (V)")  # fmt: skip
def rotate(direction: Any, axis: Any, turn: float) -> Any:
    """A vector turned about an axis by an angle in radians."""
    change = rhino3dm.Transform.Rotation(turn, axis, rhino3dm.Point3d(0, 0, 0))
    return shapes.transformed(direction, change)


@native(
    "93b8e93d-f932-402c-b435-84be04d87666", "Distance", "Dist", "Point A (A): point; Point B (B): point", "Distance (D)"
)
def distance(a: Any, b: Any) -> float:
    """The distance between two points."""
    return float(np.linalg.norm(shapes.xyz(b) - shapes.xyz(a)))


def _world(guid: str, name: str, nickname: str, x: tuple[float, ...], y: tuple[float, ...]) -> None:
    def run(origin: Any) -> Any:
        return shapes.plane(shapes.xyz(origin), x, y)

    run.__doc__ = f"A plane parallel to the world's {nickname} plane."
    native(guid, name, nickname, "Origin (O): point", "Plane (P)")(run)


_world("17b7152b-d30d-4d50-b9ef-c9fe25576fc2", "XY Plane", "XY", (1, 0, 0), (0, 1, 0))
_world("8cc3a196-f6a0-49ea-9ed9-0cb343a3ae64", "XZ Plane", "XZ", (1, 0, 0), (0, 0, 1))
_world("fad344bc-09b1-4855-a2e6-437ef5715fe3", "YZ Plane", "YZ", (0, 1, 0), (0, 0, 1))


@native("bc3e379e-7206-4e7b-b63a-ff61f4b38a3e", "Construct Plane", "Pl",
        "Origin (O): point; X-Axis (X): vector; Y-Axis (Y): vector", "Plane (Pl)")  # fmt: skip
def construct_plane(origin: Any, x: Any, y: Any) -> Any:
    """A plane from its origin and axes; the y axis is made perpendicular to x."""
    if not np.cross(shapes.xyz(x), shapes.xyz(y)).any():
        raise Unfit("the axes are parallel")
    return shapes.plane(shapes.xyz(origin), shapes.xyz(x), shapes.xyz(y))


@native("cfb6b17f-ca82-4f5d-b604-d4f69f569de3", "Plane Normal", "Pl",
        "Origin (O): point; Z-Axis (Z): vector", "Plane (P)")  # fmt: skip
def plane_normal(origin: Any, normal: Any) -> Any:
    """A plane perpendicular to a vector."""
    return rhino3dm.Plane(origin, shapes.vector(_unit(normal)))


@native("c98a6015-7a2f-423c-bc66-bdc505249b45", "Plane 3Pt", "Pl 3Pt",
        "Point A (A): point; Point B (B): point; Point C (C): point", "Plane (Pl)")  # fmt: skip
def plane_of_points(a: Any, b: Any, c: Any) -> Any:
    """The plane through three points: origin A, x axis towards B, C on the side of the y axis."""
    o, x, y = (shapes.xyz(one) for one in (a, b, c))
    if not np.cross(x - o, y - o).any():
        raise Unfit("the points are on a line")
    return shapes.plane(o, x - o, y - o)


@native("3cd2949b-4ea8-4ffb-a70c-5c380f9f46ea", "Deconstruct Plane", "DePlane",
        "Plane (P): plane", "Origin (O); X-Axis (X); Y-Axis (Y); Z-Axis (Z)")  # fmt: skip
def deconstruct_plane(frame: Any) -> tuple[Any, ...]:
    """The origin and the axes of a plane."""
    return frame.Origin, frame.XAxis, frame.YAxis, frame.ZAxis


@native("75eec078-a905-47a1-b0d2-0934182b1e3d", "Plane Origin", "Pl Origin",
        "Base (B): plane; Origin (O): point", "Plane (Pl)")  # fmt: skip
def plane_origin(frame: Any, origin: Any) -> Any:
    """A plane with another origin."""
    _, x, y, _ = shapes.axes(frame)
    return shapes.plane(shapes.xyz(origin), x, y)


@native("3a0c7bda-3d22-4588-8bab-03f57a52a6ea", "Plane Offset", "Pl Offset",
        "Plane (P): plane; Offset (O): number = 1.0", "Plane (Pl)")  # fmt: skip
def plane_offset(frame: Any, offset: float) -> Any:
    """A plane moved along its z axis."""
    origin, x, y, z = shapes.axes(frame)
    return shapes.plane(origin + offset * z, x, y)


@native("f6f14b09-6497-4564-8403-09e4eb5a6b82", "Rotate Plane", "PRot",
        "Plane (P): plane; Angle (A): number", "Plane (P)")  # fmt: skip
def rotate_plane(frame: Any, turn: float) -> Any:
    """A plane turned about its z axis, counter-clockwise by radians."""
    origin, x, y, _ = shapes.axes(frame)
    c, s = math.cos(turn), math.sin(turn)
    return shapes.plane(origin, c * x + s * y, c * y - s * x)


@native(
    "33bfc73c-19b2-480b-81e6-f3523a012ea6", "Plane Fit", "PlFit", "Points (P): point list", "Plane (Pl); Deviation (dx)"
)
def plane_fit(places: list[Any]) -> tuple[Any, float]:
    """The plane with the least squared distances to points, and the largest distance."""
    found = shapes.rows(places)
    if len(found) < 3:
        raise Unfit("a plane needs three points")
    frame = shapes.fitted_plane(found)
    return frame, float(np.abs(shapes.coordinates(frame, found)[:, 2]).max())


@native("571ca323-6e55-425a-bf9e-ee103c7ba4b9", "Closest Point", "CP",
        "Point (P): point; Cloud (C): point list", "Closest Point (P); CP Index (i); Distance (D)")  # fmt: skip
def closest_point(place: Any, cloud: list[Any]) -> tuple[Any, int, float]:
    """The point of a cloud that is nearest to another, its index, and their distance."""
    if not cloud:
        raise Unfit("the cloud has no points")
    apart = np.linalg.norm(shapes.rows(cloud) - shapes.xyz(place), axis=1)
    nearest = int(apart.argmin())
    return cloud[nearest], nearest, float(apart[nearest])


@native("446014c4-c11c-45a7-8839-c45dc60950d6", "Closest Points", "CPs",
        "Point (P): point; Cloud (C): point list; Count (N): integer = 1",
        "Closest Point (P): list; CP Index (i): list; Distance (D): list")  # fmt: skip
def closest_points(place: Any, cloud: list[Any], count: int) -> tuple[list[Any], list[int], list[float]]:
    """The points of a cloud that are nearest to another, their indices and distances, the nearest first."""
    apart = np.linalg.norm(shapes.rows(cloud) - shapes.xyz(place), axis=1)
    order = np.argsort(apart, kind="stable")[: max(count, 0)].tolist()
    return [cloud[i] for i in order], order, [float(apart[i]) for i in order]


@native("6eaffbb2-3392-441a-8556-2dc126aa8910", "Cull Duplicates", "CullPt",
        "Points (P): point list; Tolerance (T): number = 0.01",
        "Points (P): list; Indices (I): list; Valence (V): list",
        remark="of points within the tolerance the first is kept, not their mean")  # fmt: skip
def cull_duplicates(places: list[Any], tolerance: float) -> tuple[list[Any], list[int], list[int]]:
    """The points with no earlier one within a tolerance; the place of each point among them; how many each is."""
    from scipy.spatial import cKDTree

    found = shapes.rows(places)
    near = cKDTree(found).query_ball_point(found, max(tolerance, 0.0)) if len(found) else []
    of = [-1] * len(found)
    kept: list[int] = []
    for i, group in enumerate(near):
        if of[i] < 0:
            for j in (i, *group):
                of[j] = len(kept) if of[j] < 0 else of[j]
            kept.append(i)
    return [places[i] for i in kept], of, [of.count(k) for k in range(len(kept))]


@native(
    "4e86ba36-05e2-4cc0-a0f5-3ad57c91f04e",
    "Sort Points",
    "Sort Pt",
    "Points (P): point list",
    "Points (P): list; Indices (I): list",
)
def sort_points(places: list[Any]) -> tuple[list[Any], list[int]]:
    """Points by their x, then y, then z coordinate, and their places in the list."""
    order = sorted(range(len(places)), key=lambda i: (places[i].X, places[i].Y, places[i].Z))
    return [places[i] for i in order], order


def _grid(frame: Any, size: tuple[float, float], count: tuple[int, int]) -> tuple[list[list[Any]], list[list[Any]]]:
    """Outlines and corner points of cells, a list for each column."""
    nx, ny = count
    if min(count) < 1:
        raise Unfit("a grid needs at least one cell each way")
    bounded(nx * ny)
    local = [[[i * size[0], j * size[1]] for j in range(ny + 1)] for i in range(nx + 1)]
    at = [shapes.in_plane(frame, column) for column in local]
    cells = [
        [shapes.polyline([at[i][j], at[i + 1][j], at[i + 1][j + 1], at[i][j + 1]], closed=True) for j in range(ny)]
        for i in range(nx)
    ]
    return cells, [shapes.points(column) for column in at]


_EXTENT = "Extent X (Ex): integer = 5; Extent Y (Ey): integer = 5"


@native("717a1e25-a075-4530-bc80-d43ecc2500d9", "Square", "SqGrid",
        f"Plane (P): plane; Size (S): number = 1.0; {_EXTENT}",
        "Cells (C): branches; Points (P): branches")  # fmt: skip
def square_grid(frame: Any, size: float, nx: int, ny: int) -> tuple[list[list[Any]], list[list[Any]]]:
    """A grid of square cells from the origin of a plane on: outlines and corners, a branch for each column."""
    return _grid(frame, (size, size), (nx, ny))


@native("1a25aae0-0b56-497a-85b2-cc5bf7e4b96b", "Rectangular", "RecGrid",
        f"Plane (P): plane; Size X (Sx): number = 1.0; Size Y (Sy): number = 1.0; {_EXTENT}",
        "Cells (C): branches; Points (P): branches")  # fmt: skip
def rectangular_grid(frame: Any, sx: float, sy: float, nx: int, ny: int) -> tuple[list[list[Any]], list[list[Any]]]:
    """A grid of rectangular cells from the origin of a plane on: outlines and corners, a branch for each column."""
    return _grid(frame, (sx, sy), (nx, ny))
