"""Quantities of an equilibrium that goals and constraints name. A new one is a class in a file here, and its place in
CLASSES. A program loads those that it uses and no others."""

from __future__ import annotations

import importlib
from collections.abc import Iterator, Mapping
from functools import cache

from hookean.designing.quantities.base import Quantity

CLASSES = {
    "position": "position.Position",
    "offset": "offset.Offset",
    "length": "of_elements.Length",
    "force": "of_elements.Force",
    "force_density": "of_elements.ForceDensity",
    "load_path": "of_elements.LoadPath",
    "output": "of_elements.Output",
    "strain_energy": "energy.StrainEnergy",
    "reaction": "reaction.Reaction",
    "volume": "meshes.Volume",
    "area": "meshes.Area",
    "planarity": "faces.Planarity",
    "fairness": "faces.Fairness",
    "frequency": "frequency.Frequency",
    "buckling_factor": "buckling.BucklingFactor",
    "curvature": "curvature.Curvature",
    "direction": "direction.Direction",
}
"""File and class of each kind."""


class _Quantities(Mapping[str, type[Quantity]]):
    """Every class by its kind: one is loaded when it is asked for, all to go through them."""

    def __getitem__(self, kind: str) -> type[Quantity]:
        return _loaded(CLASSES[kind])

    def __iter__(self) -> Iterator[str]:
        return iter(CLASSES)

    def __len__(self) -> int:
        return len(CLASSES)


@cache
def _loaded(name: str) -> type[Quantity]:
    file, _, cls = name.partition(".")
    found: type[Quantity] = getattr(importlib.import_module(f"{__name__}.{file}"), cls)
    return found


QUANTITIES: Mapping[str, type[Quantity]] = _Quantities()
"""All quantities by kind."""
