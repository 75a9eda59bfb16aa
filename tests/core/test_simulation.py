"""Running systems: frames, patches, saving and resuming, carried geometry, ways to end."""

from __future__ import annotations

import io

import numpy as np
import pytest

from hookean import InputError, Scene, Simulation, relax, simulate
from hookean.running.result import Status
from samples import cable


def test_a_saved_simulation_goes_on_bit_for_bit(tmp_path):
    """x and v after 10 + 7 frames equal those of 10 frames, save, load, 7 frames; plastic memory included."""
    base = cable(sub_iterations=11).model_dump()
    base["forces"][0]["plasticity"] = 0.01
    straight = Simulation(Scene(**base))
    straight.step(10)
    straight.patch({"forces": {"cable": {"stiffness": 900}}})
    straight.save(tmp_path / "half.npz")
    resumed = Simulation.load(tmp_path / "half.npz")
    for simulation in (straight, resumed):
        simulation.step(7)
    assert resumed.state.x.tobytes() == straight.state.x.tobytes()
    assert resumed.state.v.tobytes() == straight.state.v.tobytes()
    assert resumed.state.memory[0].tobytes() == straight.state.memory[0].tobytes()
    assert np.abs(straight.state.memory[0]).max() > 0
    assert (resumed.state.revision, resumed.state.time) == (straight.state.revision, straight.state.time)


def test_a_file_that_is_no_simulation_is_refused(tmp_path):
    """One sentence, not a traceback of the archive reader."""
    (tmp_path / "x.npz").write_bytes(b"not an archive")
    with pytest.raises(InputError, match="not a saved simulation"):
        Simulation.load(tmp_path / "x.npz")


def test_patches_change_loads_stiffness_rest_length_and_settings_while_it_runs():
    """After a patch the running system relaxes to what a fresh scene with the new values gives."""
    simulation = Simulation(cable(tolerance=1e-10))
    simulation.step(3)
    revision = simulation.patch(
        {"forces": {"cable": {"stiffness": 500, "rest_factor": 0.9}, "1": {"vector": [0, 3, -10]}},
         "settings": {"tolerance": 1e-11}}
    )  # fmt: skip
    fresh = cable(tolerance=1e-11).model_dump()
    fresh["forces"][0].update(stiffness=500, rest_factor=0.9)
    fresh["forces"][1].update(vector=[0, 3, -10])
    assert revision == 1
    assert simulation.relax().particles == pytest.approx(relax(Scene(**fresh)).particles, abs=1e-8)


def test_particles_are_pinned_released_and_retargeted_while_it_runs():
    """Held exactly where told; a released particle moves again."""
    simulation = Simulation(cable())
    simulation.patch({"pin": [{"particles": [2], "targets": [[4, 0, 1]]}]})
    result = simulation.relax()
    assert result.particles[2].tolist() == [4, 0, 1]
    assert result.reactions["particles"].tolist() == [0, 2, 5]
    simulation.patch({"release": [2, 0], "pin": [{"particles": [0], "axes": "z"}]})
    assert simulation.state.free[0].tolist() == [1, 1, 0]
    assert simulation.state.free[2].tolist() == [1, 1, 1]


@pytest.mark.parametrize(
    ("patch", "pointer"),
    [
        ({"forces": {"cable": {"stiffness": -1}}}, "/forces/cable/stiffness"),
        ({"forces": {"cabel": {"stiffness": 1}}}, "/forces/cabel"),
        ({"forces": {"0": {"stiffness": 1}, "cable": {"stiffness": 2}}}, "/forces/cable"),  # the same force
        ({"forces": {"2": {"stiffness": 1}}}, "/forces/2"),  # there are two, counted from 0
        ({"forces": {"cable": {"particles": [[0, 1]]}}}, "/forces/cable/particles"),
        ({"move": [{"anchor": "ends", "targets": [[0, 0, 0]]}]}, "/move/0/targets"),
        ({"move": [{"anchor": "nobody", "targets": []}]}, "/move/0/anchor"),
        ({"move": [{"anchor": "ends", "shift": [0, 0, 1]}, {"anchor": 0, "shift": [0, 0, 2]}]}, "/move/1/anchor"),
        ({"release": [99]}, "/release/0"),
        ({"settings": {"time_step": -1}}, "/settings/time_step"),
        ({"geometry": []}, "/geometry"),
    ],
)
def test_a_patch_that_does_not_fit_changes_nothing(patch: dict, pointer: str):
    """The pointer of the fault, and the same state as before."""
    simulation = Simulation(cable())
    simulation.step(2)
    before, revision = simulation.state.x.copy(), simulation.state.revision
    with pytest.raises(InputError) as caught:
        simulation.patch(patch)
    assert caught.value.pointer == pointer
    assert simulation.state.revision == revision
    assert (simulation.state.x == before).all()
    assert simulation.system.groups[0].block.parameters[0, 0] == 1000


