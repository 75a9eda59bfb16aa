"""Co-circular groups: the circle of least squares in space, exact circles, lines."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import least_squares

from core.test_co_spherical import fitted
from hookean import Scene, relax
from hookean.forces.fits import NORMAL, POINT, RADIUS

CENTRE, RIM = np.array([1.0, -2.0, 0.5]), 3.0


def ring(seed: int, count: int, noise: float) -> np.ndarray:
    """Points near a part of a circle of radius 3 about (1, -2, 0.5), in a plane that is askew."""
    rng = np.random.default_rng(seed)
    turn = rng.uniform(0.0, 4.5, count)
    flat = np.column_stack([RIM * np.cos(turn), RIM * np.sin(turn), np.zeros(count)]) + noise * rng.normal(
        size=(count, 3)
    )
    return np.asarray(CENTRE + flat @ np.linalg.qr(rng.normal(size=(3, 3)))[0])


def off(q: np.ndarray, x: np.ndarray) -> np.ndarray:
    """Height over the plane of a circle, and distance from its cylinder, of all points: centre, normal, radius."""
    normal = q[3:6] / np.linalg.norm(q[3:6])
    y = x - q[:3]
    height = y @ normal
    return np.concatenate([height, np.linalg.norm(y - height[:, None] * normal, axis=1) - q[6]])


@pytest.mark.parametrize("seed", range(6))
def test_the_circle_is_that_of_least_squares(seed: int) -> None:
    """Of scipy's minimum, started from the true circle, the energy to 1e-9 and the circle to 1e-6 (flat to second
    order)."""
    x = ring(seed, 7 + 3 * seed, 0.15)
    energy, fit = fitted(x, 2.0, "co_circular")
    start = np.concatenate([CENTRE, fit[NORMAL : NORMAL + 3] + 0.05, [RIM]])
    known = least_squares(off, start, args=(x,), xtol=1e-15, ftol=1e-15, gtol=1e-14)
    assert energy == pytest.approx(2.0 * known.cost, rel=1e-9)
    assert np.abs(np.append(fit[POINT : POINT + 3], fit[RADIUS]) - known.x[[0, 1, 2, 6]]).max() < 1e-5


def test_points_made_on_a_circle_are_at_rest() -> None:
    """Exact fit, to rounding times the condition of a part of a circle."""
    energy, fit = fitted(ring(3, 15, 0.0), 1.0, "co_circular")
    assert energy < 15 * (1e-13 * RIM) ** 2
    assert [*fit[POINT : POINT + 3], fit[RADIUS]] == pytest.approx([*CENTRE, RIM], abs=1e-11)


def test_a_quad_becomes_cyclic() -> None:
    """Corners on a circle: opposite angles sum to pi (Euclid, Elements III.22); they end flat, and the mean stays."""
    x = np.array([[0, 0, 0.1], [2, 0.2, -0.2], [2.5, 2.2, 0.3], [-0.4, 1.5, 0.0]])
    force = {"kind": "co_circular", "particles": range(4), "strength": 10.0}
    found = relax(Scene(particles=x, forces=[force], settings={"tolerance": 1e-11, "max_iterations": 20000}))
    sides = np.roll(found.particles, -1, axis=0) - found.particles
    sides /= np.linalg.norm(sides, axis=1)[:, None]
    angles = np.arccos(-(sides * np.roll(sides, 1, axis=0)).sum(axis=1))
    assert found.converged and found.forces[0]["distance"].max() < 1e-8
    assert angles[::2].sum() == pytest.approx(np.pi, abs=1e-7) and angles[1::2].sum() == pytest.approx(np.pi, abs=1e-7)
    assert np.abs(found.particles.mean(axis=0) - x.mean(axis=0)).max() < 1e-12


def test_a_group_on_a_line_has_a_line() -> None:
    """Four points on a line, unevenly spaced, and on no circle: energy 0 and no radius."""
    x = np.array([0.0, 1.0, 2.5, 4.5])[:, None] * [1.0, 2.0, -1.0]
    energy, fit = fitted(x, 1.0, "co_circular")
    assert energy < 1e-28 and fit[RADIUS] == 0.0
