"""Co-linear: groups of particles that are pulled onto one straight line."""

from __future__ import annotations

from typing import ClassVar, Literal

import numpy as np

from hookean.forces.base import Floats
from hookean.forces.fits import LINE
from hookean.forces.fitted import Fitted


class CoLinear(Fitted):
    """Particles of a group are pulled onto one line: E = sum k d^2 / 2, d the distances to its least-squares line.

    The line goes through the mean of the particles, weighted by k, along the axis of their largest variance. It moves
    with them: forces and moments sum to zero. Each particle feels k at most. Two particles always have a line.
    """

    kind: Literal["co_linear"] = "co_linear"

    shape: ClassVar[float] = LINE
    axes: ClassVar[tuple[int, ...]] = (0, 1, 4, 5)

    @classmethod
    def example(cls) -> tuple[CoLinear, Floats]:
        """Two groups, of four and of three particles, near lines of their own."""
        x = [[0, 0.2, 0.1], [2, -0.1, 0.3], [3.5, 0.1, -0.2], [6, 0.3, 0], [1, 4, 1.0], [2.5, 5.2, 1.2], [4, 6.4, 2.4]]
        return cls(particles=range(7), group=[0, 0, 0, 0, 7, 7, 7], strength=[5, 20, 1, 7, 30, 4, 9.0]), np.array(x)
