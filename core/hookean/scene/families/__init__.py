"""Families: scenes to begin with, each from a few parameters that stay editable.

    from hookean import family, relax

    roof = relax(family("saddle", width=12, rise=4))

A scene remembers its family and parameters in its field `family`; `rebuilt` gives it others. To add a family, write a
function with types of `parameters.py`, and its line in FAMILIES.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, get_type_hints

import numpy as np
from pydantic import create_model

from hookean.errors import InputError
from hookean.scene.catalogue import field_entry
from hookean.scene.families import films, nets, prisms, shells
from hookean.scene.scene import Origin, Scene
from hookean.values.columns import Model
from hookean.values.units import Units

WELDS = 0.1  # of the least distance between points: nearer ones become one particle
ROUNDING = 1e-9  # of the size


@dataclass(frozen=True)
class Family:
    """A family of scenes: a function of parameters, which its signature describes."""

    make: Callable[..., Scene]

    @property
    def name(self) -> str:
        """The name of the function."""
        return self.make.__name__

    @cached_property
    def model(self) -> type[Model]:
        """Its parameters as a model, with their defaults and bounds."""
        hints = get_type_hints(self.make, include_extras=True)
        fields: dict[str, Any] = {n: (hints[n], p.default) for n, p in inspect.signature(self.make).parameters.items()}
        made: type[Model] = create_model(self.name, __base__=Model, **fields)
        return made

    def entry(self) -> dict[str, Any]:
        """It as plain values: name, title, summary, description, and parameters (name, description, unit, type,
        default, bounds, choices) as the catalogue of forces has fields."""
        described = self.model.model_json_schema()["properties"]
        parts = [" ".join(part.split()) for part in (self.make.__doc__ or "").strip().split("\n\n")]
        return {
            "name": self.name,
            "title": self.name.replace("_", " ").capitalize(),
            "summary": parts[0],
            "description": "\n\n".join(parts),
            "parameters": [field_entry(n, f, described[n]) for n, f in self.model.model_fields.items()],
        }

    def scene(self, parameters: Mapping[str, Any], units: Units) -> Scene:
        """The scene of these parameters, others at their defaults. InputError for what is not allowed."""
        given = dict(self.model.read(dict(parameters)))
        made = self.make(**given)
        weld = min(made.weld_tolerance, WELDS * _spacing(made))
        return made.replaced(units=units, weld_tolerance=weld, family=Origin(name=self.name, parameters=given))


def _spacing(scene: Scene) -> float:
    """The least distance [length] between points of a scene, but for those that rounding puts apart; infinite if all
    points coincide."""
    from scipy.spatial import cKDTree

    points = np.concatenate([scene.particles, *(mesh.vertices for mesh in scene.meshes.values())])
    nearest = cKDTree(np.unique(points, axis=0)).query(points, k=3)[0][:, 1:]
    apart = nearest[np.isfinite(nearest) & (nearest > ROUNDING * np.ptp(points, axis=0).max())]
    return float(apart.min(initial=np.inf))


_ALL: tuple[Callable[..., Scene], ...] = (
    *(nets.cable, nets.grid, nets.saddle, nets.radial_net),
    *(shells.dome, shells.vault, films.catenoid, prisms.tensegrity, shells.gridshell, films.cushion),
)
FAMILIES = {make.__name__: Family(make) for make in _ALL}
"""All families by name, in the order in which they are shown."""


def family(name: str, units: Units | Mapping[str, Any] | None = None, **parameters: Any) -> Scene:
    """The scene of a family, such as `family("saddle", rise=4)`, in `units` (default: those of a scene).

    docs/scene.md lists the families. InputError for an unknown family or a value that is not allowed.
    """
    return found(name).scene(parameters, Units.read(units or {}))


def found(name: str) -> Family:
    """The family of a name; InputError for an unknown one."""
    if name not in FAMILIES:
        raise InputError("/name", f"unknown family {name!r}; known: {', '.join(FAMILIES)}")
    return FAMILIES[name]


def families() -> list[dict[str, Any]]:
    """All families as plain values; see `Family.entry`."""
    return [one.entry() for one in FAMILIES.values()]
