"""Equilibrium: whether a shape at rest is stable, and how far it is from where it would rest exactly.

Both come from the tangent stiffness K on what may move. All eigenvalues positive: stable. One negative: energy falls
along its mode, and a touch sends the shape there. Zero: a motion that nothing resists. K^-1 of what is out of balance
is the movement that one more exact step would make, and its largest part the position error.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import StrEnum
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from hookean.forces.base import lengths
from hookean.stability import nets
from hookean.stability.tension import taut
from hookean.system import components
from hookean.system.balance import Balance
from hookean.system.state import State
from hookean.system.system import System

if TYPE_CHECKING:
    from hookean.solvers import Solver
    from hookean.stability.modes import Modes

Floats = NDArray[np.float64]

DENSE = 400  # unknowns up to which numpy's eigenvalues are quick
LARGEST_FACTOR = 60_000  # unknowns: more are left to multigrid, or to nobody
LARGEST_BLOCKS = 3_000_000  # entries of all element blocks; a shell's have 36 x 36 each
PUSH = 1e-6  # of the force of a contact
FINEST = 1e-16  # position tolerance that means as well as can be
DOUBTFUL = 1e-6  # of the work of all forces along a step: less may be rounding
LARGE_NET = 4_000  # particles from which on multigrid is quicker than factors


class Stability(StrEnum):
    """What a small push does to a shape at rest."""

    STABLE = "stable"
    UNSTABLE = "unstable"
    MECHANISM = "mechanism"
    UNKNOWN = "unknown"


@dataclass(frozen=True)
class Equilibrium:
    """The stability of a shape and how accurate it is.

    `stability`; of an unstable shape or a mechanism the particle that moves most in the softest mode (`soft_particle`)
    and how many modes are unstable or meet no resistance (`soft_modes`), where that was counted; of a stable shape how
    many turns of hinged joints do. `position_errors` (k,) [length] of the connected components: the largest movement
    that one more exact step would make, within a factor of 3; None where that is not known. Reasons are sentences.
    """

    stability: Stability
    stability_reason: str = ""
    soft_particle: int | None = None
    soft_modes: int | None = None
    position_errors: Floats | None = None
    position_reason: str = ""
    mode: Floats | None = None  # (n, 3) the softest, its largest part 1
    beside: Floats | None = None  # (k,) position errors [length] of a mechanism, but for what nothing resists

    @property
    def position_error(self) -> float | None:
        """The largest of all components [length]; None where one is not known."""
        return None if self.position_errors is None else float(self.position_errors.max(initial=0.0))


def unknown(reason: str) -> Equilibrium:
    """An equilibrium of which nothing is known."""
    return Equilibrium(Stability.UNKNOWN, reason, position_reason=reason)


def assess(system: System, state: State, found: Balance, method: Solver | None = None) -> Equilibrium:
    """The stability and accuracy of a shape at rest, `found` what is out of balance there; `method` is the solver that
    came to it, which may know."""
    free, reason = movable(system, state, found)
    if reason:
        return unknown(reason)
    if not free.any():
        return Equilibrium(Stability.STABLE, position_errors=np.zeros(len(found.scales)))
    if reason := amiss(system, state):
        return unknown(reason)
    certain = _certain(system, state, free, method)
    if certain:
        moved = None if method is None else method.correction(system, state, found)
        if moved is None and len(state.x) < LARGE_NET:
            from hookean.linear import spring_cg as _conjugate

            moved = _conjugate.movement(system, state, free, found)
        if moved is not None:
            return Equilibrium(Stability.STABLE, position_errors=_largest(moved, found))
    rest = _by_modes(system, state, free, found, method)
    if rest.stability is Stability.MECHANISM and rest.soft_modes and _only_turns(system, state, free, found, rest):
        # nothing moves along them, and nothing turns them: moments on them would not be in balance
        reason = f"{rest.soft_modes} turns of hinged joints, which move nothing, meet no resistance"
        errors = rest.beside
        return Equilibrium(Stability.STABLE, reason, soft_modes=rest.soft_modes, position_errors=errors)
    if not certain or rest.stability is Stability.STABLE:
        return rest
    return Equilibrium(Stability.STABLE, position_errors=rest.position_errors, position_reason=rest.position_reason)


def _only_turns(system: System, state: State, free: Floats, found: Balance, rest: Equilibrium) -> bool:
    """Whether all that meets no resistance are turns of particles about themselves. These are motions that the part of
    the tangent K of rotations alone does not resist: where K is at least 0, K_rr t = 0 means that K t = 0. Joints with
    eccentric ends of beams, which swing, are left out."""
    slots = system.slots
    if not len(slots) or system.films is not None:
        return False
    turning = free.copy()
    turning[: slots.count] = 0.0
    for group in system.groups:
        for end in range(2):
            away = [i for i, name in enumerate(group.block.names) if name == ("offset_start", "offset_end")[end]]
            if group.cls.turns and away:
                swings = group.block.parameters[:, away].any(axis=1)
                turning[group.block.indices[swings, group.cls.arity + end]] = 0.0
    if not turning.any():
        return False
    turns = _by_modes(system, state, turning, found, None)
    return turns.stability is Stability.MECHANISM and turns.soft_modes == rest.soft_modes


def _certain(system: System, state: State, free: Floats, method: Solver | None) -> bool:
    """Whether the tangent is positive definite for a reason that is quick to find: the solver knows, everything pulls,
    or the force densities of a net of springs are positive definite."""
    if (method is not None and method.certain) or taut(system, state, free):
        return True
    few = np.count_nonzero(free) <= DENSE
    return not few and nets.suits(system) and nets.super_stable(system, state)


def amiss(system: System, state: State) -> str:
    """Why a shape cannot rest although its forces balance, as a sentence without its full stop: films that are folded
    over, bodies that lie in each other, particles below floors, beams turned against themselves. Empty where it can."""
    if system.films is not None and len(folded := system.films.folded(state.x, state.free)):
        more = f" (and at {len(folded) - 1} more)" if len(folded) > 1 else ""
        return (
            f"the film is folded over at particle {folded[0]}{more}: no film has this shape. Use auto, which spreads "
            "the triangles evenly, or start from a shape without folds"
        )
    particle, depth = system.sunk(state)
    if particle >= 0:
        unit = system.scene.units.length
        return f"particle {particle} lies {depth:.3g} {unit} below a floor. Use auto, which lays particles on floors"
    found = (group.cls.amiss(group.block, state.x) for group in system.groups if group.cls.rewired or group.cls.turns)
    return next((reason for reason in found if reason), "")


def movable(system: System, state: State, found: Balance) -> tuple[Floats, str]:
    """The axes (n, 3) on which particles may move from a shape at rest, 0 on the others; and why that is not known.

    What a floor holds is found by pushing: it is what carries a small force along an axis. Particles that nothing
    touches are left out: they are no part of the structure.
    """
    free, (label, joined) = state.free, (found.components.label, found.components.joined)
    if not joined.all():
        free = free.copy()
        free[(label >= 0) & ~joined[label]] = 0.0
    if not (system.contacts and found.contact.any()):
        return free, ""
    free, touching = free.copy(), (found.contact != 0.0).any(axis=1)
    carried = found.forces - found.contact  # what comes out of balance without the floor
    push = PUSH * lengths(found.contact)
    for axis in range(3):
        pushed = carried.copy()
        pushed[:, axis] += push * state.free[:, axis]
        system.support(state, pushed)
        moved = np.abs(pushed - found.forces)[touching].max(axis=1) > 0.5 * push[touching]
        passed = (pushed - found.forces)[touching, axis] > 0.99 * push[touching]
        if (moved & ~passed).any():
            return free, f"particle {int(np.flatnonzero(touching)[np.argmax(moved & ~passed)])} slides on a floor"
        free[np.flatnonzero(touching)[~moved], axis] = 0.0
    return free, ""


def _by_modes(system: System, state: State, free: Floats, found: Balance, method: Solver | None) -> Equilibrium:
    """By the factors of the tangent on what is `free` (n, 3), or by multigrid where they are large."""
    from hookean.stability.modes import iterated, settled

    if missing := system.no_tangent():
        return unknown(missing)
    if system.films is not None:  # multigrid has no axes across them
        counts = system.films.frames(state.x, free)[1]
        unknowns = int(np.count_nonzero(counts))
        if unknowns > LARGEST_FACTOR:
            return unknown(f"films of {unknowns} unknowns are too large to factor again")
        return _concluded(settled(system, state, found, free, DENSE), found)
    unknowns = int(np.count_nonzero(free))
    entries = sum(len(g.block.indices) * (3 * g.cls.arity) ** 2 for g in system.groups if not g.cls.constant)
    plain = nets.suits(system)
    if unknowns <= LARGEST_FACTOR and entries <= LARGEST_BLOCKS and not (plain and len(state.x) >= LARGE_NET):
        modes = settled(system, state, found, free, DENSE)
    elif missing := system.no_tangent(sparse=False):
        return unknown(missing)
    elif any(group.cls.rewired for group in system.groups):
        return unknown(f"contacts that come and go among {unknowns} unknowns are too many to factor")
    else:
        modes = iterated(system, replace(state, free=free), found, None if method is None else method.tangent)
    return _concluded(modes, found)


def _concluded(modes: Modes, found: Balance) -> Equilibrium:
    """The stability that follows from the modes."""
    if modes.reason:
        return unknown(modes.reason)
    errors = None if modes.moved is None else _largest(modes.moved, found)
    count: int | None
    if modes.unstable:
        kind, count = Stability.UNSTABLE, modes.unstable
        reason = "the energy falls along its softest mode"
    elif modes.loose:
        kind, count = Stability.MECHANISM, modes.loose
        reason = "1 motion meets no resistance" if count == 1 else f"{count} motions meet no resistance"
        reason = reason if modes.counted else "a motion meets no resistance"
    else:
        return Equilibrium(Stability.STABLE, position_errors=errors, position_reason=modes.unsettled)
    particle = int(np.argmax(lengths(modes.mode))) if modes.mode is not None else None
    count = count if modes.counted else None
    if kind is Stability.MECHANISM:
        singular = f"the tangent is singular: {reason}"
        return Equilibrium(kind, reason, particle, count, None, singular, modes.mode, beside=errors)
    return Equilibrium(kind, reason, particle, count, errors, modes.unsettled, modes.mode)


def _largest(moved: Floats, found: Balance) -> Floats:
    """The largest movement in each component."""
    size = lengths(moved)
    if len(found.scales) == 1:
        return np.array([size.max(initial=0.0)])
    label = found.components.label
    errors = np.zeros(len(found.scales))
    np.maximum.at(errors, label[label >= 0], size[label >= 0])
    return errors


def excess(system: System, state: State, found: Balance, rest: Equilibrium) -> float:
    """The largest position error of a component by the scene's position tolerance times the component's size [-]; 0
    where it is not known or does not count."""
    tolerance = system.scene.settings.position_tolerance
    errors = rest.position_errors if rest.position_errors is not None else rest.beside
    if tolerance is None or errors is None:
        return 0.0
    tolerance = max(tolerance, FINEST)
    sizes = components.sizes(found.components, system.groups, state.x)
    if (errors > tolerance * sizes).any():  # what has shrunk to a point has the size that it had
        sizes = np.maximum(sizes, components.sizes(found.components, system.groups, system.x))
    return float((errors / (tolerance * np.where(sizes > 0.0, sizes, 1.0))).max(initial=0.0))


def leave(system: System, state: State, rest: Equilibrium, sides: tuple[float, ...] = (1.0, -1.0)) -> float:
    """Move along the softest mode, or against it, to where the energy is lower: the side that was taken, 0 where it is
    lower nowhere."""
    if rest.mode is None:
        return 0.0
    start, energy, noise = state.x.copy(), *_energy(system, state)
    length = 0.01 * system.size
    for _ in range(20):
        for side in sides:
            step = side * length * rest.mode
            state.x = start + step
            fall = energy - _energy(system, state)[0]
            if fall > noise or (fall >= -noise and _gains(system, replace(state, x=start), step)):
                system.slots.fold(state)
                return side
        length *= 0.5
    state.x = start
    return 0.0


def _gains(system: System, state: State, step: Floats) -> bool:
    """Whether the forces along a step do work, where a heavier part hides how much energy falls: Gauss quadrature."""
    work, size = 0.0, 0.0
    for place, weight in zip(*np.polynomial.legendre.leggauss(4), strict=True):
        there = replace(state, x=state.x + 0.5 * (1.0 + place) * step)
        along = system.evaluate(there)[0] * state.free * step
        work, size = work + weight * float(along.sum()), size + weight * float(np.abs(along).sum())
    return work > DOUBTFUL * size


def _energy(system: System, state: State) -> tuple[float, float]:
    """The energy of a shape, and what of it may be rounding [force length]."""
    _, _, energies = system.evaluate(state)
    return float(energies.sum()), 1e-13 * float(np.abs(energies).sum())
