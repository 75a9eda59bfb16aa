"""Equal lengths: divisions of a polyline, groups by their numbers, loads, and means weighted by stiffness."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hookean import InputError, Scene, relax


def chain(x: Any, *forces: Any, axes: str = "yz", **columns: Any) -> Any:
    """Lines between particles at these x; both ends are held, the others on some axes."""
    n = len(x)
    pairs = [[i, i + 1] for i in range(n - 1)]
    return relax(
        Scene(
            particles=np.outer(x, [1, 0, 0]),
            forces=[{"kind": "equal_length", "particles": pairs, "stiffness": 30.0, **columns}, *forces],
            anchors=[{"particles": [0, n - 1]}, {"particles": range(1, n - 1), "axes": axes}],
            settings={"tolerance": 1e-11},
        )
    )


def test_a_polyline_between_two_points_is_divided_evenly() -> None:
    """The only shape without force and without a fold, whatever the stiffness."""
    found = chain([0.0, 0.5, 1.1, 1.9, 2.3, 3.0], stiffness=[10.0, 20.0, 30.0, 15.0, 20.0])
    assert found.converged
    assert found.particles[:, 0] == pytest.approx(np.linspace(0.0, 3.0, 6), abs=1e-9)
    assert found.forces[0]["length"] == pytest.approx(np.full(5, 0.6), abs=1e-9)


def test_a_load_moves_the_middle_by_half_of_p_over_k() -> None:
    """Lengths p and L - p have the mean L / 2: E = k (p - L / 2)^2, p = L / 2 + P / (2 k), tensions +-P / 2."""
    found = chain([0.0, 0.8, 3.0], {"kind": "unary", "particles": [1], "vector": [12.0, 0, 0]})
    assert found.converged
    assert found.particles[1, 0] == pytest.approx(1.5 + 12.0 / 60.0, abs=1e-9)
    assert found.forces[0]["force"] == pytest.approx([6.0, -6.0], abs=1e-8)


def test_lines_with_the_same_number_are_a_group() -> None:
    """Lines 0, 2 and 1, 3 in turn have lengths a and b with 2 a + 2 b = 3. A soft anchor at the end of line 0
    rests without force at a = 0.4."""
    soft = {"kind": "anchor_spring", "particles": [1], "targets": [[0.4, 0, 0]], "strength": 5.0}
    found = chain([0.0, 0.7, 1.1, 2.0, 3.0], soft, group=[4, -2, 4, -2])
    assert found.converged
    assert found.forces[0]["length"] == pytest.approx([0.4, 1.1, 0.4, 1.1], abs=1e-8)
    assert found.stability == "stable"


def test_a_stiff_line_has_more_weight_in_the_mean() -> None:
    """Two springs apart, K = 10 and L = 1, 2: tensions k1 (l1 - m) = -k2 (l2 - m), so T = (l1 - l2) k1 k2 / (k1 + k2),
    l1 = 1 - T / K, l2 = 2 + T / K."""
    found = relax(
        Scene(
            particles=[[0, 0, 0], [1, 0, 0], [0, 1, 0], [2, 1, 0]],
            forces=[
                {"kind": "equal_length", "particles": [[0, 1], [2, 3]], "stiffness": [4.0, 12.0]},
                {"kind": "springs", "particles": [[0, 1], [2, 3]], "stiffness": 10.0},
            ],
            anchors=[{"particles": [0, 2]}, {"particles": [1, 3], "axes": "yz"}],
            settings={"tolerance": 1e-11},
        )
    )
    tension = -3.0 / (1.0 + 3.0 * 2.0 / 10.0)  # T = 3 (l1 - l2) = 3 (-1 - 2 T / K)
    assert found.converged
    assert found.forces[0]["force"] == pytest.approx([tension, -tension], abs=1e-8)
    assert found.forces[0]["length"] == pytest.approx([1.0 - tension / 10.0, 2.0 + tension / 10.0], abs=1e-9)


def test_numbers_of_groups_are_one_for_each_line() -> None:
    with pytest.raises(InputError, match="/forces/0/group: 3 values for 2 elements; give one for each"):
        chain([0.0, 1.0, 3.0], group=[1, 1, 1])
