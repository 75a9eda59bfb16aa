"""Corners of solids against a plane: depth by F / k, Coulomb's slope, and a bounce that loses nothing."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from hookean import Scene, relax
from hookean.forces import SolidPlaneCollide
from hookean.running.run import relax_state
from hookean.solvers import solver
from hookean.system.system import compile
from laws import laws
from laws.cases import case_of

CUBE = np.array([[i & 1, i >> 1 & 1, i >> 2] for i in range(8)]) - [0.5, 0.5, 0.0]


def on_slope(tangent: float, friction: float, **settings: Any) -> tuple[Scene, np.ndarray]:
    """A rigid box of weight 8 on a plane of some slope; the directions down the slope and off it."""
    turn = Rotation.from_euler("y", math.atan(tangent)).as_matrix()
    forces = [
        {"kind": "rigid_body", "particles": range(8), "strength": 1e4},
        {"kind": "solid_plane_collide", "particles": range(8), "normal": 3.0 * turn[:, 2], "strength": 1e4,
         "friction": friction},
        {"kind": "unary", "particles": range(8), "vector": [0, 0, -1.0]},
    ]  # fmt: skip
    return Scene.read({"particles": CUBE @ turn.T, "forces": forces, "settings": settings}), turn[:, [0, 2]]


@pytest.mark.parametrize("solver", ["auto", "relaxation", "newton"])
def test_a_particle_sinks_by_its_load_over_the_stiffness(solver: str) -> None:
    """F / k behind the plane, and held along it by friction: T / k as long as T < mu N."""
    force = {"kind": "solid_plane_collide", "particles": [0], "normal": [0, 0, 2], "origin": [0, 0, 1.0],
             "strength": 200.0, "friction": 0.5}  # fmt: skip
    load = {"kind": "unary", "particles": [0], "vector": [1.2, 0.0, -3.0]}
    scene = Scene(particles=[[0.3, 0.2, 0.99]], forces=[force, load], settings={"solver": solver, "tolerance": 1e-10})
    found = relax(scene)
    assert found.converged
    assert found.particles[0] == pytest.approx([0.3 + 1.2 / 200.0, 0.2, 1.0 - 3.0 / 200.0], abs=1e-9)
    assert found.force("solid_plane_collide")["depth"] == pytest.approx([0.015], rel=1e-8)
    assert found.force("solid_plane_collide")["force"][0] == pytest.approx([-1.2, 0.0, 3.0], rel=1e-8)


def test_a_box_rests_on_a_slope_below_the_angle_of_friction() -> None:
    """tan a = 0.45 < 0.5. It moves by no more than its weight over the stiffness of one corner, 8e-4, a few times over,
    and then stays in time."""
    scene, directions = on_slope(0.45, 0.5, tolerance=1e-10, time_step=0.002, drag=0.0)
    system = compile(scene)
    state = system.start()
    assert relax_state(system, state, solver("relaxation")).converged
    moved = np.abs((state.x - system.x) @ directions).max()
    assert 0.0 < moved < 3e-3
    rest = state.x.copy()
    solver("verlet").advance(system, state, 500, 0.0)
    assert np.abs(state.x - rest).max() < 1e-3 * moved


def test_a_box_slides_down_a_slope_above_the_angle_of_friction() -> None:
    """It gains g (sin a - mu cos a) t of speed (Coulomb), without friction g sin a t; as it is let go it vibrates, 2
    per cent of that."""
    for friction in (0.5, 0.0):
        scene, directions = on_slope(0.7, friction, solver="verlet", time_step=0.002, drag=0.0)
        system = compile(scene)
        state, speeds = system.start(), []
        for _ in range(2):
            solver("verlet").advance(system, state, 1000, 0.0)
            speeds.append(float((state.v.mean(axis=0) @ directions)[0]))
        angle = math.atan(0.7)
        known = 2.0 * (math.sin(angle) - friction * math.cos(angle))
        assert speeds[1] - speeds[0] == pytest.approx(known, rel=0.02)


def test_a_particle_bounces_without_loss() -> None:
    """It comes back with its speed, to the order of what a step of dt changes in a contact, (k/m) dt^2 = 1e-4."""
    force = {"kind": "solid_plane_collide", "particles": [0], "strength": 100.0}
    given = {"solver": "verlet", "time_step": 0.001, "drag": 0.0}
    system = compile(Scene(particles=[[0, 0, 0.5]], velocities=[[0.3, 0, -1.0]], forces=[force], settings=given))
    state = system.start()
    solver("verlet").advance(system, state, 1000, 0.0)
    assert state.v[0] == pytest.approx([0.3, 0.0, 1.0], abs=1e-3)


@pytest.mark.parametrize("slip", [0.02, 0.4])
def test_with_friction_the_tangent_is_that_of_the_force(slip: float) -> None:
    """Held and sliding: the exact tangent against differences (its symmetric part while it slides), and its bound."""
    force = SolidPlaneCollide(particles=[0], normal=[0.2, 0.1, 1.0], strength=30.0, friction=0.7)
    case = case_of("sliding", force, np.array([[0.1, 0.2, 0.0]]))
    x = np.array([[0.1 + slip, 0.2 + 0.5 * slip, -0.3]])
    moved = type(case)(**{**vars(case), "x": x, "conservative": slip < 0.1})
    for seed in range(5):
        laws.tangent_is_the_gradient_of_the_force(moved, np.random.default_rng(seed), 0.01)
        laws.lumped_stiffness_bounds_the_tangent(moved, np.random.default_rng(seed), 0.01)
