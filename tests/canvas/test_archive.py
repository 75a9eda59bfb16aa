"""Archives: the layout byte by byte, real files unchanged by reading and writing, any archive there and back."""

from __future__ import annotations

import math
import struct
import uuid
from decimal import Decimal
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from canvas.archives import PACKAGES, TEXT, XML_TEXT, chunks, samples, user_objects
from hookean.errors import InputError
from hookean_canvas import archive
from hookean_canvas.archive import Chunk, Item, Type
from hookean_canvas.archive.binary import inflate, of_plain, to_plain
from soak import SOAK

CASES = 1000 if SOAK else 20
ID = uuid.UUID("00112233-4455-6677-8899-aabbccddeeff")


def unchanged(chunk: Chunk, plain: bytes) -> bool:
    """Whether an archive comes back as these bytes, directly and by way of XML."""
    return to_plain(chunk) == plain == to_plain(archive.of_xml(archive.to_xml(chunk)))


# -------------------------------------------------------------------------------------------------------- real files


@pytest.mark.thinned
@pytest.mark.parametrize("package", PACKAGES)
def test_installed_user_objects_come_back_byte_for_byte(package: str) -> None:
    """Each .ghuser, and the object packed in it: read and written, binary and by way of XML, the same bytes."""
    files = user_objects(package)
    assert len(files) >= PACKAGES[package]
    for file in files:
        root = archive.read(file)
        assert unchanged(root, inflate(file.read_bytes())), file.name
        packed = root.value("Object")
        assert unchanged(archive.of_bytes(packed), inflate(packed)), f"the object in {file.name}"


def test_shared_definitions_come_back_byte_for_byte() -> None:
    for file in samples():
        root = archive.read(file)
        assert unchanged(root, inflate(file.read_bytes())), file.name


def test_a_file_is_written_by_its_suffix_and_read_by_its_content(tmp_path: Path) -> None:
    root = Chunk("Root").put("Text", Type.STRING, "Größe\r\nfilm")
    for name in ("a.gh", "a.ghx", "a.ghuser", "A.GHX"):
        archive.write(root, tmp_path / name)
        assert archive.read(tmp_path / name) == root
    assert (tmp_path / "a.ghx").read_bytes().startswith(b"<?xml")
    (tmp_path / "a.ghx").rename(tmp_path / "b.gh")
    assert archive.read(tmp_path / "b.gh") == root
    with pytest.raises(InputError, match=r"ends in '.txt'; Grasshopper archives end in .gh, .ghx or .ghuser"):
        archive.write(root, tmp_path / "a.txt")


# ------------------------------------------------------------------------------------------------------- the layout

LAYOUT = [
    (Type.BOOL, True, "01", "true"),
    (Type.BYTE, 200, "c8", "200"),
    (Type.INT32, -2, "feffffff", "-2"),
    (Type.INT64, 2**40, "0000000000010000", "1099511627776"),
    (Type.SINGLE, 0.10000000149011612, "cdcccc3d", "0.1"),
    (Type.DOUBLE, 1e-20, struct.pack("<d", 1e-20).hex(), "1E-20"),
    (Type.DOUBLE, 5.0, "0000000000001440", "5"),
    (Type.DOUBLE, math.inf, "000000000000f07f", "INF"),
    (Type.DOUBLE, -math.inf, "000000000000f0ff", "-INF"),
    (Type.DOUBLE, math.nan, "000000000000f87f", "NaN"),
    (Type.DECIMAL, Decimal("-1.50"), "96000000" + "00" * 8 + "00000280", "-1.50"),
    (Type.DATE, 637504888010964201, struct.pack("<q", 637504888010964201).hex(), "637504888010964201"),
    (Type.GUID, ID, "33221100554477668899aabbccddeeff", "00112233-4455-6677-8899-aabbccddeeff"),
    (Type.STRING, "é<&", "04c3a93c26", "é&lt;&amp;"),
    (Type.BYTEARRAY, b"\x00\x01\x02", "03000000000102", '<stream length="3">AAEC</stream>'),
    (Type.DOUBLEARRAY, (1.0,), "01000000000000000000f03f", '<stream length="8">AAAAAAAA8D8=</stream>'),
    (Type.DRAWING_POINT, (1, -1), "01000000ffffffff", "<X>1</X><Y>-1</Y>"),
    (Type.DRAWING_SIZEF, (1.0, 0.5), "0000803f0000003f", "<W>1</W><H>0.5</H>"),
    (Type.DRAWING_RECTANGLE, (1, 2, 3, 4), "01000000020000000300000004000000", "<X>1</X><Y>2</Y><W>3</W><H>4</H>"),
    (Type.DRAWING_COLOR, (255, 1, 2, 3), "030201ff", "<ARGB>255;1;2;3</ARGB>"),
    (Type.DRAWING_BITMAP, b"\xff", "01000000ff", '<bitmap length="1">/w==</bitmap>'),
    (Type.POINT2D, (0.0, 1.0), "00" * 8 + "000000000000f03f", "<X>0</X><Y>1</Y>"),
    (Type.INTERVAL1D, (0.0, 1.0), "00" * 8 + "000000000000f03f", "<A>0</A><B>1</B>"),
    (Type.PLANE, (0.0,) * 9, "00" * 72, "".join(f"<{a}{b}>0</{a}{b}>" for a in "OXY" for b in "xyz")),
    (Type.VERSION, (0, 2, 2), "000000000200000002000000", "<Major>0</Major><Minor>2</Minor><Revision>2</Revision>"),
]


