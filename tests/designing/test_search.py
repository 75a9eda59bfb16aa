"""Design problems with known optima, and ones that cannot be met."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

import hookean
from hookean.commands.design import app
from hookean.designing.problem import Problem
from hookean.designing.search import Search, design
from hookean.errors import InputError
from soak import sampled

from .test_gradients import cable, sag

TOLERANCE = 1e-6  # of the closed forms below, which are exact


def test_a_string_gets_the_sag_that_is_asked_for() -> None:
    """P = 2 k (l - L0) d / l (two-link string): the rest length for a sag d is L0 = l - P l / (2 k d)."""
    found = design(
        {
            "scene": cable(),
            "variables": [{"force": "string", "field": "rest_length", "tie": "all", "lower": 0.5, "upper": 2.0}],
            "goals": [{"kind": "position", "particles": [1], "axes": "z", "target": -0.7}],
        }
    )
    length = np.hypot(1.0, 0.7)
    assert found.status == "converged" and found.method == "least_squares"
    assert found.variables[0]["value"] == pytest.approx(length - 5.0 * length / (2 * 100 * 0.7), rel=TOLERANCE)
    assert found.goals[0]["value"] == pytest.approx(-0.7, rel=TOLERANCE) and not found.variables[0]["at_bound"]
    again = hookean.relax(found.scene)
    assert again.particles[1, 2] == pytest.approx(-0.7, rel=1e-5)


def test_a_string_gets_the_thrust_that_is_asked_for() -> None:
    """H = P / (2 d) for a span of 2: a thrust of 4 needs a sag of 5 / 8, and the stiffness that gives it."""
    found = design(
        {
            "scene": cable(),
            "variables": [{"force": "string", "field": "stiffness", "tie": "all", "upper": 1e4}],
            "goals": [{"kind": "reaction", "anchor": "right", "axes": "x", "target": 4.0}],
        }
    )
    assert sag(found.variables[0]["value"], 1.0, 5.0) == pytest.approx(5.0 / 8.0, rel=TOLERANCE)


def test_two_strings_of_least_load_path_hang_at_45_degrees() -> None:
    """Strings from (-1, h) and (1, h) that hold a load P at the origin: the sum of |F| L is P (1 + h²) / h, least at
    h = 1 (Michell 1904), with the place of the load as a constraint and force densities free."""
    scene = {
        "particles": [[-1, 0, 0.5], [1, 0, 0.6], [0, 0, 0]],
        "forces": [
            {"kind": "springs", "name": "strings", "particles": [[0, 2], [1, 2]], "stiffness": 1, "rest_length": 0},
            {"kind": "unary", "particles": [2], "vector": [0, 0, -1]},
        ],
        "anchors": [{"name": "left", "particles": [0]}, {"name": "right", "particles": [1]}],
    }
    found = design(
        {
            "scene": scene,
            "variables": [
                {"force": "strings", "field": "stiffness", "lower": 0.01},
                {"anchor": "left", "axes": "z"},
                {"anchor": "right", "axes": "z"},
            ],
            "goals": [{"kind": "load_path", "force": "strings"}],
            "constraints": [{"kind": "position", "particles": [2], "lower": 0, "upper": 0}],
            "settings": {"tolerance": 1e-10},
        }
    )
    assert found.status == "converged" and found.objective == pytest.approx(2.0, rel=TOLERANCE)
    heights = [float(np.ravel(entry["value"])[0]) for entry in found.variables[1:]]
    assert heights == pytest.approx([1.0, 1.0], abs=TOLERANCE)


def test_three_equal_tensions_meet_in_the_fermat_point() -> None:
    """The sum of distances to three points is least where they are seen at 120 degrees; found here by Weiszfeld's
    iteration (1937)."""
    corners = np.array([[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [1.0, 3.0, 0.0]])
    scene = {
        "particles": [*corners.tolist(), [2.0, 1.2, 0.0]],
        "forces": [{"kind": "constant_tension", "name": "star", "particles": [[0, 3], [1, 3], [2, 3]], "tension": 1.0}],
        "anchors": [{"particles": [0, 1, 2]}, {"name": "knot", "particles": [3]}],
    }
    found = design(
        {
            "scene": scene,
            "variables": [{"anchor": "knot", "axes": "xy"}],
            "goals": [{"kind": "load_path", "force": "star"}],
            "settings": {"tolerance": 1e-13},
        }
    )
    point = corners.mean(axis=0)
    for _ in range(2000):
        near = 1.0 / np.linalg.norm(corners - point, axis=1)
        point = near @ corners / near.sum()
    assert np.ravel(found.variables[0]["value"]) == pytest.approx(point[:2], abs=TOLERANCE)


def net(m: int, densities: Any, load: float = -0.3) -> dict[str, Any]:
    """A square net of m x m meshes with force densities, held at its rim, under equal loads."""
    number = np.arange((m + 1) ** 2).reshape(m + 1, m + 1)
    pairs = [*zip(number[:-1].ravel(), number[1:].ravel(), strict=True)]
    pairs += [*zip(number[:, :-1].ravel(), number[:, 1:].ravel(), strict=True)]
    inside = number[1:-1, 1:-1].ravel()
    rim = np.setdiff1d(number, inside)
    points = [[i, j, 0.0] for i in range(m + 1) for j in range(m + 1)]
    pairs = [[int(a), int(b)] for a, b in pairs if not (a in rim and b in rim)]
    return {
        "particles": points,
        "forces": [
            {"kind": "springs", "name": "net", "particles": pairs, "stiffness": densities, "rest_length": 0.0},
            {"kind": "unary", "particles": inside.tolist(), "vector": [0, 0, load]},
        ],
        "anchors": [{"particles": rim.tolist()}],
    }


def heights(m: int, densities: np.ndarray, load: float = -0.3) -> np.ndarray:
    """The heights of its inner particles: C^T Q C z = p, by numpy."""
    scene = net(m, 1.0)
    pairs = np.array(scene["forces"][0]["particles"])
    inside = np.array(scene["forces"][1]["particles"])
    count = (m + 1) ** 2
    matrix = np.zeros((count, count))
    for (a, b), q in zip(pairs, densities, strict=True):
        matrix[[a, b], [a, b]] += q
        matrix[[a, b], [b, a]] -= q
    return np.linalg.solve(matrix[np.ix_(inside, inside)], np.full(len(inside), load))


@pytest.mark.parametrize("m", sampled([4, 7], 2))
def test_heights_are_recovered_from_their_own_densities(m: int) -> None:
    """Heights that random force densities give are reached from equal ones (compare jax_fdm's examples): to 1e-6."""
    rng = np.random.default_rng(m)
    count = len(net(m, 1.0)["forces"][0]["particles"])
    wanted = heights(m, rng.uniform(0.5, 2.0, count))
    scene = net(m, 1.0)
    inside = scene["forces"][1]["particles"]
    found = design(
        {
            "scene": scene,
            "variables": [{"force": "net", "field": "stiffness", "lower": 0.05, "upper": 20.0}],
            "goals": [{"kind": "position", "particles": inside, "axes": "z", "target": wanted.tolist()}],
        }
    )
    assert found.result.particles[inside, 2] == pytest.approx(wanted, abs=1e-6 * np.abs(wanted).max())
    own = np.asarray(found.variables[0]["value"])
    assert heights(m, own) == pytest.approx(wanted, abs=1e-6 * np.abs(wanted).max())


def test_an_arch_of_least_load_path() -> None:
    """A funicular line of n equal loads P and force density q over a span L: its load path q sum l² is least at the
    density that a scan of the closed form (a parabola with its nodes) finds; the rise tends to sqrt(3) L / 4."""
    n, span = 12, 10.0
    x = np.linspace(0.0, span, n + 1)

    def path(q: float) -> float:
        z = 0.5 / q * (x * n / span) * (n - x * n / span)  # q (z[i+1] - 2 z[i] + z[i-1]) = -1
        return float(q * ((span / n) ** 2 + np.diff(z) ** 2).sum())

    low, high = 0.1, 10.0
    for _ in range(200):  # golden section
        a, b = high - 0.618034 * (high - low), low + 0.618034 * (high - low)
        low, high = (low, b) if path(a) < path(b) else (a, high)
    scene = {
        "particles": [[float(v), 0.0, 0.0] for v in x],
        "forces": [
            {"kind": "springs", "name": "arch", "particles": [[i, i + 1] for i in range(n)],
             "stiffness": 1.0, "rest_length": 0.0},
            {"kind": "unary", "particles": list(range(1, n)), "vector": [0, 0, -1.0]},
        ],
        "anchors": [{"particles": [0, n]}],
    }  # fmt: skip
    found = design(
        {
            "scene": scene,
            "variables": [{"force": "arch", "field": "stiffness", "tie": "all", "lower": 0.1, "upper": 10.0}],
            "goals": [{"kind": "load_path", "force": "arch"}],
            "settings": {"tolerance": 1e-13},
        }
    )
    assert found.objective == pytest.approx(path(0.5 * (low + high)), rel=TOLERANCE)
    assert found.variables[0]["value"] == pytest.approx(0.5 * (low + high), rel=TOLERANCE)
    assert -found.result.particles[:, 2].min() / span == pytest.approx(np.sqrt(3) / 4, rel=0.01)


def test_constraints_hold_and_are_reported() -> None:
    """The lowest sag with no more than 6 N in the string: 6 = P l / (2 d) at the limit."""
    problem = {
        "scene": cable(),
        "variables": [{"force": "string", "field": "rest_length", "tie": "all", "lower": 0.5, "upper": 3.0}],
        "goals": [{"kind": "position", "particles": [1], "axes": "z", "target": 0.0}],
        "constraints": [{"kind": "force", "force": "string", "upper": 6.0}],
    }
    found = design(problem)
    d = -found.goals[0]["value"]
    assert found.status == "converged" and found.constraints[0]["met"]
    assert 5.0 * np.hypot(1.0, d) / (2.0 * d) == pytest.approx(6.0, rel=1e-5)


def test_what_cannot_be_met_is_reported_with_the_nearest_shape() -> None:
    """Half of the load is the least force of two vertical strings, so that 2 N cannot carry 5 N: infeasible, named,
    with a shape in equilibrium and no NaN. Contradictory limits are refused."""
    problem: dict[str, Any] = {
        "scene": cable(),
        "variables": [{"force": "string", "field": "rest_length", "tie": "all", "lower": 0.5, "upper": 3.0}],
        "goals": [{"kind": "position", "particles": [1], "axes": "z", "target": 0.0}],
        "constraints": [{"kind": "force", "name": "weak string", "force": "string", "upper": 2.0}],
    }
    found = design(problem)
    assert found.status == "infeasible" and "weak string" in found.message
    assert found.result.converged and np.isfinite(found.result.particles).all() and not found.constraints[0]["met"]
    assert found.variables[0]["at_bound"]
    problem["constraints"][0]["lower"] = 3.0
    with pytest.raises(InputError, match="lower is more than upper"):
        design(problem)
    for goals in ([], [{"kind": "position", "particles": [1], "target": [1, 2]}], [{"kind": "hight"}]):
        with pytest.raises(InputError):
            design({**problem, "constraints": [], "goals": goals})


@pytest.mark.parametrize(
    "part, values, pointer",
    [
        ("goals", {"axes": "q"}, "/goals/0/axes"),
        ("goals", {"kind": "hight"}, "/goals/0"),
        ("goals", {"particles": [0, -1]}, "/goals/0/particles/1"),
        ("goals", {"target": "low"}, "/goals/0/target"),
        ("variables", {"tie": "some"}, "/variables/0/tie"),
        ("variables", {"lower": "a"}, "/variables/0/lower"),
        ("settings", {"method": "magic"}, "/settings/method"),
        (
            "scene",
            {"forces": [{"kind": "springs", "particles": [[0, 1]], "stiffness": -1}]},
            "/scene/forces/0/stiffness",
        ),
    ],
)
def test_faults_point_to_what_was_given(part: str, values: dict[str, Any], pointer: str) -> None:
    """A fault's pointer has the steps of the problem as it is written, nothing of how it is read."""
    problem: dict[str, Any] = {
        "scene": cable(),
        "variables": [{"force": "string", "field": "rest_length"}],
        "goals": [{"kind": "position", "particles": [1], "axes": "z", "target": -0.7}],
        "settings": {},
    }
    (problem[part][0] if part in ("goals", "variables") else problem[part]).update(values)
    with pytest.raises(InputError) as error:
        design(problem)
    assert error.value.faults[0].pointer == pointer


def test_a_goal_beyond_the_bounds_sits_at_the_bound() -> None:
    """A sag of 3 is out of reach with rest lengths up to 1.5: the longest is best, is at its bound, and the gain is the
    slope of the closed form's (d - 3)²."""
    found = design(
        {
            "scene": cable(),
            "variables": [{"force": "string", "field": "rest_length", "tie": "all", "lower": 0.5, "upper": 1.5}],
            "goals": [{"kind": "position", "particles": [1], "axes": "z", "target": -3.0}],
        }
    )
    assert found.variables[0]["at_bound"] and found.variables[0]["value"] == pytest.approx(1.5)
    better = [(sag(100.0, 1.5 + way * 1e-4, 5.0) - 3.0) ** 2 for way in (-1, 1)]
    gain = (better[0] - better[1]) / 2e-4  # by which the objective falls as the bound gives way
    assert found.variables[0]["gain"] == pytest.approx(gain, rel=TOLERANCE)
    assert found.goals[0]["gains"] == {"string.rest_length": pytest.approx(gain, rel=TOLERANCE)}


def test_a_start_at_a_bound_is_left() -> None:
    """Both links of a string begin as long as they may be. Links of 0.9 of that have the forces that are asked for, so
    that the search gets there, to 1e-8 of their squares."""
    scene = a_string()
    at = {"force": "string", "field": "rest_length", "lower": 0.5, "upper": 1.0}
    links = [0, 1]
    short = hookean.relax(hookean.Scene.read(a_string(0.9))).force("string")["force"][links]
    goals = [{"kind": "force", "force": "string", "elements": links, "target": short.tolist()}]
    found = design({"scene": scene, "variables": [at], "goals": goals})
    assert found.method == "least_squares" and found.status == "converged"
    assert found.objective <= 1e-8 * float(short @ short)


def a_string(rest: float = 1.0) -> dict[str, Any]:
    """A weight between supports 2 apart, on links of a rest length."""
    return {
        "particles": [[-1, 0, 0], [0, 0, -0.2], [1, 0, 0]],
        "forces": [
            {"kind": "springs", "name": "string", "particles": [[0, 1], [1, 2]], "stiffness": 100, "rest_length": rest},
            {"kind": "unary", "particles": [1], "vector": [0, 0, -5]},
        ],
        "anchors": [{"particles": [0, 2]}],
    }


def test_the_caller_may_stop_it() -> None:
    """A search that is cancelled returns its best shape so far."""
    count = iter(range(100))
    found = design(
        {
            "scene": cable(),
            "variables": [{"force": "string", "field": "rest_length"}],
            "goals": [{"kind": "length", "force": "string", "target": 1.2}],
        },
        cancelled=lambda: next(count) > 2,
    )
    assert found.status == "cancelled" and found.result.converged


def test_the_command_reads_toml_and_writes_the_answer(tmp_path: Path) -> None:
    """`hookean design`: a scene beside the problem, the answer printed with units and as JSON, exit codes."""
    (tmp_path / "scene.json").write_text(json.dumps(cable()))
    problem = tmp_path / "problem.toml"
    text = """scene = "scene.json"
    [[variables]]
    force = "string"
    field = "rest_length"
    tie = "all"
    lower = 0.5
    upper = 2.0
    [[goals]]
    kind = "position"
    particles = [1]
    axes = "z"
    target = -0.7
    """
    problem.write_text(text)
    report = tmp_path / "answer.json"
    ran = CliRunner().invoke(app, [str(problem), "--report", str(report), "-o", str(tmp_path / "shape.json")])
    assert ran.exit_code == 0 and "goal position: -0.7 m, target -0.7" in ran.output
    answer = json.loads(report.read_text())
    assert set(answer) >= {
        "status", "message", "objective", "iterations", "variables", "goals", "constraints", "result"
    }  # fmt: skip
    assert hookean.relax(hookean.Scene.read(answer["scene"])).particles[1, 2] == pytest.approx(-0.7, rel=1e-5)
    problem.write_text(text.replace("rest_length", "rest_lenght"))
    ran = CliRunner().invoke(app, [str(problem)])
    assert ran.exit_code == 2 and "no column 'rest_lenght'" in ran.output and "Traceback" not in ran.output


def test_rounding_does_not_leave_the_bounds() -> None:
    """A value at its least one is this one, whatever its scale rounds to."""
    scene = cable()
    scene["forces"][0]["rest_length"] = [1.1, 0.3]
    variable = {"force": "string", "field": "rest_length", "lower": 0.0, "upper": 2.0}
    goal = {"kind": "position", "particles": [1], "axes": "z", "target": -0.7}
    search = Search(Problem.read({"scene": scene, "variables": [variable], "goals": [goal]}))
    lower, upper = search.bounds
    assert (search.given(lower * (1.0 + 1e-15)) == 0.0).all() and (search.given(upper * (1.0 + 1e-15)) == 2.0).all()
