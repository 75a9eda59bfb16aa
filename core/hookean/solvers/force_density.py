"""Force density: one sparse linear solve, exact where every internal force is linear in the positions.

With rest length 0 a spring's force density is its stiffness k, and (sum of k (x_j - x_i)) + load = 0 is linear: one
matrix, of a number for each pair of particles, serves all axes on which the same particles are held. A front solves it
where that is quick, conjugate gradients over coarser nets where the front is wide.
Source: Schek, "The force density method for form finding and computation of general networks", 1974.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

import numpy as np
from numpy.typing import NDArray

from hookean import kernels
from hookean.balance import ROUNDING
from hookean.forces.anchor_spring import AnchorSpring
from hookean.forces.springs import Springs
from hookean.solvers.base import Solver

if TYPE_CHECKING:
    from hookean.state import State
    from hookean.system import System

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

QUICK = 5_000  # multiplications for each particle up to which a front is quicker than conjugate gradients
MOST = 1e11  # beyond which it would take half a minute, and more than a gigabyte


class Method(Solver):
    """One linear solve; only for springs of rest length 0, soft anchors and loads."""

    name: ClassVar[str] = "force_density"

    def refuse(self, system: System) -> str:
        """A sentence unless every internal force is linear."""
        if system.contacts:
            return "a floor is not linear; force_density needs springs of rest length 0 alone"
        linear = False
        for group in system.groups:
            if group.cls.role == "load" and group.cls.conservative:
                continue
            if group.cls is AnchorSpring:
                linear = True
                continue
            if group.cls is not Springs:
                return f"{group.cls.__name__} is not linear; force_density needs springs of rest length 0 alone"
            p = group.block.parameters
            if (p[:, 2] * p[:, 3] != 0).any() or (p[:, 4:] != 0).any():
                return "a spring has a rest length, a cutoff or plasticity; force_density needs rest length 0 alone"
            linear = linear or bool(len(p))
        return "" if linear else "there is no spring"

    def start(self, system: System, state: State) -> None:
        """Start from rest."""
        state.scratch.clear()
        state.v[:] = 0.0

    def advance(self, system: System, state: State, count: int, goal: float) -> int:
        """Solve K dx = f on the free axes; none done where some particles hang on nothing that is held."""
        if count < 1:
            return 0
        f, _, _ = system.evaluate(state)
        x = state.x.copy()
        left = [0, 1, 2]
        while left:
            free = np.ascontiguousarray(state.free[:, left[0]])
            axes = [axis for axis in left if np.array_equal(state.free[:, axis], free)]
            left = [axis for axis in left if axis not in axes]
            if not _solve(system, free, np.array(axes), f, x):
                return 0
        if not np.isfinite(x).all():
            return 0
        state.x[:] = x
        state.iteration += 1
        return 1


def _solve(system: System, free: Floats, axes: Ints, f: Floats, x: Floats) -> bool:
    """Add K^-1 f to x on some axes, on which the particles with `free` (n,) above 0 move; whether that was possible."""
    from hookean.solvers import _front, _gradients, _laplacian

    net, particles = _laplacian.laplacian(system, free)
    b = np.empty((len(particles), 4))
    kernels.compiled(_laplacian.take)(particles, axes, f, b)
    way = _front.front(net, QUICK * len(particles))
    if way is None:
        # |A| |x| is twice the stiffness times what is largest of x: that rounds
        largest, stiffness = max(float(x.max()), -float(x.min())), net.values[net.diagonal]
        goal = ROUNDING * largest * float(np.sqrt((stiffness * stiffness).sum()))
        found = _gradients.solve(net, b.copy(), goal)
        if found is not None:
            kernels.compiled(_laplacian.put)(particles, axes, found, x)
            return True
        way = _front.front(net, MOST)  # stiffnesses that differ by more than 1e16
    factor = _front.Factor(net, way) if way is not None and way.held else None
    if factor is None or not factor.sound:
        return False
    factor.solve(b, b)
    kernels.compiled(_laplacian.put)(particles, axes, b, x)
    return True
