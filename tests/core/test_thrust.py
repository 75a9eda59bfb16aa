"""Thrust: a rocket that turns at an even rate runs in a circle, and one that does not turn goes straight on."""

from __future__ import annotations

import numpy as np
import pytest

from hookean import InputError, Scene, relax
from hookean.forces import Thrust

MASS, RADIUS, SPEED, LENGTH, STIFFNESS = 3.0, 2.0, 1.5, 0.8, 500.0
RATE = SPEED / RADIUS
THRUST = MASS * SPEED**2 / RADIUS


def rocket(time: float, steps: int, rate: float) -> Scene:
    """Two particles joined by a spring, at a distance from the origin, to which they point; they move along y and turn.

    The spring has the length at which its tension, m w^2 l / 4, holds both together.
    """
    x = np.array([[RADIUS + 0.5 * LENGTH, 0.0, 0.0], [RADIUS - 0.5 * LENGTH, 0.0, 0.0]])
    stretch = MASS * rate**2 * LENGTH / 4.0 / STIFFNESS
    return Scene(
        particles=x,
        forces=[
            {"kind": "thrust", "particles": [[0, 1]], "thrust": THRUST},
            {"kind": "springs", "particles": [[0, 1]], "stiffness": STIFFNESS, "rest_length": LENGTH - stretch,
             "damping": 0.0},
        ],
        masses=0.5 * MASS,
        velocities=[[0.0, SPEED + 0.5 * rate * LENGTH, 0.0], [0.0, SPEED - 0.5 * rate * LENGTH, 0.0]],
        settings={
            "solver": "yoshida", "drag": 0, "time_step": time / steps, "divide_steps": False,
            "max_iterations": steps, "tolerance": 0, "sub_iterations": 1,
        },
    )  # fmt: skip


@pytest.mark.parametrize("turn", [0.25, 1.0])
def test_an_even_turn_makes_a_circle_of_radius_m_v2_by_f(turn: float) -> None:
    """The thrust has no moment about the middle, so the rate w stays; with w = v / r it remains at a right angle to the
    speed: r = m v^2 / F. Yoshida's scheme has order 4: with twice the steps the middle is off by 16 times less."""
    angle = 2.0 * np.pi * turn
    expected = [RADIUS * np.cos(angle), RADIUS * np.sin(angle), 0.0]
    off = []
    for steps in (400, 800):
        found = relax(rocket(angle / RATE, steps, RATE))
        off.append(float(np.linalg.norm(found.particles.mean(axis=0) - expected)))
    assert off[0] < 1e-4 * RADIUS
    assert off[1] < off[0] / 12.0


def test_without_a_turn_it_is_a_constant_acceleration() -> None:
    """x = x0 - F t^2 / (2 m), y = v t: a parabola, which the scheme has exactly, to the rounding of 200 steps."""
    found = relax(rocket(2.0, 200, 0.0))
    middle = [RADIUS - THRUST * 2.0**2 / (2.0 * MASS), SPEED * 2.0, 0.0]
    assert found.particles.mean(axis=0) == pytest.approx(middle, abs=1e-11)
    assert found.forces[0]["force"][0] == pytest.approx([-THRUST, 0.0, 0.0], abs=1e-11)


def test_bad_rockets_are_refused() -> None:
    with pytest.raises(InputError, match="/thrust: not a finite number"):
        Thrust(particles=[[0, 1]], thrust=float("inf"))
    with pytest.raises(InputError, match="give exactly one of particles, lines"):
        Thrust(thrust=1.0)
