"""Time steps that hold: limits by scheme, in motions of any size, and those that are chosen."""

from __future__ import annotations

import re
from io import BytesIO
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hookean import Scene, Simulation, Status, relax
from hookean.discretize import corners, edges, grid, naked_vertices
from hookean.running.in_motion import in_motion
from hookean.solvers import solver
from hookean.stability.time_steps import stable_time_step, time_step_of_all_shapes
from hookean.system.system import compile
from serving import SOAK

from ..laws.scenes import random_scene

COUNT = 500 if SOAK else 15
CUBE = 2.0 ** (1.0 / 3.0)
PARTS = {"verlet": (1.0,), "yoshida": (1.0 / (2.0 - CUBE), -CUBE / (2.0 - CUBE), 1.0 / (2.0 - CUBE))}


def growth(scheme: str, stiffness: float, damping: float = 0.0, drag: float = 0.0) -> float:
    """Spectral radius of one step of length 1 of x'' = -k x - (c + d) x', as the schemes are defined: velocity Verlet
    with a predicted velocity in c and the mean of before and after in d, with Yoshida's three parts (1990)."""
    whole = np.eye(2)
    for h in PARTS[scheme]:
        start = np.array([-stiffness, -damping - drag])  # of the acceleration, by x and v
        x, v = np.array([1.0, 0.0]), np.array([0.0, 1.0])
        half = v + 0.5 * h * start
        there = x + h * half
        end = -stiffness * there - damping * (half + 0.5 * h * start)
        whole = np.array([there, (half + 0.5 * h * end) / (1.0 + 0.5 * h * drag)]) @ whole
    return float(np.abs(np.linalg.eigvals(whole)).max())


def trace(scheme: str) -> np.polynomial.Polynomial:
    """Trace of an undamped step's matrix, as a polynomial in (omega dt)^2: stable while it is within [-2, 2]."""
    z, one = np.polynomial.Polynomial([0.0, 1.0]), np.polynomial.Polynomial([1.0])
    m = [[one, 0 * one], [0 * one, one]]
    for h in PARTS[scheme]:
        # x' = (1 - h^2 z/2) x + h v;  v' = -h z (1 - h^2 z/4) x + (1 - h^2 z/2) v, times in units of dt
        part = [[one - h * h / 2 * z, h * one], [-h * z * (one - h * h / 4 * z), one - h * h / 2 * z]]
        m = [[part[i][0] * m[0][j] + part[i][1] * m[1][j] for j in (0, 1)] for i in (0, 1)]
    return m[0][0] + m[1][1]


def exact_reach(scheme: str) -> float:
    """The longest undamped step as a part of 2 / omega, from the first crossing of |trace| = 2 beyond 0."""
    roots = np.concatenate([(trace(scheme) - 2.0).roots(), (trace(scheme) + 2.0).roots()])
    real = roots.real[(np.abs(roots.imag) < 1e-6) & (roots.real > 1e-3)]
    beyond = [z for z in sorted(real) if abs(trace(scheme)(z * 1.001)) > 2.0]
    return float(np.sqrt(beyond[0])) / 2.0


def test_the_limit_of_each_scheme_is_the_root_of_its_stability_polynomial():
    """Verlet: omega dt = 2; Yoshida: 1.5734, 0.7867 of that. What is used is the root, rounded down to four digits."""
    for scheme in PARTS:
        reach, used = exact_reach(scheme), solver(scheme).limit.reach
        assert reach - 1e-4 < used <= reach * (1 + 1e-9), scheme
    assert exact_reach("yoshida") == pytest.approx(0.787, abs=5e-4)


rates = st.floats(0.0, 1.0)


@pytest.mark.parametrize("scheme", PARTS)
@given(shares=st.tuples(rates, rates, rates))
def test_damped_steps_within_the_limit_never_grow(scheme: str, shares: tuple[float, float, float]):
    """At a step that the limit allows for the highest rates, no vibration up to them grows; 1e-9 is rounding."""
    k, c, d = 4.0 * shares[0], 2.0 * shares[1], 2.0 * shares[2]
    step = min(solver(scheme).limit.step(k, c, d), 1e3)
    for part in (1.0, 0.7, 0.3, 0.01):
        for damped in (0.0, 1.0):
            grown = growth(scheme, part * step**2 * k, damped * step * c, damped * step * d)
            assert grown <= 1.0 + 1e-6


