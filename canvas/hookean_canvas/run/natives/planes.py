"""Natives of the tab Vector that turn and make planes, and measure points in them."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from hookean_canvas.run.natives import shapes
from hookean_canvas.run.natives.declare import Unfit, native
from hookean_canvas.run.rhino import rhino3dm

Array = shapes.Array


@native("9ce34996-d8c6-40d3-b442-1a7c8c093614", "Adjust Plane", "PAdjust",
        "Plane (P): plane; Normal (N): vector", "Plane (P)")  # fmt: skip
def adjust_plane(frame: Any, normal: Any) -> Any:
    """A plane turned on the shortest way so that its normal has a direction."""
    if not shapes.xyz(normal).any():
        raise Unfit("the normal has no length")
    return shapes.transformed(frame, rhino3dm.Transform.Rotation(frame.ZAxis, normal, frame.Origin))


@native("e76040ec-3b91-41e1-8e00-c74c23b89391", "Align Plane", "Align",
        "Plane (P): plane; Direction (D): vector", "Plane (P); Angle (A)")  # fmt: skip
def align_plane(frame: Any, direction: Any) -> tuple[Any, float]:
    """A plane turned about its normal so that its x axis comes nearest to a direction, and the angle."""
    turn = _turn(frame, shapes.xyz(direction))
    return shapes.transformed(frame, rhino3dm.Transform.Rotation(turn, frame.ZAxis, frame.Origin)), turn


def _turn(frame: Any, direction: Array) -> float:
    """The angle about the normal from the x axis to a direction; 0 where that is the normal."""
    _, x, y, _ = shapes.axes(frame)
    along, across = float(direction @ x), float(direction @ y)
    return math.atan2(across, along) if math.hypot(along, across) > 1e-12 * np.linalg.norm(direction) else 0.0


@native("2318aee8-01fe-4ea8-9524-6966023fc622", "Align Planes", "Align",
        "Planes (P): plane list; Master (M): plane optional", "Planes (P): list")  # fmt: skip
def align_planes(frames: list[Any], master: Any) -> list[Any]:
    """Planes turned about their normals, each so that its x axis comes nearest to that of the one before."""
    found: list[Any] = []
    before = master
    for frame in frames:
        if before is not None:
            frame = align_plane(frame, before.XAxis)[0]
        found.append(frame)
        before = frame
    return found


@native("c73e1ed0-82a2-40b0-b4df-8f10e445d60b", "Flip Plane", "PFlip",
        "Plane (P): plane; Reverse X (X): boolean = False; Reverse Y (Y): boolean = False; "
        "Swap axes (S): boolean = False", "Plane (P)")  # fmt: skip
def flip_plane(frame: Any, x: bool, y: bool, swap: bool) -> Any:
    """A plane with its axes reversed or exchanged."""
    origin, first, second, _ = shapes.axes(frame)
    first, second = (-first if x else first), (-second if y else second)
    return shapes.plane(origin, second, first) if swap else shapes.plane(origin, first, second)


@native("d788ad7f-6d68-4106-8b2f-9e55e6e107c0", "Line + Line", "LnLn", "Line A (A): line; Line B (B): line",
        "Plane (Pl)")  # fmt: skip
def line_line(a: Any, b: Any) -> Any:
    """The plane at the start of a line with it as x axis, parallel to another line."""
    start, x = shapes.xyz(a.From), shapes.xyz(a.To) - shapes.xyz(a.From)
    return _through(start, x, shapes.xyz(b.To) - shapes.xyz(b.From))


@native("ccc3f2ff-c9f6-45f8-aa30-8a924a9bda36", "Line + Pt", "LnPt", "Line (L): line; Point (P): point",
        "Plane (Pl)")  # fmt: skip
def line_point(line: Any, place: Any) -> Any:
    """The plane at the start of a line with it as x axis, through a point."""
    start = shapes.xyz(line.From)
    return _through(start, shapes.xyz(line.To) - start, shapes.xyz(place) - start)


def _through(start: Array, x: Array, y: Array) -> Any:
    if np.linalg.norm(np.cross(x, y)) <= 1e-12 * np.linalg.norm(x) * np.linalg.norm(y):
        raise Unfit("both are on a line")
    return shapes.plane(start, x, y)


@native("b075c065-efda-4c9f-9cc9-288362b1b4b9", "Plane Closest Point", "CP", "Point (S): point; Plane (P): plane",
        "Point (P); UV Point (uv); Distance (D)")  # fmt: skip
def plane_closest_point(place: Any, frame: Any) -> tuple[Any, Any, float]:
    """The foot of a point on a plane, its coordinates there, and its height over it."""
    x, y, z = shapes.coordinates(frame, [shapes.xyz(place)])[0].tolist()
    return shapes.point(shapes.in_plane(frame, [(x, y)])[0]), rhino3dm.Point3d(x, y, 0.0), z


@native("5f127fa4-ca61-418e-bb2d-e3739d900f1f", "Plane Coordinates", "PlCoord",
        "Point (P): point; System (S): plane", "X coordinate (X); Y coordinate (Y); Z coordinate (Z)")  # fmt: skip
def plane_coordinates(place: Any, frame: Any) -> tuple[float, float, float]:
    """The coordinates of a point in a plane."""
    x, y, z = shapes.coordinates(frame, [shapes.xyz(place)])[0].tolist()
    return x, y, z
