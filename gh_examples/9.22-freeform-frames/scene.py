"""Figure 9.22: chains hang between two free-form frames."""

from pathlib import Path
from typing import Any

import numpy as np

from hookean import Scene
from hookean.discretize import divide
from hookean.files.rhino import threedm


def scene(
    near_frame: Any = None, far_frame: Any = None, chains: int = 48, links: int = 24, length_factor: float = 1.2,
    stiffness: float = 1e6, load: float = 1.0,
) -> Scene:  # fmt: skip
    """Chains between points at equal lengths on two frames, curves of rhino3dm or COMPAS [m], without them those of
    model.3dm; where both are closed, their starts are one point with their ends.

    Each chain has `links` of a `stiffness` [N/m] and is `length_factor` [-] as long as its ends are apart; a `load` [N]
    down on every particle.
    """
    frames = drawn() if near_frame is None or far_frame is None else [near_frame, far_frame]
    near, far = (divide(frame, chains) for frame in frames)
    if all(np.allclose(side[0], side[-1]) for side in (near, far)):
        near, far = near[:-1], far[:-1]
    points = np.linspace(near, far, links + 1, axis=1)
    number = np.arange(points[..., 0].size).reshape(len(points), links + 1)
    springs = {"kind": "springs", "name": "chains",
               "particles": np.stack([number[:, :-1], number[:, 1:]], axis=-1).reshape(-1, 2),
               "stiffness": stiffness, "rest_factor": length_factor}  # fmt: skip
    return Scene(
        particles=points.reshape(-1, 3),
        forces=[springs, {"kind": "unary", "name": "weight", "particles": number.ravel(), "vector": [0.0, 0.0, -load]}],
        anchors=[{"name": "frames", "particles": np.concatenate([number[:, 0], number[:, -1]])}],
        settings={"tolerance": 1e-9},
    )


def drawn() -> list[Any]:
    """The frames in model.3dm."""
    return [o.geometry for o in threedm.read(Path(__file__).parent / "model.3dm").objects if o.layer == "frames"]
