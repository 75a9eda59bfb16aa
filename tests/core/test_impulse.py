"""Impulses: momentum balance, a pendulum that is struck, division of runs, books of the energy."""

from __future__ import annotations

import numpy as np
import pytest

from hookean import InputError, Scene, Simulation, relax
from hookean.solvers import solver
from hookean.system.state import State
from hookean.system.system import compile

SOLVERS = ["verlet", "yoshida"]


def blast(**more: object) -> dict[str, object]:
    """An explosion below the middle of a net, at 0.055."""
    return {"kind": "impulse", "origin": [0.4, 0.6, -1.0], "momentum": 2.0, "time": 0.055, **more}


def net(
    solver: str = "verlet", masses: object = 0.7, *forces: dict[str, object], anchors: object = (), **settings: object
) -> Scene:
    """A square of four springs."""
    x = [[0.0, 0, 0], [1.0, 0, 0.1], [1.0, 1, 0], [0.0, 1, 0.2]]
    springs = {"kind": "springs", "particles": [[0, 1], [1, 2], [2, 3], [3, 0]], "stiffness": 40.0, "damping": 0.5}
    given = {"solver": solver, "drag": 0.0, "time_step": 0.01, **settings}
    return Scene(particles=x, masses=masses, anchors=anchors, forces=[springs, *forces], settings=given)


def moved(scene: Scene, steps: int) -> State:
    """The state after some steps."""
    system = compile(scene)
    state, method = system.start(), solver(scene.settings.solver)
    method.start(system, state)
    method.advance(system, state, steps, 0.0)
    return state


@pytest.mark.parametrize("name", SOLVERS)
def test_the_momentum_is_what_is_given(name: str) -> None:
    """Internal forces keep the sum of m v; so after the moment it is the sum of P u with the positions of the step that
    contains it, whatever the masses; rounding of 30 steps of sums of 4: 1e-14."""
    masses = [0.5, 1.0, 2.0, 0.7]
    scene = net(name, masses, blast(momentum=[1.0, -2.0, 3.0, 0.5]))
    before = moved(scene, 5)
    apart = before.x - [0.4, 0.6, -1.0]
    given = np.array([1.0, -2.0, 3.0, 0.5])[:, None] * apart / np.linalg.norm(apart, axis=1, keepdims=True)
    assert np.array(masses) @ before.v == pytest.approx(np.zeros(3), abs=1e-15)
    for steps in (6, 30):
        assert np.array(masses) @ moved(scene, steps).v == pytest.approx(given.sum(axis=0), rel=1e-14, abs=1e-14)


def test_free_particles_fly_apart_evenly() -> None:
    """Without forces x = x0 + (t - t0) P u / m: straight lines, at speeds that follow from the momentum alone."""
    x = np.array([[1.0, 2, 2], [-3.0, 0, 4]])
    scene = Scene(
        particles=x, masses=[0.5, 2.0], forces=[{"kind": "impulse", "particles": [0, 1], "momentum": 3.0, "time": 0.2}],
        settings={"solver": "verlet", "drag": 0.0, "time_step": 0.05},
    )  # fmt: skip
    assert moved(scene, 4).x.tolist() == x.tolist()
    late = moved(scene, 24)
    speed = np.array([[6.0], [1.5]]) * x / np.array([[3.0], [5.0]])
    assert late.v == pytest.approx(speed, rel=1e-15)
    assert late.x == pytest.approx(x + speed, rel=1e-13)


def test_a_struck_pendulum_rises_to_the_height_of_its_energy() -> None:
    """P along x on a mass at rest that slides along x against a spring k: amplitude P / sqrt(k m), by the energy
    P^2 / 2m = k a^2 / 2. A step of verlet is w dt = 0.01: its ellipse is wider by (w dt)^2 / 8."""
    forces = [
        {"kind": "anchor_spring", "particles": [0], "strength": 50.0},
        {"kind": "impulse", "particles": [0], "origin": [-1.0, 0, 0], "momentum": 3.0},
    ]
    scene = Scene(
        particles=[[0.0, 0, 0]], masses=2.0, forces=forces,
        settings={"solver": "verlet", "drag": 0.0, "time_step": 0.002},
    )  # fmt: skip
    system = compile(scene)
    state, method, way = system.start(), solver("verlet"), []
    method.start(system, state)
    for _ in range(700):
        method.advance(system, state, 1, 0.0)
        way.append(state.x[0, 0])
    assert max(way) == pytest.approx(3.0 / np.sqrt(50.0 * 2.0), rel=0.01**2 / 8.0 + 0.005**2 / 2.0)


