"""Patches: what may change while a system runs. Anchors, loads, stiffness, rest lengths, settings; never geometry."""

from __future__ import annotations

from typing import Any

import numpy as np
from pydantic import Field, ValidationError

from hookean.columns import Indices, Model, Points
from hookean.errors import InputError
from hookean.forces.base import PLACES
from hookean.scene import Anchor, Settings, first_fault
from hookean.state import State
from hookean.system import Held, System, hold


class Move(Model):
    """New targets for an anchor, by its name or its number in the scene."""

    anchor: str | int = Field(description="Name or number of an anchor")
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


def apply(system: System, state: State, patch: Patch) -> None:
    """Write a patch into a running system and raise its revision. InputError leaves both untouched."""
    held = _held(system, state, patch)
    forces = _forces(system, patch)
    settings = _settings(system, patch)
    blocks = {number: system.places.recompile(number, force) for number, force in forces.items()}
    for group in system.groups + system.contacts:
        for part in group.parts:
            if part.number in blocks:
                part.force = forces[part.number]
                fresh = blocks[part.number]
                group.block.parameters[part.rows] = fresh.parameters[part.inputs]
    listed = tuple(forces.get(i, f) for i, f in enumerate(system.scene.forces))
    system.scene = system.scene.model_copy(update={"forces": listed, "settings": settings})
    system.drag = settings.drag
    system.held = held
    state.free[:] = 1.0
    for anchor in held:
        hold(state, anchor)
    state.revision += 1


def _held(system: System, state: State, patch: Patch) -> list[Held]:
    """The anchors after the patch: moved, thinned by releases, joined by pins."""
    held = [Held(h.number, h.particles, h.targets.copy(), h.free) for h in system.held]
    names = [a.name for a in system.scene.anchors]
    for i, move in enumerate(patch.move):
        number = names.index(move.anchor) if move.anchor in names else move.anchor
        chosen = [h for h in held if h.number == number]
        if not chosen:
            known = ", ".join(repr(n) for n in names if n) or f"numbers 0 to {len(names) - 1}"
            raise InputError(f"/move/{i}/anchor", f"{move.anchor!r} is no anchor of the scene; it has {known}")
        if len(move.targets) != len(chosen[0].particles):
            raise InputError(
                f"/move/{i}/targets",
                f"{len(move.targets)} targets for {len(chosen[0].particles)} particles; give one for each",
            )
        chosen[0].targets = np.array(move.targets)
    _exist(patch.release, len(state.x), "/release")
    for h in held:
        stays = ~np.isin(h.particles, patch.release)
        h.particles, h.targets = h.particles[stays], np.ascontiguousarray(h.targets[stays])
    for i, pin in enumerate(patch.pin):
        if pin.particles is None:
            raise InputError(f"/pin/{i}", "a running system pins particles by number; give particles")
        _exist(pin.particles, len(state.x), f"/pin/{i}/particles")
        targets = state.x[pin.particles] if pin.targets is None else np.array(pin.targets)
        free = np.array([0.0 if axis in pin.axes else 1.0 for axis in "xyz"])
        held.append(Held(-1, np.array(pin.particles), targets, free))
    return held


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
        names = [f.name for f in scene.forces]
        number = names.index(key) if key in names else int(key) if key.isdigit() else -1
        if not 0 <= number < len(names):
            known = ", ".join(repr(n) for n in names if n) or f"numbers 0 to {len(names) - 1}"
            raise InputError(f"/forces/{key}", f"no force of this name or number; the scene has {known}")
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
