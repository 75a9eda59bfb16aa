"""Figure 9.1: a square membrane of particles and springs alone, held at its corners."""

import numpy as np

from hookean import Scene
from hookean.commands.examples import figure
from hookean.discretize import warp_weft

MEMBRANE = figure("9.24-membrane")


def scene(
    size: float = 8.0, divisions: int = 8, stiffness: float = 1000.0, rest_factor: float = 1.0, load: float = 5.0
) -> Scene:
    """The membrane of figure 9.24 without the mesh that rides along, its springs row by row: a `size` [m] in
    `divisions` by as many faces, a `stiffness` [N/m], a `rest_factor` [-], a `load` [N] down on every particle."""
    mesh = MEMBRANE.square(size, divisions)
    warp, weft = (pairs[np.lexsort(pairs.T[::-1])] for pairs in warp_weft(mesh))
    springs = MEMBRANE.net("membrane", np.concatenate([weft, warp]), stiffness, rest_factor)
    made = MEMBRANE.loaded(mesh, [springs], load, MEMBRANE.holds(mesh, "corners"), tolerance=1e-12)
    return made.model_copy(update={"meshes": {}, "geometry": ()})
