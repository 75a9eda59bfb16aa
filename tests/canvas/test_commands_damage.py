"""Damaged files through show, check, convert, draw and run: an answer or a sentence, never a traceback or a wait."""

from __future__ import annotations

import base64
import random
import zlib
from functools import cache
from pathlib import Path
from typing import Any

import pytest
import rhino3dm
from typer.testing import CliRunner

from canvas.test_import_damage import damaged
from canvas.test_stored import MESH, internalised, item
from hookean.errors import InputError
from hookean_canvas import archive
from hookean_canvas.archive import Type
from hookean_canvas.archive.binary import deflate, to_plain
from hookean_canvas.command import app
from hookean_canvas.definitions.write import Definition
from hookean_canvas.run import graph
from hookean_canvas.run.internalised import unreadable
from hookean_canvas.run.stored import Unread
from soak import SOAK

CASES = 300 if SOAK else 5
COMMANDS = {
    "show": ["show"],
    "show --all": ["show", "--all"], "show --json": ["show", "--json", "--code"], "check": ["check", "--strict"],
    "convert": ["convert"], "draw": ["draw", "-o"], "run": ["run", "--seconds", "2"],
}  # fmt: skip
shell = CliRunner()


class Held:
    """What encodes to given bytes."""

    def __init__(self, held: dict[str, Any]) -> None:
        self.held = held

    def Encode(self) -> dict[str, Any]:
        return self.held


def endless() -> bytes:
    """A line whose first length has a high byte that is 127: rhino3dm looks for 2 GB in its 141 bytes."""
    line = rhino3dm.LineCurve(rhino3dm.Point3d(0, 0, 0), rhino3dm.Point3d(1, 0, 0)).Encode()
    data = bytearray(base64.b64decode(line["data"]))
    data[11] = 127
    return internalised(Held({**line, "data": base64.b64encode(bytes(data)).decode("ascii")}))


def definition(*stored: bytes) -> Definition:
    """Numbers, panels, a script of Python and stored geometry."""
    d = Definition("damage", "Damage", "A definition that gets damaged.")
    mesh = d.parameter("Mesh", "Mesh")
    data = mesh.container.add("PersistentData").put("Count", Type.INT32, 1)
    branch = data.add("Branch", 0).put("Count", Type.INT32, len(stored)).put("Path", Type.STRING, "{0}")
    for i, held in enumerate(stored):
        chunk = item("ON_Data", Type.BYTEARRAY, held)
        chunk.index = i
        branch.chunks.append(chunk)
    number = d.slider("Number", 3, 0, 10)
    d.panel("vertices", d.native("Deconstruct Mesh", mesh=mesh)["Vertices"])
    d.panel("line", d.native("Line", start_point=d.point(0, 0, 0), end_point=d.point(number, 0, 0)))
    return d


@cache
def sound(form: str) -> bytes:
    root = definition(internalised(MESH)).archive()
    return {"xml": archive.to_xml, "packed": archive.to_bytes, "plain": to_plain}[form](root)


@pytest.mark.thinned
@pytest.mark.parametrize("command", COMMANDS)
@pytest.mark.parametrize("form", ["xml", "packed", "plain"])
def test_no_command_fails_on_damaged_files_but_in_sentences(
    command: str, form: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("HOOKEAN_TRUST", "0")
    source, target = tmp_path / ("form.ghx" if form == "xml" else "form.gh"), tmp_path / "made"
    words = COMMANDS[command]
    call = [*words[:1], *words[1:]] + ([str(target.with_suffix(".png"))] if "-o" in words else []) + [str(source)]
    call += [str(target.with_suffix(".ghx"))] if command == "convert" else []
    for seed in range(CASES):
        data = damaged(sound(form), random.Random(f"{command} {form} {seed}").randrange(2**32))
        source.write_bytes(deflate(data) if form == "plain" else data)
        found = shell.invoke(app, call)
        assert found.exception is None or isinstance(found.exception, SystemExit | InputError), (seed, found.exception)
        assert found.exit_code in (0, 1, 2) and "Traceback" not in found.output, (seed, found.output)


def test_geometry_that_keeps_rhino3dm_busy_is_left_out_with_a_sentence_and_the_rest_is_read(tmp_path: Path) -> None:
    path = tmp_path / "busy.gh"
    archive.write(definition(internalised(MESH), endless(), internalised(MESH)).archive(), path)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(graph, "unreadable", lambda objects: unreadable(objects, 1.0))
        found = graph.read(path)
    first, busy, last = next(node for node in found.nodes if node.name == "Mesh").inputs[0].data.values_in_order()  # type: ignore[union-attr]
    assert isinstance(busy, Unread) and busy.why.endswith("busy for more than 1 s; the file is damaged")
    assert len(first.Vertices) == len(last.Vertices) == len(MESH.Vertices)
    assert not unreadable([internalised(MESH), b"no geometry", zlib.compress(b"none")])


def test_geometry_is_not_decoded_where_nobody_needs_it(tmp_path: Path) -> None:
    """draw, show, check and convert of a file with such bytes end at once: nothing decodes them."""
    path = tmp_path / "busy.gh"
    archive.write(definition(endless()).archive(), path)
    for call in (["draw", str(path), "-o", str(tmp_path / "a.png")], ["show", str(path)], ["check", str(path)]):
        assert shell.invoke(app, call).exit_code == 0
