"""Figures 9.12 and 9.13: Hooke's law, a weight on a spring."""

from typing import Any

import numpy as np

from hookean import Scene


def scene(
    rest_length: float = 80.0, stiffness: float = 2.0, weight: Any = 100.0, damping: float = 10.0,
    length: float | None = None, **settings: Any,
) -> Scene:  # fmt: skip
    """A spring of `rest_length` [cm], `stiffness` [N/cm] and `damping` [N s/cm] hangs from an anchor, a `weight` [N] at
    its end; several weights hang on springs side by side, 30 cm apart. It starts with a `length` [cm], else its rest
    length."""
    weights = np.atleast_1d(weight)
    count = len(weights)
    tops = 30.0 * np.arange(count)[:, None] * [1.0, 0.0, 0.0]
    ends = tops - [0.0, 0.0, rest_length if length is None else length]
    springs = {"kind": "springs", "name": "cable", "particles": np.arange(count)[:, None] + [0, count],
               "stiffness": stiffness, "rest_length": rest_length, "damping": damping}  # fmt: skip
    loads = {"kind": "unary", "name": "weight", "particles": count + np.arange(count),
             "vector": -weights[:, None] * [0.0, 0.0, 1.0]}  # fmt: skip
    return Scene(
        units={"length": "cm"},
        particles=np.concatenate([tops, ends]),
        forces=[springs, loads],
        anchors=[{"name": "top", "particles": np.arange(count)}],
        settings={"tolerance": 1e-12, "drag": 0.0, "time_step": 0.01, "sub_iterations": 20, **settings},
    )
