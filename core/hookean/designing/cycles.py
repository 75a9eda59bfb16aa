"""One solve with the tangent of a large net by conjugate gradients and multigrid cycles, as the forward solve does it:
quicker than factors where it is the only one."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from hookean.solvers import force_density, multilevel
from hookean.solvers.force_density import Solved

if TYPE_CHECKING:
    from hookean.linear.tangent import Tangent
    from hookean.solvers.base import Solver
    from hookean.system.state import State
    from hookean.system.system import System

Floats = NDArray[np.float64]

MANY = 3_000  # particles from which on it pays
LEFT = 1e-11  # part of the right side that may be left
MOST = 500  # steps


class Cycles:
    """What solves with the tangent K of a shape, by what the solver that found it ended with; `usable` where K is
    positive definite."""

    def __init__(self, system: System, state: State, method: Solver | None) -> None:
        self.system, self.state = system, state
        self._solved: Sequence[Solved] = ()
        self._tangent: Tangent | None = None
        self.usable = len(state.x) >= MANY and self._ready(method)

    def _ready(self, method: Solver | None) -> bool:
        system, state = self.system, self.state
        if not force_density.Method().refuse(system):
            return self._linear(() if method is None else method.solved)
        groups = zip(system.groups, state.memory, strict=True)
        alone = all(group.cls.gathered(group.block, memory, state.x, None) is None for group, memory in groups)
        conservative = all(group.conservative or group.cls.constant for group in system.groups)
        if not conservative or not alone or multilevel.Method().refuse(system):
            return False
        from hookean.linear.tangent import Tangent

        known = None if method is None else method.tangent
        self._tangent = known or Tangent(system, state)
        return bool(self._tangent.take_up(system, state, 0.0))

    def _linear(self, known: Sequence[Solved]) -> bool:
        """What solves on each set of axes on which the same particles are free: known, or by cycles."""
        free = self.state.free
        sets = [(own, axes) for own, axes in force_density.alike(free) if own.any()]
        self._solved = known or [Solved.ready(self.system, own, axes) for own, axes in sets]
        held = all(solved.hierarchy is None or solved.hierarchy.held for solved in self._solved)
        rows = sum(len(solved.particles) * len(solved.axes) for solved in self._solved)
        return held and rows == np.count_nonzero(free)

    def solve(self, b: Floats, left: float = LEFT) -> Floats | None:
        """K^-1 b (n, 3) on the free axes, of which a part may be left; None where that did not come to an end."""
        b = b.reshape(-1, 3) * (self.state.free > 0.0)
        if self._tangent is not None:
            found, positive = self._tangent.solve(b, left, MOST)
            return found if positive and found is not None and np.isfinite(found).all() else None
        total = np.zeros_like(b)
        return total if all(solved.add(b, total, left) for solved in self._solved) else None
