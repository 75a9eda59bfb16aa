"""Pressure on a mesh: it stays normal to the faces and grows with them."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np

from hookean.forces.base import Block, Floats, Force, OnFilm, Places
from hookean.forces.soapfilm import halves
from hookean.values.fields import Field


def pressure_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    energy = 0.0
    g = np.zeros((3, 3))
    n = np.zeros(3)
    for e in range(indices.shape[0]):
        p = parameters[e, 0] * parameters[e, 1] / 6.0
        if p == 0.0:
            continue
        for i in range(3):
            a = indices[e, (i + 1) % 3]
            b = indices[e, (i + 2) % 3]
            for c in range(3):
                g[i, c] = x[b, c] - x[a, c]
        n[0] = g[0, 1] * g[1, 2] - g[0, 2] * g[1, 1]
        n[1] = g[0, 2] * g[1, 0] - g[0, 0] * g[1, 2]
        n[2] = g[0, 0] * g[1, 1] - g[0, 1] * g[1, 0]
        reach = 0.0
        for i in range(3):
            reach += np.abs(p) * np.sqrt(g[i, 0] * g[i, 0] + g[i, 1] * g[i, 1] + g[i, 2] * g[i, 2])
        for i in range(3):
            a = indices[e, i]
            w[a] += reach
            for c in range(3):
                f[a, c] += p * n[c]
                # volume of the cone over the face, by the mean of its corners
                energy -= p * n[c] * (x[a, c] - parameters[e, 2 + c]) / 3.0
    return energy


def pressure_hessian(x, indices, parameters, memory, blocks):  # type: ignore[no-untyped-def]
    # f = p n / 6 on each corner, dn = sum of (opposite edge) x dx; the symmetric part, of which the sum is that of -p V
    g = np.zeros((3, 3))
    for e in range(indices.shape[0]):
        p = parameters[e, 0] * parameters[e, 1] / 12.0
        for i in range(3):
            a = indices[e, (i + 1) % 3]
            b = indices[e, (i + 2) % 3]
            for c in range(3):
                g[i, c] = x[b, c] - x[a, c]
        for i in range(3):
            for j in range(3):
                for c in range(3):
                    u = (c + 1) % 3
                    d = (c + 2) % 3
                    blocks[e, 3 * i + c, 3 * j + c] = 0.0
                    # minus [edge of the column] x, and the transpose of that of the row
                    blocks[e, 3 * i + c, 3 * j + u] = p * (g[j, d] - g[i, d])
                    blocks[e, 3 * i + c, 3 * j + d] = p * (g[i, u] - g[j, u])


class Pressure(Force):
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
    role: ClassVar[Literal["internal", "load", "support"]] = "load"
    conservative: ClassVar[bool] = False
    creates: ClassVar[bool] = False
    arity: ClassVar[int] = 3
    on_film: ClassVar[OnFilm] = "across"
    outputs: ClassVar[dict[str, str]] = {"force": "force"}
    kernel: ClassVar[Any] = staticmethod(pressure_kernel)
    hessian: ClassVar[Any] = staticmethod(pressure_hessian)
    example_faces: ClassVar[list[list[int]]] = [[0, 1, 4, 3], [1, 2, 5, 4], [3, 4, 7, 6], [4, 5, 8], [4, 8, 7]]

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: p, share, centre."""
        faces = places.faces(self.mesh)
        corners, share, _ = halves(faces[(faces >= 0).all(axis=1)])
        centre = places.x[corners].mean(axis=(0, 1)) if len(corners) else np.zeros(3)
        return Block.of(corners, pressure=self.pressure, share=share, centre=np.tile(centre, (len(corners), 1)))

    def measure(self, block: Block, x: Floats, element_forces: Floats) -> dict[str, Floats]:
        """Force on each triangle [force], halved where a quad is cut in two ways."""
        return {"force": element_forces.sum(axis=1)}

    @classmethod
    def example(cls) -> tuple[Pressure, Floats]:
        """Air under an irregular dome of quads and triangles (`example_faces`)."""
        x = [[0.0, 0.1, 0.0], [1.1, 0.0, 0.3], [2.0, -0.1, 0.1], [0.1, 1.0, 0.35], [0.9, 1.1, 0.7], [2.1, 0.9, 0.3]]
        x += [[-0.1, 2.0, 0.05], [1.0, 2.2, 0.4], [1.9, 2.1, -0.1]]
        return cls(mesh="skin", pressure=3.0), np.array(x)
