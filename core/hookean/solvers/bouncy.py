"""Bouncy: a swing that soon comes to rest. The mass of every particle is the stiffness that it feels.

v' = k v + f / w; x' = x + v', by iteration. w is the lumped stiffness of the shape, in which a load weighs 1 as in
`momentum`; k is the part of the velocity that the drag c leaves a mass m in a step h of `verlet`,
(2 m - c h) / (2 m + c h). Masses follow the stiffness, so no vibration is faster than a radian an iteration, any
stiffness is stable, and soft parts come to rest about as soon as stiff ones. Contacts rebound and rub as in physical
time, with an iteration for the step. Sources: Kangaroo 2's iteration as `momentum` has it, with the 0.99 of the
velocity that its BouncySolver keeps; for such masses, Barnes, "Form finding and analysis of tension structures by
dynamic relaxation", 1999.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from hookean.compiled import dispatch
from hookean.compiled.dispatch import forces, impacts, supports
from hookean.compiled.marks import device
from hookean.forces.rotations import fold
from hookean.solvers.base import Solver
from hookean.system.packing import contacts, lean

if TYPE_CHECKING:
    from hookean.system.state import State
    from hookean.system.system import System


@device
def accelerate(f: Any, w: Any, a: Any) -> Any:
    """Accelerations by iteration; returns the largest squared force."""
    worst = 0.0
    for i in range(f.shape[0]):
        worst = max(worst, f[i, 0] * f[i, 0] + f[i, 1] * f[i, 1] + f[i, 2] * f[i, 2])
        inverse = 1.0 / w[i] if w[i] > 0.0 else 1.0
        for c in range(3):
            a[i, c] = f[i, c] * inverse
    return worst


def bouncy_loop(  # type: ignore[no-untyped-def]
    full, hits, rests, x, v, free, load, still, f, w, a, x_before, v_before, carried, kept, loads, count, goal, slots,
    arms,
):  # fmt: skip
    n = x.shape[0]
    for step in range(count):
        for i in range(n):
            w[i] = loads[i]
            for c in range(3):
                f[i, c] = load[i, c]
        forces(full, x, still, f, w)
        for i in range(n):
            for c in range(3):
                f[i, c] *= free[i, c]
                v[i, c] *= kept[i]
        supports(rests, x[:slots], v[:slots], f[:slots], carried[:slots], free[:slots], w[:slots], 1.0)
        worst = accelerate(f, w, a)
        if worst <= goal * goal:
            return step
        for i in range(n):
            for c in range(3):
                x_before[i, c] = x[i, c]
                v_before[i, c] = v[i, c] + 0.5 * a[i, c]  # speeds are those of half steps
                v[i, c] += a[i, c]
                x[i, c] += v[i, c]
        fold(x, v, slots, arms)
        impacts(hits, x_before[:slots], v_before[:slots], a[:slots], x[:slots], v[:slots], free[:slots], 1.0)
    return count


class Method(Solver):
    """Fictitious masses and drag; bounces as Kangaroo 2 does, for shapes that a person watches."""

    name: ClassVar[str] = "bouncy"

    def start(self, system: System, state: State) -> None:
        """Start from rest."""
        state.scratch.clear()
        state.v[:] = 0.0

    def advance(self, system: System, state: State, count: int, goal: float) -> int:
        """At most `count` iterations, stopping at the first shape within `goal`."""
        still, f, a, x_before, v_before, carried = (np.zeros_like(state.x) for _ in range(6))
        w, half = np.zeros(len(state.x)), 0.5 * system.drag * system.scene.settings.time_step
        kept = np.maximum(system.mass - half, 0.0) / (system.mass + half)
        own = lean(system, state, damped=False)
        done = dispatch.compiled(bouncy_loop)(
            own.full, *contacts(system), state.x, state.v, state.free, own.load, still, f, w, a, x_before, v_before,
            carried, kept, system.load_count, count, goal, system.slots.count, system.slots.lengths,
        )  # fmt: skip
        state.iteration += int(done)
        return int(done)
