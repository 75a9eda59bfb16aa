"""Direction: lines that are turned parallel to a direction that is fixed in space."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np

from hookean.compiled.marks import device
from hookean.forces.base import Block, Floats, Force, Places, lengths, units
from hookean.forces.line_lengths import apart
from hookean.values.columns import Directions, IndexRows, Lines, NonNegatives
from hookean.values.fields import Field, Maybe


@device
def off(x: Any, indices: Any, parameters: Any, e: Any, c: Any) -> Any:
    """Of the vector along a line the component `c` of its part across the direction."""
    along = 0.0
    for d in range(3):
        along += (x[indices[e, 1], d] - x[indices[e, 0], d]) * parameters[e, 1 + d]
    return x[indices[e, 1], c] - x[indices[e, 0], c] - along * parameters[e, 1 + c]


def direction_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    energy = 0.0
    for e in range(indices.shape[0]):
        a, b, k = indices[e, 0], indices[e, 1], parameters[e, 0]
        w[a] += 2.0 * k
        w[b] += 2.0 * k
        for c in range(3):
            across = off(x, indices, parameters, e, c)
            energy += 0.5 * k * across * across
            f[a, c] += k * across
            f[b, c] -= k * across
    return energy


def direction_hessian(x, indices, parameters, memory, blocks):  # type: ignore[no-untyped-def]
    for e in range(indices.shape[0]):
        for i in range(3):
            for j in range(3):
                entry = parameters[e, 0] * ((1.0 if i == j else 0.0) - parameters[e, 1 + i] * parameters[e, 1 + j])
                apart(blocks, e, i, j, entry)


class Direction(Force):
    """Lines parallel to a direction d that is fixed in space: E = k |part of the line across d|^2 / 2.

    The force is linear: k times the part of the line, end - start, that is normal to d, on the end, and the opposite on
    the start. It does not resist changes of length, and a line may point either way along d. Without a direction each
    line gets the coordinate axis that is nearest to it at the start. Forces of each line sum to zero, moments do not.
    K2's Direction has half of its strength as k.
    """

    kind: Literal["direction"] = "direction"
    particles: Maybe[IndexRows] = Field(default=None, description="Pairs of particles")
    lines: Maybe[Lines] = Field(default=None, description="Straight lines; their ends must meet particles")
    stiffness: NonNegatives = Field(default=1.0, description="k [force/length]")
    direction: Maybe[Directions] = Field(
        default=None, description="d, its length is ignored; default: the axis nearest to the line at the start"
    )

    formula: ClassVar[str] = "E = k |l - (l·d) d|²/2"
    role: ClassVar[Literal["internal", "load", "support"]] = "support"
    creates: ClassVar[bool] = False
    arity: ClassVar[int] = 2
    steady: ClassVar[str] = "stiffness"
    solid: ClassVar[bool] = False
    outputs: ClassVar[dict[str, str]] = {"offset": "length", "force": "force"}
    kernel: ClassVar[Any] = staticmethod(direction_kernel)
    hessian: ClassVar[Any] = staticmethod(direction_hessian)

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: k, the unit vector along d."""
        index = places.elements(self)
        if self.direction is None:
            nearest = np.abs(places.x[index[:, 1]] - places.x[index[:, 0]]).argmax(axis=1)
            direction = np.eye(3)[nearest]
        else:
            direction = units(self.direction)
        return Block.of(index, stiffness=self.stiffness, direction=direction)

    def measure(self, block: Block, x: Floats, element_forces: Floats) -> dict[str, Floats]:
        """Part of the line across its direction [length] and the force on its end [force]."""
        apart, d = x[block.indices[:, 1]] - x[block.indices[:, 0]], block.parameters[:, 1:]
        return {"offset": lengths(apart - (apart * d).sum(axis=1)[:, None] * d), "force": element_forces[:, 1]}

    @classmethod
    def example(cls) -> tuple[Direction, Floats]:
        """Three lines on four particles, each with a direction of its own."""
        x = np.array([[0.0, 0.1, 0.0], [1.0, 0.0, 0.2], [0.3, 1.1, -0.1], [0.2, 0.4, 0.9]])
        lines = cls(
            particles=[[0, 1], [1, 2], [2, 3]],
            stiffness=[100.0, 20.0, 3.0],
            direction=[[1.0, 0.0, 0.0], [0.0, 3.0, 0.0], [1.0, -1.0, 2.0]],
        )
        return lines, x