def spring(scheme: str, step: float) -> Scene:
    """A mass of 2 on a spring of 800: omega = 20, let go 0.1 from rest along it."""
    return Scene(
        particles=[[0, 0, 0], [1, 0, 0]],
        velocities=[[0, 0, 0], [0.5, 0, 0]],
        masses=2.0,
        forces=[{"kind": "springs", "particles": [[0, 1]], "stiffness": 800, "damping": 0}],
        anchors=[{"particles": [0]}],
        settings={"drag": 0, "solver": scheme, "time_step": step},
    )


@pytest.mark.parametrize("scheme", PARTS)
def test_each_scheme_is_warned_of_by_its_own_limit(scheme: str):
    """Just below the exact root 2,000 steps stay bounded without a word, as large as they swing there; just above it a
    warning comes before the motion grows, with a step that holds."""
    limit = exact_reach(scheme) * 2.0 / 20.0
    below = Simulation(spring(scheme, 0.995 * limit))
    assert below.step(100) is Status.RUNNING and not below.system.report.warnings
    assert np.abs(below.state.x[1, 0] - 1.0) < 1.0
    above = Simulation(spring(scheme, 1.005 * limit))
    (warning,) = above.system.report.warnings
    told = float(re.findall(r"most motions, (\S+) s in small", warning)[0])
    assert 0.999 * limit < told <= limit
    assert above.step(100) is Status.DIVERGED and np.abs(above.state.x[1, 0] - 1.0) < 10.0


@pytest.mark.parametrize("scheme", PARTS)
def test_the_step_chosen_for_a_scheme_is_within_its_limit(scheme: str):
    """The spring of 800 made 80,000: the usual 0.01 is too long for both, and the one that is chosen is not."""
    spec = spring(scheme, 1.0).model_dump(exclude={"settings"})
    spec["forces"][0]["stiffness"] = 80_000.0
    scene, said = in_motion(Scene(**spec, settings={"drag": 0, "solver": scheme}))
    assert said and scene.settings.time_step <= exact_reach(scheme) * 2.0 / 200.0
    running = Simulation(scene)
    assert running.step(50) is Status.RUNNING and not running.system.report.warnings


def net(factor: float, held: str, load: float, **settings: Any) -> dict[str, Any]:
    """A square net of 10 x 10 cells of springs stretched to 1 / factor of their rest lengths, plucked in its middle."""
    mesh = grid(np.arange(11) * 0.5, np.arange(11) * 0.5)
    velocities = np.zeros_like(mesh.vertices)
    velocities[60] = [3.0, 0.9, 3.0]
    return {
        "particles": mesh.vertices, "velocities": velocities,
        "forces": [
            {"kind": "springs", "particles": edges(mesh), "stiffness": 1000.0, "damping": 0.0, "rest_factor": factor},
            {"kind": "unary", "particles": np.arange(121), "vector": [0.0, 0.0, load]},
        ],
        "anchors": [{"name": "held", "particles": naked_vertices(mesh) if held == "rim" else corners(mesh)}],
        "settings": {"drag": 0.0, **settings},
    }  # fmt: skip


def energy(spec: dict[str, Any], simulation: Simulation) -> float:
    """Of springs and loads, k (l - L0)^2 / 2 - F x, and of motion, m v^2 / 2 with masses 1 [N m]."""
    x, v = simulation.state.x, simulation.state.v
    a, b = spec["forces"][0]["particles"].T
    rest = spec["forces"][0]["rest_factor"] * np.linalg.norm(spec["particles"][b] - spec["particles"][a], axis=1)
    stretch = np.linalg.norm(x[b] - x[a], axis=1) - rest
    return float(500.0 * (stretch**2).sum() - x[:, 2].sum() * spec["forces"][1]["vector"][2] + 0.5 * (v**2).sum())


def omega(spec: dict[str, Any], x: np.ndarray) -> float:
    """Highest circular frequency of a net in a shape, from the textbook's tangent of springs, dense; masses 1."""
    (a, b), start = spec["forces"][0]["particles"].T, spec["particles"]
    rest = spec["forces"][0]["rest_factor"] * np.linalg.norm(start[b] - start[a], axis=1)
    along = x[b] - x[a]
    length = np.linalg.norm(along, axis=1)
    n = along / length[:, None]
    blocks = 1000.0 * (np.eye(3) * (1 - rest / length)[:, None, None]
                       + n[:, :, None] * n[:, None, :] * (rest / length)[:, None, None])  # fmt: skip
    whole = np.zeros((len(x), 3, len(x), 3))
    for i, j, block in zip(a, b, blocks, strict=True):
        whole[i, :, i] += block
        whole[j, :, j] += block
        whole[i, :, j] -= block
        whole[j, :, i] -= block
    free = np.setdiff1d(np.arange(len(x)), spec["anchors"][0]["particles"])
    tangent = whole[free][:, :, free].reshape(3 * len(free), -1)
    return float(np.sqrt(np.linalg.eigvalsh(tangent)[-1]))


