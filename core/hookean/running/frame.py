"""Frame: what a client sees of a running simulation."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hookean.running.result import Status

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Frame:
    """What a client sees of a running simulation: positions (n, 3) [length], time [time], energies [force length]."""

    particles: Floats
    geometry: list[dict[str, object]]
    time: float
    iteration: int
    revision: int
    residual: float
    status: Status
    message: str
