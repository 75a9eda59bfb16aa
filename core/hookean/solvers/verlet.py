"""Verlet: velocity Verlet in physical time, with the scene's masses, damping and drag.

v' = v + dt/2 a(x, v);  x = x + dt v';  v = (v' + dt/2 a(x, v + dt a)) / (1 + dt c / 2m). Order 2 with damping too:
forces that depend on velocity see a predicted one, and drag is taken as the mean of before and after.
Source: Swope et al. 1982 for the undamped scheme.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from hookean import kernels
from hookean.solvers.base import Solver

if TYPE_CHECKING:
    from hookean.state import State
    from hookean.system import System


@kernels.device
def start_step(raw: Any, x: Any, v: Any, free: Any, inverse: Any, drag: Any, dt: Any, predicted: Any) -> None:
    """Half a step of speed, a whole one of place; the speed that forces are to see next, and none of them yet."""
    for i in range(x.shape[0]):
        for c in range(3):
            a = (raw[i, c] * free[i, c] - drag * v[i, c]) * inverse[i] * free[i, c]
            v[i, c] += 0.5 * dt * a
            x[i, c] += dt * v[i, c]
            predicted[i, c] = v[i, c] + 0.5 * dt * a
            raw[i, c] = 0.0


@kernels.device
def end_step(f: Any, v: Any, free: Any, inverse: Any, drag: Any, dt: Any) -> None:
    """The second half step of speed, drag included."""
    for i in range(v.shape[0]):
        half = 0.5 * dt * inverse[i]
        for c in range(3):
            if free[i, c] != 0.0:  # held axes go on as fast as their anchor is led
                v[i, c] = (v[i, c] + half * f[i, c]) / (1.0 + half * drag)


@kernels.device
def start_among_contacts(
    impacts: Any, supports: Any, planes: Any, raw: Any, f: Any, x: Any, v: Any, free: Any, mass: Any, inverse: Any,
    carried: Any, x_before: Any, v_before: Any, a: Any, drag: Any, dt: Any, predicted: Any,
) -> None:  # fmt: skip
    """`start_step` where contacts carry and catch."""
    for i in range(x.shape[0]):
        for c in range(3):
            f[i, c] = raw[i, c] * free[i, c]
    for p in range(len(supports)):
        supports[p](x, v, f, carried, free, mass, dt, planes[p])
    for i in range(x.shape[0]):
        for c in range(3):
            a[i, c] = (f[i, c] - drag * v[i, c]) * inverse[i] * free[i, c]
            x_before[i, c] = x[i, c]
            v_before[i, c] = v[i, c]
            v[i, c] += 0.5 * dt * a[i, c]
            x[i, c] += dt * v[i, c]
    for p in range(len(impacts)):
        impacts[p](x_before, v_before, a, x, v, free, dt, planes[p])
    for i in range(x.shape[0]):
        for c in range(3):
            predicted[i, c] = v[i, c] + 0.5 * dt * a[i, c]
            raw[i, c] = 0.0


def verlet_loop(  # type: ignore[no-untyped-def]
    functions, indices, parameters, memory, impacts, supports, planes, notes, x, v, free, mass, inverse, raw, w,
    f, carried, x_before, v_before, acceleration, predicted, drag, steps, contacts, changing, fresh, count,
):  # fmt: skip
    for _ in range(count):
        for s in range(steps.shape[0]):
            dt = steps[s]
            if changing or fresh:
                raw[:, :] = 0.0
                for b in range(len(functions)):
                    functions[b](x, v, indices[b], parameters[b], memory[b], raw, w)
                fresh = False
            if contacts:
                start_among_contacts(
                    impacts, supports, planes, raw, f, x, v, free, mass, inverse, carried,
                    x_before, v_before, acceleration, drag, dt, predicted,
                )  # fmt: skip
            else:  # the same in one pass over memory
                start_step(raw, x, v, free, inverse, drag, dt, predicted)
            for b in range(len(functions)):
                functions[b](x, predicted, indices[b], parameters[b], memory[b], raw, w)
            if contacts:
                f[:, :] = raw * free
                for p in range(len(supports)):
                    supports[p](x, v, f, carried, free, mass, dt, planes[p])
                end_step(f, v, free, inverse, drag, dt)
            else:
                end_step(raw, v, free, inverse, drag, dt)
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
        raw, predicted = np.zeros_like(state.x), np.zeros_like(state.x)
        contacts = bool(system.contacts)
        f, carried, x_before, v_before, a = [np.zeros_like(state.x) if contacts else raw for _ in range(5)]
        functions, indices, parameters, memory = system.tuples(state)
        notes = kernels.pointers([g.cls.end_of_step for g in system.groups], "remember")
        kernels.call(
            kernels.compiled(verlet_loop),
            functions, indices, parameters, memory, *system.hooks(), notes,
            state.x, state.v, state.free, system.mass, 1.0 / system.mass, raw, np.zeros(n),
            f, carried, x_before, v_before, a, predicted, system.drag,
            step * np.array(self.weights), contacts, system.damped or system.yields, True, count,
        )  # fmt: skip
        state.iteration += count
        for _ in range(count):
            # one by one: the same bits however the steps are divided into calls
            state.time += step
        return count
