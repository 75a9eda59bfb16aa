"""Forces added to and removed from a running simulation, on scenes of every kind of place; the scene as edits left it.

Oracle: the forces of a simulation compiled from the edited scene alone, and sums of loads by hand.
"""

from __future__ import annotations

import io
from typing import Any

import numpy as np
import pytest

from hookean import InputError, Scene, Simulation

SHEET = {
    "vertices": [[float(i), float(j), 0.0] for i in range(3) for j in range(3)],
    "faces": [[3 * i + j, 3 * i + j + 3, 3 * i + j + 4, 3 * i + j + 1] for i in range(2) for j in range(2)],
}
PLACES: dict[str, dict[str, Any]] = {
    "given": {
        "particles": [[0, 0, 0], [1, 0, 0], [2, 0, 0]],
        "forces": [{"kind": "springs", "particles": [[0, 1], [1, 2]]}],
        "anchors": [{"particles": [0, 2]}],
    },
    "lines": {
        "forces": [{"kind": "springs", "lines": [[[0, 0, 0], [1, 0, 0]], [[1, 0, 0], [2, 0, 0]]]}],
        "anchors": [{"points": [[0, 0, 0], [2, 0, 0]]}],
    },
    "mesh": {
        "meshes": {"sheet": SHEET},
        "forces": [{"kind": "springs", "mesh": "sheet", "plasticity": 0.01}],
        "anchors": [{"points": [[0, 0, 0], [2, 0, 0], [0, 2, 0]]}],
    },
    "both": {
        "particles": [[5, 0, 0], [0, 0, 0]],
        "velocities": [[0, 0, 1], [0, 0, 0]],
        "masses": [2.0, 3.0],
        "forces": [{"kind": "springs", "lines": [[[0, 0, 0], [1, 0, 0]], [[1, 0, 0], [5, 0, 0]]]}],
        "anchors": [{"particles": [0, 1]}],
    },
    "twins": {  # given particles at one place, so that coordinates cannot name the second
        "particles": [[0, 0, 0], [2, 0, 0], [2, 0, 0]],
        "masses": [1.0, 1.0, 4.0],
        "velocities": [[0, 0, 0], [0, 0, 0], [0, 0, 1]],
        "forces": [
            {"kind": "springs", "lines": [[[0, 0, 0], [1, 0, 0]], [[1, 0, 0], [2, 0, 0]]]},
            {"kind": "springs", "particles": [[1, 2]]},
        ],
        "anchors": [{"points": [[0, 0, 0]]}],
    },
}


def moving(name: str) -> Simulation:
    """A simulation of a scene that has moved a little."""
    simulation = Simulation(Scene.read({**PLACES[name], "strict": True}))
    simulation.patch({"forces": {"0": {"stiffness": 900.0}}})
    simulation.step(2)
    return simulation


def forces(simulation: Simulation) -> np.ndarray:
    """What acts on the particles where they are, by the simulation itself."""
    return simulation.system.evaluate(simulation.state)[0]


def anew(simulation: Simulation) -> np.ndarray:
    """The same by a simulation of the edited scene alone, as a file would hold it."""
    fresh = Simulation(Scene.read(simulation.edited_scene().canonical))
    assert np.array_equal(fresh.system.x, simulation.system.x)
    assert np.array_equal(fresh.system.mass, simulation.system.mass)
    assert np.array_equal(fresh.system.v, simulation.system.v)
    state = fresh.state.copy()
    state.x = simulation.state.x.copy()
    state.memory = [memory.copy() for memory in simulation.state.memory]
    return fresh.system.evaluate(state)[0]


