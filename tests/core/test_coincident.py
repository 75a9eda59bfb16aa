"""Coincident pairs: where they meet, and how far a load keeps them apart."""

from __future__ import annotations

import numpy as np
import pytest

from hookean import InputError, Scene, relax

STRENGTH = 250.0


def test_a_load_keeps_a_pair_apart_by_its_part_of_the_strength() -> None:
    """d = P / k, in the direction of the load; the force that is reported is P."""
    load = np.array([3.0, -4.0, 12.0])
    forces = [
        {"kind": "coincident", "particles": [[0, 1]], "strength": STRENGTH},
        {"kind": "unary", "particles": [1], "vector": load},
    ]
    settings = {"tolerance": 1e-13}
    found = relax(
        Scene(particles=[[1, 2, 3], [4, 4, 4]], forces=forces, anchors=[{"particles": [0]}], settings=settings)
    )
    assert found.particles[1] == pytest.approx([1, 2, 3] + load / STRENGTH, abs=1e-12)
    assert found.forces[0]["force"][0] == pytest.approx(13.0, rel=1e-12)
    assert found.forces[0]["distance"][0] == pytest.approx(13.0 / STRENGTH, rel=1e-12)


def test_free_ends_meet_in_their_mean() -> None:
    """Nothing acts from outside, so three ends, each pulled to both others, meet in their mean; lines create
    particles."""
    ends = np.array([[0.0, 0, 0], [3.0, 1.0, 0], [0, 5.0, 6.0]])
    force = {"kind": "coincident", "lines": [ends[:2], ends[1:], ends[::2]], "strength": STRENGTH}
    found = relax(Scene(forces=[force], settings={"tolerance": 1e-12}))
    assert found.converged
    assert np.abs(found.particles - ends.mean(axis=0)).max() < 1e-9


def test_a_negative_strength_is_refused() -> None:
    """Stiffness is not negative."""
    with pytest.raises(InputError, match="/forces/0/strength: -1 given; at least 0 allowed"):
        Scene(particles=np.eye(3), forces=[{"kind": "coincident", "particles": [[0, 1]], "strength": -1}])
