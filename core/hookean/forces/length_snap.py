"""Length snap: lines that are pulled to the nearest multiple of a length."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np

from hookean.compiled.marks import device
from hookean.forces.base import Block, Floats, Places
from hookean.forces.line_lengths import LineForce, fill, line, pull, resist
from hookean.values.columns import NonNegatives, Positives
from hookean.values.fields import Field


@device
def beyond(parameters: Any, e: Any, length: Any) -> Any:
    """How much longer a line is than the nearest multiple."""
    if parameters[e, 1] <= 1e-16 * length:
        return 0.0  # between the numbers near it: every length is a multiple
    return length - parameters[e, 1] * np.floor(length / parameters[e, 1] + 0.5)


def length_snap_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    energy = 0.0
    for e in range(indices.shape[0]):
        w[indices[e, 0]] += 2.0 * parameters[e, 0]
        w[indices[e, 1]] += 2.0 * parameters[e, 0]
        length, dx, dy, dz = line(x, indices, e)
        more = beyond(parameters, e, length)
        energy += 0.5 * parameters[e, 0] * more * more
        if length > 0.0:
            pull(indices, e, parameters[e, 0] * more / length, dx, dy, dz, f)
    return energy


def length_snap_central(x, indices, parameters, memory, stiffness):  # type: ignore[no-untyped-def]
    for e in range(indices.shape[0]):
        length, dx, dy, dz = line(x, indices, e)
        k = parameters[e, 0]
        resist(stiffness, e, k, k * beyond(parameters, e, length), length, dx, dy, dz)


def length_snap_hessian(x, indices, parameters, memory, blocks):  # type: ignore[no-untyped-def]
    row = np.zeros((1, 5))
    for e in range(indices.shape[0]):
        length, dx, dy, dz = line(x, indices, e)
        k = parameters[e, 0]
        resist(row, 0, k, k * beyond(parameters, e, length), length, dx, dy, dz)
        fill(blocks, e, row)


class LengthSnap(LineForce):
    """Lines that are pulled to the nearest multiple of a length a: E = k (l - n a)^2 / 2, n a whole number.

    n is found again wherever the line is, so that each multiple has a well of its own, from (n - 1/2) a to
    (n + 1/2) a: a load P below k a / 2 moves the line by P / k within its well, and a larger one moves it to the next.
    Lines shorter than a / 2 are pulled to zero length (n = 0). K2's LengthSnap has the same strength.
    """

    kind: Literal["length_snap"] = "length_snap"
    stiffness: NonNegatives = Field(default=1.0, description="k [force/length]")
    multiple: Positives = Field(default=1.0, description="a [length]: lines become 0, a, 2 a, ... long")

    formula: ClassVar[str] = "E = k (l - n a)²/2"
    steady: ClassVar[str] = "stiffness"
    solid: ClassVar[bool] = False
    kernel: ClassVar[Any] = staticmethod(length_snap_kernel)
    hessian: ClassVar[Any] = staticmethod(length_snap_hessian)
    central: ClassVar[Any] = staticmethod(length_snap_central)

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: k, a."""
        return Block.of(places.elements(self), stiffness=self.stiffness, multiple=self.multiple)

    @classmethod
    def example(cls) -> tuple[LengthSnap, Floats]:
        """Four lines on four particles: one and three multiples long, and less."""
        x = np.array([[0.0, 0.1, 0.0], [1.0, 0.0, 0.2], [0.3, 1.1, -0.1], [0.2, 0.4, 0.9]])
        lines = cls(
            particles=[[0, 1], [1, 2], [2, 3], [3, 0]],
            stiffness=[100.0, 50.0, 20.0, 30.0],
            multiple=[1.1, 0.4, 5.0, 0.9],
        )
        return lines, x
