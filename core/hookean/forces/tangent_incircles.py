"""Tangent incircles: circles in neighbouring triangles that touch at their common edge."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np

from hookean.compiled.marks import device
from hookean.forces.base import Block, Floats, Force, Places, complete, lengths
from hookean.forces.line_angles import unit
from hookean.forces.mesh_edges import folds
from hookean.values.columns import IndexRows, PointRows
from hookean.values.fields import Field, Maybe


@device
def apart(x: Any, indices: Any, e: Any, u: Any, reach: Any, g: Any) -> Any:
    """How far apart the points are at which both incircles touch the edge; its gradient into `g` (4, 3).

    The sides 0-2, 2-1, 1-3, 3-0 have their unit vectors in `u` (4, 3) and lengths in `reach` (4,); a side of zero
    length has none.
    """
    total = 0.0
    g[:] = 0.0
    for i in range(4):
        a, b = 0 if i == 0 or i == 3 else 1, 2 if i < 2 else 3
        for c in range(3):
            u[i, c] = 0.0
        reach[i] = unit(x, indices[e, a], indices[e, b], u[i])
        sign = 0.5 if i % 2 == 0 else -0.5
        total += sign * reach[i]
        for c in range(3):
            g[a, c] -= sign * u[i, c]
            g[b, c] += sign * u[i, c]
    return total


def tangent_incircles_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    energy, u, reach, g = 0.0, np.zeros((4, 3)), np.zeros(4), np.zeros((4, 3))
    for e in range(indices.shape[0]):
        k, off, total = parameters[e, 0], apart(x, indices, e, u, reach, g), 0.0
        energy += 0.5 * k * off * off
        for i in range(4):
            total += np.sqrt(g[i, 0] * g[i, 0] + g[i, 1] * g[i, 1] + g[i, 2] * g[i, 2])
        for i in range(4):
            size = np.sqrt(g[i, 0] * g[i, 0] + g[i, 1] * g[i, 1] + g[i, 2] * g[i, 2])
            w[indices[e, i]] += k * size * total
            for c in range(3):
                f[indices[e, i], c] -= k * off * g[i, c]
        for i in range(4):
            # sides in tension stiffen across
            force = 0.5 * k * off if i % 2 == 0 else -0.5 * k * off
            if force > 0.0 and reach[i] > 0.0:
                w[indices[e, 0 if i == 0 or i == 3 else 1]] += 2.0 * force / reach[i]
                w[indices[e, 2 if i < 2 else 3]] += 2.0 * force / reach[i]
    return energy


def tangent_incircles_hessian(x, indices, parameters, memory, blocks):  # type: ignore[no-untyped-def]
    u, reach, g = np.zeros((4, 3)), np.zeros(4), np.zeros((4, 3))
    for e in range(indices.shape[0]):
        k, off = parameters[e, 0], apart(x, indices, e, u, reach, g)
        for i in range(12):
            for j in range(12):
                blocks[e, i, j] = k * g[i // 3, i % 3] * g[j // 3, j % 3]
        for i in range(4):
            a, b = 0 if i == 0 or i == 3 else 3, 6 if i < 2 else 9
            force = 0.5 * k * off if i % 2 == 0 else -0.5 * k * off
            density = force / reach[i] if reach[i] > 0.0 else 0.0
            for c in range(3):
                for d in range(3):
                    across = density * ((1.0 if c == d else 0.0) - u[i, c] * u[i, d])
                    blocks[e, a + c, a + d] += across
                    blocks[e, b + c, b + d] += across
                    blocks[e, a + c, b + d] -= across
                    blocks[e, b + c, a + d] -= across


class TangentIncircles(Force):
    """Pairs of triangles whose incircles touch at their common edge: E = k u^2 / 2, u how far apart they touch it.

    With the sides L0 to L3 round both triangles u = (L0 - L1 + L2 - L3) / 2, so u is zero where L0 + L2 = L1 + L3 (a
    circle packing mesh, CP mesh, has this at all edges). Forces and moments of every pair sum to zero. Edges of a mesh
    count where two triangles share them; its quads are left out. Source: Schiftner et al., "Packing circles and spheres
    on surfaces", 2009.
    """

    kind: Literal["tangent_incircles"] = "tangent_incircles"
    particles: Maybe[IndexRows] = Field(default=None, description="Edge start, edge end, tip 1, tip 2 of each pair")
    points: Maybe[PointRows] = Field(default=None, description="Coordinates of edge start, edge end, tip 1, tip 2")
    mesh: str | None = Field(default=None, description="Name of a mesh: the edges between its triangles")
    stiffness: float = Field(default=1.0, ge=0, le=1e12, description="k [force/length]")

    formula: ClassVar[str] = "E = k (L0 - L1 + L2 - L3)²/8"
    arity: ClassVar[int] = 4
    solid: ClassVar[bool] = False
    outputs: ClassVar[dict[str, str]] = {"distance": "length", "force": "force"}
    kernel: ClassVar[Any] = staticmethod(tangent_incircles_kernel)
    hessian: ClassVar[Any] = staticmethod(tangent_incircles_hessian)
    example_faces: ClassVar[list[list[int]]] = [[0, 1, 2], [0, 2, 3], [1, 4, 2], [0, 3, 5]]

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: k."""
        if self.mesh is None:
            return Block.of(places.elements(self), stiffness=self.stiffness)
        return Block.of(folds(complete(places.faces(self.mesh))), stiffness=self.stiffness)

    def measure(self, block: Block, x: Floats, element_forces: Floats) -> dict[str, Floats]:
        """Distance of the points at which both circles touch the edge, positive where that of the first triangle is
        nearer to the edge's end [length], and k times this [force]."""
        a, b, c, d = (x[corner] for corner in block.indices.T)
        distance = 0.5 * (lengths(c - a) - lengths(c - b) + lengths(d - b) - lengths(d - a))
        return {"distance": distance, "force": block.parameters[:, 0] * distance}

    @classmethod
    def example(cls) -> tuple[TangentIncircles, Floats]:
        """Four triangles with three edges between them (`example_faces`)."""
        x = [[0, 0, 0.3], [2, 0.2, 0], [1.3, 1.9, 0.4], [-0.9, 1.5, -0.1], [3.1, 1.3, 0.5], [-1.1, 0.2, 0.2]]
        return cls(mesh="skin", stiffness=30.0), np.array(x)
