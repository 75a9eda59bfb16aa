"""Motion through time against closed forms: frequencies, orders, energies, drag, bounces."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from hookean import InputError, Scene, Simulation
from hookean.discretize import edges, grid
from hookean.running.result import Status
from hookean.solvers import solver
from hookean.stability.time_steps import highest_mode, stable_time_step
from hookean.system.system import System, compile
from soak import SOAK


def mass_on_spring(dt: float, method: str = "verlet", **more: Any) -> System:
    """Mass 1 on a spring of k 1000 along x, at rest at x = 1, pulled to 1.1; omega = 31.6227766."""
    spring = {"kind": "springs", "particles": [[0, 1]], "stiffness": 1000.0, "damping": 0.0, "rest_length": 1.0}
    settings = {"solver": method, "time_step": dt, "drag": 0.0}
    return compile(
        Scene.read(
            {
                "particles": [[0, 0, 0], [1.1, 0, 0]],
                "forces": [{**spring, **more.get("spring", {})}, *more.get("forces", [])],
                "anchors": [{"particles": [0]}],
                "settings": {**settings, **more.get("settings", {})},
            }
        )
    )


def path(system: System, steps: int, method: str = "verlet") -> np.ndarray:
    """x of particle 1 after every step, the start first."""
    state = system.start()
    found = [state.x[1, 0]]
    for _ in range(steps):
        solver(method).advance(system, state, 1, 0.0)
        found.append(state.x[1, 0])
    return np.array(found)


@pytest.mark.parametrize(("dt", "expected"), [(0.01, 31.756043), (0.005, 31.655810)])
def test_verlet_vibrates_at_its_own_frequency(dt: float, expected: float) -> None:
    """omega_d = (2/dt) asin(omega dt/2); the path is 1 + 0.1 cos(omega_d t) exactly, here to 1e-11 over 1000 steps."""
    omega = math.sqrt(1000.0)
    discrete = 2.0 / dt * math.asin(0.5 * omega * dt)
    assert discrete == pytest.approx(expected, abs=5e-7)
    found = path(mass_on_spring(dt), 1000)
    assert np.abs(found - 1.0 - 0.1 * np.cos(discrete * dt * np.arange(1001))).max() < 1e-11
    # the undiscretised frequency is a different one: it would show
    assert np.abs(found - 1.0 - 0.1 * np.cos(omega * dt * np.arange(1001))).max() > 0.01


@pytest.mark.slow
def test_stability_knows_the_frequency() -> None:
    """Highest mode 31.6227766, largest step 2 / omega: just below it the motion stays bounded, just above it grows."""
    system = mass_on_spring(0.01)
    omega, damping = highest_mode(system, system.start())
    assert omega == pytest.approx(31.6227766, abs=1e-7) and damping == 0.0
    limit = stable_time_step(system, system.start())
    assert limit == pytest.approx(2.0 / math.sqrt(1000.0), rel=1e-9)
    below = path(mass_on_spring(0.999 * limit), 2000)
    assert np.abs(below - 1.0).max() < 0.1 * 1.001
    above = path(mass_on_spring(1.01 * limit), 40)
    assert np.abs(above - 1.0).max() > 1.0


def pendulum(method: str, dt: float, count: int) -> np.ndarray:
    """Positions after `count` steps of a chain of three heavy masses on stiff springs, let go sideways."""
    x = np.array([[0.0, 0, 0], [1.0, 0, 0], [1.8, 0.3, 0], [2.5, 0.1, 0.4]])
    system = compile(
        Scene.read(
            {
                "particles": x,
                "forces": [
                    {"kind": "springs", "particles": [[0, 1], [1, 2], [2, 3]], "stiffness": 60.0, "damping": 0.0},
                    {"kind": "unary", "particles": [1, 2, 3], "vector": [0, 0, -3.0]},
                ],
                "anchors": [{"particles": [0]}],
                "settings": {"solver": method, "time_step": dt, "drag": 0.0},
            }
        )
    )
    state = system.start()
    solver(method).advance(system, state, count, 0.0)
    return state.x


@pytest.mark.parametrize(("method", "order"), [("verlet", 2), ("yoshida", 4)])
def test_order_of_accuracy(method: str, order: int) -> None:
    """A nonlinear chain after 1 time unit: halving the step divides the error by 2^order; slope +- 0.15."""
    exact = pendulum("yoshida", 1.0 / 6400, 6400)
    steps = np.array([50, 100, 200, 400])
    errors = [np.abs(pendulum(method, 1.0 / n, int(n)) - exact).max() for n in steps]
    slope = -np.polyfit(np.log(steps), np.log(errors), 1)[0]
    assert slope == pytest.approx(order, abs=0.15)


@pytest.mark.slow
def test_drag_keeps_the_order_two() -> None:
    """Damping along springs and drag keep order 2: a damped oscillator at t = 1, slope 2 +- 0.15."""
    spring = {"damping": 3.0}
    omega, half = math.sqrt(1000.0), 0.5 * (3.0 + 1.0)
    ringing = math.sqrt(omega**2 - half**2)
    exact = 1.0 + 0.1 * math.exp(-half) * (math.cos(ringing) + half / ringing * math.sin(ringing))
    steps = np.array([200, 400, 800, 1600])
    errors = [
        abs(path(mass_on_spring(1.0 / n, spring=spring, settings={"drag": 1.0}), int(n))[-1] - exact) for n in steps
    ]
    slope = -np.polyfit(np.log(steps), np.log(errors), 1)[0]
    assert slope == pytest.approx(2, abs=0.15)


@pytest.mark.parametrize("method", ["verlet", "yoshida"])
def test_undamped_energy_is_bounded_without_drift(method: str) -> None:
    """Over 1e5 steps (1e4 in the short form) of an undamped net: the energy swings but does not drift.

    |E - E0| <= 1e-2 of the kinetic energy at its largest; the line fitted through it changes by less than a tenth of
    that over the whole run.
    """
    rng = np.random.default_rng(2)
    mesh = grid(np.arange(5), np.arange(5), 0.1 * rng.normal(size=(5, 5)))
    scene = Scene.read(
        {
            "particles": mesh.vertices,
            "forces": [
                {"kind": "springs", "particles": edges(mesh), "stiffness": 100.0, "damping": 0.0, "rest_factor": 0.8},
                {"kind": "self_weight", "total": 50.0},
            ],
            "anchors": [{"particles": [0, 4, 20, 24]}],
            "settings": {"solver": method, "time_step": 0.005, "drag": 0.0},
        }
    )
    system = compile(scene)
    state = system.start()
    total, kinetic = [], []
    samples = 1000
    for _ in range(samples):
        _, _, energies = system.evaluate(state)
        kinetic.append(0.5 * float((system.mass[:, None] * state.v**2).sum()))
        total.append(float(energies.sum()) + kinetic[-1])
        solver(method).advance(system, state, (100_000 if SOAK else 10_000) // samples, 0.0)
    swing = np.array(total) - total[0]
    most = max(kinetic)
    assert most > 10.0
    assert np.abs(swing).max() <= 1e-2 * most
    drift = np.polyfit(np.linspace(0.0, 1.0, samples), swing, 1)[0]
    assert abs(drift) <= 1e-3 * most


@pytest.mark.slow
def test_damped_energy_never_rises() -> None:
    """With damping and drag the energy after each step is not above the one before by more than 1e-9 of the first."""
    system = mass_on_spring(0.001, spring={"damping": 10.0}, settings={"drag": 1.0})
    state, energies = system.start(), []
    for _ in range(3000):
        energies.append(float(system.evaluate(state)[2].sum()) + 0.5 * float((state.v**2).sum()))
        solver("verlet").advance(system, state, 1, 0.0)
    # Verlet conserves a neighbour of the energy, (omega dt)^2 / 8 away: its ripple is the only rise there may be
    ripple = 1000.0 * 0.001**2 / 8.0
    rise = np.diff(energies) / energies[:-1]
    assert rise.max() <= 2.0 * ripple * math.sqrt(1000.0) * 0.001
    assert energies[-1] < 1e-12 * energies[0]


def test_free_motion_keeps_momentum() -> None:
    """Nothing outside, drag 0, damping along springs on: linear and angular momentum change by rounding alone."""
    rng = np.random.default_rng(5)
    x, v = rng.uniform(-1, 1, (10, 3)), rng.normal(size=(10, 3))
    mass = rng.uniform(0.5, 2.0, 10)
    pairs = [[i, j] for i in range(10) for j in range(i)]
    system = compile(
        Scene.read(
            {
                "particles": x, "velocities": v, "masses": mass,
                "forces": [{"kind": "springs", "particles": pairs, "stiffness": 50.0, "damping": 1.0}],
                "settings": {"solver": "verlet", "time_step": 0.002, "drag": 0.0},
            }
        )
    )  # fmt: skip
    state = system.start()
    state.v[:] = v

    def momenta() -> np.ndarray:
        p = mass[:, None] * state.v
        return np.concatenate([p.sum(axis=0), np.cross(state.x, p).sum(axis=0)])

    before, scale = momenta(), float(np.abs(mass[:, None] * v).sum())
    solver("verlet").advance(system, state, 1000, 0.0)
    assert np.abs(momenta() - before)[:3].max() <= 1e-12 * scale
    # forces along springs keep the angular momentum of Verlet's positions and half-step velocities exactly
    assert np.abs(momenta() - before)[3:].max() <= 1e-11 * scale * 2.0


def test_velocities_of_the_scene_are_where_motion_starts() -> None:
    """A thrown particle: x = v0 t + g t^2/2 exactly, for any step."""
    system = compile(
        Scene.read(
            {
                "particles": [[0, 0, 0]], "velocities": [[3.0, 0.0, 4.0]],
                "forces": [{"kind": "unary", "particles": [0], "vector": [0, 0, -9.8]}],
                "settings": {"time_step": 0.1, "drag": 0.0, "sub_iterations": 10},
            }
        )
    )  # fmt: skip
    running = Simulation(system.scene)
    running.step()
    assert running.state.x[0] == pytest.approx([3.0, 0.0, 4.0 - 4.9], abs=1e-12)
    assert running.state.time == pytest.approx(1.0)


def test_free_fall_with_drag() -> None:
    """v = (F/c)(1 - exp(-c t/m)): F 9.8, c 1, m 1, t 2: v 8.473714, x 11.126286; error falls with dt^2."""
    errors = []
    for dt in (0.01, 0.005):
        system = compile(
            Scene.read(
                {
                    "particles": [[0, 0, 0]],
                    "forces": [{"kind": "unary", "particles": [0], "vector": [9.8, 0, 0]}],
                    "settings": {"time_step": dt, "drag": 1.0},
                }
            )
        )
        state = system.start()
        solver("verlet").advance(system, state, round(2.0 / dt), 0.0)
        errors.append([state.v[0, 0] - 8.473714, state.x[0, 0] - 11.126286])
    coarse, fine = np.array(errors)
    assert np.abs(fine).max() < 5e-5
    assert (4.0 * fine - coarse) / 3.0 == pytest.approx([0.0, 0.0], abs=1e-6)


@pytest.mark.slow
def test_one_spring_under_a_step_load_overshoots() -> None:
    """k 1000, m 1, damping 10, drag 1: zeta 0.173925; overshoot exp(-pi zeta/sqrt(1-zeta^2)) = 0.574153, at 0.100883 s.

    The peak lies between samples: a parabola through three of them; then Richardson for dt -> 0.
    """
    zeta = 11.0 / (2.0 * math.sqrt(1000.0))
    assert zeta == pytest.approx(0.173925, abs=5e-7)
    assert math.exp(-math.pi * zeta / math.sqrt(1 - zeta**2)) == pytest.approx(0.574153, abs=5e-7)
    load = {"kind": "unary", "particles": [1], "vector": [100.0, 0, 0]}
    found = []
    for dt in (2e-4, 1e-4):
        system = mass_on_spring(dt, spring={"damping": 10.0}, forces=[load], settings={"drag": 1.0})
        system.x[1, 0] = 1.0
        moved = (path(system, round(0.15 / dt)) - 1.0) / 0.1
        top = int(np.argmax(moved))
        before, peak, after = moved[top - 1 : top + 2]
        lag = 0.5 * (before - after) / (before - 2.0 * peak + after)
        found.append([peak - 0.25 * (before - after) * lag - 1.0, (top + lag) * dt])
    limit = (4.0 * np.array(found[1]) - found[0]) / 3.0
    assert limit == pytest.approx([0.574153, 0.100883], abs=1e-6)
    assert found[1] == pytest.approx([0.574153, 0.100883], abs=1e-5)


def test_bounces_fall_off_with_the_square_of_the_restitution() -> None:
    """h_n = h0 e^(2n): with e 0.7, 0.49, 0.2401, 0.117649; free fall between impacts is exact at any step."""
    system = compile(
        Scene.read(
            {
                "particles": [[0, 0, 1.0]],
                "forces": [{"kind": "unary", "particles": [0], "vector": [0, 0, -9.8]}],
                "settings": {"time_step": 0.001, "drag": 0.0, "floor": {"restitution": 0.7}},
            }
        )
    )
    state, heights = system.start(), []
    for _ in range(1700):
        solver("verlet").advance(system, state, 1, 0.0)
        heights.append(state.x[0, 2])
    z = np.array(heights)
    tops = z[1:-1][(z[1:-1] >= z[:-2]) & (z[1:-1] > z[2:])]
    # a top lies within half a step of a sample: g (dt/2)^2 / 2 below it at most
    assert tops[:3] == pytest.approx([0.49, 0.2401, 0.117649], abs=1.3e-6)
    assert z.min() >= 0.0


def test_a_ball_without_rebound_stays_on_the_floor() -> None:
    """Restitution 0: after the impact the particle rests, carried by its weight, and the simulation says so."""
    running = Simulation(
        Scene.read(
            {
                "particles": [[0, 0, 0.3]],
                "forces": [{"kind": "unary", "particles": [0], "vector": [0, 0, -9.8]}],
                "settings": {"time_step": 0.01, "floor": {"restitution": 0.0}},
            }
        )
    )
    for _ in range(10):
        running.step()
    assert running.status is Status.CONVERGED
    assert abs(running.state.x[0, 2]) < 1e-12 and np.abs(running.state.v).max() < 1e-12
    assert running.result().contacts["force"][0] == pytest.approx([0, 0, 9.8], abs=1e-9)


def test_friction_stops_a_sliding_particle() -> None:
    """v0 = 2, mu_k 0.5, g 9.8: it slides v0^2 / (2 mu g) = 0.408163 and stops after v0 / (mu g) = 0.408163 s."""
    system = compile(
        Scene.read(
            {
                "particles": [[0, 0, 0.0]], "velocities": [[2.0, 0.0, 0.0]],
                "forces": [{"kind": "unary", "particles": [0], "vector": [0, 0, -9.8]}],
                "settings": {"time_step": 1e-4, "drag": 0.0, "floor": {"kinetic_friction": 0.5}},
            }
        )
    )  # fmt: skip
    state = system.start()
    state.v[:] = system.v
    solver("verlet").advance(system, state, 4000, 0.0)
    assert state.v[0, 0] == pytest.approx(2.0 - 4.9 * 0.4, abs=1e-3)
    solver("verlet").advance(system, state, 1000, 0.0)
    assert np.abs(state.v).max() == 0.0
    assert state.x[0, 0] == pytest.approx(2.0**2 / (2 * 4.9), abs=4e-4)


def test_damping_does_not_hold_what_static_friction_cannot() -> None:
    """A spring pulls with 1.01 mu_s N a particle whose speed makes its damping push against that: it slides all the
    same, to where the pull is mu_k N. In balance it is as soon as the pull is mu_s N."""
    press, static, kinetic, stiffness = 1.0, 0.6, 0.5, 20.0
    pull = 1.01 * static * press
    running = Simulation(
        Scene.read(
            {
                "particles": [[0, 0, 0], [1, 0, 0]], "velocities": [[5e-4, 0, 0], [0, 0, 0]],
                "forces": [
                    {"kind": "springs", "particles": [[0, 1]], "stiffness": stiffness, "damping": 20.0,
                     "rest_length": 1.0 - pull / stiffness},
                    {"kind": "unary", "particles": [0], "vector": [0, 0, -press]},
                    {"kind": "floor", "static_friction": static, "kinetic_friction": kinetic},
                ],
                "anchors": [{"particles": [1]}], "settings": {"solver": "verlet", "time_step": 0.01},
            }
        )
    )  # fmt: skip
    assert running.result().residual == pytest.approx((pull - static * press) / press, rel=1e-9)
    for _ in range(20):
        running.step()
    assert running.status is Status.CONVERGED
    assert running.state.x[0, 0] > (pull - static * press) / stiffness
    # x'' + 21 x' + 20 x = pull - mu_k N creeps to where the pull is mu_k N: after 20 s exp(-20) of the way is left
    solver("verlet").advance(running.system, running.state, 2000, 0.0)
    assert running.state.x[0, 0] == pytest.approx((pull - kinetic * press) / stiffness, rel=2.0 * math.exp(-20.0))
    assert np.abs(running.state.v).max() <= 2.0 * math.exp(-20.0) * (pull - kinetic * press) / stiffness


def test_friction_that_slides_with_more_than_it_holds_is_refused() -> None:
    """mu_s 0.3 < mu_k 0.5: the same push would and would not move what rests. In a scene, its settings and a patch. A
    smooth floor of which only mu_s is given slides with no more, as does what is written of it."""
    wrong = {"kind": "floor", "static_friction": 0.3, "kinetic_friction": 0.5}
    said = "0.5 given, above the static friction, 0.3; lower it, or raise static_friction"
    for place, scene in (
        ("/forces/0", {"forces": [wrong]}),
        ("/settings/floor", {"forces": [], "settings": {"floor": {**wrong}}}),
    ):
        with pytest.raises(InputError) as caught:
            Scene.read({"particles": [[0, 0, 0]], **scene})
        assert str(caught.value) == f"{place}/kinetic_friction: {said}"
    running = Simulation(Scene.read({"particles": [[0, 0, 0]], "forces": [{"kind": "floor", "name": "ground"}]}))
    with pytest.raises(InputError, match=r"/forces/ground/kinetic_friction: 0[.]7 given"):
        running.patch({"forces": {"ground": {"kinetic_friction": 0.7}}})
    running.patch({"forces": {"ground": {"static_friction": 0.2}}})
    smooth = running.system.scene
    assert smooth.forces[0].kinetic_friction == 0.2 and Scene.read(smooth.canonical).digest == smooth.digest
    running.patch({"forces": {"ground": {"static_friction": 0.4}}})
    assert running.system.scene.forces[0].kinetic_friction == 0.4


def test_a_hanging_heavy_chain_swings_at_laguerre_frequencies() -> None:
    """n = 10 masses: omega^2 = (g/a) x zeros of L_n: 1.173855, 2.700842, 4.252462 times sqrt(g/L), from the tangent.

    Springs 1e9 times stiffer than the weights keep the chain inextensible to 1e-8; modes from the stiffness blocks.
    """
    n, weight = 10, 1.0
    x = np.column_stack([np.zeros((n + 1, 2)), -np.arange(n + 1.0)])
    k = 1e9
    tension = weight * np.arange(n, 0.0, -1.0)
    system = compile(
        Scene.read(
            {
                "particles": x,
                "forces": [
                    {
                        "kind": "springs", "particles": np.column_stack([np.arange(n), np.arange(1, n + 1)]),
                        "stiffness": k, "rest_length": 1.0 - tension / k,
                    },
                    {"kind": "unary", "particles": np.arange(1, n + 1), "vector": [0, 0, -weight]},
                ],
                "anchors": [{"particles": [0]}],
            }
        )
    )  # fmt: skip
    state = system.start()
    assert np.abs(system.evaluate(state)[0][1:]).max() < 1e-6
    (group,) = (g for g in system.groups if g.cls.arity == 2)
    tangent = np.zeros((3 * (n + 1), 3 * (n + 1)))
    for pair, block in zip(group.block.indices, system.stiffness_blocks(group, state, group.block.memory), strict=True):
        degrees = (3 * pair[:, None] + np.arange(3)).ravel()
        tangent[np.ix_(degrees, degrees)] += block
    sideways = tangent[3::3, 3::3]
    found = np.sqrt(np.linalg.eigvalsh(sideways)[:3] * n)  # unit masses, spacing 1: g = 1, L = n
    assert found == pytest.approx([1.173855, 2.700842, 4.252462], abs=2e-6)
    zeros = np.polynomial.laguerre.lagroots([0.0] * n + [1.0])
    assert np.linalg.eigvalsh(sideways) == pytest.approx(np.sort(zeros), rel=1e-6)
