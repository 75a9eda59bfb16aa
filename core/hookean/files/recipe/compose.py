"""The recipe that the rows of a draft make."""

from __future__ import annotations

import contextlib
import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from hookean.errors import InputError
from hookean.files.recipe import shapes
from hookean.files.recipe.drawing import Drawing, Item
from hookean.files.recipe.roles import FLOOR, ROLES, Part
from hookean.files.recipe.rows import Row
from hookean.files.recipe.select import select, terms


@dataclass(eq=False)
class _Table:
    """A table of the recipe, with the row and the objects that it is of."""

    row: int
    part: Part
    items: list[Item] = field(default_factory=list)


def recipe_of(rows: Sequence[Row], seen: Drawing, weld: float) -> tuple[dict[str, Any], dict[str, list[int]]]:
    """The recipe, and for each table of its groups the number of the row that it is of."""
    tables: dict[tuple[Any, ...], _Table] = {}
    tops = []
    for number, row in enumerate(rows):
        for entry in row.entries:
            role, values = (row.role, row.values) if entry.role is None else (entry.role, entry.values)
            kind = ROLES.get((row.family, role))
            if role == FLOOR:
                tops.append(entry.item.geometry.GetBoundingBox().Max.Z * seen.factor)
            if kind is None or entry.why:
                continue
            for part in kind.read(values).parts(entry.item, seen.units):
                key = (number, part.group, part.place, part.feature, json.dumps(part.table))
                tables.setdefault(key, _Table(number, part)).items.append(entry.item)
    groups: dict[str, list[_Table]] = {"forces": [], "anchors": [], "geometry": []}
    for table in tables.values():
        groups[table.part.group].append(table)
    recipe: dict[str, Any] = {"units": seen.units.model_dump(), "weld_tolerance": weld, "strict": False}
    led = [table for table in groups["forces"] if table.part.place in FEATURES]
    recipe |= {group: list(_written(found, seen, led)) for group, found in groups.items()}
    if tops:
        recipe["settings"] = {"floor": {"point": [0.0, 0.0, max(tops)]}}
    return recipe, {group: [table.row for table in found] for group, found in groups.items()}


GUIDES = ("curve", "target")
"""The places of what pulls and stays where it is."""
FEATURES = {"lines": {"edges": "ends", "all": "vertices"}, "mesh": {"edges": "rim", "all": "vertices"}}
"""By the place of an elastic force, the points of it that a guide pulls."""


def _written(tables: Sequence[_Table], seen: Drawing, led: Sequence[_Table]) -> Iterator[dict[str, Any]]:
    """Tables with their selectors, and names that differ; guides pull points of the elastic tables `led`."""
    used: dict[str, int] = {}
    for table in tables:
        part = table.part
        name = str(part.table["name"])
        used[name] = used.get(name, 0) + 1
        named = name if used[name] == 1 else f"{name}/{used[name]}"
        if part.place in GUIDES:
            selector = _selector(table.items, replace(part, feature=""), seen)
            yield {**part.table, "name": named, part.place: selector, "points": _pulled(part, seen, led)}
            continue
        selector = _selector(table.items, part, seen)
        yield {**part.table, "name": named, part.place: selector}


def _pulled(guide: Part, seen: Drawing, led: Sequence[_Table]) -> list[str]:
    """Selectors of the points that a guide pulls."""
    found: list[str] = []
    for table in led:
        items = [item for item in table.items if guide.layer in ("", item.layer)]
        if not items:
            continue
        part = Part("forces", {}, "points", FEATURES[table.part.place][guide.feature])
        selector = _selector(items, part, seen)
        found += [selector] if isinstance(selector, str) else selector
    if guide.layer and not found:
        return [f"vertices:layer:{guide.layer}"]  # which the file lacks, or nothing elastic is on: reported as that
    return list(dict.fromkeys(found))


def _selector(items: Sequence[Item], part: Part, seen: Drawing) -> Any:
    """A selector of exactly these objects: by their layer where that has no others that would be meant, or by ids."""
    front = f"{part.feature}:" if part.feature else ""
    if part.place == "points":
        divided = "divide" in part.table or part.table.get("kind") in ("polyline", "curve")
        fits, _ = shapes.points_from(part.feature, divided=divided)
    else:
        fits = shapes.is_curve if part.place in ("lines", "curve") else shapes.is_mesh
    text = f"{front}layer:{items[0].layer}"
    with contextlib.suppress(InputError):
        meant = terms(text, "")
        if len(meant) == 1 and [item for item in select(seen, meant[0], "") if fits(item)] == list(items):
            return text
    ids = [f"{front}id:{item.ids[-1]}" for item in items]
    return list(dict.fromkeys(ids)) if len(ids) > 1 else ids[0]
