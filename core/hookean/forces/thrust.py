"""Thrust: forces that follow the direction of their line, as a rocket's do."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np

from hookean.forces.base import Block, Floats, Force, Places
from hookean.forces.line_lengths import fill, line, resist
from hookean.values.columns import IndexRows, Lines, Reals
from hookean.values.fields import Field, Maybe


def thrust_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    d = np.zeros(3)
    for e in range(indices.shape[0]):
        length, d[0], d[1], d[2] = line(x, indices, e)
        if length > 0.0:
            density = 0.5 * parameters[e, 0] / length
            for i in range(2):
                w[indices[e, i]] += np.abs(density)
                for c in range(3):
                    f[indices[e, i], c] += density * d[c]
    return 0.0


def thrust_hessian(x, indices, parameters, memory, blocks):  # type: ignore[no-untyped-def]
    # F / 2 across the line, by its length: of the start with one sign, of the end with the other; the symmetric part
    row = np.zeros((1, 5))
    for e in range(indices.shape[0]):
        length, dx, dy, dz = line(x, indices, e)
        resist(row, 0, 0.0, 0.5 * parameters[e, 0], length, dx, dy, dz)
        fill(blocks, e, row)
        for i in range(3):
            for j in range(3):
                blocks[e, 3 + i, 3 + j] = -blocks[e, 3 + i, 3 + j]
                blocks[e, i, 3 + j] = 0.0
                blocks[e, 3 + i, j] = 0.0


class Thrust(Force):
    """A force F along a line that turns with it, from its start to its end, half on each of them: f = F u / 2.

    u is the direction of the line. The force has no moment about the middle of its line. It has no energy: a line that
    is moved along, turned and moved back has gained work. A body of mass m that turns at an even rate, so that the
    thrust remains at a right angle to its speed v, runs in a circle of radius m v^2 / F. A line of zero length has no
    direction and no thrust. Newton steps use the symmetric part of its stiffness. Source: classic Kangaroo's Rocket.
    """

    kind: Literal["thrust"] = "thrust"
    particles: Maybe[IndexRows] = Field(default=None, description="Pairs of particles: tail and nose")
    lines: Maybe[Lines] = Field(default=None, description="Straight lines; their ends must meet particles")
    thrust: Reals = Field(default=1.0, description="F [force], from start to end")

    formula: ClassVar[str] = "f = F u/2"
    role: ClassVar[Literal["internal", "load", "support"]] = "load"
    conservative: ClassVar[bool] = False
    creates: ClassVar[bool] = False
    arity: ClassVar[int] = 2
    linear: ClassVar[str] = "thrust"
    outputs: ClassVar[dict[str, str]] = {"force": "force"}
    example_beside: ClassVar[dict[str, Any]] = {
        "forces": [{"kind": "anchor_spring", "particles": [0, 1, 2, 3], "strength": 100.0}]
    }
    kernel: ClassVar[Any] = staticmethod(thrust_kernel)
    hessian: ClassVar[Any] = staticmethod(thrust_hessian)

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: F."""
        return Block.of(places.elements(self), thrust=self.thrust)

    @classmethod
    def example(cls) -> tuple[Thrust, Floats]:
        """Three lines on four particles, one of them pushed backwards."""
        x = np.array([[0.0, 0.1, 0.0], [1.0, 0.0, 0.2], [0.3, 1.1, -0.1], [0.2, 0.4, 0.9]])
        return cls(particles=[[0, 1], [1, 2], [2, 3]], thrust=[10.0, 2.0, -3.0]), x
