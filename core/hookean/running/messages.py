"""Sentences on the end of a run: how it ended, at which particle and force, and what to do about it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from hookean.forces.unary import Unary
from hookean.running.result import Status
from hookean.running.trial import trial
from hookean.stability import time_steps
from hookean.stability.equilibrium import Equilibrium, Stability, amiss
from hookean.system.balance import Balance, Floats
from hookean.system.state import State
from hookean.system.system import System
from hookean.system.untaken import untaken_moment

if TYPE_CHECKING:
    from hookean.running.watch import Watch

BEYOND = 100.0  # sizes of the model that a load may move its particle by, before it is called too large


def sentence(watch: Watch, system: System, status: Status) -> str:
    """The message of a run that ended with `status`."""
    found, unit = watch.found, system.scene.units.force
    left = f"residual {found.residual:.3g}, {found.out_of_balance:.3g} {unit} out of balance"
    count = watch.last - watch.first
    spent = f"{count} iteration{'s' * (count != 1)}"
    if status is Status.CONVERGED:
        rounding = " (the rounding floor)" if found.residual > watch.settings.tolerance else ""
        return f"In equilibrium after {spent}: {left}{rounding}.{_caveat(system, watch.rest)}"
    if status is Status.DIVERGED and watch.collapse:
        return f"Collapsed after {spent}; the last good shape is returned. {watch.collapse}."
    if status is Status.DIVERGED:
        where = f" after {spent} at {watch.fault}" if watch.fault else ""  # a state taken up knows no more
        return f"Diverged{where}; the last good shape is returned. {_advice(watch, system)}."
    if status is Status.STALLED:
        worst = system.slots.owner(found.worst)
        return f"Stalled after {spent} at particle {worst}: {left}. {_obstacle(watch, system)}."
    if status is Status.CANCELLED:
        return f"Cancelled after {spent}: {left}."
    if status is Status.TIME_LIMIT:
        most = f"{watch.settings.time_limit:g} s"
        return f"Time limit ({most}) reached after {spent}: {left}. Raise time_limit."
    advice = _adrift(system, found) or "Raise max_iterations"
    return f"Not in equilibrium after {spent}: {left}. {advice}."


def _advice(watch: Watch, system: System) -> str:
    """What to do about a run that diverged."""
    if not watch.advised:
        watch.advised = _blame(watch, system)
    return watch.advised


def _blame(watch: Watch, system: System) -> str:
    if watch.method.physical and not watch.settings.divide_steps and not watch.flew:
        held = (0.0, 0.0) if watch.driven else trial(system, watch.origin, watch.good, watch.method, type(watch))
        return time_steps.too_long(system, watch.good, watch.method, held)
    part = watch.found.components.label[watch.lost] if watch.lost >= 0 else -1
    free = part >= 0 and not watch.found.components.supported[part] and not len(watch.found.planes)
    if watch.flew and free:
        return f"Nothing supports {_called(system, watch.found, part)}: add anchors"
    if said := _adrift(system, watch.found):
        return said
    if free:
        return (
            f"Only the forces between its particles act on {_called(system, watch.found, part)}, and no shape "
            "was found that balances them: add springs that keep distances, or anchors"
        )
    if said := _overloaded(system, watch.good, watch.size):
        return said
    if watch.method.physical:
        return "The forces grow without bound, and no time step is stable: add damping or mass, or lower the stiffness"
    other = "" if watch.method.name == "auto" else "use auto, "
    return (
        f"The solver {watch.method.name} found no equilibrium from here: {other}check that every part is held along "
        "all axes on which it is loaded, or lower the loads"
    )


def _obstacle(watch: Watch, system: System) -> str:
    """Why a run stalled."""
    if said := _adrift(system, watch.found):
        return said
    if said := amiss(system, watch.good):
        return f"Forces balance, but {said}"
    if len(watch.found.coarse):
        part = int(watch.found.coarse[0])
        return (
            f"Rounding alone causes a residual of {watch.found.floors[part]:.1g} in "
            f"{_called(system, watch.found, part)}: stiffness or coordinates are too large for these forces. "
            "Move the model to the origin, or lower the stiffness"
        )
    if watch.rest is not None and watch.rest.position_error is not None:
        error, unit = watch.rest.position_error, system.scene.units.length
        return (
            f"Forces balance, but one more exact step would still move a particle by {error:.2g} {unit}, more than "
            "position_tolerance allows: the structure is close to an instability. Stiffen it, or raise "
            "position_tolerance"
        )
    if watch.method.name == "newton" and system.contacts:
        return "Newton steps end where a particle comes to a floor: use auto, which goes on from there"
    if said := untaken_moment(system, watch.good):
        return said
    if any(np.any(force.moment) for force in system.scene.forces if isinstance(force, Unary)):
        return (
            "A moment keeps its direction and has no energy, so a shape that it bends far may not come to rest. "
            'Hold particles in a plane, or use solver "newton" with allow_unstable'
        )
    return (
        "Common causes: springs at their cutoff, unsupported loads, a shape near snap-through. Check that "
        "particle, or raise the tolerance"
    )


def _caveat(system: System, rest: Equilibrium | None) -> str:
    """A sentence on an equilibrium that is not stable."""
    if rest is None or rest.stability not in (Stability.UNSTABLE, Stability.MECHANISM):
        return ""
    softest = rest.soft_particle
    most = f"; particle {system.slots.owner(softest)} moves most" if softest is not None else ""
    if softest is not None and softest >= system.slots.count:
        most = most.replace("moves", "turns")
        if rest.stability is Stability.MECHANISM:
            most += ": hold it by the rotations of an anchor, or release fewer axes of its beams"
    kind = "It is unstable" if rest.stability is Stability.UNSTABLE else "It is a mechanism"
    return f" {kind}: {rest.stability_reason}{most}."


def _overloaded(system: System, state: State, size: float) -> str:
    """Which load is too large for what holds it: one that would move its particle by many times the model's size, or
    that nothing holds at all; and which beam has lost its forces."""
    turned = (group.cls.amiss(group.block, state.x) for group in system.groups if group.cls.turns)
    if said := next((said for said in turned if said), ""):
        return said[0].upper() + said[1:]
    loads = np.sqrt((system.evaluate(state, only="load")[0] ** 2 * state.free).sum(axis=1))
    stiffness = system.evaluate(state)[1]
    loose = (stiffness == 0.0) & (loads > 0.0)
    loose[system.slots.count :] = False
    if loose.any():
        particle, units = int(np.argmax(loose)), system.scene.units
        return (
            f"In this shape nothing resists the load of {loads[particle]:.3g} {units.force} on particle {particle}"
            f"{owner(system, particle, role='load')}: connect it, or anchor it"
        )
    reach = loads / np.where(stiffness > 0.0, stiffness, np.inf)
    particle = int(np.argmax(reach[: system.slots.count]))
    if reach[particle] <= BEYOND * size:
        return ""
    force, units = owner(system, particle, role="load"), system.scene.units
    return (
        f"The load of {loads[particle]:.3g} {units.force} on particle {particle}{force} is too large for the stiffness "
        f"of its supports, which would stretch by {reach[particle]:.2g} {units.length}: lower the load, or raise the "
        "stiffness"
    )


def _adrift(system: System, found: Balance) -> str:
    """Which components carry loads that nothing can balance; empty where there are none."""
    if not len(found.adrift):
        return ""
    part = int(found.adrift[0])
    more = f" (and {len(found.adrift) - 1} more such parts)" if len(found.adrift) > 1 else ""
    called, unit = _called(system, found, part), system.scene.units.force
    count = int(np.count_nonzero(found.components.label[: system.slots.count] == part))
    carry, them = ("carries", "it") if count == 1 and not more else ("carry", "them")
    unheld = found.unheld[part]
    if len(found.planes):
        return (
            f"The floor cannot hold {called}{more}: {_load(unheld)} {unit} of the loads lift {them} off or exceed the "
            f"friction. Anchor {them}, or raise static_friction"
        )
    if np.trace(found.components.loose[part]) > 2.5:
        load = float(np.abs(unheld).max())
        return f"Nothing supports {called}{more}, which {carry} a load of {load:.3g} {unit}: anchor {them}"
    return (
        f"Nothing supports {called}{more} along {_direction(unheld)}, where {them if them == 'it' else 'they'} {carry} "
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


def _called(system: System, found: Balance, part: int) -> str:
    """A component in words."""
    count = int(np.count_nonzero(found.components.label[: system.slots.count] == part))
    particle = system.slots.owner(int(found.components.first[part]))
    called = f"particle {particle}{owner(system, particle)}"
    return called if count == 1 else f"the {count} particles connected with {called}"


def owner(system: System, particle: int, *, role: str = "") -> str:
    """The first force of a role, or of all but loads, with an element at a particle: " (of /forces/3, springs)"."""
    for group in system.groups:
        hit = (group.block.indices == particle).any(axis=1)
        for part in group.parts:
            if hit[part.rows].any() and (group.cls.role == role if role else group.cls.role != "load"):
                return f" (of /forces/{part.number}, {group.cls.kind_name})"
    return ""
