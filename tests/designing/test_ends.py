"""How searches end at limits, at starts without a slope, and for problems of any size: closed forms of a string and of
two bars."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import hookean
from hookean import InputError
from hookean.designing.answer import Design
from hookean.designing.problem import METHODS


def string(size: float = 1.0, load: float = -5.0, rest: float = 1.0, stiffness: float = 100.0) -> dict[str, Any]:
    """Two springs between supports 2 sizes apart, with a load at the middle."""
    s = size
    return {
        "particles": [[-s, 0, 0], [0, 0, -0.2 * s if load else 0.0], [s, 0, 0]],
        "forces": [
            {"kind": "springs", "name": "string", "particles": [[0, 1], [1, 2]], "stiffness": stiffness / s,
             "rest_length": rest * s},
            {"kind": "unary", "name": "load", "particles": [1], "vector": [0, 0, load]},
        ],
        "anchors": [{"particles": [0, 2]}],
        "weld_tolerance": 1e-3 * s,
    }  # fmt: skip


REST = {"force": "string", "field": "rest_length", "tie": "all", "lower": 0.5, "upper": 2}
LOAD = {"force": "load", "field": "vector", "axes": "z", "tie": "all", "lower": -50, "upper": 50}
PLACE = {"kind": "position", "particles": [1], "axes": "z"}
LENGTH = {"kind": "length", "force": "string", "elements": [0]}


def design(scene: dict[str, Any], variables: Any, goals: Any, constraints: Any = (), **settings: Any) -> Design:
    problem = {"scene": scene, "variables": list(variables), "goals": list(goals), "constraints": list(constraints)}
    return hookean.design({**problem, "settings": settings})


def test_a_problem_of_constraints_alone_ends_at_a_shape_that_meets_them() -> None:
    found = design(string(), [REST], [], [{**PLACE, "upper": -0.9}])
    assert found.status == "converged" and found.result.particles[1, 2] <= -0.9 + 1e-6


def test_methods_that_make_no_headway_hand_over(monkeypatch: pytest.MonkeyPatch) -> None:
    """The sags for which two goals conflict least: d = (0.7 + 0.3) / 2, by the method that goes on; also where SLSQP
    is asked for and there are no constraints."""
    from hookean.designing import methods

    for name, value in (("WANDERS", 1), ("SLOW", 2), ("polish", lambda search: None)):
        monkeypatch.setattr(methods, name, value)
    for method in ("slsqp", "least_squares"):
        found = design(string(), [REST], [{**PLACE, "target": -0.7}, {**PLACE, "target": -0.3}], method=method)
        assert (found.status, found.method) == ("converged", "l-bfgs-b")
        assert found.result.particles[1, 2] == pytest.approx(-0.5, rel=1e-5)


@pytest.mark.thinned
@pytest.mark.parametrize("side", [{"lower": -0.7}, {"upper": 0.0, "lower": -0.7}])
def test_steps_to_the_last_digits_end_at_limits(side: dict[str, float]) -> None:
    """Steps that would pass a limit end there, and go on along it: from a sag of 0.38 to one of 0.7 where one of 0.9 is
    wanted, objective 0.04."""
    from hookean.designing.polish import polish
    from hookean.designing.problem import Problem
    from hookean.designing.search import Search

    goals, limits = [{**PLACE, "target": -0.9}], [{**PLACE, **side}]
    given = {"scene": string(), "variables": [REST], "goals": goals, "constraints": limits}
    search = Search(Problem.read(given))
    polish(search)
    assert search.best[:2] == (0.0, pytest.approx(0.04, rel=1e-5))


def test_of_two_limits_at_one_value_the_one_that_holds_has_the_gain() -> None:
    """The objective (z + 0.7)^2 at z = -1 falls by 0.6 as the upper limit gives way by 1, and not by the lower one; the
    limit is met to 1e-6, the slope of the objective to twice that."""
    goal = {**PLACE, "target": -0.7}
    found = design(string(), [REST], [goal], [{**PLACE, "upper": -1}, {**PLACE, "lower": -1}])
    assert [c["gain"] for c in found.constraints] == pytest.approx([0.6, 0.0], abs=2e-6)


@pytest.mark.parametrize("size", [1e-9, 1e-6, 1e6])
def test_a_problem_of_any_size_has_the_same_answer(size: float) -> None:
    """Sag 0.7 of a string: l = sqrt(1.49), tension 2.5 l / 0.7, rest length l - tension / 100."""
    length = math.sqrt(1.49)
    goal = {**PLACE, "target": -0.7 * size}
    found = design(string(size), [{**REST, "lower": 0.5 * size, "upper": 2 * size}], [goal])
    assert found.status == "converged"
    value = float(np.ravel(found.variables[0]["value"])[0])
    assert value / size == pytest.approx(length - 2.5 * length / 0.7 / 100, rel=1e-6)


@pytest.mark.parametrize(
    ("variables", "place"),
    [
        ([{**REST, "upper": 1.1}, REST], "/variables/1"),
        ([{**REST, "drives": [{"force": "string", "field": "rest_length", "factor": 2}]}], "/variables/0/drives/0"),
    ],
)
def test_a_number_has_one_variable(variables: Any, place: str) -> None:
    with pytest.raises(InputError, match="gives these values already; leave one of them out") as refused:
        design(string(), variables, [{**PLACE, "target": -0.7}])
    assert refused.value.pointer == place


def test_a_start_that_is_stationary_by_symmetry_is_reported() -> None:
    """A straight string under no load: its length grows with the square of a load. With a goal, with a goal and a slack
    constraint, and with a constraint that asks for the length."""
    scene = string(load=0.0, rest=0.8, stiffness=10.0)
    goal, slack = {**LENGTH, "target": 1.2}, {**PLACE, "axes": "x", "lower": -5}
    for goals, constraints in (([goal], []), ([goal], [slack]), ([], [{**LENGTH, "lower": 1.2}])):
        found = design(scene, [LOAD], goals, constraints)
        assert found.status == "stalled" and "a little off it" in found.message, found.message


def test_a_maximum_along_a_limit_is_no_answer() -> None:
    """Force densities a, b of two links carry a load at z = -1 / (a + b), x = 2 b / (a + b). Along the limit z >= -0.4,
    a + b = 2.5, their load path is 0.4 + 1.6 a b: most at a = b, where a start that is even ends by symmetry. A little
    off it the search goes on to where one link has its least density, 0.05, at 0.4 + 1.6 x 0.05 x 2.45 or below."""
    for start, ends in (((1.0, 1.0), "stalled"), ((1.25, 1.25), "stalled"), ((1.2, 1.4), "converged")):
        links = {"kind": "springs", "name": "s", "particles": [[0, 1], [1, 2]], "stiffness": start, "rest_length": 0.0}
        scene = {
            "particles": [[0, 0, 0], [1, 0, -0.2], [2, 0, 0]],
            "forces": [links, {"kind": "unary", "particles": [1], "vector": [0, 0, -1]}],
            "anchors": [{"particles": [0, 2]}],
        }
        variable = {"force": "s", "field": "stiffness", "lower": 0.05, "upper": 50}
        limit = {"kind": "position", "particles": [1], "axes": "z", "lower": -0.4}
        found = design(scene, [variable], [{"kind": "load_path", "force": "s"}], [limit])
        assert found.status == ends and ("on both sides" in found.message) == (ends == "stalled"), found.message
        if ends == "converged":
            assert found.objective < 0.4 + 1.6 * 0.05 * 2.45 + 1e-9


def test_what_cannot_be_met_ends_nearest_in_least_squares() -> None:
    """z <= -1 three times and z >= -0.5: the least of 3 (z + 1)^2 + (z + 0.5)^2 is at -0.875."""
    scene = string(rest=0.0, stiffness=10.0)
    limits = [{**PLACE, "upper": -1.0}] * 3 + [{**PLACE, "lower": -0.5}]
    found = design(scene, [{**LOAD, "lower": -100, "upper": 100}], [{**PLACE, "target": -0.7}], limits)
    assert found.status == "infeasible" and found.result.particles[1, 2] == pytest.approx(-0.875, abs=1e-5)


@pytest.mark.soak
def test_with_constraints_the_answer_does_not_use_their_slack() -> None:
    """Two bars of least load path from a wall to a load: 45 degrees, sum |F| L = 2 P L = 6 (Michell 1904)."""
    bars = {"kind": "springs", "name": "b", "particles": [[0, 2], [1, 2]], "stiffness": 1000.0, "rest_length": [1, 1.2]}
    scene = {
        "particles": [[0, 0, 0.4], [0, 0, -0.7], [1, 0, 0]],
        "forces": [bars, {"kind": "unary", "particles": [2], "vector": [0, 0, -3.0]}],
        "anchors": [{"name": "u", "particles": [0]}, {"name": "d", "particles": [1]}, {"particles": [2], "axes": "y"}],
    }
    variables = [
        {"force": "b", "field": "rest_length", "lower": 0.3, "upper": 4},
        {"anchor": "u", "axes": "z", "lower": 0.1, "upper": 3},
        {"anchor": "d", "axes": "z", "lower": -3, "upper": -0.1},
    ]
    tip = {"kind": "position", "particles": [2], "axes": "xz", "lower": [1, 0], "upper": [1, 0]}
    found = design(scene, variables, [{"kind": "load_path", "force": "b"}], [tip], tolerance=1e-10)
    assert found.status == "converged" and found.objective == pytest.approx(6.0, rel=1e-8)
    np.testing.assert_allclose(found.result.particles[:2, 2], [1, -1], atol=1e-6)


def test_a_tie_over_different_values_is_reported() -> None:
    """What is tied has one value: of stiffnesses 100 and 60 the mean, and the sag is that of a scene of 80."""
    scene, even = string(), string(stiffness=80.0)
    scene["forces"][0]["stiffness"] = [100.0, 60.0]
    tied = {"force": "string", "field": "stiffness", "tie": "all"}
    found = hookean.sensitivity(scene, goals=[PLACE], variables=[tied])
    assert found.warnings == ["string.stiffness: values from 60 to 100 in the scene are not kept; each tie gets the"
                              " mean of its values"]  # fmt: skip
    plain = hookean.sensitivity(even, goals=[PLACE], variables=[tied])
    assert plain.warnings == [] and found.value == pytest.approx(plain.value, rel=1e-9)
    answer = design(scene, [tied], [{**PLACE, "target": -0.5}])
    assert answer.warnings == found.warnings
    driven = {**REST, "drives": [{"force": "string", "field": "stiffness", "factor": 50}]}
    said = design(even, [driven], [{**PLACE, "target": -0.5}]).warnings
    assert said == ["string.stiffness: the value 80 in the scene is not kept; it follows its variable"]


@pytest.mark.parametrize("part", ["goals", "constraints"])
@pytest.mark.parametrize(
    "quantity", [{**PLACE, "particles": []}, {**LENGTH, "elements": []}, {**LENGTH, "elements": [], "total": True}]
)
def test_what_measures_nothing_is_refused(part: str, quantity: dict[str, Any]) -> None:
    both: dict[str, Any] = {"goals": [], "constraints": [], part: [{**quantity, "lower": 0.5}]}
    with pytest.raises(InputError, match="measures nothing, because no particles or elements are selected") as refused:
        design(string(), [REST], **both)
    assert refused.value.pointer == f"/{part}/0"


def test_a_goal_that_no_variable_changes_is_reported() -> None:
    """The height of a support beside that of the middle."""
    goals = [{**PLACE, "particles": [0], "target": 1.0, "name": "support"}, {**PLACE, "target": -0.7}]
    found = design(string(), [REST], goals)
    assert found.warnings == ["no variable changes goal support at this shape"]
    assert found.objective == pytest.approx(1.0, abs=1e-9)


@pytest.mark.thinned
@pytest.mark.parametrize("method", [name for name in METHODS if name != "augmented_lagrangian"])  # needs constraints
def test_a_search_that_begins_at_its_goals_converges(method: str) -> None:
    """Where all goals are met but for rounding at the start, there is no smaller objective to compare slopes with."""
    goals = [{**PLACE, "target": -0.7}]
    first = design(string(), [REST], goals)
    again = design(string(rest=float(np.ravel(first.variables[0]["value"])[0])), [REST], goals, method=method)
    assert first.status == again.status == "converged"
    assert again.result.particles[1, 2] == pytest.approx(-0.7, abs=1e-12)


def test_forces_that_are_zero_but_for_rounding_are_met() -> None:
    """A tie takes the whole thrust of two bars: on a roller none is left, but for rounding of forces of 18."""
    bars = {"kind": "springs", "name": "bars", "particles": [[0, 2], [2, 1]], "axial_stiffness": 1e4}
    scene = {
        "particles": [[0, 0, 0], [6, 0, 0], [3, 0, 1.7]],
        "forces": [
            bars,
            {"kind": "springs", "name": "tie", "particles": [[0, 1]], "axial_stiffness": 2e4},
            {"kind": "unary", "particles": [2], "vector": [0, 0, -20.0]},
        ],
        "anchors": [{"name": "l", "particles": [0]}, {"particles": [1], "axes": "yz"}, {"particles": [2], "axes": "y"}],
    }
    tie = {"force": "tie", "field": "axial_stiffness", "lower": 1.0, "upper": 1e6}
    for thrust in ({"axes": "x"}, {"direction": [0, 0, 1], "total": True}):
        reaction = {"kind": "reaction", "anchor": "l", **thrust}
        found = design(scene, [tie], [{**reaction, "target": 0.0}])
        assert (found.status, found.goals[0]["met"]) == ("converged", True)
        assert np.abs(found.goals[0]["value"]).max() < 1e-9 * 20.0
    found = design(scene, [tie], [], [{**reaction, "lower": 0.0, "upper": 0.0}])
    assert (found.status, found.constraints[0]["met"]) == ("converged", True)
    found = design(scene, [tie], [{"kind": "reaction", "anchor": "l", "axes": "z", "target": 10.0 + 1e-4}])
    assert found.goals[0]["met"] is False  # 1e-5 off is not rounding


@pytest.mark.slow
def test_a_minimum_whose_objective_is_rounded_is_one() -> None:
    """The height of a curved shell has a least by its thickness, where the objective differs by 1e-11 from one way to
    the same shape to the next: slopes tell the least, 1e-8 of the objective there."""
    u = np.linspace(0, 4, 6)
    points = [[a, b, 0.15 * (a - 2) * (b - 2)] for a in u for b in u]
    at = np.arange(36).reshape(6, 6)
    faces = np.stack([at[:-1, :-1], at[1:, :-1], at[1:, 1:], at[:-1, 1:]], -1).reshape(-1, 4).tolist()
    sheet = {"mesh": "m", "material": "t", "thickness": 0.05}
    scene = {
        "particles": points,
        "meshes": {"m": {"vertices": points, "faces": faces}},
        "materials": {"t": {"E": 1e6, "poisson": 0.3}},
        "forces": [
            {"kind": "membrane", "name": "c", **sheet},
            {"kind": "shell", "name": "s", **sheet},
            {"kind": "area_weight", "mesh": "m", "weight": 1.0},
        ],
        "anchors": [{"particles": [*range(6), *range(30, 36)]}],
    }
    drives = [{"force": "c", "field": "thickness"}]
    variable = {"force": "s", "field": "thickness", "tie": "all", "lower": 0.01, "upper": 0.5, "drives": drives}
    goal = {"kind": "position", "particles": [14], "axes": "z"}
    target = points[14][2] - 0.02
    found = design(scene, [variable], [{**goal, "target": target}])
    assert found.status == "converged" and not found.variables[0]["at_bound"]
    slope = hookean.sensitivity(found.scene, goals=[goal], variables=[variable])
    by = 2.0 * (slope.value - target) * float(slope.gradient[0][0]) * float(found.variables[0]["value"])
    assert abs(by) < 1e-6 * found.objective


STAY = {"kind": "springs", "name": "stay", "particles": [[1, 3]], "stiffness": 50.0, "rest_length": 1.6}


def stayed(load: float) -> dict[str, Any]:
    """A string with a stay of 1.6 from 1 above its middle: it carries where that hangs 0.6 deep at least."""
    scene = string(load=load, rest=0.8, stiffness=10.0)
    scene["particles"].append([0, 0, 1.0])
    scene["forces"].append({**STAY, "tension_only": True})
    scene["anchors"][0]["particles"].append(3)
    return scene


def load_at(force: float) -> float:
    """The load at which the stay carries a force: it hangs d = 0.6 + force / 50 deep, V = 2 N d / l + force."""
    d = 0.6 + force / 50.0
    length = math.hypot(1.0, d)
    return 2.0 * 10.0 * (length - 0.8) * d / length + force


def test_a_stay_that_is_slack_at_the_start_is_tightened() -> None:
    """No variable changes the force of a stay that hangs slack; a search from other values of the load finds the one
    at which it carries 2, as goal and as limit."""
    variable = {**LOAD, "upper": 0.0}
    stay = {"kind": "force", "force": "stay"}
    found = design(stayed(-2.0), [variable], [{**stay, "target": 2.0}])
    assert (found.status, found.goals[0]["met"]) == ("converged", True)
    assert found.variables[0]["value"] == pytest.approx(-load_at(2.0), rel=1e-6)
    assert [said for said in found.warnings if "no variable changes goal force at the values of the scene" in said]
    found = design(stayed(-2.0), [variable], [], [{**stay, "lower": 2.0}])
    assert found.status == "converged" and found.variables[0]["value"] <= -load_at(2.0) * (1.0 - 1e-6)
    least = {**stay, "lower": 2.0}
    found = design(
        stayed(-2.0), [variable], [{"kind": "position", "particles": [1], "axes": "z", "target": 0}], [least]
    )
    assert (found.status, found.variables[0]["value"]) == ("converged", pytest.approx(-load_at(2.0), rel=1e-5))


def test_what_no_start_reaches_is_said() -> None:
    """Where the stay stays slack at all loads within the bounds the message does not end with the limit alone."""
    stay = {"kind": "force", "force": "stay"}
    variable = {**LOAD, "lower": -3.0, "upper": 0.0}
    said = "at this shape, where it is 0: its elements carry nothing; values at which they do may change it"
    found = design(stayed(-2.0), [variable], [], [{**stay, "lower": 2.0}])
    assert found.status == "infeasible" and f"no variable changes constraint force {said}" in found.warnings
    found = design(stayed(-2.0), [variable], [{**stay, "target": 2.0}])
    assert found.status == "converged" and f"no variable changes goal force {said}" in found.warnings


@pytest.mark.slow
def test_a_search_from_elsewhere_keeps_what_is_better_and_can_be_stopped() -> None:
    """Progress never shows more than before, what is kept is never worse, and a caller may end it."""
    problem = {
        "scene": stayed(-2.0),
        "variables": [{**LOAD, "upper": 0.0}],
        "goals": [{"kind": "force", "force": "stay", "target": 2.0}],
    }
    shown: list[tuple[int, float]] = []
    kept: list[float] = []
    found = hookean.design(problem, progress=lambda i, v: shown.append((i, v)), keep=lambda u: kept.append(float(u[0])))
    assert [v for _, v in shown] == sorted((v for _, v in shown), reverse=True)
    assert [i for i, _ in shown] == sorted(i for i, _ in shown)
    assert kept[0] == -2.0 and kept[-1] == pytest.approx(found.variables[0]["value"])
    first = next(i for i, (_, v) in enumerate(shown) if v < 4.0)
    calls = iter(range(10**6))
    stopped = hookean.design(problem, cancelled=lambda: next(calls) > first + 17)
    assert stopped.status in ("cancelled", "converged") and stopped.objective <= 4.0
