"""Equal length: groups of lines that become as long as their mean."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np

from hookean.compiled.marks import device
from hookean.forces import groups
from hookean.forces.base import Block, Floats, Places, lengths
from hookean.forces.groups import begins, following
from hookean.forces.line_lengths import length_and_force, line, pull
from hookean.values.columns import IndexRows, Labels, Lines, NonNegatives
from hookean.values.fields import Field, Maybe

K = groups.COLUMNS  # column of the stiffness


@device
def mean_length(x: Any, indices: Any, parameters: Any, first: Any) -> Any:
    """The mean length of a group, weighted by stiffness."""
    total = weight = 0.0
    e = first
    while e >= 0:
        total += parameters[e, K] * line(x, indices, e)[0]
        weight += parameters[e, K]
        e = following(parameters, e)
    return total / weight if weight > 0.0 else 0.0


def equal_length_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    energy = 0.0
    for first in range(indices.shape[0]):
        if not begins(parameters, first):
            continue
        mean = mean_length(x, indices, parameters, first)
        e = first
        while e >= 0:
            k = parameters[e, K]
            length, dx, dy, dz = line(x, indices, e)
            energy += 0.5 * k * (length - mean) * (length - mean)
            w[indices[e, 0]] += 2.0 * k
            w[indices[e, 1]] += 2.0 * k
            if length > 0.0:
                pull(indices, e, k * (length - mean) / length, dx, dy, dz, f)
            e = following(parameters, e)
    return energy


class EqualLength(groups.Grouped):
    """Groups of lines that become equally long: E = sum k (l - m)^2 / 2, m the mean length of the group.

    m is weighted by k, so that the energy is least by it, and the tension of each line is k (l - m): it sums to zero
    over the group, which neither grows nor shrinks. Lines with the same number are one group; without numbers all are.
    A line of zero length has no direction and no force. K2's EqualLength has half of its strength as k.
    """

    kind: Literal["equal_length"] = "equal_length"
    particles: Maybe[IndexRows] = Field(default=None, description="Pairs of particles")
    lines: Maybe[Lines] = Field(default=None, description="Straight lines; their ends must meet particles")
    group: Maybe[Labels] = Field(default=None, description="Number of the group of each line; default: all are in one")
    stiffness: NonNegatives = Field(default=1.0, description="k [force/length]")

    formula: ClassVar[str] = "E = Σ k (l - m)²/2"
    creates: ClassVar[bool] = False
    arity: ClassVar[int] = 2
    steady: ClassVar[str] = "stiffness"
    solid: ClassVar[bool] = False
    unknowns: ClassVar[int] = 1
    outputs: ClassVar[dict[str, str]] = {"length": "length", "force": "force"}
    kernel: ClassVar[Any] = staticmethod(equal_length_kernel)

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: links of the groups, k."""
        index = places.elements(self)
        return Block.of(index, links=groups.links(index, self.group), stiffness=self.stiffness)

    def measure(self, block: Block, x: Floats, element_forces: Floats) -> dict[str, Floats]:
        """Length [length] and force [force; tension +]."""
        found = length_and_force(block, x, element_forces)
        return {"length": found["length"], "force": block.parameters[:, K] * (found["length"] - means(block, x))}

    @classmethod
    def second(cls, block: Block, memory: Floats, x: Floats) -> Floats:
        """Of k (l - m)^2 / 2 by both ends of a line and m."""
        k, apart = block.parameters[:, K], x[block.indices[:, 1]] - x[block.indices[:, 0]]
        length = lengths(apart)
        long = length > 0.0
        u = apart / np.where(long, length, 1.0)[:, None]
        slope = np.column_stack([-u, u, -np.ones(len(u))])
        density = np.where(long, k * (length - means(block, x)) / np.where(long, length, 1.0), 0.0)
        across = density[:, None, None] * (np.eye(3) - u[:, :, None] * u[:, None])
        found: Floats = k[:, None, None] * slope[:, :, None] * slope[:, None]
        found[:, :6, :6] += np.block([[across, -across], [-across, across]])
        return found

    @classmethod
    def example(cls) -> tuple[EqualLength, Floats]:
        """Five lines in two groups, apart from each other, that take turns."""
        x = [[0.0, 0.1, 0.0], [1.0, 0.0, 0.2], [0.3, 1.7, -0.1], [0.2, 0.4, 0.9]]
        x += [[4.0, 0.0, 0.3], [5.1, 0.2, 0.0], [5.0, 2.4, 0.4]]
        lines = cls(
            particles=[[0, 1], [4, 5], [1, 2], [5, 6], [2, 3]],
            group=[0, 7, 0, 7, 0],
            stiffness=[100.0, 50.0, 20.0, 30.0, 10.0],
        )
        return lines, np.array(x)


def means(block: Block, x: Floats) -> Floats:
    """The mean length (m,) of the group of each line."""
    head, k = groups.heads(block), block.parameters[:, K]
    length = lengths(x[block.indices[:, 1]] - x[block.indices[:, 0]])
    weight = np.bincount(head, k, len(head))[head]
    found: Floats = np.bincount(head, k * length, len(head))[head] / np.where(weight > 0.0, weight, 1.0)
    return found
