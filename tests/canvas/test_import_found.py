"""Real definitions, in a folder that HOOKEAN_DEFINITIONS names: each is read by every command and translated.

Public ones are github.com/naysok/Study-Kangaroo, Tensegrity-1.ghx, Tensegrity-2.ghx and Kangaroo1-vs-Kangaroo2.ghx
(classic), Tensile-Simple.ghx, Bending-Rod.ghx and 5/Inflation.ghx (Kangaroo 2). They carry no licence, so none is kept
here.
"""

from __future__ import annotations

import os
from collections import Counter
from pathlib import Path

import pytest

from canvas.kangaroo_samples import wires
from canvas.test_import import overlapping
from hookean.errors import InputError
from hookean_canvas import archive
from hookean_canvas.archive import Chunk
from hookean_canvas.archive.parts import parts
from hookean_canvas.inspect import drawing, lint, lint_refused
from hookean_canvas.inspect.describe import describe
from hookean_canvas.inspect.show import lines, text
from hookean_canvas.kangaroo import translate as kangaroo
from hookean_canvas.kangaroo.ids import Known, libraries, recognised
from hookean_canvas.run import graph
from hookean_canvas.run.evaluate import Canvas

FOLDER = os.environ.get("HOOKEAN_DEFINITIONS", "")
FILES = sorted([*Path(FOLDER).glob("*.gh"), *Path(FOLDER).glob("*.ghx")]) if FOLDER else []

if not FILES:
    pytest.skip("HOOKEAN_DEFINITIONS names no folder with .gh or .ghx files", allow_module_level=True)


def of_kangaroo(root: Chunk) -> Counter[str]:
    """Names of components of Kangaroo, with how often they stand in a definition."""
    definition = root.chunk("Definition")
    assert definition is not None
    found: list[Known | None] = [recognised(part.chunk, libraries(definition)) for part in parts(root)]
    return Counter(known.name for known in found if known)


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.name)
def test_a_real_definition_is_translated_without_a_fault_or_a_wire_lost_unseen(file: Path, tmp_path: Path) -> None:
    before = archive.read(file)
    target, report = kangaroo.import_file(file, tmp_path / "translated.ghx")
    after = archive.read(target)
    print(report.text())
    assert set(lint.faults(after)) <= set(lint.faults(before)) or lint.faults(after) == []
    assert report.wires == len(wires(before)) == report.kept + len(report.lost) + len(report.idle)
    assert {part.id for part in parts(before)} <= {part.id for part in parts(after)} | {None} | _shown(before)
    assert overlapping(before, after) == []
    was, stays = of_kangaroo(before), of_kangaroo(after)
    assert sum(was.values()) == report.kangaroo == len(report.swapped) + sum(stays.values())
    told = Counter(what.split(" (")[0] for what, _ in report.stays)
    assert all(told[name] == count for name, count in stays.items()), (stays, report.stays)


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.name)
def test_a_real_definition_is_drawn_shown_and_not_refused(file: Path, tmp_path: Path) -> None:
    """Grasshopper saved it, so Grasshopper opens it."""
    root = archive.read(file)
    assert lint_refused.refusals(root) == []
    text(lines(describe(root), file.name, with_code=True))
    try:
        drawing.draw(graph.read(file), tmp_path / "canvas.png")
        Canvas(graph.read(file))
    except InputError as error:
        assert "\n" not in str(error)


def _shown(root: Chunk) -> set[object]:
    """Components Show and Grab become parameters, which go by the id of their output."""
    return {part.id for part in parts(root) if part.name in ("Show", "Grab")}
