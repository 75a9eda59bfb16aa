"""Natives of the tab Transform beside the usual ones: mappings, shears, arrays, transformations, groups."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from hookean.discretize import curves as arc_lengths
from hookean_canvas.run.natives import shapes
from hookean_canvas.run.natives.curves import _at_length
from hookean_canvas.run.natives.curves_at import _across, _carried
from hookean_canvas.run.natives.declare import Unfit, bounded, native
from hookean_canvas.run.natives.measures import surface_mesh
from hookean_canvas.run.natives.places import _closest, _extremes
from hookean_canvas.run.natives.points_more import ray_hits
from hookean_canvas.run.rhino import rhino3dm

Array = shapes.Array
_OUT = "Geometry (G); Transform (X)"
_GEOMETRY = "Geometry (G): geometry"
_ARRAY = "Geometry (G): list; Transform (X): list"


def _of_matrix(rows: Array) -> Any:
    """The transformation of a matrix (4, 4), or of a linear part (3, 3) about the world's origin."""
    whole = np.eye(4)
    whole[: len(rows), : len(rows)] = rows
    found = rhino3dm.Transform(1.0)
    for i in range(4):
        for j in range(4):
            setattr(found, f"M{i}{j}", float(whole[i, j]))
    return found


def _frame(origin: Array, x: Array, y: Array, z: Array) -> Array:
    """The matrix from coordinates along three vectors from an origin to those of the world."""
    found = np.eye(4)
    found[:3] = np.column_stack([x, y, z, origin])
    return found


def _between(start: Array, end: Array) -> Any:
    """The transformation that takes one frame of three vectors to another."""
    if abs(np.linalg.det(start)) <= 1e-300:
        raise Unfit("what it is mapped from is flat")
    return _of_matrix(end @ np.linalg.inv(start))


def _changed(geometry: Any, change: Any) -> tuple[Any, Any]:
    if isinstance(geometry, rhino3dm.Curve) and not geometry.IsPolyline():
        geometry = geometry.ToNurbsCurve()  # an arc may become anything
    return shapes.transformed(geometry, change), change


@native("06d7bc4a-ba3e-4445-8ab5-079613b52f28", "Project Along", "ProjectA",
        f"{_GEOMETRY}; Plane (P): plane; Direction (D): vector", _OUT)  # fmt: skip
def project_along(geometry: Any, frame: Any, direction: Any) -> tuple[Any, Any]:
    """Geometry projected onto a plane along a direction."""
    origin, _, _, normal = shapes.axes(frame)
    way = shapes.xyz(direction)
    rise = float(way @ normal)
    if abs(rise) <= 1e-12 * np.linalg.norm(way):
        raise Unfit("the direction is parallel to the plane")
    matrix = np.eye(4)
    matrix[:3, :3] -= np.outer(way, normal) / rise
    matrix[:3, 3] = way * float(origin @ normal) / rise
    return _changed(geometry, _of_matrix(matrix))


@native("8465bcce-9e0a-4cf4-bbda-1a7ce5681e10", "Box Mapping", "BoxMap",
        f"{_GEOMETRY}; Source (S): box; Target (T): box", _OUT)  # fmt: skip
def box_mapping(geometry: Any, source: Any, target: Any) -> tuple[Any, Any]:
    """Geometry stretched as one box is to another."""
    frames = []
    for box in (source, target):
        low, high = shapes.xyz(box.Min), shapes.xyz(box.Max)
        frames.append(_frame(low, *np.diag(np.where(high > low, high - low, 1.0))))
    return _changed(geometry, _between(*frames))


@native("17d40004-489e-42d9-ad10-857f7b436801", "Rectangle Mapping", "RecMap",
        f"{_GEOMETRY}; Source (S): rectangle; Target (T): rectangle", _OUT)  # fmt: skip
