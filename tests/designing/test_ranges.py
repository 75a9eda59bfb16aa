"""The range of numbers that columns take: found where the model refuses more than fields do, and kept by searches."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import hookean
from hookean.designing.problem import Problem
from hookean.designing.ranges import natural
from hookean.designing.search import Search
from hookean.forces import KINDS

CORNERS = [[0, 0, 0], [2, 0, 0], [2, 1, 0], [0, 1, 0]]
POISSON = {"force": "c", "field": "poisson", "tie": "all"}


def strip(poisson: float, **parts: Any) -> dict[str, Any]:
    """A cloth of 2 by 1, drawn by 40 along it: E per width 600, free to contract."""
    cloth = {"warp_stiffness": 600.0, "weft_stiffness": 600.0, "shear_stiffness": 200.0, "warp": [1, 0, 0], **parts}
    return {
        "particles": CORNERS,
        "meshes": {"m": {"vertices": CORNERS, "faces": [[0, 1, 2, 3]]}},
        "forces": [
            {"kind": "membrane", "name": "c", "mesh": "m", **cloth, "poisson": poisson},
            {"kind": "unary", "particles": [1, 2], "vector": [20.0, 0, 0]},
        ],
        "anchors": [
            {"particles": [0, 3], "axes": "xz"},
            {"particles": [1, 2], "axes": "z"},
            {"particles": [0, 1], "axes": "y"},
        ],
        "settings": {"tolerance": 1e-11},
    }


@pytest.mark.parametrize("given", [{}, {"lower": -0.9, "upper": 0.9}])
def test_a_contraction_may_be_negative(given: dict[str, float]) -> None:
    """The width of a strip whose ratio is -0.2 is found from 0.3, past 0."""
    goal = {"kind": "position", "particles": [2], "axes": "y"}
    width = hookean.relax(hookean.Scene.read(strip(-0.2))).particles[2, 1]
    problem = {"variables": [{**POISSON, **given}], "goals": [{**goal, "target": float(width)}]}
    found = hookean.design({"scene": strip(0.3), **problem})
    assert found.status == "converged" and found.variables[0]["value"] == pytest.approx(-0.2, abs=1e-6)


def test_derivatives_at_zero_but_for_rounding() -> None:
    """Where a search comes by 0 differences are taken of the size that the values had at first."""
    goal = {"kind": "position", "particles": [2], "axes": "y", "target": 0.5}
    search = Search(Problem.read({"scene": strip(0.3), "variables": [POISSON], "goals": [goal]}))
    slopes = [search.gradient(np.array([value / 0.3 - 1.0]))[0] for value in (0.0, 5e-17, 1e-6)]
    assert np.ptp(slopes) < 1e-5 * abs(slopes[0])


@pytest.mark.parametrize(("target", "end"), [(0.9, 1), (1.2, -1)])
def test_a_search_stays_within_the_range(target: float, end: int) -> None:
    """Widths that no ratio gives: the answer is at the end of the range, |nu| < sqrt(warp / weft) = 1."""
    goal = {"kind": "position", "particles": [2], "axes": "y", "target": target}
    found = hookean.design({"scene": strip(0.3), "variables": [POISSON], "goals": [goal]})
    assert found.status == "converged" and found.variables[0]["at_bound"]
    assert 0.98 < end * found.variables[0]["value"] < 1.0


def test_ranges_are_those_of_the_model() -> None:
    """sqrt(600 / 400) for unlike stiffnesses, less a hundredth of the way; 0 where fields refuse negative numbers."""
    scene = strip(0.3, weft_stiffness=400.0)
    goal = {"kind": "position", "particles": [2], "axes": "y", "target": 1.0}
    stiff = {"force": "c", "field": "shear_stiffness"}
    unknowns = Search(Problem.read({"scene": scene, "variables": [POISSON, stiff], "goals": [goal]})).unknowns
    most = np.sqrt(1.5)
    assert unknowns.upper[0] == pytest.approx(most - 0.01 * (most - 0.3), rel=1e-6)
    assert unknowns.lower[0] == pytest.approx(-most + 0.01 * (most + 0.3), rel=1e-6)
    assert (unknowns.lower[1], unknowns.upper[1]) == (0.0, np.inf)


def test_limits_that_are_allowed_are_the_ends() -> None:
    membrane = KINDS["membrane"]
    found = natural(membrane, "poisson", np.array([[0.3], [0.1]]), lambda v: bool((np.abs(v) <= 0.5).all()))
    assert found == (-0.5, 0.5)
    assert natural(membrane, "poisson", np.array([[0.3]]), lambda v: bool((v >= 0.0).all()))[0] == 0.0


def test_bounds_beyond_the_range_are_refused() -> None:
    goal = {"kind": "position", "particles": [2], "axes": "y", "target": 1.0}
    for given, said in (({"lower": 2.0}, "2 given; poisson is at most 0.99"), ({"upper": -2.0}, "is at least -0.98")):
        with pytest.raises(hookean.InputError, match=said):
            hookean.design({"scene": strip(0.3), "variables": [{**POISSON, **given}], "goals": [goal]})
