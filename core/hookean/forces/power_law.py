"""Power law: pairs of particles that attract or repel each other by a power of their distance."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np
from pydantic import field_validator

from hookean.compiled.marks import device
from hookean.forces.base import Block, Floats, Places
from hookean.forces.line_lengths import LineForce, apart, pull
from hookean.values.columns import Reals, fault
from hookean.values.fields import Field

STEEPEST = 9.0  # exponent: more would overflow where particles nearly meet
NEAREST = 1e-20  # distance from which a pair acts


@device
def pair(x: Any, indices: Any, parameters: Any, e: Any) -> Any:
    """Of one pair: its distance, the vector between its particles, and whether it acts at this distance."""
    dx = x[indices[e, 1], 0] - x[indices[e, 0], 0]
    dy = x[indices[e, 1], 1] - x[indices[e, 0], 1]
    dz = x[indices[e, 1], 2] - x[indices[e, 0], 2]
    length = np.sqrt(dx * dx + dy * dy + dz * dz)
    cutoff = parameters[e, 2]
    acts = length > NEAREST and (cutoff == 0.0 or (length < cutoff if cutoff > 0.0 else length > -cutoff))
    return length, dx, dy, dz, acts


@device
def potential(strength: Any, power: Any, length: Any) -> Any:
    """The integral of -S d^n."""
    if power == -1.0:
        return -strength * np.log(length)
    return -strength * length ** (power + 1.0) / (power + 1.0)


def power_law_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    energy = 0.0
    for e in range(indices.shape[0]):
        strength, power, cutoff = parameters[e, 0], parameters[e, 1], np.abs(parameters[e, 2])
        length, dx, dy, dz, acts = pair(x, indices, parameters, e)
        if not acts:
            continue
        push = strength * length ** (power - 1.0)  # by distance
        stiffness = 2.0 * np.abs(push) * max(1.0, np.abs(power))
        w[indices[e, 0]] += stiffness
        w[indices[e, 1]] += stiffness
        energy += potential(strength, power, length) - (potential(strength, power, cutoff) if cutoff > 0.0 else 0.0)
        pull(indices, e, -push, dx, dy, dz, f)
    return energy


def power_law_hessian(x, indices, parameters, memory, blocks):  # type: ignore[no-untyped-def]
    d = np.zeros(3)
    for e in range(indices.shape[0]):
        length, d[0], d[1], d[2], acts = pair(x, indices, parameters, e)
        across = -parameters[e, 0] * length ** (parameters[e, 1] - 1.0) if acts else 0.0
        along = across * parameters[e, 1]
        square = length * length if acts else 1.0
        for i in range(3):
            for j in range(3):
                entry = (along - across) * d[i] * d[j] / square + (across if i == j else 0.0)
                apart(blocks, e, i, j, entry)


def not_too_steep(exponent: float | Floats) -> float | Floats:
    """An exponent whose powers are finite; else a fault of its field."""
    values = np.ravel(exponent)
    steep = values[np.abs(values) > STEEPEST]
    if len(steep):
        raise fault(f"{steep[0]:g} given; exponents from -{STEEPEST:g} to {STEEPEST:g} allowed")
    return exponent


class PowerLaw(LineForce):
    """Pairs that repel each other by a power of their distance, F = S d^n; with a negative strength they attract.

    Energy -S d^(n+1) / (n+1), or -S ln d where n = -1. n = -2 is gravity or electric charge, n = 0 a constant force,
    n = 1 a spring of rest length 0 (S = -k). A positive cutoff lets a pair act below this distance only, a negative one
    above it only; there the force ends at once, and the energy is 0. Pairs nearer
    than 1e-20 do not act.
    """

    kind: Literal["power_law"] = "power_law"
    strength: Reals = Field(default=1.0, description="S [force/length^n]; positive: they repel each other")
    exponent: Reals = Field(default=-2.0, description="n [-]")
    cutoff: Reals = Field(
        default=0.0, description="Acts only below this distance, if negative only above it [length]; 0: always"
    )

    formula: ClassVar[str] = "E = -S d^(n+1)/(n + 1)"
    solid: ClassVar[bool] = False
    example_beside: ClassVar[dict[str, Any]] = {
        "forces": [{"kind": "springs", "particles": [[0, 1], [1, 2], [2, 3], [3, 0]]}]
    }
    kernel: ClassVar[Any] = staticmethod(power_law_kernel)
    hessian: ClassVar[Any] = staticmethod(power_law_hessian)

    _not_too_steep = field_validator("exponent")(not_too_steep)

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: strength, exponent, cutoff."""
        index = places.elements(self)
        return Block.of(index, strength=self.strength, exponent=self.exponent, cutoff=self.cutoff)

    @classmethod
    def example(cls) -> tuple[PowerLaw, Floats]:
        """Four pairs on four particles: gravity, charge, a logarithm, and a cutoff above which it acts."""
        x = np.array([[0.0, 0.1, 0.0], [1.0, 0.0, 0.2], [0.3, 1.1, -0.1], [0.2, 0.4, 0.9]])
        pairs = cls(
            particles=[[0, 1], [1, 2], [2, 3], [3, 0]],
            strength=[-20.0, 5.0, 3.0, -2.0],
            exponent=[-2.0, -2.0, -1.0, 1.5],
            cutoff=[0.0, 3.0, 0.0, -0.2],
        )
        return pairs, x