def test_geometry_rides_along_with_its_particles():
    """Points, lines, a polyline, a curve and a mesh move with the particles they meet; a stray point stays."""
    corners = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
    scene = Scene(
        meshes={"net": {"vertices": corners, "faces": [[0, 1, 2, 3]]}},
        forces=[
            {"kind": "springs", "mesh": "net"},
            {"kind": "unary", "points": corners, "vector": [0, 0, -1]},
        ],
        anchors=[{"points": [corners[0], corners[2]]}],
        geometry=[
            {"name": "p", "kind": "points", "points": [corners[1], [7, 7, 7]]},
            {"name": "l", "kind": "lines", "lines": [[corners[0], corners[1]]]},
            {"name": "o", "kind": "polyline", "points": corners},
            {"name": "c", "kind": "curve", "points": corners, "degree": 2},
            {"name": "m", "kind": "mesh", "mesh": "net"},
        ],
    )
    result = relax(scene)
    points, line, polyline, curve, mesh = result.geometry
    assert result.particles[1, 2] < 0
    assert points["points"].tolist() == [result.particles[1].tolist(), [7, 7, 7]]
    assert line["lines"][0, 1].tolist() == result.particles[1].tolist()
    for carried in (polyline["points"], curve["points"], mesh["vertices"]):
        assert carried.tolist() == result.particles.tolist()
    assert curve["degree"] == 2
    assert any("/geometry/0: 1 of 2 points" in w for w in result.report.warnings)


def test_every_way_to_end_has_a_status_and_a_sentence():
    """Out of iterations, out of time, cancelled, diverged (a load nothing holds): a value, never an exception."""
    flying = Scene(particles=[[0, 0, 0]], forces=[{"kind": "unary", "particles": [0], "vector": [0, 0, 1]}])
    ended = {
        Status.MAX_ITERATIONS: relax(cable(max_iterations=3)),
        Status.TIME_LIMIT: relax(cable(time_limit=0.0, tolerance=0.0)),
        Status.CANCELLED: relax(cable(), cancelled=lambda: True),
        Status.DIVERGED: relax(flying),
    }
    for status, result in ended.items():
        assert result.status is status
        assert result.message.endswith(".")
        assert np.isfinite(result.particles).all()
    assert ended[Status.MAX_ITERATIONS].iterations == 3
    assert "Diverged after 0" not in ended[Status.DIVERGED].message
    assert any("nothing" in w or "no spring" in w for w in ended[Status.DIVERGED].report.warnings)


def test_a_step_that_diverges_takes_the_shape_back_and_not_the_revision():
    """Clients wait for frames of the revision they made; an older one would never be taken for it."""
    scene = {"particles": [[0, 0, 0], [1, 0, 0]], "settings": {"solver": "newton"}}
    scene["forces"] = [
        {"kind": "springs", "particles": [[0, 1]]},
        {"kind": "unary", "particles": [0, 1], "vector": [0, 0, -1]},
    ]
    simulation = Simulation(Scene.read(scene))
    simulation.reset()
    simulation.state.revision += 1  # as a session counts a reset
    assert simulation.step(100) == "diverged"
    assert (simulation.state.revision, simulation.state.x.tolist()) == (1, [[0, 0, 0], [1, 0, 0]])


def test_a_diverged_simulation_that_is_loaded_says_no_more_than_it_knows(tmp_path):
    """Where it flew apart is not in the file: the sentence leaves it out, and has no gap."""
    flying = Simulation(cable(time_step=0.5))
    flying.step(50)
    assert flying.status is Status.DIVERGED and " at particle" in flying.message
    flying.save(tmp_path / "flying.npz")
    said = Simulation.load(tmp_path / "flying.npz").message
    assert said.startswith("Diverged; the last good shape is returned.")


def test_a_simulation_bounces_before_it_settles():
    """Figure 9.6: the sag passes its equilibrium and comes back; the last frame is at rest on it."""
    frames = list(simulate(cable(tolerance=1e-5), 400))
    sag = np.array([-f.particles[:, 2].min() for f in frames])
    assert sag.max() > 1.3149604882 * 1.05
    assert frames[-1].status is Status.CONVERGED
    assert sag[-1] == pytest.approx(1.3149604882, rel=1e-4)
    assert [f.iteration for f in frames[:3]] == [0, 20, 40]
    assert frames[2].time == pytest.approx(0.4)


