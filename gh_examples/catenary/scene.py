"""Chains from a nail to rings that slide along rails without friction."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from hookean import Scene
from hookean.discretize import arc_of_length


def scene(
    angles: Sequence[float] = (90.0, 120.0, 75.0), span: float = 6.0, length: float = 10.0, links: int = 40,
    weight: float = 20.0, stiffness: float = 1e6, apart: float = 1.0, **settings: Any,
) -> Scene:  # fmt: skip
    """Chains of a `length` [m] in `links`, of a `weight` [N/m], side by side, `apart` [m]; each hangs from a nail, and
    from a ring on a rail through a point `span` [m] beside the nail, at one of the `angles` [degrees] to the ground.

    Links are springs, rails pull their rings back, both of a `stiffness` [N/m].
    """
    count = links + 1
    drawn = arc_of_length(length, span, links) * [1.0, 1.0, -1.0]  # it hangs
    place = np.arange(len(angles))[:, None, None] * [0.0, apart, 0.0]
    x = (drawn + place).reshape(-1, 3)
    first = count * np.arange(len(angles))
    pairs = (first[:, None] + np.arange(links)).ravel()[:, None] + [0, 1]
    rings, nails = first + links, first
    turn = np.radians(angles)
    rails = np.column_stack([np.cos(turn), 0.0 * turn, np.sin(turn)])
    return Scene(
        particles=x,
        forces=[
            {"kind": "springs", "name": "chains", "particles": pairs, "stiffness": stiffness,
             "rest_length": length / links},
            {"kind": "unary", "name": "weight", "particles": np.arange(len(x)),
             "vector": np.tile(shares(links), len(angles))[:, None] * [0.0, 0.0, -weight * length / links]},
            {"kind": "pull_to_line", "name": "rails", "particles": rings, "origin": x[rings], "direction": rails,
             "strength": stiffness},
        ],
        anchors=[{"name": "nails", "particles": nails}],
        settings={"tolerance": 1e-9, **settings},
    )  # fmt: skip


def shares(links: int) -> np.ndarray:
    """Of the weight of a link on each particle of a chain: half on its ends."""
    return np.r_[0.5, np.ones(links - 1), 0.5]
