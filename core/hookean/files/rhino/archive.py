"""The chunk structure of a .3dm file, read from its bytes alone: which tables, layers and objects it holds.

A .3dm file is a 32-byte header and a row of chunks: a typecode (u32), a length (8 bytes from version 50 on,
4 before) and that many bytes. Tables are chunks of records, each record a chunk again. Reading these frames
without decoding any geometry is cheap, cannot hang, and shows objects that rhino3dm leaves out silently.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple
from uuid import UUID

from hookean.errors import InputError, refuse_pointer
from hookean.files.rhino.checksums import Checksums

MAGIC = b"3D Geometry File Format "
HEADER_SIZE = 32

PROPERTIES_TABLE = 0x10000014
SETTINGS_TABLE = 0x10000015
LAYER_TABLE = 0x10000011
OBJECT_TABLE = 0x10000013
LAYER_RECORD = 0x20008050
OBJECT_RECORD = 0x20008070
LIGHT_RECORD = 0x20008060
UNITS_RECORD = 0x20008031
CURRENT_LAYER = 0xA0000038
END_OF_TABLE = 0xFFFFFFFF
END_OF_FILE = 0x00007FFF

_SHORT = 0x80000000
_TABLE = 0x10000000
_CLASS = 0x00027FFA
_CLASS_UUID = 0x0002FFFB
_CLASS_DATA = 0x0002FFFC
_OBJECT_TYPE = 0x82000071
_OBJECT_ATTRIBUTES = 0x02008072
_RECORD_END = 0x8200007F
_OTHER_PARTS = (0x02000073, 0x02008074)  # user data of the attributes, history
_WORDS = {LAYER_RECORD: "layer", LIGHT_RECORD: "light", UNITS_RECORD: "setting of units"}
OBJECT_TYPES = {
    0x1: "point",
    0x2: "point cloud",
    0x4: "curve",
    0x8: "surface",
    0x10: "Brep",
    0x20: "mesh",
    0x100: "light",
    0x200: "annotation",
    0x1000: "block instance",
    0x2000: "text dot",
    0x8000: "detail view",
    0x10000: "hatch",
    0x20000: "morph control",
    0x40000: "SubD",
    0x20000000: "clipping plane",
    0x40000000: "extrusion",
}
"""What the bit of an object's type stands for."""
_NAMED = 3  # damaged objects that a note names
_MAX_TOP_LEVEL = 4096  # a file has about 20: one per table and one per plug-in


class Chunk(NamedTuple):
    """One chunk: bytes `start:end` in the file, its body `body:end`; `value` is a short chunk's number."""

    typecode: int
    start: int
    body: int
    end: int
    value: int


@dataclass(frozen=True, slots=True)
class Table:
    """A table: typecode, span `start:end`, and `tail`, where its end-of-table record begins."""

    typecode: int
    start: int
    body: int
    tail: int
    end: int


@dataclass(frozen=True, slots=True)
class LayerRecord:
    """A layer record: span `start:end` and the layer's number as stored in it (None if unreadable)."""

    start: int
    end: int
    index: int | None


@dataclass(frozen=True, slots=True)
class ObjectRecord:
    """An object record: span `start:end`, uuid of its class, bit of its object type, and from its attributes
    the object's id and layer number (None if unreadable) and name ("" for none, and before Rhino 5)."""

    start: int
    end: int
    class_id: UUID
    object_type: int
    id: UUID | None
    layer_index: int | None
    name: str

    @property
    def label(self) -> str:
        """Type, name and id, for a person."""
        return _label(self.object_type, self.name, self.id)


@dataclass(frozen=True, slots=True)
class Archive:
    """What `scan` found.

    `version` is 2, 3, 4, 50, 60, 70 or 80 (Rhino 5 is 50); `size` counts the bytes up to and with the end
    mark; `lights` counts light records; `current_layer` is a layer number or None; `notes` are sentences on
    small damage that does not keep the file from being read.
    """

    version: int
    size: int
    tables: tuple[Table, ...]
    layers: tuple[LayerRecord, ...]
    objects: tuple[ObjectRecord, ...]
    lights: int
    current_layer: int | None
    end_mark: Chunk
    notes: tuple[str, ...]

    @property
    def length_size(self) -> int:
        """Bytes of a chunk's length field: 8 from version 50 on, 4 before."""
        return length_size(self.version)

    def table(self, typecode: int) -> Table | None:
        """The first table of this typecode, or None."""
        return next((t for t in self.tables if t.typecode == typecode), None)


def length_size(version: int) -> int:
    """Bytes of a chunk's length field in archives of this version."""
    return 8 if version >= 50 else 4


def scan(data: bytes, name: str = "file") -> Archive:
    """Read the frames of a .3dm file's bytes; `name` is how errors call the file.

    Raises InputError when the bytes are no .3dm file, a file of version 1, cut short or damaged. Any bytes
    are safe to pass; the time is linear in their number.
    """
    version = _version(data, name)
    try:
        return _Scan(data, version).run()
    except _Damage as damage:
        raise InputError(
            name,
            f"damaged .3dm file: {damage}; it may be cut short, so copy or download it again, "
            "or open it in Rhino and save it again.",
        ) from None


