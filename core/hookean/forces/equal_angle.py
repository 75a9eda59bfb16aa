"""Equal angle: groups of pairs of lines that turn to the mean of their angles."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np

from hookean.compiled import dispatch
from hookean.compiled.marks import device
from hookean.forces import groups
from hookean.forces.base import Block, Floats, Places
from hookean.forces.groups import begins, following
from hookean.forces.line_angles import LinePair, between, fill, line_angles, turn
from hookean.values.columns import Labels, NonNegatives
from hookean.values.fields import Field, Maybe

S = groups.COLUMNS  # column of the strength


@device
def mean_angle(x: Any, indices: Any, parameters: Any, first: Any, g: Any) -> Any:
    """The mean angle of a group, weighted by strength; pairs with a line of zero length do not count."""
    total = weight = 0.0
    e = first
    while e >= 0:
        sine, cosine, _, _ = between(x, indices, e, g)
        if not np.isnan(sine):
            total += parameters[e, S] * np.arctan2(sine, cosine)
            weight += parameters[e, S]
        e = following(parameters, e)
    return total / weight if weight > 0.0 else 0.0


def equal_angle_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    energy = 0.0
    g = np.zeros((5, 3))
    for first in range(indices.shape[0]):
        if not begins(parameters, first):
            continue
        mean = mean_angle(x, indices, parameters, first, g)
        e = first
        while e >= 0:
            sine, cosine, a, b = between(x, indices, e, g)
            if not np.isnan(sine):
                off = np.arctan2(sine, cosine) - mean
                energy += 0.5 * parameters[e, S] * off * off
                turn(indices, e, parameters[e, S], parameters[e, S] * off, a, b, g, f, w)
            e = following(parameters, e)
    return energy


def equal_angle_second(x, indices, parameters, moments, whole):  # type: ignore[no-untyped-def]
    """Write the second derivatives (m, 13, 13) of S (theta - q)^2 / 2 by the coordinates of a pair and q, its mean, and
    the moments (m,)."""
    g = np.zeros((5, 3))
    for first in range(indices.shape[0]):
        if not begins(parameters, first):
            continue
        mean = mean_angle(x, indices, parameters, first, g)
        e = first
        while e >= 0:
            moments[e] = 0.0
            strength = parameters[e, S]
            sine, cosine, a, b = between(x, indices, e, g)
            if not np.isnan(sine):
                moments[e] = strength * (np.arctan2(sine, cosine) - mean)
                whole[e, 12, 12] = strength
                for i in range(2):
                    for c in range(3):
                        slope = strength * g[2 + i, c] / (a if i == 0 else b)
                        for p in range(2):
                            at = 6 * i + 3 * p + c
                            whole[e, at, 12] = whole[e, 12, at] = slope if p == 1 else -slope
                fill(whole, e, strength, moments[e], sine, cosine, a, b, g)
            e = following(parameters, e)


class EqualAngle(LinePair, groups.Grouped):
    """Groups of pairs of lines that turn to the same angle: E = sum S (theta - m)^2 / 2, m the mean of the group.

    theta is the angle between the directions of the lines of a pair, from 0 to pi, as for `angle`. m is weighted by S,
    so that the energy is least by it, and the moment of each pair is S (theta - m). The lines need not meet; forces and
    moments of each pair sum to zero. Pairs with the same number are one group; without numbers all are.
    """

    kind: Literal["equal_angle"] = "equal_angle"
    group: Maybe[Labels] = Field(default=None, description="Number of the group of each pair; default: all are in one")
    strength: NonNegatives = Field(default=1.0, description="S, moment per angle [force length]")

    formula: ClassVar[str] = "E = Σ S (θ - m)²/2"
    unknowns: ClassVar[int] = 1
    outputs: ClassVar[dict[str, str]] = {"angle": "angle", "moment": "moment"}
    kernel: ClassVar[Any] = staticmethod(equal_angle_kernel)

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: links of the groups, S."""
        index = places.elements(self)
        return Block.of(index, links=groups.links(index, self.group), strength=self.strength)

    def measure(self, block: Block, x: Floats, element_forces: Floats) -> dict[str, Floats]:
        """Angle [rad] and the moment that turns the lines towards each other [force length]."""
        return {"angle": line_angles(x, block.indices), "moment": second(block, x)[1]}

    @classmethod
    def second(cls, block: Block, memory: Floats, x: Floats) -> Floats:
        """Of S (theta - m)^2 / 2 by the particles of a pair and m."""
        return second(block, x)[0]

    @classmethod
    def example(cls) -> tuple[EqualAngle, Floats]:
        """Five pairs of lines in two groups, apart from each other, that take turns; some pairs share particles."""
        x = [[0, 0, 0], [1, 0.1, 0.2], [0.4, 0.9, 0.3], [0.6, -0.8, 0.25], [1.4, 0.8, -0.1]]
        x += [[4.0, 0.0, 0.3], [5.1, 0.2, 0.0], [5.0, 2.4, 0.4], [3.8, 1.0, 1.2]]
        pairs = cls(
            particles=[[0, 1, 0, 2], [5, 6, 5, 7], [1, 2, 3, 4], [6, 8, 7, 5], [3, 0, 4, 2]],
            group=[3, 1, 3, 1, 3],
            strength=[20.0, 5.0, 50.0, 8.0, 10.0],
        )
        return pairs, np.array(x)


def second(block: Block, x: Floats) -> tuple[Floats, Floats]:
    """Second derivatives (m, 13, 13) by the particles of each pair and its mean, and moments (m,)."""
    whole, moments = np.zeros((len(block.indices), 13, 13)), np.zeros(len(block.indices))
    dispatch.compiled(equal_angle_second)(x, block.indices, block.parameters, moments, whole)
    return whole, moments
