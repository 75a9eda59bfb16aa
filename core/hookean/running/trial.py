"""Trials: whether a time step holds in a motion that another one did not bear, found by taking it."""

from __future__ import annotations

from copy import copy
from typing import TYPE_CHECKING

import numpy as np

from hookean.running.result import Status
from hookean.scene.scene import Scene
from hookean.solvers import Solver, solver
from hookean.stability import time_steps
from hookean.system.state import State
from hookean.system.system import System

if TYPE_CHECKING:
    from hookean.running.watch import Watch

TRIES = 10  # steps, each half of the last one
LEAST_STEPS = 2_000  # of a trial
LONGER = 2.0  # times as long as the motion lasted is tried
WORK = 20_000_000  # steps of a trial times the numbers of indices: a fraction of a second


def trial(system: System, start: State, end: State, method: Solver, watching: type[Watch]) -> tuple[float, float]:
    """A time step [time] that holds in the motion from `start` that did not go beyond `end` with the scene's, and the
    time [time] for which it was tried; zeros if none was found. Each trial is judged by a `watching`."""
    given = system.scene.settings.time_step
    # from both shapes, as either may be the stiffer one
    step = min(time_steps.roomy(system, start, method), time_steps.roomy(system, end, method), 0.8 * given)
    lasted = max(end.time - start.time, 0.0) + given * watching(system, start.copy(), method).burst(system, start)
    for _ in range(TRIES):
        step = float(f"{time_steps.floored(step):.4g}")
        if time := _held(system, start, method, step, max(LONGER * lasted, LEAST_STEPS * step), watching):
            return step, time
        step *= 0.5
    return 0.0, 0.0


def _held(system: System, start: State, method: Solver, step: float, until: float, watching: type[Watch]) -> float:
    """For how long [time] a step held, at most `until` or as long as may be tried; 0 where it did not."""
    alone = copy(system)
    alone.scene = _with_step(system, step)
    state, used = start.copy(), solver(method.name)
    used.start(alone, state)
    watch = watching(alone, state, used)
    size = 100 + sum(group.block.indices.size for group in system.groups)
    steps = int(min(np.ceil(until / step), max(WORK // size, LEAST_STEPS)))
    first = state.iteration
    while (done := state.iteration - first) < steps:
        used.advance(alone, state, min(watch.burst(alone, state), steps - done), 0.0)
        if watch.look(alone, state) is Status.DIVERGED:
            return 0.0
    return state.time - start.time


def _with_step(system: System, step: float) -> Scene:
    settings = system.scene.settings.replaced(time_step=step, max_iterations=10**9, time_limit=None)
    return system.scene.replaced(settings=settings)
