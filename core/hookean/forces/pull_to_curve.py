"""Pulls particles onto a curve given as a polyline, each to the point of it that is closest."""

from __future__ import annotations

from typing import Any, ClassVar, Literal, Self

import numpy as np
from pydantic import model_validator

from hookean.forces.base import Block, Floats, OnFilm, Places
from hookean.forces.pull_to_mesh import Pull, pull_hessian, pull_kernel, pulls, tree
from hookean.values.columns import NonNegatives, Points, fault
from hookean.values.fields import Field


class PullToCurve(Pull):
    """Particles pulled to the closest point C of a curve that itself stays where it is: E = S |C - x|^2 / 2.

    The curve is a polyline, open or closed; give a NURBS curve as points that divide it finely
    (`discretize.divide`): a piece is off by length^2 / (8 radius) and askew by length / (2 radius), which holds back
    that part of a load as friction would. Of points equally near, that on the first piece is taken. Particles may
    slide along. One rests at a distance load / S from the curve; a strength of 0
    has no effect (it is not a hard constraint). Source: classic Kangaroo's CurvePull; Ericson, Real-Time Collision
    Detection, 2005, chapter 5 (closest points).
    """

    kind: Literal["pull_to_curve"] = "pull_to_curve"
    mesh: str | None = Field(default=None, description="Name of a mesh whose vertices are pulled")
    curve: Points = Field(description="Corners of the polyline [length], at least two")
    closed: bool = Field(default=False, description="Whether the last corner is joined to the first")
    strength: NonNegatives = Field(default=1000.0, description="S [force/length]")

    formula: ClassVar[str] = "E = S |C - x|²/2"
    shared: ClassVar[tuple[str, ...]] = ("curve",)
    on_film: ClassVar[OnFilm] = "curve"
    kernel: ClassVar[Any] = staticmethod(pull_kernel)
    hessian: ClassVar[Any] = staticmethod(pull_hessian)

    @model_validator(mode="after")
    def _two_points(self) -> Self:
        if len(self.curve) < 2:
            raise fault(f"{len(self.curve)} points given; a curve needs at least two", "/curve")
        return self

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: strength, address and rows of the tree about the curve's pieces."""
        after = np.roll(self.curve, -1, axis=0)
        count = len(self.curve) - (0 if self.closed else 1)
        pieces = np.stack([self.curve, after, after], axis=1)[:count]
        return pulls(places.elements(self), self.strength, *tree(pieces))

    @classmethod
    def example(cls) -> tuple[PullToCurve, Floats]:
        """Three particles about a bent line: beside its pieces and beyond its start."""
        curve = [[-2.0, 0.0, 0.0], [2.0, 0.0, 0.0], [6.0, 3.0, 1.0]]
        x = np.array([[0.2, 1.0, 0.5], [4.5, 1.0, -0.5], [-3.0, -0.5, 0.3]])
        return cls(particles=[0, 1, 2], curve=curve, strength=[100.0, 20.0, 3.0]), x