def rectangle_mapping(geometry: Any, source: Any, target: Any) -> tuple[Any, Any]:
    """Geometry stretched as one rectangle is to another."""
    frames = []
    for frame, width, height in (source, target):
        origin, x, y, z = shapes.axes(frame)
        frames.append(_frame(origin, width * x, height * y, z))
    return _changed(geometry, _between(*frames))


@native("61d81100-c4d3-462d-8b51-d951c0ae32db", "Triangle Mapping", "TriMap",
        f"{_GEOMETRY}; Source (S): curve; Target (T): curve", _OUT)  # fmt: skip
def triangle_mapping(geometry: Any, source: Any, target: Any) -> tuple[Any, Any]:
    """Geometry stretched as one triangle is to another."""
    frames = []
    for outline in (source, target):
        rows = shapes.corners(outline)
        if rows is None or len(rows) != 4:
            raise Unfit("a curve is not a triangle")
        x, y = rows[1] - rows[0], rows[2] - rows[0]
        frames.append(_frame(rows[0], x, y, shapes.unit(np.cross(x, y))))
    return _changed(geometry, _between(*frames))


@native("407e35c6-7c40-4652-bd80-fde1eb7ec034", "Camera Obscura", "CO",
        f"{_GEOMETRY}; Point (P): point; Factor (F): number = 1.0", _OUT)  # fmt: skip
def camera_obscura(geometry: Any, place: Any, factor: float) -> tuple[Any, Any]:
    """Geometry mirrored in a point and scaled by a factor."""
    return _changed(geometry, rhino3dm.Transform.Scale(place, -factor))


@native("1602b2cc-007c-4b79-8926-0067c6184e44", "Orient Direction", "Orient",
        f"{_GEOMETRY}; Point A (pA): point; Direction A (dA): vector; Point B (pB): point; Direction B (dB): vector",
        _OUT)  # fmt: skip
def orient_direction(geometry: Any, start: Any, before: Any, end: Any, after: Any) -> tuple[Any, Any]:
    """Geometry moved from one point to another, turned and scaled from one direction to another."""
    a, b = shapes.xyz(before), shapes.xyz(after)
    if not (a.any() and b.any()):
        raise Unfit("a direction has no length")
    turn = rhino3dm.Transform.Rotation(before, after, rhino3dm.Point3d(0, 0, 0))
    linear = shapes._matrix(turn)[:3, :3] * float(np.linalg.norm(b) / np.linalg.norm(a))
    matrix = np.eye(4)
    matrix[:3, :3] = linear
    matrix[:3, 3] = shapes.xyz(end) - linear @ shapes.xyz(start)
    return _changed(geometry, _of_matrix(matrix))


@native("5a27203a-e05f-4eea-b80f-a5f29a00fdf2", "Shear", "Shear",
        f"{_GEOMETRY}; Base (P): plane; Grip (G): point; Target (T): point", _OUT)  # fmt: skip
def shear(geometry: Any, frame: Any, grip: Any, target: Any) -> tuple[Any, Any]:
    """Geometry sheared over a plane so that one point goes to another at its height."""
    origin, _, _, normal = shapes.axes(frame)
    height = float((shapes.xyz(grip) - origin) @ normal)
    if height == 0.0:
        raise Unfit("Grip is on the plane")
    moved = shapes.xyz(target) - shapes.xyz(grip)
    return _sheared(geometry, origin, normal, (moved - float(moved @ normal) * normal) / height)


def _sheared(geometry: Any, origin: Array, normal: Array, by: Array) -> tuple[Any, Any]:
    matrix = np.eye(4)
    matrix[:3, :3] += np.outer(by, normal)
    matrix[:3, 3] = -float(origin @ normal) * by
    return _changed(geometry, _of_matrix(matrix))


@native("f19ee36c-f21f-4e25-be4c-4ca4b30eda0d", "Shear Angle", "Shear",
        f"{_GEOMETRY}; Base (P): plane; Angle X (Ax): number; Angle Y (Ay): number", _OUT)  # fmt: skip
