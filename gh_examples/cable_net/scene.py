"""A cable net between four corners: its form by force densities, then cables of steel under snow."""

from typing import Any

import numpy as np

from hookean import Scene, relax
from hookean.discretize import edges, grid, on_boundary
from hookean.values.mesh import Mesh


def scene(snow: float = 0.6, net_steel: float = 10_000.0, edge_steel: float = 300_000.0, **parameters: Any) -> Scene:
    """The net of `form(**parameters)` of cables that are `net_steel` and `edge_steel` [kN] stiff (EA), as tense as
    their force densities make them, under `snow` [kN/m2] of plan.

    Each cable is cut so that it has its tension T at its length L in the form: L0 = L / (1 + T / EA), k = EA / L0.
    """
    found = form(**parameters)
    x = relax(found).particles
    springs = []
    for force, steel in zip(found.forces, (net_steel, edge_steel), strict=True):
        pairs = force.particles
        length = np.linalg.norm(x[pairs[:, 1]] - x[pairs[:, 0]], axis=1)
        cut = length / (1.0 + force.stiffness * length / steel)
        springs.append({"kind": "springs", "name": force.name, "particles": pairs, "stiffness": steel / cut,
                        "rest_length": cut})  # fmt: skip
    faces = found.meshes["net"].faces
    load = {"kind": "unary", "name": "snow", "particles": np.arange(len(x)), "vector": -snow * plan(x, faces)}
    mesh = {"net": {"vertices": x, "faces": faces}}
    return found.model_copy(update={"particles": x, "meshes": mesh, "forces": [*springs, load]})


def form(
    divisions: int = 12, side: float = 12.0, rise: float = 4.0, density: float = 10.0, edge_density: float = 150.0,
    **settings: Any,
) -> Scene:  # fmt: skip
    """A net of `divisions` meshes a side over a square of a `side` [m], two of its corners `rise` [m] over the others.

    Cables have a constant force per length: `density` in the net, `edge_density` [kN/m] along its edges.
    """
    mesh = drawn(divisions, side, rise)
    pairs = edges(mesh)
    rim = on_boundary(mesh, pairs)
    count = divisions + 1
    cables = (("net", pairs[~rim], density), ("edges", pairs[rim], edge_density))
    return Scene(
        units={"force": "kN"},
        particles=mesh.vertices,
        meshes={"net": {"vertices": mesh.vertices, "faces": mesh.faces}},
        forces=[
            {"kind": "springs", "name": name, "particles": of, "stiffness": q, "rest_factor": 0.0}
            for name, of, q in cables
        ],
        anchors=[{"name": "corners", "particles": [0, divisions, count * divisions, count * count - 1]}],
        geometry=[{"name": "net", "kind": "mesh", "mesh": "net"}],
        settings={"tolerance": 1e-10, **settings},
    )


def drawn(divisions: int, side: float, rise: float) -> Mesh:
    """The grid as it is drawn: a hyperbolic paraboloid on straight edges."""
    along = np.linspace(0.0, 1.0, divisions + 1)
    u, v = np.meshgrid(along, along, indexing="ij")
    return grid(side * along, side * along, rise * (u * v + (1.0 - u) * (1.0 - v)))


def plan(x: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """Upward vectors (n, 3) [m2]: a quarter of the plan of each face on each of its corners."""
    area = 0.5 * np.abs(np.cross(x[faces[:, 2]] - x[faces[:, 0]], x[faces[:, 3]] - x[faces[:, 1]])[:, 2])
    total = np.zeros((len(x), 3))
    np.add.at(total[:, 2], faces.ravel(), np.repeat(area / 4.0, 4))
    return total