@pytest.mark.soak
@pytest.mark.parametrize("held", ["rim", "corners"])
def test_the_bound_of_all_shapes_is_below_the_limit_of_each(held: str):
    """2 / omega of crumpled and stretched shapes of a net never falls below the bound, and comes near it."""
    spec, rng = net(0.7, held, -1.0), np.random.default_rng(5)
    system = compile(Scene.read(spec))
    bound = time_step_of_all_shapes(system, system.start())
    found = [2.0 / omega(spec, spec["particles"] * size + rng.normal(size=(121, 3)) * bumps)
             for size, bumps in ((1.0, 0.0), (1.0, 0.3), (0.5, 0.2), (3.0, 0.1), (20.0, 0.0))]  # fmt: skip
    assert bound <= min(found) * (1 + 1e-6)
    assert min(found) < 1.05 * bound  # it is not just small
    start = system.start()
    assert stable_time_step(system, start) == pytest.approx(found[0], rel=1e-6)


def plucked(scheme: str, factor: float, load: float, part: float, **settings: Any) -> dict[str, Any]:
    """A net on its corners, with `part` of the exact limit of small vibrations about its start as its step."""
    spec = net(factor, "corners", load)
    limit = exact_reach(scheme) * 2.0 / omega(spec, spec["particles"])
    return net(factor, "corners", load, solver=scheme, time_step=part * limit, **settings)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("scheme", "factor", "load"), [("verlet", 0.7, -1.0), ("verlet", 0.9, -10.0), ("yoshida", 0.9, -10.0)]
)
def test_a_prestressed_net_at_0_85_of_its_limit_ends_before_it_explodes(scheme: str, factor: float, load: float):
    """Small vibrations about its start are stable with 0.85 of their limit, the motion that follows is not: nothing
    adds to its energy, yet it grows hundredfold. The run ends while the total is within what motion and forces
    exchange, and with a step at which the same motion keeps its energy to a tenth of that."""
    spec = plucked(scheme, factor, load, 0.85)
    running = Simulation(Scene.read(spec))
    started = energy(spec, running)
    assert not running.system.report.warnings
    assert running.step(400) is Status.DIVERGED and "/settings/time_step" in running.message
    told = float(re.findall(r"Steps of (\S+) s were stable for", running.message)[0])
    assert told < spec["settings"]["time_step"]
    holding = Simulation(Scene.read({**spec, "settings": {**spec["settings"], "time_step": told}}))
    exchanged = 0.0
    for _ in range(100):
        assert holding.step(2) is Status.RUNNING
        exchanged = max(exchanged, 0.5 * float((holding.state.v**2).sum()))
        assert energy(spec, holding) - started < 0.1 * exchanged
    assert energy(spec, running) - started < 2.0 * exchanged
    ended = relax(Scene.read(spec))  # the other loop around solvers
    assert ended.status is Status.DIVERGED and " s were stable for " in ended.message


@pytest.mark.slow
@pytest.mark.parametrize("scheme", PARTS)
def test_steps_that_hold_are_not_ended(scheme: str):
    """Nets held all around stay taut: 0.85 of the limit holds for 2,000 steps. So does 0.7 of it where anchors are led
    and where patches move them, though both add many times the energy of the pluck, 9.4 N m."""
    spec = net(0.7, "rim", -1.0)
    limit = exact_reach(scheme) * 2.0 / omega(spec, spec["particles"])
    scene = Scene.read({**spec, "settings": {"drag": 0.0, "solver": scheme, "time_step": 0.85 * limit}})
    assert Simulation(scene).step(100) is Status.RUNNING
    scene = Scene.read({**spec, "settings": {"drag": 0.0, "solver": scheme, "time_step": 0.7 * limit}})
    raised = {"anchors": [{"anchor": "held", "times": [0.0, 1.0], "shifts": [[0, 0, 0], [0, 0, 5.0]]}]}
    led, patched = Simulation(scene, raised), Simulation(scene)
    started = energy(spec, led)
    assert led.step(100) is Status.RUNNING and energy(spec, led) - started > 10 * 9.4
    for shift in (0.3, 0.6, 0.9):
        patched.patch({"move": [{"anchor": "held", "shift": [0.0, 0.0, shift]}]})
        assert patched.step(20) is Status.RUNNING
    assert energy(spec, patched) - started > 10 * 9.4


