"""Collide lines: capsules, straight lines with a radius, that do not pass through one another."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np

from hookean.forces.base import Block, Floats, Force, Places
from hookean.forces.capsules import TINY
from hookean.forces.cells import PARALLEL
from hookean.forces.collide import Crowd, crowd, overlapping
from hookean.forces.crowd_rows import NEAREST, STIFFNESS
from hookean.values.columns import IndexRows, Labels, Lines, Positives
from hookean.values.fields import Field, Maybe


class CollideLines(Crowd):
    """Capsules about lines that push each other apart where they overlap: E = k (a + b - d)^2 / 2.

    a and b are the radii of two capsules, d is the shortest distance of their lines, and the force k (a + b - d) acts
    where they are nearest, on both ends of each line by the lever rule. All capsules of the force can touch, except
    those that share a particle and those of one `collision_group`. A line that starts and ends at one particle is a
    sphere. Two pressed together with a force F overlap by F / k. Lines that cross have no direction in which to part:
    nothing pushes them.

    The contact of two capsules is one point. Of parallel ones it is in the middle of where they are beside each other,
    and it moves quickly as they turn: piles of parallel capsules may not come to rest. Source: Ericson, Real-Time
    Collision Detection, 2005, 4.5 and 5.1.9 (capsules, closest points).
    """

    kind: Literal["collide_lines"] = "collide_lines"
    particles: Maybe[IndexRows] = Field(default=None, description="Pairs of particles at the ends of lines")
    lines: Maybe[Lines] = Field(default=None, description="Straight lines between particles")
    radius: Positives = Field(default=0.2, description="Radius of each capsule [length]")
    strength: float = Field(default=1000.0, ge=0, le=1e12, description="k, stiffness of a contact [force/length]")
    collision_group: Maybe[Labels] = Field(
        default=None, description="A number for each line [-]: those of one group ignore each other; 0: of no group"
    )

    formula: ClassVar[str] = "E = k (a + b - d)²/2"
    arity: ClassVar[int] = 2
    pointed: ClassVar[bool] = True

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: those of all that collide, and the particles by which lines are joined."""
        index = places.elements(self)
        return crowd(places, index, self.radius, self.collision_group, self.strength, joints=index)

    @classmethod
    def gathered(
        cls, block: Block, memory: Floats, x: Floats, node: int | None
    ) -> list[tuple[type[Force], Block]] | None:
        """The pairs that overlap."""
        pair, place = overlapping(block, x)
        table = np.column_stack([block.parameters[pair[:, 0], STIFFNESS], place])
        return [(Pressed, Block(block.indices[pair].reshape(-1, 4), table, np.zeros((len(pair), 0))))]

    @classmethod
    def example(cls) -> tuple[CollideLines, Floats]:
        """Five lines: two that cross, one with its end on them, one joined to it, and one in a group with the first."""
        x = [[0, 0, 0], [3, 0.2, 0.3], [1.2, -1.5, 0.6], [1.7, 1.6, 0.9], [2.3, 0.5, 0.9], [2.5, 0.9, 3.2]]
        x += [[4.5, -0.6, 3.3], [0.3, -1.2, 0.4], [0.5, 1.5, -0.1]]
        force = cls(
            particles=[[0, 1], [2, 3], [4, 5], [5, 6], [7, 8]],
            radius=[0.5, 0.6, 0.4, 0.3, 0.4],
            strength=50.0,
            collision_group=[1, 0, 0, 0, 1],
        )
        return force, np.array(x)


class Pressed(Force):
    """Pairs of capsules as elements of four particles: for their tangents alone."""

    tangent: ClassVar[Any] = staticmethod(lambda block, x: _stiffness(block, x))


def _stiffness(block: Block, x: Floats) -> Floats:
    """Stiffness (m, 12, 12) of pairs that overlap: with B the weights of the ends, so that B x is the vector between
    the nearest points, d its length and n its direction, k (B'n n'B - (a + b - d) H) with the second derivative of d,
    H = (B'(1 - n n')B - G (U'U)^-1 G') / d, G = d B'/ds n + B'U, where U are the half axes along which they may slide.
    """
    stiffness, reach, s, t = block.parameters.T
    a, b, c, e = x[block.indices].transpose(1, 0, 2)
    axes = np.stack([0.5 * (b - a), 0.5 * (c - e)], axis=2)  # (m, 3, 2): derivatives of the vector by s and by t
    weight = 0.5 * np.column_stack([1.0 - s, 1.0 + s, t - 1.0, -1.0 - t])
    apart = np.einsum("mi,mic->mc", weight, x[block.indices])
    length = np.maximum(np.sqrt((apart**2).sum(axis=1)), NEAREST)
    n = apart / length[:, None]
    gram = np.einsum("mci,mcj->mij", axes, axes)
    size = gram[:, [0, 1], [0, 1]]
    slides = (np.abs(np.column_stack([s, t])) < 1.0) & (size > TINY)
    slides[slides.all(axis=1) & (np.linalg.det(gram) <= PARALLEL * size.prod(axis=1)), 1] = False
    turn = np.array([[-0.5, 0.5, 0.0, 0.0], [0.0, 0.0, 0.5, -0.5]])
    way = length[:, None, None, None] * np.einsum("pi,mc->mpic", turn, n) + np.einsum("mi,mcp->mpic", weight, axes)
    way = np.where(slides[:, :, None], way.reshape(-1, 2, 12), 0.0)
    gram = np.where(slides[:, :, None] & slides[:, None], gram, np.eye(2))
    steady = np.einsum("mi,mc->mic", weight, n).reshape(-1, 12)
    square = np.einsum("mi,mj,cd->micjd", weight, weight, np.eye(3)).reshape(-1, 12, 12)
    square -= steady[:, :, None] * steady[:, None] + np.einsum("mpi,mpj->mij", way, np.linalg.solve(gram, way))
    part = stiffness * np.maximum(reach - length, 0.0) / length
    return np.asarray(stiffness[:, None, None] * steady[:, :, None] * steady[:, None] - part[:, None, None] * square)
