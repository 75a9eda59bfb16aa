"""Coincident: pairs of particles that are pulled to one place."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np

from hookean.forces.base import Block, Floats, Force, Places, lengths
from hookean.values.columns import IndexRows, Lines, NonNegatives
from hookean.values.fields import Field, Maybe


def coincident_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    energy = 0.0
    for e in range(indices.shape[0]):
        a, b, strength = indices[e, 0], indices[e, 1], parameters[e, 0]
        w[a] += 2.0 * strength
        w[b] += 2.0 * strength
        for c in range(3):
            d = x[b, c] - x[a, c]
            f[a, c] += strength * d
            f[b, c] -= strength * d
            energy += 0.5 * strength * d * d
    return energy


def coincident_hessian(x, indices, parameters, memory, blocks):  # type: ignore[no-untyped-def]
    for e in range(indices.shape[0]):
        for i in range(6):
            for j in range(6):
                entry = parameters[e, 0] if i % 3 == j % 3 else 0.0
                blocks[e, i, j] = entry if i == j else -entry


class Coincident(Force):
    """Pairs of particles pulled to one place: f = k (p1 - p0), E = k |p1 - p0|^2 / 2.

    It is a spring of rest length 0 without damping, for constraints: ends that should meet, parts that should be
    joined. Under a load P across it a pair is P / k apart.
    """

    kind: Literal["coincident"] = "coincident"
    particles: Maybe[IndexRows] = Field(default=None, description="Pairs of particles p0, p1")
    lines: Maybe[Lines] = Field(default=None, description="Straight lines from p0 to p1; their ends become particles")
    strength: NonNegatives = Field(default=1000.0, description="k [force/length]")

    formula: ClassVar[str] = "E = k |p1 - p0|²/2"
    arity: ClassVar[int] = 2
    solid: ClassVar[bool] = False
    steady: ClassVar[str] = "strength"
    outputs: ClassVar[dict[str, str]] = {"distance": "length", "force": "force"}
    kernel: ClassVar[Any] = staticmethod(coincident_kernel)
    hessian: ClassVar[Any] = staticmethod(coincident_hessian)

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: strength."""
        return Block.of(places.elements(self), strength=self.strength)

    def measure(self, block: Block, x: Floats, element_forces: Floats) -> dict[str, Floats]:
        """Distance of each pair [length], and the size of the force that pulls it together [force]."""
        distance = lengths(x[block.indices[:, 1]] - x[block.indices[:, 0]])
        return {"distance": distance, "force": block.parameters[:, 0] * distance}

    @classmethod
    def example(cls) -> tuple[Coincident, Floats]:
        """Three pairs, two of which share a particle."""
        x = [[0, 0.1, 0], [1, 0, 0.2], [0.3, 1.1, -0.1], [3.0, 0.4, 0.9], [3.5, 1.0, 2.0]]
        return cls(particles=[[0, 1], [1, 2], [3, 4]], strength=[1e4, 5.0, 300.0]), np.array(x)