def shear_angle(geometry: Any, frame: Any, about_x: float, about_y: float) -> tuple[Any, Any]:
    """Geometry sheared over a plane by angles of its normal about both axes."""
    origin, x, y, normal = shapes.axes(frame)
    return _sheared(geometry, origin, normal, math.tan(about_y) * x - math.tan(about_x) * y)


@native("dd9f597a-4db0-42b1-9cb2-5607ec97db09", "Move Away From", "MoveAway",
        f"{_GEOMETRY}; Emitter (E): geometry; Distance (D): number = 1.0", _OUT,
        remark="from the point of the other shape that is nearest to the middle of the box")  # fmt: skip
def move_away(geometry: Any, emitter: Any, distance: float) -> tuple[Any, Any]:
    """Geometry moved away from another shape."""
    rows = _extremes(geometry)
    middle = 0.5 * (rows.min(axis=0) + rows.max(axis=0))
    way = shapes.unit(middle - shapes.xyz(_closest(shapes.point(middle), emitter)))
    if not way.any():
        raise Unfit("the shapes have one place in common")
    return _changed(geometry, rhino3dm.Transform.Translation(*(distance * way).tolist()))


@native("9f6f954c-ba7b-4428-bf1e-1768cdff666c", "Box Array", "ArrBox",
        f"{_GEOMETRY}; Cell (C): box; X Count (X): integer = 3; Y Count (Y): integer = 3; Z Count (Z): integer = 3",
        _ARRAY)  # fmt: skip
def box_array(geometry: Any, cell: Any, nx: int, ny: int, nz: int) -> tuple[list[Any], list[Any]]:
    """Copies of geometry at steps of the sides of a box, the first one in place; x runs first."""
    if min(nx, ny, nz) < 1:
        raise Unfit("the counts must be at least 1")
    bounded(nx * ny * nz)
    size = shapes.xyz(cell.Max) - shapes.xyz(cell.Min)
    steps = [(i * size[0], j * size[1], k * size[2]) for k in range(nz) for j in range(ny) for i in range(nx)]
    changes = [rhino3dm.Transform.Translation(*map(float, step)) for step in steps]
    return [_changed(geometry, change)[0] for change in changes], changes


@native("c6f23658-617f-4ac8-916d-d0d9e7241b25", "Curve Array", "ArrCurve",
        f"{_GEOMETRY}; Curve (C): curve; Count (N): integer = 10", _ARRAY,
        remark="copies turn as little as they can along the curve")  # fmt: skip
def curve_array(geometry: Any, curve: Any, count: int) -> tuple[list[Any], list[Any]]:
    """Copies of geometry at equal lengths along a curve, the first one in place."""
    if count < 1:
        raise Unfit("Count must be at least 1")
    bounded(count)
    pieces = count if curve.IsClosed else max(count - 1, 1)
    at = [_at_length(curve, i * arc_lengths.length(curve) / pieces) for i in range(count)]
    places, ways = shapes.rows(map(curve.PointAt, at)), shapes.rows(map(curve.TangentAt, at))
    x, frames = _across(ways[0]), []
    for i, (place, way) in enumerate(zip(places, ways, strict=True)):
        if i:
            x = _carried(x, places[i - 1], ways[i - 1], place, way)
        frames.append(shapes.plane(place, x, np.cross(way, x)))
    changes = [rhino3dm.Transform.PlaneToPlane(frames[0], frame) for frame in frames]
    return [_changed(geometry, change)[0] for change in changes], changes


@native("b90eaa92-6e38-4054-a915-afcf486224b3", "Kaleidoscope", "KScope",
        f"{_GEOMETRY}; Plane (P): plane; Segments (S): integer = 6", _ARRAY)  # fmt: skip
def kaleidoscope(geometry: Any, frame: Any, count: int) -> tuple[list[Any], list[Any]]:
    """Copies of geometry round the normal of a plane, every second one mirrored."""
    if count < 1:
        raise Unfit("Segments must be at least 1")
    bounded(2 * count)
    _, _, y, _ = shapes.axes(frame)
    mirror = shapes._matrix(rhino3dm.Transform.Mirror(frame.Origin, shapes.vector(y)))
    changes = []
    for i in range(count):
        turn = shapes._matrix(rhino3dm.Transform.Rotation(2.0 * math.pi * i / count, frame.ZAxis, frame.Origin))
        changes += [_of_matrix(turn), _of_matrix(turn @ mirror)]
    return [_changed(geometry, change)[0] for change in changes], changes


