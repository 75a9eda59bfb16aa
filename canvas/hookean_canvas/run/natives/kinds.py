"""Values as inputs of natives take them, by Grasshopper's conversions, and the floating parameters that hold them."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from typing import Any
from uuid import UUID

from hookean_canvas.archive import guids
from hookean_canvas.run import stand_in as untyped
from hookean_canvas.run.natives import shapes
from hookean_canvas.run.natives.declare import Unfit
from hookean_canvas.run.rhino import rhino3dm
from hookean_canvas.run.trees import path_of

stand_in: Any = untyped

_KINDS = {
    "Number": "number", "Integer": "integer", "Boolean": "boolean", "Text": "text", "Point": "point",
    "Vector": "vector", "Line": "line", "Curve": "curve", "Mesh": "mesh", "Data": "any", "Plane": "plane",
    "Domain": "domain", "Colour": "colour", "Circle": "curve", "Circular Arc": "curve", "Rectangle": "curve",
    "Geometry": "geometry", "Brep": "brep", "Surface": "surface", "Box": "anybox", "Transform": "transform",
    "Mesh Face": "face", "Data Path": "path", "Shader": "any", "Domain²": "any", "File Path": "any", "Guid": "any",
    "Time": "any", "Complex": "any", "Matrix": "any", "Twisted Box": "any", "Mesher Settings": "any", "Group": "any",
    "Mesh Point": "any", "Culture": "any", "Field": "any", "Location": "any",
}  # fmt: skip
PARAMETERS: dict[UUID, tuple[str, str]] = {guids.PARAMETERS[name]: (name, kind) for name, kind in _KINDS.items()}
"""Floating parameters: their names and the kind of values they hold."""
PARAMETERS[UUID("a484c1c6-bb88-4507-b650-58aadebda4c1")] = ("PlanktonMesh", "halfedge")  # github.com/meshmash/Plankton


def kind_of(guid: UUID, name: str) -> str | None:
    """The kind of values of a floating parameter, by its id, or by its name where it is an older version of one."""
    return PARAMETERS[guid][1] if guid in PARAMETERS else _KINDS.get(name)


_NUMBERS = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
_DOMAIN = re.compile(rf"\s*({_NUMBERS.pattern})\s+[tT][oO]\s+({_NUMBERS.pattern})\s*")


def as_kind(kind: str, value: Any) -> Any:
    """A value as an input of this kind takes it, by Grasshopper's conversions; Unfit where there is none."""
    if kind == "any" or value is None:
        return value
    found = _CASTS[kind](value)
    if found is None:
        raise Unfit(f"Data conversion failed from {_described(value)} to {kind.capitalize()}")
    return found


def radians(angle: Any) -> Any:
    """An angle in degrees as radians; anything but a number stays."""
    number = _number(angle) if isinstance(angle, (str, int, float)) else None
    return angle if number is None else math.radians(number)


def over_unit_domain(value: Any) -> Any:
    """A curve or surface with parameters from 0 to 1, as a parameter that is reparameterized gives it."""
    one = rhino3dm.Interval(0.0, 1.0)
    if isinstance(value, rhino3dm.Line):
        value = _curve(value)
    if isinstance(value, rhino3dm.Curve):
        value = value.Duplicate()
        value.Domain = one
    elif isinstance(value, rhino3dm.Brep) and len(value.Faces) == 1 and value.IsSurface:
        value = value.Faces[0].UnderlyingSurface()
    if isinstance(value, rhino3dm.Surface) and hasattr(value, "SetDomain"):
        value = value.ToNurbsSurface() if isinstance(value, rhino3dm.BrepFace) else value.Duplicate()
        for axis in (0, 1):
            value.SetDomain(axis, one)
    return value


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
    if isinstance(value, rhino3dm.Curve | rhino3dm.Line):
        from hookean.discretize.curves import length

        return length(value)
    return float(value) if isinstance(value, (bool, int, float)) else None


def _integer(value: Any) -> int | None:
    found = _number(value)
    return None if found is None or not math.isfinite(found) else math.floor(found + 0.5)


def _boolean(value: Any) -> bool | None:
    if isinstance(value, str):
        return {"true": True, "false": False, "1": True, "0": False}.get(value.strip().lower())
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
    found = _triple(value.Origin if isinstance(value, rhino3dm.Plane) else value)
    return rhino3dm.Point3d(*found) if found is not None else None


def _vector(value: Any) -> Any:
    if isinstance(value, rhino3dm.Line):
        return shapes.vector(shapes.xyz(value.To) - shapes.xyz(value.From))
    if isinstance(value, rhino3dm.Plane):
        return value.ZAxis
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
    if isinstance(value, rhino3dm.Circle):
        return rhino3dm.ArcCurve.CreateFromCircle(value)
    if isinstance(value, rhino3dm.Arc):
        return rhino3dm.ArcCurve.CreateFromArc(value)
    return value if isinstance(value, rhino3dm.Curve) else None


def _plane(value: Any) -> Any:
    if isinstance(value, rhino3dm.Plane):
        return value
    origin = _point(value)
    return rhino3dm.Plane(origin, rhino3dm.Vector3d(0, 0, 1)) if origin is not None else None


