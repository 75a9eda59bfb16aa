"""Stability of explicit time stepping: the limit is known before the motion explodes."""

from __future__ import annotations

import re

import numpy as np
import pytest

from hookean import Scene, Simulation, simulate
from hookean.discretize import diagonals as across
from hookean.discretize import edges, grid
from hookean.running.in_motion import MOST_STEPS, in_motion
from hookean.running.result import Status
from hookean.stability.time_steps import critical_time_step, highest_mode, stable_time_step
from hookean.system.system import compile


def sheet(stiffness: float, diagonals: bool, damping: float, drag: float, **settings: object) -> Scene:
    """A flat sheet of 20 x 20 square cells, masses 1."""
    mesh = grid(np.arange(21) * 0.5, np.arange(21) * 0.5)
    pairs = np.concatenate([edges(mesh), *([across(mesh)] if diagonals else [])])
    x, y, z = mesh.vertices.T
    return Scene(
        particles=mesh.vertices,
        velocities=np.stack([1e-3 * np.sin(7.0 * x + 3.0 * y**2), z, z], axis=1),
        forces=[{"kind": "springs", "particles": pairs, "stiffness": stiffness, "damping": damping}],
        settings={"drag": drag, "solver": "verlet", **settings},
    )


@pytest.mark.parametrize(
    ("stiffness", "diagonals", "undamped", "damped"),
    [
        (5000, True, 0.01004, 0.00822),
        (7000, True, 0.00849, 0.00717),
        (5000, False, 0.01418, 0.01227),
        (7000, False, 0.01199, 0.01061),
    ],
)
def test_critical_steps_of_the_chapters_sheet(stiffness, diagonals, undamped, damped):
    """2/omega, and (2/omega)(sqrt(1 + zeta^2) - zeta) with damping 10 along springs and drag 1. The rows give three
    digits: agreement to 1 of the last one."""
    for damping, drag, expected in ((0.0, 0.0, undamped), (10.0, 1.0, damped)):
        system = compile(sheet(stiffness, diagonals, damping, drag))
        assert stable_time_step(system, system.start()) == pytest.approx(expected, abs=1.01e-5)


@pytest.mark.parametrize(("damping", "drag"), [(0.0, 0.0), (10.0, 1.0)])
def test_the_step_that_is_told_holds_and_a_larger_one_explodes(damping: float, drag: float):
    """Below the limit the sheet's small vibration stays small; above it it grows without bound, as was said before."""
    system = compile(sheet(5000, True, damping, drag))
    limit = stable_time_step(system, system.start())
    held = Simulation(sheet(5000, True, damping, drag, time_step=0.99 * limit))
    assert not held.system.report.warnings
    start = held.state.x.copy()
    held.iterate(2000)
    assert np.abs(held.state.x - start).max() < 0.05
    # with damping the scheme itself lasts a little longer than the limit that is told
    burst = Simulation(sheet(5000, True, damping, drag, time_step=1.15 * limit))
    (warning,) = burst.system.report.warnings
    assert "/settings/time_step" in warning
    told = float(re.split("(?:any|most) motions?, ", warning)[1].split(" s in small")[0])
    assert 0.999 * limit < told <= limit
    assert float(warning.split("Steps up to ")[1].split(" s are stable in ")[0]) < told
    burst.iterate(1000)
    # crumpled springs soften, so an explosion may stay finite; it has left the small vibration 4 orders behind
    assert burst.status is Status.DIVERGED or np.abs(burst.state.x - start).max() > 1.0


def test_a_diverged_step_gives_back_the_last_good_shape_and_names_the_culprit():
    """A step a thousand times too large: finite positions, a particle and a force named, and the step that holds."""
    frames = list(simulate(sheet(5000, True, 0.0, 0.0, time_step=10.0)))
    last = frames[-1]
    assert last.status is Status.DIVERGED
    assert np.isfinite(last.particles).all()
    assert "particle " in last.message
    assert "/forces/0, springs" in last.message
    assert "were stable" in last.message


