"""Lengths that snap: every start goes to its nearest multiple, and loads move lines within their wells."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hookean import InputError, Scene, relax


def snapped(starts: Any, load: float = 0.0, **columns: Any) -> Any:
    """Lines along x of these lengths, one end held, the other free along x with a load."""
    starts, n = np.asarray(starts), len(starts)
    ends = [[[0, 3 * i, 0], [start, 3 * i, 0]] for i, start in enumerate(starts)]
    return relax(
        Scene(
            particles=np.reshape(ends, (2 * n, 3)),
            forces=[
                {"kind": "length_snap", "particles": np.arange(2 * n).reshape(n, 2), "stiffness": 50.0, **columns},
                {"kind": "unary", "particles": np.arange(1, 2 * n, 2), "vector": [load, 0, 0]},
            ],
            anchors=[{"particles": np.arange(0, 2 * n, 2)}, {"particles": np.arange(1, 2 * n, 2), "axes": "yz"}],
            settings={"tolerance": 1e-10},
        )
    )


def test_each_start_goes_to_the_nearest_multiple() -> None:
    """Wells from (n - 1/2) a to (n + 1/2) a, at a = 0.7: lengths n a, without force."""
    found = snapped([0.4, 0.8, 1.0, 1.1, 1.74, 1.76, 70.2], multiple=0.7)
    assert found.converged
    assert found.forces[0]["length"] == pytest.approx(0.7 * np.array([1, 1, 1, 2, 2, 3, 100]), abs=1e-8)
    assert found.forces[0]["force"] == pytest.approx(np.zeros(7), abs=1e-6)


@pytest.mark.parametrize("load", [-6.0, 5.0, 8.0, 12.0])
def test_a_load_moves_a_line_within_its_well(load: float) -> None:
    """P / k from the multiple, where a motion from there does not reach the edge: P a / 2 < k a^2 / 8."""
    found = snapped([1.0, 2.0], load, multiple=1.0)
    assert found.converged
    assert found.forces[0]["length"] == pytest.approx(np.array([1.0, 2.0]) + load / 50.0, abs=1e-8)
    assert found.forces[0]["force"] == pytest.approx(np.full(2, load), abs=1e-7)


def test_short_lines_vanish() -> None:
    """Below a / 2 the nearest multiple is zero, and a line of zero length has no force."""
    assert snapped([0.3], multiple=1.0).forces[0]["length"][0] == pytest.approx(0.0, abs=1e-8)


def test_a_multiple_of_zero_is_refused() -> None:
    with pytest.raises(InputError, match="/forces/0/multiple: 0 given; more than 0 allowed"):
        snapped([1.0], multiple=0.0)
