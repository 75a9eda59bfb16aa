"""Columns that a force takes as a whole, by elements: which number each element reads, found by digits."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hookean.designing import columns
from hookean.designing.equilibrium import settle
from hookean.designing.problem import Problem
from hookean.designing.readers import balanced, readers
from hookean.designing.sensitivity import sensitivity
from hookean.designing.unknowns import Unknowns
from hookean.system.system import compile

from .test_many import mesh


def test_codes_are_different_and_half_full() -> None:
    """As many digits as the least even n with n choose n/2 codes."""
    for count, digits in ((1, 2), (2, 2), (3, 4), (6, 4), (7, 6), (10_000, 16)):
        codes = balanced(count)
        assert codes.shape == (count, digits) and len(np.unique(codes, axis=0)) == count
        assert (2 * codes.sum(axis=1) == digits).all()


def test_elements_that_read_one_number_are_found_and_others_are_reported() -> None:
    """Elements that read a number, or none; one that reads two is not of one number."""
    own = np.random.default_rng(4).integers(-1, 900, 5000)
    assert np.array_equal(readers(900, lambda some: np.where(own >= 0, some[own], False)), own)
    assert readers(900, lambda some: some[np.maximum(own, 0)] | some[(own + 1) % 900]) is None


def cloth(m: int, spread: float = 1.0, **more: Any) -> Problem:
    """A membrane of m x m quads with a prestress of its own in each, and the height of a vertex as the goal."""
    rng = np.random.default_rng(m)
    prestress = np.column_stack([3.0 + spread * rng.uniform(-1.0, 1.0, (m * m, 2)), np.zeros(m * m)])
    scene = mesh(m, {"kind": "membrane", "warp_stiffness": 50.0, "prestress": prestress.tolist()})
    scene["settings"] = {"solver": "newton", "tolerance": 1e-12}
    goal = {"kind": "position", "particles": [(m // 2) * (m + 1) + m // 3 + 1], "axes": "z"}
    variables = [{"force": "it", "field": "prestress", **more}]
    return Problem.read({"scene": scene, "variables": variables, "goals": [goal]})


def test_the_prestress_of_each_face_takes_a_few_compilations(monkeypatch: pytest.MonkeyPatch) -> None:
    """48 numbers of 16 faces, each cut into four triangles: derivatives are those of one number at a time, which are
    differences of the same kernel, to its rounding of 1e-9 of the largest; 6 digits and 8 compilations, not 96."""
    problem = cloth(4)
    system = compile(problem.scene)
    unknowns, state = Unknowns(problem, system), system.start()
    found, y = settle(system, state, once=True), np.random.default_rng(1).normal(size=state.x.shape)
    taken, compiled = [], columns.compiled
    monkeypatch.setattr(columns, "compiled", lambda *given: taken.append(1) or compiled(*given))
    own = unknowns.work(found, y)
    assert len(own) == 48 and len(taken) <= 6 + 1 + 2 * 3
    monkeypatch.setattr(columns, "MANY", 10**6)
    one_by_one = unknowns.work(found, y)
    assert own == pytest.approx(one_by_one, abs=1e-9 * np.abs(one_by_one).max())


def test_faces_and_directions_of_a_prestress_vary_by_tie_and_axes() -> None:
    """A value for two lists of faces along warp and weft (axes x and y): sums of the derivatives of each face."""
    each = sensitivity(cloth(4, 0.0)).gradient[0]
    lists = [[0, 1, 5], [*range(8, 16)]]
    tied = sensitivity(cloth(4, 0.0, tie=lists, axes="xy")).gradient[0]
    sums = np.array([each[faces, :2].sum(axis=0) for faces in lists])
    assert tied == pytest.approx(sums, abs=1e-8 * np.abs(sums).max())
