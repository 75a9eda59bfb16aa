"""Patches: what may change while a system runs. Anchors, loads, stiffness, rest lengths, settings; never geometry."""

from __future__ import annotations

from typing import Any

import numpy as np
from pydantic import Field, StrictInt, StrictStr, ValidationError

from hookean.columns import Indices, Model, Points
from hookean.errors import InputError
from hookean.forces.base import PLACES
from hookean.scene import Anchor, Scene, Settings, first_fault
from hookean.state import State
from hookean.system import Floats, Group, Held, Part, System, hold


class Move(Model):
    """New targets for an anchor, by its name or its number in the scene."""

    anchor: StrictStr | StrictInt = Field(description="Name or number of an anchor")
    targets: Points = Field(description="Where its particles go [length], one each")


class Patch(Model):
    """One edit of a running system; everything in it lands together, or nothing does.

    `pin` holds particles (where they are, or at targets), `release` frees them, `move` retargets anchors; `forces`
    maps a force's name or number to new values of its columns; `settings` to new settings.
    """

    pin: tuple[Anchor, ...] = Field(default=(), description="Particles to hold from now on")
    release: Indices = Field(default=np.zeros(0, np.int64), description="Particles to free")
    move: tuple[Move, ...] = Field(default=(), description="Anchors to move")
    forces: dict[str, dict[str, Any]] = Field(default={}, description="New values by force and column")
    settings: dict[str, Any] = Field(default={}, description="New values of settings")

    @classmethod
    def read(cls, value: Any) -> Patch:
        """A patch from a dict; InputError with a pointer and one sentence."""
        if isinstance(value, Patch):
            return value
        try:
            return cls.model_validate(value)
        except ValidationError as error:
            raise first_fault(error) from None


class Undo:
    """Everything a patch may change, as it was before."""

    def __init__(self, system: System, state: State) -> None:
        self.scene, self.drag, self.held = system.scene, system.drag, system.held
        self._state = state.copy()
        self._groups = [
            (group.block.parameters.copy(), [part.force for part in group.parts])
            for group in system.groups + system.contacts
        ]

    def put_back(self, system: System, state: State) -> None:
        """Undo the patch."""
        system.scene, system.drag, system.held = self.scene, self.drag, self.held
        for group, (parameters, forces) in zip(system.groups + system.contacts, self._groups, strict=True):
            group.block.parameters[:] = parameters
            for part, force in zip(group.parts, forces, strict=True):
                part.force = force
        for name, value in vars(self._state).items():
            setattr(state, name, value)


def apply(system: System, state: State, patch: Patch) -> None:
    """Write a patch into a running system and raise its revision; InputError where it does not fit (see `Undo`)."""
    held = _held(system, state, patch)
    forces = _forces(system, patch)
    settings = _settings(system, patch)
    listed = tuple(forces.get(i, f) for i, f in enumerate(system.scene.forces))
    retune(system, state, system.scene.model_copy(update={"forces": listed, "settings": settings}), held)


def retune(system: System, state: State, scene: Scene, held: list[Held]) -> None:
    """Give a running system other parameters, settings and anchors; raises its revision. `scene` has the system's
    own places and elements; InputError where not, and then parts of it may have landed (see `Undo`)."""
    for group in system.groups + system.contacts:
        for part in group.parts:
            if part.number >= 0 and scene.forces[part.number] is not part.force:
                part.force = scene.forces[part.number]
                group.block.parameters[part.rows] = _rows(system, group, part)
    system.scene = scene
    system.drag = scene.settings.drag
    system.held = held
    state.free[:] = 1.0
    for anchor in held:
        hold(state, anchor)
    system.put_outside(state)
    state.revision += 1


def _rows(system: System, group: Group, part: Part) -> Floats:
    """Parameters of a changed force for the elements it had; InputError if it has others now."""
    fresh = system.places.recompile(part.number, part.force)
    met = (fresh.indices >= 0).all(axis=1)
    indices, parameters = fresh.indices[met], fresh.parameters[met]
    if not np.array_equal(indices, group.block.indices[part.rows]):
        raise InputError(f"/forces/{part.number}", "this changes which particles it acts on; send a new scene")
    return parameters


