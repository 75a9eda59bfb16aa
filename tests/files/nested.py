"""Objects whose records nest chunks in chunks: made by hand as openNURBS lays them out, then written by openNURBS.

rhino3dm makes neither detail views nor texts, but decodes what it is given; from then on every byte is openNURBS's own.
Source: openNURBS, `opennurbs_detail.cpp`, `opennurbs_annotationbase.cpp`, `opennurbs_text.cpp`.
"""

from __future__ import annotations

import base64
import struct
import tempfile
import zlib
from pathlib import Path
from typing import Any
from uuid import UUID

import rhino3dm as _rhino3dm

from hookean.files.rhino.archive import SETTINGS_TABLE, chunks, scan

rhino: Any = _rhino3dm
UNNAMED, CLASS, CLASS_ID, CLASS_DATA, CLASS_END = 0x40008000, 0x00027FFA, 0x0002FFFB, 0x0002FFFC, 0x80027FFF
USER_DATA, USER_HEAD = 0x00027FFD, 0x0002FFF9
VIEWS = 0x20008037
PLANE = struct.pack("<16d", 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 0)
Part = bytes | tuple[bytes]  # a nested chunk stands in a tuple: it is not summed


def chunk(typecode: int, *parts: Part) -> bytes:
    """A chunk of own bytes and nested chunks, with its checksum where its typecode asks for one (8-byte lengths)."""
    body, found = b"", 0
    for part in parts:
        if isinstance(part, bytes):
            body, found = body + part, zlib.crc32(part, found)
        else:
            body += part[0]
    tail = struct.pack("<I", found) if typecode & 0x8000 else b""
    return struct.pack("<Iq", typecode, len(body) + len(tail)) + body + tail


def short(typecode: int, value: int = 0) -> bytes:
    """A chunk that is a head only."""
    return struct.pack("<Iq", typecode, value)


def version(major: int, minor: int) -> bytes:
    return struct.pack("<ii", major, minor)


def decoded(class_id: str, data: bytes) -> Any:
    """The object of a class and its data, as rhino3dm decodes it."""
    head = (chunk(CLASS_ID, UUID(class_id).bytes_le),)
    whole = chunk(CLASS, head, (chunk(CLASS_DATA, (data,)),), (short(CLASS_END),))
    form = rhino.Point(rhino.Point3d(0, 0, 0)).Encode()
    found = rhino.CommonObject.Decode({**form, "data": base64.b64encode(whole).decode()})
    assert found is not None
    return found


def written(file: Any, number: int) -> bytes:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "written.3dm"
        assert file.Write(str(path), number)
        return path.read_bytes()


def _view() -> bytes:
    """The chunks of a view: short ones among them, and the end of a table at their end."""
    file = rhino.File3dm()
    file.Views.Add(rhino.ViewInfo())
    data = written(file, 6)
    table = scan(data).table(SETTINGS_TABLE)
    assert table is not None
    views = next(c for c in chunks(data, table.body, table.tail, 8) if c.typecode == VIEWS)
    record = next(chunks(data, views.body + 4, views.end - 4, 8))  # behind the number of views
    return data[record.body : record.end - 4]


def _curve() -> bytes:
    corners = [rhino.Point3d(x, y, 0) for x, y in ((0, 0), (4, 0), (4, 3), (0, 3), (0, 0))]
    data = base64.b64decode(rhino.NurbsCurve.Create(False, 1, corners).Encode()["data"])
    whole = next(chunks(data, 0, len(data), 8))
    part = next(c for c in chunks(data, whole.body, whole.end, 8) if c.typecode == CLASS_DATA)
    return data[part.body : part.end - 4]


def detail() -> Any:
    """A detail view of a layout: a view and its frame."""
    view, frame = (chunk(UNNAMED, version(1, 0), part) for part in ((_view(),), _curve()))
    whole = chunk(UNNAMED, version(1, 1), (view,), (frame,), struct.pack("<d", 0.5))
    return decoded("C8C66EFA-B3CB-4e00-9440-2AD66203379E", whole)


