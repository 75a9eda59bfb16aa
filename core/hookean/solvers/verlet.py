"""Verlet: velocity Verlet in physical time, with the scene's masses, damping and drag.

v' = v + dt/2 a(x, v);  x = x + dt v';  v = (v' + dt/2 a(x, v + dt a)) / (1 + dt c / 2m). Order 2 with damping too:
forces that depend on velocity see a predicted one, and drag is taken as the mean of before and after.
Source: Swope et al. 1982 for the undamped scheme.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from hookean import kernels
from hookean.kernels import device, forces, impacts, notes, supports
from hookean.lean import contacts, lean, padded
from hookean.solvers.base import Solver

if TYPE_CHECKING:
    from hookean.state import State
    from hookean.system import System


@device
def start_step(f: Any, x: Any, v: Any, free: Any, load: Any, inverse: Any, drag: Any, dt: Any, seen: Any) -> None:
    """Half a step of speed, a whole one of place; the speed that forces are to see next, and the loads alone."""
    for i in range(x.shape[0]):
        for c in range(4):
            a = (f[i, c] * free[i, c] - drag * v[i, c]) * inverse[i] * free[i, c]
            v[i, c] += 0.5 * dt * a
            x[i, c] += dt * v[i, c]
            seen[i, c] = v[i, c] + 0.5 * dt * a
            f[i, c] = load[i, c]


@device
def end_step(f: Any, v: Any, free: Any, inverse: Any, drag: Any, dt: Any) -> None:
    """The second half step of speed, drag included."""
    for i in range(v.shape[0]):
        half = 0.5 * dt * inverse[i]
        kept = 1.0 / (1.0 + half * drag)
        for c in range(4):
            if free[i, c] != 0.0:  # held axes go on as fast as their anchor is led
                v[i, c] = (v[i, c] + half * f[i, c]) * kept


@device
def turn(
    f: Any, x: Any, v: Any, free: Any, load: Any, inverse: Any, drag: Any, ended: Any, dt: Any
) -> None:  # fmt: skip
    """`end_step` of one step and `start_step` of the next in one pass over memory; nobody sees the speed."""
    for i in range(x.shape[0]):
        half = 0.5 * ended * inverse[i]
        kept = 1.0 / (1.0 + half * drag)
        for c in range(4):
            speed = v[i, c]
            if free[i, c] != 0.0:
                speed = (speed + half * f[i, c]) * kept
            a = (f[i, c] * free[i, c] - drag * speed) * inverse[i] * free[i, c]
            speed += 0.5 * dt * a
            v[i, c] = speed
            x[i, c] += dt * speed
            f[i, c] = load[i, c]


@device
def start_among_contacts(
    hits: Any, rests: Any, raw: Any, f: Any, x: Any, v: Any, free: Any, load: Any, mass: Any, inverse: Any,
    carried: Any, x_before: Any, v_before: Any, a: Any, drag: Any, dt: Any, seen: Any,
) -> None:  # fmt: skip
    """`start_step` where contacts carry and catch."""
    for i in range(x.shape[0]):
        for c in range(4):
            f[i, c] = raw[i, c] * free[i, c]
    supports(rests, x, v, f, carried, free, mass, dt)
    for i in range(x.shape[0]):
        for c in range(4):
            a[i, c] = (f[i, c] - drag * v[i, c]) * inverse[i] * free[i, c]
            x_before[i, c] = x[i, c]
            v_before[i, c] = v[i, c]
            v[i, c] += 0.5 * dt * a[i, c]
            x[i, c] += dt * v[i, c]
    impacts(hits, x_before, v_before, a, x, v, free, dt)
    for i in range(x.shape[0]):
        for c in range(4):
            seen[i, c] = v[i, c] + 0.5 * dt * a[i, c]
            raw[i, c] = load[i, c]


def verlet_loop(  # type: ignore[no-untyped-def]
    packed, hits, rests, noted, x, v, free, load, mass, inverse, raw, w, f, carried, x_before, v_before,
    acceleration, seen, drag, steps, contacts, changing, count,
):  # fmt: skip
    last = count * steps.shape[0] - 1
    started = False
    for s in range(last + 1):
        dt = steps[s % steps.shape[0]]
        if not started:
            if s == 0 or changing:
                raw[:, :] = load
                forces(packed, x, v, raw, w)
            if contacts:
                start_among_contacts(
                    hits, rests, raw, f, x, v, free, load, mass, inverse, carried, x_before, v_before, acceleration,
                    drag, dt, seen,
                )  # fmt: skip
            else:  # the same in one pass over memory
                start_step(raw, x, v, free, load, inverse, drag, dt, seen)
        forces(packed, x, seen, raw, w)
        started = not (contacts or changing or s == last)
        if contacts:
            f[:, :] = raw * free
            supports(rests, x, v, f, carried, free, mass, dt)
            end_step(f, v, free, inverse, drag, dt)
        elif started:
            turn(raw, x, v, free, load, inverse, drag, dt, steps[(s + 1) % steps.shape[0]])
        else:
            end_step(raw, v, free, inverse, drag, dt)
        if (s + 1) % steps.shape[0] == 0:
            notes(noted, x)


class Method(Solver):
    """Velocity Verlet; what classic Kangaroo does, and what bounces."""

    name: ClassVar[str] = "verlet"
    physical: ClassVar[bool] = True
    weights: ClassVar[tuple[float, ...]] = (1.0,)

    def advance(self, system: System, state: State, count: int, goal: float) -> int:
        """Exactly `count` time steps; physical time does not stop early."""
        n = len(state.x)
        step = system.scene.settings.time_step
        own = lean(system, state, damped=True)
        x, v, free, load, raw, seen = padded(n, state.x, state.v, state.free, own.load, None, None)
        rows = padded(n, *[None] * 5) if system.contacts else [raw] * 5
        yields = system.yields
        noted = [
            (g.cls.end_of_step, (g.block.indices, g.block.parameters, memory))
            for g, memory in zip(system.groups, state.memory, strict=True)
            if yields and g.cls.end_of_step is not None
        ]
        kernels.compiled(verlet_loop)(
            own.packed, *contacts(system), kernels.table("remember", noted), x, v, free, load, system.mass,
            1.0 / system.mass, raw, np.zeros(n), *rows, seen, system.drag, step * np.array(self.weights),
            bool(system.contacts), system.damped or yields, count,
        )  # fmt: skip
        state.x[:], state.v[:] = x[:, :3], v[:, :3]
        state.iteration += count
        for _ in range(count):
            # one by one: the same bits however the steps are divided into calls
            state.time += step
        return count
