"""Concentric: axes of two bodies that become one line."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np

from hookean.forces.base import Block, Floats, Force, Places, lengths
from hookean.values.columns import IndexRows, NonNegatives, PointRows
from hookean.values.fields import Field, Maybe

TINY = 1e-280  # square of a length below which an axis is a point


def concentric_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    energy = 0.0
    for e in range(indices.shape[0]):
        strength = parameters[e, 0]
        for end in range(4):
            p = indices[e, end]
            a, b = indices[e, 2 if end < 2 else 0], indices[e, 3 if end < 2 else 1]
            square, along = 0.0, 0.0
            for c in range(3):
                square += (x[b, c] - x[a, c]) * (x[b, c] - x[a, c])
                along += (x[b, c] - x[a, c]) * (x[p, c] - x[a, c])
            t = along / square if square > TINY else 0.0
            reach = 1.0 + abs(1.0 - t) + abs(t)
            w[p] += strength * reach
            w[a] += strength * abs(1.0 - t) * reach
            w[b] += strength * abs(t) * reach
            for c in range(3):
                d = x[p, c] - (1.0 - t) * x[a, c] - t * x[b, c]
                energy += 0.5 * strength * d * d
                f[p, c] -= strength * d
                f[a, c] += strength * (1.0 - t) * d
                f[b, c] += strength * t * d
    return energy


class Concentric(Force):
    """Pairs of axes that become one line: E = k sum d^2 / 2, d the distances of the ends of each from the other.

    An axis is the line through two particles; what they are the corners of is another force's matter, such as
    `rigid_body`. Bodies may turn about the common axis and slide along it. Of two axes of one length l about one middle
    a force F moves one by F / (4 k) off the other, and a moment M turns it by M / (k l^2).
    """

    kind: Literal["concentric"] = "concentric"
    particles: Maybe[IndexRows] = Field(
        default=None, description="Start and end of one axis, start and end of the other"
    )
    points: Maybe[PointRows] = Field(default=None, description="Coordinates of these four")
    strength: NonNegatives = Field(default=1000.0, description="k [force/length]")

    formula: ClassVar[str] = "E = k Σ d²/2"
    arity: ClassVar[int] = 4
    creates: ClassVar[bool] = False
    solid: ClassVar[bool] = False
    outputs: ClassVar[dict[str, str]] = {"distance": "length", "force": "force"}
    kernel: ClassVar[Any] = staticmethod(concentric_kernel)

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: k."""
        return Block.of(places.elements(self), strength=self.strength)

    def measure(self, block: Block, x: Floats, element_forces: Floats) -> dict[str, Floats]:
        """The largest distance of an end from the other axis [length], and the force on the first axis [force]."""
        far = np.zeros(len(block.indices))
        for end in range(4):
            p, a, b = (x[block.indices[:, i]] for i in ((end, 2, 3) if end < 2 else (end, 0, 1)))
            size = np.maximum(lengths(b - a), TINY)
            far = np.maximum(far, lengths(np.cross(p - a, b - a)) / size)
        return {"distance": far, "force": element_forces[:, 0] + element_forces[:, 1]}

    @classmethod
    def example(cls) -> tuple[Concentric, Floats]:
        """Two pairs of axes, askew."""
        x = [[0, 0, 0], [3, 0.2, 0.1], [0.4, 0.9, -0.2], [2.9, 0.4, 1.0], [6, 1, 2], [7, 3, 5], [4, 2, 3], [9, 3.1, 7]]
        return cls(particles=[[0, 1, 2, 3], [4, 5, 6, 7]], strength=[50.0, 8.0]), np.array(x)
