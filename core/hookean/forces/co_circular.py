"""Co-circular: groups of particles that are pulled onto one circle."""

from __future__ import annotations

from typing import ClassVar, Literal

import numpy as np

from hookean.forces.base import Floats
from hookean.forces.fits import CIRCLE
from hookean.forces.fitted import Fitted


class CoCircular(Fitted):
    """Particles of a group are pulled onto one circle: E = sum k d^2 / 2, d the distances to its least-squares circle.

    Plane, centre and radius are those of the least sum of squared distances in space, weighted by k. The circle moves
    and grows with the particles: forces and moments sum to zero. Each particle feels k at most. Three particles or
    fewer always have a circle. A group on one line, or with a radius beyond 100,000 times its size, has a line
    instead. Source: Coope, "Circle fitting by linear and nonlinear least squares", 1993, for the start of the search.
    """

    kind: Literal["co_circular"] = "co_circular"

    shape: ClassVar[float] = CIRCLE
    axes: ClassVar[tuple[int, ...]] = (0, 1, 2, 3, 4, 5)
    outputs: ClassVar[dict[str, str]] = {"distance": "length", "force": "force", "radius": "length"}

    @classmethod
    def example(cls) -> tuple[CoCircular, Floats]:
        """Two groups, of six and of five particles, near circles of their own."""
        turn = np.array([0.1, 1.0, 2.2, 3.0, 4.1, 5.3])
        first = np.column_stack([3.1 * np.cos(turn), 2.9 * np.sin(turn), 0.1 * np.cos(3.0 * turn)])
        other = np.column_stack([2.0 * np.cos(turn[:5]) + 7.0, 0.2 * np.sin(2.0 * turn[:5]), 2.2 * np.sin(turn[:5])])
        strength = [5, 20, 1, 7, 30, 4, 9.0, 3, 6, 2, 8.0]
        return cls(particles=range(11), group=[0] * 6 + [5] * 5, strength=strength), np.vstack([first, other])
