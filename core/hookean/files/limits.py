"""Limits of results, and which of them are exceeded.

A limits file is TOML (or JSON). Limits of the whole model come first; `[force.NAME]`, `[layer.NAME]` and
`[anchor.NAME]` hold for a force (its name or kind; a support or a floor as well), a layer (path or name, sublayers
included) or an anchor:

    max_force = 250          # tension of any element
    min_force = -5           # compression
    max_strain = 0.02        # of either sign
    max_displacement = 0.1   # of any particle from its start
    max_reaction = 500       # of a support, or of a floor on a particle
    max_utilisation = 0.5    # part of the strength of any element
    max_stress = 235e6       # of lines and beams of a section, of either sign
    max_moment = 20          # bending of beams about either axis
    max_slack = 0            # number of tension-only elements that hang slack
    units = {length = "m", force = "kN"}   # without it those of the scene

    [layer.cables]
    max_force = 120

    [force.ground]           # a floor
    max_reaction = 20
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydantic import ValidationError

from hookean.analysis.load_cases import slack_elements
from hookean.errors import InputError
from hookean.files.tables import CARRIED, FLOOR, Floats, Section
from hookean.forces import KINDS
from hookean.forces.floor import Floor
from hookean.running.result import Result
from hookean.running.utilisation import NAME, STRESS
from hookean.system.system import System
from hookean.values.units import Units

LIMITS = {
    "max_force": "force",
    "min_force": "force",
    "max_strain": "",
    "max_displacement": "length",
    "max_reaction": "force",
    "max_utilisation": "",
    "max_stress": "force/length^2",
    "max_moment": "moment",
    "max_slack": "",
}
BENDING = ("My0", "Mz0", "My1", "Mz1")
NEEDED = {
    "max_force": "no element has a force along a line; give max_force for springs, cables or beams",
    "min_force": "no element has a force along a line; give min_force for springs, cables or beams",
    "max_strain": "no element has a strain; give max_strain for springs with a rest length",
    "max_reaction": "no anchor, support or floor has this name; give max_reaction for one of these",
    "max_utilisation": "no element has a known strength; give materials with strength, or strength, to the forces",
    "max_stress": "no element has a known section; give material and section to springs or beams, thickness to shells",
    "max_moment": "no element is a beam; give max_moment for beams",
}
"""Limits of what not every element has, and what to do where none has it."""
_SCOPES = ("force", "layer", "anchor")


def read_limits(text: str, name: str = "limits") -> dict[str, Any]:
    """Limits from TOML or JSON text; InputError where it is neither, names an unknown limit or has none."""
    from hookean.scene.text import parse_tables

    limits = parse_tables(text, name)
    _known(limits, f"{name} ", (*LIMITS, "units", *_SCOPES))
    for scope in _SCOPES:
        tables = limits.get(scope, {})
        if not isinstance(tables, dict):
            raise InputError(f"{name} /{scope}", f"give tables such as [{scope}.NAME]")
        for key, table in tables.items():
            _known(table, f"{name} /{scope}/{key}", tuple(LIMITS))
    scopes = [table for scope in _SCOPES for table in limits.get(scope, {}).values()]
    if not any(key in LIMITS for table in (limits, *scopes) for key in table):
        raise InputError(name, f"has no limit, so that nothing would be checked; give one of {', '.join(LIMITS)}")
    return limits


def _known(table: Any, pointer: str, allowed: tuple[str, ...]) -> None:
    if not isinstance(table, dict):
        raise InputError(pointer, "give a table of limits")
    for key, value in table.items():
        if key not in allowed:
            raise InputError(f"{pointer}/{key}", f"unknown limit; known: {', '.join(allowed)}")
        if key in LIMITS and (
            isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value)
        ):
            raise InputError(f"{pointer}/{key}", f"{value!r} given; give a number")


def exceeded(
    limits: Mapping[str, Any],
    parts: Sequence[Section],
    system: System,
    result: Result,
    name: str = "limits",
    source: str = "the file",
) -> list[str]:
    """A sentence for each limit that is exceeded; InputError where one names a force, layer or anchor that is not
    there, for it could never be exceeded."""
    try:
        units = Units.model_validate({**result.units.model_dump(), **limits.get("units", {})})
    except (ValidationError, TypeError):
        raise InputError(f"{name} /units", 'give a table such as {length = "m", force = "kN"}') from None
    found = _check("model", limits, [(p, np.ones(len(p.particles), bool)) for p in parts], system, result, units)
    for scope in _SCOPES:
        for key, table in limits.get(scope, {}).items():
            chosen = [(p, _mask(p, scope, key)) for p in parts]
            nothing = not any(mask.any() for _, mask in chosen)
            if nothing and not (scope == "force" and key in _floors(system)):
                there = f"has no such {scope}; it has {_there(parts, scope, system)}"
                raise InputError(f"{name} /{scope}/{key}", f"{source} {there}")
            if nothing and set(table) <= {"max_reaction", "max_displacement"}:
                continue  # nothing lies on the floor
            found += _check(f"{scope} {key}", table, chosen, system, result, units)
    return found


def _mask(part: Section, scope: str, key: str) -> NDArray[np.bool_]:
    count = len(part.particles)
    if scope == "layer":
        from hookean.files.recipe.select import on_layer

        good = [on_layer(item.layer, key) for item in part.items]
        return np.array([o >= 0 and good[o] for o in part.owner.tolist()], dtype=bool).reshape(count)
    if scope == "anchor":
        supports = part.names if part.kind == "reaction" else []
        return np.array([n == key for n in supports] or [False] * count, dtype=bool).reshape(count)
    if part.kind == "contact":  # of one or several floors
        return np.array([key == FLOOR or f", {key}, " in f", {said}, " for said in part.names], dtype=bool)
    # forces of one layer without a recipe are numbered: cables, cables/2
    base = re.sub(r"/\d+$", "", part.name)
    return np.full(count, part.kind not in CARRIED and key in (part.name, part.kind, base))


def _floors(system: System) -> list[str]:
    """What limits may call the floors of a scene: their names, and their kind."""
    floors = [f for f in (*system.scene.forces, system.scene.settings.floor) if isinstance(f, Floor)]
    return [name for floor in floors for name in (floor.name, FLOOR) if name]


def _there(parts: Sequence[Section], scope: str, system: System) -> str:
    from hookean.files.recipe.select import listed

    if scope == "layer":
        return listed(part.items[o].layer for part in parts for o in np.unique(part.owner) if o >= 0)
    if scope == "anchor":
        return listed(name for part in parts if part.kind == "reaction" for name in part.names if name)
    elements = (name for part in parts if part.kind not in CARRIED for name in (part.name, part.kind))
    return listed((*elements, *_floors(system)))


def _check(
    where: str,
    limits: Mapping[str, Any],
    chosen: Sequence[tuple[Section, NDArray[np.bool_]]],
    system: System,
    result: Result,
    units: Units,
) -> list[str]:
    moved = np.linalg.norm(result.particles - system.points, axis=1)
    found, whole = [], where == "model"
    for limit, dimension in LIMITS.items():
        if limit not in limits:
            continue
        if limit == "max_slack":
            found += _slack(where, limits[limit], chosen, system)
            continue
        scale = result.units.factor(dimension, units)
        worst, place = -math.inf, ""
        for part, mask in chosen:
            values = _values(part, limit, moved, whole)
            if values is None or not mask.any():
                continue
            at = int(np.flatnonzero(mask)[np.argmax(values[mask])])
            if float(values[at]) > worst:
                worst, place = float(values[at]), _spot(part, at, moved if limit == "max_displacement" else None)
        if limit in NEEDED and not place and not (whole and limit == "max_reaction"):
            raise InputError(f"{where} {limit}", NEEDED[limit])
        sign = -1.0 if limit == "min_force" else 1.0
        if worst * scale > sign * limits[limit]:
            unit = units.of(dimension)
            what = limit.replace("_", " ")
            below = "is below" if sign < 0 else "exceeds"
            value = f"{sign * worst * scale:.6g} {unit}".strip()
            found.append(f"{where}: {what} {value} at {place} {below} the limit {limits[limit]:g} {unit}".strip())
    return found


def _slack(where: str, limit: float, chosen: Sequence[tuple[Section, NDArray[np.bool_]]], system: System) -> list[str]:
    """A sentence if more elements than the limit hang slack."""
    places = []
    for part, mask in chosen:
        if part.number >= 0:
            rows = slack_elements(system.scene.forces[part.number], part.columns)
            places += [_spot(part, int(row)) for row in rows[mask[rows]]]
    if len(places) <= limit:
        return []
    return [f"{where}: {len(places)} elements are slack, the first is {places[0]}; at most {limit:g} may be"]


def _values(part: Section, limit: str, moved: Floats, whole: bool) -> Floats | None:
    """The value that a limit checks, the larger the worse; None if the section has no such value. Of the whole model
    elastic supports are among the reactions."""
    if limit == "max_displacement":
        far: Floats = moved[part.particles].max(axis=1, initial=0.0)
        return far
    if limit == "max_reaction":
        bears = part.kind in CARRIED or (not whole and KINDS[part.kind].bearing)
        return np.linalg.norm(part.columns["force"], axis=1) if bears else None
    if limit == "max_strain":
        return np.abs(part.columns["strain"]) if "strain" in part.columns else None
    if limit == "max_utilisation":
        return part.columns.get(NAME)
    if limit == "max_stress":
        return np.abs(part.columns[STRESS]) if STRESS in part.columns else None
    if limit == "max_moment":
        ends = [np.abs(part.columns[name]) for name in BENDING if name in part.columns]
        return np.max(ends, axis=0) if ends else None
    if not part.internal:
        return None
    return part.columns["force"] if limit == "max_force" else -part.columns["force"]


def _spot(part: Section, row: int, moved: Floats | None = None) -> str:
    """An element in words, and which of its particles has `moved` (n,) most, where that counts."""
    item = part.item(row)
    called = f" of {item.label}" if item is not None else ""
    if moved is not None:
        most = part.particles[row][np.argmax(moved[part.particles[row]])]
        return f"particle {most}{called or f' of {part.name}'}"
    thing = f"particle {part.particles[row, 0]}" if part.kind in CARRIED else f"element {row} of {part.name}"
    return thing + called
