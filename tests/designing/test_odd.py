"""Problems that cannot be met, have no end, contradict themselves or are badly scaled; and random ones, whose status is
re-checked by an evaluation of its own."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hookean.designing.problem import Problem
from hookean.designing.search import Search, design
from hookean.designing.unknowns import Unknowns
from hookean.errors import InputError
from hookean.forces.springs import Springs
from hookean.scene.scene import Scene
from hookean.system.system import compile
from soak import SOAK

from .test_gradients import cable, sag

FREE = {"force": "string", "field": "rest_length", "tie": "all", "lower": 0.5, "upper": 3.0}


def level(**more: Any) -> dict[str, Any]:
    """The height of the string's middle."""
    return {"kind": "position", "particles": [1], "axes": "z", **more}


@pytest.mark.soak
def test_an_objective_without_end_is_reported() -> None:
    """The longer the string the lower it hangs: no lowest shape. The variable is named and the shape is at rest."""
    variable = {"force": "string", "field": "rest_length", "tie": "all"}
    found = design({"scene": cable(), "variables": [variable], "goals": [level()]})
    assert found.status == "unbounded" and "string.rest_length grows" in found.message
    assert np.isfinite(found.result.particles).all() and np.isfinite(found.objective)


@pytest.mark.slow
@pytest.mark.parametrize("constrained", [False, True])
@pytest.mark.parametrize(
    ("variable", "name"),
    [
        ({"force": "load", "field": "vector", "axes": "z"}, "load.vector"),
        ({"anchor": "left", "axes": "z"}, "anchor left"),
        ({"particles": [1], "field": "drawn"}, "drawn position"),
        ({"force": "string", "field": "stiffness", "tie": "all"}, "string.stiffness"),
    ],
)
def test_each_variable_that_has_no_end_is_named(variable: dict[str, Any], name: str, constrained: bool) -> None:
    """Larger loads, lower anchors, longer drawn strings and softer ones let the middle down as far as one likes."""
    scene = cable()
    if "particles" in variable:
        del scene["forces"][0]["rest_length"]
    beside = [{"kind": "position", "particles": [1], "axes": "x", "lower": -100}] if constrained else []
    found = design({"scene": scene, "variables": [variable], "goals": [level()], "constraints": beside})
    assert found.status == "unbounded" and name in found.message
    assert np.isfinite(found.result.particles).all() and np.isfinite(found.objective)


def straight(height: float, **more: Any) -> dict[str, Any]:
    """A string whose lengths are measured from a drawn middle, and its sag as the goal."""
    scene = cable()
    scene["particles"][1] = [0, 0, height]
    scene["forces"][0] = {"kind": "springs", "name": "string", "particles": [[0, 1], [1, 2]], "stiffness": 1000}
    variable = {"particles": [1], "field": "drawn", "axes": "z"}
    return {"scene": scene, "variables": [variable], "goals": [level(target=-0.7)], **more}


def test_a_start_that_is_stationary_by_symmetry_is_reported() -> None:
    """Drawn straight, the string gets longer whichever way its middle is drawn: the derivative is 0, and no goal is
    met. A little below the line the search arrives."""
    found = design(straight(0.0))
    assert found.status == "stalled" and "stationary by symmetry" in found.message
    assert design(straight(-0.05)).goals[0]["met"]


def test_a_start_that_is_a_minimum_is_not_taken_for_a_saddle() -> None:
    """The goal is nearest at the start, where its derivative is 0: a sag of less than that of a straight string."""
    problem = straight(0.0)
    problem["goals"][0]["target"] = 0.0
    assert design(problem).status == "converged"


