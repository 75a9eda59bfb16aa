"""The components of design problems: the optimum of the core, which follows a slider, and one sentence for a fault."""

from __future__ import annotations

import json
from typing import Any

import pytest

import hookean
from canvas.canvasing import Bench, line, point, sentences, xyz
from canvas.test_tools import SQUARE, Placed, as_mesh, branches
from canvas.test_tools_sweep import tree
from hookean.designing.quantities import QUANTITIES
from hookean_canvas.components import bundles
from hookean_canvas.run import stand_in
from hookean_client import canvas_design, canvas_goals
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


@pytest.mark.slow
def test_a_search_goes_on_from_no_values_that_led_nowhere(home: Home) -> None:
    """A load without bounds for a sag of 1e9 m, then of 1.7 m: found as if there had been no search before."""
    bench = Bench()
    placed, given = Placed("Design", bench), cable(bench)
    given["_variables"] = variables(bench, _force=["UForce"], _field=["vector"], _axes_=["z"], lower_=[], upper_=[])
    assert placed.run(**given, _goals=sag(bench, 1e9))["status"] == "unbounded"
    found = placed.run(**given, _goals=sag(bench, 1.7))
    assert found["status"] == "converged" and not placed.ghenv.Component.messages
    assert branches(found["goals"])["{0}"] == pytest.approx([-1.7], abs=1e-6)


def test_switches_and_kinds_are_those_of_the_core() -> None:
    """True, false and words at the switches; quantities of the whole model, and offsets of points from a mesh."""
    bench, at = Bench(), [point(5, 0, 0)]

    def goal(**inputs: Any) -> dict[str, Any]:
        [text] = Placed("Goals", bench).run(**inputs)["goals"]
        return json.loads(text)["goal"]

    for given, wanted in ((True, {"equal": True}), ("yes", {"equal": True}), (False, {}), ("0", {})):
        assert (
            goal(_kind=["force"], forces_=["Springs"], equal_=[given]) == {"kind": "force", "force": "Springs"} | wanted
        )
    whole = goal(_kind=["Reaction"], anchors_=at, total_=[True], size_=[True])
    assert whole == {"kind": "reaction", "anchor_at": [5, 0, 0], "total": True, "size": True}
    for kind in ("frequency", "buckling_factor"):
        assert goal(_kind=[kind], target_=[3.0]) == {"kind": kind, "target": 3.0}
    offset = goal(_kind=["offset"], points_=at, meshes_=[as_mesh(SQUARE)], target_=[0.0])
    assert (
        offset["points"] == [[5, 0, 0]]
        and offset["mesh"].startswith("mesh-")
        and offset["mesh_drawn"]["faces"]["shape"] == [1, 4]
    )
    assert goal(_kind=[1], forces_=["Springs"])["kind"] == goal(_kind=["1"], forces_=["Springs"])["kind"] == "length"


def test_every_kind_of_the_core_is_listed_at_the_input() -> None:
    for name in ("Goals", "Constraints"):
        [kind] = [one for one in bundles.read(name).inputs if one.name == "_kind"]
        listed = kind.description.removeprefix("What is measured: ").removesuffix(".").split(", ")
        assert set(listed) == set(QUANTITIES) == set(canvas_goals.KINDS)


@pytest.mark.parametrize(
    ("component", "inputs", "sentence"),
    [
        ("Variables", {}, "_force is missing"),
        ("Variables", {"_force": ["Springs"]}, "_field is missing"),
        ("Variables", {"_force": ["Springs"], "anchors_": [(0, 0, 0)]}, "connect one of them"),
        (
            "Variables",
            {"_force": ["Springs"], "_field": ["stiffness"], "lower_": [1.0, 2.0]},
            "2 numbers given; give one",
        ),
        ("Goals", {"_kind": ["offset"], "anchors_": [(0, 0, 0)]}, "connect points and meshes"),
        ("Goals", {"_kind": ["99"], "forces_": ["Springs"]}, "give one of 0 position"),
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
