"""Values that a file stores in parameters and inputs: numbers, text, points ..., and geometry that was internalised.

Internalised geometry is the item `ON_Data`: raw deflate around a stream of .NET's binary serialisation (MS-NRBF) with
one object, of which the members version, archive3dm, opennurbs and data are those that rhino3dm decodes.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any
from uuid import UUID

from hookean_canvas.archive import Chunk, Item, Type
from hookean_canvas.run import stand_in as untyped
from hookean_canvas.run.internalised import decoded
from hookean_canvas.run.natives import shapes
from hookean_canvas.run.natives.surfaces_at import Domain2
from hookean_canvas.run.rhino import rhino3dm

stand_in: Any = untyped
REFERS = "it refers to an object of a Rhino file; give the file with --rhino form.3dm, or internalise it in Grasshopper"
REFERS_TO_PLACE = "it refers to a place on an object of a Rhino file; internalise it in Grasshopper"
NOTHING: Mapping[bytes, str] = MappingProxyType({})


@dataclass(frozen=True)
class Unread:
    """A stored value that is not read; `items` are the names under which it is stored, `why` the reason if known,
    `reference` the id of the object of a Rhino file that it refers to."""

    items: list[str]
    why: str = ""
    reference: UUID | None = None


def stored(chunk: Chunk, refused: Mapping[bytes, str] = NOTHING) -> Any:
    """A stored value; None for a null, Unread for what cannot be read here; `refused`: bytes that are not decoded, and
    why."""
    found = _with_plane(chunk)
    if found is not None:
        return found
    for name, (kinds, read) in _KINDS.items():
        item = chunk.item(name)
        if item is not None and item.type in kinds:
            return read(item)
    data = chunk.item("ON_Data")
    if data is not None and data.type is Type.BYTEARRAY:
        return _geometry(data.value, refused)
    for inner in chunk.chunks:  # data of any kind, and references of points, have a chunk of their own
        found = stored(inner, refused)
        if not isinstance(found, Unread) or found.why:
            return found
    if not chunk.items and not chunk.chunks:
        return None
    if len(chunk.items) == 1 and not chunk.chunks and chunk.items[0].type in _BY_TYPE:
        return _BY_TYPE[chunk.items[0].type](chunk.items[0])
    names = [item.name for item in chunk.items]
    reference = chunk.value("RefID")
    if isinstance(reference, UUID):
        whole = "object" in str(chunk.value("RefType", default="object"))
        return Unread(names, REFERS, reference) if whole else Unread(names, REFERS_TO_PLACE)
    return Unread(names or [inner.name for inner in chunk.chunks], REFERS if "RefID" in names else "")


def _with_plane(chunk: Chunk) -> Any:
    """A rectangle or circle, which are stored as a plane and a size; None for anything but a plane with a companion."""
    values = {item.name.lower(): item for item in chunk.items}
    held = values.pop("plane", None)
    if held is None or held.type is not Type.PLANE or not values or "refid" in values:
        return None
    frame, size, radius = _plane(held), values.get("size"), values.get("radius")
    if size is not None and size.type is Type.INTERVAL2D:
        x0, x1, y0, y1 = size.value
        return shapes.polyline(shapes.in_plane(frame, [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]), closed=True)
    if radius is None or radius.type is not Type.DOUBLE or len(values) > 1:
        return Unread([item.name for item in chunk.items])
    found = rhino3dm.ArcCurve.CreateFromCircle(rhino3dm.Circle(radius.value))
    world = shapes.plane((0, 0, 0), (1, 0, 0), (0, 1, 0))
    found.Transform(rhino3dm.Transform.PlaneToPlane(world, frame))
    return found


def _plane(item: Item) -> Any:
    origin, x, y = (item.value[k : k + 3] for k in (0, 3, 6))
    return rhino3dm.Plane(rhino3dm.Point3d(*origin), rhino3dm.Vector3d(*x), rhino3dm.Vector3d(*y))


def _line(item: Item) -> Any:
    return rhino3dm.Line(rhino3dm.Point3d(*item.value[:3]), rhino3dm.Point3d(*item.value[3:]))


def _same(item: Item) -> Any:
    return item.value


_KINDS: dict[str, tuple[tuple[Type, ...], Callable[[Item], Any]]] = {
    "number": ((Type.INT32, Type.INT64, Type.SINGLE, Type.DOUBLE), _same),
    "string": ((Type.STRING,), _same),
    "expression": ((Type.STRING,), _same),
    "boolean": ((Type.BOOL,), _same),
    "Coordinate": ((Type.POINT3D,), _same),
    "vector": ((Type.POINT3D,), _same),
    "interval": ((Type.INTERVAL1D,), lambda item: rhino3dm.Interval(*item.value)),
    "Interval": ((Type.INTERVAL1D,), lambda item: rhino3dm.Interval(*item.value)),
    "plane": ((Type.PLANE,), _plane),
    "Plane": ((Type.PLANE,), _plane),
    "line": ((Type.LINE,), _line),
    "Line": ((Type.LINE,), _line),
    "color": ((Type.DRAWING_COLOR,), lambda item: stand_in.Color(*item.value)),
    "colour": ((Type.DRAWING_COLOR,), lambda item: stand_in.Color(*item.value)),
    "diffuse": ((Type.DRAWING_COLOR,), lambda item: stand_in.Color(*item.value)),  # of a material, which only shows
    "path": ((Type.STRING,), _same),
}
"""Under which names values are stored, as which types, and how they are read."""


_BY_TYPE: dict[Type, Callable[[Item], Any]] = {
    Type.POINT3D: _same,
    Type.PLANE: _plane,
    Type.LINE: _line,
    Type.INTERVAL1D: lambda item: rhino3dm.Interval(*item.value),
    Type.INTERVAL2D: lambda item: Domain2(item.value[:2], item.value[2:]),
    Type.BOUNDINGBOX: lambda item: rhino3dm.BoundingBox(
        rhino3dm.Point3d(*item.value[:3]), rhino3dm.Point3d(*item.value[3:])
    ),
    Type.DRAWING_COLOR: lambda item: stand_in.Color(*item.value),
}
"""How a value is read that is the only item, whatever its name."""


def _geometry(data: bytes, refused: Mapping[bytes, str]) -> Any:
    """The object of rhino3dm in internalised bytes."""
    try:
        if data in refused:
            raise ValueError(refused[data])
        found = decoded(data)
    except ValueError as error:
        return Unread(["ON_Data"], str(error))
    if found is None:
        return Unread(["ON_Data"], "rhino3dm does not know its version")
    return found.Location if isinstance(found, rhino3dm.Point) else found


def internalised_in(root: Chunk) -> list[bytes]:
    """The bytes of all geometry that an archive holds."""
    items = (chunk.item("ON_Data") for chunk in root.walk())
    return [item.value for item in items if item is not None and item.type is Type.BYTEARRAY]
