"""Steps of a motion keep its energy, or the run reports what they added; a step that a message names was tried.

The oracle is the textbook's: springs k (l - L0)^2 / 2, loads -F x and motion m v^2 / 2, summed here.
"""

from __future__ import annotations

import re
from io import BytesIO
from typing import Any

import numpy as np
import pytest

from hookean import Scene, Simulation, Status
from hookean.discretize import edges, grid
from hookean.stability import time_steps
from hookean.stability.time_steps import MOST_PARTS, most_parts
from serving import SOAK

Spec = dict[str, Any]


def chain(seed: int, factor: float, solver: str, **settings: Any) -> Spec:
    """Twelve particles of 0.03 kg on undamped springs of 8e5 N/m, held at both ends, bent at random: with a rest
    length of twice the start they push through one another."""
    rng = np.random.default_rng(seed)
    x = np.zeros((12, 3))
    x[:, 0] = np.arange(12) * 0.6
    x += rng.normal(size=x.shape) * 0.06
    pairs = np.array([[i, i + 1] for i in range(11)])
    return {
        "particles": x,
        "masses": 0.03,
        "forces": [
            {"kind": "springs", "particles": pairs, "stiffness": 8e5, "damping": 0.0, "rest_factor": factor},
            {"kind": "unary", "particles": np.arange(12), "vector": [3.0, -5.0, 1.0]},
        ],
        "anchors": [{"particles": [0, 11]}],
        "settings": {"drag": 0.0, "solver": solver, "sub_iterations": 6, **settings},
    }


def energies(spec: Spec, simulation: Simulation) -> tuple[float, float]:
    """Of springs and loads, and of motion [N m]."""
    x, v = simulation.state.x, simulation.state.v
    springs, start = spec["forces"][0], np.asarray(spec["particles"])
    a, b = np.asarray(springs["particles"]).T
    rest = springs["rest_factor"] * np.linalg.norm(start[b] - start[a], axis=1)
    still = 0.5 * springs["stiffness"] * ((np.linalg.norm(x[b] - x[a], axis=1) - rest) ** 2).sum()
    loads = spec["forces"][-1]
    still -= float((x[np.asarray(loads["particles"])] @ np.asarray(loads["vector"])).sum())
    return float(still), float(0.5 * spec["masses"] * (v**2).sum())


def gain(spec: Spec, simulation: Simulation, frames: int) -> float:
    """What the total gained at most in so many frames, by what the motion exchanged: start less least of forces."""
    start = sum(energies(spec, simulation))
    lowest, most = energies(spec, simulation)[0], 0.0
    for _ in range(frames):
        assert simulation.step() is Status.RUNNING, simulation.message
        still, motion = energies(spec, simulation)
        lowest, most = min(lowest, still), max(most, still + motion - start)
    return most / (start - lowest)


@pytest.mark.slow
@pytest.mark.parametrize("solver", ["verlet", "yoshida"])
@pytest.mark.parametrize("seed", range(3 if SOAK else 1))
def test_springs_that_pass_through_length_zero_gain_no_energy_unseen(solver: str, seed: int):
    """3,600 steps without damping. Their direction turns round within one step, and steps that are half of what small
    vibrations allow heat the chain thousandfold. With energies watched each division lets the total gain a third by
    its swing and a quarter more, and three divisions do; a gain of more than 0.6 is in the message of the frame and in
    the warnings."""
    spec = chain(seed, 2.0, solver)
    simulation = Simulation(Scene.read(spec))
    gained = gain(spec, simulation, 600)
    assert gained < 3 * (1.0 / 3.0 + 0.25)
    if gained > 0.6:
        assert "steps have added" in simulation.message
        assert any("steps have added" in warning for warning in simulation.result().report.warnings)


def test_a_given_step_that_heats_slowly_is_reported_and_ends_the_run():
    """The same with 0.8 of the limit of small vibrations, 2 / omega <= sqrt(m / k): the message reports a gain before
    the run ends, and the step that is named keeps the energy of the same motion to what it exchanges."""
    step = 0.8 * np.sqrt(0.03 / 8e5)
    spec = chain(0, 2.0, "verlet", time_step=step, sub_iterations=25)
    simulation = Simulation(Scene.read(spec))
    said = []
    while simulation.step() is Status.RUNNING and len(said) < 2000:
        said.append(simulation.message)
    assert simulation.status is Status.DIVERGED
    assert any("steps have added" in message for message in said)
    found = re.search(r"Steps of (\S+) s were stable for (\S+) s of the same motion", simulation.message)
    assert found is not None
    named, lasted = float(found[1]), float(found[2])
    assert named < step and lasted >= simulation.state.time
    again = chain(0, 2.0, "verlet", time_step=named, sub_iterations=25)
    assert gain(again, Simulation(Scene.read(again)), int(lasted / (25 * named))) < 2.0 / (1.0 - 0.25)


