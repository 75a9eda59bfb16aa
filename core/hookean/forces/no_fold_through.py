"""No fold through: folds that stop where two triangles meet face to face."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np

from hookean.compiled.marks import device
from hookean.forces.base import Block, Floats, Force, Places, complete
from hookean.forces.dihedral import fold, fold_angles, turn, wrapped
from hookean.forces.mesh_edges import folds
from hookean.values.columns import IndexRows, PointRows
from hookean.values.fields import Field, Maybe

STRENGTH, LIMIT, START = 0, 1, 2  # columns of the parameters


@device
def followed(parameters: Any, memory: Any, e: Any, angle: Any) -> Any:
    """The fold angle, counted on beyond half a turn from where it was at the end of the last step."""
    last = parameters[e, START] + memory[e, 0]
    return last + wrapped(angle - last)


def no_fold_through_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    energy = 0.0
    g = np.zeros((4, 5))
    for e in range(indices.shape[0]):
        angle = fold(x, indices[e, 0], indices[e, 1], indices[e, 2], indices[e, 3], g)
        if np.isnan(angle):
            continue
        angle = followed(parameters, memory, e, angle)
        more = max(np.abs(angle) - parameters[e, LIMIT], 0.0)
        energy += 0.5 * parameters[e, STRENGTH] * more * more
        # what is below the limit counts for the stiffness as well: it may pass it in the next step
        turn(indices, e, parameters[e, STRENGTH], np.copysign(parameters[e, STRENGTH] * more, angle), g, f, w)
    return energy


def no_fold_through_follow(x, indices, parameters, memory):  # type: ignore[no-untyped-def]
    g = np.zeros((4, 5))
    for e in range(indices.shape[0]):
        angle = fold(x, indices[e, 0], indices[e, 1], indices[e, 2], indices[e, 3], g)
        if not np.isnan(angle):
            memory[e, 0] = followed(parameters, memory, e, angle) - parameters[e, START]


class NoFoldThrough(Force):
    """Hinges that push back where they fold beyond a limit: E = S (|theta| - limit)^2 / 2, nothing below it.

    theta is the fold angle between the triangles start-end-tip 1 and end-start-tip 2, 0 where flat, as for `hinge`. At
    the limit of pi, the default, the triangles lie on each other. At the end of each step theta is remembered, so that
    it is counted on beyond pi instead of being that of a fold to the other side. Forces and moments of every hinge sum
    to zero. Edges of a mesh count where two triangles share them; its quads are left out.
    """

    kind: Literal["no_fold_through"] = "no_fold_through"
    particles: Maybe[IndexRows] = Field(default=None, description="Edge start, edge end, tip 1, tip 2 of each hinge")
    points: Maybe[PointRows] = Field(default=None, description="Coordinates of edge start, edge end, tip 1, tip 2")
    mesh: str | None = Field(default=None, description="Name of a mesh: the edges between its triangles")
    strength: float = Field(default=1.0, ge=0, le=1e12, description="S, moment per angle [force length]")
    limit: float = Field(default=np.pi, ge=0, le=2.0 * np.pi, description="Fold angle from which on it pushes [rad]")

    formula: ClassVar[str] = "E = S (|θ| - limit)²/2"
    remembers: ClassVar[bool] = True
    yielding: ClassVar[tuple[str, ...]] = ("strength",)
    creates: ClassVar[bool] = False
    arity: ClassVar[int] = 4
    solid: ClassVar[bool] = False
    outputs: ClassVar[dict[str, str]] = {"angle": "angle", "moment": "moment"}
    kernel: ClassVar[Any] = staticmethod(no_fold_through_kernel)
    end_of_step: ClassVar[Any] = staticmethod(no_fold_through_follow)
    example_faces: ClassVar[list[list[int]]] = [[0, 1, 2], [1, 0, 3], [1, 4, 2]]

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: S, limit, start angle; memory: how far the fold has gone from there."""
        if self.mesh is None:
            index = places.elements(self)
        else:
            index = folds(complete(places.faces(self.mesh)))
        start = fold_angles(places.x, index)
        return Block.of(index, memory=1, strength=self.strength, limit=self.limit, start=start)

    def measure(self, block: Block, x: Floats, element_forces: Floats) -> dict[str, Floats]:
        """Fold angle, beyond pi where it has folded through [rad], and the moment against it [force length]."""
        last = block.parameters[:, START] + block.memory[:, 0]
        angle: Floats = last + wrapped(fold_angles(x, block.indices) - last)
        more = np.maximum(np.abs(angle) - block.parameters[:, LIMIT], 0.0)
        acts = element_forces.any(axis=(1, 2))  # a sliver has no fold
        return {"angle": angle, "moment": np.where(acts, block.parameters[:, STRENGTH] * np.copysign(more, angle), 0.0)}

    @classmethod
    def example(cls) -> tuple[NoFoldThrough, Floats]:
        """Three triangles with two folds between them (`example_faces`), of which one is beyond the limit."""
        x = [[0.0, 0.0, 0.0], [1.0, 0.1, 0.2], [0.4, 0.9, 0.3], [0.6, 0.5, 0.75], [1.4, 0.8, -0.1]]
        return cls(mesh="skin", strength=20.0, limit=1.0), np.array(x)
