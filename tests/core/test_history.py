"""Patches taken back and made again, and scenes that succeed each other."""

from __future__ import annotations

import io

import numpy as np
import pytest

from hookean import InputError, Scene, Simulation
from samples import cable


def test_undo_and_redo_move_between_the_same_setups():
    """After undo the anchors, loads and settings are those before the patch, after redo those after it."""
    running = Simulation(cable())
    first = running.scene
    name = running.scene.forces[1].name or "1"
    running.patch({"forces": {name: {"vector": [0, 0, -5]}}})
    running.patch({"pin": [{"particles": [2], "targets": [[4, 0, 1]]}]})
    assert running.state.revision == 2 and running.state.free[2].sum() == 0
    assert running.undo() == 3
    assert running.state.free[2].sum() == 3
    assert running.undo() == 4
    assert running.scene == first
    running.redo()
    assert running.redo() == 6
    assert running.state.free[2].sum() == 0
    assert np.array_equal(running.state.x[2], [4, 0, 1])
    with pytest.raises(InputError, match="no edit that could be made again"):
        running.redo()


def test_what_was_undone_gives_the_first_equilibrium():
    """The equilibrium after a patch and its undo is the one without: the state goes on, the setup is the old one."""
    running = Simulation(cable())
    wanted = running.relax().particles
    running.patch({"forces": {"1": {"vector": [0, 0, -90]}}})
    running.relax()
    running.undo()
    assert np.allclose(running.relax().particles, wanted, atol=1e-5)


def test_a_gesture_is_taken_back_as_one_and_a_new_patch_forgets_what_was_undone():
    """Twenty moves of one drag are one undo; a patch after an undo leaves nothing to redo."""
    running = Simulation(cable())
    for step in range(20):
        running.patch({"move": [{"anchor": 0, "targets": [[0, 0, 0.1 * step], [10, 0, 0]]}]}, gesture="drag 1")
    running.undo()
    assert np.array_equal(running.state.x[0], [0, 0, 0])
    running.patch({"release": [5]})
    with pytest.raises(InputError):
        running.redo()


def test_a_succeeding_scene_keeps_where_its_particles_are():
    """Particles that both scenes start with go on from where they are; new ones start where they are drawn."""
    running = Simulation(cable())
    running.step(10)
    data = running.scene.model_dump(mode="json", exclude_unset=True)
    data["particles"] = [*np.asarray(data["particles"]).tolist(), [12.0, 0.0, 0.0]]
    longer = running.succeed(Scene.read(data))
    assert np.array_equal(longer.state.x[1:5], running.state.x[1:5])
    assert np.array_equal(longer.state.v[1:5], running.state.v[1:5])
    assert np.array_equal(longer.state.x[6], [12, 0, 0])
    assert longer.state.revision == running.state.revision + 1


def test_saving_to_a_stream_is_saving_to_a_file(tmp_path):
    """Streams and paths hold the same, and both go on bit for bit."""
    running = Simulation(cable())
    running.step(3)
    stream = io.BytesIO()
    running.save(stream)
    running.save(tmp_path / "a.npz")
    stream.seek(0)
    for again in (Simulation.load(stream), Simulation.load(tmp_path / "a.npz")):
        again.step(3)
        reference = Simulation.load(tmp_path / "a.npz")
        reference.step(3)
        assert np.array_equal(again.state.x, reference.state.x)
