"""Clamped angles: free between two limits, elastic outside."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

from hookean import InputError, Scene, relax


def clamped(start: float, load: float = 0.0, **columns: Any) -> Any:
    """A bar of length 1 in the xz plane at an angle to a held line along x, with a load along z at its end."""
    return relax(
        Scene(
            particles=[[3, 2, 0], [5, 2, 0], [0, 0, 0], [np.cos(start), 0, np.sin(start)]],
            forces=[
                {"kind": "clamp_angle", "particles": [[0, 1, 2, 3]], "strength": 2.0, **columns},
                {"kind": "springs", "particles": [[2, 3]], "stiffness": 1e8, "damping": 0.0},
                {"kind": "unary", "particles": [3], "vector": [0.0, 0.0, load]},
            ],
            anchors=[{"particles": [0, 1, 2]}, {"particles": [3], "axes": "y"}],  # else it slips around the cone
            settings={"tolerance": 1e-9, "solver": "newton"},
        )
    )


@pytest.mark.parametrize(("start", "end"), [(0.2, 0.5), (0.8, 0.8), (1.5, 1.1)])
def test_an_angle_returns_to_its_limits_and_is_free_between_them(start: float, end: float) -> None:
    found = clamped(start, lower_limit=0.5, upper_limit=1.1)
    assert found.converged
    assert found.forces[0]["angle"][0] == pytest.approx(end, abs=1e-7)


@pytest.mark.parametrize(("start", "load", "limit"), [(0.95, 1.5, 0.9), (0.45, -0.4, 0.5)])
def test_a_loaded_bar_turns_beyond_its_limit(start: float, load: float, limit: float) -> None:
    """S (theta - limit) = P cos theta, by bisection."""
    found = clamped(start, load, lower_limit=0.5, upper_limit=0.9)
    theta = brentq(lambda t: 2.0 * (t - limit) - load * np.cos(t), 0.0, 1.6, xtol=1e-14)
    assert found.converged
    assert found.forces[0]["angle"][0] == pytest.approx(theta, abs=1e-7)
    assert found.forces[0]["moment"][0] == pytest.approx(2.0 * (theta - limit), abs=1e-6)


def test_limits_that_are_no_angles_or_in_the_wrong_order_are_refused() -> None:
    with pytest.raises(InputError, match=r"/forces/0/lower_limit: 2 given, above the upper limit, 1.5; exchange them"):
        clamped(1.0, lower_limit=2.0, upper_limit=1.5)
    with pytest.raises(InputError, match=r"/forces/0/lower_limit: 0.5 given, above the upper limit, 0; exchange them"):
        clamped(1.0, lower_limit=0.5, upper_limit=0.0)
    with pytest.raises(InputError, match="/forces/0/upper_limit: 180 given; angles from 0 to pi allowed, in radians"):
        clamped(1.0, upper_limit=180)
