"""Clamp angle: a moment between two lines whose angle is outside two limits."""

from __future__ import annotations

from typing import Any, ClassVar, Literal, Self

import numpy as np
from pydantic import field_validator, model_validator

from hookean.compiled.marks import device
from hookean.forces.base import Block, Floats, Force, Places
from hookean.forces.line_angles import between, fill, line_angles, turn, within_half_a_turn
from hookean.forces.line_lengths import in_order
from hookean.values.columns import IndexRows, NonNegatives, PointRows, Reals
from hookean.values.fields import Field, Maybe


@device
def outside(angle: Any, low: Any, high: Any) -> Any:
    """How far an angle is above its upper limit, or below its lower one (then negative); 0 between them."""
    return angle - np.minimum(np.maximum(angle, low), high)


def clamp_angle_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    energy = 0.0
    g = np.zeros((5, 3))
    for e in range(indices.shape[0]):
        sine, cosine, a, b = between(x, indices, e, g)
        if np.isnan(sine):
            continue
        off = outside(np.arctan2(sine, cosine), parameters[e, 1], parameters[e, 2])
        energy += 0.5 * parameters[e, 0] * off * off
        turn(indices, e, parameters[e, 0], parameters[e, 0] * off, a, b, g, f, w)
    return energy


def clamp_angle_hessian(x, indices, parameters, memory, blocks):  # type: ignore[no-untyped-def]
    g = np.zeros((5, 3))
    for e in range(indices.shape[0]):
        sine, cosine, a, b = between(x, indices, e, g)
        if np.isnan(sine):
            continue
        off = outside(np.arctan2(sine, cosine), parameters[e, 1], parameters[e, 2])
        stiffness = parameters[e, 0] if off != 0.0 else 0.0
        fill(blocks, e, stiffness, parameters[e, 0] * off, sine, cosine, a, b, g)


class ClampAngle(Force):
    """Moments between pairs of lines that are free between two angles and elastic outside: M = S (theta - theta0).

    theta is the angle between the directions of the lines, from 0 to pi, and theta0 the limit that is passed; energy
    S (theta - theta0)^2 / 2, and 0 between the limits. The lines need not meet; forces and moments of each pair sum to
    zero. The moment is the same for lines of any length, other than that of K2's ClampAngle.
    """

    kind: Literal["clamp_angle"] = "clamp_angle"
    particles: Maybe[IndexRows] = Field(
        default=None, description="Start and end of line A, start and end of line B, for each pair"
    )
    points: Maybe[PointRows] = Field(
        default=None, description="Coordinates of the start and end of line A, the start and end of line B"
    )
    strength: NonNegatives = Field(default=1.0, description="S, moment per angle [force length]")
    lower_limit: Reals = Field(default=0.0, description="Least free angle [rad], from 0 to pi")
    upper_limit: Reals = Field(default=np.pi, description="Greatest free angle [rad], from 0 to pi")

    formula: ClassVar[str] = "E = S (θ - θ0)²/2"
    creates: ClassVar[bool] = False
    arity: ClassVar[int] = 4
    solid: ClassVar[bool] = False
    outputs: ClassVar[dict[str, str]] = {"angle": "angle", "moment": "moment"}
    kernel: ClassVar[Any] = staticmethod(clamp_angle_kernel)
    hessian: ClassVar[Any] = staticmethod(clamp_angle_hessian)

    @field_validator("lower_limit", "upper_limit")
    @classmethod
    def _an_angle(cls, angle: float | Floats) -> float | Floats:
        return within_half_a_turn(angle)

    @model_validator(mode="after")
    def _limits_in_order(self) -> Self:
        in_order(self.lower_limit, self.upper_limit)
        return self

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: S, lower and upper limit."""
        index = places.elements(self)
        return Block.of(index, strength=self.strength, lower_limit=self.lower_limit, upper_limit=self.upper_limit)

    def measure(self, block: Block, x: Floats, element_forces: Floats) -> dict[str, Floats]:
        """Angle [rad] and the moment that turns the lines towards each other [force length]."""
        angle = line_angles(x, block.indices)
        return {"angle": angle, "moment": block.parameters[:, 0] * outside(angle, *block.parameters[:, 1:].T)}

    @classmethod
    def example(cls) -> tuple[ClampAngle, Floats]:
        """Three pairs of lines on five particles: too wide, too narrow, free."""
        x = np.array([[0.0, 0.0, 0.0], [1.0, 0.1, 0.2], [0.4, 0.9, 0.3], [0.6, -0.8, 0.25], [1.4, 0.8, -0.1]])
        pairs = cls(
            particles=[[0, 1, 0, 2], [1, 2, 3, 4], [3, 0, 4, 2]],
            strength=[20.0, 5.0, 50.0],
            lower_limit=[0.0, 2.4, 0.1],
            upper_limit=[0.5, 2.8, 2.7],
        )
        return pairs, x
