"""Transform lock: pairs of particles of which one is the other's image in a transformation."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np
from numpy.typing import ArrayLike
from pydantic import field_validator

from hookean.compiled.marks import device
from hookean.forces.base import Block, Floats, Force, Ints, Places, lengths
from hookean.values.columns import IndexRows, Lines, NonNegatives, Table, fault
from hookean.values.fields import Field, Maybe


@device
def missed(x: Any, indices: Any, parameters: Any, e: Any, c: Any) -> Any:
    """Component `c` of the vector from the image of an element's first particle to its second."""
    image = parameters[e, 11 + c]
    for d in range(3):
        image += parameters[e, 2 + 3 * c + d] * x[indices[e, 0], d]
    return x[indices[e, 1], c] - image


def image_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    energy = 0.0
    for e in range(indices.shape[0]):
        a, b, k, scale = indices[e, 0], indices[e, 1], parameters[e, 0], parameters[e, 1]
        w[a] += k * scale * (1.0 + scale)
        w[b] += k * (1.0 + scale)
        for c in range(3):
            off = missed(x, indices, parameters, e, c)
            energy += 0.5 * k * off * off
            f[b, c] -= k * off
            for d in range(3):
                f[a, d] += k * off * parameters[e, 2 + 3 * c + d]
    return energy


def image_hessian(x, indices, parameters, memory, blocks):  # type: ignore[no-untyped-def]
    for e in range(indices.shape[0]):
        k = parameters[e, 0]
        for i in range(3):
            for j in range(3):
                square = 0.0
                for c in range(3):
                    square += parameters[e, 2 + 3 * c + i] * parameters[e, 2 + 3 * c + j]
                blocks[e, i, j] = k * square
                blocks[e, 3 + i, 3 + j] = k if i == j else 0.0
                blocks[e, 3 + i, j] = -k * parameters[e, 2 + 3 * i + j]
                blocks[e, j, 3 + i] = -k * parameters[e, 2 + 3 * i + j]


def images(index: Ints, stiffness: Any, linear: Floats, shift: ArrayLike) -> Block:
    """The block of pairs of particles p1, p2 with p2 = A p1 + t: A (3, 3) `linear`, t (3,) or (m, 3) `shift`."""
    rows = np.broadcast_to(linear.reshape(1, 9), (len(index), 9))
    scale = float(np.linalg.norm(linear, 2))
    return Block.of(index, stiffness=stiffness, scale=scale, linear=rows, shift=np.broadcast_to(shift, (len(index), 3)))


class Imaged(Force):
    """Base of forces that pull the second particle of a pair to an image of the first."""

    kind: str = ""
    particles: Maybe[IndexRows] = Field(default=None, description="Pairs of particles")
    lines: Maybe[Lines] = Field(default=None, description="Lines between the pairs; their ends must meet particles")
    stiffness: NonNegatives = Field(default=1.0, description="k [force/length]")

    role: ClassVar[Literal["internal", "load", "support"]] = "support"
    creates: ClassVar[bool] = False
    arity: ClassVar[int] = 2
    solid: ClassVar[bool] = False
    outputs: ClassVar[dict[str, str]] = {"distance": "length", "force": "force"}
    kernel: ClassVar[Any] = staticmethod(image_kernel)
    hessian: ClassVar[Any] = staticmethod(image_hessian)

    def measure(self, block: Block, x: Floats, element_forces: Floats) -> dict[str, Floats]:
        """Distance of the second particle from the image [length] and the force on it [force]."""
        force, k = element_forces[:, 1], block.parameters[:, 0]
        return {"distance": np.divide(lengths(force), k, out=np.zeros(len(k)), where=k > 0.0), "force": force}


class TransformLock(Imaged):
    """Pairs of particles a, b of which b is pulled to the image of a, and a so that its image meets b.

    Energy k |b - T a|^2 / 2, T an affine transformation: T p = A p + t, given as a matrix of 3 or 4 rows and 4
    columns [A t]. The force on a is k A^T (b - T a): for a motion or a mirror image that is as large as on b, with
    a scale s it is s times that. K2's Transform has half of its strength as k, and is the same for motions.
    """

    kind: Literal["transform_lock"] = "transform_lock"
    particles: Maybe[IndexRows] = Field(default=None, description="Pairs of particles: original and image")
    lines: Maybe[Lines] = Field(default=None, description="Lines from originals to images; their ends meet particles")
    matrix: Table = Field(description="T, 3 or 4 rows of 4 numbers, or these in one row; the last column is a length")

    formula: ClassVar[str] = "E = k |b - T a|²/2"
    shared: ClassVar[tuple[str, ...]] = ("matrix",)

    @field_validator("matrix")
    @classmethod
    def _affine(cls, matrix: Floats) -> Floats:
        if matrix.shape not in ((12,), (16,), (3, 4), (4, 4)):
            raise fault(f"shape {list(matrix.shape)} given; 3 or 4 rows of 4 numbers expected")
        if matrix.size == 16 and not np.array_equal(matrix.ravel()[12:], [0.0, 0.0, 0.0, 1.0]):
            raise fault("the last row must be 0, 0, 0, 1: a projection is not an affine transformation")
        return matrix

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: k, the greatest scale of A, A, t."""
        rows = np.asarray(self.matrix).reshape(-1, 4)[:3]
        return images(places.elements(self), self.stiffness, rows[:, :3], rows[:, 3])

    @classmethod
    def example(cls) -> tuple[TransformLock, Floats]:
        """Two pairs on three particles: turned about an axis, larger and sheared, and moved."""
        x = np.array([[0.0, 0.1, 0.0], [1.0, 0.0, 0.2], [0.3, 1.1, -0.1]])
        matrix = [[0.0, -1.2, 0.1, 0.3], [1.2, 0.0, 0.0, -0.2], [0.0, 0.3, 1.5, 0.1]]
        return cls(particles=[[0, 1], [1, 2]], stiffness=[100.0, 20.0], matrix=matrix), x
