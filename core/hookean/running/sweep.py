"""Sweeps: one scene, lists of values, a row of figures for each. This module has one item; other modules run many.

    sweep = Sweep.read({"forces": {"net": {"rest_factor": [0.8, 0.9, 1.0]}}})
    table = Table(scene)
    rows = [table.row(sweep.patch(number)) for number in range(sweep.count)]

A row depends on the scene and the patch alone: the same bits, whatever was solved before, and wherever.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any, Literal, Self

import numpy as np
from pydantic import model_validator

from hookean.errors import InputError
from hookean.forces import KINDS
from hookean.running.history import Before
from hookean.running.patch import Patch, apply
from hookean.running.result import Result
from hookean.running.run import relax_state
from hookean.scene.scene import Scene
from hookean.solvers import solver
from hookean.system.system import System, compile
from hookean.values.columns import Model, fault
from hookean.values.fields import Field

MOST = 100_000  # items of one sweep
Cancelled = Callable[[], bool]


class Sweep(Model):
    """Lists of values for columns of forces and for settings, or a list of patches."""

    forces: dict[str, dict[str, list[Any]]] = Field(default={}, description="Values by a force's name, and by column")
    settings: dict[str, list[Any]] = Field(default={}, description="Values by setting")
    mode: Literal["product", "zip"] = Field(
        default="product", description="All combinations, the last list fastest; or the lists side by side"
    )
    patches: tuple[dict[str, Any], ...] | None = Field(default=None, description="A list of patches")

    @model_validator(mode="after")
    def _counted(self) -> Self:
        lists = self._lists
        if self.patches is not None and (lists or not self.patches):
            raise fault("give either patches, at least one, or forces and settings", "/patches")
        if self.patches is None and not lists:
            raise fault("a sweep needs lists of values under forces or settings, or patches")
        for path, values in lists:
            pointer = "/" + "/".join(step.replace("~", "~0").replace("/", "~1") for step in path)
            if not values:
                raise fault("a list of values needs at least one", pointer)
            if self.mode == "zip" and len(values) != len(lists[0][1]):
                raise fault(f"{len(values)} values; the first list has {len(lists[0][1])}, and zip pairs them", pointer)
        if self.count > MOST:
            raise fault(f"{self.count} items; at most {MOST} are allowed")
        return self

    @property
    def _lists(self) -> list[tuple[tuple[str, ...], list[Any]]]:
        columns = [(("forces", f, c), v) for f, values in self.forces.items() for c, v in values.items()]
        return [*columns, *((("settings", name), values) for name, values in self.settings.items())]

    @property
    def count(self) -> int:
        """How many items it has."""
        if self.patches is not None:
            return len(self.patches)
        sizes = [len(values) for _, values in self._lists]
        return math.prod(sizes) if self.mode == "product" else sizes[0]

    @property
    def names(self) -> list[str]:
        """What it changes, as `net.rest_factor` or `settings.tolerance`, in order."""
        if self.patches is None:
            return [_called(path) for path, _ in self._lists]
        return list(dict.fromkeys(name for patch in self.patches for name in parameters(patch)))

    def patch(self, number: int) -> dict[str, Any]:
        """The patch of one item, counted from 0; IndexError where there is none."""
        if not 0 <= number < self.count:
            raise IndexError(number)
        if self.patches is not None:
            return self.patches[number]
        lists, places, left = self._lists, [], number
        for _, values in reversed(lists):
            left, place = divmod(left, len(values)) if self.mode == "product" else (left, number)
            places.append(place)
        made: dict[str, Any] = {}
        for (path, values), place in zip(lists, reversed(places), strict=True):
            inner = made
            for step in path[:-1]:
                inner = inner.setdefault(step, {})
            inner[path[-1]] = values[place]
        return made


def parameters(patch: Mapping[str, Any]) -> dict[str, Any]:
    """The values in a patch, as `net.rest_factor` or `settings.tolerance`; anchors it moves are not among them."""
    found: dict[str, Any] = {}
    for force, values in _items(patch.get("forces")):
        found.update({_called(("forces", force, column)): value for column, value in _items(values)})
    found.update({_called(("settings", name)): value for name, value in _items(patch.get("settings"))})
    return found


class Table:
    """A scene compiled once, for many rows."""

    def __init__(self, scene: Scene) -> None:
        self.system = compile(scene)
        self._said = list(self.system.report.warnings)

    def result(self, patch: Mapping[str, Any], cancelled: Cancelled | None = None) -> Result:
        """The scene with a patch, relaxed from its start. Raises InputError for an invalid patch."""
        system = self.system
        edit = Patch.read(dict(patch))
        state = system.start()
        before = Before(system, state)
        try:
            apply(system, state, edit)
            state.revision = 0
            return relax_state(system, state, solver(system.scene.settings.solver), cancelled=cancelled)
        finally:
            before.put_back(state)
            system.report.warnings[:] = self._said

    def row(self, patch: Mapping[str, Any], cancelled: Cancelled | None = None) -> dict[str, Any]:
        """The figures of one item; see `figures`."""
        return {"parameters": parameters(patch), **figures(self.result(patch, cancelled), self.system)}


def solve(scene: Scene, patch: Mapping[str, Any]) -> dict[str, Any]:
    """The row of one item of a sweep; the same for the same scene, patch and version."""
    return Table(scene).row(patch)


def figures(result: Result, system: System) -> dict[str, Any]:
    """How a run ended and its largest numbers, in the scene's units: status, message, iterations, residual [-], energy
    [force length], largest displacement [length], largest reaction [force], and under `forces` by name (or kind) the
    smallest and the largest force of each force that has one (moment of hinges and the like), tension +."""
    moved = np.linalg.norm(result.particles - system.points, axis=1).max(initial=0.0)
    reactions = np.asarray(result.reactions["force"], dtype=float).reshape(-1, 3)
    forces: dict[str, list[float | None]] = {}
    row = {
        "status": str(result.status),
        "message": result.message,
        "iterations": result.iterations,
        "residual": _finite(result.residual),
        "energy": _finite(result.energy["total"]),
        "displacement": _finite(moved),
        "reaction": _finite(np.linalg.norm(reactions, axis=1).max(initial=0.0)),
        "forces": forces,
    }
    for (name, _, column), entry in zip(_measured(system.scene), result.forces, strict=True):
        values = np.asarray(entry.get(column, ()), dtype=float)
        sizes = np.linalg.norm(values, axis=1) if values.ndim == 2 else values
        if column:
            forces[name] = [_finite(sizes.min()), _finite(sizes.max())] if sizes.size else [0.0, 0.0]
    return row


def columns(scene: Scene) -> list[tuple[str, str]]:
    """Names and units of the numbers in a row, in order; forces have two each, `smallest` and `largest`."""
    units = scene.units
    found = [("iterations", ""), ("residual", "-"), ("energy", units.of("energy"))]
    found += [("displacement", units.length), ("reaction", units.force)]
    for name, unit, column in _measured(scene):
        if column:
            found += [(f"{name}.smallest", units.of(unit)), (f"{name}.largest", units.of(unit))]
    return found


def _measured(scene: Scene) -> list[tuple[str, str, str]]:
    """Of each force its name in tables, unit and the column that is its force; no column where it has none."""
    found: list[tuple[str, str, str]] = []
    for number, force in enumerate(scene.forces):
        kind = force.kind_name
        outputs = KINDS[kind].outputs
        column = next((c for c in ("force", "moment") if c in outputs), "")
        name = force.name or kind
        if any(name == other for other, _, _ in found):
            name = f"{name} (force {number})"
        found.append((name, outputs.get(column, ""), column))
    return found


def _called(path: tuple[str, ...]) -> str:
    return ".".join(path[1:] if path[0] == "forces" else path)


def _items(value: Any) -> list[tuple[str, Any]]:
    return list(value.items()) if isinstance(value, dict) else []


def _finite(value: Any) -> float | None:
    number = float(value)
    return number if math.isfinite(number) else None


__all__ = ["MOST", "InputError", "Sweep", "Table", "columns", "figures", "parameters", "solve"]
