"""Co-spherical groups: the sphere of least squares against a general minimiser, exact spheres, flat groups."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.optimize import least_squares

from hookean import Scene, relax
from hookean.forces.fits import POINT, RADIUS
from hookean.forces.fitted import fits
from hookean.system.system import compile


def fitted(x: np.ndarray, strength: Any = 1.0, kind: str = "co_spherical") -> tuple[float, np.ndarray]:
    """Energy and fit of all particles as one group."""
    system = compile(Scene(particles=x, forces=[{"kind": kind, "particles": range(len(x)), "strength": strength}]))
    return float(system.evaluate(system.start())[2].sum()), fits(system.groups[0].block, x)[0]


def shell(seed: int, count: int, noise: float) -> np.ndarray:
    """Points near a part of a sphere of radius 3 about (1, -2, 0.5)."""
    rng = np.random.default_rng(seed)
    normals = rng.normal(size=(count, 3)) + [0.5, 0.0, 1.0]
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    return np.asarray([1.0, -2.0, 0.5] + (3.0 + noise * rng.normal(size=(count, 1))) * normals)


@pytest.mark.parametrize("seed", range(6))
def test_the_sphere_is_that_of_least_squares(seed: int) -> None:
    """Centre and radius as scipy's minimiser finds them from the true ones, to its tolerance, and the energy is the
    least: centres to 1e-6 as the minimum is flat to second order at gradient 1e-12."""
    x = shell(seed, 6 + 3 * seed, 0.15)
    strength = np.random.default_rng(seed).uniform(1.0, 20.0, len(x))

    def off(q: np.ndarray) -> np.ndarray:
        return np.asarray(np.sqrt(strength) * (np.linalg.norm(x - q[:3], axis=1) - q[3]))

    known = least_squares(off, [1.0, -2.0, 0.5, 3.0], xtol=1e-15, ftol=1e-15, gtol=1e-14)
    energy, fit = fitted(x, strength)
    assert energy == pytest.approx(known.cost, rel=1e-9)
    assert np.abs([*fit[POINT : POINT + 3], fit[RADIUS]] - known.x).max() < 1e-6


def test_points_made_on_a_sphere_are_at_rest() -> None:
    """Exact fit: centre and radius to rounding times the condition of a part of a sphere, energy its square."""
    energy, fit = fitted(shell(3, 15, 0.0))
    assert energy < 15 * (1e-13 * 3.0) ** 2
    assert [*fit[POINT : POINT + 3], fit[RADIUS]] == pytest.approx([1.0, -2.0, 0.5, 3.0], abs=1e-11)


def test_a_group_comes_onto_a_sphere() -> None:
    """At rest all distances are 0; the mean stays, as no force comes from outside; the result reports the radius."""
    x = shell(4, 12, 0.2)
    force = {"kind": "co_spherical", "particles": range(12), "strength": 10.0}
    found = relax(Scene(particles=x, forces=[force], settings={"tolerance": 1e-10, "max_iterations": 20000}))
    assert found.converged and found.forces[0]["distance"].max() < 1e-8
    assert np.abs(found.particles.mean(axis=0) - x.mean(axis=0)).max() < 1e-12
    radius = found.forces[0]["radius"]
    centre = np.linalg.lstsq(2.0 * np.diff(found.particles, axis=0), np.diff((found.particles**2).sum(axis=1)))[0]
    assert np.linalg.norm(found.particles - centre, axis=1) == pytest.approx(radius, abs=1e-6)


def test_a_flat_group_has_a_plane() -> None:
    """In one plane, off any circle: no sphere is the nearest, and the plane is: energy 0 and radius infinite."""
    x = np.array([[0, 0, 1.0], [3, 0, 1], [4, 2, 1], [1, 3, 1], [1.5, 1, 1]])
    energy, fit = fitted(x)
    assert energy < 1e-28 and fit[RADIUS] == 0.0
    found = relax(Scene(particles=x, forces=[{"kind": "co_spherical", "particles": range(5)}]))
    assert np.isinf(found.forces[0]["radius"]).all() and np.abs(found.particles - x).max() < 1e-12
