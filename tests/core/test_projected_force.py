"""Projected forces: funiculars of a prescribed thrust, and lines across the vector."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hookean import InputError, Scene, relax


def funicular(x: np.ndarray, loads: np.ndarray, **columns: Any) -> Any:
    """A chain whose particles are held at `x` along x, and at both ends, with loads along z between them."""
    n = len(x)
    return relax(
        Scene(
            particles=np.column_stack([x, np.zeros(n), 0.1 * np.sin(np.arange(n))]),
            forces=[
                {"kind": "projected_force", "particles": [[i, i + 1] for i in range(n - 1)], **columns},
                {"kind": "unary", "particles": np.arange(1, n - 1), "vector": np.outer(loads, [0, 0, 1])},
            ],
            anchors=[{"particles": [0, n - 1]}, {"particles": np.arange(1, n - 1), "axes": "xy"}],
            settings={"tolerance": 1e-11},
        )
    )


def test_equal_loads_make_a_parabola() -> None:
    """H (z[i+1] - 2 z[i] + z[i-1]) / h = P: z = z0 + P x (x - L) / (2 H h) between the ends, exactly at particles."""
    x = np.linspace(0.0, 5.0, 11)
    found = funicular(x, np.full(9, -2.0), component=8.0)
    z = found.particles[:, 2]
    chord = z[0] + (z[-1] - z[0]) * x / 5.0
    assert found.converged
    assert z - chord == pytest.approx(2.0 * x * (x - 5.0) / (2.0 * 8.0 * 0.5), abs=1e-8)


@pytest.mark.parametrize("direction", [[1, 0, 0], [-3, 0, 0]])
def test_slopes_change_by_load_over_thrust(direction: list[float]) -> None:
    """With loads P down, H (slope after - slope before) = P at any spacing; every line has H / cos of its slope."""
    x = np.array([0.0, 0.7, 1.0, 2.2, 2.9, 4.0])
    loads = np.array([-1.0, -4.0, 2.0, -3.0])
    found = funicular(x, loads, component=6.0, direction=direction)
    step = np.diff(found.particles, axis=0)
    slope = step[:, 2] / step[:, 0]
    assert found.converged
    assert 6.0 * np.diff(slope) == pytest.approx(-loads, abs=1e-8)
    assert found.forces[0]["force"] == pytest.approx(6.0 * np.sqrt(1.0 + slope**2), rel=1e-9)
    assert abs(found.reactions["force"][0, 0]) == pytest.approx(6.0, abs=1e-8)


def test_a_line_across_the_vector_has_no_force() -> None:
    """No finite force has such a component there."""
    scene = Scene(
        particles=[[0, 0, 0], [0, 0, 1]],
        forces=[{"kind": "projected_force", "particles": [[0, 1]]}],
        anchors=[{"particles": [0, 1]}],
    )
    assert relax(scene).forces[0]["force"][0] == 0.0


def test_a_vector_of_zero_length_is_refused() -> None:
    with pytest.raises(
        InputError, match="/forces/0/direction: a vector of zero length given; give one that is not 0, 0, 0"
    ):
        funicular(np.arange(3.0), np.zeros(1), direction=[0, 0, 0])
