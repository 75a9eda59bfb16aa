"""What a session's process does with its simulation: made from a scene or the store, edited, described, shown."""

from __future__ import annotations

import hashlib
import io
import json
import math
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.errors import InputError
from hookean.files import saved as saved_file
from hookean.files.documents import plain
from hookean.running.patch import Patch
from hookean.running.result import Status, held_particles, kinetic
from hookean.running.simulation import Simulation
from hookean.scene.scene import Scene
from hookean.scene.text import parse
from hookean.system.state import State
from hookean.system.two_ended import spring_forces
from hookean_server.sessions.wire import Shown

EDITS = ("undo", "redo", "reset")
REPLACES: dict[str, dict[str, Any]] = {
    "rebuild": {"rise": 4},
    "units": {"length": "mm"},
    "draw": {"delete": {"particles": [3]}},
}
"""Edits that lead to another scene, with an example of each."""


def scene_of(body: bytes) -> Scene:
    """The scene in a JSON body; meshes may be COMPAS documents. InputError and ValidationError as `Scene` has them."""
    read = plain(parse(body))
    if read.unheld:
        raise InputError("/", read.unheld)
    return Scene.model_validate(read.scene)


def opened(body: bytes) -> Simulation:
    """The simulation of a scene as JSON, or one that was saved, as it was saved."""
    if not body.startswith(saved_file.BEGINS):
        return Simulation(scene_of(body))
    simulation = saved_file.read(body)
    simulation.state.revision = 0
    return simulation


def following(simulation: Simulation, body: bytes) -> Simulation | None:
    """What replaces a simulation: that of a scene, in which particles keep where they are, or a saved one, in which
    they are as saved; None where the scene is the one it has."""
    if body.startswith(saved_file.BEGINS):
        other = opened(body)
        other.state.revision = simulation.state.revision + 1
        return other
    scene = scene_of(body)
    return None if scene.canonical == simulation.scene.canonical else simulation.succeed(scene)


def split(body: bytes, sizes: list[int]) -> list[bytes]:
    """Several bodies that were sent as one."""
    ends = np.cumsum([0, *sizes])
    return [body[a:b] for a, b in pairwise(ends)]


def saved(simulation: Simulation) -> bytes:
    """A whole simulation, for the store."""
    stream = io.BytesIO()
    simulation.save(stream)
    return stream.getvalue()


def state_bytes(simulation: Simulation) -> bytes:
    """What moves of a simulation, for a checkpoint, but for what follows from its anchors and its start."""
    stream = io.BytesIO()
    state = simulation.state
    arrays: dict[str, Any] = state.arrays()
    del arrays["free"]
    for number, start in enumerate(simulation.system.start().memory):
        if np.array_equal(state.memory[number], start):
            del arrays[f"memory_{number}"]
    arrays["memories"] = np.array(len(state.memory))
    np.savez(stream, allow_pickle=False, status=np.array(str(simulation.status)), **arrays)
    return stream.getvalue()


def restored(base: bytes, state: bytes, edits: list[bytes], revisions: list[int]) -> Simulation:
    """The simulation of the store: `edits` made again on `base`, each leading to its revision, and the particles where
    the checkpoint `state` has them. Edits later than the checkpoint act on them once more."""
    simulation = Simulation.load(io.BytesIO(base))
    arrays: dict[str, NDArray[Any]] = {}
    if state:
        with np.load(io.BytesIO(state), allow_pickle=False) as file:
            arrays = {name: file[name] for name in file.files}
    for edit, revision in zip(edits, revisions, strict=True):
        if arrays and revision > int(arrays["clock"][2]):
            _put(simulation, arrays)
            arrays = {}
        make(simulation, edit)
        simulation.state.revision = revision
    if arrays:
        _put(simulation, arrays)
    return simulation


