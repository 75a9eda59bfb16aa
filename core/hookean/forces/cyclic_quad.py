"""Cyclic quad: the quads of a mesh whose corners are pulled onto a circle."""

from __future__ import annotations

from typing import ClassVar, Literal

import numpy as np

from hookean.forces import groups
from hookean.forces.base import Block, Floats, Places
from hookean.forces.fits import CIRCLE
from hookean.forces.fitted import Fit
from hookean.forces.mesh_edges import quads
from hookean.values.fields import Field


class CyclicQuad(Fit):
    """The corners of each quad of a mesh are pulled onto a circle: E = sum k d^2 / 2, d the distances to its
    least-squares circle.

    A quad on a circle is flat. The circles move and grow with the corners: forces and moments of each quad sum to zero,
    and each corner feels k at most from each of its quads. Triangles of the mesh are on circles. `co_circular` does
    this for any groups of particles.
    """

    kind: Literal["cyclic_quad"] = "cyclic_quad"
    mesh: str = Field(description="Name of the mesh")
    strength: float = Field(default=1.0, ge=0, le=1e12, description="k [force/length]")

    shape: ClassVar[float] = CIRCLE
    axes: ClassVar[tuple[int, ...]] = (0, 1, 2, 3, 4, 5)
    outputs: ClassVar[dict[str, str]] = {"distance": "length", "force": "force", "radius": "length"}
    example_faces: ClassVar[list[list[int]]] = [[0, 1, 2, 3], [4, 5, 6, 7]]

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: links of the corners of each quad, strength and shape."""
        faces = quads(places.faces(self.mesh))
        index = np.ascontiguousarray(faces.reshape(-1, 1))
        quad = np.repeat(np.arange(len(faces)), 4)
        return Block.of(index, links=groups.links(index, quad), strength=self.strength, shape=self.shape)

    @classmethod
    def example(cls) -> tuple[CyclicQuad, Floats]:
        """Two quads, apart from each other (`example_faces`)."""
        x = [[0, 0, 0.2], [2, 0.2, 0], [2.3, 1.9, 0.3], [-0.2, 1.5, -0.1]]
        x += [[4, 0, 0.5], [6.5, 0.1, 0.2], [6.1, 2.6, 0.4], [4.3, 2.1, 0.1]]
        return cls(mesh="skin", strength=12.0), np.array(x)
