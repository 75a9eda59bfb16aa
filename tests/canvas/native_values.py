"""Plain values of a table as those of rhino3dm that natives take, and what natives give as plain values."""

from __future__ import annotations

from typing import Any

import pytest

from hookean_canvas.run.natives import BY_NAME, PLUGINS, as_kind, shapes
from hookean_canvas.run.rhino import rhino3dm
from hookean_canvas.run.trees import Tree


def made(value: Any) -> Any:
    """A value of a table as a native takes it."""
    if isinstance(value, list):
        if value and isinstance(value[0], tuple) and not isinstance(value[0][0], str):
            return shapes.polyline(value)
        return [made(one) for one in value]
    if not isinstance(value, tuple) or not value or not isinstance(value[0], str):
        return value
    kind, *parts = value
    if kind == "plane":
        return shapes.plane(*parts)
    if kind == "mesh":
        return shapes.mesh(*parts)
    if kind == "line":
        return rhino3dm.Line(*map(shapes.point, parts))
    of = {"point": rhino3dm.Point3d, "vector": rhino3dm.Vector3d, "domain": rhino3dm.Interval}[kind]
    return of(*map(float, parts))


def plain(value: Any) -> Any:
    """What a native gave, as a value of a table."""
    if isinstance(value, Tree):
        return {path: plain(branch) for path, branch in value.branches()}
    if isinstance(value, list):
        return [plain(one) for one in value]
    if isinstance(value, rhino3dm.Mesh):
        vertices, faces = shapes.mesh_parts(value)
        return vertices.tolist(), faces
    if isinstance(value, rhino3dm.Plane):
        return tuple(tuple(row.tolist()) for row in shapes.axes(value)[:3])
    if isinstance(value, rhino3dm.Interval):
        return value.T0, value.T1
    if isinstance(value, rhino3dm.BoundingBox):
        return plain(value.Min), plain(value.Max)
    if isinstance(value, (rhino3dm.Curve, rhino3dm.Line)):
        corners = shapes.corners(value)
        return "a curve" if corners is None else [tuple(row) for row in corners.tolist()]
    return (value.X, value.Y, value.Z) if hasattr(value, "Z") else value


def called(name: str, *given: Any, **named: Any) -> list[Any]:
    """What a native gives for values of a table, taken as its inputs take them, as plain values."""
    native = BY_NAME.get(name) or PLUGINS[name]
    kinds = [of.kind for of in native.inputs] + [native.inputs[-1].kind] * len(given)
    values = [_taken(kind, made(value)) for kind, value in zip(kinds, given, strict=False)]
    return [plain(one) for one in native.run(*values, **named)]


def _taken(kind: str, value: Any) -> Any:
    if isinstance(value, Tree):
        return value
    if isinstance(value, list):
        return [_taken(kind, one) for one in value]
    return value if kind == "rectangle" and isinstance(value, tuple) else as_kind(kind, value)


def near(found: Any, expected: Any) -> bool:
    """Whether values agree, numbers to rounding: 1e-9 of values of the order of 1 to 1000."""
    if isinstance(expected, (list, tuple)) and isinstance(found, (list, tuple)):
        return len(found) == len(expected) and all(map(near, found, expected))
    if isinstance(expected, dict):
        return list(found) == list(expected) and all(near(found[key], expected[key]) for key in expected)
    if isinstance(expected, (bool, str, type(None))) or isinstance(found, str):
        return bool(found == expected) and type(found) is type(expected)
    return bool(found == pytest.approx(expected, rel=1e-9, abs=1e-9))
