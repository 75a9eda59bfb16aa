"""Align faces: faces of two bodies that come into one plane, face to face."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np

from hookean.compiled.marks import device
from hookean.forces.base import Block, Floats, Force, Places, lengths
from hookean.values.columns import IndexRows, NonNegatives, PointRows
from hookean.values.fields import Field, Maybe

TINY = 1e-280  # square of an area below which a face has no normal


@device
def facing(x: Any, indices: Any, e: Any, first: Any, n: Any) -> Any:
    """The unit normal of a face, and twice its area; zero where it has none."""
    a, b, c = indices[e, first], indices[e, first + 1], indices[e, first + 2]
    square = 0.0
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        n[i] = (x[b, j] - x[a, j]) * (x[c, k] - x[a, k]) - (x[b, k] - x[a, k]) * (x[c, j] - x[a, j])
        square += n[i] * n[i]
    size = np.sqrt(square) if square > TINY else 0.0
    for i in range(3):
        n[i] = n[i] / size if size > 0.0 else 0.0
    return size


@device
def push_normal(x: Any, indices: Any, e: Any, first: Any, n: Any, size: Any, slope: Any, f: Any) -> None:
    """Add the force on the corners of a face of an energy with this slope by its normal."""
    along = slope[0] * n[0] + slope[1] * n[1] + slope[2] * n[2]
    for corner in range(3):
        b, c = indices[e, first + (corner + 1) % 3], indices[e, first + (corner + 2) % 3]
        for i in range(3):
            j, k = (i + 1) % 3, (i + 2) % 3
            q_j, q_k = (slope[j] - along * n[j]) / size, (slope[k] - along * n[k]) / size
            f[indices[e, first + corner], i] -= (x[b, j] - x[c, j]) * q_k - (x[b, k] - x[c, k]) * q_j


@device
def weigh(x: Any, indices: Any, e: Any, first: Any, size: Any, by: Any) -> None:
    """By how much the normal turns as a corner of the face moves [1/length]: 1 by its height in the triangle."""
    for corner in range(3):
        b, c, square = indices[e, first + (corner + 1) % 3], indices[e, first + (corner + 2) % 3], 0.0
        for i in range(3):
            square += (x[b, i] - x[c, i]) * (x[b, i] - x[c, i])
        by[corner] = np.sqrt(square) / size


def align_faces_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    energy, room = 0.0, np.zeros((5, 3))
    gap, slope, by = room[2], room[3], room[4]
    for e in range(indices.shape[0]):
        strength, moment, sign = parameters[e, 0], parameters[e, 1], parameters[e, 2]
        sizes = facing(x, indices, e, 0, room[0]), facing(x, indices, e, 3, room[1])
        if sizes[0] == 0.0 or sizes[1] == 0.0:
            continue
        cosine, far = 0.0, 0.0
        for c in range(3):
            cosine += room[0, c] * room[1, c]
            gap[c] = 0.0
            for corner in range(3):
                gap[c] += (x[indices[e, 3 + corner], c] - x[indices[e, corner], c]) / 3.0
            far += gap[c] * gap[c]
        far = np.sqrt(far)
        energy += moment * max(1.0 - sign * cosine, 0.0)
        for face in range(2):
            n, other, height = room[face], room[1 - face], gap[0] * room[face, 0] + gap[1] * room[face, 1]
            height += gap[2] * n[2]
            energy += 0.25 * strength * height * height
            for c in range(3):
                slope[c] = 0.5 * strength * height * gap[c] - sign * moment * other[c]
                for corner in range(3):
                    f[indices[e, corner], c] += 0.5 * strength * height * n[c] / 3.0
                    f[indices[e, 3 + corner], c] -= 0.5 * strength * height * n[c] / 3.0
            push_normal(x, indices, e, 3 * face, n, sizes[face], slope, f)
            weigh(x, indices, e, 3 * face, sizes[face], by)
            turn = by[0] + by[1] + by[2]
            for corner in range(3):
                # a product of slopes for each pair of corners, and what is bent: of the height and of the normals
                own = 0.5 * strength * (1.0 / 3.0 + far * by[corner]) * (2.0 + far * turn)
                bent = 4.0 * (0.5 * strength * abs(height) * (1.0 + far * turn) + moment * turn) * by[corner]
                w[indices[e, 3 * face + corner]] += own + bent
                w[indices[e, 3 * (1 - face) + corner]] += 0.5 * strength / 3.0 * (2.0 + far * turn)
                w[indices[e, 3 * (1 - face) + corner]] += 2.0 * strength * abs(height) * turn / 3.0
    return energy


class AlignFaces(Force):
    """Pairs of faces that come into one plane, with opposite normals: E = k (d1^2 + d2^2) / 4 + M (1 + n1 . n2).

    A face is three particles, its normal n by the right-hand rule; what they are the corners of is another force's
    matter, such as `rigid_body`. d1 and d2 are the distances of the middle of each face from the plane of the other.
    With `flip` normals become the same, 1 - n1 . n2. Faces may slide and turn in their common plane. Pulled apart by a
    force F they have a distance of F / k; a moment M1 that bends one away turns it by M1 / M.
    """

    kind: Literal["align_faces"] = "align_faces"
    particles: Maybe[IndexRows] = Field(default=None, description="Three corners of one face, three of the other")
    points: Maybe[PointRows] = Field(default=None, description="Coordinates of these six")
    strength: NonNegatives = Field(default=1000.0, description="k [force/length]")
    moment: NonNegatives = Field(default=1000.0, description="M [force length]")
    flip: bool = Field(default=False, description="Whether the normals become the same, not opposite")

    formula: ClassVar[str] = "E = k (d₁² + d₂²)/4 + M (1 + n₁·n₂)"
    arity: ClassVar[int] = 6
    creates: ClassVar[bool] = False
    solid: ClassVar[bool] = False
    outputs: ClassVar[dict[str, str]] = {"distance": "length", "angle": "angle", "force": "force"}
    kernel: ClassVar[Any] = staticmethod(align_faces_kernel)

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: k, M, and 1 or -1 for normals that become the same or opposite."""
        sign = 1.0 if self.flip else -1.0
        return Block.of(places.elements(self), strength=self.strength, moment=self.moment, flip=sign)

    def measure(self, block: Block, x: Floats, element_forces: Floats) -> dict[str, Floats]:
        """The larger distance of a middle from the plane of the other face [length], the angle between the planes
        [radian] and the force on the first face [force]."""
        corners = x[block.indices].reshape(-1, 2, 3, 3)
        normal = np.cross(corners[:, :, 1] - corners[:, :, 0], corners[:, :, 2] - corners[:, :, 0])
        size = np.sqrt((normal**2).sum(axis=2, keepdims=True))
        normal /= np.where(size > 0.0, size, 1.0)
        gap = corners[:, 1].mean(axis=1) - corners[:, 0].mean(axis=1)
        far = np.abs(np.einsum("mfc,mc->mf", normal, gap)).max(axis=1)
        other = block.parameters[:, 2, None] * normal[:, 1]
        angle = np.arctan2(lengths(np.cross(normal[:, 0], other)), (normal[:, 0] * other).sum(axis=1))
        return {"distance": far, "angle": angle, "force": element_forces[:, :3].sum(axis=1)}

    @classmethod
    def example(cls) -> tuple[AlignFaces, Floats]:
        """Two pairs of faces, apart and askew."""
        x = [[0, 0, 0], [3, 0.2, 0.1], [0.4, 2.9, -0.2], [0.4, 0.1, 0.9], [0.7, 3.2, 0.6], [3.1, 0.5, 0.5]]
        x += [[6, 1, 2], [8, 3, 2.2], [5.5, 4, 3], [6.5, 0.2, 3.1], [8.4, 2.0, 3.9], [6, 4.4, 3.2]]
        return cls(particles=np.arange(12).reshape(2, 6), strength=[50.0, 8.0], moment=[20.0, 30.0]), np.array(x)
