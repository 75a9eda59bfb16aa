"""Figure 9.4: a line cut into springs, a cable under its loads."""

from typing import Any

import numpy as np

from hookean import InputError, Scene


def scene(
    anchors: Any = ((0.0, 0.0, 0.0), (10.0, 0.0, 0.0)), pieces: int = 10, length_factor: float = 1.0,
    stiffness: float = 1000.0, load: float = 10.0, damping: float = 10.0, strict: bool = True, **settings: Any,
) -> Scene:  # fmt: skip
    """A straight cable from the first of its `anchors` [m] to the last; those between hold the particles they meet.

    `pieces` springs, each with `length_factor` [-] of its length as rest length, `stiffness` [N/m] and `damping`
    [N s/m] along it; a `load` [N] down on every particle. InputError where there are not two anchors, and from solving
    where `strict` and one meets no particle.
    """
    if len(anchors) < 2:
        raise InputError("anchors", "one anchor given; a cable needs two, one for each end")
    held: list[dict[str, Any]] = [{"name": "ends", "particles": [0, pieces]}]
    if len(anchors) > 2:
        held.append({"name": "between", "points": anchors[1:-1]})
    springs = {"kind": "springs", "name": "cable", "particles": np.arange(pieces)[:, None] + [0, 1],
               "stiffness": stiffness, "rest_factor": length_factor, "damping": damping}  # fmt: skip
    weight = {"kind": "unary", "name": "load", "particles": np.arange(pieces + 1), "vector": [0.0, 0.0, -load]}
    return Scene(
        particles=np.linspace(anchors[0], anchors[-1], pieces + 1),
        forces=[springs, weight],
        anchors=held,
        strict=strict,
        settings={"tolerance": 1e-12, **settings},
    )
