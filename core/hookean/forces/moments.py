"""Moments: the part of `unary` loads that turns particles with orientations."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np

from hookean.forces.base import Block, Floats, Rider
from hookean.forces.rotations import mapped

NONE = "particle {} has a moment but no rotation: no beam ends there. Give moments to particles of beams"


def moment_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    energy = 0.0
    for e in range(indices.shape[0]):
        i, length = indices[e, 1], parameters[e, 0]
        a, b, c = parameters[e, 1], parameters[e, 2], parameters[e, 3]
        energy -= (a * x[i, 0] + b * x[i, 1] + c * x[i, 2]) / length
        turned = np.sqrt(x[i, 0] ** 2 + x[i, 1] ** 2 + x[i, 2] ** 2)
        w[i] += np.sqrt(a * a + b * b + c * c) * turned / length**3
        a, b, c = mapped(x, i, length, -1.0, a, b, c)
        f[i, 0] += a / length
        f[i, 1] += b / length
        f[i, 2] += c / length
    return energy


def moment_hessian(x, indices, parameters, memory, blocks):  # type: ignore[no-untyped-def]
    step, p, found = 1e-40, np.zeros((1, 3), np.complex128), np.zeros((3, 3))
    for e in range(indices.shape[0]):
        length = parameters[e, 0]
        for k in range(3):
            for c in range(3):
                p[0, c] = x[indices[e, 1], c]
            p[0, k] += step * 1j
            a, b, c = mapped(p, 0, length, -1.0, parameters[e, 1], parameters[e, 2], parameters[e, 3])
            found[0, k], found[1, k], found[2, k] = a.imag, b.imag, c.imag
        for k in range(3):
            for j in range(3):
                blocks[e, 3 + j, 3 + k] = -0.5 * (found[j, k] + found[k, j]) / (step * length)


def moment_skew(block: Block) -> Floats:
    """-M x / 2 between the turns of a slot, divided by the square of its length: f = (M + M x theta / 2) / l near 0."""
    count, arity = block.indices.shape
    found = np.zeros((count, 3 * arity, 3 * arity))
    found[:, 3:6, 3:6] = np.cross(block.parameters[:, None, 1:4], np.eye(3))
    found /= 2.0 * block.parameters[:, :1, None] ** 2
    return found


class Moments(Rider):
    """Moments M that keep their direction in space. Such a load has no energy: the work it does depends on the path.

    The kernel returns -M . theta, what it has done since the last reference but for terms of second order. The
    symmetric part of its tangent is zero there, and the other part, M x / 2, has a place of its own: `skew`.
    """

    kind_name: ClassVar[str] = "unary"
    role: ClassVar[Literal["internal", "load", "support"]] = "load"
    conservative: ClassVar[bool] = False
    zero: ClassVar[tuple[str, ...]] = ("moment",)
    kernel: ClassVar[Any] = staticmethod(moment_kernel)
    hessian: ClassVar[Any] = staticmethod(moment_hessian)
    skew: ClassVar[Any] = staticmethod(lambda block, memory, x: [(block.indices, moment_skew(block))])

    @classmethod
    def of(cls, force: Any, block: Block) -> Block:
        """The moments of a `unary`."""
        return Block.of(block.indices, arm=1.0, moment=block.parameters[:, 3:6])

    @classmethod
    def missing(cls, force: Any, block: Block) -> str:
        """A moment needs a rotation."""
        if not np.count_nonzero(force.moment) or not block.parameters[:, 3:6].any():
            return ""
        return NONE.format(block.indices[np.argmax(block.parameters[:, 3:6].any(axis=1)), 0])

    @classmethod
    def measured(cls, block: Block, x: Floats, element_forces: Floats) -> dict[str, Floats]:
        """Nothing: the load itself has its moments."""
        return {}
