"""Verlet: velocity Verlet in physical time, with the scene's masses, damping and drag.

v' = v + dt/2 a(x, v);  x = x + dt v';  v = (v' + dt/2 a(x, v + dt a)) / (1 + dt c / 2m). Order 2 with damping too:
forces that depend on velocity see a predicted one, and drag is taken as the mean of before and after.
Source: Swope et al. 1982 for the undamped scheme.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from hookean.compiled import dispatch
from hookean.compiled.dispatch import forces, impacts, notes, supports
from hookean.compiled.marks import device
from hookean.forces.rotations import fold
from hookean.solvers.base import Solver
from hookean.stability import time_steps
from hookean.system.impulses import give, steps_before
from hookean.system.packing import Desk, Lean, Seen, contacts, lean

if TYPE_CHECKING:
    from hookean.system.state import State
    from hookean.system.system import System


@device
def start_step(f: Any, x: Any, v: Any, pull: Any, drag: Any, dt: Any, seen: Any) -> None:
    """Half a step of speed, a whole one of place; the speed that forces are to see next.

    All passes run over flat arrays, few at a time, so that they take several numbers in one operation; `pull` is 1/m,
    and 0 on held axes, which go on as fast as their anchor is led.
    """
    for i in range(x.size):
        a = (f[i] - drag * v[i]) * pull[i]
        v[i] += 0.5 * dt * a
        x[i] += dt * v[i]
        seen[i] = v[i] + 0.5 * dt * a


@device
def end_step(f: Any, v: Any, pull: Any, drag: Any, dt: Any) -> None:
    """The second half step of speed, drag included."""
    for i in range(v.size):
        half = 0.5 * dt * pull[i]
        v[i] = (v[i] + half * f[i]) / (1.0 + half * drag)


@device
def turn(f: Any, x: Any, v: Any, pull: Any, load: Any, drag: Any, ended: Any, dt: Any) -> None:
    """`end_step` of one step and `start_step` of the next in one pass, where no force sees the speed."""
    for i in range(x.size):
        half = 0.5 * ended * pull[i]
        speed = (v[i] + half * f[i]) / (1.0 + half * drag)
        a = (f[i] - drag * speed) * pull[i]
        speed += 0.5 * dt * a
        v[i] = speed
        x[i] += dt * speed
        f[i] = load[i]


@device
def copy(given: Any, to: Any) -> None:
    """The same numbers; many times as quick as a slice."""
    for i in range(given.size):
        to[i] = given[i]


@device
def only_free(raw: Any, free: Any, f: Any) -> None:
    """Forces on free axes; anchors carry the others."""
    for i in range(raw.size):
        f[i] = raw[i] * free[i]


@device
def accelerate(f: Any, v: Any, pull: Any, drag: Any, a: Any) -> None:
    """Accelerations at the start of a step, drag included."""
    for i in range(f.size):
        a[i] = (f[i] - drag * v[i]) * pull[i]


@device
def fly(x: Any, v: Any, a: Any, dt: Any) -> None:
    """Half a step of speed, a whole one of place."""
    for i in range(x.size):
        v[i] += 0.5 * dt * a[i]
        x[i] += dt * v[i]


@device
def foresee(v: Any, a: Any, dt: Any, seen: Any) -> None:
    """The speed that forces are to see next."""
    for i in range(v.size):
        seen[i] = v[i] + 0.5 * dt * a[i]


@device
def take(given_x: Any, given_v: Any, given_free: Any, mass: Any, x: Any, v: Any, free: Any, pull: Any) -> Any:
    """Lay out a state in rows of four columns; whether `x` had been there."""
    moved = 0
    for i in range(x.shape[0]):
        for c in range(3):
            moved |= x[i, c] != given_x[i, c]
            x[i, c] = given_x[i, c]
            v[i, c] = given_v[i, c]
            free[i, c] = given_free[i, c]
            pull[i, c] = given_free[i, c] / mass[i]
    return moved == 0


def verlet_loop(  # type: ignore[no-untyped-def]
    quiet, lively, hits, rests, noted, given_x, given_v, given_free, mass, x, v, free, pull, load, raw, base, w, f,
    carried, x_before, v_before, acceleration, seen, drag, steps, contacts, known, count, slots, arms,
):  # fmt: skip
    # `base` is known from the end of the last call, unless somebody has moved something since
    known &= take(given_x, given_v, given_free, mass, x, v, free, pull)
    last = count * steps.shape[0] - 1
    started = False
    resting, changing = len(quiet) > 0, len(lively) > 0  # without the one `base` is `load`, without the other `raw`
    size = x.size
    flat_x, flat_v, flat_pull, flat_load = x.reshape(size), v.reshape(size), pull.reshape(size), load.reshape(size)
    flat_raw, flat_base, flat_f, flat_seen = raw.reshape(size), base.reshape(size), f.reshape(size), seen.reshape(size)
    flat_free, flat_a = free.reshape(size), acceleration.reshape(size)
    for s in range(last + 1):
        dt = steps[s % steps.shape[0]]
        if not started:
            if s == 0 and not known:
                copy(flat_load, flat_base)
                forces(quiet, x, v, base, w)
            if changing:
                copy(flat_base, flat_raw)
                forces(lively, x, v, raw, w)
            if contacts:
                only_free(flat_raw, flat_free, flat_f)
                supports(rests, x[:slots], v[:slots], f[:slots], carried[:slots], free[:slots], mass[:slots], dt)
                accelerate(flat_f, flat_v, flat_pull, drag, flat_a)
                copy(flat_x, x_before.reshape(size))
                copy(flat_v, v_before.reshape(size))
                fly(flat_x, flat_v, flat_a, dt)
                impacts(
                    hits, x_before[:slots], v_before[:slots], acceleration[:slots], x[:slots], v[:slots], free[:slots],
                    dt,
                )  # fmt: skip
                foresee(flat_v, flat_a, dt, flat_seen)
            elif changing:
                start_step(flat_raw, flat_x, flat_v, flat_pull, drag, dt, flat_seen)
            else:  # nothing has ended
                turn(flat_raw, flat_x, flat_v, flat_pull, flat_load, drag, 0.0, dt)
            if resting and (contacts or changing):
                copy(flat_load, flat_base)
        fold(x, v, slots, arms)
        forces(quiet, x, seen, base, w)
        if changing:
            copy(flat_base, flat_raw)
            forces(lively, x, seen, raw, w)
        started = not (contacts or changing or s == last)
        if contacts:
            only_free(flat_raw, flat_free, flat_f)
            supports(rests, x[:slots], v[:slots], f[:slots], carried[:slots], free[:slots], mass[:slots], dt)
            end_step(flat_f, flat_v, flat_pull, drag, dt)
        elif started:
            turn(flat_raw, flat_x, flat_v, flat_pull, flat_load, drag, dt, steps[(s + 1) % steps.shape[0]])
        else:
            end_step(flat_raw, flat_v, flat_pull, drag, dt)
        if (s + 1) % steps.shape[0] == 0:
            notes(noted, x)
    for i in range(x.shape[0]):
        for c in range(3):
            given_x[i, c] = x[i, c]
            given_v[i, c] = v[i, c]


class Method(Solver):
    """Velocity Verlet; what classic Kangaroo does, and what bounces.

    With `divide_steps` a step is divided into equal parts that hold (see `time_steps.parts`); how many is kept in
    `state.scratch`; a watched run takes more where they feed energy into the motion. A step that needs more than
    `time_steps.most_parts` covers less time.
    """

    name: ClassVar[str] = "verlet"
    physical: ClassVar[bool] = True
    weights: ClassVar[tuple[float, ...]] = (1.0,)  # its parts of a time step, one after the other

    def __init__(self) -> None:
        self._desk, self._seen = Desk(), Seen()
        self._tables: tuple[Any, ...] = ()
        self._own: Lean | None = None
        self._free = np.zeros((0, 3))  # of the state that forces were laid out for

    def parts(self, system: System, state: State) -> int:
        """In how many parts a time step is divided."""
        if "parts" not in state.scratch:
            state.scratch["parts"] = np.array([time_steps.parts(system, state, self.limit)])
        return int(state.scratch["parts"][0])

    def covers(self, system: System, state: State) -> float:
        """The time that a step takes: the scene's time step, or less where it needs too many parts."""
        parts, step = self.parts(system, state), system.scene.settings.time_step
        return step * min(1.0, time_steps.most_parts(system) / parts)

    def advance(self, system: System, state: State, count: int, goal: float) -> int:
        """Exactly `count` time steps; physical time does not stop early."""
        left = count
        while left > 0:
            covered = self.covers(system, state)
            give(system, state, covered)
            several = steps_before(system, state.time, covered, left)
            self._steps(system, state, several)
            left -= several
        return max(count, 0)

    def _steps(self, system: System, state: State, count: int) -> None:
        """Time steps without an impulse after the beginning of the first."""
        n, step = len(state.x), system.scene.settings.time_step
        same = self._seen.same(system, state) and self._own is not None and dispatch.same(self._free, state.free)
        if not same or self._own is None:
            self._own = lean(system, state, damped=True)
            self._tables = (self._own.quiet, self._own.lively, *contacts(system), _noted(system, state))
            self._free = state.free.copy()
        parts = self.parts(system, state)
        steps = step / parts * np.tile(self.weights, min(parts, time_steps.most_parts(system)))
        touching, lively = bool(system.contacts), len(self._own.lively) > 0
        rows, new = self._desk.keep(n, 6 + lively + 6 * touching)
        x, v, pull, load, base, seen, *rest = rows
        if not len(self._own.quiet):
            base = load  # nothing is ever added to it
        raw = rest.pop() if lively else base
        free, *others = rest or [pull, *[raw] * 5]  # asked for by contacts alone
        if new or not same:
            load[:, :3] = self._own.load
        dispatch.compiled(verlet_loop)(
            *self._tables, state.x, state.v, state.free, system.mass, x, v, free, pull, load, raw, base, np.zeros(n),
            *others, seen, system.drag, steps, touching, same and not new, count, system.slots.count,
            system.slots.lengths,
        )  # fmt: skip
        state.iteration += count
        covered = self.covers(system, state)
        for _ in range(count):
            # one by one: the same bits however the steps are divided into calls
            state.time += covered


def _noted(system: System, state: State) -> Any:
    """Table of what elements remember at the end of a step."""
    return dispatch.table(
        "remember",
        [
            (g.cls.end_of_step, (g.block.indices, g.block.parameters, memory))
            for g, memory in zip(system.groups, state.memory, strict=True)
            if system.yields and g.cls.end_of_step is not None
        ],
    )
