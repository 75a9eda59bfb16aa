"""Angles that snap: every start turns to its nearest multiple, up to half a turn."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hookean import InputError, Scene, relax


def snapped(start: float, multiple: float, load: float = 0.0) -> Any:
    """A bar of length 1 in the xz plane at an angle to a held line along x; the load acts across the bar at first."""
    return relax(
        Scene(
            particles=[[3, 2, 0], [5, 2, 0], [0, 0, 0], [np.cos(start), 0, np.sin(start)]],
            forces=[
                {"kind": "angle_snap", "particles": [[0, 1, 2, 3]], "strength": 2.0, "multiple": multiple},
                {"kind": "springs", "particles": [[2, 3]], "stiffness": 1e8, "damping": 0.0},
                {"kind": "unary", "particles": [3], "vector": [0.0, 0.0, load]},
            ],
            anchors=[{"particles": [0, 1, 2]}],
            settings={"tolerance": 1e-9, "solver": "newton"},
        )
    )


@pytest.mark.slow
@pytest.mark.parametrize(
    ("start", "multiple", "end"),
    [
        (0.5, np.pi / 2, 0.0),
        (1.0, np.pi / 2, np.pi / 2),
        (2.2, np.pi / 2, np.pi / 2),
        (2.6, np.pi / 2, np.pi),
        (1.3, np.pi, 0.0),
        (1.8, np.pi, np.pi),
        (2.9, np.pi / 3, np.pi),
        (3.0, 2.0, 2.0),  # 4 would be nearer, and no two lines have that angle
        (1.0, 3.1, 0.0),
    ],
)
def test_each_start_turns_to_the_nearest_multiple(start: float, multiple: float, end: float) -> None:
    found = snapped(start, multiple)
    assert found.converged
    assert found.forces[0]["angle"][0] == pytest.approx(end, abs=1e-7)
    assert found.forces[0]["moment"][0] == pytest.approx(0.0, abs=1e-6)


def test_a_load_turns_a_line_within_its_well() -> None:
    """S theta = P cos theta with S = 2 P: theta = cos(theta) / 2, by iteration; less than pi / 4, the well's edge."""
    found, theta = snapped(0.1, np.pi / 2, 1.0), 0.4
    for _ in range(60):
        theta = 0.5 * np.cos(theta)
    assert found.converged
    assert found.forces[0]["angle"][0] == pytest.approx(theta, abs=1e-7)
    assert found.forces[0]["moment"][0] == pytest.approx(2.0 * theta, abs=1e-6)


def test_a_multiple_of_zero_is_refused() -> None:
    with pytest.raises(InputError, match="/forces/0/multiple: 0 given; more than 0 allowed"):
        snapped(1.0, 0.0)
