"""Clamp length: lines that resist only beyond a greatest or below a least length."""

from __future__ import annotations

from typing import Any, ClassVar, Literal, Self

import numpy as np
from pydantic import model_validator

from hookean.compiled.marks import device
from hookean.forces.base import Block, Floats, Places, lengths
from hookean.forces.line_lengths import LineForce, fill, in_order, line, pull, resist
from hookean.values.columns import NonNegatives
from hookean.values.fields import Field, Maybe


@device
def outside(parameters: Any, e: Any, length: Any) -> Any:
    """How far a length is above its upper limit, or below its lower one (then negative); 0 between them."""
    if parameters[e, 2] > 0.0 and length > parameters[e, 2]:
        return length - parameters[e, 2]
    return min(length - parameters[e, 1], 0.0)


def clamp_length_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    energy = 0.0
    for e in range(indices.shape[0]):
        w[indices[e, 0]] += 2.0 * parameters[e, 0]
        w[indices[e, 1]] += 2.0 * parameters[e, 0]
        length, dx, dy, dz = line(x, indices, e)
        excess = outside(parameters, e, length)
        energy += 0.5 * parameters[e, 0] * excess * excess
        if length > 0.0 and excess != 0.0:
            pull(indices, e, parameters[e, 0] * excess / length, dx, dy, dz, f)
    return energy


def clamp_length_central(x, indices, parameters, memory, stiffness):  # type: ignore[no-untyped-def]
    for e in range(indices.shape[0]):
        length, dx, dy, dz = line(x, indices, e)
        excess = outside(parameters, e, length)
        resist(stiffness, e, parameters[e, 0] if excess != 0.0 else 0.0, parameters[e, 0] * excess, length, dx, dy, dz)


def clamp_length_hessian(x, indices, parameters, memory, blocks):  # type: ignore[no-untyped-def]
    row = np.zeros((1, 5))
    for e in range(indices.shape[0]):
        length, dx, dy, dz = line(x, indices, e)
        excess = outside(parameters, e, length)
        resist(row, 0, parameters[e, 0] if excess != 0.0 else 0.0, parameters[e, 0] * excess, length, dx, dy, dz)
        fill(blocks, e, row)


class ClampLength(LineForce):
    """Lines that are free between two limits and elastic outside: E = k (l - L)^2 / 2, L the limit that is passed.

    The defaults make a rope: its upper limit is the start length, and it has no lower one, so that it is slack where
    its ends come closer. A strut that loses contact has a lower limit alone (`upper_limit = 0`). A weight P on a rope
    stretches it to L + P / k. K2's ClampLength has half of its strength as k.
    """

    kind: Literal["clamp_length"] = "clamp_length"
    stiffness: NonNegatives = Field(default=1000.0, description="k [force/length]")
    lower_limit: NonNegatives = Field(default=0.0, description="Pushes below this length [length]; 0: never")
    upper_limit: Maybe[NonNegatives] = Field(
        default=None, description="Pulls above this length [length]; 0: never; default: the start length"
    )

    formula: ClassVar[str] = "E = k (l - L)²/2"
    steady: ClassVar[str] = "stiffness"
    kernel: ClassVar[Any] = staticmethod(clamp_length_kernel)
    hessian: ClassVar[Any] = staticmethod(clamp_length_hessian)
    central: ClassVar[Any] = staticmethod(clamp_length_central)

    @model_validator(mode="after")
    def _limits_in_order(self) -> Self:
        if self.upper_limit is not None:
            in_order(self.lower_limit, np.where(np.equal(self.upper_limit, 0.0), np.inf, self.upper_limit))
        return self

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: k, lower and upper limit."""
        index = places.elements(self)
        high = self.upper_limit
        if high is None:
            high = np.maximum(lengths(places.x[index[:, 1]] - places.x[index[:, 0]]), self.lower_limit)
        return Block.of(index, stiffness=self.stiffness, lower_limit=self.lower_limit, upper_limit=high)

    @classmethod
    def example(cls) -> tuple[ClampLength, Floats]:
        """Four lines on four particles: too long, too short, free, a little too long."""
        x = np.array([[0.0, 0.1, 0.0], [1.0, 0.0, 0.2], [0.3, 1.1, -0.1], [0.2, 0.4, 0.9]])
        lines = cls(
            particles=[[0, 1], [1, 2], [2, 3], [3, 0]],
            stiffness=[1000.0, 500.0, 20.0, 300.0],
            lower_limit=[0.2, 2.0, 0.3, 0.7],
            upper_limit=[0.4, 3.0, 2.5, 0.9],
        )
        return lines, x
