"""Scripts: anchors led along paths and forces through values, exactly, smoothly and repeatably."""

from __future__ import annotations

import json

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hookean import InputError, Scene, Script, Simulation, Status, relax, simulate
from hookean.running.script import between
from hookean.scene.scene import Settings
from hookean.solvers import verlet
from samples import cable

RAISED = {"anchors": [{"anchor": "ends", "times": [0, 1, 2], "shifts": [[0, 0, 0], [0, 0, 2], [0, 0, 0]]}]}


def test_an_anchor_is_on_its_path_at_every_frame_and_stays_at_its_end():
    """Linear between the times, held after the last: z = 2t, 2(2 - t), 0; the difference is rounding of the clock."""
    for frame in simulate(cable(), 14, script=RAISED):
        t = frame.time
        assert frame.particles[[0, 5], 2] == pytest.approx(max(min(2 * t, 4 - 2 * t), 0.0), abs=1e-14)
        assert frame.particles[5, 0] == 10.0


def test_a_script_in_dicts_json_and_toml_is_one_script():
    """The three forms are read to equal scripts; JSON of the model is read back."""
    toml = '[[anchors]]\nanchor = "ends"\ntimes = [0, 1, 2]\nshifts = [[0, 0, 0], [0, 0, 2], [0, 0, 0]]\n'
    script = Script.read(RAISED)
    assert script == Script.read(json.dumps(RAISED)) == Script.read(toml) == Script.read(script.model_dump_json())
    assert script.end == 2.0


def test_the_patch_of_a_time_moves_a_running_system_there():
    """`at` gives what `Simulation.patch` takes; none where nothing is led or nothing changed."""
    loads = {"force": "1", "column": "vector", "times": [1, 3], "values": [[0, 0, -20], [0, 0, -40]]}
    script = Script.read(RAISED | {"forces": [loads]})
    simulation = Simulation(cable())
    patch = script.at(1.5)
    assert patch is not None
    simulation.patch(patch)
    assert simulation.state.x[[0, 5], 2].tolist() == [1.0, 1.0]
    assert simulation.scene.forces[1].vector.tolist() == [0.0, 0.0, -25.0]
    assert script.at(9.0, since=3.0) is None
    assert script.at(2.5, since=2.0) is not None
    assert Script().at(1.0) is None


@given(st.lists(st.floats(-1e3, 1e3), min_size=2, max_size=6), st.floats(-1, 7))
def test_values_between_times_are_those_of_numpy_and_exact_at_the_times(values: list[float], time: float):
    """Against numpy's `interp` to rounding of two products, 4 units in the last place of the largest value."""
    times, rows = np.arange(len(values), dtype=float), np.array(values)
    scale = np.abs(rows).max()
    assert between(times, rows, time) == pytest.approx(np.interp(time, times, rows), abs=4 * np.spacing(scale))
    assert [float(between(times, rows, t)) for t in times] == values


def towed(damping: float, speed: float, solver: str = "verlet", time_step: float = 0.01) -> tuple[Scene, dict]:
    """A mass on a spring of 1 m towed along x by its anchor, without drag."""
    scene = Scene(
        particles=[[0, 0, 0], [1, 0, 0]],
        velocities=[[speed, 0, 0], [speed, 0, 0]],
        forces=[{"kind": "springs", "name": "rope", "particles": [[0, 1]], "stiffness": 100, "damping": damping}],
        anchors=[{"name": "tug", "particles": [1]}],
        settings={"drag": 0, "solver": solver, "time_step": time_step},
    )
    return scene, {"anchors": [{"anchor": "tug", "times": [0, 10], "shifts": [[0, 0, 0], [10 * speed, 0, 0]]}]}


@pytest.mark.parametrize("solver", ["verlet", "yoshida"])
def test_a_spring_towed_at_constant_speed_does_not_know_that_it_moves(solver: str):
    """Galilei: mass and anchor at one speed and the spring at its rest length stay so, whatever the damping along it.
    An anchor without a velocity would pull with damping * speed = 150 N. Tolerance: rounding of x = 15 over 300 steps,
    300 * spacing(15) = 5e-13, thrice."""
    scene, script = towed(50.0, 3.0, solver)
    for frame in simulate(scene, 15, script=script):
        assert frame.particles[:, 0] == pytest.approx([3 * frame.time, 1 + 3 * frame.time], abs=2e-12)


@pytest.mark.slow
def test_a_mass_picked_up_by_a_moving_anchor_swings_as_the_closed_form_says():
    """In the anchor's frame: a damped oscillator with start velocity -s, u = -(s/w_d) exp(-z w t) sin(w_d t).
    Verlet has order 2: halving the step leaves a quarter of the error; the next order is a part w dt = 0.02 of it."""
    speed, k, c, end = 2.0, 100.0, 4.0, 1.0
    omega = np.sqrt(k)
    zeta = c / (2 * omega)
    damped = omega * np.sqrt(1 - zeta**2)
    exact = speed * end - speed / damped * np.exp(-zeta * omega * end) * np.sin(damped * end)
    errors = []
    for step in (0.002, 0.001):
        scene, script = towed(c, speed, time_step=step)
        simulation = Simulation(scene.model_copy(update={"velocities": np.zeros((2, 3))}), script)
        simulation.iterate(round(end / step))
        errors.append(simulation.state.x[0, 0] - exact)
    assert errors[0] / errors[1] == pytest.approx(4.0, abs=4 * 0.02)