def chunks(data: bytes, start: int, end: int, size: int) -> Iterator[Chunk]:
    """The chunks that fill `start:end` exactly; `size` is that of a length field. Internal: raises _Damage."""
    layout = struct.Struct("<Iq" if size == 8 else "<Ii")
    head = layout.size
    position = start
    while position < end:
        if position + head > end:
            raise _Damage(f"a record at byte {position} is too short for its header")
        typecode, value = layout.unpack_from(data, position)
        body = position + head
        after = body if typecode & _SHORT else body + value
        if not body <= after <= end:
            raise _Damage(f"the record at byte {position} claims {value} bytes where {end - body} are left")
        yield Chunk(typecode, position, body, after, value)
        position = after


class _Damage(Exception):
    """What is wrong inside the bytes, as the middle of a sentence."""


def _version(data: bytes, name: str) -> int:
    if not data:
        raise InputError(name, "the file is empty (0 bytes); give a .3dm file.")
    refuse_pointer(data, name)
    if not data.startswith(MAGIC[: len(data)]):
        raise InputError(
            name,
            'not a .3dm file: it does not begin with "3D Geometry File Format"; give a file saved by Rhino.',
        )
    digits = data[len(MAGIC) : HEADER_SIZE].strip()
    if len(data) < HEADER_SIZE or not digits.isdigit():
        raise InputError(name, "damaged .3dm file: its header is cut or has no version; copy or save it again.")
    version = int(digits)
    if version < 2:
        raise InputError(name, "a .3dm file of version 1, older than 2; open it in Rhino and save it again.")
    return version


