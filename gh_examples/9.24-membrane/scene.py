"""Figures 9.23 to 9.25: a square becomes a net, which hangs from its corners."""

from typing import Any

import numpy as np

from hookean import Scene
from hookean.discretize import corners, edges, grid, naked_vertices
from hookean.discretize import diagonals as diagonals_of
from hookean.values.mesh import Mesh


def scene(
    size: float = 10.0, divisions: int = 20, stiffness: float = 2000.0, rest_factor: float = 1.0, load: float = 20.0,
    held: str = "corners", anchors: Any = None, rise: float = 0.0, drop: float = 0.0, diagonals: str = "none",
    diagonal_stiffness: float = 1000.0, diagonal_factor: float = 1.0, **settings: Any,
) -> Scene:  # fmt: skip
    """A square of a `size` [m] in `divisions` by as many faces, their edges springs of a `stiffness` [N/m] and a
    `rest_factor` [-], with a `load` [N] down on every vertex.

    It is `held` at its "corners" or all along its "rim", or at `anchors`, points [m] on vertices. With `rise` or `drop`
    [m] two opposite corners go up and the other two down. `diagonals` "one" way, the "other" or "both" of each face are
    springs of their own.
    """
    mesh = square(size, divisions)
    nets = [net("membrane", edges(mesh), stiffness, rest_factor)]
    if diagonals != "none":
        nets.append(net("diagonals", diagonals_of(mesh, diagonals), diagonal_stiffness, diagonal_factor))
    where = led(mesh, rise, drop) if rise or drop else holds(mesh, held, anchors)
    return loaded(mesh, nets, load, where, **settings)


def square(size: float, divisions: int) -> Mesh:
    """A flat square [m] between the origin and (size, size) in quads."""
    steps = np.linspace(0.0, size, divisions + 1)
    return grid(steps, steps)


def net(name: str, pairs: Any, stiffness: float, rest_factor: float) -> dict[str, Any]:
    """Springs between pairs of particles."""
    return {"kind": "springs", "name": name, "particles": pairs, "stiffness": stiffness, "rest_factor": rest_factor}


def holds(mesh: Mesh, held: str, anchors: Any = None) -> dict[str, Any]:
    """The corners of a mesh, its rim, or the given points."""
    if anchors is not None:
        return {"name": "points", "points": anchors}
    return {"name": held, "particles": naked_vertices(mesh) if held == "rim" else corners(mesh)}


def led(mesh: Mesh, rise: float, drop: float) -> dict[str, Any]:
    """The corners of a square, two opposite ones led up and two down."""
    last = len(mesh.vertices) - 1
    side = round(len(mesh.vertices) ** 0.5) - 1
    four = [0, last, last - side, side]
    lifted = np.array([rise, rise, -drop, -drop])[:, None] * [0.0, 0.0, 1.0]
    return {"name": "corners", "particles": four, "targets": mesh.vertices[four] + lifted}


def loaded(mesh: Mesh, nets: list[dict[str, Any]], load: float, held: dict[str, Any], **settings: Any) -> Scene:
    """Nets over a mesh, which rides along, with a load down on every vertex."""
    where = np.arange(len(mesh.vertices))
    return Scene(
        particles=mesh.vertices,
        forces=[*nets, {"kind": "unary", "name": "load", "particles": where, "vector": [0.0, 0.0, -load]}],
        anchors=[held],
        meshes={"membrane": {"vertices": mesh.vertices, "faces": mesh.faces}},
        geometry=[{"name": "membrane", "kind": "mesh", "mesh": "membrane"}],
        settings={"tolerance": 1e-9, **settings},
    )