def test_a_shape_that_a_relaxation_does_not_find_is_reported() -> None:
    """Two stiff bars drawn below their supports and pulled through them: as the load falls to 0 they stay above, while
    from the drawn shape they stay below, twice as far as they are from the line of the supports."""
    scene = {
        "particles": [[-1, 0, 0], [0, 0, -0.3], [1, 0, 0]],
        "forces": [
            {"kind": "springs", "name": "s", "particles": [[0, 1], [1, 2]], "stiffness": 100, "rest_length": 1.1},
            {"kind": "unary", "name": "l", "particles": [1], "vector": [0, 0, 20.0]},
        ],
        "anchors": [{"particles": [0, 2]}],
    }
    variable = {"force": "l", "field": "vector", "axes": "z", "tie": "all"}
    found = design({"scene": scene, "variables": [variable], "goals": [level(target=0.44)]})
    assert found.goals[0]["value"] > 0.0 and any("another equilibrium" in said for said in found.warnings)


def test_the_best_shape_is_returned_where_its_values_have_another() -> None:
    """Two bars stand above or below their supports by the same values. The search saw both, the one below was nearer to
    the goal: that is the best, whichever was seen last."""
    height = 0.5
    bars = {"kind": "springs", "name": "bars", "particles": [[0, 1], [1, 2]], "stiffness": 100.0}
    scene = {
        "particles": [[-1, 0, 0], [0, 0, -height], [1, 0, 0]],
        "forces": [{**bars, "rest_length": float(np.hypot(1.0, height))}],
        "anchors": [{"particles": [0, 2]}, {"particles": [1], "axes": "y"}],
    }
    goal = {"kind": "position", "particles": [1], "axes": "z", "target": -height}
    search = Search(
        Problem.read({"scene": scene, "variables": [{"force": "bars", "field": "stiffness"}], "goals": [goal]})
    )
    y = np.zeros(search.unknowns.count)
    search._resting, search.found = search.state.x * [1.0, 1.0, -1.0], None
    assert search.at(y).x[1, 2] == pytest.approx(height, abs=1e-9)
    search.note(y)
    assert search.at_best().x[1, 2] == pytest.approx(-height, abs=1e-9)


def test_constraints_that_contradict_one_another_are_named() -> None:
    """Two heights of one particle: least squares of what is missed leave both halfway, and the sentence names both."""
    constraints = [level(lower=z, upper=z, name=name) for z, name in ((-0.5, "high"), (-0.9, "low"))]
    found = design({"scene": cable(), "variables": [FREE], "goals": [], "constraints": constraints})
    assert found.status == "infeasible" and "high, low" in found.message
    assert found.constraints[0]["value"] == pytest.approx(-0.7, rel=1e-6)
    assert found.result.converged and found.constraints[0]["gain"] is None


def test_badly_scaled_variables_reach_their_goals() -> None:
    """A load of 5e-6 N on springs of 100 N/m where 20 N are asked of a support, and weights of 1e6 beside 1e-6."""
    scene = cable()
    scene["forces"][0]["stiffness"] = 1e2
    scene["forces"][1]["vector"] = [0, 0, -5e-6]
    found = design(
        {
            "scene": scene,
            "variables": [
                {"force": "string", "field": "rest_length", "tie": "all", "lower": 1e-3},
                {"force": "load", "field": "vector", "axes": "z", "tie": "all"},
            ],
            "goals": [
                level(target=-0.4, weight=1e6),
                {"kind": "reaction", "anchor": "left", "axes": "z", "target": 20.0, "weight": 1e-6},
            ],
        }
    )
    rest, load = found.variables[0]["value"], float(np.ravel(found.variables[1]["value"])[0])
    assert load == pytest.approx(-40.0, rel=1e-6) and sag(100.0, rest, 40.0) == pytest.approx(0.4, rel=1e-6)


def test_a_start_without_an_equilibrium_is_reported() -> None:
    """A weight that nothing holds falls: the search reports this and returns the start."""
    scene = cable()
    scene["anchors"] = []
    found = design({"scene": scene, "variables": [FREE], "goals": [level(target=-1.0)]})
    assert found.status == "stalled" and found.message.startswith("The start has no equilibrium")
    assert np.isfinite(found.objective)


