"""Co-linear groups: what they share with planes is in test_co_planar; here the direction, and ends that are held."""

from __future__ import annotations

import numpy as np
import pytest

from hookean import Scene, relax
from hookean.forces.fits import NORMAL, POINT
from hookean.forces.fitted import fits
from hookean.system.system import compile


def test_the_line_is_the_axis_of_largest_variance() -> None:
    """Through the mean weighted by strength, along the first singular vector, to rounding by the gap of the values."""
    rng = np.random.default_rng(7)
    x, strength = rng.normal(size=(20, 3)) * [4.0, 1.0, 0.5], rng.uniform(1.0, 9.0, 20)
    force = {"kind": "co_linear", "particles": range(20), "strength": strength}
    system = compile(Scene(particles=x, forces=[force]))
    fit = fits(system.groups[0].block, x)[0]
    mean = np.average(x, axis=0, weights=strength)
    axis = np.linalg.svd(np.sqrt(strength)[:, None] * (x - mean))[2][0]
    assert np.abs(fit[POINT : POINT + 3] - mean).max() < 1e-14 * 4.0
    assert abs(fit[NORMAL : NORMAL + 3] @ axis) == pytest.approx(1.0, abs=1e-13)


def test_two_particles_always_have_a_line() -> None:
    """Groups of two feel nothing, of one neither: at most rounding, eps x k x length."""
    x = np.random.default_rng(8).normal(size=(5, 3))
    force = {"kind": "co_linear", "particles": range(5), "group": [1, 2, 1, 2, 3]}
    system = compile(Scene(particles=x, forces=[force]))
    assert np.abs(system.evaluate(system.start())[0]).max() < 1e-14 * 1000.0 * 4.0


def test_newton_finds_the_line_between_anchors() -> None:
    """A zigzag between two held ends comes onto the straight line between them: the end points are in the group, so
    no other line has energy 0. Distances to 1e-10, the tolerance over the least stiffness of the zigzag, k / 9."""
    x = np.array([[0, 0, 0], [1, 0.3, 0.1], [2, -0.2, 0.2], [3, 0.25, -0.3], [4, 0, 0.0]])
    forces = [
        {"kind": "co_linear", "particles": range(5), "strength": 90.0},
        {"kind": "springs", "particles": [[0, 1], [1, 2], [2, 3], [3, 4]], "rest_factor": 0.0, "stiffness": 1.0},
    ]
    settings = {"solver": "newton", "tolerance": 1e-11}
    found = relax(Scene(particles=x, forces=forces, anchors=[{"particles": [0, 4]}], settings=settings))
    assert found.converged and found.iterations < 15 and found.stability == "stable"
    assert np.abs(found.particles - np.linspace([0, 0, 0], [4, 0, 0], 5)).max() < 1e-9
