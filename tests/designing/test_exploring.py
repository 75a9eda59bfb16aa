"""Families of designs: samples between bounds, the front of Pareto, the same bits on any executor, one command."""

from __future__ import annotations

import csv
import json
import re
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from matplotlib.image import imread
from typer.testing import CliRunner

import hookean
from hookean.commands.explore import app
from hookean.designing.exploring import Exploration, pareto
from soak import examples


def problem(**changes: Any) -> dict[str, Any]:
    """A string of force density q under a load P in its middle: it sags by P / 2q, its force is q x length."""
    scene = {
        "particles": [[-1, 0, 0], [0, 0, -0.2], [1, 0, 0]],
        "forces": [
            {"kind": "springs", "name": "string", "particles": [[0, 1], [1, 2]], "stiffness": 5, "rest_length": 0},
            {"kind": "unary", "name": "load", "particles": [1], "vector": [0, 0, -5]},
        ],
        "anchors": [{"name": "ends", "particles": [0, 2]}],
    }
    variables = [{"force": "string", "field": "stiffness", "tie": "all", "lower": 2.0, "upper": 10.0}]
    goals = [
        {"kind": "position", "particles": [1], "axes": "z", "target": 0.0, "name": "sag"},
        {"kind": "load_path", "force": "string"},
    ]
    return {"scene": scene, "variables": variables, "goals": goals, **changes}


@pytest.fixture(scope="module")
def found() -> Exploration:
    return hookean.explore(problem(), 20)


@pytest.mark.soak
def test_samples_have_the_values_of_the_closed_form(found: Exploration) -> None:
    """Sag P / 2q, load path 2 q L2 = 2 q (1 + (P / 2q)2); beyond q = P / 2 less sag is more path: stiffer strings
    alone are on the front."""
    q = found.points[:, 0]
    assert ((q >= 2.0) & (q <= 10.0)).all() and len(np.unique(q)) == 20
    sag = 5.0 / (2.0 * q)
    assert found.values[:, 0] == pytest.approx(sag, rel=1e-8)
    assert found.values[:, 1] == pytest.approx(2.0 * q * (1.0 + sag**2), rel=1e-8)
    assert (found.goals, found.units) == (["sag missed", "load_path"], ["m", "N m"])
    least = int(np.argmin(found.values[:, 1]))
    assert set(found.front) == {i for i in range(20) if q[i] >= q[least]}
    assert found.result(3).particles[1, 2] == pytest.approx(-sag[3], rel=1e-8)


def test_the_same_bits_on_an_executor_and_each_time(found: Exploration) -> None:
    with ThreadPoolExecutor(2) as executor:
        again = hookean.explore(problem(), 20, executor=executor)
    assert (again.values == found.values).all() and (again.points == found.points).all()
    assert again.front == found.front and again.to_dict() == found.to_dict()
    assert (hookean.explore(problem(), 4, seed=1).points != found.points[:4]).any()


def test_grid_and_latin_hypercube() -> None:
    """A grid has equal steps and the bounds; a hypercube has one sample in each of n equal parts."""
    grid = hookean.explore(problem(), 5, sampling="grid").points[:, 0]
    assert grid == pytest.approx(np.linspace(2.0, 10.0, 5))
    cube = hookean.explore(problem(), 8, sampling="latin_hypercube").points[:, 0]
    assert sorted(np.floor(cube - 2.0)) == list(range(8))


def test_samples_that_miss_constraints_are_not_on_the_front() -> None:
    limit = [{"kind": "force", "force": "string", "upper": 6.0}]
    some = hookean.explore(problem(constraints=limit), 8)
    forces = some.points[:, 0] * np.sqrt(1.0 + (2.5 / some.points[:, 0]) ** 2)
    assert some.met.tolist() == (forces <= 6.0).tolist() and some.met.any() and not some.met.all()
    assert some.met[some.front].all()


@settings(max_examples=examples(60), deadline=None)
@given(st.lists(st.lists(st.integers(0, 4), min_size=3, max_size=3), min_size=1, max_size=12))
def test_the_front_is_what_nothing_beats(rows: list[list[int]]) -> None:
    values = np.array(rows, dtype=float)
    front = pareto(values)
    beaten = [any((o <= v).all() and (o < v).any() for o in values) for v in values]
    assert {tuple(values[i]) for i in front} == {tuple(v) for v, b in zip(values, beaten, strict=True) if not b}


@pytest.mark.parametrize(
    ("changes", "options", "sentence"),
    [
        ({"variables": [{"force": "string", "field": "stiffness", "upper": 1.0}]}, {}, "is not bounded"),
        ({"goals": [], "constraints": [{"kind": "load_path", "force": "string", "upper": 1}]}, {}, "at least one goal"),
        ({}, {"count": 0}, "a whole number from 1 to 100000"),
        ({}, {"count": 1, "sampling": "grid"}, "2^1 samples at least"),
        ({}, {"sampling": "random"}, "known: sobol, latin_hypercube, grid"),
        ({}, {"seed": -1}, "a whole number from 0"),
    ],
)
def test_bad_input_is_one_sentence(changes: dict[str, Any], options: dict[str, Any], sentence: str) -> None:
    with pytest.raises(hookean.InputError) as caught:
        hookean.explore(problem(**changes), **options)
    assert sentence in str(caught.value).replace("\n", " ")


def test_the_command_writes_table_picture_and_report(tmp_path: Path) -> None:
    path = tmp_path / "problem.json"
    path.write_text(json.dumps(problem()))
    arguments = [str(path), "-n", "6", "--csv", str(tmp_path / "t.csv"), "--picture", str(tmp_path / "t.png")]
    ran = CliRunner().invoke(app, [*arguments, "--report", str(tmp_path / "t.json")])
    assert ran.exit_code == 0, ran.output
    assert "6 samples, 6 at rest" in ran.output and "load_path" in ran.output
    assert re.search(r"\(string\.stiffness [\d.]+ N/m\)", ran.output)
    rows = list(csv.DictReader((tmp_path / "t.csv").read_text().splitlines()))
    assert len(rows) == 6 and set(rows[0]) >= {"string.stiffness [N/m]", "sag missed [m]", "load_path [N m]", "front"}
    assert float(rows[2]["sag missed [m]"]) == pytest.approx(2.5 / float(rows[2]["string.stiffness [N/m]"]), rel=1e-8)
    assert len(json.loads((tmp_path / "t.json").read_text())["front"]) == sum(row["front"] == "True" for row in rows)
    assert imread(tmp_path / "t.png").shape[1] >= 1500
    path.write_text(json.dumps(problem(variables=[{"force": "string", "field": "stiffness"}])))
    ran = CliRunner().invoke(app, [str(path)])
    assert ran.exit_code == 2 and "is not bounded" in ran.output and "Traceback" not in ran.output
