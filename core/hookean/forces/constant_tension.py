"""Constant tension: lines that pull their ends together with the same force at any length."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np

from hookean.compiled.marks import device
from hookean.forces.base import Block, Floats, Places, lengths
from hookean.forces.line_lengths import LineForce, fill, line, pull, resist
from hookean.values.columns import Reals
from hookean.values.fields import Field

CLOSING = 1e-3  # of the mean start length of the lines of a force: shorter ones close up

TENSION, CLOSED = range(2)  # columns of parameters


@device
def closing(length: Any, tension: Any, closed: Any) -> Any:
    """Energy of a line, its tension dE/dl, and d2E/dl2."""
    if length >= closed:
        return tension * length, tension, 0.0
    part = length / closed
    return 0.5 * tension * (part * length + closed), tension * part, tension / closed


def constant_tension_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    energy = 0.0
    for e in range(indices.shape[0]):
        length, dx, dy, dz = line(x, indices, e)
        own, tension, along = closing(length, parameters[e, TENSION], parameters[e, CLOSED])
        energy += own
        density = tension / length if length > 0.0 else along
        pull(indices, e, density, dx, dy, dz, f)
        w[indices[e, 0]] += 2.0 * np.abs(density)
        w[indices[e, 1]] += 2.0 * np.abs(density)
    return energy


def constant_tension_central(x, indices, parameters, memory, stiffness):  # type: ignore[no-untyped-def]
    for e in range(indices.shape[0]):
        length, dx, dy, dz = line(x, indices, e)
        _, tension, along = closing(length, parameters[e, TENSION], parameters[e, CLOSED])
        resist(stiffness, e, along, tension, length, dx, dy, dz)


def constant_tension_hessian(x, indices, parameters, memory, blocks):  # type: ignore[no-untyped-def]
    row = np.zeros((1, 5))
    for e in range(indices.shape[0]):
        length, dx, dy, dz = line(x, indices, e)
        _, tension, along = closing(length, parameters[e, TENSION], parameters[e, CLOSED])
        resist(row, 0, along, tension, length, dx, dy, dz)
        fill(blocks, e, row)


class ConstantTension(LineForce):
    """Lines with the same tension T at any length, such as ropes over pulleys to hanging weights: E = T l.

    Where three of the same tension meet, they meet at 120 degrees (the Fermat point): the lines of a loaded net of
    constant tensions have the least total T l, and many lines of it may vanish. A line shorter than e, a thousandth of
    the mean start length of the lines of its force, closes up smoothly, with T l / e (E = T (l^2 / e + e) / 2): where
    others hold it with less than T, it has that fraction of e as its length and reports that force. A negative tension
    pushes the ends apart. Source: Maxwell, On reciprocal figures, frames and diagrams of forces, 1870 (T l); Huber,
    "Robust estimation of a location parameter", Ann. Math. Statist. 35 (1964) 73 (below e); K2's ConstantTension, which
    pulls with half of its strength.
    """

    kind: Literal["constant_tension"] = "constant_tension"
    tension: Reals = Field(
        default=1.0,
        description="T [force]; negative: compression; T l / e where a line closes up",
    )

    formula: ClassVar[str] = "E = T l; T (l²/e + e)/2 below e"
    pieces: ClassVar[dict[str, int] | None] = {}
    linear: ClassVar[str] = "tension"
    sharp: ClassVar[str] = "tension"
    kernel: ClassVar[Any] = staticmethod(constant_tension_kernel)
    hessian: ClassVar[Any] = staticmethod(constant_tension_hessian)
    central: ClassVar[Any] = staticmethod(constant_tension_central)

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: tension, and the length below which a line closes up."""
        ends = places.elements(self)
        mean = lengths(places.x[ends[:, 1]] - places.x[ends[:, 0]]).sum() / max(len(ends), 1)
        return Block.of(ends, tension=self.tension, closed=CLOSING * mean)

    @classmethod
    def example(cls) -> tuple[ConstantTension, Floats]:
        """Four lines on four particles, one of them in compression."""
        x = np.array([[0.0, 0.1, 0.0], [1.0, 0.0, 0.2], [0.3, 1.1, -0.1], [0.2, 0.4, 0.9]])
        return cls(particles=[[0, 1], [1, 2], [2, 3], [3, 0]], tension=[20.0, 5.0, 3.0, -1.0]), x
