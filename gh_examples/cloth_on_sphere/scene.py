"""A cloth laid over a ball: springs along its threads and across, and a sphere that its vertices collide with."""

from typing import Any

import numpy as np

from hookean import Scene
from hookean.discretize import diagonals, edges, grid

THICK = 0.001  # m: radius of the spheres about vertices


def scene(
    divisions: int = 16, side: float = 2.4, radius: float = 0.8, weight: float = 4.0, stiffness: float = 2000.0,
    shear: float = 100.0, bending: float = 0.005, contact: float = 5000.0, **settings: Any,
) -> Scene:  # fmt: skip
    """A square cloth of a `side` [m] and a `weight` [N/m2], of an even number of `divisions` a side, flat on top of a
    ball of a `radius` [m].

    Threads are springs of a `stiffness`, diagonals of `shear` [N/m], `bending` [N m2] is that of a thread. Contacts of
    a stiffness `contact` [N/m]: the ball is a sphere, vertices are spheres of 1 mm that ignore each other.
    """
    along = np.linspace(-0.5 * side, 0.5 * side, divisions + 1)
    mesh = grid(along, along, radius + THICK)
    count = len(mesh.vertices)
    share = np.outer(*2 * [np.r_[0.5, np.ones(divisions - 1), 0.5]]).ravel() * (side / divisions) ** 2
    springs = [
        {"kind": "springs", "name": name, "particles": pairs, "stiffness": k}
        for name, pairs, k in (("threads", edges(mesh), stiffness), ("diagonals", diagonals(mesh), shear))
    ]
    return Scene(
        particles=np.concatenate([mesh.vertices, np.zeros((1, 3))]),
        meshes={"cloth": {"vertices": mesh.vertices, "faces": mesh.faces}},
        forces=[
            *springs,
            {"kind": "bend", "name": "bending", "particles": corners(divisions + 1), "stiffness": bending},
            {"kind": "unary", "name": "weight", "particles": np.arange(count),
             "vector": -weight * share[:, None] * [0.0, 0.0, 1.0]},
            {"kind": "collide", "name": "ball", "particles": np.arange(count + 1), "strength": contact,
             "radius": np.r_[np.full(count, THICK), radius], "collision_group": np.r_[np.ones(count, int), 0]},
        ],
        anchors=[
            {"name": "ball", "particles": [count]},
            {"name": "top", "particles": [count // 2], "axes": "xy"},
        ],
        geometry=[{"name": "cloth", "kind": "mesh", "mesh": "cloth"}],
        settings={"solver": "relaxation", "tolerance": 1e-6, **settings},
    )  # fmt: skip


def corners(count: int) -> np.ndarray:
    """Three vertices in a row, (k, 3), along all threads of a cloth of `count` by `count` vertices."""
    number = np.arange(count * count).reshape(count, count)
    rows = np.stack([number[:, :-2], number[:, 1:-1], number[:, 2:]], axis=2).reshape(-1, 3)
    columns = np.stack([number[:-2], number[1:-1], number[2:]], axis=2).reshape(-1, 3)
    return np.concatenate([rows, columns])
