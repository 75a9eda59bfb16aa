"""Constant tension: lines that pull their ends together with the same force at any length."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np

from hookean.forces.base import Block, Floats, Places
from hookean.forces.line_lengths import LineForce, fill, line, pull, resist
from hookean.values.columns import Reals
from hookean.values.fields import Field


def constant_tension_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    energy = 0.0
    for e in range(indices.shape[0]):
        length, dx, dy, dz = line(x, indices, e)
        energy += parameters[e, 0] * length
        if length > 0.0:
            density = parameters[e, 0] / length
            pull(indices, e, density, dx, dy, dz, f)
            w[indices[e, 0]] += 2.0 * np.abs(density)
            w[indices[e, 1]] += 2.0 * np.abs(density)
    return energy


def constant_tension_central(x, indices, parameters, memory, stiffness):  # type: ignore[no-untyped-def]
    for e in range(indices.shape[0]):
        length, dx, dy, dz = line(x, indices, e)
        resist(stiffness, e, 0.0, parameters[e, 0], length, dx, dy, dz)


def constant_tension_hessian(x, indices, parameters, memory, blocks):  # type: ignore[no-untyped-def]
    row = np.zeros((1, 5))
    for e in range(indices.shape[0]):
        length, dx, dy, dz = line(x, indices, e)
        resist(row, 0, 0.0, parameters[e, 0], length, dx, dy, dz)
        fill(blocks, e, row)


class ConstantTension(LineForce):
    """Lines with the same tension T at any length, such as ropes over pulleys to hanging weights: E = T l.

    Where three of the same tension meet, they meet at 120 degrees (the Fermat point): the lines of a loaded net of
    constant tensions have the least total T l. A negative tension pushes the ends apart. A line of zero length has no
    direction and no force. Source: Maxwell, On reciprocal figures, frames and diagrams of forces, 1870 (T l);
    K2's ConstantTension, which pulls with half of its strength.
    """

    kind: Literal["constant_tension"] = "constant_tension"
    tension: Reals = Field(default=1.0, description="T [force]; negative: compression")

    formula: ClassVar[str] = "E = T l"
    linear: ClassVar[str] = "tension"
    kernel: ClassVar[Any] = staticmethod(constant_tension_kernel)
    hessian: ClassVar[Any] = staticmethod(constant_tension_hessian)
    central: ClassVar[Any] = staticmethod(constant_tension_central)

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: tension."""
        return Block.of(places.elements(self), tension=self.tension)

    @classmethod
    def example(cls) -> tuple[ConstantTension, Floats]:
        """Four lines on four particles, one of them in compression."""
        x = np.array([[0.0, 0.1, 0.0], [1.0, 0.0, 0.2], [0.3, 1.1, -0.1], [0.2, 0.4, 0.9]])
        return cls(particles=[[0, 1], [1, 2], [2, 3], [3, 0]], tension=[20.0, 5.0, 3.0, -1.0]), x
