"""Level set: particles pulled to the surface on which the potential of point charges has a given value."""

from __future__ import annotations

from typing import Any, ClassVar, Literal, Self

import numpy as np
from pydantic import model_validator

from hookean.compiled.dispatch import keep, rows
from hookean.compiled.marks import device
from hookean.forces.base import Block, Floats, Places
from hookean.forces.pull_to_mesh import Pull
from hookean.values.columns import NonNegatives, Points, Positives, fault
from hookean.values.fields import Field

STRENGTH, LEVEL, MEAN, STEEPEST, TABLE = 0, 1, 2, 3, 4  # columns of the parameters
NEAREST = 1e-150  # distance to a charge from which it has a direction


@device
def off_level(parameters: Any, e: Any, x: Any, a: Any, g: Any, h: Any) -> Any:
    """d of a particle, its gradient `g` (3,) and its second derivatives `h` (3, 3).

    Everything is by parts of the distance to the nearest charge, so that no power of it overflows.
    """
    table = rows(parameters[e, TABLE], parameters[e, TABLE + 1], 4)
    nearest = np.inf
    for i in range(table.shape[0]):
        square = 0.0
        for c in range(3):
            square += (x[a, c] - table[i, c]) * (x[a, c] - table[i, c])
        nearest = min(nearest, np.sqrt(square))
    total = 0.0
    for c in range(3):
        g[c] = 0.0
        for d in range(3):
            h[c, d] = 0.0
    if not nearest > NEAREST:
        return -parameters[e, MEAN] / parameters[e, LEVEL]
    for i in range(table.shape[0]):
        square = 0.0
        for c in range(3):
            square += (x[a, c] - table[i, c]) * (x[a, c] - table[i, c])
        length = np.sqrt(square)
        part, charge = nearest / length, table[i, 3]
        total += charge * part
        for c in range(3):
            one = (x[a, c] - table[i, c]) / length
            g[c] += charge * part * part * one
            for d in range(3):
                other = (x[a, d] - table[i, d]) / length
                h[c, d] += charge * part * part * part * ((1.0 if c == d else 0.0) - 3.0 * one * other)
    scale = parameters[e, MEAN] / (total * total)
    for c in range(3):
        for d in range(3):
            h[c, d] = scale * (h[c, d] + 2.0 * g[c] * g[d] / total) / nearest
    for c in range(3):
        g[c] *= scale
    return parameters[e, MEAN] * (nearest / total - 1.0 / parameters[e, LEVEL])


def level_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    energy, g, h = 0.0, np.zeros(3), np.zeros((3, 3))
    for e in range(indices.shape[0]):
        k, a, size = parameters[e, STRENGTH], indices[e, 0], 0.0
        off = off_level(parameters, e, x, a, g, h)
        energy += 0.5 * k * off * off
        for c in range(3):
            f[a, c] -= k * off * g[c]
            for d in range(3):
                size += h[c, d] * h[c, d]
        # not the gradient here: it may be steeper where the particle goes
        w[a] += k * (parameters[e, STEEPEST] * parameters[e, STEEPEST] + np.abs(off) * np.sqrt(size))
    return energy


def level_hessian(x, indices, parameters, memory, blocks):  # type: ignore[no-untyped-def]
    g, h = np.zeros(3), np.zeros((3, 3))
    for e in range(indices.shape[0]):
        off = off_level(parameters, e, x, indices[e, 0], g, h)
        for c in range(3):
            for d in range(3):
                blocks[e, c, d] = parameters[e, STRENGTH] * (g[c] * g[d] + off * h[c, d])


class LevelSet(Pull):
    """Particles pulled to the surface on which the potential of point charges is L: E = k d^2 / 2, d = q (1 / phi - 1 /
    L) with phi = sum q_i / r_i.

    r_i are the distances of a particle to the charges, which stay where they are, and q is the mean of these. Of one
    charge the surface is the sphere of radius q / L, and d is the distance from it. Several charges give surfaces that
    merge where these are near each other (Cassini's ovals are alike, of 1 / r^2); round each of some equal charges that
    are far apart, d is the distance, too. Between charges, where phi has no gradient, there is no force. All charges
    are positive. With other units of q the surface stays if L has the same. A particle that is exactly on a charge has
    no direction: nothing pushes it. Source: Blinn, "A generalization of algebraic surface drawing", 1982; classic
    Kangaroo's LevelSet.
    """

    kind: Literal["level_set"] = "level_set"
    mesh: str | None = Field(default=None, description="Name of a mesh whose vertices are pulled")
    charges: Points = Field(description="Places of the charges [length], at least one")
    charge: Positives = Field(default=1.0, description="q_i, one for all charges or one for each [length]")
    level: float = Field(default=1.0, ge=1e-12, le=1e12, description="L, the potential on the surface [-]")
    strength: NonNegatives = Field(default=1000.0, description="k [force/length]")

    formula: ClassVar[str] = "E = k q² (1/φ - 1/L)²/2, φ = Σ q/r"
    shared: ClassVar[tuple[str, ...]] = ("charges", "charge")
    steady: ClassVar[str] = ""
    kernel: ClassVar[Any] = staticmethod(level_kernel)
    hessian: ClassVar[Any] = staticmethod(level_hessian)

    @model_validator(mode="after")
    def _has_charges(self) -> Self:
        count = len(self.charges)
        if not count:
            raise fault("no charges given; give at least one", "/charges")
        if np.ndim(self.charge) and np.size(self.charge) != count:
            raise fault(f"{np.size(self.charge)} values for {count} charges; give one or one for each", "/charge")
        return self

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: k, L, the mean charge, and address and rows of the table of charges."""
        index = places.elements(self)
        charge = np.broadcast_to(self.charge, len(self.charges))
        table = [keep(np.column_stack([self.charges, charge])), float(len(charge))]
        each = np.ones((len(index), 1))
        mean = float(charge.mean())
        # |grad 1/phi| <= 1 / the least charge, as sum q/r^2 <= (sum q/r)^2 / the least q
        steepest = mean / float(charge.min())
        return Block.of(
            index,
            strength=self.strength,
            level=self.level,
            mean=mean,
            steepest=steepest,
            table=each * [table],
        )

    def measure(self, block: Block, x: Floats, element_forces: Floats) -> dict[str, Floats]:
        """d, positive outside the surface [length], and the force on the particle [force]."""
        apart = x[block.indices[:, 0], None] - self.charges
        square = np.einsum("mic,mic->mi", apart, apart)
        with np.errstate(divide="ignore"):
            phi = (np.broadcast_to(self.charge, len(self.charges)) / np.sqrt(square)).sum(axis=1)
        distance = block.parameters[:, MEAN] * (1.0 / phi - 1.0 / block.parameters[:, LEVEL])
        return {"distance": distance, "force": element_forces[:, 0]}

    @classmethod
    def example(cls) -> tuple[LevelSet, Floats]:
        """Three particles about two unequal charges: outside, inside, and at their waist."""
        x = np.array([[2.5, 0.4, -0.3], [0.2, 0.5, 0.3], [0.9, 1.5, 0.4]])
        charges = [[0.0, 0.0, 0.0], [2.0, 0.3, 0.1]]
        return cls(particles=range(3), charges=charges, charge=[1.0, 0.6], level=1.1, strength=[100.0, 20.0, 3.0]), x
