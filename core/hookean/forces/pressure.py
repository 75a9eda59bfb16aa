"""Pressure on a mesh: it stays normal to the faces and grows with them."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np

from hookean.forces.base import Block, Floats, Places
from hookean.forces.face_loads import FaceLoad, dome, fill, length, sides
from hookean.values.fields import Field


def pressure_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    energy = 0.0
    g = np.zeros((3, 3))
    n = np.zeros(3)
    for e in range(indices.shape[0]):
        p = parameters[e, 0] * parameters[e, 1] / 6.0
        if p == 0.0:
            continue
        sides(x, indices, e, g, n)
        reach = np.abs(p) * (length(g, 0) + length(g, 1) + length(g, 2))
        for i in range(3):
            a = indices[e, i]
            w[a] += reach
            for c in range(3):
                f[a, c] += p * n[c]
                # volume of the cone over the face, by the mean of its corners
                energy -= p * n[c] * (x[a, c] - parameters[e, 2 + c]) / 3.0
    return energy


def pressure_hessian(x, indices, parameters, memory, blocks):  # type: ignore[no-untyped-def]
    # the symmetric part, of which the sum is that of -p V
    g = np.zeros((3, 3))
    n = np.zeros(3)
    slope = np.zeros((3, 3))
    for e in range(indices.shape[0]):
        sides(x, indices, e, g, n)
        for c in range(3):
            slope[c, c] = parameters[e, 0] * parameters[e, 1] / 2.0
        fill(blocks, e, slope, g)


class Pressure(FaceLoad):
    """Pressure p normal to the faces of a mesh, on the side their corners run counter-clockwise: f = p A n / 3.

    A and n are those of the shape as it is, so the force follows the face (wind and air, not snow). Each corner of a
    triangle takes a third; a quad is the mean of its two cuts into triangles. Positive p pushes along the normal:
    out of a closed mesh whose faces are oriented outwards. On a closed mesh, or where the rim is held, these forces
    have the energy -p V, V the volume between the mesh and its start centre, and that is the energy reported; with a
    free rim they have none (turning a flap in a loop can gain work), and Newton steps take the symmetric part of their
    stiffness.
    """

    kind: Literal["pressure"] = "pressure"
    mesh: str = Field(description="Name of the mesh under pressure")
    pressure: float = Field(default=1.0, ge=-1e12, le=1e12, description="p along the normals [force/length^2]")

    formula: ClassVar[str] = "f = p A n / 3"
    outward: ClassVar[bool] = True
    kernel: ClassVar[Any] = staticmethod(pressure_kernel)
    hessian: ClassVar[Any] = staticmethod(pressure_hessian)

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: p, share, centre."""
        corners, part = self.triangles(places, self.mesh)
        centre = places.x[corners].mean(axis=(0, 1)) if len(corners) else np.zeros(3)
        return Block.of(corners, pressure=self.pressure, share=part, centre=np.tile(centre, (len(corners), 1)))

    @classmethod
    def example(cls) -> tuple[Pressure, Floats]:
        """Air under an irregular dome of quads and triangles (`example_faces`)."""
        return cls(mesh="skin", pressure=3.0), dome()
