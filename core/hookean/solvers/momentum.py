"""Momentum: the published iteration of Kangaroo 2.

x += v; every force proposes moves, a particle takes their mean weighted by lumped stiffness: d = F / W;
x += d; v += d; where d . v < 0 the velocity shrinks to 0.9. A load weighs 1. Any stiffness is stable.
Source: T. Oberbichler's port, checked by its author against Kangaroo to machine accuracy.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

import numpy as np

from hookean.compiled import dispatch
from hookean.compiled.dispatch import forces, impacts, supports
from hookean.forces.rotations import fold
from hookean.solvers.base import Solver
from hookean.system.packing import contacts, lean

if TYPE_CHECKING:
    from hookean.system.state import State
    from hookean.system.system import System


def momentum_loop(  # type: ignore[no-untyped-def]
    full, hits, rests, x, v, free, load, still, f, w, mass, carried, loads, count, goal, slots, arms
):  # fmt: skip
    n = x.shape[0]
    for step in range(count):
        for i in range(n):
            w[i] = loads[i]
            for c in range(3):
                x[i, c] += v[i, c]
                f[i, c] = load[i, c]
        fold(x, v, slots, arms)
        impacts(hits, x[:slots], v[:slots], v[:slots], x[:slots], v[:slots], free[:slots], 0.0)
        forces(full, x, still, f, w)
        for i in range(n):
            for c in range(3):
                f[i, c] *= free[i, c]
        supports(rests, x[:slots], v[:slots], f[:slots], carried[:slots], free[:slots], mass[:slots], 0.0)
        worst = 0.0
        for i in range(n):
            size = f[i, 0] * f[i, 0] + f[i, 1] * f[i, 1] + f[i, 2] * f[i, 2]
            worst = max(worst, size)
            if size == 0.0 or w[i] == 0.0:
                for c in range(3):
                    v[i, c] = 0.0
                continue
            along = 0.0
            for c in range(3):
                d = f[i, c] / w[i]
                x[i, c] += d
                v[i, c] += d
                along += d * v[i, c]
            if along < 0.0:
                for c in range(3):
                    v[i, c] *= 0.9
        fold(x, v, slots, arms)
        impacts(hits, x[:slots], v[:slots], v[:slots], x[:slots], v[:slots], free[:slots], 0.0)
        if worst <= goal * goal:
            return step + 1
    return count


class Method(Solver):
    """Weighted means with momentum; robust for any mix of stiffnesses, slow on long chains."""

    name: ClassVar[str] = "momentum"

    def start(self, system: System, state: State) -> None:
        """Start from rest."""
        state.scratch.clear()
        state.v[:] = 0.0

    def advance(self, system: System, state: State, count: int, goal: float) -> int:
        """At most `count` iterations."""
        still, f, carried = (np.zeros_like(state.x) for _ in range(3))
        w = np.zeros(len(state.x))
        own = lean(system, state, damped=False)
        done = dispatch.compiled(momentum_loop)(
            own.full, *contacts(system), state.x, state.v, state.free, own.load, still, f, w, system.mass, carried,
            system.load_count, count, goal, system.slots.count, system.slots.lengths,
        )  # fmt: skip
        state.iteration += int(done)
        return int(done)
