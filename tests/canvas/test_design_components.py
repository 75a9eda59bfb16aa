"""The components of design problems: the optimum of the core, which follows a slider, and one sentence for a fault."""

from __future__ import annotations

import json
from typing import Any

import pytest

import hookean
from canvas.canvasing import Bench, line, point, sentences, xyz
from canvas.test_tools import Placed, branches
from canvas.test_tools_sweep import tree
from hookean_canvas.run import stand_in
from hookean_client import canvas_design
from serving import Home

pytestmark = pytest.mark.usefixtures("canvas")


def cable(bench: Bench) -> dict[str, Any]:
    """Inputs of Design of a cable of ten links under loads, from the components of forces."""
    lines = [line((i, 0, 0), (i + 1, 0, 0)) for i in range(10)]
    springs = Placed("Springs", bench).run(_connection=lines, rest_length_=[1.05], _stiffness_=[1e4])["force"]
    inner = [point(i, 0, 0) for i in range(1, 10)]
    load = Placed("Unary", bench).run(_point=inner, _force=[stand_in.Vector3d(0, 0, -20)])["force"]
    return {
        "_forces": tree([springs], [load]),
        "anchors_": [point(0, 0, 0), point(10, 0, 0)],
        "geometry_": [point(5, 0, 0)],
    }


def variables(bench: Bench, **more: Any) -> list[str]:
    given = {"_force": ["Springs"], "_field": ["rest_length"], "_tie_": ["all"], "lower_": [0.9], "upper_": [1.5]}
    return Placed("Variables", bench).run(**{**given, **more})["variables"]


def sag(bench: Bench, depth: float) -> list[str]:
    given = {"_kind": ["position"], "points_": [point(5, 0, 0)], "axes_": ["z"], "target_": [-depth]}
    return Placed("Goals", bench).run(**given)["goals"]


def test_the_optimum_is_that_of_the_core_and_follows_a_slider(home: Home) -> None:
    """A sag of 2 m, then of 2.001 m: the second search starts from the first one's values."""
    bench = Bench()
    placed, given = Placed("Design", bench), cable(bench)
    given["_variables"] = variables(bench)
    first = placed.run(**given, _goals=sag(bench, 2.0))
    assert not placed.ghenv.Component.messages and first["status"] == "converged"
    assert xyz(first["geometry"][0]) == pytest.approx((5.0, 0.0, -2.0), abs=1e-6)
    assert branches(first["goals"])["{0}"] == pytest.approx([-2.0], abs=1e-6)
    scene = hookean.Scene.read(json.loads(first["scene"]))
    here = hookean.design(
        {
            "scene": scene.replaced(
                forces=tuple(f.replaced(rest_length=1.05) if f.kind_name == "springs" else f for f in scene.forces)
            ),
            "variables": [json.loads(one)["variable"] for one in given["_variables"]],
            "goals": [json.loads(one)["goal"] for one in sag(bench, 2.0)],
        }
    )
    assert branches(first["values"])["{0}"] == pytest.approx([here.variables[0]["value"]], rel=1e-7)
    [search] = canvas_design._searches.values()
    began = search.status["id"]
    second = placed.run(**given, _goals=sag(bench, 2.001))
    assert xyz(second["geometry"][0])[2] == pytest.approx(-2.001, abs=1e-6)
    assert search.status["id"] != began and search.best[1] == branches(second["values"])["{0}"]
    assert search.answer["iterations"] < here.iterations


def test_a_thrust_is_held_by_a_constraint_at_an_anchor(home: Home) -> None:
    """Least cable length whose horizontal thrust is at most 150 N: the limit is met with equality."""
    bench = Bench()
    placed, given = Placed("Design", bench), cable(bench)
    goal = Placed("Goals", bench).run(_kind=["load_path"], forces_=["Springs"])["goals"]
    limit = {"_kind": ["reaction"], "anchors_": [point(10, 0, 0)], "axes_": ["x"], "upper_": [150.0]}
    held = Placed("Constraints", bench).run(**limit)["constraints"]
    found = placed.run(**given, _variables=variables(bench), _goals=goal, constraints_=held)
    assert found["status"] in ("converged", "infeasible")
    thrust = branches(found["constraints"])["{0}"][0]
    assert thrust <= 150.0 * (1 + 1e-6)


@pytest.mark.parametrize(
    ("component", "inputs", "sentence"),
    [
        ("Variables", {}, "_force is missing"),
        ("Variables", {"_force": ["Springs"]}, "_field is missing"),
        ("Variables", {"_force": ["Springs"], "anchors_": [(0, 0, 0)]}, "connect one of them"),
        ("Variables", {"_force": ["Springs"], "_field": ["stiffness"], "_axes_": ["w"]}, "unknown"),
        ("Goals", {}, "_kind is missing"),
        ("Goals", {"_kind": ["length"]}, "connect points, names of forces"),
        ("Goals", {"_kind": ["length"], "forces_": ["Springs"], "target_": ["long"]}, "numbers or points"),
        ("Constraints", {"_kind": ["length"], "forces_": ["Springs"]}, "lower_ or upper_ is missing"),
        ("Design", {}, "_forces is missing"),
    ],
)
def test_what_is_missing_or_wrong_is_one_sentence(component: str, inputs: dict[str, Any], sentence: str) -> None:
    given = {k: [point(*v[0])] if k == "anchors_" else v for k, v in inputs.items()}
    placed = Placed(component)
    placed.run(**given)
    [said] = sentences(placed.ghenv)
    assert sentence.lower() in said.lower() and said.endswith(".")


def test_a_refused_problem_names_the_component(home: Home) -> None:
    bench = Bench()
    placed, given = Placed("Design", bench), cable(bench)
    given["_variables"] = variables(bench, _field=["rest_lenght"])
    placed.run(**given, _goals=sag(bench, 2.0), until=lambda found: bool(sentences(placed.ghenv, "Error")))
    [said] = sentences(placed.ghenv, "Error")
    assert "rest_lenght" in said and "Variables 0" in said


def test_points_with_the_field_drawn_or_mass_are_particles() -> None:
    """One variable of all points; without such a field each point names the anchor there."""
    bench, points = Bench(), [point(1, 0, 0), point(2, 0, 0)]
    for field in ("drawn", "mass"):
        [text] = variables(bench, _force=[], _field=[field], anchors_=points, lower_=[], upper_=[])
        assert json.loads(text)["variable"] == {"points": [[1, 0, 0], [2, 0, 0]], "field": field, "tie": "all"}
    held = variables(bench, _force=[], _field=[], anchors_=points, lower_=[], upper_=[])
    assert [json.loads(text)["variable"]["anchor_at"] for text in held] == [[1, 0, 0], [2, 0, 0]]
