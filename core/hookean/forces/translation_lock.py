"""Translation lock: pairs of particles that keep the vector between them."""

from __future__ import annotations

from typing import ClassVar, Literal

import numpy as np

from hookean.forces.base import Block, Floats, Places
from hookean.forces.transform_lock import Imaged, images
from hookean.values.columns import Vectors
from hookean.values.fields import Field, Maybe


class TranslationLock(Imaged):
    """Pairs of particles a, b that keep the vector t between them: E = k |b - a - t|^2 / 2.

    By default t is the vector of the start. The pair may move, and may not turn: forces sum to zero, moments do not.
    Pairs with the same vector keep two edges alike, such as those that meet in a periodic pattern.
    """

    kind: Literal["translation_lock"] = "translation_lock"
    translation: Maybe[Vectors] = Field(
        default=None, description="t [length], one or one for each pair; default: the vector of the start"
    )

    formula: ClassVar[str] = "E = k |b - a - t|²/2"
    steady: ClassVar[str] = "stiffness"

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: those of `transform_lock`, of the translation."""
        index = places.elements(self)
        start = places.x[index[:, 1]] - places.x[index[:, 0]]
        return images(index, self.stiffness, np.eye(3), start if self.translation is None else self.translation)

    @classmethod
    def example(cls) -> tuple[TranslationLock, Floats]:
        """Two pairs with a vector each, which they do not have yet."""
        x = np.array([[0.0, 0.1, 0.0], [1.0, 0.0, 0.2], [0.3, 1.1, -0.1], [0.2, 0.4, 0.9]])
        pairs = cls(
            particles=[[0, 1], [2, 3]], stiffness=[100.0, 20.0], translation=[[0.8, 0.1, 0.0], [0.1, -0.5, 0.8]]
        )
        return pairs, x
