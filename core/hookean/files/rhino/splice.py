"""Adding layers, objects and document text to a .3dm file without touching what is already in it.

A round trip through rhino3dm changes more than one expects: plug-in classes, some geometry, unknown objects.
So the new records are copied as bytes from a file rhino3dm wrote into a copy of the original's bytes; only
the lengths of the two tables and the end mark change. Document text is a table of its own, replaced as a whole.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass
from uuid import UUID

from hookean.errors import InputError
from hookean.files.rhino.archive import (
    LAYER_TABLE,
    OBJECT_TABLE,
    PROPERTIES_TABLE,
    Archive,
    Table,
    chunks,
    scan,
)

OLDEST_SPLICED = 50  # Rhino 5; before it the records of a table depend on other tables

_USER_TABLE = 0x10000017
_TEXT = UUID("06f3218e-f5ec-4f6c-b74c-14583f0ed7bc")  # of the table that holds the document's user text
_FILE_NAME = 0x20008027
_REVISION_HISTORY = 0x20008021


@dataclass(frozen=True, slots=True)
class _Edit:
    """Bytes `start:end` of the original replaced by `new`."""

    start: int
    end: int
    new: bytes


def splice(
    original: bytes,
    addition: bytes,
    *,
    layers: int,
    objects: int,
    drop_objects: Collection[int] = (),
    drop_layers: int = 0,
    text: bool = False,
    name: str = "file",
) -> bytes:
    """`original` with the last `layers` layer and last `objects` object records of `addition` put at the ends
    of its tables.

    Both are .3dm bytes of the same version, 50 or later. The new layers must have the numbers they will have
    in the result: `addition` holds as many layers before them as `original` keeps. `drop_objects` are places
    of object records to leave out, `drop_layers` how many layer records at the end to leave out; `text` puts the
    document text of `addition` in place of the original's. Every other record of the original stays byte for byte, in
    order. Raises InputError when the two do not fit.
    """
    old, new = scan(original, name), scan(addition, "addition")
    _fit(old, new, layers, objects, drop_layers, name)
    cut_layers = old.layers[len(old.layers) - drop_layers :]
    cut_objects = [old.objects[i] for i in sorted(set(drop_objects))]
    new_layers = b"".join(addition[r.start : r.end] for r in new.layers[len(new.layers) - layers :])
    new_objects = b"".join(addition[r.start : r.end] for r in new.objects[len(new.objects) - objects :])
    edits = {
        LAYER_TABLE: [_Edit(r.start, r.end, b"") for r in cut_layers],
        OBJECT_TABLE: [_Edit(r.start, r.end, b"") for r in cut_objects],
    }
    for typecode, records in ((LAYER_TABLE, new_layers), (OBJECT_TABLE, new_objects)):
        tail = _table(old, typecode).tail
        edits[typecode].append(_Edit(tail, tail, records))
    return _rewrite(original, old, edits, _text_edits(original, old, addition, new) if text else [])


def _text_edits(original: bytes, old: Archive, addition: bytes, new: Archive) -> list[_Edit]:
    """The original's table of document text out, the addition's in: in its place, or behind all tables."""
    edits = [_Edit(table.start, table.end, b"") for table in _text_tables(original, old)]
    found = b"".join(addition[table.start : table.end] for table in _text_tables(addition, new))
    place = edits[0].start if edits else old.end_mark.start
    return [*edits, _Edit(place, place, found)]


def _text_tables(data: bytes, archive: Archive) -> list[Table]:
    """Tables of a plug-in begin with a record that has its id: here the id of document text."""
    head = 4 + archive.length_size
    users = (table for table in archive.tables if table.typecode == _USER_TABLE)
    return [t for t in users if data[t.body + head : t.body + head + 16] == _TEXT.bytes_le]


def without_history(data: bytes) -> bytes:
    """A .3dm file's bytes without the path it was written to and its dates, authors and revision number.

    Rhino reads such a file as new. What is left depends on the content alone.
    """
    archive = scan(data)
    table = _table(archive, PROPERTIES_TABLE)
    cut = [
        _Edit(chunk.start, chunk.end, b"")
        for chunk in chunks(data, table.body, table.tail, archive.length_size)
        if chunk.typecode in (_FILE_NAME, _REVISION_HISTORY)
    ]
    return _rewrite(data, archive, {PROPERTIES_TABLE: cut})


def _fit(old: Archive, new: Archive, layers: int, objects: int, drop_layers: int, name: str) -> None:
    if old.version != new.version or old.version < OLDEST_SPLICED:
        raise InputError(
            name,
            f"cannot add records of version {new.version} to a .3dm file of version {old.version}; "
            f"both must be the same and {OLDEST_SPLICED} (Rhino 5) or later: save the file with Rhino 5 or later.",
        )
    if any(record.index != place for place, record in enumerate(old.layers)):
        raise InputError(
            name,
            "the layers of this .3dm file are not numbered 0, 1, 2, ...; open it in Rhino and save it again.",
        )
    kept = len(old.layers) - drop_layers
    if kept < 0 or len(new.layers) < layers or len(new.objects) < objects:
        raise InputError(name, "more records are requested than the two .3dm files have.")
    if layers and new.layers[len(new.layers) - layers].index != kept:
        raise InputError(name, f"the first new layer must have number {kept}, as many as the file keeps.")


def _table(archive: Archive, typecode: int) -> Table:
    table = archive.table(typecode)
    if table is None:
        raise InputError("file", f"the .3dm file has no table {typecode:#x}; save it again with Rhino.")
    return table


def _rewrite(data: bytes, archive: Archive, edits: dict[int, list[_Edit]], whole: Sequence[_Edit] = ()) -> bytes:
    """Apply edits inside tables and of `whole` tables, then set the tables' lengths and the end mark. Tables carry no
    checksum."""
    size = archive.length_size
    every = list(whole)
    for typecode, inside in edits.items():
        table = _table(archive, typecode)
        grown = sum(len(e.new) - (e.end - e.start) for e in inside)
        length = table.end - table.body + grown
        every.append(_Edit(table.start + 4, table.body, length.to_bytes(size, "little")))
        every += inside
    total = archive.size + sum(len(e.new) - (e.end - e.start) for e in every)
    mark = archive.end_mark
    every.append(_Edit(mark.body, mark.body + size, total.to_bytes(size, "little")))
    return b"".join(_pieces(data, every))


def _pieces(data: bytes, edits: Iterable[_Edit]) -> Iterable[bytes]:
    position = 0
    for edit in sorted(edits, key=lambda e: (e.start, e.end)):
        yield data[position : edit.start]
        yield edit.new
        position = edit.end
    yield data[position:]
