"""Soft forces of every kind in one scene with springs a million times as stiff: `auto` finds the equilibrium."""

from __future__ import annotations

import numpy as np
import pytest

from hookean import Scene, relax
from hookean.forces import KINDS
from hookean.system.system import compile
from soak import sampled

from .cases import scene_of

RATIO = 1e6
# followers without a potential, whose work round a circle has no end: not every shape of their example has a rest
RESTLESS = ("thrust", "vortex")
SLOW = ("rigid_collide",)  # which has no tangent: 10,000 iterations
SOFT = [kind for kind, cls in KINDS.items() if cls.kernel is not None and kind not in (*RESTLESS, *SLOW)]


@pytest.mark.parametrize("kind", [*sampled(SOFT, 4), *(pytest.param(kind, marks=pytest.mark.soak) for kind in SLOW)])
def test_auto_finds_the_equilibrium_of_soft_forces_beside_stiff_springs(kind: str) -> None:
    """The example of a force; each particle drawn by a spring as soft as that to a place nearby; and all in a chain of
    springs that are 1e6 times as stiff. At equilibrium the chain bears forces of about the soft stiffness s times
    lengths, so it stretches by 1e-6 of them: 1e-4 allowed; what is out of balance is small for the soft ones, too."""
    force, given = KINDS[kind].example()
    alone = compile(scene_of(force, given))
    count = alone.slots.count  # rows behind are orientations
    x, w = alone.x[:count], alone.evaluate(alone.start())[1][:count]
    soft = max(float(np.median(w[w > 0])) if (w > 0).any() else 1.0, 1e-3)
    long = np.linalg.norm(np.diff(x, axis=0), axis=1)
    links = np.flatnonzero(long > 0)
    spacing = float(np.median(long[links]))
    near = x + 0.05 * spacing * np.random.default_rng(0).uniform(-1.0, 1.0, x.shape)
    more = (
        {"kind": "springs", "particles": np.column_stack([links, links + 1]), "stiffness": RATIO * soft},
        {"kind": "anchor_spring", "particles": range(len(x)), "targets": near, "strength": soft},
    )
    scene = scene_of(force, given, settings={"tolerance": 1e-6})
    found = relax(scene.replaced(forces=(force, *Scene(particles=x, forces=more).forces)))
    assert found.converged, found.message
    assert found.out_of_balance <= 1e-5 * soft * spacing
    after = np.linalg.norm(np.diff(found.particles, axis=0), axis=1)
    assert np.abs(after[links] / long[links] - 1.0).max() <= 1e-4
