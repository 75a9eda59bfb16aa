"""Area weight: a load in one direction per area of faces: true, plan or that of the start."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np

from hookean.compiled.marks import device
from hookean.forces.base import Block, Floats, OnFilm, Places, units
from hookean.forces.face_loads import FaceLoad, dome, fill, share, sides
from hookean.values.columns import Direction
from hookean.values.fields import Field

Per = Literal["true", "plan", "start"]

WEIGHT, PART, DOWN, PER, AREA = 0, 1, 2, 5, 6  # columns of the parameters
TRUE, PLAN, START = 0.0, 1.0, 2.0


@device
def counted(parameters: Any, e: Any, n: Any, double: Any) -> Any:
    """Twice the area that counts, of a triangle with twice the area vector `n`."""
    if parameters[e, PER] == START:
        return parameters[e, AREA]
    if parameters[e, PER] == PLAN:
        along = n[0] * parameters[e, DOWN] + n[1] * parameters[e, DOWN + 1] + n[2] * parameters[e, DOWN + 2]
        return np.abs(along)
    return double


def area_weight_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    energy = 0.0  # that of the present weight in a field of gravity, by which solvers judge steps
    g, n = np.zeros((3, 3)), np.zeros(3)
    for e in range(indices.shape[0]):
        half, double = 0.5 * parameters[e, WEIGHT] * parameters[e, PART], sides(x, indices, e, g, n)
        area = counted(parameters, e, n, double)
        for c in range(3):
            n[c] = half * area * parameters[e, DOWN + c]
            energy -= n[c] * (x[indices[e, 0], c] + x[indices[e, 1], c] + x[indices[e, 2], c]) / 3.0
        share(indices, e, n, np.abs(half) if parameters[e, PER] != START else 0.0, g, f, w)
    return energy


def area_weight_hessian(x, indices, parameters, memory, blocks):  # type: ignore[no-untyped-def]
    # F = q |N| g / 2, so dF/dN = q g n^T / 2; of the plan F = q |N . g| g / 2
    g, n, slope = np.zeros((3, 3)), np.zeros(3), np.zeros((3, 3))
    for e in range(indices.shape[0]):
        half, double = 0.5 * parameters[e, WEIGHT] * parameters[e, PART], sides(x, indices, e, g, n)
        along = n[0] * parameters[e, DOWN] + n[1] * parameters[e, DOWN + 1] + n[2] * parameters[e, DOWN + 2]
        for k in range(3):
            rate = n[k] / double if double > 0.0 else 0.0
            if parameters[e, PER] == PLAN:
                rate = np.sign(along) * parameters[e, DOWN + k]
            elif parameters[e, PER] == START:
                rate = 0.0
            for c in range(3):
                slope[c, k] = half * parameters[e, DOWN + c] * rate
        fill(blocks, e, slope, g)


class AreaWeight(FaceLoad):
    """A load q per area of the faces of a mesh, in one direction: f = q A g / 3 on each corner.

    g is the direction of the load, gravity unless given. A is the true area of a face as it is now: the load grows with
    the faces, as that of a form-found shell of constant thickness, of whose final area nothing is known yet. Per plan A
    is the area of the shadow of the face along g, as codes give snow; faces that lie above one another each carry it.
    Per start A stays that of the start, as the weight of a membrane that stretches. For a load along the normals use
    `pressure`. A quad is the mean of its two cuts into triangles.

    Per true and plan area these forces have no energy: moving a face up large and down small gains work; what is
    reported is -F . x of the present load F. Newton steps use the symmetric part of their stiffness.
    """

    kind: Literal["area_weight"] = "area_weight"
    mesh: str = Field(description="Name of the mesh that has the weight")
    per: Per = Field(default="true", description="Area that counts: as it is, its plan along g, or that of the start")
    weight: float = Field(default=1.0, ge=-1e12, le=1e12, description="q [force/length^2]")
    direction: Direction = Field(
        default=np.array([0.0, 0.0, -1.0]), description="g, direction of gravity; its length is ignored"
    )

    formula: ClassVar[str] = "f = q A g/3"
    directed: ClassVar[bool] = True
    on_film: ClassVar[OnFilm] = "spread"
    kernel: ClassVar[Any] = staticmethod(area_weight_kernel)
    hessian: ClassVar[Any] = staticmethod(area_weight_hessian)

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: q, share, the unit vector along g, which area counts, twice that of the start."""
        corners, part = self.triangles(places, self.mesh)
        down = np.tile(units(self.direction), (len(corners), 1))
        a, b, c = (places.x[corners[:, i]] for i in range(3))
        area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
        per = {"true": TRUE, "plan": PLAN, "start": START}[self.per]
        return Block.of(corners, weight=self.weight, share=part, direction=down, per=per, area=area)

    @classmethod
    def example(cls) -> tuple[AreaWeight, Floats]:
        """An irregular dome of quads and triangles (`example_faces`)."""
        return cls(mesh="skin", weight=3.0, direction=[0.3, 0.0, -2.0]), dome()
