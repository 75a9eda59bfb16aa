"""Supports: elastic bearings that resist displacements and rotations along the axes of space."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np

from hookean.errors import InputError
from hookean.forces.base import Block, Floats, Force, Places, Rider
from hookean.forces.support_turns import SupportTurns
from hookean.values.columns import IndexRows, Points, Vectors
from hookean.values.fields import Field, Maybe


def support_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    energy = 0.0
    for e in range(indices.shape[0]):
        i = np.uint64(indices[e, 0])
        for c in range(3):
            away = x[i, c] - parameters[e, 3 + c]
            force = parameters[e, c] * away
            energy += 0.5 * force * away
            f[i, c] -= force
        w[i] += max(parameters[e, 0], parameters[e, 1], parameters[e, 2])
    return energy


def support_hessian(x, indices, parameters, memory, blocks):  # type: ignore[no-untyped-def]
    for e in range(indices.shape[0]):
        for c in range(3):
            blocks[e, c, c] = parameters[e, c]


class Support(Force):
    """Elastic supports: a force -k d along each axis of space for the displacement d, and moments for rotations.

    E = sum over x, y, z of (k d^2 + kr phi^2) / 2. The displacement is that from the start position, or from a target;
    phi is the rotation vector of the particle's orientation, turned from the start, of at most half a turn (there the
    moment changes its sign). Only particles at the ends of beams have rotations. A support that must not give way is
    one of the scene's `anchors`.
    """

    kind: Literal["support"] = "support"
    particles: Maybe[IndexRows] = Field(default=None, description="Supported particles")
    points: Maybe[Points] = Field(default=None, description="Coordinates of supported particles")
    stiffness: Vectors = Field(default=np.zeros(3), description="k along x, y, z [force/length]; 0: free")
    rotation_stiffness: Vectors = Field(
        default=np.zeros(3), description="kr about x, y, z [force length], per radian; 0: free"
    )
    targets: Maybe[Points] = Field(
        default=None, description="Where there is no force [length], one for each; default: the start positions"
    )

    formula: ClassVar[str] = "E = Σ (k d² + kr φ²)/2"
    role: ClassVar[Literal["internal", "load", "support"]] = "support"
    bearing: ClassVar[bool] = True
    creates: ClassVar[bool] = False
    rider: ClassVar[type[Rider] | None] = SupportTurns
    outputs: ClassVar[dict[str, str]] = {"force": "force", "moment": "moment"}
    kernel: ClassVar[Any] = staticmethod(support_kernel)
    hessian: ClassVar[Any] = staticmethod(support_hessian)

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: stiffness and targets; and those of rotations, for `SupportTurns`."""
        index = places.elements(self)
        start = places.x[np.maximum(index[:, 0], 0)]
        for name in ("stiffness", "rotation_stiffness"):
            low = np.atleast_2d(getattr(self, name)).min(initial=0.0)
            if low < 0.0:
                raise InputError("", f"{name} of {low:g} given; at least 0 allowed")
        rows = (len(index), 3)
        return Block.of(
            index,
            stiffness=np.broadcast_to(self.stiffness, rows),
            targets=start if self.targets is None else self.targets,
            rotation_stiffness=np.broadcast_to(self.rotation_stiffness, rows),
        )

    def measure(self, block: Block, x: Floats, element_forces: Floats) -> dict[str, Floats]:
        """The force [force] and the moment [force length] on each particle; the latter is the rider's."""
        return {"force": element_forces[:, 0], "moment": np.zeros((len(block.indices), 3))}

    @classmethod
    def example(cls) -> tuple[Support, Floats]:
        """Two supports, one of them stiff along one axis only."""
        return cls(
            particles=[0, 1],
            stiffness=[[30.0, 20.0, 10.0], [0.0, 0.0, 5.0]],
            targets=[[0.9, 0.1, 0.0], [0.0, 1.0, 0.2]],
        ), np.eye(3)[:2]
