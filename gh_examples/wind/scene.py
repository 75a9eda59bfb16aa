"""The sail: a net between four corners in the wind, a cable along each of its sides."""

from typing import Any

import numpy as np

from hookean import Scene
from hookean.discretize import corners, edges, grid, naked_edges
from hookean.values.mesh import Mesh

AIR = 1.225  # kg/m^3


def scene(
    size: float = 6.0, low: float = 2.5, high: float = 4.5, divisions: int = 10, speed: float = 12.0,
    drag: float = 0.5, lift: float = 0.8, stiffness: float = 4000.0, rest_factor: float = 0.92,
    edge_stiffness: float = 40_000.0, edge_factor: float = 0.97,
) -> Scene:  # fmt: skip
    """A ruled square of a `size` [m] in `divisions` by as many faces, two opposite corners at the height `low` and two
    at `high` [m], of springs with a `stiffness` [N/m] and a `rest_factor` [-]; `edge_stiffness` and `edge_factor` are
    those of the cables.

    The wind has a `speed` [m/s] along x; each vertex has an equal part of its pressure on the square, times the
    coefficients `drag` along x and `lift` upwards [-].
    """
    mesh = drawn(size, low, high, divisions)
    pressed = 0.5 * AIR * speed**2 * size**2 / len(mesh.vertices)
    sail = {"kind": "springs", "name": "sail", "particles": edges(mesh), "stiffness": stiffness,
            "rest_factor": rest_factor}  # fmt: skip
    edge = {"kind": "springs", "name": "edge", "particles": naked_edges(mesh), "stiffness": edge_stiffness,
            "rest_factor": edge_factor}  # fmt: skip
    wind: dict[str, Any] = {"kind": "unary", "name": "wind", "particles": np.arange(len(mesh.vertices)),
                            "vector": [pressed * drag, 0.0, pressed * lift]}  # fmt: skip
    return Scene(
        particles=mesh.vertices,
        forces=[sail, edge, wind],
        anchors=[{"name": "corners", "particles": corners(mesh)}],
        meshes={"sail": {"vertices": mesh.vertices, "faces": mesh.faces}},
        geometry=[{"name": "sail", "kind": "mesh", "mesh": "sail"}],
        settings={"time_step": 0.0025, "sub_iterations": 40, "drag": 3.0, "tolerance": 1e-8},
    )


def drawn(size: float, low: float, high: float, divisions: int) -> Mesh:
    """The ruled square."""
    part = np.linspace(0.0, 1.0, divisions + 1)
    u, v = part[:, None], part[None, :]
    return grid(size * part, size * part, low + (high - low) * (u + v - 2.0 * u * v))
