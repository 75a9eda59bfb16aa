"""Circles packed in a round boundary: spheres that collide in a plane, and stay near a centre."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from hookean import Scene

APART = 2.0  # m between two boundaries
GOLDEN = np.pi * (3.0 - np.sqrt(5.0))  # rad


def scene(
    counts: Sequence[int] = (7, 19, 91), boundaries: Sequence[float] = (2.97, 4.8, 10.5), radius: float = 1.0,
    stiffness: float = 1e4, **settings: Any,
) -> Scene:  # fmt: skip
    """Packings side by side along x, of `counts` circles of a `radius` [m] in round boundaries of the radii
    `boundaries` [m]; contacts of a `stiffness` [N/m].

    Each boundary is a limit on the distance of its circles from its centre.
    """
    centres = centres_of(boundaries)
    starts = [sunflower(n, size - radius) + c for n, size, c in zip(counts, boundaries, centres, strict=True)]
    circles = len(counts) + np.arange(sum(counts))
    lines = np.column_stack([np.arange(len(counts)).repeat(counts), circles])
    limits = np.repeat(np.asarray(boundaries, float) - radius, counts)
    return Scene(
        particles=np.concatenate([centres, *starts]),
        forces=[
            {"kind": "collide", "name": "circles", "particles": circles, "radius": radius, "strength": stiffness},
            {"kind": "clamp_length", "name": "boundary", "particles": lines, "upper_limit": limits,
             "stiffness": stiffness},
        ],
        anchors=[
            {"name": "centres", "particles": np.arange(len(counts))},
            {"name": "plane", "particles": circles, "axes": "z"},
        ],
        settings={"tolerance": 1e-9, **settings},
    )  # fmt: skip


def centres_of(boundaries: Sequence[float]) -> np.ndarray:
    """Centres (n, 3) [m] of boundaries along x, the first at the origin."""
    size = np.asarray(boundaries, float)
    steps = size[:-1] + APART + size[1:]
    return np.cumsum([0.0, *steps])[:, None] * [1.0, 0.0, 0.0]


def sunflower(count: int, reach: float) -> np.ndarray:
    """Points (count, 3) [m] spread evenly over a disc of radius `reach` [m]: each a golden angle after the last."""
    i = np.arange(count)
    out = reach * np.sqrt((i + 0.5) / count)
    return np.column_stack([out * np.cos(GOLDEN * i), out * np.sin(GOLDEN * i), 0.0 * i])
