"""Intact files are not called damaged, however deep their objects nest chunks; damaged ones name the object.

The oracle of an intact file is openNURBS, which wrote it; that of a damaged one a bit that was turned.
"""

from __future__ import annotations

import random
import struct
from pathlib import Path
from typing import Any

import pytest
import rhino3dm as _rhino3dm

from hookean.errors import InputError
from hookean.files.rhino.archive import OBJECT_TYPES, chunks, scan
from hookean.files.rhino.threedm import Additions, read, write

from . import nested

rhino: Any = _rhino3dm
VERSIONS = (2, 3, 4, 5, 6, 7, 8)


@pytest.fixture(scope="module", params=VERSIONS)
def data(request: pytest.FixtureRequest) -> bytes:
    """The same objects as openNURBS writes them in each version."""
    return nested.written(nested.sample(), request.param)


def records(data: bytes) -> list[bytes]:
    return [data[record.start : record.end] for record in scan(data).objects]


def test_the_nested_typecodes_are_there() -> None:
    """The sample has what it is meant to have: strings and attributes of components, views in detail views."""
    for version, codes in ((2, (0x2000813B,)), (8, (0x2000813B, 0x40008001, 0x40008002))):
        whole = b"".join(records(nested.written(nested.sample(), version)))
        assert all(code.to_bytes(4, "little") in whole for code in codes)


def test_intact_objects_are_not_called_damaged(data: bytes) -> None:
    archive = scan(data)
    assert archive.notes == () and len(archive.objects) == 4
    found = rhino.File3dm.FromByteArray(data)
    assert [record.id for record in archive.objects] == [item.Attributes.Id for item in found.Objects]


def test_they_come_through_a_round_trip(data: bytes, tmp_path: Path, additions: Additions) -> None:
    """From Rhino 5 on byte for byte; before, rhino3dm writes them again. Neither the source nor the copy is damaged."""
    source, target = tmp_path / "source.3dm", tmp_path / "target.3dm"
    source.write_bytes(data)
    model = read(source)
    assert not [said for said in model.warnings if "damage" in said]
    less = Additions(additions.layers, [item for item in additions.objects if item.name != "cloud"])
    done = write(source, target, less)  # version 2 has no point sets
    assert not [said for said in done.warnings if "damage" in said]
    back = target.read_bytes()
    assert scan(back).notes == () and len(scan(back).objects) == 4 + len(less.objects)
    assert [item.name for item in read(target).objects][:4] == ["first", "page", "note", "sheet"]
    if model.version >= 50:
        assert records(back)[:4] == records(data)


@pytest.mark.parametrize("version", [5, 6, 7, 8])
@pytest.mark.parametrize("place", range(4))
def test_data_of_plug_ins_may_nest_what_they_like(version: int, place: int, tmp_path: Path) -> None:
    """Dictionaries, typecodes of their own, a minus one and a zero that only look like the end of a table."""
    plain = nested.written(nested.sample(), version)
    data = nested.with_plug_in_data(plain, place)
    assert len(data) > len(plain) and scan(data).notes == ()
    source, target = tmp_path / "source.3dm", tmp_path / "target.3dm"
    source.write_bytes(data)
    write(source, target, Additions())
    assert records(target.read_bytes()) == records(data)
    assert not [said for said in read(target).warnings if "damage" in said]


@pytest.mark.parametrize("version", VERSIONS)
def test_numbers_that_look_like_a_nested_chunk_are_numbers(version: int) -> None:
    """A vertex at x = 2.0078125 has the bytes of the typecode 0x40008000; with a y of 5.6e-44 after it, a length."""
    x, y = (struct.unpack("<f", struct.pack("<I", number))[0] for number in (0x40008000, 40))
    mesh = rhino.Mesh()
    for corner in ((x, y, 0.0), (1, 0, 0), (0, 1, 0), (3, 3, 0)):
        mesh.Vertices.Add(*corner)
    mesh.Faces.AddFace(0, 1, 2, 3)
    file = rhino.File3dm()
    file.Objects.AddMesh(mesh)
    data = nested.written(file, version)
    assert struct.pack("<II", 0x40008000, 40) in data and scan(data).notes == ()


