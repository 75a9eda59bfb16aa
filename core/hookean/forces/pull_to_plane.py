"""Pulls particles onto planes that are fixed in space."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np

from hookean.forces.base import Block, Floats, Places, units
from hookean.forces.pull_to_mesh import Pull
from hookean.values.columns import Directions, NonNegatives, Vectors
from hookean.values.fields import Field


def pull_to_plane_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    energy = 0.0
    for e in range(indices.shape[0]):
        a, strength, height = indices[e, 0], parameters[e, 0], 0.0
        w[a] += strength
        for c in range(3):
            height += (x[a, c] - parameters[e, 1 + c]) * parameters[e, 4 + c]
        energy += 0.5 * strength * height * height
        for c in range(3):
            f[a, c] -= strength * height * parameters[e, 4 + c]
    return energy


def pull_to_plane_hessian(x, indices, parameters, memory, blocks):  # type: ignore[no-untyped-def]
    for e in range(indices.shape[0]):
        for i in range(3):
            for j in range(3):
                blocks[e, i, j] = parameters[e, 0] * (parameters[e, 4 + i] * parameters[e, 4 + j])


class PullToPlane(Pull):
    """Particles pulled to the closest point of a plane that stays where it is: E = k d^2 / 2, d = n . (x - O).

    The plane goes through O, square to the normal n, and has no edge. Particles may slide along it; one rests at a
    distance load / k from it. Both sides are the same.
    """

    kind: Literal["pull_to_plane"] = "pull_to_plane"
    origin: Vectors = Field(default=np.zeros(3), description="O, a point of the plane [length], or one for each")
    normal: Directions = Field(default=np.array([0.0, 0.0, 1.0]), description="n, or one for each; any length [-]")
    strength: NonNegatives = Field(default=1000.0, description="k [force/length]")

    formula: ClassVar[str] = "E = k (n·(x - O))²/2"
    kernel: ClassVar[Any] = staticmethod(pull_to_plane_kernel)
    hessian: ClassVar[Any] = staticmethod(pull_to_plane_hessian)

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: strength, origin, unit normal."""
        index = places.elements(self)
        return Block.of(index, strength=self.strength, origin=np.atleast_2d(self.origin), normal=units(self.normal))

    @classmethod
    def example(cls) -> tuple[PullToPlane, Floats]:
        """Three particles with planes of their own."""
        return cls(
            particles=[0, 1, 2],
            origin=[[0, 0, 0.5], [2, 0, 0], [1, 1, 1]],
            normal=[[0, 0, 1], [1, -2, 0], [1, 1, 3]],
            strength=[100.0, 20.0, 3.0],
        ), np.array([[0.3, -0.5, 2.0], [4.0, 0.2, 0.5], [-4.0, -5.0, 1.0]])