def test_a_load_led_through_values_is_the_one_the_time_says():
    """The spring of a hanging mass in slow loading carries the load of the time: quasi-static to speed of loading /
    omega^2 ... and exactly the last value at rest."""
    scene = Scene(
        particles=[[0, 0, 0], [0, 0, -1]],
        forces=[
            {"kind": "springs", "name": "rope", "particles": [[0, 1]], "stiffness": 1000, "damping": 30},
            {"kind": "unary", "name": "load", "particles": [1], "vector": [0, 0, 0]},
        ],
        anchors=[{"particles": [0]}],
        settings={"tolerance": 1e-9},
    )
    script = {"forces": [{"force": "load", "column": "vector", "times": [1, 3], "values": [[0, 0, 0], [0, 0, -50]]}]}
    simulation = Simulation(scene, script)
    simulation.step(10)  # 2 s, halfway: the load of the last step's start is 24.75 N
    assert simulation.result().force("load")["force"][0, 2] == pytest.approx(-24.75, abs=1e-9)
    *_, last = simulate(scene, script=script)
    assert last.status == "converged"
    assert last.particles[1, 2] == pytest.approx(-1.05, abs=1e-9)


def test_rest_before_the_end_of_a_script_is_no_end():
    """The cable is at rest while its script waits; the run ends only when it rests after the last time."""
    late = {"anchors": [{"anchor": "ends", "times": [15, 16], "shifts": [[0, 0, 0], [0, 0, 1]]}]}
    *_, last = simulate(cable(tolerance=1e-2, drag=10), script=late)
    assert last.time > 16
    assert last.status == "converged"
    assert last.particles[0, 2] == 1.0


def test_anchors_moved_and_put_back_leave_the_first_equilibrium():
    """A path that ends where it began: the same cable to the tolerance, residual 1e-9 of 20 N over k = 1000 N/m and a
    stiffness of the sag above 10 N/m: below 1e-8 m."""
    scene = cable(tolerance=1e-9)
    *_, last = simulate(scene, script=RAISED)
    assert last.particles == pytest.approx(relax(scene).particles, abs=1e-8)


def test_reset_after_a_script_keeps_every_support_and_plays_it_again_bit_for_bit():
    """In the original the supports are lost; here each anchor has its particles, at the start of its path."""
    simulation = Simulation(cable(), RAISED)
    simulation.step(7)
    first = simulation.state.x.copy()
    simulation.reset()
    assert simulation.state.x.tobytes() == Simulation(cable()).state.x.tobytes()
    assert simulation.state.free[[0, 5]].sum() == 0
    assert simulation.result().reactions["particles"].tolist() == [0, 5]
    simulation.step(7)
    assert simulation.state.x.tobytes() == first.tobytes()


@pytest.mark.parametrize("half", [5, 13])
def test_a_script_is_saved_with_its_simulation(tmp_path, half: int):
    """Saved in the middle of the path or after it, and resumed: the same bits as straight on."""
    straight = Simulation(cable(), RAISED)
    straight.step(half)
    straight.save(tmp_path / "half.npz")
    resumed = Simulation.load(tmp_path / "half.npz")
    for simulation in (straight, resumed):
        simulation.step(6)
    assert resumed.state.x.tobytes() == straight.state.x.tobytes()
    resumed.reset()
    resumed.step(half + 6)
    assert resumed.state.x.tobytes() == straight.state.x.tobytes()


def test_an_anchor_on_some_axes_is_led_on_those_alone():
    """Held in z only, it is led in z; x and y stay the spring's business."""
    scene = cable().model_dump()
    scene["anchors"] = [{"name": "left", "particles": [0]}, {"name": "right", "particles": [5], "axes": "z"}]
    script = {"anchors": [{"anchor": "right", "times": [0, 1], "shifts": [[0, 0, 0], [5, 5, 1]]}]}
    *_, last = simulate(Scene(**scene), 5, script=script)
    assert last.particles[5, 2] == 1.0
    assert last.particles[5, 1] == 0.0


def test_targets_lead_each_particle_of_an_anchor_by_itself():
    """(k, particles, 3) from the scene's own targets; a particle released by hand is let go, the other led on."""
    ends = [[[0, 0, 0], [10, 0, 0]], [[0, 0, 1], [9, 0, 2]]]
    simulation = Simulation(cable(), {"anchors": [{"anchor": 0, "times": [0, 1], "targets": ends}]})
    simulation.step(2)
    assert simulation.state.x[[0, 5]] == pytest.approx(np.array([[0, 0, 0.4], [9.6, 0, 0.8]]), abs=1e-14)
    simulation.patch({"release": [0]})
    simulation.step(3)
    assert simulation.state.x[5].tolist() == [9.0, 0.0, 2.0]
    assert simulation.state.free[0].tolist() == [1, 1, 1]


