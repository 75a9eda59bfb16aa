"""A cable whose links are found: joints above one another in equal steps, and a sag in the middle."""

from typing import Any

import numpy as np

from hookean import Scene


def scene(span: float = 10.0, sag: float = 1.5, links: int = 20, load: float = 2.0, stiffness: float = 1e4) -> Scene:
    """A cable over a `span` [m] in an even number of `links` of a `stiffness` [kN/m], each 3 % longer than its part of
    the span, with a `load` [kN] on each joint; drawn with a `sag` [m]."""
    x = np.linspace(0.0, span, links + 1)
    drawn = np.stack([x, 0.0 * x, -4.0 * sag * (x / span) * (1.0 - x / span)], axis=1)
    cable = {"kind": "springs", "name": "cable", "particles": np.arange(links)[:, None] + [0, 1],
             "stiffness": stiffness, "rest_length": 1.03 * span / links}  # fmt: skip
    return Scene(
        units={"force": "kN"},
        particles=drawn,
        forces=[cable, {"kind": "unary", "name": "load", "particles": np.arange(1, links), "vector": [0, 0, -load]}],
        anchors=[{"name": "ends", "particles": [0, links]}],
    )


def problem(sag: float = 1.5, **given: Any) -> dict[str, Any]:
    """Which lengths of the links put the joints in equal steps and the middle one `sag` [m] below the ends?"""
    made = scene(sag=sag, **given)
    joints = np.arange(1, len(made.particles) - 1)
    return {
        "scene": made,
        "variables": [{"force": "cable", "field": "rest_length", "lower": 0.0}],
        "goals": [
            {"kind": "position", "particles": joints, "axes": "x", "target": made.particles[joints, 0]},
            {"kind": "position", "particles": [len(joints) // 2 + 1], "axes": "z", "target": -sag},
        ],
    }
