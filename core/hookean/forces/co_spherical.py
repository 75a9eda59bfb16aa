"""Co-spherical: groups of particles that are pulled onto one sphere."""

from __future__ import annotations

from typing import ClassVar, Literal

import numpy as np

from hookean.forces.base import Floats
from hookean.forces.fits import SPHERE
from hookean.forces.fitted import Fitted


class CoSpherical(Fitted):
    """Particles of a group are pulled onto one sphere: E = sum k d^2 / 2, d the distances to its least-squares sphere.

    Centre and radius are those of the least sum of squared distances, weighted by k; the search starts from an
    algebraic fit (Coope, "Circle fitting by linear and nonlinear least squares", 1993). The sphere moves and grows with
    the particles: forces and moments sum to zero. Each particle feels k at most. Four particles or fewer always have a
    sphere. A group in one plane, or with a radius beyond 100,000 times its size, has a plane instead.
    """

    kind: Literal["co_spherical"] = "co_spherical"

    shape: ClassVar[float] = SPHERE
    axes: ClassVar[tuple[int, ...]] = (0, 1, 2, 3, 4, 5)
    outputs: ClassVar[dict[str, str]] = {"distance": "length", "force": "force", "radius": "length"}

    @classmethod
    def example(cls) -> tuple[CoSpherical, Floats]:
        """Two groups, of seven and of six particles, near spheres of their own."""
        x = [
            [2.1, 0.1, 0],
            [-1.8, 0.2, 0.3],
            [0, 2.2, 0.1],
            [0.1, -1.9, -0.2],
            [0.2, 0, 2],
            [0, 0.3, -2.1],
            [1.2, 1.3, 1.1],
        ]
        far = np.array(x) * [1, 1.05, 1] + [6.0, 2.0, 1.0]
        strength = [5, 20, 1, 7, 30, 4, 9.0, 3, 6, 2, 8, 4, 5.0]
        group = [2] * 7 + [3] * 6
        return cls(particles=range(13), group=group, strength=strength), np.vstack([x, far[:6]])