@pytest.mark.thinned
@pytest.mark.parametrize("version", [4, 8])
@pytest.mark.parametrize(("place", "label"), [(1, 'detail view "page"'), (2, 'annotation "note"'), (3, 'mesh "sheet"')])
def test_one_wrong_bit_names_the_object(version: int, place: int, label: str) -> None:
    """Bits anywhere in a record that nests: either the file is refused or a note names the object by type, name and id.
    What no checksum covers is the heads of short chunks, the bytes of a row that are not in its chunks, and the sum of
    the record itself: those bits may pass."""
    data = nested.written(nested.sample(), version)
    archive = scan(data)
    record, chance = archive.objects[place], random.Random(place)
    label = label if version == 8 else label.partition(' "')[0]  # before Rhino 5 names are not read from the bytes
    called = f"object {place} ({label}, id {record.id})"
    silent = 0
    for _ in range(150):
        at = chance.randrange(record.start + 16, record.end - 4)
        changed = bytearray(data)
        changed[at] ^= 1 << chance.randrange(8)
        try:
            notes = scan(bytes(changed)).notes
        except InputError as error:
            assert f"object {place} (" in error.sentence or "record at byte" in error.sentence
            continue
        silent += not notes
        same = scan(bytes(changed)).objects[place].label == record.label  # the bit may be one of the name
        assert not notes or not same or notes[0].startswith(called) or "unknown kind" in notes[0], notes
    assert silent < 15


def test_a_note_lists_a_few_objects_and_counts_the_others() -> None:
    file = rhino.File3dm()
    for i in range(6):
        file.Objects.AddPoint(rhino.Point3d(i, 0, 0))
    data = bytearray(nested.written(file, 7))
    for record in scan(bytes(data)).objects:
        data[data.index(record.class_id.bytes_le, record.start)] ^= 1
    notes = scan(bytes(data)).notes
    assert [said[:9] for said in notes] == ["object 0 ", "object 1 ", "object 2 ", "3 more ob"]


def test_a_refusal_names_the_object(tmp_path: Path) -> None:
    """A record whose class is gone, one whose length is wrong."""
    data = nested.written(nested.sample(), 7)
    record = scan(data).objects[3]
    whole = next(c for c in chunks(data, record.start + 12, record.end - 4, 8) if c.typecode == nested.CLASS)
    for at, byte, said in ((whole.start + 3, 0x7F, "has no class"), (whole.start + 9, 0x7F, "claims")):
        changed = bytearray(data)
        changed[at] = byte
        path = tmp_path / "damaged.3dm"
        path.write_bytes(changed)
        with pytest.raises(InputError) as raised:
            read(path)
        assert raised.value.pointer == "damaged.3dm" and raised.value.sentence.startswith("damaged .3dm file: object 3")
        assert "(mesh" in raised.value.sentence and said in raised.value.sentence


def test_types_of_objects_are_those_of_rhino() -> None:
    names = {
        "point cloud": "PointSet", "block instance": "InstanceReference", "detail view": "Detail",
        "clipping plane": "ClipPlane",
    }  # fmt: skip
    for bit, name in OBJECT_TYPES.items():
        known = names.get(name) or "".join(word.capitalize() for word in name.split()).replace("Subd", "SubD")
        member = getattr(rhino.ObjectType, known, None)
        assert member is None or int(member.value) == bit, name


def test_bytes_that_pretend_to_nest_are_read_in_time() -> None:
    """A record of nothing but heads, each claiming the rest: looked at a bounded number of times, whatever it holds."""
    from hookean.files.rhino.checksums import Checksums

    data = b"".join(nested.short(0x4000FACE, 12 * (4999 - i)) for i in range(5000))
    sums = Checksums(data, 8)
    sums.hold(0x4000FACE, 0, len(data))
    assert sums.left > -10 * len(data)
