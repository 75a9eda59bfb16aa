"""The rows of a drafted recipe: the objects of one family on one layer, with their role and values by guess."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from hookean.errors import InputError
from hookean.files.recipe import convention, shapes
from hookean.files.recipe.drawing import Drawing, Item, above
from hookean.files.recipe.roles import FAMILIES, FLOOR, IGNORE, ROLES, Role, SpringRole, told, usable
from hookean.files.rhino.model import SEPARATOR
from hookean.values.units import Units

WORDS = {
    "cables": ("cable", "rope", "wire", "stay", "tie", "seil", "tendon", "ridge", "valley"),
    "springs": ("spring", "strut", "bar", "beam", "rod", "stab"),
    "membrane": ("membrane", "net", "fabric", "cloth", "textile", "sail", "roof", "canopy", "skin", "surface"),
    "anchors": ("anchor", "support", "fix", "fixed", "pin", "hold", "foundation", "base"),
    "loads": ("load", "force"),
    "floor": ("floor", "ground"),
}
"""Words in the name of a layer that suggest a role, in the singular."""
IN_FAMILY = {
    "springs": {"curves": "springs", "surfaces": "net"},
    "cables": {"curves": "cables"},
    "membrane": {"surfaces": "net"},
    "anchors": dict.fromkeys(FAMILIES, "anchors"),
    "loads": {"points": "loads", "curves": "loads"},
    "geometry": dict.fromkeys(FAMILIES, "geometry"),
    "floor": dict.fromkeys(FAMILIES, FLOOR),
}
"""For a role that a layer name means the roles of each family."""
AS_DRAWN = {"points": "anchors", "curves": "springs", "surfaces": "net"}
CLOSED = "closed, so it has no edge to hold; hold all of it, or anchor some of it"


@dataclass(eq=False)
class Entry:
    """An object of a row: `role` and `values` that are its own, by its user text or by choice, or None; `why` it is
    left out though its role is another."""

    item: Item
    role: str | None = None
    values: dict[str, Any] = field(default_factory=dict)
    why: str = ""


@dataclass(eq=False)
class Row:
    """Objects of one family on one layer, with their role and its values; `becomes` has what of, in words."""

    layer: str
    family: str
    entries: list[Entry]
    role: str = IGNORE
    values: dict[str, Any] = field(default_factory=dict)
    becomes: list[str] = field(default_factory=list)

    @property
    def items(self) -> list[Item]:
        """Its objects in the order of the file."""
        return [entry.item for entry in self.entries]


def rows_of(seen: Drawing) -> list[Row]:
    """The visible objects of a file by layer and family, in the order of the file."""
    rows: dict[tuple[str, str], Row] = {}
    for item in seen.items:
        family = next((name for name, fits in FAMILIES.items() if fits(item)), "")
        row = rows.setdefault((item.layer, family), Row(item.layer, family, []))
        row.entries.append(Entry(item))
    return list(rows.values())


def guess(rows: Sequence[Row]) -> None:
    """Give every row the role that its layer means, exactly or by a word of its name; without any such layer that of
    its kind of objects."""
    meant = [_meaning(row.items[0]) for row in rows]
    for row, meaning in zip(rows, meant, strict=True):
        by_kind = IGNORE if any(meant) else AS_DRAWN.get(row.family, IGNORE)
        row.role = IN_FAMILY[meaning].get(row.family, IGNORE) if meaning else by_kind


def _meaning(item: Item) -> str:
    """The role that the layers of an item mean; "" for none."""
    exact = convention.role_of(item)
    if exact:
        return exact
    for layer in item.layers:
        for path in above(layer):
            parts = re.findall(r"[^\W\d_]+", re.sub(r"(?<=[a-z])(?=[A-Z])", " ", path.rpartition(SEPARATOR)[2]))
            words = {form for part in parts for form in (part.casefold(), part.casefold().removesuffix("s"))}
            for role, known in WORDS.items():
                if words.intersection(known):
                    return role
    return ""


def fill(row: Row, rows: Sequence[Row], seen: Drawing, weld: float | None, guessed: bool) -> None:
    """The values of a row where nobody gives any. With a `weld` tolerance loose ends and edges are held; a closed
    surface, which has no edge, is then left out where others are not, or the role is `guessed`."""
    kind = ROLES.get((row.family, row.role))
    row.values = {} if kind is None else kind.defaults(seen.units)
    if row.role == "net" and convention.role_of(row.items[0]) == "springs":
        row.values["rest_factor"] = 1.0
    if kind is None or not kind.elastic or weld is None:
        return
    if row.family == "curves":
        others = [i for r in rows if r is not row and r.role in ("springs", "cables") for i in r.items]
        loose = shapes.loose(_pieces(row.items, seen), _pieces(others, seen), weld)
        row.values["held"] = "loose ends" if len(loose.array) else "nothing"
        return
    closed = [entry for entry in row.entries if _closed(entry.item, kind(), seen)]
    row.values["held"] = "edges" if len(closed) < len(row.entries) else "nothing"
    for entry in closed if guessed or len(closed) < len(row.entries) else []:
        entry.role, entry.why = IGNORE, CLOSED
    if len(closed) == len(row.entries) and guessed:
        row.role, row.values = IGNORE, {}


def _pieces(items: Sequence[Item], seen: Drawing) -> shapes.Shape:
    """The lines of curves as springs have them, without what cannot be springs."""
    role, found = SpringRole(), []
    for item in items:
        if not usable(role, item):
            lines = shapes.lines_of(item, role.split(item), "") * seen.factor
            found.append(shapes.Shape((item,), lines, np.zeros(len(lines), np.int64)))
    return shapes.concatenated(found, 3)


def _closed(item: Item, role: Role, seen: Drawing) -> bool:
    """Whether a surface has no edge."""
    if usable(role, item):
        return False
    shape = shapes.joined([item], [shapes.mesh_of(item, role.split(item), "")], 1.0)
    size = float(np.ptp(shape.array, axis=0).max())
    return not len(shapes.mesh_points(shape, "naked", max(seen.model.tolerance, 1e-9 * size)).array)


def own(row: Row, units: Units) -> None:
    """The values that the user text of objects gives, and why an object cannot have the role."""
    kind = ROLES.get((row.family, row.role))
    if kind is None:
        return
    for entry in row.entries:
        if entry.role is not None:
            continue
        values = {**row.values, **told(kind, entry.item, units)}
        try:
            role = kind.read(values)
        except InputError as error:
            raise InputError(f"{entry.item.label}, user text {error.pointer.strip('/')}", error.sentence) from None
        if values != row.values:
            entry.role, entry.values = row.role, values
        entry.why = usable(role, entry.item)
