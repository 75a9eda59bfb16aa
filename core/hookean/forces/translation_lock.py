"""Translation lock: pairs of particles that keep the vector between them."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np

from hookean.forces.base import Block, Floats, Force, Places
from hookean.forces.transform_lock import distance_and_force, holding, image_hessian, image_kernel, images
from hookean.values.columns import IndexRows, Lines, NonNegatives, Vectors
from hookean.values.fields import Field, Maybe


class TranslationLock(Force):
    """Pairs of particles a, b that keep the vector t between them: E = k |b - a - t|^2 / 2.

    By default t is the vector of the start. The pair may move, and may not turn: forces sum to zero, moments do not.
    Pairs with the same vector keep two edges alike, such as those that meet in a periodic pattern.
    """

    kind: Literal["translation_lock"] = "translation_lock"
    particles: Maybe[IndexRows] = Field(default=None, description="Pairs of particles")
    lines: Maybe[Lines] = Field(default=None, description="Lines between the pairs; their ends must meet particles")
    stiffness: NonNegatives = Field(default=1.0, description="k [force/length]")
    translation: Maybe[Vectors] = Field(
        default=None, description="t [length], one or one for each pair; default: the vector of the start"
    )

    formula: ClassVar[str] = "E = k |b - a - t|²/2"
    role: ClassVar[Literal["internal", "load", "support"]] = "support"
    creates: ClassVar[bool] = False
    arity: ClassVar[int] = 2
    steady: ClassVar[str] = "stiffness"
    solid: ClassVar[bool] = False
    outputs: ClassVar[dict[str, str]] = {"distance": "length", "force": "force"}
    kernel: ClassVar[Any] = staticmethod(image_kernel)
    hessian: ClassVar[Any] = staticmethod(image_hessian)

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: those of `transform_lock`, of the translation."""
        index = places.elements(self)
        start = places.x[index[:, 1]] - places.x[index[:, 0]]
        return images(index, self.stiffness, np.eye(3), start if self.translation is None else self.translation)

    def measure(self, block: Block, x: Floats, element_forces: Floats) -> dict[str, Floats]:
        """Distance from where the second particle should be [length] and the force on it [force]."""
        return distance_and_force(block, element_forces)

    @classmethod
    def holds(cls, block: Block) -> Floats:
        """As its forces do in all."""
        return holding(block)

    @classmethod
    def example(cls) -> tuple[TranslationLock, Floats]:
        """Two pairs with a vector each, which they do not have yet."""
        x = np.array([[0.0, 0.1, 0.0], [1.0, 0.0, 0.2], [0.3, 1.1, -0.1], [0.2, 0.4, 0.9]])
        pairs = cls(
            particles=[[0, 1], [2, 3]], stiffness=[100.0, 20.0], translation=[[0.8, 0.1, 0.0], [0.1, -0.5, 0.8]]
        )
        return pairs, x
