"""The force along elements with two ends: by their stiffness as by their kernel, whatever the kind."""

from __future__ import annotations

import numpy as np
import pytest

from hookean import Scene
from hookean.forces import KINDS
from hookean.system.system import compile
from hookean.system.two_ended import spring_forces

CENTRAL = [name for name, cls in KINDS.items() if cls.central is not None and cls.role == "internal"]


@pytest.mark.parametrize("kind", CENTRAL)
def test_the_force_along_an_element_is_that_of_its_kernel(kind: str) -> None:
    """Tension is what the kernel pulls the first end with, along the element: equal but for rounding of sums of a few
    terms of that size, 1e-12 of the largest."""
    force, particles = KINDS[kind].example()
    system = compile(Scene(particles=particles, forces=[force]))
    state = system.start()
    state.x += np.random.default_rng(1).normal(scale=0.2, size=state.x.shape)
    [group], [memory] = system.groups, state.memory
    start, end = group.particles.T
    along = state.x[end] - state.x[start]
    pulls = system.element_forces(group, state, memory)[:, 0]
    wanted = (pulls * along).sum(axis=1) / np.linalg.norm(along, axis=1)
    found = spring_forces(system, state)
    assert np.abs(wanted).max() > 0.0
    assert np.abs(found - wanted).max() <= 1e-12 * np.abs(wanted).max()
