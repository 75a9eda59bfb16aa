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
    with pytest.raises(InputError, match="no edit to be redone"):
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


def held_by(*anchors: dict[str, object]) -> Scene:
    """The cable with other anchors."""
    return Scene.read({**cable().model_dump(mode="json", exclude_unset=True), "anchors": list(anchors)})


def held(running: Simulation) -> list[tuple[int, str, dict[int, tuple[float, ...]]]]:
    """Number, name, and the targets of its particles, of every anchor that holds any."""
    return [
        (h.number, h.name, {int(p): tuple(map(float, t)) for p, t in zip(h.particles, h.targets, strict=True)})
        for h in running.system.held
        if len(h.particles)
    ]


def test_a_pull_is_one_edit_and_leaves_the_particle_free():
    """A free particle is pinned where a hand leads it and let go: it follows exactly, swings back to the equilibrium
    without the hand, and one undo takes the whole pull back."""
    running = Simulation(cable())
    wanted = running.relax().particles
    before = held(running)
    running.patch({"forces": {"1": {"vector": [0, 0, -20]}}})
    for step in range(1, 9):
        target = wanted[2] + [0, 0.1 * step, 0]
        running.patch({"pin": [{"particles": [2], "targets": [target]}]}, gesture="pull 1")
        assert np.array_equal(running.state.x[2], target) and not running.state.free[2].any()
        running.step(2)
    assert len(running.history.before) == 2 and len(held(running)) == len(before) + 1
    running.patch({"release": [2]}, gesture="pull 1")
    assert len(running.history.before) == 2 and held(running) == before
    assert running.state.free[2].all() and not running.state.v[2].any()
    assert np.allclose(running.relax().particles, wanted, atol=1e-5)
    running.undo()
    assert held(running) == before and len(running.history.before) == 1
    running.redo()
    assert held(running) == before and running.state.free[2].all()
    running.undo()
    running.undo()
    with pytest.raises(InputError, match="undone"):
        running.undo()


def test_one_particle_of_an_anchor_follows_and_the_others_stay():
    """A pin of a particle that an anchor holds on the same axes leads it within its anchor: name and number stay, so
    do the others; release frees this one alone; undo puts it back where the anchor had it."""
    running = Simulation(cable())
    assert held(running) == [(0, "ends", {0: (0, 0, 0), 5: (10, 0, 0)})]
    for step in range(1, 4):
        pin = {"particles": [5], "targets": [[10, 0, step]]}
        running.patch({"pin": [pin]}, gesture="drag 1")
        running.step()
    assert held(running) == [(0, "ends", {0: (0, 0, 0), 5: (10, 0, 3)})]
    assert np.array_equal(running.state.x[[0, 5]], [[0, 0, 0], [10, 0, 3]])
    assert running.result().reactions["names"] == ["ends", "ends"]
    direct = Simulation(held_by({"particles": [0, 5], "targets": [[0, 0, 0], [10, 0, 3]]}))
    assert np.allclose(running.relax().particles, direct.relax().particles, atol=1e-5)
    running.patch({"move": [{"anchor": "ends", "targets": [[0, 0, 1], [10, 0, 3]]}]})
    running.undo()
    running.undo()
    assert held(running) == [(0, "ends", {0: (0, 0, 0), 5: (10, 0, 0)})]
    assert np.array_equal(running.state.x[5], [10, 0, 0])
    running.redo()
    running.patch({"release": [5]})
    assert held(running) == [(0, "ends", {0: (0, 0, 0)})] and running.state.free[5].all()
    running.undo()
    assert held(running) == [(0, "ends", {0: (0, 0, 0), 5: (10, 0, 3)})]


def test_a_pin_that_differs_from_the_anchor_is_an_anchor_of_its_own():
    """With a name, on more axes, or of particles that nothing holds: only these are new."""
    running = Simulation(held_by({"name": "rollers", "particles": [0, 5], "axes": "yz"}))
    running.patch({"pin": [{"particles": [5, 3], "axes": "yz", "targets": [[0, 0, 1], [0, 0, 2]]}]})
    assert [(n, sorted(at)) for n, _, at in held(running)] == [(0, [0, 5]), (-1, [3])]
    assert running.state.x[[5, 3], 2].tolist() == [1, 2]
    running.patch({"pin": [{"particles": [5], "targets": [[9, 0, 1]]}]})
    assert [(n, sorted(at)) for n, _, at in held(running)] == [(0, [0]), (-1, [3]), (-1, [5])]
    running.patch({"pin": [{"particles": [0], "axes": "yz", "name": "post"}]})
    assert [(n, name, sorted(at)) for n, name, at in held(running)] == [
        (-1, "", [3]), (-1, "", [5]), (-1, "post", [0])
    ]  # fmt: skip
