"""Stand-ins for Grasshopper's own components and parameters, so that definitions run without it.

Each is described as in Grasshopper's documentation: the component's description and those of its inputs, as
shown by its tooltip and by the component index (https://grasshopperdocs.com). Ids: `guids`, and public definitions.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any
from uuid import UUID

import rhino3dm

from hookean_canvas.archive import guids
from hookean_canvas.run.trees import LIST


class Unfit(ValueError):
    """A value that an input cannot take; the message is the component's."""


@dataclass(frozen=True)
class Input:
    """An input of a native component: what it takes, and its default where a person connects nothing."""

    name: str
    nickname: str
    kind: str
    access: int = 0
    default: tuple[Any, ...] = ()


@dataclass(frozen=True)
class Output:
    """An output of a native component."""

    name: str
    nickname: str
    access: int = 0


@dataclass(frozen=True)
class Native:
    """A native component: `run` takes a value for each input, gives one for each output; `does` is what it copies."""

    guid: UUID
    name: str
    nickname: str
    inputs: tuple[Input, ...]
    outputs: tuple[Output, ...]
    run: Callable[..., tuple[Any, ...]]
    does: str


def point(x: float, y: float, z: float) -> tuple[Any, ...]:
    return (rhino3dm.Point3d(x, y, z),)


def line(start: rhino3dm.Point3d, end: rhino3dm.Point3d) -> tuple[Any, ...]:
    return (rhino3dm.Line(start, end),)


def vector(x: float, y: float, z: float) -> tuple[Any, ...]:
    return rhino3dm.Vector3d(x, y, z), math.sqrt(x * x + y * y + z * z)


def along(axis: int) -> Callable[[float], tuple[Any, ...]]:
    """Unit X, Y or Z: the unit vector times a factor."""

    def run(factor: float) -> tuple[Any, ...]:
        return (rhino3dm.Vector3d(*(factor if i == axis else 0.0 for i in range(3))),)

    return run


def ends(curve: Any) -> tuple[Any, ...]:
    return curve.PointAtStart, curve.PointAtEnd


def series(start: float, step: float, count: int) -> tuple[Any, ...]:
    if count < 0:
        raise Unfit("Count must not be negative")
    return ([start + step * i for i in range(count)],)


def list_length(values: list[Any]) -> tuple[Any, ...]:
    return (len(values),)


def move(geometry: Any, motion: rhino3dm.Vector3d) -> tuple[Any, ...]:
    """Points and lines by their coordinates, other geometry by a copy of it."""
    change = rhino3dm.Transform.Translation(motion.X, motion.Y, motion.Z)
    if isinstance(geometry, (rhino3dm.Point3d, rhino3dm.Point)):
        p = as_kind("point", geometry)
        return rhino3dm.Point3d(p.X + motion.X, p.Y + motion.Y, p.Z + motion.Z), change
    if isinstance(geometry, rhino3dm.Line):
        return rhino3dm.Line(move(geometry.From, motion)[0], move(geometry.To, motion)[0]), change
    copy = geometry.Duplicate()
    copy.Transform(change)
    return copy, change


def _native(
    guid: str, name: str, nickname: str, inputs: Sequence[Input], outputs: Sequence[Output],
    run: Callable[..., tuple[Any, ...]], does: str,
) -> Native:  # fmt: skip
    return Native(UUID(guid), name, nickname, tuple(inputs), tuple(outputs), run, does)


_XYZ = ("X", "Y", "Z")
_AXES = (
    ("79f9fbb3-8f1d-4d9a-88a9-f7961b1012cd", "Unit X"),
    ("d3d195ea-2d59-4ffa-90b1-8b7ff3369f69", "Unit Y"),
    ("9103c240-a6a9-4223-9b42-dbd19bf38e2b", "Unit Z"),
)
_ALL = (
    _native(
        "3581f42a-9592-4549-bd6b-1c0fc39d067b", "Construct Point", "Pt",
        [Input(f"{axis} coordinate", axis, "number", default=(0.0,)) for axis in _XYZ], [Output("Point", "Pt")],
        point, "A point from its {xyz} coordinates; a coordinate without data is 0.",
    ),
    _native(
        "4c4e56eb-2f04-43f9-95a3-cc46a14f495a", "Line", "Ln",
        [Input("Start Point", "A", "point"), Input("End Point", "B", "point")], [Output("Line", "L")],
        line, "A line between two points.",
    ),
    _native(
        "56b92eab-d121-43f7-94d3-6cd8f0ddead8", "Vector XYZ", "Vec",
        [Input(f"{axis} component", axis, "number", default=(0.0,)) for axis in _XYZ],
        [Output("Vector", "V"), Output("Length", "L")],
        vector, "A vector from its {xyz} components, and its length.",
    ),
    *(
        _native(
            guid, name, _XYZ[i], [Input("Factor", "F", "number", default=(1.0,))], [Output("Unit vector", "V")],
            along(i), f"A vector parallel to the world's {_XYZ[i].lower()} axis, the unit times the factor.",
        )
        for i, (guid, name) in enumerate(_AXES)
    ),
    _native(
        "11bbd48b-bb0a-4f1b-8167-fa297590390d", "End Points", "End",
        [Input("Curve", "C", "curve")], [Output("Start", "S"), Output("End", "E")],
        ends, "The start and the end point of a curve.",
    ),
    _native(
        "e64c5fb1-845c-4ab1-8911-5f338516ba67", "Series", "Series",
        [Input("Start", "S", "number", default=(0.0,)), Input("Step", "N", "number", default=(1.0,)),
         Input("Count", "C", "integer", default=(10,))],
        [Output("Series", "S", LIST)],
        series, "Count numbers, the first is Start, each next one larger by Step; a list for each run.",
    ),
    _native(
        "1817fd29-20ae-4503-b542-f0fb651e67d7", "List Length", "Lng",
        [Input("List", "L", "any", LIST)], [Output("Length", "L")],
        list_length, "How many items a list has.",
    ),
    _native(
        "e9eb1dcf-92f6-4d4d-84ae-96222d60f56b", "Move", "Move",
        [Input("Geometry", "G", "geometry"), Input("Motion", "T", "vector", default=((0.0, 0.0, 10.0),))],
        [Output("Geometry", "G"), Output("Transform", "X")],
        move, "Geometry moved along a vector.",
    ),
)  # fmt: skip

