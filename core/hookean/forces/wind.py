"""Wind: the pressure of wind on the faces of a mesh, by their angle to it."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np

from hookean.forces.base import Block, Floats, Places, units
from hookean.forces.face_loads import FaceLoad, dome, fill, share, sides
from hookean.values.columns import Direction
from hookean.values.fields import Field

Q, PART, ALONG = 0, 1, 2  # columns of the parameters


def wind_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    g, n = np.zeros((3, 3)), np.zeros(3)
    for e in range(indices.shape[0]):
        double = sides(x, indices, e, g, n)
        if not double > 0.0:
            continue
        half, along = 0.5 * parameters[e, Q] * parameters[e, PART], 0.0
        for c in range(3):
            along += n[c] / double * parameters[e, ALONG + c]
        for c in range(3):
            n[c] *= half * along
        share(indices, e, n, np.abs(half) * (1.0 + np.abs(along)), g, f, w)
    return 0.0


def wind_hessian(x, indices, parameters, memory, blocks):  # type: ignore[no-untyped-def]
    # F = q (n . d) N / 2, so dF/dN = q (n d^T + (n . d) (1 - n n^T)) / 2
    g, n, slope = np.zeros((3, 3)), np.zeros(3), np.zeros((3, 3))
    for e in range(indices.shape[0]):
        double = sides(x, indices, e, g, n)
        half, along = 0.5 * parameters[e, Q] * parameters[e, PART], 0.0
        for c in range(3):
            n[c] = n[c] / double if double > 0.0 else 0.0
            along += n[c] * parameters[e, ALONG + c]
        for c in range(3):
            for k in range(3):
                flat = (1.0 if c == k else 0.0) - n[c] * n[k]
                slope[c, k] = half * (n[c] * parameters[e, ALONG + k] + along * flat)
        fill(blocks, e, slope, g)


class Wind(FaceLoad):
    """Wind on the faces of a mesh: f = q A (n.d) n, normal to each face, a third of it on each corner.

    q is the velocity pressure, rho v^2 / 2 times a coefficient, d the direction of the wind, A and n area and normal of
    the shape as it is. Either side of a face may meet the wind: the force is the same for a mesh turned inside out, and
    is q A cos(theta) on a plate at angle theta. Nothing shelters a face from the wind. A quad is the mean of its two
    cuts into triangles. These forces have no energy, and Newton steps take the symmetric part of their stiffness.
    """

    kind: Literal["wind"] = "wind"
    mesh: str = Field(description="Name of the mesh in the wind")
    pressure: float = Field(default=1.0, ge=-1e12, le=1e12, description="q, velocity pressure [force/length^2]")
    direction: Direction = Field(
        default=np.array([1.0, 0.0, 0.0]), description="d, where the wind blows to; its length is ignored"
    )

    formula: ClassVar[str] = "f = q A (n·d) n"
    kernel: ClassVar[Any] = staticmethod(wind_kernel)
    hessian: ClassVar[Any] = staticmethod(wind_hessian)

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: q, share, the unit vector along d."""
        corners, part = self.triangles(places, self.mesh)
        along = np.tile(units(self.direction), (len(corners), 1))
        return Block.of(corners, pressure=self.pressure, share=part, direction=along)

    @classmethod
    def example(cls) -> tuple[Wind, Floats]:
        """An irregular dome of quads and triangles (`example_faces`) in a wind from above."""
        return cls(mesh="skin", pressure=3.0, direction=[2.0, 0.5, -1.0]), dome()
