"""Damaged, cut, oversized and hostile archives: one sentence each, never another exception, never a wrong value."""

from __future__ import annotations

import struct
import tracemalloc
import zlib
from pathlib import Path

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from hookean.errors import InputError
from hookean_canvas import archive
from hookean_canvas.archive import Chunk, Type
from hookean_canvas.archive.binary import deflate, of_plain, to_plain
from hookean_canvas.archive.chunk import DEEPEST
from soak import SOAK

CASES = 3000 if SOAK else 150


def sample() -> Chunk:
    """A little of everything."""
    root = Chunk("Root").put("ArchiveVersion", Type.VERSION, (0, 2, 2))
    inner = root.add("Object", 0).put("Name", Type.STRING, "Panel").put("Icon", Type.BYTEARRAY, b"1234")
    inner.put("Colour", Type.DRAWING_COLOR, (255, 1, 2, 3)).put("On", Type.BOOL, True).put(
        "Values", Type.DOUBLEARRAY, (1.0,)
    )
    return root


def one_sentence(error: InputError, name: str = "archive") -> bool:
    text = str(error)
    return text.startswith(f"{name}: ") and text.endswith(".") and "\n" not in text and len(text) < 400


# ----------------------------------------------------------------------------------------------------------- binary


def test_every_cut_of_an_archive_is_refused() -> None:
    plain, packed = to_plain(sample()), archive.to_bytes(sample())
    for end in range(len(plain)):
        with pytest.raises(InputError) as raised:
            of_plain(plain[:end])
        assert one_sentence(raised.value)
    for end in range(len(packed)):
        with pytest.raises(InputError, match=r"it ends after|damaged") as raised:
            archive.of_bytes(packed[:end])
        assert one_sentence(raised.value)


def test_what_follows_an_archive_is_not_dropped_in_silence() -> None:
    with pytest.raises(InputError, match="3 bytes follow the last chunk"):
        of_plain(to_plain(sample()) + b"abc")
    with pytest.raises(InputError, match="has 3 bytes after the end"):
        archive.of_bytes(archive.to_bytes(sample()) + b"abc")


@settings(max_examples=CASES, deadline=None)
@given(st.data())
def test_a_changed_byte_is_refused_or_comes_back_as_it_is(data: st.DataObject) -> None:
    """Whatever is changed: an InputError, or an archive that is written as just these bytes (once sorted)."""
    plain = bytearray(to_plain(sample()))
    place = data.draw(st.integers(0, len(plain) - 1))
    plain[place] = data.draw(st.integers(0, 255))
    try:
        read = of_plain(bytes(plain))
    except InputError as error:
        assert one_sentence(error)
    else:
        assert sorted(to_plain(read)) == sorted(plain)


@settings(max_examples=CASES, deadline=None)
@given(st.binary(max_size=200))
@example(b"\x01\n\0\0\0\0")  # a name that would break the line of the error
def test_any_bytes_are_an_archive_or_an_input_error(data: bytes) -> None:
    for read in (of_plain, archive.of_bytes, archive.of_xml, lambda data: archive.of_bytes(deflate(data))):
        try:
            read(data)
        except InputError as error:
            assert one_sentence(error)


DAMAGE = [
    (b"\x01C" + struct.pack("<iii", -1, 2**31 - 1, 0), "2147483647 items and 0 chunks are announced"),
    (b"\x01C" + struct.pack("<iii", -1, 0, -1), "0 items and -1 chunks are announced"),
    (b"\x01C" + struct.pack("<iii", -1, 1, 0) + b"\x01n" + struct.pack("<iii", -1, 99, 0), "type code 99 is unknown"),
    (b"\x01C" + struct.pack("<iii", -1, 1, 0) + b"\x01n" + struct.pack("<ii", -1, 1) + b"\x07", "stored as 7"),
    (b"\x01C" + struct.pack("<iii", -1, 1, 0) + b"\x01n" + struct.pack("<iii", -1, 20, -5), "-5 bytes are expected"),
    (b"\x01C" + struct.pack("<iii", -1, 1, 0) + b"\x01n" + struct.pack("<iii", -1, 21, 2**28), "bytes are expected"),
    (
        b"\x01C" + struct.pack("<iii", -1, 1, 0) + b"\x01n" + struct.pack("<ii4i", -1, 7, 0, 0, 0, 1),
        "has the flags 0x1",
    ),
    (b"\x02\xff\xfe" + struct.pack("<iii", -1, 0, 0), "is not UTF-8"),
    (b"\xff\xff\xff\xff\xff\x01" + bytes(20), "length has no end"),
    (
        b"\x01C" + struct.pack("<iii", -1, 2, 0) + 2 * (b"\x01n" + struct.pack("<ii", 3, 1) + b"\x01"),
        r"damaged at C/n\[3\], byte \d+: the item occurs twice",
    ),
]


