"""A gridshell near a free surface, of flat glass and of laths that are in stock."""

from typing import Any

import numpy as np

from hookean import Scene
from hookean.discretize import edges, grid


def scene(size: float = 7.2, rise: float = 2.0, along: int = 6, twist: float = 0.35) -> Scene:
    """A grid of `along` by `along` quadrilaterals over a square of side `size` [m], on a doubly curved surface of a
    `rise` [m] with a `twist` [m]. Every node is held, so that each can be moved."""
    at = np.linspace(-1.0, 1.0, along + 1)
    mesh = grid(at, at)
    x, y = mesh.vertices[:, 0], mesh.vertices[:, 1]
    z = rise * (1.0 - 0.6 * x**2) * (1.0 - 0.5 * y**2) + twist * x * y**2
    points = np.stack([x * size / 2, y * size / 2, z], axis=1)
    return Scene(
        particles=points,
        meshes={"shell": {"vertices": points, "faces": mesh.faces}},
        forces=[{"kind": "constant_tension", "name": "laths", "lines": points[edges(mesh)], "tension": 0.0}],
        anchors=[{"name": "nodes", "points": points}],
        geometry=[{"name": "shell", "kind": "mesh", "mesh": "shell"}],
    )


def problem(shortest: float = 1.1, longest: float = 1.35, **given: Any) -> dict[str, Any]:
    """Which nodes near the surface make every face flat and every lath between `shortest` and `longest` [m]?"""
    made = scene(**given)
    stock = {"kind": "length", "force": "laths", "lower": shortest, "upper": longest, "weight": 1e6}
    return {
        "scene": made,
        "variables": [{"anchor": "nodes"}],
        "goals": [
            {"kind": "position", "particles": np.arange(len(made.particles)), "target": made.particles},
            {"kind": "planarity", "mesh": "shell", "target": 0.0, "weight": 1e6},
            stock,
        ],
    }
