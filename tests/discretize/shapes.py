"""Meshes with known numbers: grids, a cube, an octahedron, spheres, a Moebius band, cylinders."""

from __future__ import annotations

import numpy as np

from hookean.discretize import edges
from hookean.values.mesh import Mesh

CUBE = Mesh(
    np.array([[x, y, z] for z in (-1.0, 1.0) for y in (-1.0, 1.0) for x in (-1.0, 1.0)]),
    np.array([[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [1, 3, 7, 5], [3, 2, 6, 7], [2, 0, 4, 6]]),
)
_UP = np.array([[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2]])
OCTAHEDRON = Mesh(
    np.array([[1.0, 0, 0], [0, 1.0, 0], [0, 0, 1.0], [-1.0, 0, 0], [0, -1.0, 0], [0, 0, -1.0]]),
    np.concatenate([_UP, np.where(_UP == 2, 5, _UP)[:, ::-1]])[:, [0, 1, 2, 2]],
)


def grid(n: int, m: int, size: float = 1.0, triangles: bool = False) -> Mesh:
    """n by m squares in the plane z = 0, or twice as many triangles."""
    points = np.array([[size * i, size * j, 0.0] for j in range(m + 1) for i in range(n + 1)])
    a = np.array([j * (n + 1) + i for j in range(m) for i in range(n)])
    four = np.stack([a, a + 1, a + n + 2, a + n + 1], axis=1)
    return Mesh(points, np.concatenate([four[:, [0, 1, 2, 2]], four[:, [0, 2, 3, 3]]]) if triangles else four)


def strip(count: int, twist: float = 0.0, closed: bool = False) -> Mesh:
    """A band of `count` squares that turns by `twist` about its axis; closed, after pi, it is a Moebius band."""
    t = np.arange(count + (not closed)) / count
    across = np.stack([np.zeros_like(t), np.cos(twist * t), np.sin(twist * t)], axis=1)
    if closed:
        round_ = np.stack([np.cos(2 * np.pi * t), np.sin(2 * np.pi * t), 0 * t], axis=1)
        across = np.cos(twist * t)[:, None] * round_ + np.sin(twist * t)[:, None] * [0.0, 0.0, 1.0]
        middle = 4.0 * round_
    else:
        middle = np.stack([t * count, 0 * t, 0 * t], axis=1)
    points = np.stack([middle - 0.5 * across, middle + 0.5 * across], axis=1).reshape(-1, 3)
    rows = np.array([[2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1] for i in range(count)])
    if closed:
        ends = {2 * count: 1, 2 * count + 1: 0} if twist else {2 * count: 0, 2 * count + 1: 1}
        rows = np.vectorize(lambda v: ends.get(int(v), int(v)))(rows)
    return Mesh(points, rows)


def euler(mesh: Mesh) -> int:
    """V - E + F, of the vertices in faces."""
    return len(np.unique(mesh.faces)) - len(edges(mesh)) + len(mesh.faces)


def oriented(mesh: Mesh) -> bool:
    """Whether no directed side occurs twice: neighbours run round alike, and no edge has three faces."""
    sides = np.stack([mesh.faces, np.roll(mesh.faces, -1, axis=1)], axis=2).reshape(-1, 2)
    sides = sides[sides[:, 0] != sides[:, 1]]
    return len(np.unique(sides, axis=0)) == len(sides)
