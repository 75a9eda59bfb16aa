"""What goals would gain from bounds and constraints, and which conflict."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hookean.designing.search import design

from .test_gradients import cable

FREE = {"force": "string", "field": "rest_length", "tie": "all", "lower": 0.5, "upper": 3.0}


def lowest(limit: float) -> Any:
    """The least sag of the string with no more force than a limit."""
    return design(
        {
            "scene": cable(),
            "variables": [FREE],
            "goals": [{"kind": "position", "particles": [1], "axes": "z", "target": 0.0, "weight": 2.0}],
            "constraints": [{"kind": "force", "force": "string", "upper": limit, "elements": [0]}],
            "settings": {"tolerance": 1e-12},
        }
    )


def test_a_constraint_gains_what_the_objective_falls() -> None:
    """F = P l / (2 d), so d = 1 / sqrt((2 F / P)² - 1); the gain is -d(2 d²)/dF of the closed form."""
    found = lowest(6.0)
    objective = [2.0 / ((2.0 * force / 5.0) ** 2 - 1.0) for force in (6.0 - 1e-4, 6.0 + 1e-4)]
    expected = (objective[0] - objective[1]) / 2e-4
    assert found.constraints[0]["gain"] == pytest.approx(expected, rel=1e-5)
    assert found.goals[0]["gains"] == {"force": pytest.approx(expected, rel=1e-5)}
    assert found.goals[0]["conflicts"] == [] and found.variables[0]["gain"] == 0.0


def test_goals_that_pull_apart_are_named() -> None:
    """One rest length cannot give two sags: they conflict; a third goal that is met conflicts with neither."""
    goals: list[dict[str, Any]] = [
        {"kind": "position", "particles": [1], "axes": "z", "target": target, "name": name}
        for target, name in ((-0.5, "high"), (-0.9, "low"))
    ]
    goals.append({"kind": "position", "particles": [1], "axes": "x", "target": 0.0, "name": "middle"})
    found = design({"scene": cable(), "variables": [FREE], "goals": goals})
    assert found.goals[0]["value"] == pytest.approx(-0.7, rel=1e-6)
    assert [entry["conflicts"] for entry in found.goals] == [["low"], ["high"], []]
    assert [entry["met"] for entry in found.goals] == [False, False, True]
    assert "high, low" in found.message and found.goals[0]["gains"] == {}


def test_gains_of_goals_sum_to_those_of_the_bounds() -> None:
    """Two goals that both want longer strings than the bounds allow share the gain; neither conflicts."""
    goals = [
        {"kind": "position", "particles": [1], "axes": "z", "target": -3.0},
        {"kind": "length", "force": "string", "total": True, "target": 9.0, "weight": 0.1},
    ]
    variable = {"force": "string", "field": "rest_length", "upper": 1.5}
    found = design({"scene": cable(), "variables": [variable], "goals": goals})
    shares = [np.asarray(entry["gains"]["string.rest_length"]) for entry in found.goals]
    assert all((share > 0.0).all() for share in shares)
    assert sum(shares) == pytest.approx(found.variables[0]["gain"], rel=1e-9)
    assert not any(entry["conflicts"] for entry in found.goals)
    assert "gains" in found.to_dict()["goals"][0]


def test_an_answer_says_in_a_line_each_how_it_ended() -> None:
    """Bounds, goals that are only minimised, limits and units; several of a kind have numbers, in conflicts too."""
    place = {"kind": "position", "particles": [1], "axes": "z"}
    twice = [{**place, "target": -0.7}, {**place, "target": -0.3}]
    path = {"kind": "load_path", "force": "string", "weight": 1e-3}
    limit = {"kind": "length", "force": "string", "elements": [0], "upper": 2.0}
    found = design({"scene": cable(), "variables": [FREE], "goals": [*twice, path], "constraints": [limit]})
    first, *lines = str(found).splitlines()
    assert first.startswith("Design: converged.") and "conflict: position, position 2" in first
    assert [line.split(":")[0].strip() for line in lines] == [
        "string.rest_length", "goal position", "goal position 2", "goal load_path", "constraint length",
    ]  # fmt: skip
    assert lines[1].endswith(" m, target -0.7 m") and lines[3].endswith(" N m, minimised")
    assert lines[4].endswith(" m, met") and "bound" not in lines[0]
    bound = design({"scene": cable(), "variables": [{**FREE, "upper": 1.0}], "goals": [twice[0]]})
    assert str(bound).splitlines()[1].endswith(": 1 m (at a bound)")