def text(style: Any) -> Any:
    """A text with a height of its own: from Rhino 6 on a whole dimension style is nested in it, with its font's name
    (typecode 0x40008001) and its attributes as a component (0x40008002)."""
    letters = "height\0"
    said = struct.pack("<I", len(letters)) + letters.encode("utf-16-le")
    numbers = struct.pack("<ddIId?", 0.0, 0.0, 0, 0, 1.0, False)
    content = chunk(UNNAMED, version(1, 0), said + PLANE + numbers)
    overrides = chunk(UNNAMED, version(1, 1), b"\0")
    annotation = chunk(
        UNNAMED, version(1, 4), (content,), style.Id.bytes_le + PLANE + struct.pack("<I", 9), (overrides,),
        struct.pack("<3d?", 1, 0, 0, True),
    )  # fmt: skip
    found = decoded("57376349-62A9-4A16-B411-A46BCD544790", chunk(UNNAMED, version(1, 0), (annotation,)))
    found.SetTextHeight(style, 5.0)
    assert found.HasPropertyOverrides
    return found


def plug_in_data() -> bytes:
    """User data of a class nobody knows: a dictionary, as .NET plug-ins write it, and a typecode of their own."""
    entry = chunk(0x40008012, struct.pack("<i", 7), b"key\0")
    named = chunk(0x40008011, UUID(int=7).bytes_le)
    dictionary = chunk(0x40008010, version(1, 0), (named,), (entry,), (entry,), (short(0xC0000013),), b"rest")
    own = chunk(0x4000FACE, b"\1\2", (chunk(0x20008ABC, b"\3\4\5"),), struct.pack("<iq", -1, 0))
    head = chunk(USER_HEAD, UUID(int=8).bytes_le * 2, struct.pack("<i16d", 1, *range(16)), UUID(int=9).bytes_le)
    return chunk(USER_DATA, b"\x22", (head,), (chunk(UNNAMED, (dictionary,), (own,)),))


def with_plug_in_data(data: bytes, place: int) -> bytes:
    """A file of Rhino 5 or later with such user data on the object at `place`; every length above it is mended."""
    record, grown, table = scan(data).objects[place], plug_in_data(), 0
    found = bytearray(data)
    whole = next(c for c in chunks(data, record.start + 12, record.end - 4, 8) if c.typecode == CLASS)
    end = next(c for c in chunks(data, whole.body, whole.end, 8) if c.typecode == CLASS_END)
    archive = scan(data)
    table = next(t.start for t in archive.tables if t.start < record.start < t.end)
    for start in (table, record.start, whole.start):
        length = struct.unpack_from("<q", found, start + 4)[0]
        struct.pack_into("<q", found, start + 4, length + len(grown))
    struct.pack_into("<q", found, archive.end_mark.body, archive.size + len(grown))
    found[end.start : end.start] = grown
    return bytes(found)


def sample() -> Any:
    """A file with a point, a detail view, a text and a mesh, all named."""
    file = rhino.File3dm()
    file.Settings.ModelUnitSystem = rhino.UnitSystem.Meters
    style = rhino.DimensionStyle()
    style.Name = "style"
    file.DimStyles.Add(style)
    mesh = rhino.Mesh()
    for corner in ((0, 0, 0), (1, 0, 0), (0, 1, 0)):
        mesh.Vertices.Add(*corner)
    mesh.Faces.AddFace(0, 1, 2)
    mesh.SetUserString("key", "value")
    shapes = {"first": rhino.Point(rhino.Point3d(1, 2, 3)), "page": detail(), "note": text(style), "sheet": mesh}
    for name, shape in shapes.items():
        attributes = rhino.ObjectAttributes()
        attributes.Name = name
        file.Objects.Add(shape, attributes)
    return file
