"""Patches: what may change while a system runs. Anchors, loads, stiffness, rest lengths, settings, which forces act on
its particles; never the particles themselves."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import StrictInt, StrictStr, ValidationError, model_validator

from hookean.errors import InputError
from hookean.forces.base import PLACES, Rider
from hookean.scene.scene import Anchor, AnyForce, Scene, Settings
from hookean.system.group import Group, Part, fitted, ride
from hookean.system.state import State
from hookean.system.system import Floats, Held, System, axes_free
from hookean.system.wiring import rewire, with_forces
from hookean.values.columns import Indices, Model, Points, Vector, fault
from hookean.values.faults import first_fault
from hookean.values.fields import Field, Maybe, Parts

Ints = NDArray[np.int64]


class Move(Model):
    """An anchor moved, by its name or its number in the scene: to targets, or as a whole by a shift."""

    anchor: StrictStr | StrictInt = Field(description="Name or number of an anchor")
    targets: Maybe[Points] = Field(default=None, description="New positions of its particles [length], one each")
    shift: Maybe[Vector] = Field(default=None, description="Shift from where the scene holds them [length]")

    @model_validator(mode="after")
    def _one_way(self) -> Self:
        if (self.targets is None) == (self.shift is None):
            raise fault("give exactly one of targets, shift")
        return self


class Patch(Model):
    """One edit of a running system; everything in it lands together, or nothing does.

    `pin` holds particles, where they are or at targets (one that an anchor holds on the same axes stays with it, unless
    the pin has a name); `release` frees them; `move` retargets anchors; `forces` maps a force's name or number to new
    values of its columns; `materials` and `sections` map names to new values, which all forces of that name get;
    `settings` to new settings. `remove` takes forces away and `add` puts others behind the last
    one, on particles that are there already; names and numbers of forces are those before the patch.
    """

    pin: Parts[Anchor] = Field(default=(), description="Particles to hold")
    release: Indices = Field(default=np.zeros(0, np.int64), description="Particles to release")
    move: Parts[Move] = Field(default=(), description="Anchors to move")
    forces: dict[str, dict[str, Any]] = Field(default={}, description="New values by force and column")
    materials: dict[str, dict[str, Any]] = Field(default={}, description="New values by material")
    sections: dict[str, dict[str, Any]] = Field(default={}, description="New values by section")
    settings: dict[str, Any] = Field(default={}, description="New values of settings")
    add: Parts[AnyForce] = Field(default=(), description="Forces to add, on existing particles")
    remove: tuple[StrictStr | StrictInt, ...] = Field(default=(), description="Names or numbers of forces to remove")

    @property
    def rewires(self) -> bool:
        """Whether forces come or go."""
        return bool(self.add or self.remove)

    @property
    def is_of_anchors(self) -> bool:
        """Whether it leaves forces, their materials and settings as they are."""
        return not (self.forces or self.materials or self.sections or self.settings or self.rewires)


def apply(system: System, state: State, patch: Patch) -> None:
    """Write a patch into a running system and raise its revision; InputError where it does not fit (see `Before`)."""
    held = _held(system, state, patch)
    _named_once(system.scene, patch.forces)
    forces = changed_forces(system.scene, patch.forces)
    made = changed_materials(system.scene, patch)
    forces.update(_made_of(system.scene, forces, patch))
    scene = _with(system.scene, forces).replaced(settings=_settings(system, patch), **made)
    if patch.rewires:
        removed = [_numbered(system.scene, wanted, f"/remove/{i}") for i, wanted in enumerate(patch.remove)]
        scene = with_forces(system, scene, patch.add, removed)
        rewire(system, state, scene, added=len(patch.add))
    retune(system, state, scene, held)


def retune(system: System, state: State, scene: Scene, held: list[Held]) -> None:
    """Give a running system other parameters, settings and anchors; raises its revision. `scene` has the system's
    own places and elements; InputError where not, and then parts of it may have landed (see `Before`)."""
    system.held = held
    _put_forces(system, scene)
    system.drag = scene.settings.drag
    system.slots.fold(state)
    system.hold(state)
    system.put_outside(state)
    state.force_scale = np.zeros(0)  # that of other parameters
    state.revision += 1


def lead_forces(system: System, forces: Mapping[int, Any]) -> None:
    """Give a running system changed forces, by number; its revision stays."""
    _put_forces(system, _with(system.scene, forces))


def take_again(system: System, scene: Scene) -> None:
    """Give a running system all forces of a scene whose drawn form has changed; its revision stays."""
    _put_forces(system, scene, whole=True)


def _with(scene: Scene, forces: Mapping[int, Any]) -> Scene:
    return scene.replaced(forces=tuple(forces.get(i, f) for i, f in enumerate(scene.forces)))


def _put_forces(system: System, scene: Scene, *, whole: bool = False) -> None:
    system.places.take_materials(scene)
    changed = whole
    for group in system.all_groups:
        for part in group.parts:
            if part.number >= 0 and (whole or scene.forces[part.number] is not part.force):
                part.force, changed = scene.forces[part.number], True
                group.block.parameters[part.rows] = _rows(system, group, part)
    system.brace(changed=changed)
    system.scene = scene


def _rows(system: System, group: Group, part: Part) -> Floats:
    """Parameters of a changed force for the elements it had; InputError if it has others now."""
    fresh = system.places.recompile(part.number, part.force)
    made = part.number, part.force, fresh.some(np.flatnonzero((fresh.indices >= 0).all(axis=1))), part.inputs
    if issubclass(group.cls, Rider):
        made = ride(system.slots, group.cls, (*made[:3], np.arange(len(made[2].indices))))
    else:
        made = fitted(system.slots, group.cls, made)
    indices, parameters = made[2].indices, made[2].parameters
    if not np.array_equal(indices, group.block.indices[part.rows]):
        raise InputError(f"/forces/{part.number}", "this field sets which particles it acts on; send a new scene")
    if not issubclass(group.cls, Rider) and part.force.compiled_as is not group.cls:
        raise InputError(f"/forces/{part.number}", "this field sets how it acts; send a new scene")
    if fresh.rooms:  # its elements stay in the room they have
        column = fresh.names.index("room")
        parameters[:, column] = group.block.parameters[part.rows, column]
    return parameters


def _held(system: System, state: State, patch: Patch) -> list[Held]:
    """The anchors after the patch: moved, thinned by releases, joined by pins."""
    held = [replace(h, targets=h.targets.copy()) for h in system.held]
    moved: list[Held] = []
    for i, move in enumerate(patch.move):
        anchor = named(held, move.anchor, f"/move/{i}/anchor")
        if any(anchor is other for other in moved):
            raise InputError(f"/move/{i}/anchor", f"anchor {move.anchor!r} is moved twice; give one move for it")
        moved.append(anchor)
        if move.shift is not None:
            anchor.targets = home(system, anchor, f"/move/{i}/shift") + move.shift
        elif move.targets is not None and len(move.targets) == len(anchor.particles):
            anchor.targets = np.array(move.targets)
        elif move.targets is not None:
            raise InputError(
                f"/move/{i}/targets",
                f"{len(move.targets)} targets for {len(anchor.particles)} particles; give one for each",
            )
    _exist(patch.release, system.slots.count, "/release")
    for h in held:
        _thin(h, patch.release)
    for i, pin in enumerate(patch.pin):
        if pin.particles is None:
            raise InputError(f"/pin/{i}", "a running system pins particles by number; give particles")
        _exist(pin.particles, system.slots.count, f"/pin/{i}/particles")
        targets = state.x[pin.particles] if pin.targets is None else np.array(pin.targets)
        free, turning = axes_free(pin.axes), axes_free(pin.rotations)
        both = np.concatenate([free, turning])
        new = np.ones(len(pin.particles), bool)
        for h in held:
            own = np.concatenate([h.free, h.turning])
            if (both == own).all() and not pin.name:
                new &= ~_lead(h, np.array(pin.particles), targets)
            elif (both <= own).all():  # the pin holds all that this one held
                _thin(h, pin.particles)
        if new.any() or pin.name:
            at, there = np.array(pin.particles)[new], np.ascontiguousarray(targets[new])
            held.append(Held(-1, at, there, free, pin.name, turning))
    return [h for h in held if h.number >= 0 or len(h.particles)]


def _lead(anchor: Held, particles: Ints, targets: Floats) -> NDArray[np.bool_]:
    """Give those of the particles that an anchor holds their targets; which of them it holds."""
    if not len(anchor.particles):
        return np.zeros(len(particles), bool)
    order = np.argsort(anchor.particles)
    place = np.searchsorted(anchor.particles, particles, sorter=order)
    rows = order[np.minimum(place, len(order) - 1)]
    met: NDArray[np.bool_] = anchor.particles[rows] == particles
    anchor.targets[rows[met]] = targets[met]
    return met


def _thin(anchor: Held, particles: Any) -> None:
    stays = ~np.isin(anchor.particles, particles)
    anchor.particles, anchor.targets = anchor.particles[stays], np.ascontiguousarray(anchor.targets[stays])


def home(system: System, held: Held, pointer: str) -> Floats:
    """Where the scene holds an anchor's particles (n, 3) [length]; InputError for one that the scene does not have."""
    if held.number < 0:
        raise InputError(pointer, "this anchor was pinned during the run and has no place in the scene; give targets")
    anchor = system.scene.anchors[held.number]
    if anchor.targets is None:
        return system.x[held.particles]
    at = anchor.particles
    if at is None:
        at = system.places.meet(np.asarray(anchor.points))
    rows = {int(particle): row for row, particle in enumerate(at)}
    return np.asarray(anchor.targets)[[rows[int(particle)] for particle in held.particles]]