def _put(simulation: Simulation, arrays: dict[str, NDArray[Any]]) -> None:
    """Go on from a checkpoint, where it is one of this system."""
    status = Status(str(arrays.pop("status")))
    count = int(arrays.pop("memories", np.array(0)))
    for number, start in enumerate(simulation.system.start().memory[:count]):
        arrays.setdefault(f"memory_{number}", start)
    arrays.setdefault("free", np.ones_like(arrays["x"]))
    state = State.of(arrays)
    if state.fits(simulation.state):
        simulation.system.hold(state)  # the anchors are those of the edits, whatever the checkpoint saw
        simulation.take_up(state, status)


def make(simulation: Simulation, body: bytes) -> tuple[bytes, str]:
    """Make an edit: `{"undo": true}`, `redo`, `reset`; `{"rebuild": {...}}` with parameters of the scene's family,
    `{"units": {...}}` with other units of the same numbers, `{"draw": {...}}` with what is drawn or deleted, or a
    patch, all with or without a `gesture`.

    Returns it as it can be made again exactly, and what it sets in words: an edit of the same gesture that sets the
    same replaces it in the store; "" for one that nothing replaces.
    """
    value = parse(body)
    if not isinstance(value, dict):
        raise InputError("/", "an edit is an object with pin, release, move, forces, settings, add or remove")
    gesture = str(value.pop("gesture", ""))[:80]
    for name in EDITS:
        if name in value:
            if value != {name: True}:
                raise InputError(f"/{name}", f"must be the only key: {{{name!r}: true}}".replace("'", '"'))
            getattr(simulation, name)()
            simulation.state.revision += name == "reset"
            return json.dumps(value).encode(), ""
    for name in REPLACES:
        if name in value:
            _replace(simulation, name, value, gesture)
            sets = json.dumps([name, gesture, sorted(value[name])]) if gesture and name != "draw" else ""
            return json.dumps({**value, "gesture": gesture} if gesture else value).encode(), sets
    patch = Patch.read(value)
    pins = []
    for pin, read in zip(value.get("pin") or [], patch.pin, strict=True):
        if read.targets is None and read.particles is not None and len(read.particles):
            _check(read.particles, simulation)
            targets = simulation.state.x[read.particles]
            read, pin["targets"] = read.replaced(targets=targets), targets.tolist()
        pins.append(read)
    simulation.patch(patch.replaced(pin=tuple(pins)), gesture=gesture)
    if not gesture:
        return json.dumps(value).encode(), ""
    return json.dumps({**value, "gesture": gesture}).encode(), _sets(value, patch, gesture)


def _replace(simulation: Simulation, name: str, value: dict[str, Any], gesture: str) -> None:
    """Give the family of the scene other parameters, or its numbers other units, or draw."""
    given = value[name]
    if set(value) != {name} or not isinstance(given, dict):
        raise InputError(f"/{name}", f"must be the only key, with an object: {json.dumps({name: REPLACES[name]})}")
    if name == "rebuild":
        simulation.rebuild(given, gesture=gesture)
        return
    if name == "draw":
        try:
            simulation.draw(given, gesture=gesture)
        except InputError as error:
            raise InputError(f"/draw{error.pointer}".rstrip("/"), error.sentence) from None
        return
    scene = simulation.edited_scene()
    try:
        units = scene.units.model_copy(update=given)
    except InputError as error:
        raise InputError(f"/units{error.pointer}".rstrip("/"), error.sentence) from None
    simulation.replace(scene.replaced(units=units), gesture=gesture)


def _sets(value: dict[str, Any], patch: Patch, gesture: str) -> str:
    if len(patch.release) or patch.rewires:
        return ""
    groups = {"forces": patch.forces, "materials": patch.materials, "sections": patch.sections}
    columns = sorted(f"{g}.{name}.{c}" for g, named in groups.items() for name, given in named.items() for c in given)
    pins = [[np.asarray(pin.particles).tolist(), pin.axes, pin.name] for pin in patch.pin]
    return json.dumps([gesture, sorted(str(m.anchor) for m in patch.move), columns, sorted(patch.settings), pins])