def test_critical_step_of_one_spring():
    """omega = sqrt(k/m): two masses on a spring move against each other with omega = sqrt(2 k/m)."""
    scene = Scene(
        particles=[[0, 0, 0], [1, 0, 0]],
        masses=2.0,
        forces=[{"kind": "springs", "particles": [[0, 1]], "stiffness": 100, "damping": 0}],
        settings={"drag": 0},
    )
    system = compile(scene)
    assert stable_time_step(system, system.start()) == pytest.approx(2.0 / np.sqrt(2 * 100 / 2.0), rel=1e-9)
    assert critical_time_step(0.0) == np.inf


@pytest.mark.parametrize("omega", [1e-3, 2.0, 5e4])
@pytest.mark.parametrize("ratio", [0.0, 0.1, 1.0, 20.0])
def test_critical_step_of_a_frequency(omega: float, ratio: float):
    """dt^2 omega^2 / 4 + dt zeta omega = 1: what the two sides of the scheme's limit meet at."""
    step = critical_time_step(omega, ratio)
    assert step**2 * omega**2 / 4.0 + step * ratio * omega == pytest.approx(1.0, rel=1e-12)


@pytest.mark.parametrize("stiffness", [0.01, 100.0])
def test_the_highest_mode_of_two_masses_is_the_one_against_each_other(stiffness: float):
    """m u'' = -2 c u' - 2 k u: omega = sqrt(2 k / m), damping ratio c / (m omega); m = 2 kg, c = 0.1 N s/m."""
    springs = {"kind": "springs", "particles": [[0, 1]], "stiffness": stiffness, "damping": 0.1}
    system = compile(Scene(particles=[[0, 0, 0], [1, 0, 0]], masses=2.0, forces=[springs], settings={"drag": 0}))
    omega = np.sqrt(2.0 * stiffness / 2.0)
    assert highest_mode(system, system.start()) == pytest.approx((omega, 0.1 / (2.0 * omega)), rel=1e-9)


@pytest.mark.parametrize(("drag", "step"), [(0.0, np.inf), (3.0, 4.0 / 3.0)])
def test_without_stiffness_the_drag_alone_limits_the_step(drag: float, step: float):
    """Two masses of 2 kg that fall: dt c / m <= 2, and any step where there is no drag either."""
    weight = {"kind": "unary", "particles": [0, 1], "vector": [0, 0, -1]}
    scene = Scene(particles=[[0, 0, 0], [1, 0, 0]], masses=2.0, forces=[weight], settings={"drag": drag})
    system = compile(scene)
    assert stable_time_step(system, system.start()) == pytest.approx(step, rel=1e-12)


def test_a_drag_that_does_not_limit_the_step_is_not_blamed():
    """Two masses of 1 kg: sqrt(2 k / m) = 0.63 / s of the spring is more than drag / 2 m = 0.5 / s."""
    springs = {"kind": "springs", "particles": [[0, 1]], "stiffness": 0.2, "damping": 0}
    settings = {"drag": 1.0, "time_step": 5.0, "solver": "verlet"}
    (warning,) = Simulation(
        Scene(particles=[[0, 0, 0], [1, 0, 0]], forces=[springs], settings=settings)
    ).system.report.warnings
    assert "the stiffness of /forces/0, springs;" in warning


