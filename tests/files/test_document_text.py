"""The document text of a written file says how the run ended; all other text and every other table stays."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import rhino3dm as _rhino3dm
from typer.testing import CliRunner

from hookean.cli import app
from hookean.files.rhino.archive import LAYER_TABLE, OBJECT_TABLE, scan
from hookean.files.rhino.threedm import Additions, NewObject, read, write, write_new

from . import nested

rhino: Any = _rhino3dm
TEXT_TABLE = 0x10000017


def told(notes: Sequence[str]) -> dict[str, str]:
    return {"hookean:status": "converged", "hookean:message": "Grüße ∎", "hookean:warnings": "\n".join(notes)}


def kept(notes: Sequence[str]) -> dict[str, str]:
    """The same as Rhino keeps it: without what is empty."""
    return {key: value for key, value in told(notes).items() if value}


def tables(data: bytes) -> list[bytes]:
    """Every table but those that grow: layers, objects and document text."""
    others = [t for t in scan(data).tables if t.typecode not in (LAYER_TABLE, OBJECT_TABLE)]
    return [data[t.start : t.end] for t in others if b"h\0o\0o\0k\0e\0a\0n\0:\0" not in data[t.start : t.end]]


def rows(data: bytes) -> list[bytes]:
    return [data[record.start : record.end] for record in scan(data).objects]


@pytest.mark.thinned
@pytest.mark.parametrize("version", [4, 5, 6, 7, 8])
@pytest.mark.parametrize("own", [{}, {"author": "Ada ü", "part\\entry": "line\nline", "hookean:old": "gone"}])
def test_text_is_added_and_what_was_there_stays(
    version: int, own: dict[str, str], tmp_path: Path, additions: Additions
) -> None:
    """The text of an earlier run leaves, whatever it had; writing twice gives the same bytes as writing once."""
    file = nested.sample()
    for key, value in own.items():
        file.Strings[key] = value
    source, out, again = tmp_path / "in.3dm", tmp_path / "out.3dm", tmp_path / "again.3dm"
    source.write_bytes(nested.written(file, version))
    done = write(source, out, additions, told)
    others = {key: value for key, value in own.items() if not key.startswith("hookean:")}
    assert read(out).text == {**others, **kept(done.warnings)} == dict(rhino.File3dm.Read(str(out)).Strings)
    assert scan(out.read_bytes()).notes == ()
    write(out, again, additions, told)
    if version >= 5:
        assert rows(out.read_bytes())[:4] == rows(source.read_bytes())
        assert again.read_bytes() == out.read_bytes()
    else:
        assert read(again).text == read(out).text


@pytest.mark.thinned
def test_real_files_get_text_and_keep_their_tables(real: Path, tmp_path: Path, additions: Additions) -> None:
    out, plain = tmp_path / "out.3dm", tmp_path / "plain.3dm"
    before = read(real)
    done = write(real, out, additions, told)
    if before.version < 4:
        assert read(out).text == {} and any("and of the document is left out" in said for said in done.warnings)
        return
    assert read(out).text == {**before.text, **kept(done.warnings)}
    if before.version >= 50:
        assert tables(out.read_bytes()) == tables(real.read_bytes())
    write(real, plain, additions)
    assert read(plain).text == before.text


def test_without_text_the_table_of_text_stays_byte_for_byte(make: Callable[..., Path], tmp_path: Path) -> None:
    source, out = make(7), tmp_path / "out.3dm"
    write(source, out, Additions())

    def of(data: bytes) -> list[bytes]:
        return [data[t.start : t.end] for t in scan(data).tables if t.typecode == TEXT_TABLE]

    assert of(out.read_bytes()) == of(source.read_bytes()) != []


def test_the_command_writes_how_the_run_ended(tmp_path: Path) -> None:
    """Also where there is no equilibrium: exit code 3, and the file says so."""
    line = np.array([[0.0, 0, 0], [10, 0, 0]])
    source, out, recipe = tmp_path / "in.3dm", tmp_path / "out.3dm", tmp_path / "recipe.toml"
    write_new(source, Additions((), [NewObject(line, "cable", "main")]), own=False)
    text = (
        '[[forces]]\nkind = "springs"\nlines = "*"\ndivide = 5\n'
        '[[forces]]\nkind = "unary"\npoints = "inner:*"\nvector = [0, 0, -20]\n[[anchors]]\npoints = "ends:*"\n'
    )
    for more, code, status in (("", 0, "converged"), ("[settings]\nmax_iterations = 1\n", 3, "max_iterations")):
        recipe.write_text(text + more)
        assert CliRunner().invoke(app, ["relax", str(source), "-r", str(recipe), "-o", str(out)]).exit_code == code
        found = read(out).text
        assert found["hookean:status"] == status and found["hookean:message"].endswith(".")
        assert float(found["hookean:residual"]) >= 0.0 and found["hookean:out_of_balance"].endswith(" N")
