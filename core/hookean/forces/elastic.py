"""What a force with `material` and `section` is made of.

A force that may be given both has two fields of these names, and compiles with

    given = section_columns(self, places)        # empty where it is given neither
    modulus = given.get("E", self.E)
"""

from __future__ import annotations

from typing import Any

from hookean.errors import InputError
from hookean.forces.base import Places

NAMES = {"area": "A", "Iy": "Iy", "Iz": "Iz", "J": "J"}
"""Quantities of a section and the columns they become."""


def axial_stiffness(force: Any, places: Places) -> float:
    """E A [force] of a force's material and section."""
    return float(places.material(force.material).modulus(force.material) * area(force, places))


def area(force: Any, places: Places) -> float:
    """A [length^2] of a force's section; InputError if it has none."""
    return float(_quantity(force, places, "area"))


def section_columns(force: Any, places: Places) -> dict[str, float]:
    """E, G [force/length^2], A [length^2], Iy, Iz and J [length^4] of a force's material and section; empty without
    them. InputError if one of them is not known."""
    if force.material is None and force.section is None:
        return {}
    material = places.material(force.material)
    found = {"E": material.modulus(force.material), "G": material.shear_modulus(force.material)}
    return {**found, **{column: _quantity(force, places, name) for name, column in NAMES.items()}}


def _quantity(force: Any, places: Places, name: str) -> float:
    found = places.section(force.section).properties
    if name not in found:
        why = "a rope does not bend" if places.section(force.section).shape == "rope" else f"give its {name}"
        raise InputError("", f'section "{force.section}" has no {name}; {why}')
    return found[name]