@pytest.mark.parametrize("loose", [0, 1, 3])
def test_particles_beside_a_damped_spring_change_no_step(loose: int):
    """Two masses of 2 kg, 100 N/m, 10 N s/m: k = 100 / s^2, c = 10 / s, so dt = 2 / (c/2 + sqrt(c^2/4 + k)).

    What is told is that, rounded down to four digits. Particles without a spring have no limit.
    """
    scene = Scene(
        particles=[[float(i), 0, 0] for i in range(2 + loose)],
        masses=2.0,
        forces=[{"kind": "springs", "particles": [[0, 1]], "stiffness": 100, "damping": 10}],
        settings={"drag": 0, "solver": "verlet", "time_step": 1.0},
    )
    limit = 2.0 / (5.0 + np.sqrt(25.0 + 100.0))
    system = compile(scene)
    assert stable_time_step(system, system.start()) == pytest.approx(limit, rel=1e-9)
    (warning,) = Simulation(scene).system.report.warnings
    assert f", {np.floor(limit * 1e4) / 1e4:.4g} s in small ones" in warning
    assert not Simulation(scene.replaced(settings=scene.settings.replaced(time_step=0.12))).system.report.warnings


@pytest.mark.slow
def test_a_step_that_holds_at_the_start_only_ends_the_run_where_it_is_too_long():
    """A spring with a lower cutoff has no stiffness until it is that long: then 2/omega = 2 sqrt(m/k) falls below dt.
    The step that is named was tried: at most half of it, as nothing damps the motion (see `margin`)."""
    scene = Scene(
        particles=[[0, 0, 0], [1, 0, 0]],
        velocities=[[0, 0, 0], [1, 0, 0]],
        forces=[{"kind": "springs", "particles": [[0, 1]], "stiffness": 1e5, "damping": 0, "lower_cutoff": 1.05}],
        anchors=[{"particles": [0]}],
        settings={"drag": 0, "sub_iterations": 1, "time_step": 0.01},
    )
    running = Simulation(scene)
    assert not running.result().report.warnings
    assert running.step(100) is Status.DIVERGED
    assert running.state.x[1, 0] == pytest.approx(1.05, abs=0.011)  # a step of 0.01 at speed 1
    told = float(running.message.split("Steps of ")[1].split(" s were stable for ")[0])
    assert 0.0 < told <= 0.5 * 2.0 / np.sqrt(1e5)
    settings = scene.settings.replaced(time_step=told)
    assert Simulation(scene.replaced(settings=settings)).step(2000) is Status.RUNNING


def chain(**settings: object) -> Scene:
    """Links of 1e6 N/m and 1 kg: the usual step of 0.01 s is ten times what holds, 2 / sqrt(4 k / m) = 0.001 s."""
    return Scene(
        particles=[[float(i), 0.0, 0.0] for i in range(40)],
        forces=[
            {"kind": "springs", "particles": [[i, i + 1] for i in range(39)], "stiffness": 1e6},
            {"kind": "unary", "particles": list(range(40)), "vector": [0.0, 0.0, -10.0]},
        ],
        anchors=[{"particles": [0, 39]}],
        settings=settings,
    )


def test_a_scene_is_made_fit_to_move():
    """With the usual step it explodes; with 0.9 of what is stable (see `margin`) it swings, and a frame is as long as
    usual: 0.2 s in 0.0009 s each, were it not for the most steps. Springs have damping 10, particles drag 1."""
    assert Simulation(chain(time_step=0.01)).step(10) is Status.DIVERGED
    scene, said = in_motion(chain())
    holds = critical_time_step(2e3, (4 * 10 + 1) / (2 * 2e3))
    assert scene.settings.time_step == pytest.approx(0.9 * holds, rel=1e-3) and "steps of 0.000" in said
    assert scene.settings.sub_iterations == MOST_STEPS
    moving = Simulation(Scene.read(scene.canonical))
    assert moving.step(50) is Status.RUNNING and not moving.system.report.warnings
    assert in_motion(chain(sub_iterations=7))[0].settings.sub_iterations == 7


@pytest.mark.parametrize("settings", [{"time_step": 0.01}, {"solver": "relaxation"}, {"solver": "momentum"}])
def test_what_was_chosen_stays(settings):
    scene = chain(**settings)
    assert in_motion(scene) == (scene, "")


def test_a_scene_that_holds_stays():
    scene = chain(drag=0).model_copy(update={"forces": chain().forces[1:]})
    assert in_motion(scene) == (scene, "")
