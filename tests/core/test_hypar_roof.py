"""A hypar roof from its form to its cases: what snow weighs, what carries it, what is used of the cables' strength."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from types import ModuleType

import ezdxf
import numpy as np
import pytest

import hookean
from hookean.commands.examples import figure, home

ROOF = figure("hypar-roof")
scene, drawn = ROOF.scene, ROOF.drawn


@pytest.fixture(scope="module")
def page() -> ModuleType:
    """The Python page of the example."""
    spec = importlib.util.spec_from_file_location("hypar_page", home() / "hypar-roof" / "page.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_snow_on_a_roof_weighs_its_plan_and_is_carried_by_the_masts() -> None:
    """The nodal forces of snow add up to q times the plan inside of the edge cables (shoelace formula), to 1e-12; what
    is out of balance is at most 1e-9 of the loads in each of 81 particles, and a cable uses T / (A f)."""
    roof = scene(divisions=8, snow=0.6)
    found = hookean.load_cases(roof, ["ULS snow"])
    case = found.cases["ULS snow"]
    assert case.result.converged
    x = case.result.particles.reshape(9, 9, 3)
    rim = np.concatenate([x[:-1, 0], x[-1, :-1], x[:0:-1, -1], x[0, :0:-1]])[:, :2]
    plan = 0.5 * abs(float(np.sum(rim[:, 0] * np.roll(rim[:, 1], -1) - rim[:, 1] * np.roll(rim[:, 0], -1))))
    snow = case.result.force("snow")["force"].sum(axis=0)
    np.testing.assert_allclose(snow, [0.0, 0.0, -1.5 * 0.6 * plan], rtol=1e-12, atol=1e-12 * plan)
    loads = case.result.loads["resultant"].sum(axis=0)
    reactions = case.result.reactions["force"].sum(axis=0)
    np.testing.assert_allclose(reactions + loads, 0.0, atol=81 * 1e-9 * np.linalg.norm(loads))
    breaks = 0.75 * np.pi * 0.02**2 / 4.0 * 1570e3  # kN
    edge = case.result.force("edge")
    np.testing.assert_allclose(edge["utilisation"], edge["force"] / breaks, rtol=1e-12)
    assert 0.1 < edge["utilisation"].max() < 1.0
    assert case.slack_count == 0


def test_the_roof_is_drawn_as_a_hypar() -> None:
    mesh = drawn(4, 10.0, 3.0)
    assert mesh.vertices[[0, 4, 20, 24], 2].tolist() == [0.0, 3.0, 3.0, 0.0]


@pytest.mark.slow
def test_one_page_takes_the_roof_from_form_to_workshop(
    page: ModuleType, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Four combinations from the form by Newton steps, wind without an energy as well; all limits are met, and the
    files hold as many strips and cables as there are: eight rows, and four edges."""
    cases = page.design(scene(divisions=8), tmp_path)
    assert list(cases.cases) == list(scene().combinations)
    for case in cases.cases.values():
        assert case.result.solver == "auto: newton" and case.result.iterations < 40
        assert case.result.converged and str(case.result.stability) == "stable"
    report = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert report.count("All limits are met") == 4 and "ULS snow and wind" in report
    labels = {text.dxf.text for text in ezdxf.readfile(tmp_path / "strips.dxf").modelspace().query("TEXT")}
    assert {f"S{i}" for i in range(1, 9)} <= labels and "S9" not in labels
    ropes = [
        row for row in (tmp_path / "cables.csv").read_text(encoding="utf-8").splitlines() if row.startswith("edge")
    ]
    ends = [{int(p) for p in row.split(",")[2:4]} for row in ropes]  # a rope from mast to mast along each edge
    assert sorted(map(sorted, ends)) == [[0, 8], [0, 72], [8, 80], [72, 80]]
    assert "displacement: largest" in capsys.readouterr().out


@pytest.mark.slow
def test_cases_side_by_side_have_the_same_bits() -> None:
    roof = scene(divisions=4)
    one, two = (hookean.load_cases(roof, ["ULS wind", "SLS snow and wind"], processes=n) for n in (1, 2))
    for name, case in one.cases.items():
        assert np.array_equal(case.result.particles, two.cases[name].result.particles)
    with pytest.raises(hookean.InputError, match=r"processes: 0 given; a whole number from 1 is expected"):
        hookean.load_cases(roof, processes=0)
