"""Force density: one sparse linear solve, exact where every internal force is linear in the positions.

With rest length 0 a spring's force density is its stiffness k, and (sum of k (x_j - x_i)) + load = 0 is linear: one
matrix, of a number for each pair of particles, serves all axes on which the same particles are held. A front solves it
where that is quick, conjugate gradients over coarser nets where the front is wide.
Source: Schek, "The force density method for form finding and computation of general networks", 1974.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, ClassVar

import numpy as np
from numpy.typing import NDArray

from hookean.compiled import dispatch
from hookean.forces.anchor_spring import AnchorSpring, slides
from hookean.forces.springs import Springs
from hookean.solvers.base import Solver
from hookean.system.balance import ROUNDING

if TYPE_CHECKING:
    from hookean.linear.front_cholesky import Factor
    from hookean.linear.laplacian import Laplacian
    from hookean.linear.scalar_hierarchy import Hierarchy
    from hookean.system.balance import Balance
    from hookean.system.state import State
    from hookean.system.system import System

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

QUICK = 5_000  # multiplications for each particle up to which a front is quicker than conjugate gradients
MOST = 1e11  # beyond which it would take half a minute, and more than a gigabyte


class Method(Solver):
    """One linear solve; only for springs of rest length 0, soft anchors and loads."""

    name: ClassVar[str] = "force_density"
    together: ClassVar[int] = 1

    def refuse(self, system: System) -> str:
        """A sentence unless every internal force is linear."""
        return nonlinear(system)

    def __init__(self) -> None:
        self.solved: list[Solved] = []

    def start(self, system: System, state: State) -> None:
        """Start from rest."""
        state.scratch.clear()
        state.v[:] = 0.0
        self.certain, self.solved = False, []

    def advance(self, system: System, state: State, count: int, goal: float) -> int:
        """Solve K dx = f on the free axes; none done if some particles are unsupported."""
        if count < 1:
            return 0
        f, _, _ = system.evaluate(state)
        x = state.x.copy()
        self.solved, self.certain = [], False
        for free, axes in alike(state.free):
            solved = Solved.of(system, free, axes, f, x)
            if solved is None:
                return 0
            self.solved.append(solved)
        if not np.isfinite(x).all():
            return 0
        state.x[:] = x
        state.iteration += 1
        self.certain = True
        return 1

    def correction(self, system: System, state: State, found: Balance) -> Floats | None:
        """The next solve, by the factors of the last one, or one cycle."""
        moved = np.zeros(state.x.shape)
        for solved in self.solved:
            solved.correct(found.forces, moved)
        return moved if self.certain else None


def nonlinear(system: System, *, weights: bool = False) -> str:
    """Why a system is not linear, as a sentence; empty if it is. With `weights` loads may act whose size follows the
    shape (`Force.directed`)."""
    if system.contacts:
        return "a floor is not linear; force_density supports springs of rest length 0 only"
    linear = False
    for group in system.groups:
        if group.cls.role == "load" and (group.cls.conservative or (weights and group.cls.directed)):
            continue
        if group.cls is AnchorSpring:
            if slides(group.block):
                return "an anchor spring may slide; force_density supports linear forces only"
            linear = True
            continue
        if group.cls is not Springs:
            return f"it has {group.cls.kind_name}; force_density supports loads and springs of rest length 0 only"
        p = group.block.parameters
        if (p[:, 2] * p[:, 3]).any() or p[:, 4:].any():  # quicker than to compare with 0
            return "a spring has a rest length, a cutoff or plasticity; force_density supports rest length 0 only"
        linear = linear or bool(len(p))
    return "" if linear else "there is no spring"


def alike(free: Floats) -> Iterator[tuple[Floats, Ints]]:
    """Which particles (n,) are free on axes on which the same ones are, and these axes."""
    left = [0, 1, 2]
    while left:
        own = np.ascontiguousarray(free[:, left[0]])
        axes = [axis for axis in left if np.array_equal(free[:, axis], own)]
        left = [axis for axis in left if axis not in axes]
        yield own, np.array(axes)


class Solved:
    """K in factors, or ready to be solved with by cycles, on some axes, on which the particles with `free` (n,) above 0
    move."""

    def __init__(self, net: Laplacian, particles: NDArray[np.int32], axes: Ints) -> None:
        self.net, self.particles, self.axes = net, particles, axes
        self.factor: Factor | None = None
        self.hierarchy: Hierarchy | None = None

    @classmethod
    def of(cls, system: System, free: Floats, axes: Ints, f: Floats, x: Floats) -> Solved | None:
        """Add K^-1 f to x (n, 3); None where that was not possible."""
        from hookean.linear import laplacian as _laplacian

        self = cls(*_laplacian.laplacian(system, free), axes)
        b = self._rows(f)
        largest = max(float(x.max()), -float(x.min()))
        if not self._solve(b, largest):
            return None
        dispatch.compiled(_laplacian.put)(self.particles, axes, b, x)
        return self

    def _rows(self, f: Floats) -> Floats:
        from hookean.linear import laplacian as _laplacian

        b = np.empty((len(self.particles), 4))
        dispatch.compiled(_laplacian.take)(self.particles, self.axes, f, b)
        return b

    def _solve(self, b: Floats, largest: float) -> bool:
        """Replace b (rows, 4) by the solution, by a front where that is quick; whether that was possible."""
        from hookean.linear import front_cholesky as _front
        from hookean.linear import scalar_cg as _gradients
        from hookean.linear.scalar_hierarchy import Hierarchy

        net = self.net
        way = _front.front(net, QUICK * len(b))
        if way is None:
            # |A| |x| is twice the stiffness times what is largest of x: that rounds
            stiffness = net.values[net.diagonal]
            goal = ROUNDING * largest * float(np.sqrt((stiffness * stiffness).sum()))
            self.hierarchy = Hierarchy(net)
            found = _gradients.solve(self.hierarchy, b.copy(), goal)
            if found is not None:
                b[:] = found
                return True
            way = _front.front(net, MOST)  # stiffnesses that differ by more than 1e16
        self.factor = _front.Factor(net, way) if way is not None and way.held else None
        if self.factor is None or not self.factor.sound:
            return False
        self.factor.solve(b, b)
        return True

    @classmethod
    def ready(cls, system: System, free: Floats, axes: Ints) -> Solved:
        """Ready for cycles."""
        from hookean.linear import laplacian as _laplacian
        from hookean.linear.scalar_hierarchy import Hierarchy

        self = cls(*_laplacian.laplacian(system, free), axes)
        self.hierarchy = Hierarchy(self.net)
        return self

    def add(self, f: Floats, x: Floats, left: float) -> bool:
        """Add K^-1 f to x (n, 3), where a part `left` of f may remain; whether that was possible."""
        from hookean.linear import laplacian as _laplacian
        from hookean.linear import scalar_cg as _gradients

        b = self._rows(f)
        goal = left * float(np.sqrt((b * b).sum(axis=0).max()))
        if goal == 0.0:
            return True
        if self.factor is not None:
            self.factor.solve(b, b)
        elif self.hierarchy is not None:
            found = _gradients.solve(self.hierarchy, b, goal)
            if found is None:
                return False
            b = found
        dispatch.compiled(_laplacian.put)(self.particles, self.axes, b, x)
        return True

    def correct(self, f: Floats, moved: Floats) -> None:
        """Add about K^-1 f to `moved` (n, 3): a cycle is right within a factor of 2."""
        from hookean.linear import laplacian as _laplacian

        b = self._rows(f)
        if self.factor is not None:
            self.factor.solve(b, b)
        elif self.hierarchy is not None:
            b = self.hierarchy.cycle(b)[0]
        dispatch.compiled(_laplacian.put)(self.particles, self.axes, b, moved)
