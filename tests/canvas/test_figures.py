"""The definitions of the figures as they are shipped: current, without faults, laid out, right in their numbers."""

from __future__ import annotations

import base64
import importlib.util
import os
import re
import shutil
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from canvas.canvasing import let_go
from hookean.commands.examples import examples
from hookean_canvas import archive
from hookean_canvas.components import inline
from hookean_canvas.inspect import lint
from hookean_canvas.run import graph
from hookean_canvas.run.checking import check
from hookean_canvas.run.graph import Node
from hookean_canvas.run.scripts import SCRIPTS, code_of
from serving import SOAK, Home
from soak import sampled

FIGURES = sorted(example.name for example in examples())
HERE = Path(__file__).parents[2] / "gh_examples"
RUN = FIGURES if SOAK else ["9.4-cable", "9.24-membrane"]


def shipped(figure: str) -> Path:
    return HERE / figure / "definition.gh"


@pytest.fixture(scope="module")
def home(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Home]:
    """A server of its own for the components, found by them as by any user's."""
    found = Home(tmp_path_factory.mktemp("home"))
    found.serve()
    before = {name: os.environ.get(name) for name in ("HOOKEAN_STATE", "HOOKEAN_PYTHON")}
    os.environ.update(HOOKEAN_STATE=str(found.folder), HOOKEAN_PYTHON=sys.executable)
    yield found
    let_go()
    for name, value in before.items():
        os.environ.pop(name) if value is None else os.environ.update({name: value})
    found.end()


def test_every_figure_has_a_definition() -> None:
    assert [figure for figure in FIGURES if not shipped(figure).is_file()] == []


@pytest.mark.thinned
@pytest.mark.parametrize("figure", sampled(FIGURES, 4))
def test_a_shipped_definition_is_what_its_module_writes_now(figure: str, tmp_path: Path) -> None:
    spec = importlib.util.spec_from_file_location("build_definitions", HERE / "build_definitions.py")
    assert spec is not None and spec.loader is not None
    builder = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(builder)
    builder.definition(figure).save(tmp_path / "definition.gh")
    same = without_client(tmp_path / "definition.gh") == without_client(shipped(figure))
    assert same, f"run `.venv/bin/python gh_examples/build_definitions.py {figure}`"


def test_shipped_definitions_carry_the_present_client() -> None:
    stamp = inline.stamp()
    old = [f for f in FIGURES if any(stamp not in code for code in codes(shipped(f)) if "def _hookean_client" in code)]
    assert old == [], "run `.venv/bin/python gh_examples/build_definitions.py`"


@pytest.mark.parametrize("figure", sampled(FIGURES, 4))
def test_a_shipped_definition_has_no_faults_and_stands_as_a_person_lays_it_out(figure: str) -> None:
    assert lint.faults(archive.read(shipped(figure))) == []
    found = graph.read(shipped(figure))
    boxes = [node for node in found.nodes if node.bounds]
    assert [(a.label, b.label) for i, a in enumerate(boxes) for b in boxes[:i] if overlap(a, b)] == []
    backwards = [(a.label, b.label) for a, _, b, _ in found.wires() if right(a) >= b.bounds[0]]  # type: ignore[index]
    assert backwards == []
    placed = {key for group in found.groups for key in group.members}
    wired = {node.id for a, _, b, _ in found.wires() for node in (a, b)}
    assert [node.label for node in found.nodes if node.id in wired - placed] == []  # all stands in a group with a title
    assert all(group.title for group in found.groups)


@pytest.mark.slow
@pytest.mark.parametrize("figure", RUN)
def test_the_canvas_gives_the_numbers_of_the_figure(figure: str, home: Home, tmp_path: Path) -> None:
    folder = tmp_path / figure
    shutil.copytree(HERE / figure, folder)
    checked = check(folder / "definition.gh", seconds=300.0)
    assert checked.compared and checked.faults == []


def test_another_slider_gives_other_numbers(home: Home, tmp_path: Path) -> None:
    shutil.copytree(HERE / "9.4-cable", tmp_path / "cable")
    checked = check(tmp_path / "cable" / "definition.gh", {"Load [N]": "-20"}, seconds=300.0)
    [lift] = checked.outcome.panels["lift of an anchor"].values_in_order()
    assert checked.faults == [] and abs(lift - 110.0) < 1e-6  # half of 11 loads of 20 N


def codes(path: Path) -> list[str]:
    """The code of every script in a definition."""
    return [code_of(node) or "" for node in graph.read(path).nodes if node.guid in SCRIPTS]


def without_client(path: Path) -> archive.Chunk:
    """A definition whose scripts do not carry the client."""
    root = archive.read(path)
    for chunk in root.walk():
        if chunk.name == "Script":
            code = base64.b64decode(chunk.value("Text")).decode("utf-8")
            code = re.sub(r'(?s)\ndef _hookean_client\(.*?\n"""\n\)\n', "", code)
            chunk.put("Text", archive.Type.STRING, re.sub(r"hookean_client_\w+", "hookean_client", code))
    return root


def overlap(a: Node, b: Node) -> bool:
    p, q = a.bounds, b.bounds
    assert p and q
    return p[0] < q[0] + q[2] and q[0] < p[0] + p[2] and p[1] < q[1] + q[3] and q[1] < p[1] + p[3]


def right(node: Node) -> float:
    assert node.bounds
    return node.bounds[0] + node.bounds[2]