@pytest.mark.parametrize("name", PLACES)
def test_a_load_acts_on_the_particles_it_was_given(name: str) -> None:
    """On each free particle by its number: 0.5 N more, as the edited scene says, too; undone, redone and removed."""
    simulation = moving(name)
    free = np.flatnonzero(simulation.state.free.any(axis=1))
    before, scene, x = forces(simulation), simulation.edited_scene().canonical, simulation.state.x.copy()
    load = {"kind": "unary", "name": "load", "particles": free.tolist(), "vector": [0, 0, -0.5]}
    revision = simulation.patch({"add": [load]})
    assert revision == simulation.state.revision and np.array_equal(simulation.state.x, x)
    wanted = before.copy()
    wanted[free, 2] -= 0.5
    added = simulation.edited_scene().canonical
    for step in (lambda: None, simulation.undo, simulation.redo):
        step()
        undone = step == simulation.undo
        assert np.array_equal(forces(simulation), before if undone else wanted)
        assert np.array_equal(anew(simulation), forces(simulation))
        assert simulation.edited_scene().canonical == (scene if undone else added)
    simulation.patch({"remove": ["load"]})
    assert np.array_equal(forces(simulation), before)
    assert [force.name for force in simulation.scene.forces].count("load") == 0
    simulation.step()
    assert np.isfinite(simulation.state.x).all()


@pytest.mark.parametrize("name", PLACES)
def test_several_edits_are_taken_back_to_the_first_scene(name: str) -> None:
    """Self weight, a pin, another stiffness, a removal; then all undone, all redone, saved and loaded on the way."""
    simulation = moving(name)
    scenes = [simulation.edited_scene().canonical]
    last = len(simulation.system.x) - 1
    edits: list[dict[str, Any]] = [
        {"add": [{"kind": "self_weight", "name": "weight", "total": 3.0}]},
        {"pin": [{"particles": [last], "targets": [[2.5, 0, 1]], "name": "hand"}], "forces": {"0": {"damping": 2.0}}},
        {"add": [{"kind": "springs", "particles": [[0, last]], "stiffness": 5.0}], "remove": ["weight"]},
    ]
    for edit in edits:
        simulation.patch(edit)
        scenes.append(simulation.edited_scene().canonical)
        assert np.array_equal(anew(simulation), forces(simulation))
        simulation.step()
    assert len(set(scenes)) == 4
    for scene in scenes[-2::-1]:
        simulation.undo()
        assert simulation.edited_scene().canonical == scene
    for scene in scenes[1:]:
        simulation.redo()
        assert simulation.edited_scene().canonical == scene
    file = io.BytesIO()
    simulation.save(file)
    loaded = Simulation.load(io.BytesIO(file.getvalue()))
    assert loaded.edited_scene().canonical == scenes[-1]
    simulation.step(2)
    loaded.step(2)
    assert np.array_equal(simulation.state.x, loaded.state.x)


def test_elements_remember_what_they_did_before_an_edit() -> None:
    """Plastic rest lengths stay with their springs when a load comes and goes; a spring that is added has none."""
    simulation = moving("mesh")
    simulation.patch({"move": [{"anchor": 0, "targets": [[0, 0, 3], [2, 0, 0], [0, 2, 0]]}]})
    simulation.step(20)
    (memory,) = simulation.state.memory
    yielded = memory.copy()
    assert (yielded != 0).any()
    simulation.patch({"add": [{"kind": "unary", "points": [[1, 1, 0]], "vector": [0, 0, -1]}]})
    assert [m.shape for m in simulation.state.memory] == [yielded.shape, (1, 0)]
    assert np.array_equal(simulation.state.memory[0], yielded)
    simulation.patch({"add": [{"kind": "springs", "particles": [[0, 8]]}]})
    assert np.array_equal(simulation.state.memory[0], [*yielded, np.zeros(yielded.shape[1])])
    simulation.undo()
    simulation.undo()
    assert np.array_equal(simulation.state.memory[0], yielded)


