"""Clamp angle: a moment between two lines whose angle is outside two limits."""

from __future__ import annotations

from typing import ClassVar, Literal, Self

import numpy as np
from pydantic import field_validator, model_validator

from hookean.forces.base import Block, Floats, Places
from hookean.forces.line_angles import LineAngle, angle_block, within_half_a_turn
from hookean.forces.line_lengths import in_order
from hookean.values.columns import Reals
from hookean.values.fields import Field


class ClampAngle(LineAngle):
    """Moments between pairs of lines that are free between two angles and elastic outside: M = S (theta - theta0).

    theta is the angle between the directions of the lines, from 0 to pi, and theta0 the limit that is passed; energy
    S (theta - theta0)^2 / 2, and 0 between the limits. The lines need not meet; forces and moments of each pair sum to
    zero. The moment is the same for lines of any length, other than that of K2's ClampAngle.
    """

    kind: Literal["clamp_angle"] = "clamp_angle"
    lower_limit: Reals = Field(default=0.0, description="Least free angle [rad], from 0 to pi")
    upper_limit: Reals = Field(default=np.pi, description="Greatest free angle [rad], from 0 to pi")

    formula: ClassVar[str] = "E = S (θ - θ0)²/2"

    _an_angle = field_validator("lower_limit", "upper_limit")(within_half_a_turn)

    @model_validator(mode="after")
    def _limits_in_order(self) -> Self:
        in_order(self.lower_limit, self.upper_limit)
        return self

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: S, lower and upper limit."""
        return angle_block(places.elements(self), self.strength, self.lower_limit, self.upper_limit)

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
