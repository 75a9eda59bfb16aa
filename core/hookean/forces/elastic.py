"""What a force with `material` and `section` is made of.

A force that may be given both has two fields of these names, and compiles with

    given = section_columns(self, places)        # empty where it is given neither
    modulus = given.get("E", self.E)
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from hookean.errors import InputError
from hookean.forces.base import Places
from hookean.values.columns import fault

NAMES = {"area": "A", "Iy": "Iy", "Iz": "Iz", "J": "J"}
"""Quantities of a section and the columns they become."""


def without(value: Any, name: str, others: tuple[str, ...]) -> Any:
    """Given fields with the field `name` as None where one of the others is given and it is not: its default does not
    count then."""
    if isinstance(value, Mapping) and name not in value and any(value.get(other) is not None for other in others):
        return {**value, name: None}
    return value


def plate(force: Any, places: Places) -> tuple[float, float]:
    """D = E t^3 / (12 (1 - nu^2)) [force length] and nu [-] of a force: its `strength` and `poisson`, or those of its
    `material` and `thickness`; InputError where they are not known."""
    if force.strength is not None:
        return float(force.strength), float(force.poisson or 0.0)
    material = places.material(force.material)
    modulus = material.modulus(force.material)
    poisson = force.poisson if force.poisson is not None else material.contraction(force.material)
    return modulus * force.thickness**3 / (12.0 * (1.0 - poisson**2)), poisson


def axial_stiffness(force: Any, places: Places) -> float:
    """E A [force] of a force's material and section."""
    return float(places.material(force.material).modulus(force.material) * area(force, places))


def area(force: Any, places: Places) -> float:
    """A [length^2] of a force's section; InputError if it has none."""
    return float(_quantity(force, places, "area"))


def known_area(force: Any, places: Places) -> None:
    """InputError where a force names a section that does not exist or has no area."""
    if force.section is not None:
        area(force, places)


def one_way(force: Any) -> None:
    """A fault unless a force has either all of E, G, A, Iy, Iz and J, or both a material and a section."""
    columns = ("E", "G", *NAMES.values())
    own = [name for name in columns if getattr(force, name) is not None]
    made = [name for name in ("material", "section") if getattr(force, name) is not None]
    if bool(own) == bool(made) or len(made) == 1 or 0 < len(own) < len(columns):
        said = f"{', '.join([*own, *made]) or 'no stiffness'} given"
        raise fault(f"{said}; give either {', '.join(columns)}, or both material and section")


def section_columns(force: Any, places: Places) -> dict[str, float]:
    """E, G [force/length^2], A [length^2], Iy, Iz and J [length^4] of a force's material and section; empty without
    them. InputError if one of them is not known."""
    if force.material is None and force.section is None:
        return {}
    material = places.material(force.material)
    found = {"E": material.modulus(force.material), "G": material.shear_modulus(force.material)}
    return {**found, **{column: _quantity(force, places, name) for name, column in NAMES.items()}}


def growth(force: Any, places: Places) -> Any:
    """1 + expansion x temperature [-] of a force, one or one for each element; 1 without a temperature. InputError
    where its material has no expansion, or nothing is left of its length."""
    if force.temperature is None:
        return 1.0
    if force.material is None:
        raise InputError("", "temperature needs a material with expansion; give material in the place of stiffnesses")
    expansion = places.material(force.material).expansion
    if expansion is None:
        raise InputError("", f"{force.material} has no thermal expansion; give its expansion")
    grown = 1.0 + expansion * np.asarray(force.temperature)
    if not (grown > 0.0).all():
        raise InputError("", f"a change of {np.min(force.temperature):g} K leaves no length of {force.material}")
    return grown


def _quantity(force: Any, places: Places, name: str) -> float:
    found = places.section(force.section).properties
    if name not in found:
        why = "a rope does not bend" if places.section(force.section).shape == "rope" else f"give its {name}"
        raise InputError("", f'section "{force.section}" has no {name}; {why}')
    return found[name]