@pytest.mark.parametrize(("plain", "says"), DAMAGE, ids=lambda x: x if isinstance(x, str) else "")
def test_damage_is_named_with_its_place(plain: bytes, says: str) -> None:
    with pytest.raises(InputError, match=says) as raised:
        archive.of_bytes(deflate(plain), "form.gh")
    assert one_sentence(raised.value, "form.gh")


def test_a_deflate_bomb_is_refused_before_it_fills_the_memory() -> None:
    """200 MB of nothing in 200 kB: refused at the limit, with little more memory than the limit."""
    packer = zlib.compressobj(9, zlib.DEFLATED, -15)
    bomb = b"".join(packer.compress(bytes(2**20)) for _ in range(200)) + packer.flush()
    tracemalloc.start()
    with pytest.raises(InputError, match="unpacks to more than the 1000000 bytes allowed"):
        archive.of_bytes(bomb, limit=1_000_000)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 5_000_000


def test_nesting_ends_somewhere_in_both_directions() -> None:
    def nested(depth: int) -> Chunk:
        chunk = Chunk("0")
        for level in range(1, depth):
            chunk = Chunk(str(level), chunks=[chunk])
        return chunk

    deep = nested(DEEPEST)
    assert archive.of_bytes(archive.to_bytes(deep)) == deep == archive.of_xml(archive.to_xml(deep))
    for write in (archive.to_bytes, archive.to_xml):
        with pytest.raises(InputError, match=f"chunks are nested more than {DEEPEST} deep"):
            write(nested(DEEPEST + 1))
    level = b"\x01C" + struct.pack("<iii", -1, 0, 1)
    with pytest.raises(InputError, match=f"chunks are nested more than {DEEPEST} deep"):
        of_plain(level * 5000 + b"\x01C" + struct.pack("<iii", -1, 0, 0))


@pytest.mark.parametrize(
    ("name", "says"), [("", "cannot be read"), ("none.gh", "No such file"), ("empty.gh", "is empty")]
)
def test_what_is_no_file_is_said(tmp_path: Path, name: str, says: str) -> None:
    (tmp_path / "empty.gh").touch()
    with pytest.raises(InputError, match=says):
        archive.read(tmp_path / name)


def test_a_file_beyond_the_limit_is_refused(tmp_path: Path) -> None:
    for name in ("a.gh", "a.ghx"):
        archive.write(sample(), tmp_path / name)
        with pytest.raises(InputError, match="bytes allowed"):
            archive.read(tmp_path / name, limit=100)


# -------------------------------------------------------------------------------------------------------------- XML

ITEM = '<Archive name="Root"><items count="1"><item name="n" type_name="x" {0}>{1}</item></items></Archive>'
LAUGHS = '<!DOCTYPE a [<!ENTITY a "ha"><!ENTITY b "&a;&a;&a;&a;">]><Archive name="&b;"/>'
FOREIGN = '<!DOCTYPE a SYSTEM "file:///etc/passwd"><Archive name="Root"/>'