def named(held: list[Held], wanted: str | int, pointer: str) -> Held:
    """The one anchor of a name or number."""
    found = [h for h in held if (h.name == wanted and wanted != "") or (h.number == wanted and h.number >= 0)]
    if len(found) == 1:
        return found[0]
    if found:
        raise InputError(pointer, f"{len(found)} anchors have the name {wanted!r}; select one by number")
    names = ", ".join(repr(h.name) for h in held if h.name)
    numbers = ", ".join(str(h.number) for h in held if h.number >= 0)
    raise InputError(
        pointer, f"unknown anchor {wanted!r}; there are {names or 'no names'}, numbers {numbers or 'none'}"
    )


def _exist(particles: Any, count: int, pointer: str) -> None:
    if len(particles) and int(np.max(particles)) >= count:
        place = int(np.argmax(particles))
        given = int(particles[place])
        raise InputError(f"{pointer}/{place}", f"particle {given} does not exist; there are {count}, counted from 0")


def changed_forces(scene: Scene, given_values: Mapping[str, Mapping[str, Any]]) -> dict[int, Any]:
    """Forces by number with new values of columns, validated as if they had been given so at first."""
    changed: dict[int, Any] = {}
    for key, values in given_values.items():
        number = _numbered(scene, key, f"/forces/{key}")
        fixed = [n for n in values if n in (*PLACES, "kind", "edges")]
        if fixed:
            raise InputError(f"/forces/{key}/{fixed[0]}", "cannot change during a run; send the changed scene")
        old = changed.get(number, scene.forces[number])
        given = {n: getattr(old, n) for n in old.model_fields_set}
        try:
            changed[number] = type(old).model_validate({**given, **values})
        except ValidationError as error:
            fault = first_fault(error)
            raise InputError(f"/forces/{key}{fault.pointer}".rstrip("/"), fault.sentence) from None
    return changed


