"""Self-weight: a total shared by particles, or a weight per length of lines."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np
from pydantic import model_validator

from hookean.forces.base import Block, Floats, Force, OnFilm, Places
from hookean.forces.unary import unary_kernel
from hookean.values.columns import IndexRows, Lines, Points, Reals, Vector, fault
from hookean.values.fields import Field, Maybe


class SelfWeight(Force):
    """Weight as loads: `total` / number of particles on each, or half of `per_length` x start length on line ends.

    With a total, give particles, points or a mesh (nothing: every particle of the scene): 10 N on 51 particles is
    0.196 N each, also where some of the given points met no particle (the scene is not `strict`) and their part of the
    total is left out. With a weight per length, give lines, pairs of particles or a mesh (its edges). The load does not
    change as the lines stretch: weight is conserved. Energy -W d . x. Source: the chapter, 9.5.
    """

    kind: Literal["self_weight"] = "self_weight"
    particles: Maybe[IndexRows] = Field(default=None, description="Particles, or pairs with a weight per length")
    points: Maybe[Points] = Field(default=None, description="Coordinates of particles")
    lines: Maybe[Lines] = Field(default=None, description="Straight lines, for a weight per length")
    mesh: str | None = Field(default=None, description="Name of a mesh: its vertices, or its edges")
    total: float | None = Field(default=None, description="Total weight [force], shared equally")
    per_length: Maybe[Reals] = Field(default=None, description="Weight per length [force/length]")
    direction: Vector = Field(
        default=np.array([0.0, 0.0, -1.0]), description="Direction of gravity; its length is ignored"
    )

    formula: ClassVar[str] = "E = -W d·x"
    role: ClassVar[Literal["internal", "load", "support"]] = "load"
    creates: ClassVar[bool] = False
    constant: ClassVar[bool] = True
    everywhere: ClassVar[bool] = True
    on_film: ClassVar[OnFilm] = "spread"
    outputs: ClassVar[dict[str, str]] = {"force": "force"}
    kernel: ClassVar[Any] = staticmethod(unary_kernel)

    @model_validator(mode="after")
    def _one_way(self) -> SelfWeight:
        if (self.total is None) == (self.per_length is None):
            raise fault("give either total or per_length")
        if not np.linalg.norm(self.direction) > 0:
            raise fault("the direction of gravity must not be zero", "/direction")
        if self.per_length is not None and self.particles is None and self.lines is None and self.mesh is None:
            raise fault("per_length needs lines, pairs of particles or a mesh")
        if self.total is not None and self.lines is not None:
            raise fault("lines need per_length; give particles or points for a total", "/lines")
        if self.per_length is not None and self.points is not None:
            raise fault("points need a total; give lines for a weight per length", "/points")
        return self

    @property
    def element_arity(self) -> int:
        """Particles share a total; lines have a weight per length."""
        return 1 if self.per_length is None else 2

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: one load for each particle that carries weight."""
        index = places.elements(self)
        down = np.asarray(self.direction) / np.linalg.norm(self.direction)
        if self.per_length is None:
            share = float(self.total or 0.0) / max(len(index), 1)  # of all points, also of those that met no particle
            return Block.of(index, vector=np.broadcast_to(share * down, (len(index), 3)))
        index = index[(index >= 0).all(axis=1)]
        length = np.linalg.norm(places.x[index[:, 1]] - places.x[index[:, 0]], axis=1)
        half = 0.5 * np.broadcast_to(self.per_length, length.shape) * length
        weight = np.bincount(index.ravel(), np.repeat(half, 2), len(places.x))
        particles = np.unique(index)
        return Block.of(particles[:, None], vector=weight[particles, None] * down)

    @classmethod
    def example(cls) -> tuple[SelfWeight, Floats]:
        """10 N shared by three particles."""
        return cls(particles=[0, 1, 2], total=10.0), np.eye(3)
