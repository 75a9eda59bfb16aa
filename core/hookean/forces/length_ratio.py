"""Length ratio: pairs of lines of which one is a multiple of the other."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np

from hookean.compiled.marks import device
from hookean.forces.base import Block, Floats, Places, lengths
from hookean.forces.line_angles import LinePair
from hookean.values.columns import NonNegatives
from hookean.values.fields import Field


@device
def pair(x: Any, indices: Any, parameters: Any, e: Any, g: Any) -> Any:
    """How much longer line B is than r times line A. Writes unit vectors, zero for zero length, and lengths."""
    for i in range(2):
        a, b = indices[e, 2 * i], indices[e, 2 * i + 1]
        square = 0.0
        for c in range(3):
            g[i, c] = x[b, c] - x[a, c]
            square += g[i, c] * g[i, c]
        g[i, 3] = np.sqrt(square)
        for c in range(3):
            g[i, c] = g[i, c] / g[i, 3] if g[i, 3] > 0.0 else 0.0
    return g[1, 3] - parameters[e, 1] * g[0, 3]


def length_ratio_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    energy = 0.0
    g = np.zeros((2, 4))
    for e in range(indices.shape[0]):
        k, ratio = parameters[e, 0], parameters[e, 1]
        excess = pair(x, indices, parameters, e, g)
        energy += 0.5 * k * excess * excess
        for i in range(2):
            factor = 1.0 if i == 1 else -ratio
            for j in range(2):
                p = indices[e, 2 * i + j]
                w[p] += 2.0 * k * (1.0 + ratio) * np.abs(factor)
                for c in range(3):
                    f[p, c] += (1.0 if j == 0 else -1.0) * k * excess * factor * g[i, c]
    return energy


def length_ratio_hessian(x, indices, parameters, memory, blocks):  # type: ignore[no-untyped-def]
    g = np.zeros((2, 4))
    for e in range(indices.shape[0]):
        k = parameters[e, 0]
        excess = pair(x, indices, parameters, e, g)
        for p in range(4):
            for q in range(4):
                line = p // 2
                sign = 1.0 if p % 2 == q % 2 else -1.0
                factor = 1.0 if line == 1 else -parameters[e, 1]
                both = k * factor * (1.0 if q // 2 == 1 else -parameters[e, 1])
                across = k * excess * factor / g[line, 3] if line == q // 2 and g[line, 3] > 0.0 else 0.0
                for i in range(3):
                    for j in range(3):
                        entry = (both - across) * g[line, i] * g[q // 2, j] + (across if i == j else 0.0)
                        blocks[e, 3 * p + i, 3 * q + j] = sign * entry


class LengthRatio(LinePair):
    """Pairs of lines A, B of which B is r times as long as A: E = k (b - r a)^2 / 2, a and b their lengths.

    The tension k (b - r a) acts in B, and -r times that in A: where B is too long, it shortens and A lengthens. The
    lines need not meet; forces and moments of each pair sum to zero. A line of zero length has no direction and no
    force.
    """

    kind: Literal["length_ratio"] = "length_ratio"
    stiffness: NonNegatives = Field(default=1.0, description="k [force/length]")
    ratio: NonNegatives = Field(default=1.0, description="r [-], length of line B by that of line A")

    formula: ClassVar[str] = "E = k (b - r a)²/2"
    outputs: ClassVar[dict[str, str]] = {"ratio": "", "force": "force"}
    kernel: ClassVar[Any] = staticmethod(length_ratio_kernel)
    hessian: ClassVar[Any] = staticmethod(length_ratio_hessian)

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: k, r."""
        return Block.of(places.elements(self), stiffness=self.stiffness, ratio=self.ratio)

    def measure(self, block: Block, x: Floats, element_forces: Floats) -> dict[str, Floats]:
        """Length of B by that of A [-; 0 where A has none] and the force in B [force; tension +]."""
        a, b = (lengths(x[block.indices[:, i + 1]] - x[block.indices[:, i]]) for i in (0, 2))
        ratio = np.divide(b, a, out=np.zeros_like(a), where=a > 0.0)
        return {"ratio": ratio, "force": block.parameters[:, 0] * (b - block.parameters[:, 1] * a)}

    @classmethod
    def example(cls) -> tuple[LengthRatio, Floats]:
        """Three pairs of lines on five particles: B too long, too short, and one that shares a particle with A."""
        x = np.array([[0.0, 0.0, 0.0], [1.0, 0.1, 0.2], [0.4, 0.9, 0.3], [0.6, -0.8, 0.25], [1.4, 0.8, -0.1]])
        return cls(
            particles=[[0, 1, 2, 3], [1, 4, 3, 2], [0, 2, 2, 4]], stiffness=[20.0, 5.0, 50.0], ratio=[0.7, 3.0, 1.2]
        ), x
