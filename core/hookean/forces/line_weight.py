"""Line weight: a weight per length of lines as long as they are now."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np

from hookean.forces.base import Block, Floats, OnFilm, Places, units
from hookean.forces.line_lengths import LineForce, line
from hookean.values.columns import Directions, Lines, Reals
from hookean.values.fields import Field, Maybe


def line_weight_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    for e in range(indices.shape[0]):
        length, _, _, _ = line(x, indices, e)
        for i in range(2):
            w[indices[e, i]] += np.abs(parameters[e, 0])
            for c in range(3):
                f[indices[e, i], c] += 0.5 * parameters[e, 0] * length * parameters[e, 1 + c]
    return 0.0


def line_weight_hessian(x, indices, parameters, memory, blocks):  # type: ignore[no-untyped-def]
    # df = q / 2 g (u . dx) on both ends, u along the line; the symmetric part
    d = np.zeros(3)
    for e in range(indices.shape[0]):
        length, d[0], d[1], d[2] = line(x, indices, e)
        half = 0.5 * parameters[e, 0] / length if length > 0.0 else 0.0
        for i in range(3):
            for j in range(3):
                one = half * parameters[e, 1 + i] * d[j]
                other = half * parameters[e, 1 + j] * d[i]
                blocks[e, i, j] = 0.5 * (one + other)
                blocks[e, 3 + i, 3 + j] = -0.5 * (one + other)
                blocks[e, i, 3 + j] = 0.5 * (other - one)
                blocks[e, 3 + i, j] = 0.5 * (one - other)


class LineWeight(LineForce):
    """A weight q per length of lines as long as they are now, half of it on each end: f = q l g / 2.

    g is the direction of gravity. The load grows with the line, as that of a cable that is paid out, of ice or of snow
    on a line; a cable that carries it has the shape of a catenary whatever its stiffness. The weight of a line that
    stretches is conserved by `self_weight`, with its start length. These forces have no energy: moving a line up long
    and down short gains work. Newton steps use the symmetric part of their stiffness.
    """

    kind: Literal["line_weight"] = "line_weight"
    lines: Maybe[Lines] = Field(default=None, description="Straight lines; their ends must meet particles")
    weight: Reals = Field(default=1.0, description="q [force/length]")
    direction: Directions = Field(
        default=np.array([0.0, 0.0, -1.0]), description="g, direction of gravity; its length is ignored"
    )

    formula: ClassVar[str] = "f = q l g/2"
    role: ClassVar[Literal["internal", "load", "support"]] = "load"
    conservative: ClassVar[bool] = False
    creates: ClassVar[bool] = False
    on_film: ClassVar[OnFilm] = "spread"
    kernel: ClassVar[Any] = staticmethod(line_weight_kernel)
    hessian: ClassVar[Any] = staticmethod(line_weight_hessian)

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: q, the unit vector along g."""
        index = places.elements(self)
        down = units(self.direction)
        return Block.of(index, weight=self.weight, direction=down)

    def measure(self, block: Block, x: Floats, element_forces: Floats) -> dict[str, Floats]:
        """Length [length] and weight of each line [force]."""
        length = np.linalg.norm(x[block.indices[:, 1]] - x[block.indices[:, 0]], axis=1)
        return {"length": length, "force": element_forces.sum(axis=1)}

    @classmethod
    def example(cls) -> tuple[LineWeight, Floats]:
        """Three lines on four particles, one with an uplift."""
        x = np.array([[0.0, 0.1, 0.0], [1.0, 0.0, 0.2], [0.3, 1.1, -0.1], [0.2, 0.4, 0.9]])
        return cls(particles=[[0, 1], [1, 2], [2, 3]], weight=[10.0, 2.0, -3.0]), x
