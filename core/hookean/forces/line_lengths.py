"""Forces of a straight line that its length alone decides, E = E(l), shared by their kernels and tangents.

The tension dE/dl pulls both ends together. The tangent is d2E/dl2 along the line and tension / l across it.
"""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np

from hookean.compiled.marks import device
from hookean.forces.base import Block, Floats, Force, lengths
from hookean.values.columns import IndexRows, Lines, fault
from hookean.values.fields import Field, Maybe


@device
def line(x: Any, indices: Any, e: Any) -> Any:
    """Length of one line, and the vector along it."""
    dx = x[indices[e, 1], 0] - x[indices[e, 0], 0]
    dy = x[indices[e, 1], 1] - x[indices[e, 0], 1]
    dz = x[indices[e, 1], 2] - x[indices[e, 0], 2]
    return np.sqrt(dx * dx + dy * dy + dz * dz), dx, dy, dz


@device
def pull(indices: Any, e: Any, density: Any, dx: Any, dy: Any, dz: Any, f: Any) -> None:
    """Pull the ends of a line together by a force density: tension / length."""
    a, b = indices[e, 0], indices[e, 1]
    f[a, 0] += density * dx
    f[a, 1] += density * dy
    f[a, 2] += density * dz
    f[b, 0] -= density * dx
    f[b, 1] -= density * dy
    f[b, 2] -= density * dz


@device
def resist(stiffness: Any, e: Any, along: Any, tension: Any, length: Any, dx: Any, dy: Any, dz: Any) -> None:
    """Write the row of `Force.central`; a line of zero length has no direction, and resists alike in all."""
    inverse = 1.0 / length if length > 0.0 else 0.0
    stiffness[e, 0] = along
    stiffness[e, 1] = tension * inverse if length > 0.0 else along
    stiffness[e, 2] = dx * inverse
    stiffness[e, 3] = dy * inverse
    stiffness[e, 4] = dz * inverse


@device
def apart(blocks: Any, e: Any, i: Any, j: Any, entry: Any) -> None:
    """Write one entry of a block of `Force.hessian` where only the vector between two particles counts."""
    blocks[e, i, j] = entry
    blocks[e, 3 + i, 3 + j] = entry
    blocks[e, i, 3 + j] = -entry
    blocks[e, 3 + i, j] = -entry


@device
def fill(blocks: Any, e: Any, row: Any) -> None:
    """Write the block of `Force.hessian` from a row of `Force.central`."""
    for i in range(3):
        for j in range(3):
            entry = (row[0, 0] - row[0, 1]) * row[0, 2 + i] * row[0, 2 + j] + (row[0, 1] if i == j else 0.0)
            apart(blocks, e, i, j, entry)


class LineForce(Force):
    """Base of forces between both ends of straight lines."""

    kind: str = ""
    particles: Maybe[IndexRows] = Field(default=None, description="Pairs of particles")
    lines: Maybe[Lines] = Field(default=None, description="Straight lines; their ends become particles")

    arity: ClassVar[int] = 2
    outputs: ClassVar[dict[str, str]] = {"length": "length", "force": "force"}

    def measure(self, block: Block, x: Floats, element_forces: Floats) -> dict[str, Floats]:
        """Length [length] and force [force; tension +]."""
        return length_and_force(block, x, element_forces)


def in_order(low: float | Floats, high: float | Floats) -> None:
    """A fault of the field `lower_limit` where it is above the upper limit."""
    least, most = np.ravel(low), np.ravel(high)
    if 1 not in (len(least), len(most)) and len(least) != len(most):
        return  # not as many as elements: reported elsewhere
    least, most = np.broadcast_arrays(least, most)
    wrong = np.flatnonzero(least > most)
    if len(wrong):
        said = f"{least[wrong[0]]:g} given, above the upper limit, {most[wrong[0]]:g}; exchange them"
        raise fault(said, "/lower_limit")


def length_and_force(block: Block, x: Floats, element_forces: Floats) -> dict[str, Floats]:
    """Length [length] of each line and the force along it [force; tension +], as `Force.measure` reports them."""
    apart = x[block.indices[:, 1]] - x[block.indices[:, 0]]
    length = lengths(apart)
    along = (apart * element_forces[:, 0]).sum(axis=1)
    return {"length": length, "force": along / np.where(length > 0.0, length, 1.0)}
