"""Section 9.7: a mesh sphere falls onto the floor, of springs alone or with Shell."""

from typing import Any

import numpy as np

from hookean import Scene
from hookean.discretize import diagonals, edges
from hookean.values.mesh import Mesh


def scene(
    radius: float = 5.0, drop: float = 5.0, around: int = 20, along: int = 12, stiffness: float = 5000.0,
    shell: float = 500.0, drag: float = 1.0, weight: float = 9.81, **settings: Any,
) -> Scene:  # fmt: skip
    """A sphere of a `radius` [m], its lowest point `drop` [m] over the floor, of `around` faces round its axis and
    `along` it, 1 kg and a `weight` [N] on every vertex.

    Edges and diagonals of quads are springs of a `stiffness` [N/m]; `shell` [N m] is the strength of Shell, 0: none;
    `drag` [N s/m] on every vertex.
    """
    mesh = drawn(radius, drop, around, along)
    springs = [
        {"kind": "springs", "name": name, "particles": pairs, "stiffness": stiffness}
        for name, pairs in (("edges", edges(mesh)), ("diagonals", diagonals(mesh)))
    ]
    where = np.arange(len(mesh.vertices))
    gravity = {"kind": "unary", "name": "gravity", "particles": where, "vector": [0.0, 0.0, -weight]}
    bent = [{"kind": "shell", "name": "shell", "mesh": "sphere", "strength": shell}] if shell else []
    air = {"solver": "verlet", "time_step": 0.004, "sub_iterations": 5, "drag": drag, "floor": True, "tolerance": 1e-3}
    return Scene(
        particles=mesh.vertices,
        meshes={"sphere": {"vertices": mesh.vertices, "faces": mesh.faces}},
        forces=[*springs, gravity, *bent],
        geometry=[{"name": "sphere", "kind": "mesh", "mesh": "sphere"}],
        settings={**air, **settings},
    )


def drawn(radius: float, drop: float, around: int, along: int) -> Mesh:
    """A mesh sphere with its axis along y, as one drawn in the Front view has it, with triangles at its poles."""
    turn = 2.0 * np.pi * np.arange(around) / around
    steps = np.pi * np.arange(1, along) / along
    ring, y = radius * np.sin(steps)[:, None], -radius * np.cos(steps)[:, None]
    rows = np.stack([ring * np.sin(turn), y + 0.0 * turn, ring * np.cos(turn)], axis=2).reshape(-1, 3)
    poles = np.array([[0.0, -radius, 0.0], [0.0, radius, 0.0]])
    vertices = np.concatenate([poles[:1], rows, poles[1:]]) + [0.0, 0.0, radius + drop]
    number = 1 + np.arange(around * (along - 1)).reshape(along - 1, around)
    after = np.roll(number, -1, axis=1)
    quads = np.stack([number[:-1], after[:-1], after[1:], number[1:]], axis=2).reshape(-1, 4)
    top = np.full(around, len(vertices) - 1)
    first = np.stack([0 * top, after[0], number[0], number[0]], axis=1)
    last = np.stack([number[-1], after[-1], top, top], axis=1)
    return Mesh(vertices, np.concatenate([first, quads, last]))
