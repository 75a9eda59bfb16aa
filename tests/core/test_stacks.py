"""Walls of rigid boxes come to rest where their foundation of stiffness k says, and stay there."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from hookean import Scene
from hookean.running.run import relax_state
from hookean.solvers import solver
from hookean.system.system import compile

CUBE = np.array([[i & 1, i >> 1 & 1, i >> 2] for i in range(8)]) - 0.5
BRICK = np.array([2.0, 1.0, 0.5])
STRENGTH = 1e4


def wall(courses: int, across: int) -> tuple[np.ndarray, np.ndarray]:
    """Bricks (m, 8, 3) in running bond with half bricks at the ends of every other course, and the course of each."""
    bricks, number = [], []
    for course in range(courses):
        ends = np.arange(across + 1.0) if course % 2 == 0 else np.array([0.0, *np.arange(0.5, across), across])
        for left, right in pairwise(ends):
            middle = np.array([0.5 * (left + right) * BRICK[0], 0.0, (course + 0.5) * BRICK[2]])
            bricks.append(CUBE * BRICK * [right - left, 1.0, 1.0] + middle)
            number.append(course)
    return np.array(bricks), np.array(number)


def built(courses: int, across: int, **settings: Any) -> tuple[Scene, np.ndarray]:
    """The wall on a held slab, each brick with a weight of 1 (half ones 1/2); the course of each brick."""
    bricks, course = wall(courses, across)
    slab = CUBE * [across * BRICK[0] + 2.0, 4.0, 1.0] + [0.5 * across * BRICK[0], 0.0, -0.5]
    x = np.vstack([slab, bricks.reshape(-1, 3)])
    both = {"particles": range(len(x)), "group": np.arange(len(bricks) + 1).repeat(8)}
    weight = np.ptp(bricks[:, :, 0], axis=1).repeat(8) / BRICK[0] / 8.0
    load = {"kind": "unary", "particles": range(8, len(x)), "vector": -weight[:, None] * [0.0, 0.0, 1.0]}
    forces = [
        {"kind": "rigid_body", **both, "strength": 1e4},
        {"kind": "rigid_collide", **both, "strength": STRENGTH, "friction": 0.5},
        load,
    ]
    scene = {"particles": x, "forces": forces, "anchors": [{"particles": range(8)}], "settings": settings}
    return Scene.read(scene), course


@pytest.mark.parametrize(("courses", "across"), [(4, 6), pytest.param(20, 25, marks=pytest.mark.soak)])
def test_a_wall_of_bricks_comes_to_rest_and_stays(courses: int, across: int) -> None:
    """26 and 510 bricks. All courses press alike everywhere, so that each contact gives way by d = (weight above) /
    (k A), and a brick sinks by the sum of those below it, moving along nothing. Bricks are flush: one that has moved
    out of a face has less area to stand on, and is pushed on by k d^2 / 2 on its length, at most d / (2 width) of its
    weight, which friction holds at a slip of that part of d; added up over the courses, it is less than 1e-3 of the
    sinking. Then, in time, what the tolerance leaves of the force on each of eight particles moves a brick on the one
    below by up to twice that by k A, also if the courses add up."""
    tolerance = 1e-4
    scene, course = built(courses, across, tolerance=tolerance, time_step=0.002, drag=0.0)
    system = compile(scene)
    state = system.start()
    found = relax_state(system, state, solver("relaxation"))
    assert found.converged
    moved = (state.x - system.x).reshape(-1, 8, 3).mean(axis=1)[1:]
    d = (courses - np.arange(courses)) / (STRENGTH * BRICK[0] * BRICK[1])
    known = -np.cumsum(d)[course]
    assert np.abs(moved[:, 2] - known).max() < 1e-3 * -known.min()
    assert np.abs(moved[:, :2]).max() < 1e-3 * -known.min()
    rest = state.x.copy()
    solver("verlet").advance(system, state, 250, 0.0)
    assert np.abs(state.x - rest).max() < courses * 2.0 * 8.0 * tolerance / (STRENGTH * BRICK[0] * BRICK[1])
