"""Equal angles: a fan of bars divides its angle evenly, groups by their numbers, and a load on one bar."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

from hookean import InputError, Scene, relax


def fan(angles: Any, *forces: Any, **columns: Any) -> Any:
    """Bars of length 1 from the origin at these angles in a plane, of which the first and the last are held."""
    n = len(angles)
    ends = np.column_stack([np.cos(angles), np.sin(angles), np.zeros(n)])
    pairs = [[0, i + 1, 0, i + 2] for i in range(n - 1)]
    return relax(
        Scene(
            particles=[[0, 0, 0], *ends],
            forces=[
                {"kind": "equal_angle", "particles": pairs, "strength": 2.0, **columns},
                {"kind": "springs", "particles": [[0, i + 1] for i in range(n)], "stiffness": 1e8, "damping": 0.0},
                *forces,
            ],
            anchors=[{"particles": [0, 1, n]}, {"particles": range(2, n), "axes": "z"}],
            settings={"tolerance": 1e-9, "solver": "newton"},
        )
    )


def test_a_fan_divides_its_angle_evenly() -> None:
    """Between two held bars the only shape without moments, whatever the strength."""
    found = fan([0.2, 0.3, 1.0, 1.1, 2.2], strength=[1.0, 5.0, 2.0, 30.0])
    assert found.converged
    assert found.forces[0]["angle"] == pytest.approx(np.full(4, 0.5), abs=1e-7)
    assert found.forces[0]["moment"] == pytest.approx(np.zeros(4), abs=1e-6)


def test_a_load_turns_the_middle_bar() -> None:
    """Angles t and 1 - t have the mean 1/2: E = S (t - 1/2)^2, and the load P along y does P cos t: 2 S (t - 1/2) =
    P cos t. Both moments are S (t - 1/2) and its opposite. The bar stretches by P / k = 1e-8."""
    found = fan([0.0, 0.4, 1.0], {"kind": "unary", "particles": [2], "vector": [0.0, 1.0, 0.0]})
    turn = brentq(lambda t: 4.0 * (t - 0.5) - np.cos(t), 0.0, 1.0, xtol=1e-14)
    assert found.converged
    assert found.forces[0]["angle"] == pytest.approx([turn, 1.0 - turn], abs=1e-7)
    assert found.forces[0]["moment"] == pytest.approx([2.0 * (turn - 0.5), -2.0 * (turn - 0.5)], abs=1e-6)


def test_pairs_with_the_same_number_are_a_group() -> None:
    """Two groups of two: each divides what is between its held bars, here the first, the middle and the last."""
    soft = {"kind": "anchor_spring", "particles": [3], "strength": 1e8}
    found = fan([0.0, 0.1, 0.8, 1.0, 2.6], soft, group=[0, 0, 1, 1])
    assert found.converged
    assert found.forces[0]["angle"] == pytest.approx([0.4, 0.4, 0.9, 0.9], abs=1e-6)


def test_numbers_of_groups_are_one_for_each_pair() -> None:
    with pytest.raises(InputError, match="/forces/0/group: 1 values for 2 elements"):
        fan([0.0, 0.4, 1.0], group=[1])