def test_a_shift_counts_from_where_the_scene_holds_the_anchor():
    """From its targets where it has some, never from where a patch or script has brought it."""
    scene = cable().model_dump()
    scene["anchors"] = [{"name": "ends", "points": [[0, 0, 0], [10, 0, 0]], "targets": [[0, 0, 1], [10, 0, 1]]}]
    simulation = Simulation(Scene(**scene))
    for shift in (1.0, 3.0):
        simulation.patch({"move": [{"anchor": "ends", "shift": [0, 0, shift]}]})
        assert simulation.state.x[[0, 5], 2].tolist() == [1 + shift, 1 + shift]


def test_a_script_that_stiffens_past_the_time_step_is_told_before():
    """Stiffness led to 1e6 N/m with steps of 0.01 s: the warning names a step that holds; left out, it is divided."""
    script = {"forces": [{"force": "cable", "column": "stiffness", "times": [0, 1], "values": [1000, 1e6]}]}
    scene = cable()
    given = scene.model_copy(update={"settings": Settings(**scene.settings.model_dump(exclude={"divide_steps"}))})
    simulation = Simulation(given, script)
    assert not simulation.system.report.warnings
    simulation.step(2)
    assert any(w.startswith("/settings/time_step") for w in simulation.system.report.warnings)
    divided = Simulation(scene, script)
    assert divided.step(20) is Status.RUNNING and not divided.system.report.warnings


@pytest.mark.parametrize(
    "script", [{}, {"anchors": [{"anchor": "ends", "times": [0.5, 9], "shifts": [[0, 0, 0]] * 2}]}]
)
def test_a_script_that_moves_nothing_changes_no_bit_and_takes_many_steps_at_once(monkeypatch, script: dict):
    """The bits of no script at all; 100 steps in at most two calls a frame."""
    plain, scripted = Simulation(cable()), Simulation(cable(), script)
    plain.step(5)
    counts = []
    advance = verlet.Method.advance
    monkeypatch.setattr(verlet.Method, "advance", lambda *a: counts.append(a[3]) or advance(*a))
    scripted.step(5)
    assert plain.state.x.tobytes() == scripted.state.x.tobytes()
    assert sum(counts) == 100
    assert len(counts) <= 10


PATH = {"anchor": "ends", "times": [0, 1], "shifts": [[0, 0, 0], [0, 0, 1]]}
VALUES = {"force": "cable", "column": "stiffness", "times": [0, 1], "values": [1000, 500]}


@pytest.mark.parametrize(
    ("script", "pointer"),
    [
        ({"anchors": [PATH | {"anchor": "nobody"}]}, "/anchors/0/anchor"),
        ({"anchors": [PATH | {"times": [1, 1]}]}, "/anchors/0/times/1"),
        ({"anchors": [PATH | {"times": []}]}, "/anchors/0/times"),
        ({"anchors": [PATH | {"times": [0]}]}, "/anchors/0/shifts"),
        ({"anchors": [PATH | {"targets": [[[0, 0, 0]]]}]}, "/anchors/0"),
        ({"anchors": [{"anchor": "ends", "times": [0], "targets": [[[0, 0, 0]]]}]}, "/anchors/0/targets"),
        ({"anchors": [{"anchor": "ends", "times": [0], "targets": [[0, 0, 0]]}]}, "/anchors/0/targets"),
        ({"forces": [VALUES | {"force": "nothing"}]}, "/forces/0/force"),
        ({"forces": [VALUES | {"column": "stifness"}]}, "/forces/0/column"),
        ({"forces": [VALUES | {"column": "particles"}]}, "/forces/0/column"),
        ({"forces": [VALUES | {"values": [1, -1]}]}, "/forces/0/values/1"),
        ({"forces": [VALUES | {"values": [1]}]}, "/forces/0/values"),
        ({"forces": [VALUES | {"values": ["a", 1]}]}, "/forces/0/values/0"),
        ({"anchor": []}, "/anchor"),
        ([], "/"),
    ],
)
def test_a_script_that_does_not_fit_says_where(script: dict, pointer: str):
    """The pointer of the fault, in one line."""
    with pytest.raises(InputError) as caught:
        Simulation(cable(), script)
    assert caught.value.pointer == pointer
    assert "\n" not in str(caught.value)


def test_a_script_needs_a_solver_that_knows_time():
    """Dynamic relaxation has iterations, no seconds."""
    with pytest.raises(InputError, match="has no physical time"):
        Simulation(cable(solver="relaxation"), RAISED)
    running = Simulation(cable(), RAISED)
    with pytest.raises(InputError, match="has no physical time"):
        running.patch({"settings": {"solver": "momentum"}})


def test_the_docs_name_every_field_of_a_script():
    """docs/scene.md tells of paths, values and drives."""
    from pathlib import Path

    from hookean.running.script import AnchorPath, Drive, ForcePath

    page = (Path(__file__).parents[2] / "docs" / "scene.md").read_text(encoding="utf-8")
    fields = {name for model in (Script, AnchorPath, ForcePath, Drive) for name in model.model_fields}
    assert not sorted(name for name in fields if f"`{name}`" not in page)
