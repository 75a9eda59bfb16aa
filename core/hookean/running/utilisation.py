"""Stress of lines and beams with a known section, and utilisation: the part of its strength that each element uses."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.forces import KINDS, elastic
from hookean.forces.base import Places

Floats = NDArray[np.float64]

NAME = "utilisation"
STRESS = "stress"
"""The columns of results that have both."""
ROUND = ("rod", "tube")  # shapes of sections that have no corners, where stresses about both axes would add up
LEAST = 1e-250  # strength [force] below which a force by it may have no value in float64


def dimensions(kind: str) -> dict[str, str]:
    """The columns that a result may have of a force of this kind, with their dimensions."""
    stressed = {STRESS: "force/length^2"} if kind in STRESSES else {}
    return {**KINDS[kind].outputs, **stressed, NAME: ""}


def stress(force: Any, places: Places, columns: Mapping[str, Floats]) -> Floats | None:
    """Normal stress (m,) [force/length^2] of elements whose section is known: T / A of cables and bars; of beams the
    largest size at either end, |N| / A + |My| / Wy + |Mz| / Wz, of round ones |N| / A + (My^2 + Mz^2)^0.5 / W; of
    shells of a known thickness that of bending at their faces, 6 M / t^2."""
    rule = STRESSES.get(force.kind_name)
    return None if rule is None or _size(force) is None else rule(force, places, columns)


def _size(force: Any) -> Any:
    """The section of a force, or the thickness of a shell; None where it is not known."""
    return force.section if hasattr(force, "section") else force.thickness


def utilisation(force: Any, places: Places, columns: Mapping[str, Floats]) -> Floats | None:
    """Utilisation (m,) [-] of the elements of a force with these columns of a result; None where no strength is known.

    1 is the strength itself: cables and bars |T| / T0, T0 their `strength` or strength x area; beams |N| / (A f) +
    |My| / (Wy f) + |Mz| / (Wz f), round ones |N| / (A f) + (My^2 + Mz^2)^0.5 / (W f), the larger of both ends; cloth
    the larger of warp and weft over their strengths; solid sheets the stress of von Mises over f. Safety factors are
    yours: put them into combinations or limits.
    """
    rule = RULES.get(force.kind_name)
    return rule(force, places, columns) if rule is not None else None


def missing(force: Any, columns: Mapping[str, Any]) -> str:
    """Why a force with these columns of a result has no stress or no utilisation, as a sentence; empty where it has
    both or could have neither."""
    if not np.size(columns.get("particles", ())):
        return ""
    lacks = [(STRESS, "section")] if force.kind_name in STRESSES and STRESS not in columns else []
    lacks += [(NAME, "strength")] if force.kind_name in RULES and NAME not in columns else []
    if not lacks:
        return ""
    without = " and no ".join(column for column, _ in lacks)
    cause = " and ".join(cause for _, cause in lacks)
    if force.kind_name == "shell":
        cause = "material and thickness"
    if force.kind_name == "beam" and lacks[0][0] == STRESS:
        cause = "material and section" if force.section is None else "Wy or Wz of its section"
    return f"{force.name or force.kind_name} has no {without}: give its {cause}."


def breaking_force(force: Any, places: Places) -> Floats | None:
    """The force [force] at which the elements of springs break, one or one for each; None where it is not known."""
    if getattr(force, "strength", None) is not None:
        return np.asarray(force.strength, dtype=np.float64)
    strength = _strength(force, places)
    return None if strength is None else np.asarray(strength * elastic.area(force, places))


def _strength(force: Any, places: Places) -> float | None:
    """The strength [force/length^2] of a force's material; None where it has neither."""
    return None if force.material is None else places.material(force.material).strength


def _lines(force: Any, places: Places, columns: Mapping[str, Floats]) -> Floats | None:
    whole = breaking_force(force, places)
    return None if whole is None else np.asarray(np.abs(columns["force"]) / np.maximum(whole, LEAST))


def _beams(force: Any, places: Places, columns: Mapping[str, Floats]) -> Floats | None:
    strength, stressed = _strength(force, places), stress(force, places, columns)
    return None if strength is None or stressed is None else np.asarray(stressed / strength)


def _tensile(force: Any, places: Places, columns: Mapping[str, Floats]) -> Floats:
    return np.asarray(columns["force"] / elastic.area(force, places))


def _bent(force: Any, places: Places, columns: Mapping[str, Floats]) -> Floats | None:
    section = places.section(force.section)
    known, bent = section.properties, []
    for axis in "yz":
        moments = np.abs([columns[f"M{axis}0"], columns[f"M{axis}1"]])
        if f"W{axis}" not in known and moments.any():
            return None  # it bends by an unknown section modulus
        bent.append(moments / known.get(f"W{axis}", np.inf))
    # at each end; between them it is no larger, as moments are linear
    both = np.hypot(*bent) if section.shape in ROUND else bent[0] + bent[1]
    return np.asarray(np.abs(columns["force"]) / known["area"] + both.max(axis=0))


def _plates(force: Any, places: Places, columns: Mapping[str, Floats]) -> Floats:
    return np.asarray(6.0 * columns["moment"] / force.thickness**2)


def _sheets(force: Any, places: Places, columns: Mapping[str, Floats]) -> Floats | None:
    if force.material is None:
        return None
    material = places.material(force.material)
    if material.warp_strength is not None:
        weft = material.weft_strength or material.warp_strength
        return np.maximum(columns["warp"] / material.warp_strength, columns["weft"] / weft).clip(0.0)
    if material.strength is None or force.thickness is None:
        return None
    most, least = columns["largest"], columns["least"]
    return np.asarray(np.sqrt(most**2 - most * least + least**2) / (force.thickness * material.strength))


RULES: dict[str, Callable[[Any, Places, Mapping[str, Floats]], Floats | None]] = {
    "springs": _lines,
    "sliding_cable": _lines,
    "beam": _beams,
    "membrane": _sheets,
}
"""By the kind of a force: how its elements use their strength."""

STRESSES: dict[str, Callable[[Any, Places, Mapping[str, Floats]], Floats | None]] = {
    "springs": _tensile,
    "sliding_cable": _tensile,
    "beam": _bent,
    "shell": _plates,
}
"""The same of the stress of a section, or of a thickness."""
