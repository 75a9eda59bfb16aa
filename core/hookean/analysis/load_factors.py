"""Loads times a factor, each with fields that its force is proportional to, in units of force; and warmth."""

from __future__ import annotations

import re
from typing import Any

import numpy as np

from hookean.errors import InputError
from hookean.forces import Force
from hookean.forces.self_weight import SelfWeight
from hookean.forces.springs import Springs
from hookean.values.columns import LARGEST


def magnitudes(cls: type[Force]) -> list[str]:
    """The fields of a load that its force is proportional to: those whose unit begins with force."""
    found = []
    for name, field in cls.model_fields.items():
        units = re.findall(r"\[([^\]]*)\]", field.description or "")
        if any(unit.startswith("force") for unit in units):
            found.append(name)
    return found


def scaled(load: Force, factor: float) -> Force:
    """A load times a factor; the load itself for the factor 1. The weight of a material has a factor of its own."""
    if factor == 1.0:
        return load
    changed: dict[str, Any] = {}
    for name in magnitudes(type(load)):
        given = getattr(load, name)
        if given is not None:
            changed[name] = factor * (np.asarray(given) if isinstance(given, np.ndarray) else float(given))
            if not np.abs(changed[name]).max(initial=0.0) <= LARGEST:
                said = f"{name} of {load.name or load.kind_name} times {factor:g} is larger than the limit, {LARGEST:g}"
                raise InputError("/load_cases", said)
    if getattr(load, "material", None) is not None:
        changed["factor"] = factor * getattr(load, "factor", 1.0)
    other = load.replaced(**changed)
    return other.in_case(factor) if isinstance(other, SelfWeight) else other


def warmed(force: Force, expansion: float, degrees: float, own: Any = 0.0) -> Force:
    """A force of a frozen model whose temperature changes by `degrees` [K] from that of the form, `own` [K], one or one
    for each element. Thermal strains add, as of all materials with a constant expansion: springs get rest lengths
    L0 (1 + expansion (own + degrees)) / (1 + expansion own) of the same EA; those that go slack below their rest length
    go slack below the new one."""
    if not isinstance(force, Springs):
        before = vars(force)["temperature"]
        return force.replaced(temperature=degrees if before is None else degrees + before)
    growth = 1.0 + expansion * degrees / (1.0 + expansion * np.asarray(own, dtype=np.float64))
    if not (growth > 0.0).all():
        name = force.name or force.kind_name
        raise InputError("/load_cases", f"a change of {degrees:g} K leaves no length of {name}")
    rest = np.asarray(force.rest_length) * growth
    lower = np.where(np.asarray(force.lower_cutoff) >= np.asarray(force.rest_length), rest, force.lower_cutoff)
    return force.replaced(stiffness=np.asarray(force.stiffness) / growth, rest_length=rest, lower_cutoff=lower)
