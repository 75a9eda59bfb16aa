"""Relaxation: dynamic relaxation with kinetic damping and a fictitious mass for every particle.

Masses follow the stiffness each particle feels, so that a unit step is stable for any scene; at every peak of kinetic
energy all motion stops and starts again with half a step. With contacts a particle that no force acts on stops as
well: spheres that have parted would fly on without end, at no peak. Source: Barnes, "Form finding and analysis of
tension structures by dynamic relaxation", 1999.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from hookean.compiled import dispatch
from hookean.compiled.dispatch import forces, impacts, supports
from hookean.compiled.marks import device
from hookean.forces.rotations import fold
from hookean.solvers.base import Solver
from hookean.system.packing import Desk, contacts, lean

if TYPE_CHECKING:
    from hookean.system.state import State
    from hookean.system.system import System

# a unit step is stable while mass > w / 4 (w bounds the stiffness of a particle); a tenth more for safety
MASS = 0.275


@device
def put(values: Any, target: Any) -> None:
    """Copy one flat array to another."""
    for i in range(target.size):
        target[i] = values[i]


@device
def push(f: Any, v: Any, free: Any, mass: Any, inverse: Any, part: Any) -> Any:
    """Speeds after one step of the forces; returns the largest squared force left and twice the kinetic energy."""
    worst = 0.0
    kinetic = 0.0
    for i in range(f.shape[0]):
        step = part * inverse[i]
        f0 = f[i, 0] * free[i, 0]
        f1 = f[i, 1] * free[i, 1]
        f2 = f[i, 2] * free[i, 2]
        f3 = f[i, 3] * free[i, 3]
        v0 = v[i, 0] + step * f0
        v1 = v[i, 1] + step * f1
        v2 = v[i, 2] + step * f2
        v3 = v[i, 3] + step * f3
        f[i, 0] = f0
        f[i, 1] = f1
        f[i, 2] = f2
        f[i, 3] = f3
        v[i, 0] = v0
        v[i, 1] = v1
        v[i, 2] = v2
        v[i, 3] = v3
        kinetic += mass[i] * (v0 * v0 + v1 * v1 + v2 * v2)
        size = f0 * f0 + f1 * f1 + f2 * f2
        if size > worst:
            worst = size
    return worst, kinetic


@device
def move(x: Any, v: Any) -> Any:
    """One step, over flat arrays; `x += v` takes ten times as long."""
    for i in range(x.size):
        x[i] += v[i]


@device
def stop_what_is_free_of_force(f: Any, v: Any, free: Any, count: Any) -> None:
    """No speed where no force acts along any free axis."""
    for i in range(count):
        if f[i, 0] * free[i, 0] == 0.0 and f[i, 1] * free[i, 1] == 0.0 and f[i, 2] * free[i, 2] == 0.0:
            for c in range(4):
                v[i, c] = 0.0


@device
def step_back(x: Any, v: Any, f: Any, inverse: Any) -> Any:
    """To about where the peak of kinetic energy was, and at rest."""
    for i in range(x.shape[0]):
        for c in range(4):
            x[i, c] += 0.5 * inverse[i] * f[i, c] - 0.5 * v[i, c]
            v[i, c] = 0.0


@device
def weigh(mass: Any, inverse: Any, w: Any, caution: Any) -> Any:
    """Fictitious masses that make a unit step stable."""
    for i in range(mass.shape[0]):
        mass[i] = caution * w[i] if w[i] > 0.0 else 1.0
        inverse[i] = 1.0 / mass[i]


def relaxation_loop(  # type: ignore[no-untyped-def]
    full, packed, hits, rests, x, v, free, load, still, f, w, mass, inverse, carried, clock, count, goal, slots, arms,
    parting
):  # fmt: skip
    energy_before = clock[0]
    fresh = clock[1] != 0.0
    contacts = len(hits) + len(rests)
    flat_x, flat_v, flat_f, flat_load = x.reshape(x.size), v.reshape(x.size), f.reshape(x.size), load.reshape(x.size)
    for step in range(count):
        put(flat_load, flat_f)
        if fresh:
            w[:] = 0.0
            forces(full, x, still, f, w)
            weigh(mass, inverse, w, clock[2])
        else:
            forces(packed, x, still, f, w)
        if contacts > 0:
            f *= free
            supports(rests, x[:slots], v[:slots], f[:slots], carried[:slots], free[:slots], mass[:slots], 0.0)
        if parting:
            stop_what_is_free_of_force(f, v, free, slots)
        worst, kinetic = push(f, v, free, mass, inverse, 0.5 if fresh else 1.0)
        if worst <= goal * goal:
            v[:] = 0.0
            clock[0] = 0.0
            clock[1] = 1.0
            return step
        fresh = kinetic < energy_before
        if fresh:
            step_back(x, v, f, inverse)
            energy_before = 0.0
        else:
            move(flat_x, flat_v)
            energy_before = kinetic
        fold(x, v, slots, arms)
        if contacts > 0:
            impacts(hits, x[:slots], v[:slots], v[:slots], x[:slots], v[:slots], free[:slots], 0.0)
    clock[0] = energy_before
    clock[1] = 1.0 if fresh else 0.0
    return count


class Method(Solver):
    """Kinetic damping; the work horse for nets, membranes and shells."""

    name: ClassVar[str] = "relaxation"

    def __init__(self) -> None:
        self._desk = Desk()

    def start(self, system: System, state: State) -> None:
        """Rest, and the first step a half one."""
        n = len(state.x)
        state.v[:] = 0.0
        caution = float(state.scratch["clock"][2]) if "clock" in state.scratch else MASS
        state.scratch = {"clock": np.array([0.0, 1.0, caution]), "mass": np.ones(n)}

    def advance(self, system: System, state: State, count: int, goal: float) -> int:
        """At most `count` iterations, stopping at the first shape within `goal`."""
        n = len(state.x)
        own = lean(system, state, damped=False)
        x, v, free, load, still, f, carried = self._desk.lay(
            n, state.x, state.v, state.free, own.load, None, None, None
        )
        mass, parting = state.scratch["mass"], any(group.cls.rewired for group in system.groups)
        done = dispatch.compiled(relaxation_loop)(
            own.full, own.packed, *contacts(system), x, v, free, load, still, f, np.zeros(n), mass, 1.0 / mass, carried,
            state.scratch["clock"], count, goal, system.slots.count, system.slots.lengths,
            parting,
        )  # fmt: skip
        state.x[:], state.v[:] = x[:, :3], v[:, :3]
        state.iteration += int(done)
        return int(done)
