"""Angle snap: a moment that turns two lines to the nearest multiple of an angle."""

from __future__ import annotations

from typing import ClassVar, Literal

import numpy as np
from pydantic import field_validator

from hookean.forces.base import Block, Floats, Places
from hookean.forces.line_angles import LineAngle, angle_block, within_half_a_turn
from hookean.values.columns import Positives
from hookean.values.fields import Field


class AngleSnap(LineAngle):
    """Moments between pairs of lines that turn them to the nearest multiple of an angle a: M = S (theta - n a).

    theta is the angle between the directions of the lines, from 0 to pi, and n a the nearest multiple up to pi; energy
    S (theta - n a)^2 / 2. n is found again wherever the lines are, so that each multiple has a well of its own. A
    multiple of pi / 2 makes lines parallel or perpendicular, one of pi parallel in the same or the opposite direction.
    The lines need not meet; forces and moments of each pair sum to zero.
    """

    kind: Literal["angle_snap"] = "angle_snap"
    multiple: Positives = Field(
        default=np.pi / 2, description="a [rad], at most pi: lines turn to 0, a, 2 a, ..., up to pi"
    )

    formula: ClassVar[str] = "E = S (θ - n a)²/2"

    @field_validator("multiple")
    @classmethod
    def _an_angle(cls, angle: float | Floats) -> float | Floats:
        return within_half_a_turn(angle)

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: S, a."""
        return angle_block(places.elements(self), self.strength, 0.0, 0.0, self.multiple)

    @classmethod
    def example(cls) -> tuple[AngleSnap, Floats]:
        """Three pairs of lines on five particles: a right angle, parallel lines, a sixth of a turn."""
        x = np.array([[0.0, 0.0, 0.0], [1.0, 0.1, 0.2], [0.4, 0.9, 0.3], [0.6, -0.8, 0.25], [1.4, 0.8, -0.1]])
        pairs = cls(
            particles=[[0, 1, 0, 2], [1, 2, 3, 4], [3, 0, 4, 2]],
            strength=[20.0, 5.0, 50.0],
            multiple=[np.pi / 2, np.pi, np.pi / 3],
        )
        return pairs, x
