"""docs/canvas.md: what it prints is what comes out."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from typer.testing import CliRunner

from canvas.test_lint import add_object, add_port, add_script, at, guid
from hookean.cli import app
from hookean_canvas import archive
from hookean_canvas.archive import Chunk, Type, guids
from hookean_canvas.archive import chunk as archive_chunk

PAGE = (Path(__file__).parents[2] / "docs" / "canvas.md").read_text(encoding="utf-8")


def test_the_tree_of_the_page_is_what_show_prints(tmp_path: Path) -> None:
    root = Chunk("Root")
    definition = root.add("Definition").put("plugin_version", Type.VERSION, (1, 0, 8))
    objects = definition.add("DefinitionObjects")
    slider = add_object(objects, guids.NUMBER_SLIDER, "Number Slider", 1).put("SourceCount", Type.INT32, 0)
    slider.put("NickName", Type.STRING, "Span [m]").add("Slider").put("Value", Type.DOUBLE, 10.0).put(
        "Min", Type.DOUBLE, 1.0
    ).put("Max", Type.DOUBLE, 20.0)
    script = add_object(objects, guids.PYTHON3_SCRIPT, "Python 3 Script", 2).put("NickName", Type.STRING, "Double")
    data = script.add("ParameterData")
    add_port(data, "Input", "x", 3, 1)
    add_port(data, "Output", "a", 4).put("TypeHintID", Type.GUID, guids.HINTS["none"])
    add_script(script, "a = 2 * x")
    panel = add_object(objects, guids.PANEL, "Panel", 5).put("SourceCount", Type.INT32, 1)
    panel.put("Source", Type.GUID, guid(4), 0)
    archive.write(root, tmp_path / "arch.ghx")
    (tree,) = re.findall(r"```\n(arch\.ghx.*?)```", PAGE, re.S)
    assert CliRunner().invoke(app, ["canvas", "show", str(tmp_path / "arch.ghx")]).output == tree


def test_the_python_of_the_page_runs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (code,) = [code for code in re.findall(r"```python\n(.*?)```", PAGE, re.S) if "import archive\n" in code]
    monkeypatch.chdir(tmp_path)
    exec(compile(code, "docs/canvas.md", "exec"), {})
    assert capsys.readouterr().out == "Shaded\n"
    assert at(archive.read(tmp_path / "form.ghx"), "Definition", "DocumentHeader")


def test_the_limits_of_the_page_are_those_of_the_reader() -> None:
    page = PAGE.replace("\n", " ")
    assert f"one of {len(Type)} types" in page
    assert f"nested more than {archive_chunk.DEEPEST} deep" in page
    assert f"more than {archive_chunk.MOST_BYTES >> 20} MiB" in page
    assert f"more than {archive_chunk.MOST_PARTS // 10**6} million parts" in page
