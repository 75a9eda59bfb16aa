"""Force density: one sparse linear solve, exact where every internal force is linear in the positions.

With rest length 0 a spring's force density is its stiffness k, and (sum of k (x_j - x_i)) + load = 0 is linear.
Source: Schek, "The force density method for form finding and computation of general networks", 1974.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

import numpy as np

from hookean.forces.anchor_spring import AnchorSpring
from hookean.forces.springs import Springs
from hookean.solvers.base import Solver

if TYPE_CHECKING:
    from hookean.state import State
    from hookean.system import System


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
        from hookean.solvers import _front
        from hookean.solvers._laplacian import laplacian

        if count < 1:
            return 0
        f, _, _ = system.evaluate(state)
        x = state.x.copy()
        left = [0, 1, 2]
        while left:
            # axes on which the same particles are held share one factor
            free = np.ascontiguousarray(state.free[:, left[0]])
            axes = [axis for axis in left if np.array_equal(state.free[:, axis], free)]
            left = [axis for axis in left if axis not in axes]
            net = laplacian(system, free)
            if net is None:
                return 0
            b = np.zeros((len(net.order), 4))
            for axis in axes:
                b[:, axis] = f[net.order, axis]
            if not _front.solve(net, b):
                return 0
            for axis in axes:
                x[net.order, axis] += b[:, axis]
        if not np.isfinite(x).all():
            return 0
        state.x[:] = x
        state.iteration += 1
        return 1
