"""Quads that become flat: a roof that stays near its drawing, a surface of translation, and one quad by itself."""

from typing import Any

import numpy as np

from hookean import Scene
from hookean.discretize import join, quads
from hookean.values.mesh import Mesh

ASIDE, TWIST = 15.0, 0.5  # m: from part to part; by which a corner of the quad is out of plane


def scene(divisions: int = 10, flatness: float = 1.0, nearness: float = 0.001, **settings: Any) -> Scene:
    """A roof and a surface of translation of `divisions` a side, and a twisted quad, side by side.

    Quads are made flat by a stiffness `flatness`; springs of a strength `nearness` [N/m] keep the vertices of the roof
    where they are drawn.
    """
    parts = [roof(divisions), translation(divisions), single()]
    whole = join(parts)
    near = {"kind": "anchor_spring", "name": "drawing", "particles": np.arange(len(parts[0].vertices)),
            "strength": nearness}  # fmt: skip
    return Scene(
        particles=whole.vertices,
        meshes={"quads": {"vertices": whole.vertices, "faces": whole.faces}},
        forces=[
            {"kind": "planarize", "name": "quads", "mesh": "quads", "stiffness": flatness},
            *([near] if nearness else []),
        ],
        geometry=[{"name": "quads", "kind": "mesh", "mesh": "quads"}],
        settings={"tolerance": 1e-9, **settings},
    )


def roof(divisions: int) -> Mesh:
    """A doubly curved roof over 12 m, twisted and wider at one end."""
    u, v = even(divisions)
    return quads(np.stack([6.0 * u, 6.0 * v * (1.0 + 0.2 * u), 3.2 - 2.0 * u**2 - 1.2 * v**2 + 1.2 * u * v], axis=2))


def translation(divisions: int) -> Mesh:
    """A parabola along a wave: its quads are parallelograms, and flat."""
    u, v = even(divisions)
    return quads(np.stack([6.0 * u + ASIDE, 6.0 * v, 3.2 - 2.0 * u**2 + 0.6 * np.cos(3.0 * v)], axis=2))


def single() -> Mesh:
    """A square of 4 m with two opposite corners up and two down."""
    x = 2.0 * np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
    up = TWIST * np.array([1.0, -1.0, 1.0, -1.0])
    return Mesh(np.column_stack([x[:, 0] + 1.75 * ASIDE, x[:, 1], up]), np.array([[0, 1, 2, 3]]))


def even(divisions: int) -> tuple[np.ndarray, np.ndarray]:
    """Both coordinates of a grid, from -1 to 1."""
    along = np.linspace(-1.0, 1.0, divisions + 1)
    u, v = np.meshgrid(along, along, indexing="ij")
    return u, v