def test_anchors_take_what_is_along_their_axes() -> None:
    """A particle held along x and z gains along y alone; one held on all axes stays."""
    scene = net("verlet", 1.0, blast(time=0.0), anchors=[{"particles": [0], "axes": "xz"}, {"particles": [1]}])
    first = moved(scene, 1)
    assert first.v[1].tolist() == [0, 0, 0]
    assert first.v[0, 0] == first.v[0, 2] == 0.0
    assert first.v[0, 1] != 0.0


@pytest.mark.parametrize("name", SOLVERS)
@pytest.mark.parametrize("moment", [0.0, 0.055, 0.06, 0.29])
def test_runs_in_pieces_are_runs_as_a_whole(name: str, moment: float) -> None:
    """Saved, read and resumed at any step, before, at and after the moment: the same bits, divided steps included."""
    for settings in ({}, {"divide_steps": True, "time_step": 0.2}):
        scene = net(name, 0.7, blast(time=moment), **settings)
        whole, system = moved(scene, 31), compile(scene)
        state = system.start()
        solver(name).start(system, state)
        for several in (1, 2, 2, 1, 1, 3, 7, 14):
            state = State.of(state.arrays())
            solver(name).advance(system, state, several, 0.0)
        assert whole.arrays().keys() == state.arrays().keys()
        for key, array in whole.arrays().items():
            assert array.tobytes() == state.arrays()[key].tobytes(), key


def test_each_moment_is_in_one_step() -> None:
    """Times of steps are sums with rounding: a moment that is a multiple of the step still comes once, at that step."""
    for number in range(1, 200):
        force = {"kind": "impulse", "particles": [0], "origin": [-1, 0, 0], "time": 0.01 * number}
        settings = {"solver": "verlet", "drag": 0.0, "time_step": 0.01}
        scene = Scene(particles=[[0.0, 0, 0]], forces=[force], settings=settings)
        assert moved(scene, number).v[0, 0] == 0.0, number
        assert moved(scene, number + 1).v[0, 0] == 1.0, number


def test_a_run_waits_for_the_moment_and_its_energy_is_no_fault_of_the_steps() -> None:
    """A net at rest is struck at 0.5 by 50 times the energy of anything before, and comes to rest again: nothing warns
    of steps that are too long, and none is divided."""
    held = [{"particles": [0, 1, 2]}]
    scene = net("verlet", 1.0, blast(time=0.5, momentum=5.0), anchors=held, drag=1.0, max_iterations=20000)
    found = relax(scene)
    assert found.converged, found.message
    assert found.iterations > 50
    assert not [said for said in found.report.sentences() if "time_step" in said]


def test_solvers_of_equilibrium_leave_it_out_and_warn() -> None:
    """The same shape as without it, and a sentence."""
    scene = net("auto", 1.0, blast(), anchors=[{"particles": [0, 1, 2]}])
    found, without = relax(scene), relax(scene.replaced(forces=scene.forces[:1]))
    assert found.particles.tolist() == without.particles.tolist()
    assert any("/forces/1: an impulse acts in physical time only" in said for said in found.report.sentences())


def test_a_patch_changes_it_while_it_waits() -> None:
    """A running simulation takes another momentum; the origin's own particle has no direction and gains nothing."""
    force = {"kind": "impulse", "particles": [0, 1], "origin": [0, 0, 0], "time": 0.05, "momentum": 1.0}
    settings = {"solver": "verlet", "drag": 0.0, "time_step": 0.01}
    simulation = Simulation(Scene(particles=[[0.0, 0, 0], [2.0, 0, 0]], forces=[force], settings=settings))
    simulation.advance(3)
    simulation.patch({"forces": {"0": {"momentum": 4.0}}})
    simulation.advance(5)
    assert simulation.state.v.tolist() == [[0, 0, 0], [4.0, 0, 0]]


def test_bad_input_is_refused() -> None:
    """A moment that is no number."""
    with pytest.raises(InputError, match="/forces/0/time"):
        Scene(particles=np.eye(3), forces=[{"kind": "impulse", "particles": [0], "time": [float("nan")]}])
