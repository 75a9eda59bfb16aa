"""Figure 9.28: a net of rest factor 0 and a soap film in the frame of a hypar, z = x y."""

import numpy as np

from hookean import Scene
from hookean.discretize import edges, grid, naked_vertices


def scene(
    size: float = 2.0, divisions: int = 32, film: bool = False, tension: float = 100.0, rest_factor: float = 0.0,
    bulge: float = 0.5,
) -> Scene:  # fmt: skip
    """A square of a `size` [m] whose rim is held, in halves of its size, at z = x y.

    It has `divisions` by as many faces and starts with a `bulge` in its middle, in halves of its size [-]. A `film` has
    its `tension` [N/m]; a net has edges of that stiffness and a `rest_factor` [-].
    """
    half = 0.5 * size
    steps = np.linspace(-half, half, divisions + 1)
    t = steps / half
    hollow = (1.0 - t[:, None] ** 2) * (1.0 - t[None, :] ** 2)
    mesh = grid(steps, steps, half * (t[:, None] * t[None, :] + bulge * hollow))
    net = {"kind": "springs", "name": "net", "particles": edges(mesh), "stiffness": tension, "rest_factor": rest_factor}
    soap = {"kind": "soapfilm", "name": "film", "mesh": "surface", "tension": tension}
    return Scene(
        particles=mesh.vertices,
        meshes={"surface": {"vertices": mesh.vertices, "faces": mesh.faces}},
        forces=[soap if film else net],
        anchors=[{"name": "frame", "particles": naked_vertices(mesh)}],
        geometry=[{"name": "surface", "kind": "mesh", "mesh": "surface"}],
        settings={"tolerance": 1e-8 if film else 1e-12},
    )