@pytest.mark.parametrize(("type", "value", "packed", "body"), LAYOUT, ids=lambda x: str(x)[:20])
def test_each_type_has_its_place_in_both_forms(type: Type, value: object, packed: str, body: str) -> None:
    """As GH_IO writes them: little-endian numbers, .NET's order of an id's bytes, colours blue first."""
    chunk = Chunk("C", items=[Item("n", -1, type, value)])
    head = b"\x01C" + struct.pack("<iii", -1, 1, 0) + b"\x01n" + struct.pack("<ii", -1, type)
    assert to_plain(chunk).hex() == head.hex() + packed
    line = f'<item name="n" type_name="{type.label}" type_code="{int(type)}">{body}</item>'
    assert line in archive.to_xml(chunk).decode()


def test_a_long_name_has_its_length_in_groups_of_seven_bits() -> None:
    plain = to_plain(Chunk("x" * 300))
    assert plain[:2] == bytes([300 & 127 | 128, 300 >> 7])
    assert of_plain(plain).name == "x" * 300


def test_items_are_sorted_as_dotnet_sorts_them_whatever_the_order_they_came_in() -> None:
    """By UTF-16 code units, so a character beyond the first 65536 comes before U+E000, then by index, -1 first."""
    order = ["A 1", "A1", "A_1", "B", "Z", "_z", "a", "b", "\U0001f600", "\ue000"]
    chunk = Chunk("Root")
    for name in reversed(order):
        chunk.items.append(Item(name, -1, Type.INT32, 0))
    chunk.items += [Item("a", index, Type.INT32, 0) for index in (10, 2, 0)]
    for back in (archive.of_bytes(archive.to_bytes(chunk)), archive.of_xml(archive.to_xml(chunk))):
        keys = [(item.name, item.index) for item in back.items]
        assert keys == [(name, index) for name in order for index in ((-1, 0, 2, 10) if name == "a" else (-1,))]
    put = Chunk("Root")
    for item in chunk.items:
        put.put(item.name, item.type, item.value, item.index)
    assert put.items == back.items


# ------------------------------------------------------------------------------------------------------ any archive


@pytest.mark.soak
@settings(max_examples=CASES, deadline=None)
@given(chunks(TEXT))
def test_any_archive_comes_back_from_binary(chunk: Chunk) -> None:
    back = archive.of_bytes(archive.to_bytes(chunk))
    assert to_plain(back) == to_plain(chunk)
    assert [inner.label for inner in back.walk()] == [inner.label for inner in chunk.walk()]


@settings(max_examples=CASES, deadline=None)
@given(chunks(XML_TEXT))
def test_any_archive_comes_back_from_xml_as_the_same_bytes(chunk: Chunk) -> None:
    assert to_plain(archive.of_xml(archive.to_xml(chunk))) == to_plain(chunk)


@given(st.sampled_from("\x00\x01\x0b\x1f￾"), XML_TEXT)
def test_a_character_no_xml_may_hold_is_refused_with_its_place(character: str, text: str) -> None:
    chunk = Chunk("Root")
    chunk.add("Script", 3).put("Text", Type.STRING, text + character)
    with pytest.raises(InputError, match=r"^Root/Script\[3\]/Text: holds the character .* save as .gh"):
        archive.to_xml(chunk)


WRONG = [
    (Type.INT32, 2**31),
    (Type.INT32, "7"),
    (Type.BYTE, -1),
    (Type.BOOL, "yes"),
    (Type.BOOL, 2),
    (Type.SINGLE, 1e300),
    (Type.GUID, "00112233-4455-6677-8899-aabbccddeeff"),
    (Type.STRING, b"bytes"),
    (Type.BYTEARRAY, "text"),
    (Type.POINT3D, (1.0, 2.0)),
    (Type.DRAWING_COLOR, (256, 0, 0, 0)),
    (Type.DECIMAL, Decimal(2**96)),
    (Type.DECIMAL, Decimal("1E-29")),
    (Type.DECIMAL, Decimal("NaN")),
    (Type.VERSION, None),
]


@pytest.mark.parametrize(("type", "value"), WRONG, ids=str)
def test_a_value_not_of_its_type_is_refused_with_its_place(type: Type, value: object) -> None:
    chunk = Chunk("Root").put("Size", type, value, index=2)
    for write in (archive.to_bytes, archive.to_xml):
        with pytest.raises(InputError, match=rf"^Root/Size\[2\]: is .*, which is not a {type.label}\.$"):
            write(chunk)


# --------------------------------------------------------------------------------------------------------- the tools


def test_chunks_find_replace_and_refuse_what_stands_twice() -> None:
    root = Chunk("Root").put("Count", Type.INT32, 1).put("Count", Type.INT32, 2).put("Count", Type.INT32, 3, index=0)
    assert [root.value("Count"), root.value("Count", 0), root.value("Count", 1, "none")] == [2, 3, "none"]
    first = root.add("Object", 0)
    first.add("Container")
    root.add("Object", 1)
    assert root.chunk("Object", 0) is first and root.chunk("Object") is None
    assert [chunk.label for chunk in root.walk()] == ["Root", "Object[0]", "Container", "Object[1]"]
    with pytest.raises(ValueError, match=r"Root already has a chunk Object\[1\]"):
        root.add("Object", 1)
    root.items.append(Item("Count", 0, Type.INT32, 4))
    for write in (archive.to_bytes, archive.to_xml):
        with pytest.raises(InputError, match=r"^Root/Count\[0\]: occurs twice in its chunk"):
            write(root)
