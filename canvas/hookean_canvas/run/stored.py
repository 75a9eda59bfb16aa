"""Values that a file stores in parameters and inputs: numbers, text, points ..., and geometry that was internalised.

Internalised geometry is the item `ON_Data`: raw deflate around a stream of .NET's binary serialisation (MS-NRBF) with
one object, of which the members version, archive3dm, opennurbs and data are those that rhino3dm decodes.
"""

from __future__ import annotations

import base64
import struct
import zlib
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from hookean_canvas.archive import Chunk, Item, Type
from hookean_canvas.archive.chunk import MOST_BYTES
from hookean_canvas.run import stand_in as untyped
from hookean_canvas.run.natives import shapes
from hookean_canvas.run.rhino import rhino3dm

stand_in: Any = untyped


@dataclass(frozen=True)
class Unread:
    """A stored value that is not read; `items` are the names under which it is stored, `why` the reason if known."""

    items: list[str]
    why: str = ""


def stored(chunk: Chunk) -> Any:
    """A stored value; None for a null, Unread for what cannot be read here."""
    found = _with_plane(chunk)
    if found is not None:
        return found
    for name, (kinds, read) in _KINDS.items():
        item = chunk.item(name)
        if item is not None and item.type in kinds:
            return read(item)
    data = chunk.item("ON_Data")
    if data is not None and data.type is Type.BYTEARRAY:
        return _geometry(data.value)
    for inner in chunk.chunks:  # data of any kind: its type's name, and the value in a chunk of its own
        found = stored(inner)
        if not isinstance(found, Unread):
            return found
    if not chunk.items and not chunk.chunks:
        return None
    names = [item.name for item in chunk.items]
    why = "it refers to an object of a Rhino file; internalise it in Grasshopper" if "RefID" in names else ""
    return Unread(names or [inner.name for inner in chunk.chunks], why)


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
    "path": ((Type.STRING,), _same),
}
"""Under which names values are stored, as which types, and how they are read."""


def _geometry(data: bytes) -> Any:
    """The object of rhino3dm in internalised bytes."""
    try:
        members = _members(_inflated(data))
        found = rhino3dm.CommonObject.Decode(
            {
                "version": members["version"],
                "archive3dm": members["archive3dm"],
                "opennurbs": members["opennurbs"],
                "data": base64.b64encode(members["data"]).decode("ascii"),
            }
        )
    except (KeyError, ValueError, TypeError, IndexError, struct.error, zlib.error, RuntimeError) as error:
        return Unread(["ON_Data"], f"its bytes cannot be read ({type(error).__name__})")
    if found is None:
        return Unread(["ON_Data"], "rhino3dm does not know its version")
    return found.Location if isinstance(found, rhino3dm.Point) else found


def _inflated(data: bytes) -> bytes:
    """Bytes without their compression, a raw deflate stream or none; ValueError where they are too many."""
    if data[:1] == b"\x00" and data[1:5] == b"\x01\x00\x00\x00":  # the header of a stream that is not compressed
        return data
    unpack = zlib.decompressobj(-15)
    found = unpack.decompress(data, MOST_BYTES)
    if unpack.unconsumed_tail:
        raise ValueError("too large")
    return found


# records and types of MS-NRBF, sections 2.1.2 and 2.3
_LIBRARY, _CLASSES, _OBJECT_STRING, _BYTES, _REFERENCE, _NULL, _END = 12, (4, 5), 6, 15, 9, 10, 11
_MOST_RECORDS = 100  # records of a stream and members of its object; geometry has four members in five records
_WIDTHS = {1: "?", 2: "B", 6: "d", 7: "h", 8: "i", 9: "q", 11: "f", 14: "H", 15: "I", 16: "Q"}


class _Reader:
    """A stream of .NET's binary serialisation, read from its start."""

    def __init__(self, data: bytes) -> None:
        self.data, self.at = data, 17  # after the header: a record type and four numbers

    def number(self, form: str = "i") -> Any:
        (found,) = struct.unpack_from("<" + form, self.data, self.at)
        self.at += struct.calcsize("<" + form)
        return found

    def text(self) -> str:
        """A text with its length before it, 7 bits a byte."""
        length, shift = 0, 0
        while True:
            byte = self.number("B")
            length |= (byte & 127) << shift
            shift += 7
            if byte < 128:
                break
            if shift > 28:
                raise ValueError("text without end")
        if length > len(self.data) - self.at:
            raise ValueError("text beyond the end")
        self.at += length
        return self.data[self.at - length : self.at].decode("utf-8")

    def array(self) -> tuple[int, bytes]:
        """The id and the bytes of an array of bytes."""
        number, length, kind = self.number(), self.number(), self.number("B")
        if kind != 2 or not 0 <= length <= len(self.data) - self.at:
            raise ValueError("not an array of bytes")
        self.at += length
        return number, self.data[self.at - length : self.at]


def _members(data: bytes) -> dict[str, Any]:
    """Numbers and bytes of the one object in a stream, by the names of its members."""
    reader = _Reader(data)
    members: dict[str, Any] = {}
    later: dict[int, str] = {}
    records = 0
    while reader.at < len(data):
        record, records = reader.number("B"), records + 1
        if records > _MOST_RECORDS:
            raise ValueError("too many records")
        if record == _LIBRARY:
            reader.number()
            reader.text()
        elif record in _CLASSES and not members:
            _object(reader, record, members, later)
        elif record == _BYTES:
            number, found = reader.array()
            members[later[number]] = found
        elif record == _END:
            break
        else:
            raise ValueError(f"record {record}")
    return members


def _object(reader: _Reader, record: int, members: dict[str, Any], later: dict[int, str]) -> None:
    """The values of an object; `later` gets the ids of arrays that follow it."""
    reader.number()
    reader.text()
    count = reader.number()
    if count > _MOST_RECORDS:
        raise ValueError("too many members")
    names = [reader.text() for _ in range(count)]
    kinds = [reader.number("B") for _ in names]
    more = [reader.number("B") if kind in (0, 7) else reader.text() if kind == 3 else None for kind in kinds]
    if record == 5:
        reader.number()
    for name, kind, primitive in zip(names, kinds, more, strict=True):
        if kind == 0:
            members[name] = reader.number(_WIDTHS[int(primitive or 0)])
            continue
        inner = reader.number("B")
        if inner == _REFERENCE:
            later[reader.number()] = name
        elif inner == _BYTES:
            members[name] = reader.array()[1]
        elif inner == _OBJECT_STRING:
            reader.number()
            members[name] = reader.text()
        elif inner != _NULL:
            raise ValueError(f"record {inner}")
