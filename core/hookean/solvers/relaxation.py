"""Relaxation: dynamic relaxation with kinetic damping and a fictitious mass for every particle.

Masses follow the stiffness each particle feels, so that a unit step is stable for any scene; at every peak of kinetic
energy all motion stops and starts again with half a step. Source: Barnes, "Form finding and analysis of tension
structures by dynamic relaxation", 1999.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

import numpy as np

from hookean import kernels
from hookean.solvers.base import Solver

if TYPE_CHECKING:
    from hookean.state import State
    from hookean.system import System

# a unit step is stable while mass > w / 4 (w bounds the stiffness of a particle); a tenth more for safety
MASS = 0.275


def relaxation_loop(  # type: ignore[no-untyped-def]
    functions, indices, parameters, memory, impacts, supports, planes, x, v, free, still, f, w, mass, carried, clock,
    count, goal,
):  # fmt: skip
    n = x.shape[0]
    energy_before = clock[0]
    fresh = clock[1] != 0.0
    limit = goal * goal
    for step in range(count):
        for i in range(n):
            w[i] = 0.0
            for c in range(3):
                f[i, c] = 0.0
        for b in range(len(functions)):
            functions[b](x, still, indices[b], parameters[b], memory[b], f, w)
        for i in range(n):
            for c in range(3):
                f[i, c] *= free[i, c]
        for p in range(len(supports)):
            supports[p](x, v, f, carried, free, mass, 0.0, planes[p])
        if fresh:
            for i in range(n):
                mass[i] = clock[2] * w[i] if w[i] > 0.0 else 1.0
        worst = 0.0
        kinetic = 0.0
        part = 0.5 if fresh else 1.0
        for i in range(n):
            size = 0.0
            push = part / mass[i]
            for c in range(3):
                size += f[i, c] * f[i, c]
                u = v[i, c] + push * f[i, c]
                v[i, c] = u
                kinetic += mass[i] * u * u
            worst = max(worst, size)
        if worst <= limit:
            for i in range(n):
                for c in range(3):
                    v[i, c] = 0.0
            clock[0] = 0.0
            clock[1] = 1.0
            return step
        fresh = False
        if kinetic < energy_before:
            # past the peak: step back to about where it was, and start again from rest
            for i in range(n):
                for c in range(3):
                    x[i, c] += 0.5 * f[i, c] / mass[i] - 0.5 * v[i, c]
                    v[i, c] = 0.0
            energy_before = 0.0
            fresh = True
        else:
            for i in range(n):
                for c in range(3):
                    x[i, c] += v[i, c]
            energy_before = kinetic
        for p in range(len(impacts)):
            impacts[p](x, v, v, x, v, free, 0.0, planes[p])
    clock[0] = energy_before
    clock[1] = 1.0 if fresh else 0.0
    return count


class Method(Solver):
    """Kinetic damping; the work horse for nets, membranes and shells."""

    name: ClassVar[str] = "relaxation"

    def start(self, system: System, state: State) -> None:
        """Rest, and the first step a half one."""
        n = len(state.x)
        state.v[:] = 0.0
        caution = float(state.scratch["clock"][2]) if "clock" in state.scratch else MASS
        state.scratch = {"clock": np.array([0.0, 1.0, caution]), "mass": np.ones(n)}

    def advance(self, system: System, state: State, count: int, goal: float) -> int:
        """At most `count` iterations, stopping at the first shape within `goal`."""
        still, f, carried = (np.zeros_like(state.x) for _ in range(3))
        done = kernels.call(
            kernels.compiled(relaxation_loop),
            *system.tuples(state),
            *system.hooks(),
            state.x, state.v, state.free, still, f, np.zeros(len(state.x)), state.scratch["mass"], carried,
            state.scratch["clock"], count, goal,
        )  # fmt: skip
        state.iteration += int(done)
        return int(done)
