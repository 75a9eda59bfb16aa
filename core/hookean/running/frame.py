"""Frame: a running simulation at one moment, as clients see it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hookean.running.result import Status, carried
from hookean.system.state import State
from hookean.system.system import System


@dataclass(frozen=True)
class Frame:
    """What a client sees of a running simulation: positions (n, 3) [length], time [time], and the `rotations` (r, 4) of
    particles at the ends of beams, as `Result.rotations` has them."""

    particles: NDArray[np.float64]
    geometry: list[dict[str, object]]
    time: float
    iteration: int
    revision: int
    residual: float
    status: Status
    message: str
    rotations: NDArray[np.float64]


def framed(system: System, state: State, residual: float, status: Status, message: str) -> Frame:
    """A state of a system as clients see it."""
    particles = state.x[: system.slots.count].copy()
    clock = state.time, state.iteration, state.revision
    turned = system.slots.quaternions(state.x)
    return Frame(particles, carried(system, state), *clock, residual, status, message, turned)
