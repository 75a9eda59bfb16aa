"""Hydrostatic: the pressure of a liquid at rest on a mesh."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np

from hookean.compiled.marks import device
from hookean.forces.base import Block, Floats, Places
from hookean.forces.face_loads import FaceLoad, dome, length, sides
from hookean.values.fields import Field


@device
def add_corner(depth: Any, a: Any, sign: Any, first: Any, second: Any) -> None:
    """Add `sign` times the integrals over the part of a triangle that corner `a` alone cuts off at depth 0."""
    b, c = (a + 1) % 3, (a + 2) % 3
    s, t = depth[a] / (depth[a] - depth[b]), depth[a] / (depth[a] - depth[c])
    area = sign * s * t / 12.0
    first[a] += area * depth[a] * (4.0 - s - t)
    first[b] += area * depth[a] * s
    first[c] += area * depth[a] * t
    # of the corners of the part, by the linear functions of the whole: a; a + s (b - a); a + t (c - a)
    p, q = 1.0 - s, 1.0 - t
    second[a, a] += 2.0 * area * (1.0 + p * p + q * q + p + q + p * q)
    second[b, b] += 2.0 * area * s * s
    second[c, c] += 2.0 * area * t * t
    ab, ac, bc = area * s * (1.0 + 2.0 * p + q), area * t * (1.0 + p + 2.0 * q), area * s * t
    second[a, b] += ab
    second[b, a] += ab
    second[a, c] += ac
    second[c, a] += ac
    second[b, c] += bc
    second[c, b] += bc


@device
def wet(x: Any, indices: Any, e: Any, level: Any, depth: Any, first: Any, second: Any) -> None:
    """Depths of the corners of a triangle, and of its wet part the integrals of depth x N_i and of N_i N_j per area, N
    the linear functions of the corners."""
    count = 0
    for i in range(3):
        depth[i] = level - x[indices[e, i], 2]
        count += depth[i] > 0.0
    for i in range(3):
        first[i] = (depth[i] + depth[0] + depth[1] + depth[2]) / 12.0 if count > 1 else 0.0
        for j in range(3):
            second[i, j] = (2.0 if i == j else 1.0) / 12.0 if count > 1 else 0.0
    if count % 3 == 0:
        return
    for i in range(3):
        if (depth[i] > 0.0) == (count == 1):
            # with one dry corner: all, less what it cuts off; its depth is negative
            add_corner(depth, i, 1.0 if count == 1 else -1.0, first, second)


def hydrostatic_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    energy = 0.0
    g, n = np.zeros((3, 3)), np.zeros(3)
    depth, first, second = np.zeros(3), np.zeros(3), np.zeros((3, 3))
    for e in range(indices.shape[0]):
        half = 0.5 * parameters[e, 0] * parameters[e, 2]
        double = sides(x, indices, e, g, n)
        wet(x, indices, e, parameters[e, 1], depth, first, second)
        reach, total = length(g, 0) + length(g, 1) + length(g, 2), first[0] + first[1] + first[2]
        for i in range(3):
            own = second[i, 0] + second[i, 1] + second[i, 2]
            bound = 0.5 * (first[i] * reach + length(g, i) * total) + double * own
            w[indices[e, i]] += np.abs(half) * bound
            # the energy of the liquid between the face and its surface, straight above
            energy += 0.5 * half * n[2] * depth[i] * first[i]
            for c in range(3):
                f[indices[e, i], c] += half * first[i] * n[c]
    return energy


def hydrostatic_hessian(x, indices, parameters, memory, blocks):  # type: ignore[no-untyped-def]
    g, n = np.zeros((3, 3)), np.zeros(3)
    depth, first, second = np.zeros(3), np.zeros(3), np.zeros((3, 3))
    for e in range(indices.shape[0]):
        quarter = 0.25 * parameters[e, 0] * parameters[e, 2]
        sides(x, indices, e, g, n)
        wet(x, indices, e, parameters[e, 1], depth, first, second)
        for i in range(3):
            for j in range(3):
                for c in range(3):
                    # the area vector turns and grows: minus [side] x, symmetric part
                    u, d = (c + 1) % 3, (c + 2) % 3
                    blocks[e, 3 * i + c, 3 * j + c] = 0.0
                    blocks[e, 3 * i + c, 3 * j + u] = quarter * (first[i] * g[j, d] - first[j] * g[i, d])
                    blocks[e, 3 * i + c, 3 * j + d] = quarter * (first[j] * g[i, u] - first[i] * g[j, u])
                for c in range(3):
                    # the depth changes
                    blocks[e, 3 * i + c, 3 * j + 2] += quarter * second[i, j] * n[c]
                    blocks[e, 3 * i + 2, 3 * j + c] += quarter * second[i, j] * n[c]


class Hydrostatic(FaceLoad):
    """Pressure of a liquid at rest on a mesh: p = gamma (level - z) below its level, 0 above, normal to the faces.

    gamma is the weight of the liquid per volume, 9.81 kN/m^3 for water; z is up. Each corner of a triangle takes the
    integral of p and its linear function over the wet part, exactly, also where the level cuts the face: resultants and
    their lines of action are those of the liquid on any mesh. A quad is the mean of its two cuts into triangles.
    Positive gamma pushes along the normals, the liquid being on the other side of the faces; negative gamma is a liquid
    on the side of the normals, as around a ship whose faces are oriented outwards, or of water that ponds on a roof
    up to a level: where the roof sags, there is more of it. On a closed mesh, or where the rim
    is held, these forces have an energy, and that is the one reported; with a free rim they have none, and Newton steps
    take the symmetric part of their stiffness.
    """

    kind: Literal["hydrostatic"] = "hydrostatic"
    mesh: str = Field(description="Name of the mesh under pressure")
    weight: float = Field(default=1.0, ge=-1e12, le=1e12, description="gamma, weight per volume [force/length^3]")
    level: float = Field(default=0.0, ge=-1e12, le=1e12, description="Level of the surface, z [length]")

    formula: ClassVar[str] = "p = γ (level - z)"
    bears: ClassVar[bool] = True
    outward: ClassVar[bool] = True
    kernel: ClassVar[Any] = staticmethod(hydrostatic_kernel)
    hessian: ClassVar[Any] = staticmethod(hydrostatic_hessian)

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: gamma, level, share."""
        corners, part = self.triangles(places, self.mesh)
        return Block.of(corners, weight=self.weight, level=self.level, share=part)

    @classmethod
    def example(cls) -> tuple[Hydrostatic, Floats]:
        """An irregular dome (`example_faces`) that a level cuts in several ways."""
        return cls(mesh="skin", weight=3.0, level=0.33), dome()
