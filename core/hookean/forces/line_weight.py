"""Line weight: a load in one direction per length of lines: true, plan or that of the start."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np

from hookean.compiled.marks import device
from hookean.forces.base import Block, Floats, OnFilm, Places, lengths, units
from hookean.forces.line_lengths import LineForce, line
from hookean.values.columns import Directions, Lines, Reals
from hookean.values.fields import Field, Maybe

Per = Literal["true", "plan", "start"]

WEIGHT, DOWN, PER, LENGTH = 0, 1, 4, 5  # columns of the parameters
TRUE, PLAN, START = 0.0, 1.0, 2.0


@device
def counted(x: Any, indices: Any, parameters: Any, e: Any, d: Any) -> Any:
    """The length that counts; writes its derivative by the line into `d`."""
    length, d[0], d[1], d[2] = line(x, indices, e)
    if parameters[e, PER] == START:
        d[0], d[1], d[2] = 0.0, 0.0, 0.0
        return parameters[e, LENGTH]
    if parameters[e, PER] == PLAN:
        along = d[0] * parameters[e, DOWN] + d[1] * parameters[e, DOWN + 1] + d[2] * parameters[e, DOWN + 2]
        for c in range(3):
            d[c] -= along * parameters[e, DOWN + c]
        length = np.sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2])
    for c in range(3):
        d[c] = d[c] / length if length > 0.0 else 0.0
    return length


def line_weight_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    energy = 0.0  # that of the present weight in a field of gravity, by which solvers judge steps
    d = np.zeros(3)
    for e in range(indices.shape[0]):
        length = counted(x, indices, parameters, e, d)
        for i in range(2):
            w[indices[e, i]] += np.abs(parameters[e, WEIGHT]) if parameters[e, PER] != START else 0.0
            for c in range(3):
                push = 0.5 * parameters[e, WEIGHT] * length * parameters[e, DOWN + c]
                f[indices[e, i], c] += push
                energy -= push * x[indices[e, i], c]
    return energy


def line_weight_hessian(x, indices, parameters, memory, blocks):  # type: ignore[no-untyped-def]
    # df = q / 2 g (u . dx) on both ends, u along the line, or its shadow; the symmetric part
    d = np.zeros(3)
    for e in range(indices.shape[0]):
        counted(x, indices, parameters, e, d)
        half = 0.5 * parameters[e, WEIGHT]
        for i in range(3):
            for j in range(3):
                one = half * parameters[e, DOWN + i] * d[j]
                other = half * parameters[e, DOWN + j] * d[i]
                blocks[e, i, j] = 0.5 * (one + other)
                blocks[e, 3 + i, 3 + j] = -0.5 * (one + other)
                blocks[e, i, 3 + j] = 0.5 * (other - one)
                blocks[e, 3 + i, j] = 0.5 * (one - other)


class LineWeight(LineForce):
    """A load q per length of lines, in one direction, half of it on each end: f = q l g / 2.

    g is the direction of the load, gravity unless given. l is the true length as it is now: the load grows with the
    line, as that of a cable that is paid out, or of ice; a cable that carries it has the shape of a catenary whatever
    its stiffness. Per plan l is the length of the line's shadow along g, as of snow: a cable that carries it is a
    parabola. Per start l stays that of the start, as the weight of a line that stretches. Per true and plan length
    these forces have no energy: moving a line up long and down short gains work; what is reported is -F . x of the
    present load F. Newton steps use the symmetric part of their stiffness.
    """

    kind: Literal["line_weight"] = "line_weight"
    lines: Maybe[Lines] = Field(default=None, description="Straight lines; their ends must meet particles")
    weight: Reals = Field(default=1.0, description="q [force/length]")
    per: Per = Field(default="true", description="Length that counts: as it is, its plan along g, or at the start")
    direction: Directions = Field(
        default=np.array([0.0, 0.0, -1.0]), description="g, direction of gravity; its length is ignored"
    )

    formula: ClassVar[str] = "f = q l g/2"
    pieces: ClassVar[dict[str, int] | None] = {}
    linear: ClassVar[str] = "weight"
    role: ClassVar[Literal["internal", "load", "support"]] = "load"
    conservative: ClassVar[bool] = False
    directed: ClassVar[bool] = True
    creates: ClassVar[bool] = False
    on_film: ClassVar[OnFilm] = "spread"
    kernel: ClassVar[Any] = staticmethod(line_weight_kernel)
    hessian: ClassVar[Any] = staticmethod(line_weight_hessian)

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: q, the unit vector along g, which length counts, that of the start."""
        index = places.elements(self)
        down = units(self.direction)
        length = lengths(places.x[index[:, 1]] - places.x[index[:, 0]])
        per = {"true": TRUE, "plan": PLAN, "start": START}[self.per]
        return Block.of(index, weight=self.weight, direction=down, per=per, length=length)

    def measure(self, block: Block, x: Floats, element_forces: Floats) -> dict[str, Floats]:
        """Length [length] and weight of each line [force]."""
        length = np.linalg.norm(x[block.indices[:, 1]] - x[block.indices[:, 0]], axis=1)
        return {"length": length, "force": element_forces.sum(axis=1)}

    @classmethod
    def example(cls) -> tuple[LineWeight, Floats]:
        """Three lines on four particles, one with an uplift."""
        x = np.array([[0.0, 0.1, 0.0], [1.0, 0.0, 0.2], [0.3, 1.1, -0.1], [0.2, 0.4, 0.9]])
        return cls(particles=[[0, 1], [1, 2], [2, 3]], weight=[10.0, 2.0, -3.0]), x
