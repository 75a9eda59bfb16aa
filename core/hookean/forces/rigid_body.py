"""Rigid body: groups of particles that keep the shape in which they were drawn, wherever they move and turn."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np

from hookean.compiled import dispatch
from hookean.compiled.marks import device
from hookean.forces import groups
from hookean.forces.base import Block, Floats, OnFilm, Places
from hookean.forces.fits import SWEEPS, rotate
from hookean.forces.groups import begins, following
from hookean.forces.pull_to_mesh import away
from hookean.values.columns import IndexRows, Labels, NonNegatives, Points, Vectors
from hookean.values.fields import Field, Maybe

STRENGTH, SHAPE = 2, 3  # columns of the parameters, after the links of the group; the shape has three
CENTRE, TURN, SIZE, POSE = 0, 3, 12, 13  # of a pose: centre, rotation by rows, size of the body, how many numbers


@device
def product(x: Any, indices: Any, parameters: Any, first: Any, pose: Any, s: Any) -> Any:
    """Write the centre of a group into its pose and the sum of k q y^T into `s`, y from the centre; returns the sum of
    k, and writes the size of the body."""
    total = square = 0.0
    start = indices[first, 0]
    for i in range(3):
        pose[CENTRE + i] = 0.0
        for j in range(3):
            s[i, j] = 0.0
    e = first
    while e >= 0:
        k = parameters[e, STRENGTH]
        total += k
        for i in range(3):
            pose[CENTRE + i] += k * (x[indices[e, 0], i] - x[start, i])
            square += k * parameters[e, SHAPE + i] * parameters[e, SHAPE + i]
        e = following(parameters, e)
    if total == 0.0:
        return 0.0
    for i in range(3):
        pose[CENTRE + i] = x[start, i] + pose[CENTRE + i] / total
    e = first
    while e >= 0:
        for i in range(3):
            for j in range(3):
                y = x[indices[e, 0], j] - pose[CENTRE + j]
                s[i, j] += parameters[e, STRENGTH] * parameters[e, SHAPE + i] * y
        e = following(parameters, e)
    pose[SIZE] = np.sqrt(square / total)
    return total


@device
def find_pose(x: Any, indices: Any, parameters: Any, first: Any, pose: Any, room: Any) -> Any:
    """The centre and the rotation for which the energy of a group is least; returns its total strength.

    The rotation is the unit quaternion of the largest eigenvalue of a matrix (4, 4).
    """
    s, n, vectors = room[:4], room[4:8], room[8:]
    total = product(x, indices, parameters, first, pose, s)
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        n[0, 1 + i] = n[1 + i, 0] = s[j, k] - s[k, j]
        n[1 + i, 1 + i] = s[i, i] - s[j, j] - s[k, k]
        n[1 + i, 1 + j] = n[1 + j, 1 + i] = s[i, j] + s[j, i]
    n[0, 0] = s[0, 0] + s[1, 1] + s[2, 2]
    for i in range(4):
        for j in range(4):
            vectors[i, j] = 1.0 if i == j else 0.0
    for _ in range(SWEEPS):
        for i in range(3):
            for j in range(i + 1, 4):
                rotate(n, vectors, i, j)
    best = 0
    for i in range(1, 4):
        if n[i, i] > n[best, best]:
            best = i
    q = vectors[best]
    square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        pose[TURN + 4 * i] = 1.0 - 2.0 * (q[1 + j] * q[1 + j] + q[1 + k] * q[1 + k]) / square
        pose[TURN + 3 * i + j] = 2.0 * (q[1 + i] * q[1 + j] - q[0] * q[1 + k]) / square
        pose[TURN + 3 * j + i] = 2.0 * (q[1 + i] * q[1 + j] + q[0] * q[1 + k]) / square
    return total


def rigid_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    energy = 0.0
    pose, room = np.zeros(POSE), np.zeros((12, 4))
    for first in range(indices.shape[0]):
        if not begins(parameters, first) or find_pose(x, indices, parameters, first, pose, room) == 0.0:
            continue
        e = first
        while e >= 0:
            a, k = indices[e, 0], parameters[e, STRENGTH]
            w[a] += k
            for i in range(3):
                d = x[a, i] - pose[CENTRE + i]
                for j in range(3):
                    d -= pose[TURN + 3 * i + j] * parameters[e, SHAPE + j]
                f[a, i] -= k * d
                energy += 0.5 * k * d * d
            e = following(parameters, e)
    return energy


def find_poses(x, indices, parameters, found):  # type: ignore[no-untyped-def]
    """Write the pose of its group for every row."""
    pose, room = np.zeros(POSE), np.zeros((12, 4))
    for first in range(indices.shape[0]):
        e = first if begins(parameters, first) else -1
        if e >= 0:
            find_pose(x, indices, parameters, first, pose, room)
        while e >= 0:
            for i in range(POSE):
                found[e, i] = pose[i]
            e = following(parameters, e)


class RigidBody(groups.Grouped):
    """Particles of a group keep the shape of a body that moves and turns with them: E = sum k |x - (R q + c)|^2 / 2.

    q is the place of each particle in the body, drawn or given; R and c are the rotation and the place of the body for
    which E is least, so forces and moments of a group sum to zero, and a body that is moved and turned as a whole has
    no energy. Each particle feels k at most: a body is as stiff as k is large. Particles on one line leave the turn
    about that line free. Particles of several bodies join them: one is a ball joint, two are a hinge, three hold.
    Sources: Horn, "Closed-form solution of absolute orientation using unit quaternions", 1987 (the rotation); Mueller
    et al., "Meshless deformations based on shape matching", 2005.
    """

    kind: Literal["rigid_body"] = "rigid_body"
    particles: Maybe[IndexRows] = Field(default=None, description="Particles")
    points: Maybe[Points] = Field(default=None, description="Coordinates of particles")
    group: Maybe[Labels] = Field(
        default=None, description="Number of the body of each particle; default: all are in one"
    )
    shape: Maybe[Vectors] = Field(
        default=None, description="q, the place of each particle in its body [length]; default: where it is drawn"
    )
    strength: NonNegatives = Field(default=1000.0, description="k [force/length]")

    formula: ClassVar[str] = "E = Σ k |x - (R q + c)|²/2"
    solid: ClassVar[bool] = False
    steady: ClassVar[str] = "strength"
    on_film: ClassVar[OnFilm] = "spread"
    unknowns: ClassVar[int] = 6
    outputs: ClassVar[dict[str, str]] = {"distance": "length", "force": "force"}
    kernel: ClassVar[Any] = staticmethod(rigid_kernel)

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: links of the groups, strength, and places in the bodies from their centres."""
        index = places.elements(self)
        shape = places.x[index[:, 0]] if self.shape is None else np.atleast_2d(self.shape)
        block = Block.of(index, links=groups.links(index, self.group), strength=self.strength, shape=shape)
        block.parameters[:, SHAPE:] -= block.parameters[groups.heads(block), SHAPE:]  # means of what is far are rounded
        block.parameters[:, SHAPE:] -= _centres(block)
        return block

    def measure(self, block: Block, x: Floats, element_forces: Floats) -> dict[str, Floats]:
        """Distance of each particle from its place in the body [length] and the force on it [force]."""
        return away(block, element_forces, STRENGTH)

    @classmethod
    def second(cls, block: Block, memory: Floats, x: Floats) -> Floats:
        """Of k |d|^2 / 2 by a particle, the place of its body and a small rotation times the body's size:
        d = y - c - p - r x p - r x (r x p) / 2 with p = R q."""
        pose = poses(block, x)
        p = np.einsum("mij,mj->mi", pose[:, TURN:SIZE].reshape(-1, 3, 3), block.parameters[:, SHAPE:])
        d = x[block.indices[:, 0]] - pose[:, CENTRE:TURN] - p
        size = np.where(pose[:, SIZE] > 0.0, pose[:, SIZE], 1.0)[:, None]
        slope = np.zeros((len(d), 3, 9))
        slope[:, range(3), range(3)], slope[:, range(3), range(3, 6)] = 1.0, -1.0
        for i in range(3):
            slope[:, :, 6 + i] = -np.cross(np.eye(3)[i], p / size)
        found = slope.transpose(0, 2, 1) @ slope
        both = d[:, :, None] * p[:, None]
        inner = np.einsum("mi,mi->m", d, p)[:, None, None] * np.eye(3) - 0.5 * (both + both.transpose(0, 2, 1))
        found[:, 6:, 6:] += inner / size[:, :, None] ** 2
        return np.ascontiguousarray(block.parameters[:, STRENGTH, None, None] * found)

    @classmethod
    def example(cls) -> tuple[RigidBody, Floats]:
        """Two bodies, of five and of four particles, turned and bent out of their shapes."""
        x = [[0, 0, 0.2], [4, 0.3, -0.1], [3.6, 3, 0.3], [0.4, 3.1, 0], [2, 1.4, 2.4]]
        x += [[6, 1, 2.3], [8, 4, 3.0], [7, 6, 1.4], [6.5, 2.0, 4.0]]
        shape = [[0, 0, 0], [0, 4, 0], [-3, 4, 0], [-3, 0, 0.3], [-1, 2, 2], [0, 0, 0], [3, 2, 1], [1, 5, 0], [1, 1, 2]]
        strength = [5.0, 20.0, 1.0, 7.0, 30.0, 4.0, 9.0, 6.0, 3.0]
        return cls(particles=range(9), group=[4] * 5 + [1] * 4, shape=shape, strength=strength), np.array(x)


def poses(block: Block, x: Floats) -> Floats:
    """The pose of the body of each particle (m, POSE): centre [length], rotation by rows, size of the body [length]."""
    found = np.zeros((len(block.indices), POSE))
    dispatch.compiled(find_poses)(x, block.indices, block.parameters, found)
    return found


def _centres(block: Block) -> Floats:
    """The mean (m, 3) of the body of each particle, weighted by k; of its particles alike, where all k are 0."""
    head, k = groups.heads(block), block.parameters[:, STRENGTH]
    count = len(head)
    k = np.where(np.bincount(head, k, count)[head] > 0.0, k, 1.0)
    weight = np.bincount(head, k, count)[head]
    sums = [np.bincount(head, k * column, count)[head] for column in block.parameters[:, SHAPE:].T]
    return np.column_stack(sums) / weight[:, None]
