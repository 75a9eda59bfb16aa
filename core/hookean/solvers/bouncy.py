"""Bouncy: a swing that soon comes to rest. The mass of every particle is the stiffness that it feels.

d = f / w; v' = k (v + d - d0) + d; x' = x + v', by iteration. w is the lumped stiffness of the shape, in which a load
weighs 1, and d0 is d of the iteration before, as in `momentum`: d - d0 damps what is stiff, and what is soft swings. k
is the part of the velocity that the drag c leaves a mass m in a step h of `verlet`, (2 m - c h) / (2 m + c h). Masses
follow the stiffness, so that any is stable. Contacts rebound and rub as in physical time, with an iteration for the
step. Drag also slows what is soft: once it has left but a part `ENDED` of a swing, k is 1, and a velocity against the
force shrinks to 0.9, which is the iteration of `momentum`. Sources: Kangaroo 2's iteration as there, with the 0.99 of
the velocity that its BouncySolver keeps; for such masses, Barnes, "Form finding and analysis of tension structures by
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


ENDED = 1e-6  # part of its first amplitude that is left of a swing when it counts as ended
SHRINKS = 0.9


@device
def ways(f: Any, w: Any, d: Any) -> Any:
    """The ways d that forces propose; returns the largest squared force."""
    worst = 0.0
    for i in range(f.shape[0]):
        worst = max(worst, f[i, 0] * f[i, 0] + f[i, 1] * f[i, 1] + f[i, 2] * f[i, 2])
        inverse = 1.0 / w[i] if w[i] > 0.0 else 1.0
        for c in range(3):
            d[i, c] = f[i, c] * inverse
    return worst


@device
def swing(
    x: Any, v: Any, d: Any, before: Any, k: Any, shrinks: Any, i: Any, x_before: Any, v_before: Any, a: Any
) -> None:
    """Velocity and place of one particle after an iteration; what impacts ask for: where and how fast it was, its
    acceleration by iteration."""
    along = 0.0
    for c in range(3):
        a[i, c] = d[i, c] + k * (d[i, c] - before[i, c])
        x_before[i, c] = x[i, c]
        v_before[i, c] = k * v[i, c] + 0.5 * a[i, c]  # speeds are those of half steps
        v[i, c] = k * v[i, c] + a[i, c]
        along += d[i, c] * (v[i, c] - d[i, c])
        before[i, c] = d[i, c]
    for c in range(3):
        v[i, c] = shrinks * (v[i, c] - d[i, c]) + d[i, c] if along < 0.0 else v[i, c]
        x[i, c] += v[i, c]


def bouncy_loop(  # type: ignore[no-untyped-def]
    full, hits, rests, x, v, free, load, still, f, w, d, before, a, x_before, v_before, carried, kept, loads, count,
    left, goal, slots, arms,
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
        supports(rests, x[:slots], v[:slots], f[:slots], carried[:slots], free[:slots], w[:slots], 1.0)
        worst = ways(f, w, d)
        if worst <= goal * goal:
            return step
        for i in range(n):
            if step < left:
                swing(x, v, d, before, kept[i], 1.0, i, x_before, v_before, a)
            else:
                swing(x, v, d, before, 1.0, SHRINKS, i, x_before, v_before, a)
        fold(x, v, slots, arms)
        impacts(hits, x_before[:slots], v_before[:slots], a[:slots], x[:slots], v[:slots], free[:slots], 1.0)
    return count


class Method(Solver):
    """Fictitious masses and drag; bounces as Kangaroo 2 does, for shapes that a person watches."""

    name: ClassVar[str] = "bouncy"

    def start(self, system: System, state: State) -> None:
        """Start from rest."""
        state.scratch = {"swung": np.zeros(1), "way": np.zeros(state.x.shape)}
        state.v[:] = 0.0

    def advance(self, system: System, state: State, count: int, goal: float) -> int:
        """At most `count` iterations, stopping at the first shape within `goal`."""
        if "swung" not in state.scratch:
            self.start(system, state)
        swung, before = state.scratch["swung"], state.scratch["way"]
        still, f, d, a, x_before, v_before, carried = (np.zeros_like(state.x) for _ in range(7))
        w, half = np.zeros(len(state.x)), 0.5 * system.drag * system.scene.settings.time_step
        kept = np.maximum(system.mass - half, 0.0) / (system.mass + half)
        keeps = float(kept.max(initial=0.0))
        swings = np.inf if keeps == 1.0 else 2.0 * np.log(ENDED) / np.log(keeps) if keeps > 0.0 else 0.0
        own = lean(system, state, damped=False)
        done = dispatch.compiled(bouncy_loop)(
            own.full, *contacts(system), state.x, state.v, state.free, own.load, still, f, w, d, before, a, x_before,
            v_before, carried, kept, system.load_count, count, swings - swung[0], goal, system.slots.count,
            system.slots.lengths,
        )  # fmt: skip
        swung += done
        state.iteration += int(done)
        return int(done)