@pytest.mark.parametrize(
    ("edit", "pointer", "said"),
    [
        ({"add": [{"kind": "unary", "particles": [9], "vector": [0, 0, 1]}]}, "/add/0/particles", "there are 9"),
        ({"add": [{"kind": "unary", "points": [[7, 0, 0]], "vector": [0, 0, 1]}]}, "/add/0/points", r"\(7, 0, 0\)"),
        ({"add": [{"kind": "springs", "lines": [[[0, 0, 0], [7, 0, 0]]]}]}, "/add/0/lines", "send a new scene"),
        ({"add": [{"kind": "pressure", "mesh": "roof", "pressure": 1}]}, "/add/0/mesh", "'roof' does not exist"),
        ({"add": [{"kind": "unary", "points": [[1, 1, 0]]}]}, "/add/0/vector", "required"),
        ({"add": [{"kind": "springs", "particles": [[0, 1]], "stiffness": [1, 2]}]}, "/add/0/stiffness", "2 values"),
        ({"add": [{"kind": "sprngs"}]}, "/add/0", "did you mean"),
        ({"remove": ["nobody"]}, "/remove/0", "no force of this name"),
        ({"remove": [4]}, "/remove/0", "1 forces"),
        ({"remove": [1]}, "/remove/0", "1 forces"),
        ({"remove": [0]}, "", "no particles"),
    ],
)
def test_what_does_not_fit_changes_nothing(edit: dict[str, Any], pointer: str, said: str) -> None:
    simulation = moving("mesh")
    scene, x, memory = simulation.edited_scene().canonical, simulation.state.x.copy(), simulation.state.memory[0].copy()
    with pytest.raises(InputError, match=said) as refused:
        simulation.patch(edit)
    assert refused.value.pointer.startswith(pointer)
    assert simulation.edited_scene().canonical == scene and simulation.state.revision == 1
    assert np.array_equal(simulation.state.x, x) and np.array_equal(simulation.state.memory[0], memory)
    assert len(simulation.history.before) == 1
    simulation.step()


def test_removing_what_its_particles_come_from_is_refused() -> None:
    """Springs along lines make particles of their ends; without one of two such forces there would be fewer."""
    lines = [[[[0, 0, 0], [1, 0, 0]]], [[[1, 0, 0], [2, 0, 0]]]]
    scene = {"forces": [{"kind": "springs", "lines": one} for one in lines], "anchors": [{"points": [[0, 0, 0]]}]}
    simulation = Simulation(Scene.read(scene))
    with pytest.raises(InputError, match="change the particles"):
        simulation.patch({"remove": [1]})
    assert len(simulation.scene.forces) == 2
    simulation = moving("given")
    simulation.patch({"remove": [0]})
    assert not forces(simulation).any()


def test_a_script_keeps_its_forces() -> None:
    script = {"forces": [{"force": "1", "column": "vector", "times": [0, 1], "values": [[0, 0, 0], [0, 0, -1]]}]}
    given = PLACES["given"]
    load = {"kind": "unary", "particles": [1], "vector": [0, 0, 0]}
    simulation = Simulation(Scene.read({**given, "forces": [*given["forces"], load]}), script)
    with pytest.raises(InputError, match="script"):
        simulation.patch({"remove": [0]})
    simulation.patch({"add": [{"kind": "self_weight", "total": 1.0}]})
    simulation.step()


@pytest.mark.parametrize("name", PLACES)
def test_the_edited_scene_holds_anchors_as_they_are(name: str) -> None:
    """One moved, one released, one pinned along an axis: a simulation of that scene holds the same particles there."""
    simulation = moving(name)
    assert simulation.edited_scene().canonical == simulation.scene.canonical
    held = simulation.system.held[0]
    targets = held.targets + [0.0, 0.0, 0.5]
    last = len(simulation.system.x) - 1
    simulation.patch({"move": [{"anchor": 0, "targets": targets.tolist()}]})
    simulation.patch({"release": [int(held.particles[0])], "pin": [{"particles": [last], "axes": "z"}]})
    fresh = Simulation(Scene.read(simulation.edited_scene().canonical))
    assert np.array_equal(fresh.system.x, simulation.system.x)
    assert np.array_equal(fresh.state.free, simulation.state.free)
    fixed = simulation.state.free == 0
    assert fixed[last, 2] and np.array_equal(fresh.state.x[fixed], simulation.state.x[fixed])


def test_a_value_that_a_field_does_not_allow_is_named_by_its_place() -> None:
    simulation = Simulation(Scene.read(PLACES["lines"]))
    with pytest.raises(InputError) as found:
        simulation.patch({"forces": {"0": {"stiffness": -1.0}}})
    assert found.value.pointer.startswith("/forces/0/stiffness")