def random_motion(seed: int) -> Spec:
    """Chains and webs of springs, some with a load, some held, with a step that is often too long."""
    rng = np.random.default_rng([seed, 7])
    n = int(rng.integers(4, 10))
    x = rng.uniform(0.0, 5.0, (n, 3))
    pairs = [[i, j] for i in range(n) for j in range(i) if i == j + 1 or rng.random() < 0.3]
    stiffness = 10.0 ** rng.uniform(1.0, 6.0)
    return {
        "particles": x,
        "masses": float(10.0 ** rng.uniform(-2.0, 1.0)),
        "forces": [
            {"kind": "springs", "particles": pairs, "stiffness": stiffness,
             "damping": float(rng.choice([0.0, 0.0, 10.0])), "rest_factor": float(rng.choice([0.3, 0.9, 1.2, 2.0]))},
            {"kind": "unary", "particles": [n - 1], "vector": (rng.normal(size=3) * stiffness * 0.1).tolist()},
        ],
        "anchors": [{"particles": [0]}] if rng.random() < 0.7 else [],
        "settings": {"drag": 0.0, "sub_iterations": 5, "solver": str(rng.choice(["verlet", "yoshida"])),
                     "time_step": float(10.0 ** rng.uniform(-4.0, -1.0))},
    }  # fmt: skip


@pytest.mark.slow
def test_every_step_that_is_named_holds_in_the_same_motion():
    """Four random motions, in soak forty, whose step is often too long: each step that a diverged run names, taken
    from the start for the time that the message has, does not diverge."""
    named = 0
    runs = 40 if SOAK else 4
    for seed in range(runs):
        spec = random_motion(seed)
        simulation = Simulation(Scene.read(spec))
        if simulation.step(40) is not Status.DIVERGED:
            continue
        found = re.search(r"Steps of (\S+) s were stable for (\S+) s", simulation.message)
        assert found is not None, (seed, simulation.message)
        step, lasted = float(found[1]), float(found[2])
        settings = {**spec["settings"], "time_step": step, "sub_iterations": 50}
        again = Simulation(Scene.read({**spec, "settings": settings}))
        assert again.step(int(lasted / step / 50)) is not Status.DIVERGED, (seed, again.message)
        named += 1
    assert named > runs / 4  # it is not that none diverged


def heavy_and_light(**settings: Any) -> Spec:
    """Masses of 1e-4 to 60 kg on springs with a damping of 100 N s/m: steps of 4e-7 s hold, 26,000 in 0.01 s."""
    masses = 10.0 ** np.linspace(-4.0, 1.78, 9)
    pairs = [[i, i + 1] for i in range(8)]
    return {
        "particles": [[i * 0.5, 0.1 * (i % 2), 0.0] for i in range(9)],
        "masses": masses,
        "forces": [
            {"kind": "springs", "particles": pairs, "stiffness": 1e5, "damping": 100.0},
            {"kind": "unary", "particles": list(range(9)), "vector": [0.0, 0.0, -100.0]},
        ],
        "anchors": [{"particles": [8]}],
        "settings": {"sub_iterations": 2, **settings},
    }


def test_a_step_that_needs_too_many_parts_covers_less_time():
    """The run goes on, each frame has the time that was covered, and names by how much motion is slower."""
    scene = Scene.read(heavy_and_light())
    simulation = Simulation(scene)
    assert simulation.step(5) is Status.RUNNING
    parts = int(simulation.state.scratch["parts"][0])
    assert parts > MOST_PARTS
    asked, frame = simulation.state.iteration * 0.01, simulation.frame()
    assert frame.time == pytest.approx(asked * MOST_PARTS / parts, rel=1e-12)
    found = re.search(r"motion is (\S+) times slower than asked for", frame.message)
    assert found is not None and float(found[1]) == pytest.approx(asked / frame.time, rel=5e-3)
    assert any("times slower" in warning for warning in simulation.system.report.warnings)
    # so many steps that hold, given: the same bits
    step = 0.01 / parts
    given = heavy_and_light(time_step=step, sub_iterations=2 * MOST_PARTS)
    plain = Simulation(Scene.read(given))
    assert plain.step(5) is Status.RUNNING
    assert plain.state.x.tobytes() == simulation.state.x.tobytes()
    assert plain.state.time == pytest.approx(simulation.state.time, rel=1e-9)


