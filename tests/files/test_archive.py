"""The frames of .3dm files: what they show, and what any bytes at all do."""

from __future__ import annotations

import random
import struct
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import rhino3dm as _rhino3dm

from hookean.errors import InputError
from hookean.files.rhino.archive import MAGIC, OBJECT_TABLE, Archive, scan
from soak import SOAK

rhino: Any = _rhino3dm


def agrees(path: Path) -> Archive:
    """Scan and rhino3dm see the same objects, layers and version."""
    archive, file = scan(path.read_bytes()), rhino.File3dm.Read(str(path))
    assert archive.version == file.ArchiveVersion
    assert [record.id for record in archive.objects] == [item.Attributes.Id for item in file.Objects]
    assert [record.layer_index for record in archive.objects] == [o.Attributes.LayerIndex for o in file.Objects]
    assert [record.index for record in archive.layers] == [layer.Index for layer in file.Layers]
    assert archive.size == path.stat().st_size
    assert archive.notes == ()
    return archive


def test_real_files_agree_with_rhino3dm(real: Path) -> None:
    assert agrees(real).objects


@pytest.mark.parametrize("version", [2, 3, 4, 5, 6, 7, 8])
def test_written_files_agree_with_rhino3dm(version: int, make: Callable[..., Path]) -> None:
    archive = agrees(make(version))
    assert len(archive.objects) == 4
    assert archive.current_layer == 0
    assert archive.length_size == (8 if version >= 5 else 4)


def test_records_fill_their_table_in_order(real: Path) -> None:
    archive = scan(real.read_bytes())
    table = archive.table(OBJECT_TABLE)
    assert table is not None
    ends = [table.body, *(record.end for record in archive.objects)]
    assert [record.start for record in archive.objects] == ends[:-1]
    assert ends[-1] == table.tail
    assert archive.table(0x1234) is None


@pytest.mark.slow
def test_every_cut_of_a_small_file_is_refused(make: Callable[..., Path]) -> None:
    data = make(8).read_bytes()
    for end in range(0, len(data), 1 if SOAK else 7):
        with pytest.raises(InputError, match="file: "):
            scan(data[:end])


def test_cuts_at_table_borders_are_refused(real: Path) -> None:
    data = real.read_bytes()
    archive = scan(data)
    borders = {p + d for t in archive.tables for p in (t.start, t.body, t.tail, t.end) for d in (-1, 0, 1)}
    borders |= {p for record in archive.objects for p in (record.start, record.end - 1)}
    for end in sorted(borders | {0, 1, 31, 32, 33, len(data) - 1}):
        with pytest.raises(InputError):
            scan(data[:end])


@pytest.mark.slow
def test_flipped_bytes_give_an_archive_or_a_sentence(real: Path) -> None:
    data, chance = real.read_bytes(), random.Random(7)
    outcomes: set[type] = set()
    heads = [t.start + k for t in scan(data).tables for k in range(12)]
    for _ in range(120):
        damaged = bytearray(data)
        for _ in range(chance.randint(1, 4)):
            place = chance.choice(heads) if chance.random() < 0.6 else chance.randrange(len(data))
            damaged[place] = chance.randrange(256)
        try:
            outcomes.add(type(scan(bytes(damaged))))
        except InputError as error:
            outcomes.add(InputError)
            assert error.pointer == "file" and error.sentence.endswith(".")
    assert outcomes == {Archive, InputError}


def test_random_bytes_behind_a_header_are_refused() -> None:
    chance = random.Random(11)
    for version in (b"       2", b"       4", b"      50", b"      80", b"99999999"):
        for size in (0, 1, 11, 12, 13, 500, 5000):
            with pytest.raises(InputError):
                scan(MAGIC + version + chance.randbytes(size))


def test_a_length_that_wraps_round_is_refused(make: Callable[..., Path]) -> None:
    data = bytearray(make(7).read_bytes())
    table = scan(bytes(data)).table(OBJECT_TABLE)
    assert table is not None
    for length in (-1, -12, -(2**63), 2**63 - 1, len(data)):
        struct.pack_into("<q", data, table.start + 4, length)
        with pytest.raises(InputError, match="claims"):
            scan(bytes(data))


def test_endless_rows_of_empty_chunks_are_refused() -> None:
    row = struct.pack("<Iq", 0x1, 0) * 100_000
    with pytest.raises(InputError, match="more than 4096"):
        scan(MAGIC + b"      80" + row)


POINTER = b"version https://git-lfs.github.com/spec/v1\noid sha256:" + b"4d" * 32 + b"\nsize 12345\n"
"""What a clone without Git LFS holds in a file's place (git-lfs, docs/spec.md)."""


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (b"", "empty"),
        (b"hello, a text file", "not a .3dm file"),
        (POINTER, "is a Git LFS pointer, not the file itself"),
        (MAGIC[:10], "header is cut"),
        (MAGIC + b"  seven ", "no version"),
        (MAGIC + b"       1" + bytes(100), "version 1"),
        (MAGIC + b"      80", "end mark is missing"),
    ],
)
def test_what_is_no_archive_is_named(data: bytes, words: str) -> None:
    with pytest.raises(InputError, match=words) as caught:
        scan(data, "model.3dm")
    assert caught.value.pointer == "model.3dm"


def test_small_damage_is_noted(make: Callable[..., Path]) -> None:
    data = make(7).read_bytes()
    archive = scan(data)
    assert "after the end mark" in scan(data + b"tail").notes[0]
    assert "end mark states" in scan(data[: archive.end_mark.body] + bytes(8)).notes[0]
    at = data.index(archive.objects[0].class_id.bytes_le, archive.objects[0].start)
    assert "checksum" in scan(data[:at] + b"\xff" + data[at + 1 :]).notes[0]


def test_a_second_object_table_is_refused(make: Callable[..., Path]) -> None:
    data = make(7).read_bytes()
    table = scan(data).table(OBJECT_TABLE)
    assert table is not None
    with pytest.raises(InputError, match="2 object tables"):
        scan(data[: table.end] + data[table.start :])
    with pytest.raises(InputError, match="0 object tables"):
        scan(data[: table.start] + data[table.end :])