@native("ca80054a-cde0-4f69-a132-10502b24866d", "Compound", "Comp", "Transforms (T): transform list", "Compound (X)")
def compound(changes: list[Any]) -> Any:
    """Transformations as one, the first one first."""
    whole = np.eye(4)
    for change in changes:
        whole = shapes._matrix(change) @ whole
    return _of_matrix(whole)


@native("51f61166-7202-45aa-9126-3d83055b269e", "Inverse Transform", "Inverse", "Transform (T): transform",
        "Transform (T)")  # fmt: skip
def inverse_transform(change: Any) -> Any:
    """The transformation that undoes one."""
    rows = shapes._matrix(change)
    if abs(np.linalg.det(rows)) < 1e-300:
        raise Unfit("the transformation cannot be undone")
    return _of_matrix(np.asarray(np.linalg.inv(rows), dtype=np.float64))


@native("874eebe7-835b-4f4f-9811-97e031c41597", "Group", "Group", "Objects (O): any list", "Group (G)")
def group(members: list[Any]) -> shapes.Group:
    """Geometry as one."""
    return shapes.Group(tuple(one for one in members if one is not None))


@native("a45f59c8-11c1-4ea7-9e10-847061b80d75", "Ungroup", "Ungroup", "Group (G): any", "Objects (O): list")
def ungroup(held: Any) -> list[Any]:
    """The geometry in a group."""
    return list(held.members) if isinstance(held, shapes.Group) else [held]


@native("15204c6d-bba8-403d-9e8f-6660ab8e0df5", "Merge Group", "GMerge", "Group A (A): any; Group B (B): any",
        "Group (G)")  # fmt: skip
def merge_group(a: Any, b: Any) -> shapes.Group:
    """The geometry of two groups in one."""
    return shapes.Group((*ungroup(a), *ungroup(b)))


@native("fd03419e-e1cc-4603-8a57-6dfa56ed5dec", "Split Group", "GSplit",
        "Group (G): any; Indices (I): integer list; Wrap (W): boolean = True", "Group A (A); Group B (B)")  # fmt: skip
def split_group(held: Any, indices: list[int], wrap: bool) -> tuple[shapes.Group, shapes.Group]:
    """The geometry of a group with some numbers, and the rest."""
    members = ungroup(held)
    chosen = {i % len(members) if wrap and members else i for i in indices}
    parts = [tuple(one for i, one in enumerate(members) if (i in chosen) == inside) for inside in (True, False)]
    return shapes.Group(parts[0]), shapes.Group(parts[1])


@native("d7ee52ff-89b8-4d1a-8662-3e0dd391d0af", "Project", "Project",
        "Curve (C): curve; Brep (B): faces; Direction (D): vector", "Curve (C): list",
        remark="a curve becomes a polyline of at least 64 pieces; surfaces count as their meshes of 64 by 64 quads",
        )  # fmt: skip
def project_curve(curve: Any, target: Any, direction: Any) -> list[Any]:
    """A curve moved along a direction to the first place where each of its points meets faces; parts that miss are
    left out."""
    way = shapes.unit(shapes.xyz(direction))
    if not way.any():
        raise Unfit("the direction has no length")
    corners = surface_mesh(target)
    rows: list[list[Array]] = [[]]
    for start in arc_lengths.divide(curve, 64):
        hits = ray_hits(start, way, *corners)
        if len(hits):
            rows[-1].append(start + float(hits[np.argmin(np.abs(hits))]) * way)
        elif rows[-1]:
            rows.append([])
    return [shapes.polyline(np.array(part)) for part in rows if len(part) > 1]
