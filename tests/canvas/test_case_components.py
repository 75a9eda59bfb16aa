"""The components of load cases: the numbers of the core by case and as an envelope, and one sentence for a fault."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest

import hookean
from canvas.canvasing import Bench, line, point, sentences, xyz
from canvas.test_tools import Placed, branches
from canvas.test_tools_sweep import tree
from hookean_canvas.run import stand_in
from serving import Home

pytestmark = pytest.mark.usefixtures("canvas")


def down(*amounts: float) -> list[Any]:
    return [stand_in.Vector3d(0, 0, -amount) for amount in amounts]


def roof(bench: Bench) -> dict[str, Any]:
    """Inputs of a cable of four links under its weight, with snow and wind in cases, from their components."""
    lines = [line((i, 0, 0), (i + 1, 0, 0)) for i in range(4)]
    springs = Placed("Springs", bench).run(_connection=lines, rest_length_=[0.98], _stiffness_=[1e4], name_=["rope"])
    inner = [point(i, 0, 0) for i in range(1, 4)]
    own = Placed("Unary", bench).run(_point=inner, _force=down(5), name_=["weight"])["force"]
    snow = Placed("Unary", bench).run(_point=inner, _force=down(20), name_=["snow load"])["force"]
    wind = Placed("Unary", bench).run(_point=inner[:1], _force=[stand_in.Vector3d(0, 8, 0)], name_=["wind load"])
    cases = [
        Placed("LoadCase", bench).run(_loads=[snow], name_=["snow"])["case"],
        Placed("LoadCase", bench).run(_loads=[wind["force"]], _factor_=[2.0], name_=["wind"])["case"],
    ]
    both = {"_cases": cases, "_factors_": [1.5, 0.9], "permanent_": [1.35], "prestress_": [1.1], "name_": ["ULS"]}
    return {
        "_forces": tree([springs["force"]], [own]),
        "anchors_": [point(0, 0, 0), point(4, 0, 0)],
        "geometry_": [point(2, 0, 0)],
        "_cases": cases,
        "combinations_": [Placed("Combination", bench).run(**both)["combination"]],
    }


def test_cases_and_their_envelope_are_those_of_the_core(home: Home) -> None:
    """The loads of cases need no wire to the forces."""
    bench = Bench()
    placed = Placed("LoadCases", bench)
    found = placed.run(**roof(bench))
    assert not placed.ghenv.Component.messages and placed.ghenv.Component.Message == "3 of 3"
    assert found["names"] == ["snow", "wind", "ULS"] and found["statuses"] == ["converged"] * 3
    scene = hookean.Scene.read(json.loads(found["scene"]))
    assert scene.combinations == {"ULS": {"snow": 1.5, "wind": 0.9, "permanent": 1.35, "prestress": 1.1}}
    assert scene.load_cases["wind"].factor == 2.0 and scene.load_cases["wind"].forces == ("wind load",)
    here = hookean.load_cases(scene)
    for i, case in enumerate(here.cases.values()):
        moved = [xyz(vector) for vector in branches(found["displacements"])[f"{{{i}}}"]]
        np.testing.assert_allclose(moved, case.displacements, atol=1e-9)
        assert branches(found["forces"])[f"{{{i};0}}"] == pytest.approx(case.result.force("rope")["force"], rel=1e-9)
        pulls = [xyz(vector) for vector in branches(found["reactions"])[f"{{{i}}}"]]
        np.testing.assert_allclose(pulls, case.result.reactions["force"], atol=1e-7)
    at = found["extremes"].index("rope.force")
    largest = here.envelope.forces[0]["columns"]["force"]
    assert branches(found["largest"])[f"{{{at}}}"] == pytest.approx(largest.largest, rel=1e-9)
    assert set(branches(found["largest_cases"])[f"{{{at}}}"]) == {"ULS"}
    assert found["extremes"][0] == "displacement" and found["extremes"][-1] == "reaction"
    assert xyz(found["form"][0]) == pytest.approx(here.form.particles[2], abs=1e-9)
    assert found["slack"] == [0, 0, 0] and found["report"][0].startswith("snow: In equilibrium")
    only = placed.run(**roof(bench), chosen_=["ULS"])
    assert only["names"] == ["ULS"]


def test_temperature_and_stages(home: Home) -> None:
    """A rope of constant tension freezes to EA of the stages, and cools: T + EA a dT, and no more moves."""
    bench = Bench()
    lines = [line((0, 0, 0), (2, 0, 0))]
    rope = Placed("ConstantTension", bench).run(_connection=lines, _tension_=[10.0], name_=["rope"])["force"]
    cold = Placed("LoadCase", bench).run(heated_=[rope], degrees_=[-20.0], name_=["cold"])["case"]
    stages = {"freeze": {"rope": {"material": "S355", "section": "rod"}}}
    given = {"_forces": [rope], "anchors_": [point(0, 0, 0), point(2, 0, 0)], "_cases": [cold]}
    placed = Placed("LoadCases", bench)
    placed.run(**given, stages_=[json.dumps(stages)], until=lambda _: bool(sentences(placed.ghenv, "Error")))
    assert "section 'rod' does not exist" in sentences(placed.ghenv, "Error")[0]
    snow = Placed("Unary", bench).run(_point=[point(2, 0, 0)], _force=down(1), name_=["snow load"])["force"]
    case = Placed("LoadCase", bench).run(_loads=[snow], name_=["snow"])["case"]
    elastic = json.dumps({"freeze": {"rope": {"axial_stiffness": 1000.0}}})
    found = Placed("LoadCases", bench).run(**{**given, "_cases": [case]}, stages_=[elastic])
    assert branches(found["forces"])["{0;0}"] == pytest.approx([10.0], rel=1e-9)


@pytest.mark.parametrize(
    ("inputs", "said"),
    [
        ({"_cases": []}, "_cases is missing"),
        ({"stages_": ["freeze"]}, "Stages: it is not the JSON text of stages"),
        ({"combinations_": ["ULS"]}, "is not a hookean object"),
    ],
)
def test_a_fault_is_one_sentence(home: Home, inputs: dict[str, Any], said: str) -> None:
    bench = Bench()
    given = {**roof(bench), **({"combinations_": []} if "_cases" in inputs else {}), **inputs}
    placed = Placed("LoadCases", bench)
    placed.run(**given, until=lambda _: True)
    (found,) = sentences(placed.ghenv, "Error") + sentences(placed.ghenv, "Warning")
    assert said in found


def test_names_are_given_once(home: Home) -> None:
    bench = Bench()
    given = roof(bench)
    twice = Placed("LoadCase", bench).run(_loads=["snow load"], _factor_=[3.0], name_=["snow"])["case"]
    placed = Placed("LoadCases", bench)
    placed.run(**{**given, "_cases": [*given["_cases"], twice]}, until=lambda _: True)
    assert sentences(placed.ghenv, "Error") == ["Two load cases have the name snow; give each its own."]
    factors = Placed("Combination", bench)
    factors.run(_cases=["a", "b", "c"], _factors_=[1.0, 2.0], until=lambda _: True)
    assert sentences(factors.ghenv, "Error") == ["Factors: 2 for 3 cases; give one for all, or one for each."]
