"""The longest time step of an explicit scheme, from the highest rates of a system."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Limit:
    """How long the steps of an explicit scheme may be, by the highest rates of a system.

    It is stable while dt^2 k / (2 reach)^2 + dt (c / damping + drag / drag_part) / 2 <= 1, with the largest eigenvalues
    k of M^-1 K [1/time^2] and c of M^-1 C along springs [1/time], and drag over the smallest mass [1/time]. `reach` is
    the longest step without damping as a part of 2 / omega, `damping` and `drag` those of damping alone as parts of
    2 / c.
    """

    reach: float = 1.0
    damping: float = 1.0
    drag: float = 1.0

    def step(self, stiffness: float, damping: float, drag: float) -> float:
        """The longest step [time] that is stable with these highest rates; infinite without any."""
        half = 0.5 * (damping / self.damping + drag / self.drag)
        below = half + float(np.hypot(half, np.sqrt(max(stiffness, 0.0)) / self.reach))
        return 2.0 / below if below > 0.0 else np.inf