def changed_materials(scene: Scene, patch: Patch) -> dict[str, dict[str, Any]]:
    """The scene's materials and sections with the new values of a patch; InputError for what it does not have."""
    found: dict[str, dict[str, Any]] = {}
    for group in ("materials", "sections"):
        given = getattr(patch, group)
        if not given:
            continue
        found[group] = dict(getattr(scene, group))
        for name, values in given.items():
            old = found[group].get(name)
            if old is None:
                known = ", ".join(repr(n) for n in found[group]) or "none"
                said = f"the scene has no {group[:-1]} of its own with this name; there are {known}"
                raise InputError(f"/{group}/{name}", said)
            try:
                found[group][name] = old.model_copy(update=values)
            except InputError as error:
                raise InputError(f"/{group}/{name}{error.pointer}".rstrip("/"), error.sentence) from None
    return found


def _made_of(scene: Scene, forces: Mapping[int, Any], patch: Patch) -> dict[int, Any]:
    """The forces that are made of a changed material or section, as others, so that they are compiled again."""
    found = {}
    for number, force in enumerate(scene.forces):
        force = forces.get(number, force)
        if vars(force).get("material") in patch.materials or vars(force).get("section") in patch.sections:
            found[number] = force.replaced()
    return found


def _numbered(scene: Scene, wanted: str | int, pointer: str) -> int:
    """The number of the one force of a name or number; a name that is a number counts as one where no force has it."""
    key = str(wanted)
    named = [i for i, f in enumerate(scene.forces) if f.name == wanted and key]
    if len(named) > 1:
        raise InputError(pointer, f"{len(named)} forces have this name; select one by number")
    number = named[0] if named else int(key) if key.isascii() and key.isdigit() else -1
    if not 0 <= number < len(scene.forces):
        names = ", ".join(repr(f.name) for f in scene.forces if f.name) or "no names"
        raise InputError(pointer, f"no force of this name or number; there are {names} and {len(scene.forces)} forces")
    return number


def _named_once(scene: Scene, given: Mapping[str, Any]) -> None:
    """InputError where two keys mean one force: one of two values for a column would be lost."""
    keys: dict[int, str] = {}
    for key in given:
        first = keys.setdefault(_numbered(scene, key, f"/forces/{key}"), key)
        if first != key:
            said = f"force {first!r}, given here too, is the same force; give all its columns under one of the two"
            raise InputError(f"/forces/{key}", said)


def _settings(system: System, patch: Patch) -> Settings:
    old = system.scene.settings
    for name in patch.settings:
        if name == "floor":
            raise InputError("/settings/floor", "cannot change during a run; send the changed scene")
    kept = {n: getattr(old, n) for n in old.model_fields_set}
    try:
        return Settings.model_validate({**kept, **Settings.changes(patch.settings)})
    except ValidationError as error:
        fault = first_fault(error)
        raise InputError(f"/settings{fault.pointer}".rstrip("/"), fault.sentence) from None
