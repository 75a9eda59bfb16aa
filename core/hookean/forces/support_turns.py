"""The part of `support` that acts on rotations."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np

from hookean.compiled.marks import device
from hookean.forces.base import Block, Floats, Rider
from hookean.forces.rotations import mapped, orientation

NONE = "particle {} has a rotation_stiffness but no rotation: no beam ends there. Support rotations of beams only"


@device
def turned(p: Any, length: Any, k: Any, row: Any, q: Any, s: Any, g: Any) -> Any:
    """Gradient (3) to a slot, row 1 of `p`, of the energy that holds the rotation vector phi of the orientation at 0;
    returns that energy. With phi' = T(phi)^-1 omega the moment is T(phi)^-T K phi."""
    orientation(p, 1, 2, length, q, s)
    sign = 1.0 if q[0].real >= 0.0 else -1.0
    w, a, b, c = sign * q[0], sign * q[1], sign * q[2], sign * q[3]
    t = (a * a + b * b + c * c) / (w * w + 1e-300)
    if t.real < 0.02:
        h = 0.0 * t
        for i in range(9, -1, -1):  # atan(sqrt t) / sqrt t
            h = h * t + (1.0 - 2.0 * (i % 2)) / (2 * i + 1)
    else:
        root = np.sqrt(t)
        h = np.arctan(root) / root
    part = 2.0 * h / (w + 1e-150)
    a, b, c = part * a, part * b, part * c
    x, y, z = k[row, 1] * a, k[row, 2] * b, k[row, 3] * c
    energy = 0.5 * (x * a + y * b + z * c)
    square = a * a + b * b + c * c
    if square.real < 0.1:
        two = 1.0 / 1209600.0 + square / 47900160.0
        two = 1.0 / 12.0 + square * (1.0 / 720.0 + square * (1.0 / 30240.0 + square * two))
    else:
        half = 0.5 * np.sqrt(square)
        two = (1.0 - half * np.cos(half) / np.sin(half)) / square
    u, v, n = b * z - c * y, c * x - a * z, a * y - b * x
    x, y, z = (
        x + 0.5 * u + two * (b * n - c * v),
        y + 0.5 * v + two * (c * u - a * n),
        z + 0.5 * n + two * (a * v - b * u),
    )
    x, y, z = mapped(p, 1, length, -1.0, x, y, z)
    g[0], g[1], g[2] = x / length, y / length, z / length
    return energy


def support_turn_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    energy = 0.0
    p, room = np.zeros((3, 3)), np.zeros(11)
    q, s, g = room[:4], room[4:8], room[8:]
    for e in range(indices.shape[0]):
        for j in range(3):
            i = np.uint64(indices[e, j])
            p[j, 0], p[j, 1], p[j, 2] = x[i, 0], x[i, 1], x[i, 2]
        length = parameters[e, 0]
        energy += turned(p, length, parameters, e, q, s, g)
        i = np.uint64(indices[e, 1])
        f[i, 0] -= g[0]
        f[i, 1] -= g[1]
        f[i, 2] -= g[2]
        size = np.sqrt(q[1] * q[1] + q[2] * q[2] + q[3] * q[3])
        most = max(parameters[e, 1], parameters[e, 2], parameters[e, 3])
        w[i] += most * (1.0 + 2.0 * size) / (length * length)
    return energy


def support_turn_hessian(x, indices, parameters, memory, blocks):  # type: ignore[no-untyped-def]
    step = 1e-40
    p, room = np.zeros((3, 3), np.complex128), np.zeros(11, np.complex128)
    q, s, g = room[:4], room[4:8], room[8:]
    for e in range(indices.shape[0]):
        for j in range(3):
            i = np.uint64(indices[e, j])
            p[j, 0], p[j, 1], p[j, 2] = x[i, 0], x[i, 1], x[i, 2]
        for k in range(3):
            p[1, k] += step * 1j
            turned(p, parameters[e, 0], parameters, e, q, s, g)
            for j in range(3):
                blocks[e, 3 + j, 3 + k] = g[j].imag / step
            p[1, k] = p[1, k].real
        for k in range(3, 6):
            for j in range(3, k):
                mean = 0.5 * (blocks[e, j, k] + blocks[e, k, j])
                blocks[e, j, k], blocks[e, k, j] = mean, mean


class SupportTurns(Rider):
    """Springs that hold the rotation vector phi of an orientation at 0: E = sum k phi^2 / 2 about x, y and z."""

    kind_name: ClassVar[str] = "support"
    role: ClassVar[Literal["internal", "load", "support"]] = "support"
    bearing: ClassVar[bool] = True
    kernel: ClassVar[Any] = staticmethod(support_turn_kernel)
    hessian: ClassVar[Any] = staticmethod(support_turn_hessian)

    @classmethod
    def of(cls, force: Any, block: Block) -> Block:
        """The rotations of a `support`."""
        return Block.of(block.indices, arm=1.0, rotation_stiffness=block.parameters[:, 6:9])

    @classmethod
    def missing(cls, force: Any, block: Block) -> str:
        """Stiffness needs a rotation."""
        stiff = block.parameters[:, 6:9].any(axis=1)
        return NONE.format(block.indices[np.argmax(stiff), 0]) if stiff.any() else ""

    @classmethod
    def measured(cls, block: Block, x: Floats, element_forces: Floats) -> dict[str, Floats]:
        """The moment on each particle."""
        return {"moment": element_forces[:, 1] * block.parameters[:, :1]}