def _check(particles: NDArray[np.int64], simulation: Simulation) -> None:
    count = simulation.system.slots.count
    if int(particles.max()) >= count:
        raise InputError("/pin", f"particle {int(particles.max())} does not exist; there are {count}, counted from 0")


class Wired:
    """Distinguishes the wirings of a simulation: which forces act on which particles."""

    def __init__(self) -> None:
        self._groups: Any = None
        self._tag = ""

    def tag(self, simulation: Simulation) -> str:
        """The same text for the same forces on the same particles, whatever their parameters."""
        groups = simulation.system.groups
        if self._groups is not groups:
            digest = hashlib.sha256(f"{simulation.system.slots.count} {simulation.scene.units!r}".encode())
            for group in simulation.system.all_groups:
                for part in group.parts:
                    digest.update(f"{part.number} {part.force.name!r} {group.cls.__name__} ".encode())
                    digest.update(group.block.indices[part.rows].tobytes())
            self._groups, self._tag = groups, digest.hexdigest()[:16]
        return self._tag


class Edited:
    """The revisions that last changed a simulation's anchors, and the rest of its scene: who has read them at that
    revision or a later one need not read them again."""

    def __init__(self) -> None:
        self._anchors: Any = None
        self._rest: Any = None
        self._revisions = {"anchors_revision": 0, "scene_revision": 0}

    def revisions(self, simulation: Simulation) -> dict[str, int]:
        """Both, by their names in the summary of a session."""
        revision, system, scene = simulation.state.revision, simulation.system, simulation.scene
        anchors = [(h.number, h.name, h.free.tolist(), h.turning.tolist(), h.particles, h.targets) for h in system.held]
        if not _same_anchors(self._anchors, anchors):
            self._anchors = [(*about, particles.copy(), targets.copy()) for *about, particles, targets in anchors]
            self._revisions["anchors_revision"] = revision
        rest = [system, *scene.forces], [scene.settings, scene.materials, scene.sections]
        if self._rest is None or not (_identical(rest[0], self._rest[0]) and rest[1] == self._rest[1]):
            self._rest = rest
            self._revisions["scene_revision"] = revision
        return dict(self._revisions)


def _identical(some: list[Any], others: list[Any]) -> bool:
    """Whether two lists have the same objects: forces are replaced by edits, never written into."""
    return len(some) == len(others) and all(one is other for one, other in zip(some, others, strict=True))


def _same_anchors(some: list[Any] | None, others: list[Any]) -> bool:
    """Whether two lists of anchors hold the same particles at the same targets."""
    if some is None or len(some) != len(others):
        return False
    return all(
        one[:-2] == other[:-2] and np.array_equal(one[-2], other[-2]) and np.array_equal(one[-1], other[-1])
        for one, other in zip(some, others, strict=True)
    )


def describe(simulation: Simulation) -> dict[str, Any]:
    """How a simulation stands, in plain values."""
    state, energy = simulation.state, simulation.energy
    return {
        "revision": state.revision,
        "iteration": state.iteration,
        "time": state.time,
        "residual": simulation.balance.residual,
        "status": str(simulation.status),
        "message": simulation.message,
        "particles": simulation.system.slots.count,
        "undo": len(simulation.history.before),
        "redo": len(simulation.history.after),
        "energy": energy if energy is not None and math.isfinite(energy) else None,
        "units": simulation.scene.units.model_dump(),
        "warnings": simulation.system.report.sentences(),
    }


def frame(simulation: Simulation, number: int, playing: bool) -> Shown:
    """What clients are shown of a simulation now."""
    system, state = simulation.system, simulation.state
    stand = simulation.balance
    held = held_particles(system, state)
    moving = kinetic(system, state) if simulation.solver.physical else 0.0
    return Shown(
        number, state.revision, state.iteration, state.time, float(stand.residual), str(simulation.status), playing,
        moving, state.x[: system.slots.count], spring_forces(system, state), stand.reactions[held],
    )  # fmt: skip
