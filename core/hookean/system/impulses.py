"""Impulses: momentum that solvers of physical time give at the beginning of a step, by the time alone.

A step from t to t + dt gives what lies in [t, t + dt). The end of one step is the same number as the beginning of the
next, so that each moment belongs to one step, however a run is divided, saved and resumed.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from hookean.system.state import State
    from hookean.system.system import System


def next_moment(system: System, since: float) -> float:
    """The first moment [time] of any impulse from a time on; infinite if there is none."""
    return min((group.cls.next_moment(group.block, since) for group in system.impulses), default=math.inf)


def steps_before(system: System, time: float, covered: float, most: int) -> int:
    """How many steps of length `covered` [time], at least 1 and at most `most`, end before one that has an impulse."""
    if not system.impulses:
        return most
    moment, count = next_moment(system, time + covered), 1
    time += covered
    while count < most and not moment < time + covered:
        time, count = time + covered, count + 1
    return count


def give(system: System, state: State, covered: float) -> None:
    """Add the impulses of the step that begins now to the velocities; what they add to the energy is entered into the
    books of the run (see `running.heating`)."""
    if not next_moment(system, state.time) < state.time + covered:
        return
    gain = np.zeros(state.v.shape)
    for group in system.impulses:
        momentum = group.cls.kick(group.block, state.x, state.time, state.time + covered)
        np.add.at(gain, group.block.indices[:, 0], momentum)
    gain *= state.free
    energy = float((gain * (state.v + 0.5 * gain / system.mass[:, None])).sum())
    state.v += gain / system.mass[:, None]
    if "given" in state.scratch:
        state.scratch["given"] += energy
    else:
        state.scratch["given"] = np.array([energy])


def ignored(system: System) -> list[str]:
    """Sentences on the impulses of a system whose solver has no physical time."""
    said = "acts in physical time only and is left out of this equilibrium; use verlet or yoshida, or a simulation"
    return [
        f"/forces/{part.number}: an {part.force.kind_name} {said}" for group in system.impulses for part in group.parts
    ]
