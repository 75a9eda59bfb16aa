"""Area weight: a weight per area of faces as large as they are now."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np

from hookean.forces.base import Block, Floats, OnFilm, Places, units
from hookean.forces.face_loads import FaceLoad, dome, fill, share, sides
from hookean.values.columns import Direction
from hookean.values.fields import Field

WEIGHT, PART, DOWN = 0, 1, 2  # columns of the parameters


def area_weight_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    g, n = np.zeros((3, 3)), np.zeros(3)
    for e in range(indices.shape[0]):
        half, double = 0.5 * parameters[e, WEIGHT] * parameters[e, PART], sides(x, indices, e, g, n)
        for c in range(3):
            n[c] = half * double * parameters[e, DOWN + c]
        share(indices, e, n, np.abs(half), g, f, w)
    return 0.0


def area_weight_hessian(x, indices, parameters, memory, blocks):  # type: ignore[no-untyped-def]
    # F = q |N| g / 2, so dF/dN = q g n^T / 2
    g, n, slope = np.zeros((3, 3)), np.zeros(3), np.zeros((3, 3))
    for e in range(indices.shape[0]):
        half, double = 0.5 * parameters[e, WEIGHT] * parameters[e, PART], sides(x, indices, e, g, n)
        for c in range(3):
            for k in range(3):
                slope[c, k] = half * parameters[e, DOWN + c] * (n[k] / double if double > 0.0 else 0.0)
        fill(blocks, e, slope, g)


class AreaWeight(FaceLoad):
    """A weight q per area of the faces of a mesh as large as they are now: f = q A g / 3 on each corner.

    g is the direction of gravity. The load grows with the faces, as that of a form-found shell of constant thickness,
    of whose final area nothing is known yet, or of snow. A quad is the mean of its two cuts into triangles. The weight
    of a membrane that stretches is conserved by `self_weight`, with a total. These forces have no energy: moving a face
    up large and down small gains work. Newton steps use the symmetric part of their stiffness.
    """

    kind: Literal["area_weight"] = "area_weight"
    mesh: str = Field(description="Name of the mesh that has the weight")
    weight: float = Field(default=1.0, ge=-1e12, le=1e12, description="q [force/length^2]")
    direction: Direction = Field(
        default=np.array([0.0, 0.0, -1.0]), description="g, direction of gravity; its length is ignored"
    )

    formula: ClassVar[str] = "f = q A g/3"
    on_film: ClassVar[OnFilm] = "spread"
    kernel: ClassVar[Any] = staticmethod(area_weight_kernel)
    hessian: ClassVar[Any] = staticmethod(area_weight_hessian)

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: q, share, the unit vector along g."""
        corners, part = self.triangles(places, self.mesh)
        down = np.tile(units(self.direction), (len(corners), 1))
        return Block.of(corners, weight=self.weight, share=part, direction=down)

    @classmethod
    def example(cls) -> tuple[AreaWeight, Floats]:
        """An irregular dome of quads and triangles (`example_faces`)."""
        return cls(mesh="skin", weight=3.0, direction=[0.3, 0.0, -2.0]), dome()