class Chain:
    """A funicular chain of force densities between two ends, by numpy: what a problem asks of it."""

    def __init__(self, seed: int) -> None:
        self.rng = rng = np.random.default_rng(seed)
        self.n = int(rng.integers(2, 6))
        self.end = np.array([rng.uniform(2.0, 6.0), 0.0, rng.uniform(-1.0, 1.0)])
        self.loads = np.array([[rng.uniform(-0.3, 0.3), 0.0, -rng.uniform(0.5, 2.0)] for _ in range(self.n - 1)])
        self.low, self.high = rng.uniform(0.2, 0.8), rng.uniform(3.0, 9.0)
        self.start = rng.uniform(1.0, 3.0, self.n)

    def shape(self, q: np.ndarray) -> np.ndarray:
        """Places (n + 1, 3): C^T Q C x = p."""
        k = np.diag(q[:-1] + q[1:]) - np.diag(q[1:-1], 1) - np.diag(q[1:-1], -1)
        right = self.loads.copy()
        right[-1] += q[-1] * self.end
        return np.vstack([np.zeros(3), np.linalg.solve(k, right), self.end])

    def measure(self, part: dict[str, Any], q: np.ndarray) -> np.ndarray:
        """Values of a goal or constraint."""
        x = self.shape(q)
        length = np.linalg.norm(np.diff(x, axis=0), axis=1)
        if part["kind"] == "position":
            return x[part["particles"], 2]
        return {"length": length, "force": q * length, "load_path": np.array([(q * length**2).sum()])}[part["kind"]]

    def part(self) -> dict[str, Any]:
        """A random quantity."""
        kind = self.rng.choice(["position", "length", "force", "load_path"])
        if kind == "position":
            return {"kind": "position", "axes": "z", "particles": [int(self.rng.integers(1, self.n))]}
        return {"kind": str(kind), "force": "chain"}

    def problem(self) -> dict[str, Any]:
        """One or two goals, and up to two constraints near what other densities give."""
        rng, goals, constraints = self.rng, [], []
        for _ in range(rng.integers(1, 3)):
            part, other = self.part(), rng.uniform(self.low, self.high, self.n)
            goals.append({**part, "target": self.measure(part, other).tolist()} if rng.random() < 0.7 else part)
        for _ in range(rng.integers(0, 3)):
            part = self.part()
            values = self.measure(part, rng.uniform(self.low, self.high, self.n))
            limit = float(values.max() * rng.uniform(0.8, 1.2)) if rng.random() < 0.5 else float(values.min())
            constraints.append({**part, str(rng.choice(["lower", "upper"])): limit})
        links = [[i, i + 1] for i in range(self.n)]
        forces = [
            {"kind": "springs", "name": "chain", "particles": links, "stiffness": self.start.tolist(),
             "rest_length": 0.0},
            {"kind": "unary", "particles": list(range(1, self.n)), "vector": self.loads.tolist()},
        ]  # fmt: skip
        points = [(self.end * i / self.n).tolist() for i in range(self.n + 1)]
        variable = {"force": "chain", "field": "stiffness", "lower": self.low, "upper": self.high}
        scene = {"particles": points, "forces": forces, "anchors": [{"particles": [0, self.n]}]}
        return {"scene": scene, "variables": [variable], "goals": goals, "constraints": constraints}

    def judged(self, problem: dict[str, Any], q: np.ndarray) -> tuple[float, float]:
        """The most by which a constraint is missed, in parts of its values, and the objective."""
        missed = objective = 0.0
        for goal in problem["goals"]:
            values = self.measure(goal, q)
            objective += float(((values - goal["target"]) ** 2).sum() if "target" in goal else values.sum())
        for part in problem["constraints"]:
            values = self.measure(part, q)
            over = max(
                float((part.get("lower", -np.inf) - values).max()), float((values - part.get("upper", np.inf)).max())
            )
            missed = max(missed, over / max(np.abs(values).max(), 1.0))
        return missed, objective


