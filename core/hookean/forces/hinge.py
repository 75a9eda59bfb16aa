"""Hinge: a moment between two triangles that share an edge."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np

from hookean.compiled.marks import device
from hookean.forces.base import Block, Floats, Force, Places
from hookean.forces.dihedral import bends, fold, fold_angles, turn, wrapped
from hookean.values.columns import IndexRows, NonNegatives, PointRows, Reals
from hookean.values.fields import Field, Maybe

LIMIT = 3  # column of the parameters


@device
def bent(parameters: Any, memory: Any, e: Any, angle: Any) -> Any:
    """How far a fold is from where its rest angle has gone to, and how far its moment grows."""
    off = wrapped(angle - parameters[e, 1] * parameters[e, 2] - memory[e, 0])
    limit = parameters[e, LIMIT]
    return off, min(max(off, -limit), limit) if limit > 0.0 else off


def hinge_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    energy = 0.0
    g = np.zeros((4, 5))
    for e in range(indices.shape[0]):
        angle = fold(x, indices[e, 0], indices[e, 1], indices[e, 2], indices[e, 3], g)
        if np.isnan(angle):
            continue
        off, elastic = bent(parameters, memory, e, angle)
        moment = parameters[e, 0] * elastic
        energy += moment * (off - 0.5 * elastic)
        turn(indices, e, parameters[e, 0], moment, g, f, w)
    return energy


def hinge_hessian(x, indices, parameters, memory, blocks):  # type: ignore[no-untyped-def]
    g, h = np.zeros((4, 5)), np.zeros((12, 12))
    for e in range(indices.shape[0]):
        a, b, c, d = indices[e, 0], indices[e, 1], indices[e, 2], indices[e, 3]
        angle = fold(x, a, b, c, d, g)
        if np.isnan(angle):
            blocks[e] = 0.0
            continue
        off, elastic = bent(parameters, memory, e, angle)
        stiff = parameters[e, 0] if off == elastic else 0.0
        bends(x, a, b, c, d, g, h)
        for i in range(12):
            for j in range(i + 1):
                both = stiff * g[i // 3, i % 3] * g[j // 3, j % 3] + parameters[e, 0] * elastic * h[i, j]
                blocks[e, i, j] = blocks[e, j, i] = both


def hinge_stressed(x, indices, parameters, memory, blocks):  # type: ignore[no-untyped-def]
    """The stiffness of the moments that a small movement, after the rest angle in `memory` (m, 1 + 12), brings."""
    g, h = np.zeros((4, 5)), np.zeros((12, 12))
    for e in range(indices.shape[0]):
        a, b, c, d = indices[e, 0], indices[e, 1], indices[e, 2], indices[e, 3]
        angle = fold(x, a, b, c, d, g)
        if np.isnan(angle):
            continue
        off, elastic = bent(parameters, memory, e, angle)
        if off != elastic:
            continue
        rate = 0.0
        for i in range(12):
            rate += parameters[e, 0] * g[i // 3, i % 3] * memory[e, 1 + i]
        bends(x, a, b, c, d, g, h)
        for i in range(12):
            for j in range(12):
                blocks[e, i, j] = rate * h[i, j]


def hinge_yield(x, indices, parameters, memory):  # type: ignore[no-untyped-def]
    g = np.zeros((4, 5))
    for e in range(indices.shape[0]):
        if parameters[e, LIMIT] > 0.0:
            angle = fold(x, indices[e, 0], indices[e, 1], indices[e, 2], indices[e, 3], g)
            if not np.isnan(angle):
                off, elastic = bent(parameters, memory, e, angle)
                memory[e, 0] += off - elastic


class Hinge(Force):
    """Hinges between the triangles start-end-tip 1 and end-start-tip 2: moment M = S (theta - theta0).

    theta [rad] is the fold angle, 0 where flat, positive where the tips rise to the side of
    (end - start) x (tip 1 - start). Energy per hinge S (theta - theta0)^2 / 2, with theta - theta0 taken in
    (-pi, pi] and theta0 = rest angle x angle factor; a triangle without height has no fold and no force. S is the
    moment about the edge per radian, whatever the size of the triangles: a plate of bending stiffness D [force length]
    cut into parallel strips of width h has S = D l / h along folds of length l; `shell` finds what a plate needs on
    any mesh. With a limit the hinge yields: beyond this angle from rest the moment stays the same, S x limit, and at
    the end of the step the rest angle follows up to that angle. Forces and moments of every hinge sum to zero. Folds of
    origami are hinges with the angle of a mountain or valley as rest angle, and the folding as its factor. Source:
    Grinspun et al., "Discrete shells", 2003.
    """

    kind: Literal["hinge"] = "hinge"
    particles: Maybe[IndexRows] = Field(default=None, description="Edge start, edge end, tip 1, tip 2 of each hinge")
    points: Maybe[PointRows] = Field(default=None, description="Coordinates of edge start, edge end, tip 1, tip 2")
    strength: NonNegatives = Field(default=1.0, description="S, moment per angle [force length]")
    rest_angle: Maybe[Reals] = Field(default=None, description="theta0 [rad], 0 flat; default: the start angle")
    angle_factor: Reals = Field(default=1.0, description="Factor on the rest angle [-]; 0: flat")
    limit: NonNegatives = Field(default=0.0, description="Angle from which on the rest angle follows [rad]; 0: none")

    formula: ClassVar[str] = "E = S (θ - θ0)²/2"
    remembers: ClassVar[bool] = True
    yielding: ClassVar[tuple[str, ...]] = ("limit",)
    creates: ClassVar[bool] = False
    arity: ClassVar[int] = 4
    linear: ClassVar[str] = "strength"
    outputs: ClassVar[dict[str, str]] = {"angle": "angle", "moment": "moment"}
    example_beside: ClassVar[dict[str, Any]] = {
        "forces": [{"kind": "springs", "particles": [[0, 1], [0, 2], [0, 3], [0, 4], [1, 2], [1, 3], [1, 4], [2, 4]]}]
    }
    kernel: ClassVar[Any] = staticmethod(hinge_kernel)
    hessian: ClassVar[Any] = staticmethod(hinge_hessian)
    stressed: ClassVar[Any] = staticmethod(hinge_stressed)
    end_of_step: ClassVar[Any] = staticmethod(hinge_yield)

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: S, rest angle, factor, limit; memory: how far the rest angle has gone."""
        index = places.elements(self)
        return Block.of(
            index,
            memory=1,
            strength=self.strength,
            rest_angle=fold_angles(places.x, index) if self.rest_angle is None else self.rest_angle,
            angle_factor=self.angle_factor,
            limit=self.limit,
        )

    def measure(self, block: Block, x: Floats, element_forces: Floats) -> dict[str, Floats]:
        """Fold angle [rad] and the moment that straightens it to the rest angle [force length]."""
        angle = fold_angles(x, block.indices)
        strength, rest, factor, limit = block.parameters.T
        limit = np.where(limit > 0.0, limit, np.inf)
        off: Floats = np.clip(wrapped(angle - rest * factor - block.memory[:, 0]), -limit, limit)
        acts = element_forces.any(axis=(1, 2))  # a sliver has no fold
        return {"angle": angle, "moment": np.where(acts, strength * off, 0.0)}

    @classmethod
    def example(cls) -> tuple[Hinge, Floats]:
        """Three hinges on five particles: bent to a rest angle, flattened and yielding, at rest."""
        x = np.array([[0.0, 0.0, 0.0], [1.0, 0.1, 0.2], [0.4, 0.9, 0.3], [0.6, -0.8, 0.25], [1.4, 0.8, -0.1]])
        hinges = cls(
            particles=[[0, 1, 2, 3], [1, 2, 4, 0], [0, 1, 4, 3]],
            strength=[20.0, 5.0, 50.0],
            rest_angle=[-0.4, 0.0, 0.3],
            angle_factor=[1.0, 1.0, 0.5],
            limit=[0.0, 0.05, 0.0],
        )
        return hinges, x
