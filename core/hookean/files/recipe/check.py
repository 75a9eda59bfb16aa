"""Faults of a recipe that are reported before any selector is used: unknown names and values of the wrong type."""

from __future__ import annotations

import difflib
import re
from collections.abc import Mapping
from typing import Any

from hookean.errors import InputError

LOAD = "unary (a load on each of its points) or self_weight"
KINDS_MEANT = {
    "load": LOAD, "loads": LOAD, "gravity": LOAD, "weight": LOAD, "force": LOAD,
    "cable": "springs", "cables": "springs", "membrane": "springs", "net": "springs",
}  # fmt: skip
FIELDS_MEANT = {
    "surface": "mesh", "surfaces": "mesh", "brep": "mesh", "meshes": "mesh", "curve": "lines", "curves": "lines",
    "load": "vector", "force": "vector", "division": "divide", "k": "stiffness",
}  # fmt: skip
ADDED = ("divide", "divide_u", "divide_v", "on", "curve_divide", "target_divide", "nearest", "snap")
"""Fields that recipes have beyond those of a scene."""
TEXTS = ("name", "kind", "points", "lines", "mesh", "curve", "target", "on", "edges", "axes", "rotations", "anchor")


def check(recipe: Mapping[str, Any]) -> None:
    """Raises InputError for the first fault; the scene checks the rest."""
    _script(recipe)
    for number, table in enumerate(_tables(recipe, "forces")):
        pointer = f"/forces/{number}"
        fields = _fields(table.get("kind"), f"{pointer}/kind")
        for key, value in table.items():
            if fields and key not in fields and key not in ADDED:
                raise InputError(f"{pointer}/{key}", f'{table["kind"]} has no field "{key}"; {_field(key, fields)}')
            _value(key, value, f"{pointer}/{key}")
    for key, value in recipe.get("settings", {}).items() if isinstance(recipe.get("settings"), Mapping) else ():
        if key != "solver":
            _number(key, value, f"/settings/{key}")


def check_script(script: Mapping[str, Any]) -> None:
    """Raises InputError if a script is a recipe."""
    for group, key in (("forces", "kind"), ("anchors", "points")):
        for number, table in enumerate(_tables(script, group)):
            if key in table:
                raise InputError(f"/{group}/{number}/{key}", "is a field of recipes; pass this file with --recipe")


def _script(recipe: Mapping[str, Any]) -> None:
    paths = [f"/{g}/{i}/times" for g in ("anchors", "forces") for i, t in enumerate(_tables(recipe, g)) if "times" in t]
    for pointer in [*(["/drives"] if "drives" in recipe else []), *paths]:
        raise InputError(pointer, "is a field of scripts; pass this file to hookean simulate with --script")


def _tables(recipe: Mapping[str, Any], group: str) -> list[Mapping[str, Any]]:
    given = recipe.get(group)
    return [t if isinstance(t, Mapping) else {} for t in given] if isinstance(given, list | tuple) else []


def _fields(kind: Any, pointer: str) -> list[str]:
    """The fields of a kind of force; empty if the kind is unknown."""
    from hookean.forces import KINDS

    if isinstance(kind, str) and kind in KINDS:
        return list(KINDS[kind].model_fields)
    if isinstance(kind, str) and kind.strip().casefold() in KINDS_MEANT:
        raise InputError(pointer, f'unknown kind "{kind}"; did you mean {KINDS_MEANT[kind.strip().casefold()]}?')
    return []


def _field(key: str, fields: list[str]) -> str:
    known = [*fields, *ADDED]
    meant = FIELDS_MEANT.get(key.casefold(), "")
    near = [meant] if meant in known else difflib.get_close_matches(key.casefold(), known, 1)
    return f"did you mean {near[0]}?" if near else f"its fields: {', '.join(known)}"


def _value(key: str, value: Any, pointer: str) -> None:
    if key == "vector" and isinstance(value, int | float) and not isinstance(value, bool):
        raise InputError(pointer, f"one number given; write x, y and z, such as vector = [0, 0, {value:g}]")
    if key not in TEXTS and key not in ADDED:
        _number(key, value, pointer)


def _number(key: str, value: Any, pointer: str) -> None:
    if isinstance(value, str) and re.fullmatch(r"\s*[-+]?\d+([.,]\d+)?(e[-+]?\d+)?\s*", value, re.IGNORECASE):
        meant = value.strip().replace(",", ".")
        raise InputError(pointer, f'the text "{value}" given; write the number without quotes: {key} = {meant}')
