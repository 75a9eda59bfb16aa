"""Projected force: forces between two particles with a given component along a vector."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np

from hookean.compiled.marks import device
from hookean.forces.base import Block, Floats, Places, units
from hookean.forces.line_lengths import LineForce, apart, line, pull
from hookean.values.columns import Directions, Lines, Reals
from hookean.values.fields import Field, Maybe

STEEPEST = 1e-6  # cosine below which a line has no force: that would be more than 1e6 times its component


@device
def density_of(parameters: Any, e: Any, length: Any, dx: Any, dy: Any, dz: Any) -> Any:
    """Force by length of one line, and its length along the vector; 0 where it is across that."""
    along = dx * parameters[e, 1] + dy * parameters[e, 2] + dz * parameters[e, 3]
    return (parameters[e, 0] / np.abs(along) if np.abs(along) > STEEPEST * length else 0.0), along


def projected_force_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    for e in range(indices.shape[0]):
        length, dx, dy, dz = line(x, indices, e)
        density, along = density_of(parameters, e, length, dx, dy, dz)
        if density != 0.0:
            pull(indices, e, density, dx, dy, dz, f)
            bound = 2.0 * np.abs(density) * (length / np.abs(along))
            w[indices[e, 0]] += bound
            w[indices[e, 1]] += bound
    return 0.0


def projected_force_hessian(x, indices, parameters, memory, blocks):  # type: ignore[no-untyped-def]
    # density x (1 - d v / (d . v)), d along the line and v the vector; the symmetric part
    d = np.zeros(3)
    for e in range(indices.shape[0]):
        length, d[0], d[1], d[2] = line(x, indices, e)
        density, along = density_of(parameters, e, length, d[0], d[1], d[2])
        for i in range(3):
            for j in range(3):
                entry = density if i == j else 0.0
                if density != 0.0:
                    one = d[i] / along * parameters[e, 1 + j]
                    other = d[j] / along * parameters[e, 1 + i]
                    entry -= 0.5 * density * (one + other)
                apart(blocks, e, i, j, entry)


class ProjectedForce(LineForce):
    """Tensions between pairs of particles whose component along a vector stays the same: F = H d / |d . v|.

    d is the vector from one to the other, v of length 1 along the given vector, and H the component. With a horizontal
    vector, this is a funicular of prescribed horizontal thrust: under loads P its slopes change by P / H at each
    particle, as in graphic statics. Hold the particles along the vector (anchors with `axes`), as the component there
    does not depend on where they are. The force has no energy: the tangent is not symmetric, and Newton steps use its
    symmetric part. A line at a right angle to the vector (cosine below 1e-6) has no force. Source: classic Kangaroo's
    ProjectedForce.
    """

    kind: Literal["projected_force"] = "projected_force"
    lines: Maybe[Lines] = Field(default=None, description="Straight lines; their ends must meet particles")
    component: Reals = Field(default=1.0, description="H [force], tension +, along the vector")
    direction: Directions = Field(
        default=np.array([1.0, 0.0, 0.0]), description="The vector; its length and sign are ignored"
    )

    formula: ClassVar[str] = "F = H d/(d·v)"
    conservative: ClassVar[bool] = False
    oriented: ClassVar[bool] = True
    creates: ClassVar[bool] = False
    solid: ClassVar[bool] = False
    example_beside: ClassVar[dict[str, Any]] = {
        "forces": [{"kind": "anchor_spring", "particles": [0, 1, 2, 3], "strength": 100.0}]
    }
    kernel: ClassVar[Any] = staticmethod(projected_force_kernel)
    hessian: ClassVar[Any] = staticmethod(projected_force_hessian)

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: H, the unit vector."""
        index = places.elements(self)
        along = units(self.direction)
        return Block.of(index, component=self.component, direction=along)

    @classmethod
    def example(cls) -> tuple[ProjectedForce, Floats]:
        """Three lines on four particles, one of them in compression."""
        x = np.array([[0.0, 0.1, 0.0], [1.0, 0.0, 0.2], [0.3, 1.1, -0.1], [0.2, 0.4, 0.9]])
        lines = cls(
            particles=[[0, 1], [1, 2], [2, 3]], component=[10.0, 2.0, -3.0], direction=[[2, 0, 0], [0, 1, 0], [0, 0, 1]]
        )
        return lines, x