def _held(system: System, state: State, patch: Patch) -> list[Held]:
    """The anchors after the patch: moved, thinned by releases, joined by pins."""
    held = [Held(h.number, h.particles, h.targets.copy(), h.free, h.name) for h in system.held]
    for i, move in enumerate(patch.move):
        anchor = _named(held, move.anchor, f"/move/{i}/anchor")
        if len(move.targets) != len(anchor.particles):
            raise InputError(
                f"/move/{i}/targets",
                f"{len(move.targets)} targets for {len(anchor.particles)} particles; give one for each",
            )
        anchor.targets = np.array(move.targets)
    _exist(patch.release, len(state.x), "/release")
    for h in held:
        _thin(h, patch.release)
    for i, pin in enumerate(patch.pin):
        if pin.particles is None:
            raise InputError(f"/pin/{i}", "a running system pins particles by number; give particles")
        _exist(pin.particles, len(state.x), f"/pin/{i}/particles")
        targets = state.x[pin.particles] if pin.targets is None else np.array(pin.targets)
        free = np.array([0.0 if axis in pin.axes else 1.0 for axis in "xyz"])
        for h in held:
            if (free <= h.free).all():  # the pin holds all that this one held
                _thin(h, pin.particles)
        held.append(Held(-1, np.array(pin.particles), targets, free, pin.name))
    return [h for h in held if h.number >= 0 or len(h.particles)]


def _thin(anchor: Held, particles: Any) -> None:
    stays = ~np.isin(anchor.particles, particles)
    anchor.particles, anchor.targets = anchor.particles[stays], np.ascontiguousarray(anchor.targets[stays])


def _named(held: list[Held], wanted: str | int, pointer: str) -> Held:
    """The one anchor of a name or number."""
    found = [h for h in held if (h.name == wanted and wanted != "") or (h.number == wanted and h.number >= 0)]
    if len(found) == 1:
        return found[0]
    if found:
        raise InputError(pointer, f"{len(found)} anchors are called {wanted!r}; say which by number")
    names = ", ".join(repr(h.name) for h in held if h.name)
    numbers = ", ".join(str(h.number) for h in held if h.number >= 0)
    raise InputError(pointer, f"{wanted!r} is no anchor; there are {names or 'no names'}, numbers {numbers or 'none'}")


def _exist(particles: Any, count: int, pointer: str) -> None:
    if len(particles) and int(np.max(particles)) >= count:
        place = int(np.argmax(particles))
        given = int(particles[place])
        raise InputError(f"{pointer}/{place}", f"particle {given} does not exist; there are {count}, counted from 0")


def _forces(system: System, patch: Patch) -> dict[int, Any]:
    """The changed forces by number, validated as if they had been given so at first."""
    scene = system.scene
    changed: dict[int, Any] = {}
    for key, values in patch.forces.items():
        named = [i for i, f in enumerate(scene.forces) if f.name == key and key]
        numbered = int(key) if key.isascii() and key.isdigit() else -1
        if len(named) > 1:
            raise InputError(f"/forces/{key}", f"{len(named)} forces have this name; say which by number")
        number = named[0] if named else numbered
        if not 0 <= number < len(scene.forces):
            names = ", ".join(repr(f.name) for f in scene.forces if f.name) or "no names"
            raise InputError(
                f"/forces/{key}", f"no force of this name or number; there are {names} and {len(scene.forces)} forces"
            )
        fixed = [n for n in values if n in (*PLACES, "kind", "edges")]
        if fixed:
            raise InputError(f"/forces/{key}/{fixed[0]}", "cannot change while it runs; send the changed scene anew")
        old = changed.get(number, scene.forces[number])
        given = {n: getattr(old, n) for n in old.model_fields_set}
        try:
            changed[number] = type(old).model_validate({**given, **values})
        except ValidationError as error:
            fault = first_fault(error)
            raise InputError(f"/forces/{key}{fault.pointer}", fault.sentence) from None
    return changed


def _settings(system: System, patch: Patch) -> Settings:
    old = system.scene.settings
    for name in patch.settings:
        if name == "floor":
            raise InputError("/settings/floor", "cannot change while it runs; send the changed scene anew")
    try:
        return Settings.model_validate({**{n: getattr(old, n) for n in old.model_fields_set}, **patch.settings})
    except ValidationError as error:
        fault = first_fault(error)
        raise InputError(f"/settings{fault.pointer}", fault.sentence) from None
