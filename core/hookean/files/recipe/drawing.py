"""A .3dm file as a recipe sees it: visible objects with blocks expanded, and the units it is solved in."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any
from uuid import UUID

from pydantic import ValidationError

from hookean.errors import InputError
from hookean.files.rhino.model import SEPARATOR, Model, Object, expand
from hookean.values.units import METRES, Units

UNIT_NAMES = {
    "Millimeters": "mm",
    "Centimeters": "cm",
    "Decimeters": "dm",
    "Meters": "m",
    "Kilometers": "km",
    "Inches": "in",
    "Feet": "ft",
    "Yards": "yd",
}
"""hookean's unit for each Rhino unit system it shares."""

NO_LAYER = "(no layer)"
UNSTATED = "not stated"
"""The unit system of a model whose file states none."""


@dataclass(frozen=True, eq=False)
class Item:
    """An object to select: its geometry in file units, `id` as a person finds it in Rhino (of the instance for
    a member of a block), `ids`, `names` and `layers` by which selectors find it."""

    id: UUID
    name: str
    layer: str
    geometry: Any
    kind: str
    text: Mapping[str, str]
    locked: bool
    ids: tuple[UUID, ...]
    names: tuple[str, ...]
    layers: tuple[str, ...]
    made: dict[Any, Any] = field(default_factory=dict)  # what was made of it already, for it is asked for often

    @property
    def label(self) -> str:
        """How messages call it."""
        named = f'"{self.name}" ' if self.name else ""
        return f"{self.kind} {named}({self.id}) on layer {self.layer or NO_LAYER}"


@dataclass(frozen=True, eq=False)
class Drawing:
    """What there is to select from, and `factor`: a length in file units times it is one in `units`.

    `hidden` objects are left out, `paper` ones lie in layouts, `own` ones were added by hookean.
    """

    model: Model
    items: tuple[Item, ...]
    hidden: tuple[Item, ...]
    paper: int
    own: int
    instances: int
    units: Units
    factor: float
    unit: str
    said: str

    @cached_property
    def by_id(self) -> dict[UUID, list[Item]]:
        """Items, hidden ones too, by each of their ids."""
        found: dict[UUID, list[Item]] = {}
        for item in (*self.items, *self.hidden):
            for id in item.ids:
                found.setdefault(id, []).append(item)
        return found

    @cached_property
    def visible(self) -> frozenset[Item]:
        """The items as a set."""
        return frozenset(self.items)

    @property
    def tolerance(self) -> float:
        """The file's absolute tolerance in the scene's length unit."""
        given = self.model.tolerance * self.factor
        return given if math.isfinite(given) and given > 0 else 1e-3 * self.factor


def drawing(model: Model, units: Any = None, *, hidden: bool = False) -> Drawing:
    """The objects of a model and the units to solve in; `units` as a recipe gives them, or None.

    Raises InputError if the units are unknown to hookean or a block cannot be expanded.
    """
    kept: list[Item] = []
    unseen: list[Item] = []
    paper = instances = 0
    for item in model.foreign():
        if item.page:
            paper += 1
            continue
        if item.is_instance:
            instances += 1
        for member in expand(model, [item]):
            (kept if member.visible or hidden else unseen).append(_item(item, member))
    chosen, factor, unit, said = _units(model, units)
    own = len(model.objects) - len(model.foreign())
    return Drawing(model, tuple(kept), tuple(unseen), paper, own, instances, chosen, factor, unit, said)


def _item(outer: Object, member: Object) -> Item:
    return Item(
        id=outer.id,
        name=member.name or outer.name,
        layer=member.layer,
        geometry=member.geometry,
        kind=member.kind,
        text=member.user_text,
        locked=member.locked,
        ids=(outer.id,) if outer.id == member.id else (outer.id, member.id),
        names=tuple(dict.fromkeys((member.name, outer.name))),
        layers=tuple(dict.fromkeys((member.layer, outer.layer))),
    )


def _units(model: Model, given: Any) -> tuple[Units, float, str, str]:
    """Units to solve in, what file lengths are multiplied by, the file's unit in words, and a sentence."""
    if given is not None and not isinstance(given, Mapping):
        raise InputError("/units", 'give a table such as {length = "m", force = "kN"}')
    wanted = dict(given or {})
    own = UNIT_NAMES.get(model.unit)
    wanted.setdefault("length", own or "m")
    try:
        units = Units.model_validate(wanted)
    except ValidationError as error:
        from hookean.values.faults import first_fault

        found = first_fault(error)
        raise InputError(f"/units{found.pointer}", found.sentence) from None
    if model.unit == UNSTATED:
        return units, 1.0, units.length, f"the file states no unit: its numbers are read as {units.length}"
    if model.metres is None:
        said = f"the unit system of the file ({model.unit}) is unknown: its numbers are read as {units.length}"
        return units, 1.0, units.length, said
    # a quotient of two inexact metres would not be exactly 1 for equal units
    factor = 1.0 if own == units.length else model.metres / METRES[units.length]
    unit = own or model.unit.lower()
    if own is None:
        said = f"the file is in {unit}, which hookean does not solve in: solved in {units.length}, written back"
        return units, factor, unit, said
    said = f"the file is in {unit}"
    if own != units.length:
        said += f", solved in {units.length} (1 {unit} = {factor:.10g} {units.length}) and written back in {unit}"
    return units, factor, unit, said


def layers_of(items: tuple[Item, ...]) -> list[str]:
    """Paths of the layers that hold items, in order of appearance."""
    return list(dict.fromkeys(item.layer or NO_LAYER for item in items))


def above(path: str) -> list[str]:
    """A layer path and those above it, nearest first."""
    parts = path.split(SEPARATOR)
    return [SEPARATOR.join(parts[:n]) for n in range(len(parts), 0, -1)]
