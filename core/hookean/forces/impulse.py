"""Impulse: momentum given to particles at one moment, away from a point."""

from __future__ import annotations

from typing import ClassVar, Literal

import numpy as np

from hookean.forces.base import Block, Floats, Force, Places, lengths
from hookean.values.columns import IndexRows, NonNegatives, Points, Reals, Vectors
from hookean.values.fields import Field, Maybe

NEXT = 1e-9  # part of its time by which an impulse may be late: times of steps are sums


class Impulse(Force):
    """Momentum given to particles at one moment, away from a point, as an explosion does: dv = P u / m.

    u is the direction from the origin to the particle at that moment. Each particle gains the momentum P u, whatever
    its mass m, at the beginning of the time step that contains the moment, and the kinetic energy P u . v + P^2 / 2m,
    v its velocity before. Anchors take what is along their axes. A negative P pulls towards the origin; a particle at
    the origin has no direction and gains nothing. An impulse acts in physical time (`verlet`, `yoshida`, simulations);
    solvers that look for equilibrium leave it out and warn. Several moments are several impulses.
    """

    kind: Literal["impulse"] = "impulse"
    particles: Maybe[IndexRows] = Field(default=None, description="Particles; without a place, all of them")
    points: Maybe[Points] = Field(default=None, description="Coordinates of particles")
    origin: Vectors = Field(default=np.zeros(3), description="The point it comes from [length], or one for each")
    momentum: Reals = Field(default=1.0, description="P [force time] of each particle, or one for each")
    time: NonNegatives = Field(default=0.0, description="The moment [time] since the start, or one for each")

    formula: ClassVar[str] = "Δv = P u/m"
    role: ClassVar[Literal["internal", "load", "support"]] = "load"
    conservative: ClassVar[bool] = False
    momentary: ClassVar[bool] = True
    everywhere: ClassVar[bool] = True
    creates: ClassVar[bool] = False

    def compile(self, places: Places) -> Block:
        """Arrays: the origin, the momentum, and the moment with its allowance for rounding."""
        time = np.asarray(self.time, dtype=np.float64)
        return Block.of(
            places.elements(self),
            origin=np.atleast_2d(self.origin),
            momentum=self.momentum,
            time=time + NEXT * np.abs(time),
        )

    @classmethod
    def kick(cls, block: Block, x: Floats, since: float, until: float) -> Floats:
        """Momentum (m, 3) [force time] of the elements whose moment is in a step of time; of the others 0."""
        time = block.parameters[:, 4]
        apart = x[block.indices[:, 0]] - block.parameters[:, :3]
        largest = np.abs(apart).max(axis=1, initial=0.0)
        apart /= np.where(largest > 0.0, largest, 1.0)[:, None]  # squares of what is very small would be 0
        now = (since <= time) & (time < until) & (largest > 0.0)
        size = np.where(now, block.parameters[:, 3], 0.0) / np.where(largest > 0.0, lengths(apart), 1.0)
        return np.asarray(apart * size[:, None])

    @classmethod
    def next_moment(cls, block: Block, since: float) -> float:
        """The first moment [time] of the elements from a time on; infinite if there is none."""
        time = block.parameters[:, 4]
        return float(time[time >= since].min(initial=np.inf))

    @classmethod
    def example(cls) -> tuple[Impulse, Floats]:
        """Three particles thrown apart at different moments, one of them drawn in."""
        x = np.array([[1.0, 0.2, 0.1], [-0.5, 1.5, 0.3], [0.2, -1.0, 0.8]])
        return cls(particles=[0, 1, 2], origin=[0.1, 0.2, -0.3], momentum=[2.0, 5.0, -1.0], time=[0.0, 0.01, 0.02]), x
