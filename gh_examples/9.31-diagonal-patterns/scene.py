"""Figure 9.31: the membrane of figure 9.24 with diagonals one way (A) or the other (B); warp and weft (C)."""

from functools import partial
from typing import Any

from hookean import Scene
from hookean.commands.examples import figure
from hookean.discretize import warp_weft

MEMBRANE = figure("9.24-membrane")

scene = partial(MEMBRANE.scene, divisions=10, diagonals="one")


def warp_and_weft(
    size: float = 10.0, divisions: int = 10, warp_stiffness: float = 4000.0, warp_factor: float = 0.9,
    weft_stiffness: float = 1000.0, weft_factor: float = 1.1, load: float = 20.0, held: str = "corners",
    anchors: Any = None,
) -> Scene:  # fmt: skip
    """C: a membrane whose edges along x, the warp, and along y, the weft, differ in stiffness [N/m] and rest factor
    [-]; the rest as in `scene`."""
    mesh = MEMBRANE.square(size, divisions)
    warp, weft = warp_weft(mesh)
    nets = [
        MEMBRANE.net("warp", warp, warp_stiffness, warp_factor),
        MEMBRANE.net("weft", weft, weft_stiffness, weft_factor),
    ]
    return MEMBRANE.loaded(mesh, nets, load, MEMBRANE.holds(mesh, held, anchors))
