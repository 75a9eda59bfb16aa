"""Rigid bodies: the best rotation against another solution of it, a pendulum, joints, a free top, a box on a slope."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from hookean import Scene, relax
from hookean.forces.rigid_body import TURN, poses
from hookean.solvers import solver
from hookean.system.system import System, compile

CUBE = np.array([[i, j, k] for i in (0, 1) for j in (0, 1) for k in (0, 1)], float)


def body(x: Any, settings: Any = None, forces: Any = (), anchors: Any = (), **columns: Any) -> Scene:
    """All particles as one body, with other forces."""
    forces = [{"kind": "rigid_body", "particles": range(len(x)), **columns}, *forces]
    return Scene.read({"particles": x, "forces": forces, "anchors": anchors, "settings": settings or {}})


def energy(system: System, x: np.ndarray) -> float:
    state = system.start()
    state.x[:] = x
    return float(system.evaluate(state)[2].sum())


@pytest.mark.parametrize("count", [2, 3, 4, 20])
def test_the_energy_is_that_of_the_best_rotation(count: int) -> None:
    """Against Kabsch's solution by singular values (scipy), half of its weighted sum of squares: to 1e-12 of it and of
    the rotation, also of mirrored shapes and far from the origin."""
    rng = np.random.default_rng(count)
    for mirror in (1.0, -1.0):
        shape, strength = rng.normal(size=(count, 3)), rng.uniform(1.0, 9.0, count)
        turn = Rotation.random(random_state=count).as_matrix() * mirror
        x = 1.1 * shape @ turn.T + 0.2 * rng.normal(size=(count, 3))
        y, q = (a - np.average(a, axis=0, weights=strength) for a in (x, shape))
        u, s, v = np.linalg.svd((strength[:, None] * q).T @ y)
        side = np.sign(np.linalg.det(u @ v))
        least = 0.5 * float((strength[:, None] * (y**2 + q**2)).sum()) - float(s @ [1.0, 1.0, side])
        system = compile(body(x + [50.0, -60.0, 70.0], shape=shape + [3.0, 4.0, -5.0], strength=strength))
        state = system.start()
        assert energy(system, state.x) == pytest.approx(least, rel=1e-10)
        if count > 3:  # fewer have several, or are nearly flat
            best = v.T @ np.diag([1.0, 1.0, side]) @ u.T
            found = poses(system.groups[0].block, state.x)[0, TURN : TURN + 9].reshape(3, 3)
            assert np.abs(found - best).max() < 1e-11


def test_a_body_that_moves_and_turns_has_no_energy() -> None:
    """Half turns as well, where a quaternion has no real part; rounding of places of size 10, squared."""
    system = compile(body(CUBE))
    for axis in ([0, 0, 1], [0, 1, 0], [1, 0, 0], [1, 1, 1], [0.3, -0.5, 2.0]):
        for angle in (0.0, 0.5 * np.pi, np.pi, 3.0):
            turn = Rotation.from_rotvec(angle * np.array(axis) / np.linalg.norm(axis)).as_matrix()
            assert energy(system, CUBE @ turn.T + [7.0, 8.0, 9.0]) < 8 * 1000.0 * (100 * 2e-16 * 10.0) ** 2


def test_a_body_hangs_below_its_pin() -> None:
    """At rest the loads' centre is straight below the pin (moment 0), and the pin carries all of the load."""
    x = CUBE @ Rotation.from_euler("xyz", [0.3, 1.0, -0.4]).as_matrix().T
    weights = [1.0, 2.0, 1.0, 5.0, 1.0, 1.0, 3.0, 1.0]
    load = {"kind": "unary", "particles": range(8), "vector": [[0, 0, -w] for w in weights]}
    found = relax(body(x, {"tolerance": 1e-10}, [load], [{"particles": [0]}], strength=1e5))
    assert found.converged and found.stability != "unstable"
    centre = np.average(found.particles, axis=0, weights=weights) - found.particles[0]
    assert np.abs(centre[:2]).max() < 1e-8 and centre[2] < -0.5
    assert found.reactions["force"].sum(axis=0) == pytest.approx([0, 0, 15.0], abs=1e-8)


@pytest.mark.parametrize(("shared", "modes"), [(1, 3), (2, 1), (3, 0)])
def test_shared_particles_are_joints(shared: int, modes: int) -> None:
    """A body that shares one particle with a held one turns about it freely (3 motions), two are a hinge (1), three
    hold it."""
    other = CUBE + [0, 0, 1.0]
    x = np.vstack([CUBE, other[[i for i in range(8) if i not in (0, 2, 4)[:shared]]]])
    joints = np.array([1, 3, 5])[:shared]  # of the first cube, which are 0, 2, 4 of the other
    bodies = [*range(8), *joints, *range(8, len(x))]
    force = {"kind": "rigid_body", "particles": bodies, "group": [0] * 8 + [1] * 8}
    scene = {"particles": x, "forces": [force], "anchors": [{"particles": [0, 2, 4]}]}
    found = relax(Scene.read(scene))
    assert found.converged and found.stability == ("mechanism" if modes else "stable")
    assert (found.soft_modes or 0) == modes