def test_slow_motion_is_the_same_in_pieces_and_resumed():
    runs = [Simulation(Scene.read(heavy_and_light())) for _ in range(2)]
    for running in runs:
        running.step(2)
    file = BytesIO()
    runs[1].save(file)
    file.seek(0)
    runs[1] = Simulation.load(file)
    assert runs[1].result().report.warnings == runs[0].result().report.warnings
    for _ in range(4):
        runs[0].play(1)
    runs[1].play(4)
    assert runs[0].state.time == runs[1].state.time
    assert runs[0].state.x.tobytes() == runs[1].state.x.tobytes()


def test_frames_stay_short_whatever_a_patch_makes_stiff():
    """A spring made 1e10 times stiffer while it moves: a frame takes no more parts than before it, 20 x 10,000 at most,
    and the message has how much slower it goes. Made soft again, all of a frame is covered."""
    spec = chain(0, 0.9, "verlet", sub_iterations=20)
    spec["forces"][0]["stiffness"] = 80.0
    simulation = Simulation(Scene.read(spec))
    simulation.step()
    before = simulation.state.time
    assert before == pytest.approx(0.2, rel=1e-12)
    simulation.patch({"forces": {"0": {"stiffness": 8e11}}})
    assert simulation.step() is Status.RUNNING
    covered = simulation.state.time - before
    parts = int(simulation.state.scratch["parts"][0])
    taken = covered / (0.01 / parts)
    assert taken == pytest.approx(20 * most_parts(simulation.system), rel=1e-9) and taken <= 20 * MOST_PARTS
    assert "times slower than asked for" in simulation.message
    simulation.patch({"forces": {"0": {"stiffness": 80.0}}})
    at = simulation.state.time
    simulation.step()
    assert simulation.state.time - at == pytest.approx(0.2, rel=1e-9)
    assert not any("slower" in warning for warning in simulation.system.report.warnings)


@pytest.mark.parametrize("settings", [{}, {"time_step": 0.03}])
def test_a_particle_that_nothing_holds_is_named_and_no_step_is_blamed(settings: Spec):
    """Beside a net that is held, a loaded particle without a spring: 100 N on 1 kg for 125 s are 8e5 m, 1e5 sizes."""
    scene = Scene(
        particles=[[0, 0, 0], [1, 0, 0], [2, 0, 0], [5, 5, 5]],
        forces=[
            {"kind": "springs", "particles": [[0, 1], [1, 2]], "stiffness": 1e3},
            {"kind": "unary", "particles": [1, 3], "vector": [0, 0, -100]},
        ],
        anchors=[{"particles": [0, 2]}],
        settings={"drag": 0, "solver": "verlet", **settings},
    )
    simulation = Simulation(scene)
    while simulation.step() is Status.RUNNING:
        assert simulation.state.time < 200.0
    assert simulation.status is Status.DIVERGED
    assert "Nothing supports particle 3" in simulation.message and "time_step" not in simulation.message


@pytest.mark.soak
def test_a_shell_that_collapses_does_not_diverge_by_default():
    """A plate on its corners under springs of 0.3 of their length, so strong that its triangles become needles: their
    forces have no bound. What springs and motion have stays within three times the energy of the start (it grew ten
    thousandfold), as a shell has no negative energy."""
    rng = np.random.default_rng(3)
    plate = grid(2.5 * np.arange(4), 2.5 * np.arange(4))
    x = plate.vertices + rng.normal(size=(16, 3)) * 0.25
    spec: Spec = {
        "particles": x,
        "masses": 0.011,
        "meshes": {"plate": {"vertices": x, "faces": plate.faces}},
        "forces": [
            {"kind": "springs", "particles": edges(plate), "stiffness": 16000.0, "damping": 0.0, "rest_factor": 0.3},
            {"kind": "shell", "mesh": "plate", "strength": 3.3e5},
            {"kind": "unary", "particles": [5], "vector": [1.0, 2.0, -3.0]},
        ],
        "anchors": [{"particles": [0, 3, 12, 15]}],
        "settings": {"drag": 0.0, "sub_iterations": 5},
    }
    simulation = Simulation(Scene.read(spec))
    start = sum(energies(spec, simulation))
    for _ in range(8):
        assert simulation.step() is Status.RUNNING, simulation.message
        assert sum(energies(spec, simulation)) < 3.0 * start


