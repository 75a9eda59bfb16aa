"""Anchor springs: soft anchors that pull particles to targets."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np

from hookean.compiled.marks import device
from hookean.forces.base import Block, Floats, Force, Places
from hookean.values.columns import IndexRows, NonNegatives, Points
from hookean.values.fields import Field, Maybe

LIMIT, STICKY = 4, 5  # columns of the parameters


def anchor_spring_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    energy = 0.0
    for e in range(indices.shape[0]):
        a = indices[e, 0]
        strength = parameters[e, 0]
        w[a] += strength
        if parameters[e, LIMIT] == 0.0 and parameters[e, STICKY] == 0.0:
            for c in range(3):
                d = parameters[e, 1 + c] - x[a, c]
                f[a, c] += strength * d
                energy += 0.5 * strength * d * d
            continue
        apart, most = stretched(x, indices, parameters, memory, e)
        held = strength if apart <= most else strength * most / apart
        energy += 0.5 * strength * apart * apart if apart <= most else strength * most * (apart - 0.5 * most)
        for c in range(3):
            f[a, c] += held * (parameters[e, 1 + c] + memory[e, c] - x[a, c])
    return energy


@device
def stretched(x: Any, indices: Any, parameters: Any, memory: Any, e: Any) -> Any:
    """Distance of a particle from where its target has gone to, and that at which the target follows."""
    square, most, strength = 0.0, np.inf, parameters[e, 0]
    for c in range(3):
        square += (parameters[e, 1 + c] + memory[e, c] - x[indices[e, 0], c]) ** 2
    if parameters[e, LIMIT] > 0.0:
        most = parameters[e, LIMIT]
    if parameters[e, STICKY] > 0.0 and parameters[e, STICKY] < strength * most:
        most = parameters[e, STICKY] / strength
    return np.sqrt(square), most


def anchor_spring_hessian(x, indices, parameters, memory, blocks):  # type: ignore[no-untyped-def]
    for e in range(indices.shape[0]):
        apart, most = stretched(x, indices, parameters, memory, e)
        strength = parameters[e, 0]
        across, more = (strength, 0.0) if apart <= most else (strength * most / apart, -strength * most / apart)
        size = apart if apart > most else 1.0
        for i in range(3):
            for j in range(3):
                di = parameters[e, 1 + i] + memory[e, i] - x[indices[e, 0], i]
                dj = parameters[e, 1 + j] + memory[e, j] - x[indices[e, 0], j]
                blocks[e, i, j] = more * (di / size * (dj / size)) + (across if i == j else 0.0)


def anchor_spring_slide(x, indices, parameters, memory):  # type: ignore[no-untyped-def]
    for e in range(indices.shape[0]):
        if parameters[e, LIMIT] == 0.0 and parameters[e, STICKY] == 0.0:
            continue
        apart, most = stretched(x, indices, parameters, memory, e)
        if apart > most:
            for c in range(3):
                d = parameters[e, 1 + c] + memory[e, c] - x[indices[e, 0], c]
                memory[e, c] -= d * (1.0 - most / apart)


def slides(block: Block) -> bool:
    """Whether any of these springs may slide: then they are neither linear nor as stiff everywhere."""
    return bool(block.parameters[:, LIMIT:].any())


class AnchorSpring(Force):
    """A soft anchor: a spring of rest length 0 to a target, f = S (T - x), E = S |T - x|^2 / 2.

    The particle moves by load / S; an anchor that must not move is one of the scene's `anchors`. The default
    strength is that of Kangaroo 2's Anchor. With a limit, or a sticky force, the anchor slides: beyond this distance,
    or this force, the force stays the same, S x limit, and at the end of the step the target follows the particle up
    to that distance. The smaller of both counts.
    """

    kind: Literal["anchor_spring"] = "anchor_spring"
    particles: Maybe[IndexRows] = Field(default=None, description="Anchored particles")
    points: Maybe[Points] = Field(default=None, description="Coordinates of anchored particles")
    targets: Maybe[Points] = Field(default=None, description="T [length], one for each; default: the start positions")
    strength: NonNegatives = Field(default=10000.0, description="S [force/length]")
    limit: NonNegatives = Field(default=0.0, description="Distance from which on the target follows [length]; 0: none")
    sticky: NonNegatives = Field(default=0.0, description="Force from which on the target follows [force]; 0: none")

    formula: ClassVar[str] = "E = S |T - x|²/2"
    role: ClassVar[Literal["internal", "load", "support"]] = "support"
    creates: ClassVar[bool] = False
    steady: ClassVar[str] = "strength"
    remembers: ClassVar[bool] = True
    yielding: ClassVar[tuple[str, ...]] = ("limit", "sticky")
    outputs: ClassVar[dict[str, str]] = {"force": "force"}
    kernel: ClassVar[Any] = staticmethod(anchor_spring_kernel)
    hessian: ClassVar[Any] = staticmethod(anchor_spring_hessian)
    end_of_step: ClassVar[Any] = staticmethod(anchor_spring_slide)

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: strength, target, limit and sticky force."""
        index = places.elements(self)
        start = places.x[np.maximum(index[:, 0], 0)]
        return Block.of(
            index,
            memory=3,
            strength=self.strength,
            targets=start if self.targets is None else self.targets,
            limit=self.limit,
            sticky=self.sticky,
        )

    @classmethod
    def example(cls) -> tuple[AnchorSpring, Floats]:
        """Four soft anchors away from their targets: two that never slide, one that does and one that is about to."""
        x = np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [2.0, 1.0, 0.0], [3.0, 1.0, 1.0]])
        return cls(
            particles=[0, 1, 2, 3],
            targets=[[0.1, 0, 0], [0, 1.2, 0.3], [2.0, 1.5, 0.4], [3.0, 1.2, 1.0]],
            strength=[1e4, 50.0, 30.0, 20.0],
            limit=[0.0, 0.0, 0.1, 3.0],
            sticky=[0.0, 0.0, 0.0, 14.0],
        ), x
