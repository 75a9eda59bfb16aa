"""Power laws: orbits, equilibria between two laws, cutoffs."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

from hookean import InputError, Scene, relax

MASS, PULL = 2.0, 50.0


def planet(speed: float, time: float, steps: int) -> Scene:
    """A particle at distance 1 of one that is held, which attracts it with 50 / d^2; it moves across with `speed`."""
    return Scene(
        particles=[[0, 0, 0], [1, 0, 0]],
        forces=[{"kind": "power_law", "particles": [[0, 1]], "strength": -PULL, "exponent": -2}],
        anchors=[{"particles": [0]}],
        masses=[1.0, MASS],
        velocities=[[0, 0, 0], [0, speed, 0]],
        settings={
            "solver": "yoshida", "drag": 0, "time_step": time / steps, "divide_steps": False,
            "max_iterations": steps, "tolerance": 0, "sub_iterations": 1,
        },
    )  # fmt: skip


@pytest.mark.parametrize("speed", [5.0, 6.0])
def test_a_planet_comes_back_after_the_period_of_kepler(speed: float) -> None:
    """Kepler's third law, T = 2 pi sqrt(a^3 m / S) with a = 1 / (2 - v^2 m / S): a circle at v = 5, else an ellipse.

    Yoshida's scheme has order 4, so that with twice the steps the planet misses its start by 16 times less.
    """
    axis = 1.0 / (2.0 - speed**2 * MASS / PULL)
    period = 2.0 * np.pi * np.sqrt(axis**3 * MASS / PULL)
    missed = [np.linalg.norm(relax(planet(speed, period, n)).particles[1] - [1, 0, 0]) for n in (1000, 2000)]
    assert missed[0] < 1e-6 * axis
    assert missed[1] < missed[0] / 12.0


def rest(**law: Any) -> Any:
    """Two particles on a line, joined by a spring k = 100, L0 = 1, and by a power law; one is held."""
    pair = [[0, 1]]
    return relax(
        Scene(
            particles=[[0, 0, 0], [1, 0, 0]],
            forces=[
                {"kind": "springs", "particles": pair, "stiffness": 100, "rest_length": 1.0},
                {"kind": "power_law", "particles": pair, **law},
            ],
            anchors=[{"particles": [0]}, {"particles": [1], "axes": "yz"}],
            settings={"tolerance": 1e-10},
        )
    )


@pytest.mark.parametrize(("strength", "exponent"), [(30, -2), (-10, -1), (7, 0), (-40, 1), (4, 0.5), (-8, -3)])
def test_a_spring_and_a_law_balance(strength: float, exponent: float) -> None:
    """k (d - 1) = S d^n, solved by bisection; the force of the law is reported as attraction."""
    found = rest(strength=strength, exponent=exponent)
    expected = brentq(lambda d: 100 * (d - 1) - strength * d**exponent, 0.6, 2.0, xtol=1e-14)
    assert found.converged
    assert found.particles[1, 0] == pytest.approx(expected, abs=1e-9)
    assert found.forces[1]["force"][0] == pytest.approx(-strength * expected**exponent, rel=1e-8)


@pytest.mark.parametrize(("cutoff", "acts"), [(0.0, True), (2.0, True), (0.5, False), (-0.5, True), (-2.0, False)])
def test_a_cutoff_says_where_the_law_acts(cutoff: float, acts: bool) -> None:
    """Positive: below it only; negative: above it only; 0: everywhere."""
    found = rest(strength=10, exponent=0, cutoff=cutoff)
    assert found.converged
    assert found.particles[1, 0] == pytest.approx(1.1 if acts else 1.0, abs=1e-9)
    assert (found.forces[1]["force"][0] != 0) == acts


def test_an_exponent_that_would_overflow_is_refused() -> None:
    """At 1e-20, the least distance, |S| d^(n-1) stays below 1e212 for n = -9 and |S| = 1e12."""
    with pytest.raises(InputError, match=r"/forces/1/exponent: -12 given; exponents from -9 to 9 allowed"):
        rest(strength=1, exponent=-12)
