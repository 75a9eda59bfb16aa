"""Figures 9.17 to 9.20: an arc whose springs hardly stretch becomes a catenary."""

from typing import Any

import numpy as np

from hookean import Scene
from hookean.discretize import arc_of_length


def scene(
    arc_length: float = 20.0, span: float = 10.0, pieces: int = 50, stiffness: float = 7000.0,
    rest_factor: float = 0.995, load: float = 1.0, by_arc_length: bool = False, **settings: Any,
) -> Scene:  # fmt: skip
    """An arc of `arc_length` [m] that stands over a `span` [m], a straight line where both are the same, in `pieces`
    springs at equal arc lengths.

    Each has a `stiffness` [N/m] and as rest length `rest_factor` [-] of its chord, or `by_arc_length` of its part of
    the arc; a `load` [N] down on every particle.
    """
    springs = {"kind": "springs", "name": "cable", "particles": np.arange(pieces)[:, None] + [0, 1],
               "stiffness": stiffness, "rest_factor": rest_factor,
               "rest_length": arc_length / pieces if by_arc_length else None}  # fmt: skip
    weight = {"kind": "unary", "name": "load", "particles": np.arange(pieces + 1), "vector": [0.0, 0.0, -load]}
    return Scene(
        particles=arc_of_length(arc_length, span, pieces),
        forces=[springs, weight],
        anchors=[{"name": "A and B", "particles": [0, pieces]}],
        settings={"tolerance": 1e-12, **settings},
    )
