"""Vortex: forces that swirl about an axis."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np
from pydantic import field_validator

from hookean.compiled.marks import device
from hookean.forces.base import Block, Floats, Force, OnFilm, Places, lengths, units
from hookean.forces.power_law import NEAREST, not_too_steep
from hookean.values.columns import Directions, IndexRows, Points, Reals, Vectors
from hookean.values.fields import Field, Maybe


@device
def swirl(x: Any, indices: Any, parameters: Any, e: Any, across: Any) -> Any:
    """Write the vector `across` from the axis to a particle; its length, 0 where the force does not act."""
    a, along, square, cutoff = indices[e, 0], 0.0, 0.0, parameters[e, 2]
    for c in range(3):
        along += (x[a, c] - parameters[e, 3 + c]) * parameters[e, 6 + c]
    for c in range(3):
        across[c] = x[a, c] - parameters[e, 3 + c] - along * parameters[e, 6 + c]
        square += across[c] * across[c]
    distance = np.sqrt(square)
    acts = distance > NEAREST and (cutoff == 0.0 or (distance < cutoff if cutoff > 0.0 else distance > -cutoff))
    return distance if acts else 0.0


def vortex_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    across = np.zeros(3)
    for e in range(indices.shape[0]):
        distance = swirl(x, indices, parameters, e, across)
        if distance == 0.0:
            continue
        a, power = indices[e, 0], parameters[e, 1]
        push = parameters[e, 0] * distance ** (power - 1.0)  # by distance
        w[a] += np.abs(push) * (1.0 + np.abs(power - 1.0))
        for c in range(3):
            i, j = (c + 1) % 3, (c + 2) % 3
            f[a, c] += push * (parameters[e, 6 + i] * across[j] - parameters[e, 6 + j] * across[i])
    return 0.0


def vortex_hessian(x, indices, parameters, memory, blocks):  # type: ignore[no-untyped-def]
    # the symmetric part: of S d^n t with t = a x r, it is that of S (n - 1) d^(n-1) t r
    across, turned = np.zeros(3), np.zeros(3)
    for e in range(indices.shape[0]):
        distance = swirl(x, indices, parameters, e, across)
        power, part = parameters[e, 1], 0.0
        if distance > 0.0:
            part = -0.5 * parameters[e, 0] * (power - 1.0) * distance ** (power - 1.0)
        for c in range(3):
            across[c] = across[c] / distance if distance > 0.0 else 0.0
        for c in range(3):
            i, j = (c + 1) % 3, (c + 2) % 3
            turned[c] = parameters[e, 6 + i] * across[j] - parameters[e, 6 + j] * across[i]
        for i in range(3):
            for j in range(3):
                blocks[e, i, j] = part * (turned[i] * across[j] + across[i] * turned[j])


class Vortex(Force):
    """Particles pushed around an axis, by a power of their distance d from it: F = S d^n, square to axis and radius.

    Positive S turns counter-clockwise as seen against the axis. n = 1 is the field of a rigid rotation, n = -1 that of
    a thin vortex. The force has no potential: a particle that goes round gains 2 pi S d^(n+1) each time, so it
    settles only with drag: use `verlet` where it is strong beside what holds the particle. Newton steps take the
    symmetric part of its stiffness. A positive cutoff lets
    it act below this distance only, a negative one above it only. Particles nearer than 1e-20 to the axis feel nothing.
    """

    kind: Literal["vortex"] = "vortex"
    particles: Maybe[IndexRows] = Field(default=None, description="Particles")
    points: Maybe[Points] = Field(default=None, description="Coordinates of particles")
    origin: Vectors = Field(default=np.zeros(3), description="A point of the axis [length], or one for each")
    axis: Directions = Field(default=np.array([0.0, 0.0, 1.0]), description="Its direction, or one for each [-]")
    strength: Reals = Field(default=1.0, description="S [force/length^n]; negative: it turns clockwise")
    exponent: Reals = Field(default=0.0, description="n [-]")
    cutoff: Reals = Field(
        default=0.0, description="Acts only below this distance, if negative only above it [length]; 0: always"
    )

    formula: ClassVar[str] = "F = S d^n"
    role: ClassVar[Literal["internal", "load", "support"]] = "load"
    conservative: ClassVar[bool] = False
    creates: ClassVar[bool] = False
    on_film: ClassVar[OnFilm] = "spread"
    outputs: ClassVar[dict[str, str]] = {"distance": "length", "force": "force"}
    kernel: ClassVar[Any] = staticmethod(vortex_kernel)
    hessian: ClassVar[Any] = staticmethod(vortex_hessian)

    _not_too_steep = field_validator("exponent")(not_too_steep)

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: strength, exponent, cutoff, a point and the unit direction of the axis."""
        return Block.of(
            places.elements(self),
            strength=self.strength,
            exponent=self.exponent,
            cutoff=self.cutoff,
            origin=np.atleast_2d(self.origin),
            axis=units(self.axis),
        )

    def measure(self, block: Block, x: Floats, element_forces: Floats) -> dict[str, Floats]:
        """Distance from the axis [length] and the force on the particle [force]."""
        apart, axis = x[block.indices[:, 0]] - block.parameters[:, 3:6], block.parameters[:, 6:9]
        return {"distance": lengths(np.cross(axis, apart)), "force": element_forces[:, 0]}

    @classmethod
    def example(cls) -> tuple[Vortex, Floats]:
        """Four particles about an axis, with exponents and cutoffs of their own."""
        return cls(
            particles=[0, 1, 2, 3],
            origin=[0.1, 0.2, 0.0],
            axis=[0.0, 1.0, 2.0],
            strength=[3.0, -2.0, 5.0, 4.0],
            exponent=[0.0, 0.5, -1.0, 2.0],
            cutoff=[0.0, 8.0, 0.0, -0.5],
        ), np.array([[2.0, 0.5, 0.1], [-1.5, 2.0, 1.0], [3.0, 3.0, -1.0], [0.5, -3.0, 2.0]])
