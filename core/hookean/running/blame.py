"""Blame: which part, load or support keeps a run from equilibrium, in words."""

from __future__ import annotations

import numpy as np

from hookean.system.balance import Balance, Floats
from hookean.system.state import State
from hookean.system.system import System

BEYOND = 100.0  # sizes of the model that a load may move its particle by, before it is called too large


def overloaded(system: System, state: State, size: float) -> str:
    """Which load is too large for what holds it: one that would move its particle by many times the model's size."""
    loads = np.sqrt((system.evaluate(state, only="load")[0] ** 2 * state.free).sum(axis=1))
    reach = loads / np.maximum(system.evaluate(state)[1], 1e-300)
    particle = int(np.argmax(reach))
    if reach[particle] <= BEYOND * size:
        return ""
    force, units = owner(system, particle, role="load"), system.scene.units
    return (
        f"The load of {loads[particle]:.3g} {units.force} on particle {particle}{force} is too large for the stiffness "
        f"of its supports, which would stretch by {reach[particle]:.2g} {units.length}: lower the load, or raise the "
        "stiffness"
    )


def adrift(system: System, found: Balance) -> str:
    """Which components carry loads that nothing can balance; empty where there are none."""
    if not len(found.adrift):
        return ""
    part = int(found.adrift[0])
    more = f" (and {len(found.adrift) - 1} more such parts)" if len(found.adrift) > 1 else ""
    whose, unit = called(system, found, part), system.scene.units.force
    count = int(np.count_nonzero(found.components.label == part))
    carry, them = ("carries", "it") if count == 1 and not more else ("carry", "them")
    unheld = found.unheld[part]
    if len(found.planes):
        return (
            f"The floor cannot hold {whose}{more}: {_load(unheld)} {unit} of the loads lift {them} off or exceed the "
            f"friction. Anchor {them}, or raise static_friction"
        )
    if np.trace(found.components.loose[part]) > 2.5:
        load = float(np.abs(unheld).max())
        return f"Nothing supports {whose}{more}, which {carry} a load of {load:.3g} {unit}: anchor {them}"
    return (
        f"Nothing supports {whose}{more} along {_direction(unheld)}, where {them if them == 'it' else 'they'} {carry} "
        f"a load of {_load(unheld)} {unit}: hold {them} in that direction too"
    )


def _load(vector: Floats) -> str:
    return f"{float(np.sqrt(vector @ vector)):.3g}"


def _direction(vector: Floats) -> str:
    """A direction in words: an axis, or a unit vector."""
    unit = vector / np.sqrt(vector @ vector)
    axis = int(np.argmax(np.abs(unit)))
    if np.abs(unit[axis]) > 1.0 - 1e-9:
        return "xyz"[axis]
    return f"({', '.join(f'{c:.3g}' for c in np.where(np.abs(unit) > 1e-9, unit, 0.0))})"


def called(system: System, found: Balance, part: int) -> str:
    """A component in words."""
    count = int(np.count_nonzero(found.components.label == part))
    particle = int(found.components.first[part])
    whose = f"particle {particle}{owner(system, particle)}"
    return whose if count == 1 else f"the {count} particles connected with {whose}"


def owner(system: System, particle: int, *, role: str = "") -> str:
    """The first force of a role, or of all but loads, with an element at a particle: " (of /forces/3, springs)"."""
    for group in system.groups:
        hit = (group.block.indices == particle).any(axis=1)
        for part in group.parts:
            if hit[part.rows].any() and (group.cls.role == role if role else group.cls.role != "load"):
                return f" (of /forces/{part.number}, {group.cls.kind_name})"
    return ""
