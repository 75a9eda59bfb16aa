"""Reactions to rounding, of shapes that their coordinates do not hold as exactly as the tolerance asks for.

A stiff bar changes its force by k times the last digit of its coordinates, which may be more than the loads' share that
the tolerance allows. What is out of balance there is no error of the solver, and yet reactions and loads differ by it.
The movement K dx = r of one more exact step is too small for the coordinates, but not for what it does to the forces
at supports: R = -f + K dx, which loads balance to the rounding of the forces themselves.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from hookean.stability.equilibrium import LARGEST_FACTOR, movable

if TYPE_CHECKING:
    from hookean.solvers import Solver
    from hookean.system.balance import Balance
    from hookean.system.state import State
    from hookean.system.system import System

Floats = NDArray[np.float64]


def exact_reactions(system: System, state: State, found: Balance, method: Solver) -> Floats:
    """Reactions (n, 3) [force] of a shape at rest after one more exact step, or those that it has: where no
    more is left than the tolerance, or no such step is known. `found` is what is out of balance there, and `method` the
    solver that came to it."""
    plain = system.films is None and not system.contacts and not system.no_tangent(sparse=False)
    free, _ = movable(system, state, found)
    if not plain or found.residual <= system.scene.settings.tolerance or np.count_nonzero(free) > LARGEST_FACTOR:
        return found.reactions
    from hookean.linear.film_tangent import patterned

    pattern = patterned(system, state, free, method.pattern)
    moved = pattern.factors.solve(pattern.tangent(system, state), pattern.gather(found.forces))
    if moved is None:
        return found.reactions
    step, pull = pattern.spread(moved), np.zeros(state.x.shape)
    for group, memory in system.elements(state.x, state.memory):
        if not group.cls.constant and len(index := group.block.indices):
            own = system.stiffness_blocks(group, state, memory)
            each = np.einsum("eij,ej->ei", own, step[index].reshape(len(index), -1))
            np.add.at(pull, index, each.reshape(*index.shape, 3))
    return np.asarray(found.reactions + pull * (1.0 - state.free))
