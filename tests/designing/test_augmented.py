"""Many constraints by an augmented Lagrangian: optima that are known otherwise, and its limits met."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import hookean
from hookean.designing.augmented import Penalised
from hookean.designing.problem import Problem
from hookean.designing.search import LIMITS, Search, chosen, design
from hookean.errors import InputError

from .test_many import recovery
from .test_search import net


def limited(m: int, **settings: Any) -> dict[str, Any]:
    """The least load path of a net of m x m meshes, with links no longer than 70 % of them are now."""
    scene = net(m, 1.0)
    pairs = np.array(scene["forces"][0]["particles"])
    x = hookean.relax(hookean.Scene.read(scene)).particles
    longest = float(np.quantile(np.linalg.norm(x[pairs[:, 1]] - x[pairs[:, 0]], axis=1), 0.7))
    return {
        "scene": scene,
        "variables": [{"force": "net", "field": "stiffness", "lower": 0.05, "upper": 20.0}],
        "goals": [{"kind": "load_path", "force": "net"}],
        "constraints": [{"kind": "length", "force": "net", "upper": longest}],
        "settings": settings,
    }


@pytest.mark.soak
def test_the_optimum_is_that_of_sequential_quadratic_programming() -> None:
    """Two methods that share no step end at one objective: each to 1e-6 of its own conditions, 1e-5 of the least."""
    one, two = (design(limited(4, method=method)) for method in ("augmented_lagrangian", "slsqp"))
    assert one.method == "augmented_lagrangian" and one.status == two.status == "converged"
    assert one.objective == pytest.approx(two.objective, rel=1e-5)
    assert all(entry["met"] for entry in one.constraints)


def test_many_limits_on_a_net_of_given_heights() -> None:
    """144 forces of at most what the net of the targets has: the heights are reached, and the limits are met by a
    relaxation of the answer's scene, to 1e-6 of their size."""
    problem, densities = recovery(9)
    springs = problem["scene"]["forces"][0]
    wanted = {
        **problem["scene"],
        "forces": [{**springs, "stiffness": densities.tolist()}, *problem["scene"]["forces"][1:]],
    }
    pairs = np.array(springs["particles"])

    def forces(x: np.ndarray, q: np.ndarray) -> np.ndarray:
        return q * np.linalg.norm(x[pairs[:, 1]] - x[pairs[:, 0]], axis=1)

    limit = float(forces(hookean.relax(hookean.Scene.read(wanted)).particles, densities).max())
    problem["constraints"] = [{"kind": "force", "force": "net", "upper": limit}]
    found = design(problem)
    assert found.method == "augmented_lagrangian" and found.status == "converged"
    again = hookean.relax(found.scene)
    q = np.asarray(found.variables[0]["value"])
    assert forces(again.particles, q).max() <= limit * (1.0 + 1e-6)
    target = np.asarray(problem["goals"][0]["target"])
    inside = problem["goals"][0]["particles"]
    assert np.abs(again.particles[inside, 2] - target).max() <= 1e-5 * np.abs(target).max()


def test_the_method_is_chosen_by_the_number_of_limits() -> None:
    """Above LIMITS values where all goals have targets; and it needs constraints."""
    problem, _ = recovery(9)
    assert LIMITS < 144
    few = {**problem, "constraints": [{"kind": "force", "force": "net", "upper": 9.0, "elements": [0, 1]}]}
    many = {**problem, "constraints": [{"kind": "force", "force": "net", "upper": 9.0}]}
    assert [chosen(Search(Problem.read(each))) for each in (few, many)] == ["slsqp", "augmented_lagrangian"]
    with pytest.raises(InputError, match="augmented_lagrangian needs constraints"):
        design({**problem, "settings": {"method": "augmented_lagrangian"}})


def test_goals_that_are_minimised_have_roots() -> None:
    """Squares of the roots of the load paths of all links add up to the whole, but for 1e-6 of the first, at all
    densities; so their slope is that of the objective, by an adjoint of its own. Force densities may be of
    either sign: with those the method is that of few limits."""
    problem = limited(9)
    search = Search(Problem.read(problem))
    round_, rng = Penalised(search, 1.0), np.random.default_rng(4)
    assert round_.roots.possible and chosen(search) == "augmented_lagrangian"
    round_.low[:], round_.high[:] = -np.inf, np.inf  # no limits
    first = search.objective(np.zeros(search.unknowns.count))
    for _ in range(3):
        y = rng.uniform(-0.3, 1.0, search.unknowns.count)
        r = round_.residuals(y)
        assert r @ r == pytest.approx(search.objective(y) + 1e-6 * first, rel=1e-12)
        assert 2.0 * round_.linearised(y).transposed(r) == pytest.approx(search.gradient(y), rel=1e-7, abs=1e-9 * first)
    shape = {"kind": "force_density", "force": "net"}
    assert chosen(Search(Problem.read({**problem, "goals": [shape]}))) == "slsqp"


@pytest.mark.soak
def test_limits_that_contradict_one_another_are_infeasible() -> None:
    """Links cannot be shorter than the straight way between supports."""
    problem = limited(4, method="augmented_lagrangian")
    problem["constraints"][0]["upper"] = 0.5
    found = design(problem)
    assert found.status == "infeasible" and np.isfinite(found.objective)
