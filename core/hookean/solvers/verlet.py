"""Verlet: velocity Verlet in physical time, with the scene's masses, damping and drag.

v' = v + dt/2 a(x, v);  x = x + dt v';  v = (v' + dt/2 a(x, v + dt a)) / (1 + dt c / 2m). Order 2 with damping too:
forces that depend on velocity see a predicted one, and drag is taken as the mean of before and after.
Source: Swope et al. 1982 for the undamped scheme.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

import numpy as np

from hookean import kernels
from hookean.solvers.base import Solver

if TYPE_CHECKING:
    from hookean.state import State
    from hookean.system import System


def verlet_loop(  # type: ignore[no-untyped-def]
    functions, indices, parameters, memory, impacts, supports, planes, notes, x, v, free, mass, f, raw, w, carried,
    x_before, v_before, acceleration, predicted, drag, steps, changing, fresh, count,
):  # fmt: skip
    n = x.shape[0]
    for _ in range(count):
        for s in range(steps.shape[0]):
            dt = steps[s]
            if changing or fresh:
                for i in range(n):
                    for c in range(3):
                        raw[i, c] = 0.0
                for b in range(len(functions)):
                    functions[b](x, v, indices[b], parameters[b], memory[b], raw, w)
                fresh = False
            for i in range(n):
                for c in range(3):
                    f[i, c] = raw[i, c] * free[i, c]
            for p in range(len(supports)):
                supports[p](x, v, f, carried, free, mass, dt, planes[p])
            for i in range(n):
                for c in range(3):
                    a = (f[i, c] - drag * v[i, c]) / mass[i] * free[i, c]
                    x_before[i, c] = x[i, c]
                    v_before[i, c] = v[i, c]
                    acceleration[i, c] = a
                    v[i, c] += 0.5 * dt * a
                    x[i, c] += dt * v[i, c]
            for p in range(len(impacts)):
                impacts[p](x_before, v_before, acceleration, x, v, free, dt, planes[p])
            for i in range(n):
                for c in range(3):
                    predicted[i, c] = v[i, c] + 0.5 * dt * acceleration[i, c]
                    raw[i, c] = 0.0
            for b in range(len(functions)):
                functions[b](x, predicted, indices[b], parameters[b], memory[b], raw, w)
            for i in range(n):
                for c in range(3):
                    f[i, c] = raw[i, c] * free[i, c]
            for p in range(len(supports)):
                supports[p](x, v, f, carried, free, mass, dt, planes[p])
            for i in range(n):
                for c in range(3):
                    push = v[i, c] + 0.5 * dt * f[i, c] / mass[i]
                    if free[i, c] != 0.0:  # held axes go on as fast as their anchor is led
                        v[i, c] = push / (1.0 + 0.5 * dt * drag / mass[i])
        for b in range(len(notes)):
            notes[b](x, indices[b], parameters[b], memory[b])


class Method(Solver):
    """Velocity Verlet; what classic Kangaroo does, and what bounces."""

    name: ClassVar[str] = "verlet"
    physical: ClassVar[bool] = True
    weights: ClassVar[tuple[float, ...]] = (1.0,)

    def advance(self, system: System, state: State, count: int, goal: float) -> int:
        """Exactly `count` time steps; physical time does not stop early."""
        n = len(state.x)
        step = system.scene.settings.time_step
        scratch = [np.zeros_like(state.x) for _ in range(7)]
        f, raw, carried, x_before, v_before, acceleration, predicted = scratch
        functions, indices, parameters, memory = system.tuples(state)
        notes = kernels.pointers([g.cls.end_of_step for g in system.groups], "remember")
        kernels.call(
            kernels.compiled(verlet_loop),
            functions, indices, parameters, memory, *system.hooks(), notes,
            state.x, state.v, state.free, system.mass, f, raw, np.zeros(n), carried,
            x_before, v_before, acceleration, predicted, system.drag,
            step * np.array(self.weights), system.damped or system.yields, True, count,
        )  # fmt: skip
        state.iteration += count
        for _ in range(count):
            # one by one: the same bits however the steps are divided into calls
            state.time += step
        return count
