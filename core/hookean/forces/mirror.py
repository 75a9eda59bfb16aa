"""Mirror: pairs of particles that are mirror images of each other in a fixed plane."""

from __future__ import annotations

from typing import ClassVar, Literal

import numpy as np

from hookean.forces.base import Block, Floats, Places, units
from hookean.forces.transform_lock import Imaged, images
from hookean.values.columns import Direction, Vector
from hookean.values.fields import Field


class Mirror(Imaged):
    """Pairs of particles a, b that are pulled to each other's mirror image in a plane: E = k |b - M a|^2 / 2.

    M p = p - 2 n (n . (p - o)) is the image in the plane through o normal to n, which is fixed in space. As M is its
    own inverse, both particles have forces of the same size: the force on a is the image of that on b.
    """

    kind: Literal["mirror"] = "mirror"
    point: Vector = Field(default=np.zeros(3), description="o, a point of the plane [length]")
    normal: Direction = Field(
        default=np.array([1.0, 0.0, 0.0]), description="n, normal to the plane; its length is ignored"
    )

    formula: ClassVar[str] = "E = k |b - M a|²/2"
    shared: ClassVar[tuple[str, ...]] = ("point", "normal")

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: those of `transform_lock`, of the mirror image."""
        n = units(self.normal)[0]
        linear = np.eye(3) - 2.0 * np.outer(n, n)
        return images(places.elements(self), self.stiffness, linear, 2.0 * (n @ self.point) * n)

    @classmethod
    def example(cls) -> tuple[Mirror, Floats]:
        """Two pairs of particles about an inclined plane."""
        x = np.array([[0.0, 0.1, 0.0], [1.0, 0.0, 0.2], [0.3, 1.1, -0.1], [0.2, 0.4, 0.9]])
        pairs = cls(particles=[[0, 1], [2, 3]], stiffness=[100.0, 20.0], point=[0.4, 0.1, 0.0], normal=[2.0, 0.3, -0.1])
        return pairs, x
