"""Scenes of bars that several tests analyse."""

from __future__ import annotations

from typing import Any

import numpy as np

from hookean import Scene

Spec = dict[str, Any]


def chain(count: int) -> np.ndarray:
    return np.column_stack([np.arange(count), np.arange(1, count + 1)])


def string(masses: int = 9, tension: float = 5.0, spacing: float = 0.3, mass: float = 2.0) -> Spec:
    """A string of springs that carry a tension, between two anchors."""
    x = np.zeros((masses + 2, 3))
    x[:, 0] = np.arange(masses + 2) * spacing
    k = 1e4 / spacing
    springs = {"kind": "springs", "particles": chain(masses + 1), "stiffness": k, "rest_length": spacing - tension / k}
    return {"particles": x, "masses": mass, "forces": [springs], "anchors": [{"particles": [0, masses + 1]}]}


def truss(half: float, rise: float, stiffness: float = 100.0) -> Scene:
    """Von Mises' truss of two bars in the plane x z."""
    springs = {"kind": "springs", "particles": [[0, 1], [1, 2]], "stiffness": stiffness}
    load = {"kind": "unary", "particles": [1], "vector": [0, 0, -1.0]}
    return Scene.read(
        {
            "particles": [[-half, 0, 0], [0, 0, rise], [half, 0, 0]],
            "forces": [springs, load],
            "anchors": [{"particles": [0, 2]}, {"particles": [1], "axes": "y"}],
            "settings": {"tolerance": 1e-10},
        }
    )