def test_a_free_top_precesses() -> None:
    """A symmetric top without torque: its axis turns about the angular momentum L at L / I1 (Landau and Lifshitz,
    Mechanics, 33). Verlet keeps L to rounding; the stretch by its own spin, w^2 / k, is 2e-4 here."""
    high, wide, tilt, strength = 1.5, 0.8, 0.6, 1e4
    top = np.array([[0, 0, high], [0, 0, -high], [wide, 0, 0], [-wide, 0, 0], [0, wide, 0], [0, -wide, 0]])
    inertia, axial, momentum = 2 * high**2 + 2 * wide**2, 4 * wide**2, 6.0
    x = top @ Rotation.from_euler("y", tilt).as_matrix().T
    axis = (x[0] - x[1]) / (2.0 * high)
    spin = np.array([0, 0, momentum / inertia]) + momentum * axis[2] * (1.0 / axial - 1.0 / inertia) * axis
    system = compile(body(x, {"solver": "verlet", "time_step": 0.002, "drag": 0.0}, strength=strength))
    state = system.start()
    state.v[:] = np.cross(spin, x)
    before = np.cross(state.x, state.v).sum(axis=0)
    assert before == pytest.approx([0, 0, momentum], abs=1e-12)
    first = energy(system, state.x) + 0.5 * float((state.v**2).sum())
    solver("verlet").advance(system, state, 1000, 0.0)
    assert np.cross(state.x, state.v).sum(axis=0) == pytest.approx(before, abs=1e-10)
    last = energy(system, state.x) + 0.5 * float((state.v**2).sum())
    # Verlet keeps a neighbour of the energy: (sqrt(k) dt)^2 / 8 of what vibrates, itself w^2 / k of the motion
    assert last == pytest.approx(first, rel=1e-5)
    turned = momentum / inertia * 2.0
    expected = Rotation.from_euler("z", turned).apply(axis)
    found = (state.x[0] - state.x[1]) / np.linalg.norm(state.x[0] - state.x[1])
    assert turned > 1.0 and np.abs(found - expected).max() < 1e-3


def on_slope(slope: float, **settings: Any) -> tuple[Scene, np.ndarray]:
    """A box of weight 8 on a plane of some slope, and the directions down the slope and away from it."""
    turn = Rotation.from_euler("y", math.atan(slope)).as_matrix()
    floor = {"normal": turn[:, 2], "static_friction": 0.6, "kinetic_friction": 0.5, "restitution": 0.0}
    load = {"kind": "unary", "particles": range(8), "vector": [0, 0, -1.0]}
    return body(CUBE @ turn.T, {"floor": floor, **settings}, [load], strength=1e4), turn[:, [0, 2]]


def test_a_box_on_a_slope_rests_below_the_angle_of_friction() -> None:
    """tan a < 0.6: at rest where it was, but for its weight over k, 2e-4 of its size, a few times over."""
    scene, directions = on_slope(0.55, solver="relaxation")
    found = relax(scene)
    assert found.converged
    assert np.abs((found.particles - compile(scene).x) @ directions).max() < 2e-3


def test_a_box_on_a_slope_slides_above_the_angle_of_friction() -> None:
    """By g (sin a - 0.5 cos a) t^2 / 2 (Coulomb); it vibrates as it is let go, which is 2 per cent of the way."""
    scene, directions = on_slope(0.7, solver="verlet", time_step=0.002, drag=0.0)
    system = compile(scene)
    state = system.start()
    solver("verlet").advance(system, state, 1000, 0.0)
    down, away = ((state.x - system.x) @ directions).T
    angle = math.atan(0.7)
    known = 0.5 * (math.sin(angle) - 0.5 * math.cos(angle)) * 2.0**2
    assert down == pytest.approx(np.full(8, known), rel=0.02)
    assert np.abs(away).max() < 2e-3


def test_a_shape_given_far_away_pushes_nothing_as_a_whole() -> None:
    """Places in a body count from its mean: forces sum to zero to the rounding of sizes of 10, not of 1e9 (1e-7)."""
    system = compile(body(CUBE[:7], shape=2.0 * CUBE[:7] + 1e9))
    f = system.evaluate(system.start())[0]
    assert np.abs(f).max() > 100.0 and np.abs(f.sum(axis=0)).max() < 7 * 1000.0 * 10.0 * 1e-15


@pytest.mark.parametrize("count", [2, 3, 8])
def test_one_place_for_all_particles_is_that_of_each(count: int) -> None:
    """A shape of one vector is a body without size: its particles are pulled to their mean, E = sum k |x - c|^2 / 2."""
    x = CUBE[:count]
    system = compile(body(x, shape=[1.0, 2.0, 3.0]))
    assert energy(system, x) == pytest.approx(500.0 * ((x - x.mean(axis=0)) ** 2).sum(), rel=1e-12)


@pytest.mark.parametrize("tolerance", [1e-4, 1e-6, 1e-9])
def test_a_free_body_under_stress_is_a_mechanism_whatever_the_tolerance(tolerance: float) -> None:
    """A particle with two places in its body stresses it. It moves and turns freely: six motions meet no resistance,
    none gains energy, though what is left out of balance turns the tangent a little."""
    shape = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 1.2, 0.3]]
    forces = [{"kind": "rigid_body", "particles": [0, 1, 2, 2], "shape": shape}]
    settings = {"tolerance": tolerance, "position_tolerance": None}
    found = relax(Scene.read({"particles": CUBE[[0, 4, 2]], "forces": forces, "settings": settings}))
    assert found.converged and found.energy["total"] > 1.0
    assert (found.stability, found.soft_modes) == ("mechanism", 6)


@pytest.mark.parametrize("solver", ["momentum", "auto"])
def test_a_body_without_loads_that_has_its_shape_is_at_rest(solver: str) -> None:
    """All that is left is rounding, 1e-16 of its stiffness times its size; that is no load to be judged by."""
    turn = 2.0 * np.pi * np.arange(5) / 5.0
    x = np.column_stack([np.cos(turn) + 2.2, np.sin(turn), 0.0 * turn])
    body = {"kind": "rigid_body", "particles": np.arange(5), "strength": 10.0}
    result = relax(Scene.read({"particles": x, "forces": [body], "settings": {"solver": solver}}))
    assert result.converged and result.iterations == 0
    np.testing.assert_allclose(result.particles, x, atol=1e-14)