NATIVES: dict[UUID, Native] = {native.guid: native for native in _ALL}
"""Every native component that can be run, by its id."""

BY_NAME: dict[str, Native] = {native.name: native for native in _ALL}

_KINDS = {
    "Number": "number", "Integer": "integer", "Boolean": "boolean", "Text": "text", "Point": "point",
    "Vector": "vector", "Line": "line", "Curve": "curve", "Mesh": "mesh", "Data": "any",
}  # fmt: skip
PARAMETERS: dict[UUID, tuple[str, str]] = {guids.PARAMETERS[name]: (name, kind) for name, kind in _KINDS.items()}
"""Floating parameters: their names and the kind of values they hold."""


_NUMBERS = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")


def as_kind(kind: str, value: Any) -> Any:
    """A value as an input of this kind takes it, by Grasshopper's conversions; Unfit where there is none.

    Kinds: any, geometry, number, integer, boolean, text, point, vector, line, curve, mesh.
    """
    if kind == "any" or value is None:
        return value
    found = _CASTS[kind](value)
    if found is None:
        raise Unfit(f"Data conversion failed from {_described(value)} to {kind.capitalize()}")
    return found


def _described(value: Any) -> str:
    if isinstance(value, str):
        return "Text"
    return {bool: "Boolean", int: "Integer", float: "Number"}.get(type(value), type(value).__name__)


def _number(value: Any) -> float | None:
    if isinstance(value, str):
        try:
            return float(value)
        except ValueError:
            return None
    return float(value) if isinstance(value, (bool, int, float)) else None


def _integer(value: Any) -> int | None:
    found = _number(value)
    return None if found is None or not math.isfinite(found) else math.floor(found + 0.5)


def _boolean(value: Any) -> bool | None:
    if isinstance(value, str):
        return {"true": True, "false": False}.get(value.strip().lower())
    return bool(value) if isinstance(value, (bool, int, float)) else None


def _text(value: Any) -> str | None:
    return value if isinstance(value, str) else str(value) if isinstance(value, (bool, int, float)) else None


def _triple(value: Any) -> tuple[float, float, float] | None:
    """Coordinates of a point, of a vector, or of a text such as {1, 2, 3}."""
    if isinstance(value, rhino3dm.Point):
        value = value.Location
    if isinstance(value, str):
        found = [float(number) for number in _NUMBERS.findall(value)]
    elif isinstance(value, (tuple, list)):
        found = [float(number) for number in value]
    elif hasattr(value, "Z"):
        found = [value.X, value.Y, value.Z]
    else:
        return None
    return (found[0], found[1], found[2]) if len(found) == 3 else None


def _point(value: Any) -> Any:
    found = _triple(value)
    return rhino3dm.Point3d(*found) if found is not None else None


def _vector(value: Any) -> Any:
    if isinstance(value, rhino3dm.Line):
        return rhino3dm.Vector3d(*(b - a for a, b in zip(_triple(value.From), _triple(value.To), strict=True)))  # type: ignore[arg-type]
    found = _triple(value)
    return rhino3dm.Vector3d(*found) if found is not None else None


def _line(value: Any) -> Any:
    if isinstance(value, rhino3dm.Line):
        return value
    if isinstance(value, rhino3dm.Curve) and value.IsLinear():
        return rhino3dm.Line(value.PointAtStart, value.PointAtEnd)
    return None


def _curve(value: Any) -> Any:
    if isinstance(value, rhino3dm.Line):
        return rhino3dm.LineCurve(value.From, value.To)
    if isinstance(value, rhino3dm.Polyline):
        return value.ToPolylineCurve()
    return value if isinstance(value, rhino3dm.Curve) else None


def _mesh(value: Any) -> Any:
    return value if isinstance(value, rhino3dm.Mesh) else None


def _geometry(value: Any) -> Any:
    return value if type(value).__module__.startswith("rhino3dm") else None


_CASTS: dict[str, Callable[[Any], Any]] = {
    "number": _number,
    "integer": _integer,
    "boolean": _boolean,
    "text": _text,
    "point": _point,
    "vector": _vector,
    "line": _line,
    "curve": _curve,
    "mesh": _mesh,
    "geometry": _geometry,
}
