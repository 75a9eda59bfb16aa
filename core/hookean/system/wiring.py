"""Forces that come and go while a system runs. Its particles stay, and so do their motion and what forces remember."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from hookean.errors import InputError
from hookean.forces import Force
from hookean.system.addressed import addressed
from hookean.system.group import Group
from hookean.system.slots import Slots
from hookean.system.state import State
from hookean.system.system import System, compile

if TYPE_CHECKING:
    from hookean.scene.scene import Scene
    from hookean.system.weld import Welded


@dataclass(frozen=True, eq=False)
class Wiring:
    """What a scene's forces were compiled to; shared, as patches of parameters write into it."""

    groups: list[Group]
    contacts: list[Group]
    impulses: list[Group]
    load_count: NDArray[np.float64]
    places: Welded
    slots: Slots

    @classmethod
    def of(cls, system: System) -> Wiring:
        """That of a system now."""
        return cls(system.groups, system.contacts, system.impulses, system.load_count, system.places, system.slots)

    def put_into(self, system: System, state: State) -> None:
        """Make this the wiring of a system; elements that were there before remember what they did."""
        if self.groups is system.groups:
            return
        state.memory = _carried(system.groups, state.memory, self.groups)
        _turn_over(system, state, self.slots)
        system.groups, system.contacts, system.impulses = self.groups, self.contacts, self.impulses
        system.load_count, system.places = self.load_count, self.places
        system._components = system._films = system._braced = None


def rewire(system: System, state: State, scene: Scene, *, added: int = 0) -> None:
    """Give a running system the forces of `scene`, which has the same particles; the last `added` are those of a patch.
    InputError where the scene has other particles or does not fit together."""
    try:
        fresh = compile(scene)
    except InputError as error:
        raise _of_patch(error, len(scene.forces) - added) from None
    if not np.array_equal(fresh.points, system.points):
        raise InputError("", "these forces change the particles of the scene; send the changed scene instead")
    Wiring.of(fresh).put_into(system, state)
    system.scene = scene


def with_forces(system: System, scene: Scene, add: Sequence[Force], remove: Sequence[int]) -> Scene:
    """`scene`, of the particles of `system`, without the forces of the numbers `remove` and with `add` at the end;
    `particles` of these are numbers of the running system. InputError where a force has no place in it."""
    kept = [force for number, force in enumerate(scene.forces) if number not in remove]
    for i, force in enumerate(add):
        scene, placed = _placed(system, scene, force, f"/add/{i}")
        kept.append(placed)
    return scene.replaced(forces=tuple(kept))


def _placed(system: System, scene: Scene, force: Force, pointer: str) -> tuple[Scene, Force]:
    """A force to add with its place as the scene has it, and that scene."""
    mesh = getattr(force, "mesh", None)
    if mesh is not None and mesh not in scene.meshes:
        known = ", ".join(repr(name) for name in scene.meshes) or "none"
        raise InputError(f"{pointer}/mesh", f"mesh {mesh!r} does not exist; the scene has {known}")
    for name in ("points", "lines"):
        points = getattr(force, name, None)
        if points is not None:
            missed = np.flatnonzero(system.places.meet(points).ravel() < 0)
            if len(missed):
                spot = ", ".join(f"{c:.6g}" for c in points.reshape(-1, 3)[missed[0]])
                said = f"no particle starts at ({spot}), and a running system cannot add particles; send a new scene"
                raise InputError(f"{pointer}/{name}", said)
    particles = getattr(force, "particles", None)
    if particles is None:
        return scene, force
    count = system.slots.count
    if particles.size and int(particles.max()) >= count:
        said = f"particle {int(particles.max())} does not exist; there are {count}, counted from 0"
        raise InputError(f"{pointer}/particles", said)
    single = particles.ndim == 1 or particles.shape[1] == 1
    scene, place = addressed(system, scene, particles, points=single and "points" in type(force).model_fields)
    given: dict[str, Any] = {name: getattr(force, name) for name in force.model_fields_set if name != "particles"}
    return scene, type(force).model_validate({**given, **place})


def _of_patch(error: InputError, first: int) -> InputError:
    """A fault of an added force, by its place in the patch; `first` is the number of the first one."""
    found = re.match(r"/forces/(\d+)(.*)", error.pointer, re.DOTALL)
    if found is None or int(found[1]) < first:
        return error
    return InputError(f"/add/{int(found[1]) - first}{found[2]}", error.sentence)


def _carried(old: list[Group], memory: list[NDArray[np.float64]], new: list[Group]) -> list[NDArray[np.float64]]:
    """What elements remember, for other groups: those of a kind on the same particles are the same, in their order."""
    known: dict[tuple[type[Force], bytes], list[NDArray[np.float64]]] = {}
    for group, remembered in zip(old, memory, strict=True):
        for part in group.parts if remembered.shape[1] else ():
            key = (group.cls, group.block.indices[part.rows].tobytes())
            known.setdefault(key, []).append(remembered[part.rows])
    carried = [np.zeros_like(group.block.memory) for group in new]
    for group, fresh in zip(new, carried, strict=True):
        for part in group.parts if fresh.shape[1] else ():
            found = known.get((group.cls, group.block.indices[part.rows].tobytes()))
            if found:
                fresh[part.rows] = found.pop(0)
    return carried


def _turn_over(system: System, state: State, slots: Slots) -> None:
    """Give a system and its state other slots; particles that have orientations in both keep them."""
    if np.array_equal(slots.particles, system.slots.particles) and np.array_equal(slots.lengths, system.slots.lengths):
        return
    old, n = system.slots, system.slots.count
    system.x, system.v, system.mass = (slots.extended(rows[:n]) for rows in (system.x, system.v, system.mass))
    system.mass[n:] = 1.0
    system.mass[slots.first] = system.mass[slots.particles]
    before = replace(state)
    rows = (state.x, state.v, state.free)
    state.x, state.v, state.free = (slots.extended(a[:n], fill) for a, fill in zip(rows, (0.0, 0.0, 1.0), strict=True))
    slots.take_over(state, slots.particles, old, before, slots.particles)
    system.slots = slots
    slots.hold_references(state)
