"""Heating: energy that time steps that are too long feed into a motion, found while the shape is still a good one."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from hookean.stability import Bounds, stable_time_step

if TYPE_CHECKING:
    from hookean.balance import Balance
    from hookean.solvers.base import Solver
    from hookean.state import State
    from hookean.system import System

GAIN = 2.0  # times the energy that a motion has exchanged: the part of the total above it has no source but the steps
MOST_SWING = 100.0  # of the total energy at steps that are nearly too long
LEAST = 1e-6  # of the energy of a system, below which gains are rounding


def heated(system: System, state: State, method: Solver, found: Balance, *, driven: bool) -> int | None:
    """The particle that moves most, where time steps have fed energy into the motion; else None.

    Forces that have an energy exchange it with the motion, and damping takes some: nothing adds to the total, unless
    anchors are led (`driven`). With stable steps dt, the total swings by up to 1 / (1 - (dt / longest)^2). The total at
    the start, the least energy of forces since then and that swing are kept in `state.scratch`, so that a run that is
    resumed ends where it would have ended.
    """
    moving = 0.5 * system.mass * (state.v * state.v).sum(axis=1)
    led = driven or state.v[state.free == 0.0].any()
    if led or not all(group.cls.conservative for group in system.groups):
        state.scratch.pop("energy", None)
        return None
    still, motion = float(found.energies.sum()), float(moving.sum())
    start, lowest, swing = kept = state.scratch.setdefault("energy", np.array([still + motion, still, 0.0]))
    lowest = kept[1] = min(lowest, still)
    gain, least = still + motion - start, LEAST * (float(np.abs(found.energies).sum()) + motion)
    if gain <= GAIN * max((start - lowest) * max(swing, 1.0), least):
        return None
    step = system.scene.settings.time_step / method.parts(system, state)
    if step <= Bounds.of(system, state, found.stiffness).holds(state, method.limit):
        return None
    if swing == 0.0:
        rest = 1.0 - (step / stable_time_step(system, state, method.limit)) ** 2
        kept[2] = min(1.0 / rest, MOST_SWING) if rest > 0.0 else 1.0
        return heated(system, state, method, found, driven=driven)
    return int(np.argmax(moving))