class _Scan:
    """One pass over the bytes; gathers records as it walks."""

    def __init__(self, data: bytes, version: int) -> None:
        self.data = data
        self.version = version
        self.size = length_size(version)
        self.tables: list[Table] = []
        self.layers: list[LayerRecord] = []
        self.objects: list[ObjectRecord] = []
        self.lights = 0
        self.current_layer: int | None = None
        self.strange = self.units = 0
        self.checksums = Checksums(data, self.size)
        self.damaged = dict.fromkeys(_WORDS, 0)
        self.damaged_objects: list[int] = []

    def run(self) -> Archive:
        end_mark = self._top_level()
        for typecode in (LAYER_TABLE, OBJECT_TABLE):
            found = sum(table.typecode == typecode for table in self.tables)
            if found != 1:
                what = "layer" if typecode == LAYER_TABLE else "object"
                raise _Damage(f"it has {found} {what} tables instead of one")
        return Archive(
            version=self.version,
            size=end_mark.end,
            tables=tuple(self.tables),
            layers=tuple(self.layers),
            objects=tuple(self.objects),
            lights=self.lights,
            current_layer=self.current_layer,
            end_mark=end_mark,
            notes=self._notes(end_mark),
        )

    def _top_level(self) -> Chunk:
        for count, chunk in enumerate(chunks(self.data, HEADER_SIZE, len(self.data), self.size)):
            if count > _MAX_TOP_LEVEL:
                raise _Damage(f"it has more than {_MAX_TOP_LEVEL} tables")
            if chunk.typecode == END_OF_FILE:
                if chunk.end - chunk.body < self.size:
                    raise _Damage("its end mark is too short")
                return chunk
            if chunk.typecode & _TABLE and not chunk.typecode & _SHORT:
                self._table(chunk)
        raise _Damage("its end mark is missing")

    def _table(self, chunk: Chunk) -> None:
        tail = None
        for record in chunks(self.data, chunk.body, chunk.end, self.size):
            if tail is not None:
                raise _Damage(f"the table at byte {chunk.start} continues after its end")
            if record.typecode == END_OF_TABLE:
                tail = record.start
            elif record.typecode == OBJECT_RECORD and chunk.typecode == OBJECT_TABLE:
                self.objects.append(self._object(record))
            elif record.typecode == LAYER_RECORD and chunk.typecode == LAYER_TABLE:
                self.layers.append(self._layer(record))
            elif record.typecode == LIGHT_RECORD:
                self.lights += 1
            elif record.typecode == CURRENT_LAYER and chunk.typecode == SETTINGS_TABLE:
                self.current_layer = record.value
            elif record.typecode == UNITS_RECORD and chunk.typecode == SETTINGS_TABLE:
                self.units += 1
            elif chunk.typecode in (OBJECT_TABLE, LAYER_TABLE):
                self.strange += 1
            if record.typecode == OBJECT_RECORD and not self._holds(record):
                self.damaged_objects.append(len(self.objects) - 1)
            elif record.typecode in self.damaged and not self._holds(record):
                self.damaged[record.typecode] += 1
        if tail is None:
            raise _Damage(f"the table at byte {chunk.start} has no end")
        self.tables.append(Table(chunk.typecode, chunk.start, chunk.body, tail, chunk.end))

    def _object(self, record: Chunk) -> ObjectRecord:
        """Raises _Damage that names the object by its place, and by its type, name and id where those are read."""
        kind, class_id, ended = 0, None, False
        attributes: tuple[UUID | None, int | None, str] = (None, None, "")
        try:
            for part in self._parts(record):
                if part.typecode == _OBJECT_TYPE:
                    kind = part.value & 0xFFFFFFFF
                elif part.typecode == _CLASS and class_id is None:
                    class_id = self._class_id(part)
                elif part.typecode == _OBJECT_ATTRIBUTES:
                    attributes = self._attributes(part)
                elif part.typecode == _RECORD_END:
                    ended = True
                elif part.typecode not in _OTHER_PARTS:
                    self.strange += 1
            if class_id is None or not ended:
                raise _Damage(f"its record at byte {record.start} has no {'end' if class_id else 'class'}")
        except _Damage as damage:
            label = _label(kind, attributes[2], attributes[0])
            raise _Damage(f"object {len(self.objects)} ({label}) cannot be read: {damage}") from None
        return ObjectRecord(record.start, record.end, class_id, kind, *attributes)

    def _layer(self, record: Chunk) -> LayerRecord:
        body = next((part for part in self._parts(record) if part.typecode == _CLASS), None)
        if body is None:
            raise _Damage(f"the layer record at byte {record.start} has no class")
        for part in chunks(self.data, body.body, body.end, self.size):
            # version byte, mode, then the layer's number
            if part.typecode == _CLASS_DATA and part.end - part.body >= 13:
                return LayerRecord(record.start, record.end, self._int32(part.body + 5))
        return LayerRecord(record.start, record.end, None)

    def _parts(self, record: Chunk) -> Iterator[Chunk]:
        """A record's chunks; its last four bytes are the checksum (of nothing: all bytes are in the chunks)."""
        return chunks(self.data, record.body, record.end - 4, self.size)

    def _class_id(self, wrapper: Chunk) -> UUID:
        first = next(chunks(self.data, wrapper.body, wrapper.end, self.size), None)
        if first is None or first.typecode != _CLASS_UUID or first.end - first.body != 20:
            raise _Damage(f"the record at byte {wrapper.start} does not name its class")
        return UUID(bytes_le=self.data[first.body : first.body + 16])

    def _holds(self, record: Chunk) -> bool:
        """Whether the checksums in a record agree with its bytes."""
        if record.typecode == UNITS_RECORD:
            return self.checksums.hold(record.typecode, record.body, record.end)
        return all(self.checksums.hold(part.typecode, part.body, part.end) for part in self._parts(record))

    def _attributes(self, part: Chunk) -> tuple[UUID | None, int | None, str]:
        """Id, layer number and name."""
        # a version byte whose high four bits are 1 or 2 (before and from Rhino 5), then id and layer number
        if part.end - part.body < 25 or self.data[part.body] >> 4 not in (1, 2):
            return None, None, ""
        id, layer = UUID(bytes_le=self.data[part.body + 1 : part.body + 17]), self._int32(part.body + 17)
        name, at = "", part.body + 22
        # from Rhino 5 on items follow, each behind its number; the name is the first of them
        if self.data[part.body] >> 4 == 2 and self.data[at - 1] == 1 and at + 8 <= part.end:
            end = at + 4 + 2 * max(0, self._int32(at) - 1)
            name = self.data[at + 4 : end].decode("utf-16-le", "replace") if end <= part.end else ""
        return id, layer, name

    def _int32(self, position: int) -> int:
        return int.from_bytes(self.data[position : position + 4], "little", signed=True)

    def _notes(self, end_mark: Chunk) -> tuple[str, ...]:
        notes = []
        stated = int.from_bytes(self.data[end_mark.body : end_mark.body + self.size], "little")
        if stated != end_mark.end:
            notes.append(f"the end mark states {stated} bytes, the file has {end_mark.end}.")
        if len(self.data) > end_mark.end:
            notes.append(f"{len(self.data) - end_mark.end} bytes after the end mark are ignored.")
        if self.units != 1:
            notes.append("the unit of length is not in its place: the file is damaged, check the result.")
        if self.strange:
            notes.append(f"{self.strange} records among objects and layers are of unknown kind and are left out.")
        for place in self.damaged_objects[:_NAMED]:
            said = f"object {place} ({self.objects[place].label}) does not match its checksums"
            notes.append(f"{said}: it is damaged, check the result there.")
        if (more := len(self.damaged_objects) - _NAMED) > 0:
            notes.append(f"{more} more object{'s do' if more > 1 else ' does'} not match their checksums.")
        for typecode, what in _WORDS.items():
            if count := self.damaged[typecode]:
                whole = f"{count} {what}s do" if count > 1 else f"1 {what} does"
                notes.append(f"{whole} not match the checksum: the file is damaged, check the result.")
        return tuple(notes)


def _label(kind: int, name: str, id: UUID | None) -> str:
    what = OBJECT_TYPES.get(kind, f"type {kind:#x}") if kind else "unknown type"
    called = f' "{" ".join(name.split())[:80]}"' if name else ""
    return what + called + (f", id {id}" if id is not None else "")
