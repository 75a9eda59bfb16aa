"""No cell of a CSV file that hookean writes is a formula to a spreadsheet: CSV injection, as OWASP describes it."""

from __future__ import annotations

import ast
import csv
import io
import json
import re
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

import forking
from hookean import Scene, Simulation
from hookean.files import tables
from hookean.files.cells import cell, row

ROOT = Path(__file__).parents[2]
EVIL = [
    "=1+1",
    '=HYPERLINK("http://evil.example","x")',
    "+cmd|' /C calc'!A0",
    "-2+3",
    "@SUM(1)",
    "\t=1",
    "\r=1",
    "\n=1",
]
EVIL += ["\uff1d1", "\uff0b1+1", "\uff0d2+3", "\uff20SUM(1)", "-", "+", "--1", "-1-1", "+1e", "-1_0", "=", "-0x10"]
NUMBERS = ["-1", "+1", "-1.5", "-.5", "1e9", "-1E-9", "+2.", "0", "-inf", "nan", "-nan", "+1.5e+10"]


@pytest.mark.parametrize("text", EVIL)
def test_what_begins_like_a_formula_is_text(text: str) -> None:
    assert cell(text) == "'" + text and cell(cell(text)) == cell(text)


@pytest.mark.parametrize("text", [*NUMBERS, "", "cables", "a=b", " =1", "'=1", "1-2"])
def test_numbers_and_plain_text_stay(text: str) -> None:
    assert cell(text) == text


@pytest.mark.parametrize("value", [-1, -1.5, 0, None, True, float("-inf"), -1e300])
def test_what_is_no_text_stays(value: Any) -> None:
    assert cell(value) is value


@given(st.lists(st.one_of(st.text(), st.sampled_from(EVIL), st.floats(allow_nan=False), st.integers()), min_size=1))
def test_no_row_has_a_formula(values: list[Any]) -> None:
    """Written and read again by the csv module: a field begins like a formula only where it is a number."""
    out = io.StringIO()
    csv.writer(out).writerow(row(values))
    [found, *_] = csv.reader(io.StringIO(out.getvalue(), newline=""))
    for field in found:
        if field[:1] in set("=+-@\t\r\n\uff1d\uff0b\uff0d\uff20") - {""}:
            float(field)


@pytest.mark.slow
def test_every_writer_of_csv_writes_such_cells() -> None:
    """What is given to `writerow` and `writerows` anywhere in the sources is made by `cells.row`."""
    found = 0
    for top in ("core", "server", "canvas", "components"):
        for path in (ROOT / top).rglob("*.py"):
            text = path.read_text(encoding="utf-8")
            for node in ast.walk(ast.parse(text)) if re.search("writerow|DictWriter|to_csv|savetxt", text) else ():
                if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute):
                    if node.func.attr in ("writerow", "writerows"):
                        found += 1
                        assert ast.unparse(node.args[0]).lstrip("(").startswith("cells.row("), (path, node.lineno)
                    assert node.func.attr not in ("DictWriter", "to_csv", "savetxt"), (path, node.lineno)
    assert found >= 4


SCENE: dict[str, Any] = {
    "particles": [[0, 0, 0], [1, 0, 0], [2, 0, 0]],
    "forces": [
        {"kind": "springs", "name": "=1+1", "particles": [[0, 1], [1, 2]]},
        {"kind": "unary", "name": "@SUM(1)", "particles": [1], "vector": [0, 0, -9]},
    ],
    "anchors": [{"name": "-2+3", "particles": [0, 2]}],
}


@pytest.mark.slow
def test_tables_of_a_result_have_no_formulas(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """By Python and by the commands: names of forces and anchors come out as text, coordinates as numbers."""
    scene = Scene.model_validate(SCENE)
    simulation = Simulation(scene)
    result = simulation.relax()
    text = tables.csv_text(tables.rows(tables.sections(simulation.system, result), result))
    assert "'=1+1" in text
    file = tmp_path / "scene.json"
    file.write_text(json.dumps(SCENE))
    monkeypatch.chdir(tmp_path)
    for words in (
        ["relax", str(file), "--csv", "out.csv"],
        ["simulate", str(file), "--csv", "out.csv", "--frames", "2"],
    ):
        assert forking.run(forking.COMMAND, *words).returncode == 0
        with (tmp_path / "out.csv").open(newline="") as written:
            fields = [field for line in csv.reader(written) for field in line]
        assert any("1+1" in field for field in fields) or words[0] == "simulate"
        for field in fields:
            if field[:1] in ("=", "+", "-", "@"):
                float(field)
