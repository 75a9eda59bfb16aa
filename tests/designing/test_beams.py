"""Designs and derivatives of beams, whose ends have rotations: results as those of a relaxation, saved like those."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

import hookean
from hookean.commands.design import app

LOAD = {"kind": "unary", "name": "P", "particles": [2], "vector": [0, 0, -0.1]}
BEAM = {
    "kind": "beam", "name": "b", "particles": [[0, 1], [1, 2]],
    "E": 1e6, "G": 4e5, "A": 0.01, "Iy": 1e-5, "Iz": 2e-5, "J": 1e-5,
}  # fmt: skip
SCENE: dict[str, Any] = {
    "particles": [[0, 0, 0], [1, 0, 0], [2, 0, 0]],
    "masses": 2.0,
    "forces": [BEAM, LOAD],
    "anchors": [{"name": "a", "particles": [0], "rotations": "xyz"}],
}
PROBLEM = {
    "scene": SCENE,
    "variables": [{"force": "b", "field": "Iy", "tie": "all", "lower": 1e-7, "upper": 1e-3}],
    "goals": [{"kind": "position", "particles": [2], "axes": "z", "target": -0.05}],
}


def _same(found: hookean.Result, other: hookean.Result) -> None:
    """All of both to 1e-6 of its size: both rest at residuals of 1e-6 at most."""
    mine, theirs = found.to_dict(), other.to_dict()
    for name in ("particles", "rotations", "reactions", "loads", "contacts"):
        one, two = mine[name], theirs[name]
        for key in one if isinstance(one, dict) else ("",):
            a, b = (np.asarray(part[key] if key else part) for part in (one, two))
            assert a.shape == b.shape, (name, key)
            if a.dtype.kind == "f":
                np.testing.assert_allclose(a, b, atol=1e-6 * max(float(np.abs(b).max(initial=0.0)), 1e-3), rtol=0)
    for one, two in zip(found.forces, other.forces, strict=True):
        assert one.keys() == two.keys()
        for key in one:
            assert np.shape(one[key]) == np.shape(two[key]), key


def test_results_are_those_of_a_relaxation() -> None:
    """Rows of rotations are no particles: shapes and numbers of every column are those of a run of the scene."""
    tight = {**SCENE, "settings": {"tolerance": 1e-10}}
    found = hookean.design({**PROBLEM, "scene": tight})
    assert found.status == "converged"
    _same(found.result, hookean.relax(found.scene))
    slope = hookean.sensitivity(tight, goals=PROBLEM["goals"], variables=PROBLEM["variables"])
    _same(slope.result, hookean.relax(hookean.Scene.read(tight)))
    whole = hookean.explore({**PROBLEM, "scene": tight}, count=2)
    assert whole.result(0).particles.shape == (3, 3)


@pytest.mark.parametrize("ending", ["json", "csv", "3dm", "dxf", "vtu", "obj", "inp", "ifc", "compas.json"])
def test_results_are_saved(ending: str, tmp_path: Path, beam: hookean.Result) -> None:
    beam.save(tmp_path / f"a.{ending}")
    assert (tmp_path / f"a.{ending}").stat().st_size > 0


@pytest.fixture(scope="module")
def beam() -> hookean.Result:
    return hookean.design(PROBLEM).result


def test_the_command_writes_a_drawing(tmp_path: Path) -> None:
    path = tmp_path / "problem.json"
    path.write_text(json.dumps(PROBLEM))
    for name in ("a.3dm", "a.json", "a.csv"):
        ran = CliRunner().invoke(app, [str(path), "-o" if name != "a.csv" else "--csv", str(tmp_path / name)])
        assert ran.exit_code == 0, ran.output
        assert (tmp_path / name).stat().st_size > 0


def test_a_particle_of_rotations_is_no_particle() -> None:
    goal = {"kind": "position", "particles": [3], "axes": "z"}
    with pytest.raises(hookean.InputError, match="particle 3 does not exist; there are 3"):
        hookean.sensitivity(SCENE, goals=[goal], variables=PROBLEM["variables"])


def test_frequencies_of_loaded_beams() -> None:
    """A load that has no moment leaves the shape its energy: values are those of `hookean.frequencies` (to 1e-8: 1e-16
    of the largest stiffness by the least), and slopes differences of them (1e-3 of a value: 1e-6)."""
    goals = [{"kind": "frequency", "mode": 0}]

    def scene(load: float) -> dict[str, Any]:
        loaded = [{**BEAM, "Iy": 1e-5}, {**LOAD, "vector": [0, 0, load]}]
        return {**SCENE, "forces": loaded, "settings": {"tolerance": 1e-12}}

    variables = [{"force": "P", "field": "vector", "axes": "z", "tie": "all"}]
    found = hookean.sensitivity(scene(-2.0), goals=goals, variables=variables)
    other = [hookean.frequencies(hookean.Scene.read(scene(load)), count=1).frequencies[0] for load in (-2.0, -2.002)]
    assert found.value == pytest.approx(other[0], rel=1e-8)
    before = hookean.frequencies(hookean.Scene.read(scene(-1.998)), count=1).frequencies[0]
    assert float(found.gradient[0][0]) == pytest.approx((before - other[1]) / 0.004, rel=1e-4)
    with pytest.raises(hookean.InputError, match="forces without an energy"):
        turned = [BEAM, {**LOAD, "moment": [0, 0, 1.0]}]
        hookean.sensitivity({**SCENE, "forces": turned}, goals=goals, variables=variables)
