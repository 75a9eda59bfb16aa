"""Co-planar: groups of particles that are pulled into one plane."""

from __future__ import annotations

from typing import ClassVar, Literal

import numpy as np

from hookean.forces.base import Floats
from hookean.forces.fits import PLANE
from hookean.forces.fitted import Fitted


class CoPlanar(Fitted):
    """Particles of a group are pulled into one plane: E = sum k d^2 / 2, d the distances to its least-squares plane.

    The plane goes through the mean of the particles, weighted by k, square to the axis of their least variance. It
    moves with them: forces and moments sum to zero. Each particle feels k at most. Three particles or fewer always have
    a plane. Where the two least variances are equal, as at the corners of a cube, the plane is one of several.
    """

    kind: Literal["co_planar"] = "co_planar"

    shape: ClassVar[float] = PLANE
    axes: ClassVar[tuple[int, ...]] = (2, 4, 5)

    @classmethod
    def example(cls) -> tuple[CoPlanar, Floats]:
        """Two groups, of six and of four particles, near planes of their own."""
        x = [[0, 0, 0.2], [4, 0.3, -0.1], [3.6, 3, 0.3], [0.4, 3.1, 0], [2, 1.4, -0.4], [1, 2, 0.1], [5, 5, 2.0]]
        x += [[6, 1, 2.3], [8, 4, 3.0], [7, 6, 1.4]]
        strength = [5.0, 20.0, 1.0, 7.0, 30.0, 4.0, 9.0, 6.0, 3.0, 5.0]
        return cls(particles=range(10), group=[4, 4, 4, 4, 4, 4, 1, 1, 1, 1], strength=strength), np.array(x)
