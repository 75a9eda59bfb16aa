"""Anchor springs: soft anchors that pull particles to targets."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np

from hookean.forces.base import Block, Floats, Force, Places
from hookean.values.columns import IndexRows, NonNegatives, Points
from hookean.values.fields import Field, Maybe


def anchor_spring_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    energy = 0.0
    for e in range(indices.shape[0]):
        a = indices[e, 0]
        strength = parameters[e, 0]
        w[a] += strength
        for c in range(3):
            d = parameters[e, 1 + c] - x[a, c]
            f[a, c] += strength * d
            energy += 0.5 * strength * d * d
    return energy


class AnchorSpring(Force):
    """A soft anchor: a spring of rest length 0 to a target, f = S (T - x), E = S |T - x|^2 / 2.

    The particle moves by load / S; an anchor that must not move is one of the scene's `anchors`. The default
    strength is that of Kangaroo 2's Anchor.
    """

    kind: Literal["anchor_spring"] = "anchor_spring"
    particles: Maybe[IndexRows] = Field(default=None, description="Anchored particles")
    points: Maybe[Points] = Field(default=None, description="Coordinates of anchored particles")
    targets: Maybe[Points] = Field(default=None, description="T [length], one for each; default: the start positions")
    strength: NonNegatives = Field(default=10000.0, description="S [force/length]")

    formula: ClassVar[str] = "E = S |T - x|²/2"
    role: ClassVar[Literal["internal", "load", "support"]] = "support"
    creates: ClassVar[bool] = False
    steady: ClassVar[str] = "strength"
    outputs: ClassVar[dict[str, str]] = {"force": "force"}
    kernel: ClassVar[Any] = staticmethod(anchor_spring_kernel)

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: strength and target."""
        index = places.elements(self)
        start = places.x[np.maximum(index[:, 0], 0)]
        return Block.of(index, strength=self.strength, targets=start if self.targets is None else self.targets)

    def measure(self, block: Block, x: Floats, element_forces: Floats) -> dict[str, Floats]:
        """The force of the anchor on its particle [force]."""
        return {"force": element_forces[:, 0]}

    @classmethod
    def example(cls) -> tuple[AnchorSpring, Floats]:
        """Two soft anchors away from their targets."""
        return cls(particles=[0, 1], targets=[[0.1, 0, 0], [0, 1.2, 0.3]], strength=[1e4, 50.0]), np.eye(3)[:2]
