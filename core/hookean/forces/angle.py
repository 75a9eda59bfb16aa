"""Angle: a moment between two lines that need not meet."""

from __future__ import annotations

from typing import ClassVar, Literal

import numpy as np
from pydantic import field_validator

from hookean.forces.base import Block, Floats, Places
from hookean.forces.line_angles import LineAngle, angle_block, line_angles, within_half_a_turn
from hookean.values.columns import Reals
from hookean.values.fields import Field, Maybe


class Angle(LineAngle):
    """Moments between pairs of lines that turn them to a rest angle: M = S (theta - theta0).

    theta [rad] is the angle between the directions of the lines, start to end, from 0 (the same direction) to pi; the
    lines need not meet. Energy S (theta - theta0)^2 / 2. The moment acts on each line as a couple, so that forces and
    moments sum to zero. A rest angle of 0 aligns two lines; `angle_snap` with a multiple of pi aligns them in the same
    or the opposite direction, whichever is nearer. Exactly parallel lines with another rest angle have no plane in
    which to turn, and no moment. For the bending of rods use `bend`. Source: Adriaenssens and Barnes, "Tensegrity
    spline beam and grid shell structures", 2001, with the angle in the place of its sine.
    """

    kind: Literal["angle"] = "angle"
    rest_angle: Maybe[Reals] = Field(default=None, description="theta0 [rad], from 0 to pi; default: the start angle")

    formula: ClassVar[str] = "E = S (θ - θ0)²/2"

    @field_validator("rest_angle")
    @classmethod
    def _an_angle(cls, angle: float | Floats | None) -> float | Floats | None:
        return None if angle is None else within_half_a_turn(angle)

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: S, rest angle as both limits."""
        index = places.elements(self)
        rest = line_angles(places.x, index) if self.rest_angle is None else self.rest_angle
        return angle_block(index, self.strength, rest, rest)

    @classmethod
    def example(cls) -> tuple[Angle, Floats]:
        """Three pairs of lines on five particles: wider, narrower and apart; two of them share a particle."""
        x = np.array([[0.0, 0.0, 0.0], [1.0, 0.1, 0.2], [0.4, 0.9, 0.3], [0.6, -0.8, 0.25], [1.4, 0.8, -0.1]])
        return cls(
            particles=[[0, 1, 0, 2], [1, 2, 3, 4], [3, 0, 4, 2]], strength=[20.0, 5.0, 50.0], rest_angle=[1.4, 0.5, 1.0]
        ), x
