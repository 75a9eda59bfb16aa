"""A chain that hangs from two nails, released at one of them."""

from typing import Any

import numpy as np

from hookean import Scene


def scene(
    length: float = 10.0, apart: float = 1.2, links: int = 40, stiffness: float = 4e5, gravity: float = 9.81,
    **settings: Any,
) -> Scene:  # fmt: skip
    """A chain of a `length` [m] in `links`, 1 kg on each particle, at rest between nails that are `apart` [m]; at
    the start the second nail is gone. Links are springs of a `stiffness` [N/m]; nothing damps the motion."""
    count = np.arange(links)
    motion = {"solver": "yoshida", "time_step": 1e-4, "sub_iterations": 100, "drag": 0.0}
    return Scene(
        particles=hung(length, apart, links, gravity, stiffness),
        forces=[
            {"kind": "springs", "name": "chain", "particles": np.column_stack([count, count + 1]),
             "stiffness": stiffness, "damping": 0.0, "rest_length": length / links},
            {"kind": "unary", "name": "gravity", "particles": np.arange(links + 1), "vector": [0.0, 0.0, -gravity]},
        ],
        anchors=[{"name": "nail", "particles": [0]}],
        settings={**motion, **settings},
    )  # fmt: skip


def hung(length: float, apart: float, links: int, weight: float, stiffness: float) -> np.ndarray:
    """Particles (links + 1, 3) [m] of a chain at rest between two nails, the first at the origin: the horizontal pull
    is the same in all links, the vertical one grows by the `weight` [N] of a link from one to the next."""
    up = weight * (np.arange(links) - 0.5 * (links - 1))
    low, high = 0.0, weight * links

    def steps(pull: float) -> np.ndarray:
        tension = np.hypot(pull, up)
        return (length / links / tension + 1.0 / stiffness)[:, None] * np.column_stack([pull + 0.0 * up, 0.0 * up, up])

    for _ in range(200):
        pull = 0.5 * (low + high)
        low, high = (pull, high) if steps(pull)[:, 0].sum() < apart else (low, pull)
    return np.concatenate([np.zeros((1, 3)), np.cumsum(steps(low), axis=0)])
