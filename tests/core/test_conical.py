"""Conical meshes: opposite angles, surfaces of revolution."""

from __future__ import annotations

import numpy as np
import pytest

from core.test_cyclic_quad import model, turned
from hookean import relax
from hookean.system.system import compile

CONICAL = {"kind": "conical", "strength": 2.0}


def test_the_angles_of_a_cross() -> None:
    """Four sides in a plane at 0, 100, 170 and 300 degrees: angles 100, 70, 130 and 60, so 100 + 130 - 70 - 60 = 100
    degrees, whichever face is named first. The other vertices are on the rim."""
    turn = np.radians([0, 50, 100, 130, 170, 200, 300, 330])
    x = np.vstack([[0, 0, 0], np.column_stack([np.cos(turn), np.sin(turn), 0.0 * turn])])
    faces = [[0, 1, 2, 3], [0, 3, 4, 5], [0, 5, 6, 7], [0, 7, 8, 1]]
    for first in range(4):
        system = compile(model(x, np.roll(faces, first, axis=0), CONICAL))
        energy = system.evaluate(system.start())[2].sum()
        assert energy == pytest.approx(np.radians(100.0) ** 2, rel=1e-12)


def test_a_surface_of_revolution_stays_and_comes_back() -> None:
    """Angles beside each other on a parallel are equal: no force, to rounding. From a disturbed one all vertices come
    to equal sums, with flat faces."""
    x, faces = turned(6, 5)
    system = compile(model(x, faces, CONICAL))
    assert np.abs(system.evaluate(system.start())[0]).max() <= 1e-12
    assert len(system.groups[0].block.indices) == 4 * 4 * 3
    moved = x + 0.02 * np.random.default_rng(1).normal(size=x.shape)
    found = relax(model(moved, faces, CONICAL, {"kind": "planarize", "stiffness": 10.0}))
    assert found.converged
    assert np.abs(found.forces[0]["angle"]).max() <= 1e-7 and found.forces[1]["distance"].max() <= 1e-6


def test_vertices_with_other_than_four_faces_have_no_force() -> None:
    """A fan of five triangles."""
    turn = 2.0 * np.pi * np.arange(5) / 5
    x = np.vstack([[0, 0.1, 0.4], np.column_stack([np.cos(turn), np.sin(turn), 0.0 * turn])])
    system = compile(model(x, [[0, 1 + i, 1 + (i + 1) % 5] for i in range(5)], CONICAL))
    assert not system.groups or not len(system.groups[0].block.indices)
