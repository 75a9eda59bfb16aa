"""Faults of forces that refer to what their scene does not have."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from hookean.forces import Force
from hookean.values.columns import fault
from hookean.values.materials import Material, known, unknown
from hookean.values.sections import Section


def materials_exist(force: Force, materials: Mapping[str, Material], sections: Mapping[str, Section], at: str) -> None:
    """A fault where a force names a material or section that does not exist."""
    material, section = vars(force).get("material"), vars(force).get("section")
    if material is not None and material not in materials and material not in known():
        raise fault(unknown(material, dict(materials)), f"{at}/material")
    if section is not None and section not in sections:
        names = ", ".join(repr(name) for name in sections) or "none"
        raise fault(f"section {section!r} does not exist; the scene has {names}", f"{at}/section")


def particles_exist(indices: Any, count: int, pointer: str) -> None:
    """A fault where some of the indices are beyond the particles of the scene."""
    if indices is None or not (indices >= count).any():
        return
    spot = np.argwhere(indices >= count)[0]
    given = int(indices[tuple(spot)])
    raise fault(
        f"particle {given} does not exist; the scene gives {count}, counted from 0",
        pointer + "".join(f"/{i}" for i in spot),
    )