def test_a_gas_whose_steps_were_divided_is_not_at_rest(monkeypatch: pytest.MonkeyPatch) -> None:
    """Sixty undamped spheres at 10 m/s in a closed box. The first steps are made too long for their contacts: the run
    goes back and divides them, and the forces of the burst are no measure of rest. The kinetic energy is never far
    below that of the start, the sum of m v^2 / 2, and what the steps have added is reported (a tenth is)."""
    monkeypatch.setattr(time_steps, "contact_step", lambda *_: np.inf)
    rng, axis = np.random.default_rng(3), np.linspace(-0.8, 0.8, 4)
    x = np.array([[a, b, c] for a in axis for b in axis for c in axis])[:60]
    box = np.array([[a, b, c] for a in (-1.0, 1.0) for b in (-1.0, 1.0) for c in (-1.0, 1.0)])
    faces = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    crowd = {"particles": list(range(60)), "radius": 0.1, "strength": 1e6}
    walls = {"kind": "collide_solid", "vertices": box, "faces": faces, "inside": True, **crowd}
    velocities = 10.0 * rng.normal(size=x.shape)
    simulation = Simulation(
        Scene.read(
            {
                "particles": x,
                "velocities": velocities,
                "forces": [{"kind": "collide", **crowd}, walls],
                "settings": {"solver": "verlet", "drag": 0.0, "sub_iterations": 5},
            }
        )
    )
    start = 0.5 * float((velocities**2).sum())
    for _ in range(3):
        assert simulation.step() is Status.RUNNING, simulation.message
        moving = 0.5 * float((simulation.state.v**2).sum())
        assert moving > 0.5 * start
    total = simulation.result().energy["total"]
    assert (total > 1.1 * start) <= ("to the energy of this motion" in simulation.message)


@pytest.mark.parametrize("part", [0.3, 0.9])
@pytest.mark.parametrize("speed", [1.0, 10.0, 100.0, 1000.0])
def test_spheres_do_not_pass_through_what_can_stop_them(speed: float, part: float) -> None:
    """Two of 1 kg that fly at each other, apart at first; to pass they need k (2 r)^2 / 2, of which they have a part.
    Steps of 0.01 s would move them past each other at 100 m/s. They come back, and gain or lose at most a quarter of
    their energy: one contact at omega dt <= 1 begins and ends within a step, (omega dt)^2 / 4 of it."""
    radius = 0.1
    stiffness = 2.0 * speed**2 / part / (2.0 * radius) ** 2  # k (2 r)^2 / 2 = 2 (m v^2 / 2) / part
    simulation = Simulation(
        Scene.read(
            {
                "particles": [[-1, 0, 0], [1, 0, 0]],
                "velocities": [[speed, 0, 0], [-speed, 0, 0]],
                "forces": [{"kind": "collide", "particles": [0, 1], "radius": radius, "strength": stiffness}],
                "settings": {"solver": "verlet", "drag": 0.0, "sub_iterations": 1},
            }
        )
    )
    while simulation.state.time < 4.0 / speed:
        assert simulation.step() is Status.RUNNING, simulation.message
    x, v = simulation.state.x, simulation.state.v
    assert x[0, 0] < x[1, 0] and v[0, 0] < 0.0 < v[1, 0]
    assert 0.5 * float((v**2).sum()) == pytest.approx(speed**2, rel=0.25)


@pytest.mark.parametrize(("step", "warned"), [(0.01, True), (0.001, False)])
def test_a_given_step_that_is_too_long_for_a_contact_is_warned_of_before_it(step: float, warned: bool) -> None:
    """A free pair with a contact k = 1e6 N/m between 1 kg and 1 kg is stable up to 2 / sqrt(2 k / m) = 0.0014 s; the
    steps that the warning names are below that."""
    simulation = Simulation(
        Scene.read(
            {
                "particles": [[-1, 0, 0], [1, 0, 0]],
                "velocities": [[20, 0, 0], [-20, 0, 0]],
                "forces": [{"kind": "collide", "particles": [0, 1], "radius": 0.1, "strength": 1e6}],
                "settings": {"solver": "verlet", "time_step": step},
            }
        )
    )
    warnings = simulation.result().report.warnings
    assert len(warnings) == warned
    for warning in warnings:
        assert "is too large for this mass and the stiffness of /forces/0, collide" in warning
        named = [
            float(number) for number in re.findall(r"([\d.e-]+) s are stable in most motions, ([\d.e-]+) s", warning)[0]
        ]
        assert 0.0 < named[0] < named[1] <= 2.0 / np.sqrt(2e6)