@pytest.mark.soak
@settings(max_examples=200 if SOAK else 6)
@given(seed=st.integers(0, 10**6))
def test_the_status_of_random_problems_is_true(seed: int) -> None:
    """`converged`: the values meet bounds and constraints to 1e-5 by another evaluation, and no small step that does is
    better by 1e-4 of the objective. `infeasible`: constraints are missed there, and at each of 200 random values."""
    chain = Chain(seed)
    problem = chain.problem()
    found = design(problem)
    q = np.asarray(found.variables[0]["value"])
    assert (q >= chain.low - 1e-9).all() and (q <= chain.high + 1e-9).all()
    missed, objective = chain.judged(problem, q)
    assert objective == pytest.approx(found.objective, rel=1e-6, abs=1e-9)
    assert found.status in ("converged", "infeasible", "max_iterations", "stalled")
    if found.status == "infeasible":
        assert missed > 1e-7
        tries = chain.rng.uniform(chain.low, chain.high, (200, chain.n))
        assert all(chain.judged(problem, other)[0] > 0.0 for other in tries)
        return
    assert missed <= 1e-5 and all(entry["met"] for entry in found.constraints)
    for size in (1e-2, 1e-3) if found.status == "converged" else ():
        steps = size * q * chain.rng.normal(size=(60, chain.n))
        for other in np.clip(q + steps, chain.low, chain.high):
            over, value = chain.judged(problem, other)
            assert over > 0.0 or value >= objective - 1e-4 * (abs(objective) + 1e-3)


@pytest.mark.parametrize(("kind", "field"), [("springs", "stiffness"), ("springs", "rest_length"), ("unary", "vector")])
def test_a_column_is_at_least_0_where_the_force_refuses_less(kind: str, field: str) -> None:
    """The bound, from the field alone where that suffices, is what the whole force says of a negative number."""
    forces: list[dict[str, Any]] = [
        {"kind": "springs", "particles": [[0, 1]], "stiffness": [2.0], "rest_length": [0.5]},
        {"kind": "unary", "particles": [1], "vector": [[1.0, 2.0, 3.0]]},
    ]
    scene = {"particles": [[0, 0, 0], [1, 0, 0]], "forces": forces, "anchors": [{"particles": [0]}]}
    problem = Problem.read({"scene": scene, "variables": [{"force": kind, "field": field}], "goals": [level()]})
    wanted = 0.0
    forces[kind == "unary"][field] = [[-1.0, 2.0, 3.0]] if kind == "unary" else [-1.0]
    try:
        Scene.read(scene)
        wanted = -np.inf
    except InputError:
        pass
    assert Unknowns(problem, compile(problem.scene)).lower[0] == wanted


def test_a_start_near_the_largest_number_stays_between_its_bounds() -> None:
    """Two bars of 8e11 N/m, where searches without bounds go no further than 5e11: a load F between them moves their
    joint by F / (k1 + k2), here by that of 1.4e12 N/m together."""
    scene = {
        "particles": [[0, 0, 0], [1, 0, 0], [2, 0, 0]],
        "forces": [
            {"kind": "springs", "name": "bar", "particles": [[0, 1], [1, 2]], "stiffness": 8e11},
            {"kind": "unary", "particles": [1], "vector": [1e9, 0, 0]},
        ],
        "anchors": [{"particles": [0, 2]}],
    }
    found = design(
        {
            "scene": scene,
            "variables": [{"force": "bar", "field": "stiffness", "lower": 6e11, "upper": 9e11}],
            "goals": [{"kind": "length", "force": "bar", "target": [1.0 + 1e9 / 1.4e12, 1.0 - 1e9 / 1.4e12]}],
            "settings": {"method": "l-bfgs-b"},
        }
    )
    assert found.status == "converged"
    bars = found.scene.forces[0]
    assert isinstance(bars, Springs) and np.sum(bars.stiffness) == pytest.approx(1.4e12, rel=1e-3)
