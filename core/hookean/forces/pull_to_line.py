"""Pulls particles onto straight lines without ends that are fixed in space."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np

from hookean.forces.base import Block, Floats, OnFilm, Places, units
from hookean.forces.pull_to_mesh import Pull
from hookean.values.columns import Directions, NonNegatives, Vectors
from hookean.values.fields import Field


def pull_to_line_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    energy = 0.0
    for e in range(indices.shape[0]):
        a, strength, along = indices[e, 0], parameters[e, 0], 0.0
        w[a] += strength
        for c in range(3):
            along += (x[a, c] - parameters[e, 1 + c]) * parameters[e, 4 + c]
        for c in range(3):
            d = x[a, c] - parameters[e, 1 + c] - along * parameters[e, 4 + c]
            f[a, c] -= strength * d
            energy += 0.5 * strength * d * d
    return energy


def pull_to_line_hessian(x, indices, parameters, memory, blocks):  # type: ignore[no-untyped-def]
    for e in range(indices.shape[0]):
        for i in range(3):
            for j in range(3):
                entry = (1.0 if i == j else 0.0) - parameters[e, 4 + i] * parameters[e, 4 + j]
                blocks[e, i, j] = parameters[e, 0] * entry


class PullToLine(Pull):
    """Particles pulled to the closest point of a straight line that stays where it is: E = k d^2 / 2.

    The line goes through O along t and has no ends (for one with ends, see `pull_to_curve`). Particles may slide along
    it; one rests at a distance load / k from it.
    """

    kind: Literal["pull_to_line"] = "pull_to_line"
    origin: Vectors = Field(default=np.zeros(3), description="O, a point of the line [length], or one for each")
    direction: Directions = Field(default=np.array([0.0, 0.0, 1.0]), description="t, or one for each; any length [-]")
    strength: NonNegatives = Field(default=1000.0, description="k [force/length]")

    formula: ClassVar[str] = "E = k (|x - O|² - (t·(x - O))²)/2"
    on_film: ClassVar[OnFilm] = "curve"
    kernel: ClassVar[Any] = staticmethod(pull_to_line_kernel)
    hessian: ClassVar[Any] = staticmethod(pull_to_line_hessian)

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: strength, origin, unit direction."""
        index = places.elements(self)
        lead = units(self.direction)
        return Block.of(index, strength=self.strength, origin=np.atleast_2d(self.origin), direction=lead)

    @classmethod
    def example(cls) -> tuple[PullToLine, Floats]:
        """Three particles with lines of their own."""
        return cls(
            particles=[0, 1, 2],
            origin=[[0, 0, 0.5], [2, 0, 0], [1, 1, 1]],
            direction=[[0, 0, 1], [1, -2, 0], [1, 1, 3]],
            strength=[100.0, 20.0, 3.0],
        ), np.array([[0.3, -0.5, 2.0], [4.0, 0.2, 0.5], [-4.0, -5.0, 1.0]])