HOSTILE = [
    (LAUGHS, "declares a document type"),
    (FOREIGN, "declares a document type"),
    ('<Archive name="&a;"/>', "no sound XML: undefined entity"),
    ('<Archive name="Root">', "no sound XML: no element found"),
    ('<?xml version="1.0" encoding="nonsense"?><Archive name="Root"/>', "no sound XML: unknown encoding"),
    ('<svg name="Root"/>', "no Grasshopper archive: it starts with <svg>"),
    ('<Archive name="Root"><a/></Archive>', "damaged at Root: <a> is neither <items> nor <chunks>"),
    ('<Archive name="Root"><items><chunk/></items></Archive>', "damaged at Root: <chunk> stands in <items>"),
    (ITEM.format('type_code="3"', "7").replace('name="n"', 'name="n" index="x"'), "the index 'x' is no 32-bit whole"),
    (ITEM.format("", "7"), "damaged at Root/n: type code '' is unknown to GH_IO"),
    (ITEM.format('type_code="98"', "7"), "type code '98' is unknown"),
    (ITEM.format('type_code="6"', "2,5"), "'2,5' is no gh_double"),
    (ITEM.format('type_code="6"', "nan"), "'nan' is no gh_double"),
    (ITEM.format('type_code="6"', "1_0"), "'1_0' is no gh_double"),
    (ITEM.format('type_code="3"', "2.5"), "'2.5' is no gh_int32"),
    (ITEM.format('type_code="3"', "2147483648"), "is no gh_int32"),
    (ITEM.format('type_code="1"', "maybe"), "'maybe' is no gh_bool"),
    (ITEM.format('type_code="9"', "123"), "'123' is no gh_guid"),
    (ITEM.format('type_code="7"', "1e400"), "'1e400' is no gh_decimal"),
    (ITEM.format('type_code="20"', "<stream>!!</stream>"), "'!!' is no gh_bytearray"),
    (ITEM.format('type_code="21"', "<stream>AAAA</stream>"), "'AAAA' is no gh_doublearray"),
    (ITEM.format('type_code="36"', "<ARGB>1;2;3</ARGB>"), "'1;2;3' is no gh_drawing_color"),
    (ITEM.format('type_code="51"', "<X>1</X><Y>2</Y>"), "'12' is no gh_point3d"),
    (
        '<Archive name="Root"><items>' + 2 * '<item name="n" type_code="3">1</item>' + "</items></Archive>",
        "damaged at Root/n: the item occurs twice in its chunk",
    ),
    ("<Archive>" + 5000 * "<chunks><chunk>" + 5000 * "</chunk></chunks>" + "</Archive>", "elements lie more than"),
]


@pytest.mark.parametrize(("text", "says"), HOSTILE, ids=lambda x: x[:40])
def test_hostile_and_damaged_xml_is_refused(text: str, says: str) -> None:
    with pytest.raises(InputError, match=says) as raised:
        archive.of_xml(text, "form.ghx")
    assert one_sentence(raised.value, "form.ghx")


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "latin-1"])
def test_xml_is_read_in_the_encoding_it_declares(tmp_path: Path, encoding: str) -> None:
    """With or without a byte order mark, wrong counts and missing type names as Grasshopper's reader allows them."""
    text = (
        '<?xml version="1.0" encoding="{0}"?>\n<!--note-->\n<Archive name="Root"><items count="7">{1}</items></Archive>'
    )
    item = '<item name="Größe" type_code="10">weiß</item>'
    (tmp_path / "a.ghx").write_bytes(text.format(encoding.removesuffix("-sig"), item).encode(encoding))
    assert archive.read(tmp_path / "a.ghx") == Chunk("Root").put("Größe", Type.STRING, "weiß")


def test_xml_is_read_as_grasshopper_lays_it_out() -> None:
    """Comments with a bare ampersand, values of several numbers and streams over several lines."""
    text = """<?xml version="1.0" encoding="utf-8" standalone="yes"?>
<Archive name="Root">
  <!--Grasshopper archive-->
  <!--this & that-->
  <items count="3">
    <item name="ArchiveVersion" type_name="gh_version" type_code="80">
      <Major>0</Major>
      <Minor>2</Minor>
      <Revision>2</Revision>
    </item>
    <item name="Empty" type_name="gh_string" type_code="10"></item>
    <item name="Icon" type_name="gh_drawing_bitmap" type_code="37">
      <bitmap length="3">AA
        EC</bitmap>
    </item>
  </items>
  <chunks count="1">
    <chunk name="Object" index="0" />
  </chunks>
</Archive>
"""
    expected = Chunk("Root").put("ArchiveVersion", Type.VERSION, (0, 2, 2)).put("Empty", Type.STRING, "")
    expected.put("Icon", Type.DRAWING_BITMAP, b"\x00\x01\x02").add("Object", 0)
    assert archive.of_xml(text) == archive.of_xml(text.replace("\n", "\r\n")) == expected


@settings(max_examples=CASES, deadline=None)
@given(st.data())
def test_xml_with_a_piece_missing_is_read_or_refused(data: st.DataObject) -> None:
    text = archive.to_xml(sample())
    start = data.draw(st.integers(0, len(text)))
    end = data.draw(st.integers(start, min(len(text), start + 30)))
    try:
        archive.of_xml(text[:start] + text[end:])
    except InputError as error:
        assert one_sentence(error)