@pytest.mark.slow
def test_a_run_that_is_resumed_ends_where_it_would_have_ended():
    """What is known of its energy is saved with it: the same iteration, the same bits."""
    straight = Simulation(Scene.read(plucked("verlet", 0.9, -10.0, 0.85)))
    straight.step()
    file = BytesIO()
    straight.save(file)
    file.seek(0)
    resumed = Simulation.load(file)
    assert straight.step(50) is resumed.step(50) is Status.DIVERGED
    assert straight.state.iteration == resumed.state.iteration
    assert straight.state.x.tobytes() == resumed.state.x.tobytes()


def test_who_chose_the_step_decides_whether_it_is_divided():
    """Divided unless it is given, or given with `divide_steps`; a canonical form keeps that, a patch of the step ends
    it."""
    spec = net(0.7, "rim", -1.0)
    chosen = Scene.read(spec)
    assert chosen.settings.divide_steps and Scene.read(chosen.canonical).settings.divide_steps
    given_step = Scene.read({**spec, "settings": {"time_step": 0.01}})
    assert not given_step.settings.divide_steps and not Scene.read(given_step.canonical).settings.divide_steps
    assert Scene.read({**spec, "settings": {"time_step": 0.01, "divide_steps": True}}).settings.divide_steps
    running = Simulation(chosen)
    running.patch({"settings": {"drag": 2.0}})
    assert running.scene.settings.divide_steps
    assert not chosen.settings.model_copy(update={"time_step": 0.02}).divide_steps
    running.patch({"settings": {"time_step": 0.001}})
    assert not running.scene.settings.divide_steps


def test_divided_steps_are_so_many_shorter_ones():
    """The usual step of a net of 100,000 N/m, and the parts of it given as steps: the same bits and the same time."""
    spec = net(0.7, "rim", -1.0)
    spec["forces"][0]["stiffness"] = 1e5
    divided = Simulation(Scene.read(spec))
    divided.step(5)
    parts = int(divided.state.scratch["parts"][0])
    assert parts > 1
    settings = {"drag": 0.0, "time_step": 0.01 / parts, "sub_iterations": 20 * parts}
    short = Simulation(Scene.read({**spec, "settings": settings}))
    short.step(5)
    assert divided.state.x.tobytes() == short.state.x.tobytes()
    assert divided.state.time == pytest.approx(1.0, rel=1e-12) and divided.state.iteration == 100


def folding() -> Scene:
    """A shell that folds until it is stiffer than at its start."""
    spec = random_scene(278)
    spec["settings"] = {"drag": 0.0, "solver": "verlet"}
    return in_motion(Scene.read(spec))[0]


@pytest.mark.slow
def test_steps_that_were_too_long_are_taken_again_in_more_parts():
    """A frame is as long as ever, whatever was taken again; again and resumed from a file, the bits are the same."""
    runs, file = [Simulation(folding()), Simulation(folding())], BytesIO()
    for running in runs:
        assert running.step(3) is Status.RUNNING
    runs[0].save(file)
    file.seek(0)
    runs.append(Simulation.load(file))
    for running in runs:
        assert running.step(27) is Status.RUNNING
        settings = running.scene.settings
        assert running.state.scratch["parts"][0] > 1
        assert running.state.iteration == 30 * settings.sub_iterations
        assert running.state.time == pytest.approx(running.state.iteration * settings.time_step, rel=1e-12)
        assert running.state.x.tobytes() == runs[0].state.x.tobytes()


def in_its_own_steps(seed: int) -> dict[str, Any]:
    """A random scene with a solver of physical time and some drag, and no step given."""
    spec, rng = random_scene(seed), np.random.default_rng([12, seed])
    floor = spec["settings"].get("floor")
    scheme = "verlet" if floor else str(rng.choice(["verlet", "yoshida"]))
    return {**spec, "settings": {"floor": floor, "solver": scheme, "drag": float(rng.choice([0.0, 0.1, 1.0]))}}


@pytest.mark.soak
def test_steps_that_are_chosen_never_diverge():
    """Forty frames of each random scene, as it is and made fit to move: none diverges, and none is warned of."""
    for seed in range(COUNT):
        scene = Scene.read(in_its_own_steps(seed))
        for made in (scene, in_motion(scene)[0]):
            running = Simulation(made)
            assert running.step(40) is not Status.DIVERGED, seed
            assert not any("time_step" in warning for warning in running.result().report.warnings), seed