def test_an_anchor_moved_in_a_running_cable_and_put_back_gives_the_first_equilibrium():
    """Figures 9.7 and 9.8, without a pause: the cable swings on from where it is.

    The softest stiffness is across: 4 sin(pi / 10)^2 = 0.38 of T / l = 43 N/m. So 1e-8 of 20 N is off by 1.2e-8 m, and
    there are two such ends.
    """
    running = Simulation(cable(tolerance=1e-8, drag=5.0))

    def rest() -> np.ndarray:
        for _ in range(600):
            if running.step() is Status.CONVERGED:
                return running.state.x.copy()
        raise AssertionError("still moving")

    def drag_to(end: list[float]) -> None:
        running.patch({"move": [{"anchor": "ends", "targets": [[0, 0, 0], end]}]})

    first = rest()
    drag_to([8, 1, 2])
    running.step(3)
    assert running.status is Status.RUNNING  # on the way
    assert running.state.x[5].tolist() == [8, 1, 2]
    assert np.abs(running.state.v).max() > 0.1
    drag_to([10, 0, 0])
    assert rest() == pytest.approx(first, abs=2.4e-8)
    drag_to([8, 1, 2])
    moved = rest()
    assert moved[5].tolist() == [8, 1, 2]
    drag_to([10, 0, 0])
    assert rest() == pytest.approx(first, abs=2.4e-8)
    # reset where the anchor is not where it started: every support is kept, and the shape that belongs to it found
    drag_to([8, 1, 2])
    running.reset()
    assert rest() == pytest.approx(moved, abs=2.4e-8)
    assert running.result().reactions["particles"].tolist() == [0, 5]


def test_held_axes_slide_on_the_others():
    """A particle held in z alone slides along a loaded spring's direction and reacts in z only."""
    scene = Scene(
        particles=[[0, 0, 0], [1, 0, 0]],
        forces=[
            {"kind": "springs", "particles": [[0, 1]], "stiffness": 10},
            {"kind": "unary", "particles": [1], "vector": [5, 0, -3]},
        ],
        anchors=[{"particles": [0]}, {"particles": [1], "axes": "yz"}],
    )
    result = relax(scene)
    assert result.particles[1] == pytest.approx([1.5, 0, 0], abs=1e-6)
    assert result.reactions["force"][1] == pytest.approx([0, 0, 3], abs=1e-12)


def test_a_summary_says_what_the_columns_say():
    """Ranges of force and the sum of reactions, with units: 120 N of load on six particles, 120 N of reaction."""
    lines = relax(cable()).summary()
    assert lines[0] == "6 particles"
    assert lines[1] == "cable (springs): 5 elements, force 89.28 to 97.83 N"
    assert lines[-1].startswith("2 reactions: largest 107.6 N")
    assert lines[-1].endswith("120) N")


CHANGES = {
    "patch": lambda s: s.patch(
        {"pin": [{"particles": [2]}], "forces": {"0": {"stiffness": 7}}, "settings": {"drag": 2}}
    ),
    "gesture": lambda s: s.patch({"settings": {"drag": 9}}, gesture="slide"),
    "rewire": lambda s: s.patch({"remove": [1], "add": [{"kind": "unary", "particles": [1], "vector": [0, 9, 0]}]}),
    "solver": lambda s: s.patch({"settings": {"solver": "relaxation"}}),
    "undo": lambda s: s.undo(),
    "redo": lambda s: s.redo(),
    "reset": lambda s: s.reset(),
}


@pytest.mark.parametrize("change", CHANGES)
def test_a_change_that_is_reverted_has_never_been_made(change: str):
    """State, scene, anchors, history and every later step are those of a run without it, to the bit."""

    def run() -> Simulation:
        simulation = Simulation(cable())
        simulation.step(3)
        simulation.patch({"forces": {"1": {"vector": [0, 0, -30]}}})
        simulation.patch({"settings": {"drag": 3}}, gesture="slide")
        simulation.patch({"settings": {"drag": 4}})
        simulation.undo()
        simulation.step(2)
        return simulation

    def known(simulation: Simulation) -> tuple:
        file, history = io.BytesIO(), simulation.history
        simulation.save(file)
        scenes = [[setup.scene.canonical for setup in setups] for setups in (history.before, history.after)]
        warnings = simulation.system.report.sentences()
        return (
            file.getvalue(),
            scenes,
            history.gesture,
            simulation.edited_scene().canonical,
            warnings,
            simulation.status,
        )

    kept, changed = run(), run()
    CHANGES[change](changed)
    assert known(changed) != known(kept)
    changed.revert()
    assert known(changed) == known(kept)
    changed.revert()  # once for each
    for simulation in (kept, changed):
        simulation.step(4)
    assert known(changed) == known(kept)