def _domain(value: Any) -> Any:
    """A domain; a number is the domain from 0 to it, a text is `0 to 10`."""
    if isinstance(value, rhino3dm.Interval):
        return value
    if isinstance(value, tuple) and len(value) == 2:
        return rhino3dm.Interval(*map(float, value))
    if isinstance(value, str) and (found := _DOMAIN.fullmatch(value)):
        return rhino3dm.Interval(float(found[1]), float(found[2]))
    number = _number(value) if not isinstance(value, rhino3dm.Curve) else None
    return rhino3dm.Interval(0.0, number) if number is not None else None


def _mesh(value: Any) -> Any:
    """A mesh, or that of the faces of a Brep or surface, of as few as a solid needs, or of a closed polyline."""
    if isinstance(value, rhino3dm.Mesh):
        return value
    if isinstance(value, rhino3dm.Curve):
        corners = shapes.corners(value)
        if corners is None or not value.IsClosed:
            return None
        if len(corners) in (4, 5):  # a triangle or a quad
            return shapes.mesh(corners[:-1], [tuple(range(len(corners) - 1))])
    faces = _brep(value)
    if faces is None:
        return None
    from hookean_canvas.run.natives.meshes_made import QUADS, meshed

    return meshed(faces, 1 if getattr(faces, "IsSolid", False) else QUADS)


def _halfedge(value: Any) -> Any:
    """A mesh as those of Plankton are."""
    from hookean_canvas.run.natives.plankton import welded

    mesh = _mesh(value)
    return None if mesh is None else welded(mesh)


def _brep(value: Any) -> Any:
    """What has faces for the natives that take Breps: a Brep, an extrusion, a surface, a box, a closed flat curve."""
    if isinstance(value, (rhino3dm.BoundingBox, shapes.TiltedBox)):
        return value.ToBrep()
    if isinstance(value, rhino3dm.Curve) and value.IsClosed and value.IsPlanar():
        from hookean_canvas.run.natives.surfaces import boundary_surfaces

        return boundary_surfaces([value])[0]
    return value if isinstance(value, (rhino3dm.Brep, rhino3dm.Surface)) else None


def _surface(value: Any) -> Any:
    if isinstance(value, rhino3dm.Curve):
        value = _brep(value)
    if isinstance(value, rhino3dm.Brep):
        return value.Faces[0] if len(value.Faces) == 1 else None
    return value if isinstance(value, rhino3dm.Surface) else None


def _box(value: Any) -> Any:
    if isinstance(value, rhino3dm.BoundingBox):
        return value
    return value.GetBoundingBox() if isinstance(value, rhino3dm.GeometryBase) else None


def _transform(value: Any) -> Any:
    return value if isinstance(value, rhino3dm.Transform) else None


def _face(value: Any) -> Any:
    return value if isinstance(value, stand_in.MeshFace) else None


def _colour(value: Any) -> Any:
    if isinstance(value, stand_in.Color):
        return value
    parts = _NUMBERS.findall(value) if isinstance(value, str) else []
    return stand_in.Color.FromArgb(*(int(float(part)) for part in parts)) if len(parts) in (3, 4) else None


def _path(value: Any) -> Any:
    """A path of a tree as a tuple; a whole number is a path of one index."""
    if isinstance(value, tuple):
        return value
    if isinstance(value, str):
        try:
            return path_of(value)
        except ValueError:
            return None
    number = _integer(value)
    return None if number is None else (number,)


def _rectangle(value: Any) -> Any:
    """Plane at a corner, width and height of a rectangle, or of what bounds other geometry in the world's XY plane."""
    curve = _curve(value)
    found = shapes.rectangle(curve) if curve is not None else None
    if found is not None or not isinstance(value, (rhino3dm.Curve, rhino3dm.Brep, rhino3dm.Surface)):
        return found
    box = value.GetBoundingBox()
    low, high = shapes.xyz(box.Min), shapes.xyz(box.Max)
    return shapes.plane(low, (1, 0, 0), (0, 1, 0)), float(high[0] - low[0]), float(high[1] - low[1])


def _geometry(value: Any) -> Any:
    if isinstance(value, (shapes.Group, shapes.TiltedBox)):
        return value
    fits = type(value).__module__.startswith("rhino3dm") and not isinstance(
        value, (rhino3dm.Interval, rhino3dm.Transform)
    )
    return value if fits else _point(value) if isinstance(value, str) else None


_CASTS: dict[str, Callable[[Any], Any]] = {
    "number": _number,
    "integer": _integer,
    "boolean": _boolean,
    "text": _text,
    "point": _point,
    "vector": _vector,
    "line": _line,
    "curve": _curve,
    "plane": _plane,
    "domain": _domain,
    "rectangle": _rectangle,
    "mesh": _mesh,
    "halfedge": _halfedge,
    "brep": _brep,
    "faces": lambda value: value if isinstance(value, rhino3dm.Mesh) else _brep(value),
    "surface": _surface,
    "box": _box,
    "anybox": lambda value: value if isinstance(value, shapes.TiltedBox) else _box(value),
    "transform": _transform,
    "face": _face,
    "colour": _colour,
    "path": _path,
    "geometry": _geometry,
}
