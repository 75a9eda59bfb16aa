"""Reactions to rounding, of shapes that their coordinates do not hold as exactly as the tolerance asks for.

A stiff bar changes its force by k times the last digit of its coordinates, which may be more than the loads' share that
the tolerance allows. What is out of balance there is no error of the solver, and yet reactions and loads differ by it.
The movement K dx = r of one more exact step is too small for the coordinates, but not for what it does to the forces
at supports: R = -f + K dx, which loads balance to the rounding of the forces themselves.

Where the coordinates do hold it, that step is made instead: then moments balance as well, about where the shape is.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from hookean.linear.unsymmetric import skew_part, solve
from hookean.stability.equilibrium import LARGEST_FACTOR, movable
from hookean.system.balance import LOAD, Balance, balance

if TYPE_CHECKING:
    from hookean.solvers import Solver
    from hookean.system.state import State
    from hookean.system.system import System

Floats = NDArray[np.float64]


FINE = 1e-10  # part of all forces on a structure from which on what is out of balance is made smaller
STEPS = 3


def finer(system: System, state: State, found: Balance, method: Solver) -> Balance:
    """Take a shape at rest by exact steps to where what is out of balance adds up to at most `FINE` of the loads and
    reactions, as long as the steps bring it nearer; the balance there. `found` is that of the state."""
    for _ in range(STEPS):
        before, largest = state.x, float(np.abs(found.forces).max(initial=0.0))
        small = np.abs(found.forces).sum() <= FINE * _acting(found)
        step = None if small else _exact_step(system, state, found, method, steps=True)
        if step is None:
            return found
        state.x = before + step
        system.slots.fold(state)
        there = balance(system, state)
        if not np.abs(there.forces).max(initial=0.0) < largest or there.contact.any():  # not a number either
            state.x = before
            return found
        found = there
    return found


def _acting(found: Balance) -> float:
    """The sizes of loads and reactions in all [force]."""
    return float(found.found[:, LOAD].sum() + np.abs(found.reactions).sum())


def exact_reactions(system: System, state: State, found: Balance, method: Solver) -> Floats:
    """Reactions (n, 3) [force] of a shape at rest after one more exact step, or those that it has: where no
    more is left than the tolerance, or no such step is known. `found` is what is out of balance there, and `method` the
    solver that came to it."""
    if found.residual <= system.scene.settings.tolerance:
        return found.reactions
    step = _exact_step(system, state, found, method)
    if step is None:
        return found.reactions
    pull = np.zeros(state.x.shape)
    for group, memory in system.elements(state.x, state.memory):
        if not group.cls.constant and len(index := group.block.indices):
            own = system.stiffness_blocks(group, state, memory)
            each = np.einsum("eij,ej->ei", own, step[index].reshape(len(index), -1))
            np.add.at(pull, index, each.reshape(*index.shape, 3))
    return np.asarray(found.reactions + pull * (1.0 - state.free))


def _exact_step(system: System, state: State, found: Balance, method: Solver, *, steps: bool = False) -> Floats | None:
    """The movement (n, 3) that would end what is out of balance: K dx = r; None where no such step is known. `steps`:
    whether a tangent that Newton steps can use is enough."""
    carried = bool(system.contacts) and found.contact.any()  # what lies on floors may come off them
    plain = system.films is None and not carried and not system.no_tangent(sparse=False, steps=steps)
    free, _ = movable(system, state, found)
    if not plain or np.count_nonzero(free) > LARGEST_FACTOR:
        return None
    from hookean.linear.film_tangent import patterned

    pattern = patterned(system, state, free, method.pattern)
    factor = pattern.factors.factor(pattern.tangent(system, state))  # that of an unstable shape does as well
    if factor is None:
        return None
    skew, left = skew_part(system, state, pattern.dofs), pattern.gather(found.forces)
    moved = factor.solve(left) if skew is None else solve(factor.solve, skew, left)
    return None if not np.isfinite(moved).all() else np.asarray(pattern.spread(moved))
