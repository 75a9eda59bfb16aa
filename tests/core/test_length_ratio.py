"""Ratios of lengths: a line follows another one, both share what is missing, and forces balance."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hookean import InputError, Scene, relax


def ratio(load: float = 0.0, **columns: Any) -> Any:
    """Line A of length 2, held; line B apart from it, free to stretch along y, with a load."""
    return relax(
        Scene(
            particles=[[0, 0, 0], [2, 0, 0], [5, 0, 1], [5, 0.7, 1]],
            forces=[
                {"kind": "length_ratio", "particles": [[0, 1, 2, 3]], "stiffness": 40.0, **columns},
                {"kind": "unary", "particles": [3], "vector": [0, load, 0]},
            ],
            anchors=[{"particles": [0, 1, 2]}, {"particles": [3], "axes": "xz"}],
            settings={"tolerance": 1e-11},
        )
    )


@pytest.mark.parametrize(("factor", "load"), [(1.0, 0.0), (0.6, 0.0), (1.5, 12.0), (2.5, -30.0)])
def test_a_line_is_so_many_times_as_long_as_another(factor: float, load: float) -> None:
    """l_B = r l_A + P / k."""
    found = ratio(load, ratio=factor)
    assert found.converged
    assert found.particles[3, 1] == pytest.approx(2.0 * factor + load / 40.0, abs=1e-9)
    assert found.forces[0]["ratio"][0] == pytest.approx(factor + load / 80.0, abs=1e-9)
    assert found.forces[0]["force"][0] == pytest.approx(load, abs=1e-7)


def test_springs_share_what_a_ratio_asks_for() -> None:
    """Springs a (k = 100, L = 1) and b (k = 100, L = 1) and b = 2 a with k = 50: k_s (a - 1) = r T and
    k_s (b - 1) = -T, T = 50 (b - 2 a), so T = 50 (1 - T / 100 - 2 - 4 T / 100) = -50 / 3.5."""
    found = relax(
        Scene(
            particles=[[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]],
            forces=[
                {"kind": "springs", "particles": [[0, 1], [2, 3]], "stiffness": 100.0, "rest_length": 1.0},
                {"kind": "length_ratio", "particles": [[0, 1, 2, 3]], "stiffness": 50.0, "ratio": 2.0},
            ],
            anchors=[{"particles": [0, 2]}, {"particles": [1, 3], "axes": "yz"}],
            settings={"tolerance": 1e-11},
        )
    )
    tension = -50.0 / 3.5
    assert found.converged
    assert found.particles[1, 0] == pytest.approx(1.0 + 2.0 * tension / 100.0, abs=1e-9)
    assert found.particles[3, 0] == pytest.approx(1.0 - tension / 100.0, abs=1e-9)
    assert found.forces[1]["force"][0] == pytest.approx(tension, abs=1e-7)


def test_bad_pairs_are_refused() -> None:
    with pytest.raises(InputError, match="/forces/0/ratio: -1 given; at least 0 allowed"):
        ratio(ratio=-1.0)
    with pytest.raises(InputError, match=r"/forces/0/particles: shape \[1, 2\] given; each element needs 4 particles"):
        relax(Scene(particles=np.eye(3), forces=[{"kind": "length_ratio", "particles": [[0, 1]]}]))
