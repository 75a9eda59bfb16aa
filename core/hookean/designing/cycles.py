"""One solve with the tangent of a large net by conjugate gradients and multigrid cycles, as the forward solve does it:
quicker than factors where it is the only one."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from hookean.solvers import force_density, multilevel

if TYPE_CHECKING:
    from hookean.system.state import State
    from hookean.system.system import System

Floats = NDArray[np.float64]

MANY = 3_000  # particles from which on it pays
LEFT = 1e-11  # part of the right side that may be left
MOST = 500  # steps


class Cycles:
    """What solves with the tangent K of a shape; `usable` where it has one that is positive definite."""

    def __init__(self, system: System, state: State) -> None:
        self.system, self.state = system, state
        self._scalar: list[tuple[Any, Any, Any]] = []
        self._tangent: Any = None
        self.usable = len(state.x) >= MANY and self._ready()

    def _ready(self) -> bool:
        system, state = self.system, self.state
        if not force_density.Method().refuse(system):
            return self._scalars()
        groups = zip(system.groups, state.memory, strict=True)
        alone = all(group.cls.gathered(group.block, memory, state.x, None) is None for group, memory in groups)
        conservative = all(group.cls.conservative or group.cls.constant for group in system.groups)
        if not conservative or not alone or multilevel.Method().refuse(system):
            return False
        from hookean.linear.tangent import Tangent

        self._tangent = Tangent(system, state)
        return bool(self._tangent.take_up(system, state, 0.0))

    def _scalars(self) -> bool:
        """A hierarchy for each set of axes on which the same particles are free."""
        from hookean.linear.laplacian import laplacian
        from hookean.linear.scalar_hierarchy import Hierarchy

        free, left = self.state.free, [0, 1, 2]
        while left:
            axes = [axis for axis in left if np.array_equal(free[:, axis], free[:, left[0]])]
            left = [axis for axis in left if axis not in axes]
            if not free[:, axes[0]].any():
                continue
            net, particles = laplacian(self.system, free[:, axes[0]])
            hierarchy = Hierarchy(net)
            if not hierarchy.held or len(particles) < np.count_nonzero(free[:, axes[0]]):
                return False
            self._scalar.append((hierarchy, particles, axes))
        return True

    def solve(self, b: Floats, left: float = LEFT) -> Floats | None:
        """K^-1 b (n, 3) on the free axes, of which a part may be left; None where that did not come to an end."""
        b = b.reshape(-1, 3) * (self.state.free > 0.0)
        if self._tangent is not None:
            found, positive = self._tangent.solve(b, left, MOST)
            return found if positive and found is not None and np.isfinite(found).all() else None
        from hookean.linear.scalar_cg import solve

        total = np.zeros_like(b)
        for hierarchy, particles, axes in self._scalar:
            right = np.zeros((len(particles), 4))
            right[:, axes] = b[particles][:, axes]
            goal = left * float(np.sqrt((right**2).sum(axis=0).max()))
            if goal > 0.0:
                found = solve(hierarchy, right, goal)
                if found is None:
                    return None
                total[particles[:, None], axes] = found[:, axes]
        return total
