"""`hookean canvas convert`: the other form of an archive holds the same, and what differs is found and named."""

from __future__ import annotations

import struct
from pathlib import Path
from typing import Any
from uuid import UUID

import pytest
from hypothesis import given
from hypothesis import strategies as st
from typer.testing import CliRunner

from canvas.archives import SHARED, XML_TEXT, chunks
from hookean_canvas import archive
from hookean_canvas.archive import Chunk, Type
from hookean_canvas.archive.compare import difference
from hookean_canvas.command import app
from hookean_canvas.kangaroo.streams import copied

ROOT = Path(__file__).parents[2]
REAL = sorted([*SHARED.glob("*.gh"), *SHARED.glob("*.ghx"), *SHARED.glob("*.ghuser")])
OURS = sorted((ROOT / "gh_examples").glob("*/definition.gh"))
shell = CliRunner()


def run(*words: Any) -> tuple[int, str]:
    """The exit code and all that is printed."""
    found = shell.invoke(app, ["convert", *map(str, words)])
    return found.exit_code, found.stdout + found.stderr


def there_and_back(file: Path, folder: Path) -> None:
    """Both ways through XML; what is binary again unpacks to the same bytes."""
    text, binary = folder / "there.ghx", folder / "back.gh"
    assert run(file, text)[0] == run(text, binary)[0] == 0
    for one, other in ((file, text), (text, binary), (file, binary)):
        assert run(one, other, "--check") == (0, f"{one} and {other} hold the same\n")
    assert archive.read(binary) == archive.read(file)


@pytest.mark.skipif(not REAL, reason=f"no files of Grasshopper's own in {SHARED}")
def test_files_that_grasshopper_saved_are_converted_both_ways(tmp_path: Path) -> None:
    for file in REAL:
        there_and_back(file, tmp_path)


@pytest.mark.soak
def test_definitions_of_the_figures_are_converted_both_ways(tmp_path: Path) -> None:
    read = [file for file in OURS if not file.read_bytes().startswith(b"version https://git-lfs")]
    if not read:
        pytest.skip("the definitions are Git LFS pointers here")
    for file in read[:3]:
        there_and_back(file, tmp_path)


@pytest.mark.soak
@given(chunks(XML_TEXT))
def test_any_archive_is_like_its_own_copy_and_its_binary_form(root: Chunk) -> None:
    assert difference(root, copied(root)) is None
    assert difference(root, archive.of_bytes(archive.to_bytes(root))) is None


@given(chunks(XML_TEXT), st.data())
def test_whatever_is_changed_is_found(root: Chunk, data: st.DataObject) -> None:
    """An item or chunk that is gone, and a number with another last bit."""
    other = copied(root)
    held = [chunk for chunk in other.walk() if chunk.items or chunk.chunks]
    if not held:
        return
    chunk = data.draw(st.sampled_from(held))
    part = data.draw(st.sampled_from([*chunk.items, *chunk.chunks]))
    if isinstance(part, Chunk):
        chunk.chunks = [one for one in chunk.chunks if one is not part]
    elif part.type == Type.DOUBLE:
        [bits] = struct.unpack("<q", struct.pack("<d", part.value))
        [changed] = struct.unpack("<d", struct.pack("<q", bits ^ 1))
        if repr(changed) == repr(part.value):
            return  # one that is not a number is like another
        part.value = changed
    else:
        chunk.items = [one for one in chunk.items if one is not part]
    assert difference(root, other) is not None and difference(other, root) is not None


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (
            lambda o: o.put("Name", Type.STRING, "other"),
            "Root/Object[0]/Name: 'one' in the first, 'other' in the second",
        ),
        (lambda o: o.put("Name", Type.INT32, 1), "Root/Object[0]/Name: gh_string in the first, gh_int32 in the second"),
        (lambda o: o.put("Size", Type.DOUBLE, -0.0), "Root/Object[0]/Size: 0.0 in the first, -0.0 in the second"),
        (lambda o: o.put("More", Type.BOOL, True), "Root/Object[0]/More: missing in the first"),
        (lambda o: o.items.clear(), "Root/Object[0]/Id: missing in the second"),
        (lambda o: o.add("Inner"), "Root/Object[0]: 0 chunks in the first, 1 in the second"),
        (lambda o: setattr(o, "index", 3), "Root/Object[0]: Object[0] in the first, Object[3] in the second"),
    ],
)
def test_the_first_difference_is_named_with_its_place(change: Any, says: str, tmp_path: Path) -> None:
    root = Chunk("Root")
    thing = root.add("Object", 0).put("Name", Type.STRING, "one").put("Size", Type.DOUBLE, 0.0)
    thing.put("Id", Type.GUID, UUID(int=1))
    other = copied(root)
    change(other.chunks[0])
    archive.write(root, tmp_path / "one.gh")
    archive.write(other, tmp_path / "other.ghx")
    code, said = run(tmp_path / "one.gh", tmp_path / "other.ghx", "--check")
    assert code == 1 and said.startswith("the first difference is at ") and said.count("\n") == 1
    assert says.lower() in said.lower()


def test_files_that_cannot_be_converted_are_refused_in_one_sentence(tmp_path: Path) -> None:
    archive.write(Chunk("Root"), tmp_path / "one.gh")
    (tmp_path / "words.gh").write_text("no archive")
    for words, said in [
        ((tmp_path / "one.gh", tmp_path / "one.gh"), "is the input file"),
        ((tmp_path / "one.gh", tmp_path / "one.txt"), "end in .gh"),
        ((tmp_path / "none.gh", tmp_path / "two.ghx"), "cannot be read"),
        ((tmp_path / "words.gh", tmp_path / "two.ghx"), "words.gh"),
        ((tmp_path / "one.gh", tmp_path / "none.ghx", "--check"), "cannot be read"),
    ]:
        code, text = run(*words)
        assert code == 2 and said in text and text.count("\n") == 1
