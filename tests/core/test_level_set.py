"""Surfaces of constant potential: the sphere of one charge, and the ovals of two, in closed form."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hookean import Scene, relax
from hookean.errors import InputError
from hookean.system.system import compile

SETTINGS = {"tolerance": 1e-11, "max_iterations": 50000}


def at_rest(x: Any, **fields: Any) -> np.ndarray:
    force = {"kind": "level_set", "particles": range(len(x)), **fields}
    found = relax(Scene(particles=x, forces=[force], settings=SETTINGS))
    assert found.converged
    return found.particles


def test_one_charge_has_a_sphere_with_the_energy_of_a_spring() -> None:
    """phi = q / r: radius q / L, and E = k (r - q / L)^2 / 2 everywhere."""
    rng = np.random.default_rng(2)
    x, centre, q, level, k = rng.normal(size=(30, 3)), np.array([0.3, -0.2, 0.1]), 1.8, 1.5, 7.0
    force = {"kind": "level_set", "particles": range(30), "charges": [centre], "charge": q, "level": level}
    system = compile(Scene(particles=x, forces=[{**force, "strength": k}]))
    f, _, energies = system.evaluate(system.start())
    r = np.linalg.norm(x - centre, axis=1)
    off = r - q / level
    assert f == pytest.approx(-(k * off / r)[:, None] * (x - centre), abs=1e-12)
    assert energies.sum() == pytest.approx(0.5 * k * (off @ off), rel=1e-12)
    found = at_rest(x, charges=[centre], charge=q, level=level)
    assert np.linalg.norm(found - centre, axis=1) == pytest.approx(np.full(30, q / level), abs=1e-9)


def test_two_charges_far_apart_have_an_oval_each() -> None:
    """On the axis through both, at +-a: q / (a - s) + q / (a + s) = L where L a > 2 q has s = sqrt(a^2 - 2 q a / L)
    between them, and s = (q + sqrt(q^2 + L^2 a^2)) / L beyond."""
    a, q, level = 2.0, 0.8, 1.0
    inner, outer = np.sqrt(a * a - 2.0 * q * a / level), (q + np.sqrt(q * q + level**2 * a * a)) / level
    x = [[1.3, 0, 0], [-0.9, 0, 0], [3.2, 0, 0], [-2.1, 0, 0]]
    found = at_rest(x, charges=[[a, 0, 0], [-a, 0, 0]], charge=[q, q], level=level)
    assert found[:, 1:] == pytest.approx(np.zeros((4, 2)), abs=1e-12)
    assert found[:, 0] == pytest.approx([inner, -inner, outer, -outer], abs=1e-9)


def test_two_charges_near_each_other_have_one_waist() -> None:
    """In the middle of them, 2 q / sqrt(a^2 + y^2) = L: the radius of the waist is sqrt(4 q^2 / L^2 - a^2)."""
    a, q, level = 1.0, 0.8, 1.0
    x = [[0, 0.7, 0], [0, 0, -2.0], [0, 1.0, 1.0]]
    found = at_rest(x, charges=[[a, 0, 0], [-a, 0, 0]], charge=q, level=level)
    waist = np.sqrt(4.0 * q * q / level**2 - a * a)
    assert np.linalg.norm(found, axis=1) == pytest.approx(np.full(3, waist), abs=1e-9)
    assert found[:, 0] == pytest.approx(np.zeros(3), abs=1e-12)


def test_only_the_ratio_of_charges_to_level_matters() -> None:
    """All charges and L three times as large: the same surface; d, of the unit of q, is three times as large."""
    x = np.random.default_rng(1).normal(size=(10, 3))
    charges = [[0, 0, 0], [1.5, 0.2, 0]]
    one = at_rest(x, charges=charges, charge=[1.0, 0.5], level=1.2)
    other = at_rest(x, charges=charges, charge=[3.0, 1.5], level=3.6)
    for found in (one, other):
        r = np.linalg.norm(found[:, None] - np.array(charges), axis=2)
        assert (np.array([1.0, 0.5]) / r).sum(axis=1) == pytest.approx(np.full(10, 1.2), rel=1e-8)


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"charges": []}, "/forces/0/charges: no charges given; give at least one"),
        ({"charges": [[0, 0, 0]], "charge": [1, 2]}, "/forces/0/charge: 2 values for 1 charges"),
        ({"charges": [[0, 0, 0]], "charge": -1.0}, "/forces/0/charge: -1 given; more than 0 allowed"),
    ],
)
def test_charges_are_positive_and_there_is_one_value_for_each(fields: Any, message: str) -> None:
    with pytest.raises(InputError, match=message):
        Scene(particles=[[0, 0, 0]], forces=[{"kind": "level_set", "particles": [0], **fields}])
