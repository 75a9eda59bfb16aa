"""Unary force: a constant vector on each particle, and a constant moment on those with rotations."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np

from hookean.forces.base import Block, Floats, Force, OnFilm, Places, Rider
from hookean.forces.moments import Moments
from hookean.values.columns import IndexRows, Points, Vectors
from hookean.values.fields import Field, Maybe


def unary_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    energy = 0.0
    for e in range(indices.shape[0]):
        a = np.uint64(indices[e, 0])  # unsigned: no index counts from the end
        # one sum an element: three in a row would wait for each other
        energy -= parameters[e, 0] * x[a, 0] + parameters[e, 1] * x[a, 1] + parameters[e, 2] * x[a, 2]
        f[a, 0] += parameters[e, 0]
        f[a, 1] += parameters[e, 1]
        f[a, 2] += parameters[e, 2]
    return energy


class Unary(Force):
    """A load: a constant force vector F on each particle. Energy -F . x. Source: the chapter, 9.3.

    Particles with rotations, the ends of beams, may have a moment M beside. It keeps its direction in space, and so has
    no energy in general. Equilibria are exact, and Newton steps have its whole tangent. Stability, frequencies and
    buckling leave out the skew part, M x / 2: they are exact where all rotations are about the axis of M. Where they
    find the shape unstable, from about M = 3 EI / L on a cantilever, a run leaves it and may not come to rest.
    """

    kind: Literal["unary"] = "unary"
    particles: Maybe[IndexRows] = Field(default=None, description="Loaded particles")
    points: Maybe[Points] = Field(default=None, description="Coordinates of loaded particles")
    vector: Vectors = Field(description="F [force], one vector or one for each particle")
    moment: Vectors = Field(default=np.zeros(3), description="M [force length], on particles with rotations (beams)")

    formula: ClassVar[str] = "E = -F·x"
    linear: ClassVar[str] = "vector"
    role: ClassVar[Literal["internal", "load", "support"]] = "load"
    creates: ClassVar[bool] = False
    constant: ClassVar[bool] = True
    on_film: ClassVar[OnFilm] = "spread"
    outputs: ClassVar[dict[str, str]] = {"force": "force", "moment": "moment"}
    rider: ClassVar[type[Rider] | None] = Moments
    kernel: ClassVar[Any] = staticmethod(unary_kernel)

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: the vector; and the moment, for `Moments`."""
        index = places.elements(self)
        return Block.of(index, vector=self.vector.reshape(-1, 3), moment=self.moment.reshape(-1, 3))

    def measure(self, block: Block, x: Floats, element_forces: Floats) -> dict[str, Floats]:
        """The load on each particle [force], and its moment [force length]."""
        return {"force": element_forces[:, 0], "moment": block.parameters[:, 3:6].copy()}

    @classmethod
    def example(cls) -> tuple[Unary, Floats]:
        """Two loads, in different directions."""
        return cls(particles=[0, 1], vector=[[0.0, 0.0, -20.0], [3.0, 1.0, 0.0]]), np.eye(3)[:2]
