"""Natives of the tab Transform."""

from __future__ import annotations

import math
from typing import Any

from hookean_canvas.run.natives import shapes
from hookean_canvas.run.natives.declare import Unfit, bounded, native
from hookean_canvas.run.rhino import rhino3dm

_OUT = "Geometry (G); Transform (X)"
_GEOMETRY = "Geometry (G): geometry"


def _changed(geometry: Any, change: Any) -> tuple[Any, Any]:
    return shapes.transformed(geometry, change), change


@native("e9eb1dcf-92f6-4d4d-84ae-96222d60f56b", "Move", "Move",
        f"{_GEOMETRY}; Motion (T): vector = (0.0, 0.0, 10.0)", _OUT)  # fmt: skip
def move(geometry: Any, motion: Any) -> tuple[Any, Any]:
    """Geometry moved along a vector."""
    return _changed(geometry, rhino3dm.Transform.Translation(motion.X, motion.Y, motion.Z))


@native("b7798b74-037e-4f0c-8ac7-dc1043d093e0", "Rotate", "Rotate",
        f"{_GEOMETRY}; Angle (A): number; Plane (P): plane", _OUT)  # fmt: skip
def rotate(geometry: Any, angle: float, frame: Any) -> tuple[Any, Any]:
    """Geometry turned about the z axis of a plane, counter-clockwise by radians."""
    return _changed(geometry, rhino3dm.Transform.Rotation(angle, frame.ZAxis, frame.Origin))


@native("3ac8e589-37f5-477d-aa61-6699702c5728", "Rotate Axis", "RotAx",
        f"{_GEOMETRY}; Angle (A): number; Axis (X): line", _OUT)  # fmt: skip
def rotate_axis(geometry: Any, angle: float, axis: Any) -> tuple[Any, Any]:
    """Geometry turned about a line by radians."""
    return _changed(geometry, rhino3dm.Transform.Rotation(angle, _direction(axis), axis.From))


@native("3dfb9a77-6e05-4016-9f20-94f78607d672", "Rotate 3D", "Rot3D",
        f"{_GEOMETRY}; Angle (A): number; Center (C): point; Axis (X): vector", _OUT)  # fmt: skip
def rotate_about(geometry: Any, angle: float, centre: Any, axis: Any) -> tuple[Any, Any]:
    """Geometry turned about an axis through a point by radians."""
    return _changed(geometry, rhino3dm.Transform.Rotation(angle, axis, centre))


def _direction(line: Any) -> Any:
    return shapes.vector(shapes.xyz(line.To) - shapes.xyz(line.From))


@native("4d2a06bd-4b0f-4c65-9ee0-4220e4c01703", "Scale", "Scale",
        f"{_GEOMETRY}; Center (C): point; Factor (F): number = 0.5", _OUT)  # fmt: skip
def scale(geometry: Any, centre: Any, factor: float) -> tuple[Any, Any]:
    """Geometry scaled by a factor from a point."""
    return _changed(geometry, rhino3dm.Transform.Scale(centre, factor))


@native("290f418a-65ee-406a-a9d0-35699815b512", "Scale NU", "Scale NU",
        f"{_GEOMETRY}; Plane (P): plane; Scale X (X): number = 1.0; Scale Y (Y): number = 1.0; "
        "Scale Z (Z): number = 1.0", _OUT)  # fmt: skip
def scale_axes(geometry: Any, frame: Any, x: float, y: float, z: float) -> tuple[Any, Any]:
    """Geometry scaled by factors along the axes of a plane."""
    if isinstance(geometry, rhino3dm.Curve) and not geometry.IsPolyline():
        geometry = geometry.ToNurbsCurve()
    return _changed(geometry, rhino3dm.Transform.Scale(frame, x, y, z))


@native("f12daa2f-4fd5-48c1-8ac3-5dea476912ca", "Mirror", "Mirror", f"{_GEOMETRY}; Plane (P): plane", _OUT)
def mirror(geometry: Any, frame: Any) -> tuple[Any, Any]:
    """Geometry mirrored in a plane."""
    return _changed(geometry, rhino3dm.Transform.Mirror(frame.Origin, frame.ZAxis))


@native("378d0690-9da0-4dd1-ab16-1d15246e7c22", "Orient", "Orient",
        f"{_GEOMETRY}; Source (A): plane; Target (B): plane", _OUT)  # fmt: skip
def orient(geometry: Any, source: Any, target: Any) -> tuple[Any, Any]:
    """Geometry moved and turned so that one plane comes to another."""
    return _changed(geometry, rhino3dm.Transform.PlaneToPlane(source, target))


@native("610e689b-5adc-47b3-af8f-e3a32b7ea341", "Transform", "Transform",
        f"{_GEOMETRY}; Transform (T): transform", "Geometry (G)")  # fmt: skip
def transform(geometry: Any, change: Any) -> Any:
    """Geometry after a transformation."""
    return shapes.transformed(geometry, change)


@native("e87db220-a0a0-4d67-a405-f97fd14b2d7a", "Linear Array", "ArrLinear",
        f"{_GEOMETRY}; Direction (D): vector; Count (N): integer = 10",
        "Geometry (G): list; Transform (X): list")  # fmt: skip
def linear_array(geometry: Any, step: Any, count: int) -> tuple[list[Any], list[Any]]:
    """Copies of geometry at equal steps along a vector, the first one in place."""
    if count < 1:
        raise Unfit("Count must be at least 1")
    bounded(count)
    changes = [rhino3dm.Transform.Translation(i * step.X, i * step.Y, i * step.Z) for i in range(count)]
    return [shapes.transformed(geometry, change) for change in changes], changes


@native("fca5ad7e-ecac-401d-a357-edda0a251cbc", "Polar Array", "ArrPolar",
        f"{_GEOMETRY}; Plane (P): plane; Count (N): integer = 10; Angle (A): number = 6.283185307179586",
        "Geometry (G): list; Transform (X): list")  # fmt: skip
def polar_array(geometry: Any, frame: Any, count: int, angle: float) -> tuple[list[Any], list[Any]]:
    """Copies of geometry at equal turns about the z axis of a plane; those of a full turn do not meet."""
    if count < 1:
        raise Unfit("Count must be at least 1")
    bounded(count)
    full = abs(abs(angle) - 2.0 * math.pi) < 1e-9
    step = angle / count if full else angle / max(count - 1, 1)
    changes = [rhino3dm.Transform.Rotation(i * step, frame.ZAxis, frame.Origin) for i in range(count)]
    return [shapes.transformed(geometry, change) for change in changes], changes


@native("23285717-156c-468f-a691-b242488c06a6", "Project", "Project", f"{_GEOMETRY}; Plane (P): plane", _OUT)
def project(geometry: Any, frame: Any) -> tuple[Any, Any]:
    """Geometry projected onto a plane, along its normal."""
    return _changed(geometry, rhino3dm.Transform.Scale(frame, 1.0, 1.0, 0.0))
