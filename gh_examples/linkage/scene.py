"""A linkage that draws a straight line: bars, and a rigid body of three joints."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from hookean import Scene

CRANK, BAR, BASE = 1.0, 2.5, 2.0  # m: Chebyshev's proportions
DRAWN = 180.0  # degrees


def scene(
    angles: Sequence[float] = (90.0, 135.0, 180.0, 225.0, 270.0), weight: float = 10.0, stiffness: float = 1e7,
    apart: float = 1.0, **settings: Any,
) -> Scene:  # fmt: skip
    """Chebyshev's linkages side by side, `apart` [m], drawn with the crank at 180 degrees and turned to `angles`
    [degrees], with a `weight` [N] at the pen.

    Crank and rocker are bars of a `stiffness` [N/m]; crank end, rocker end and pen are one rigid body.
    """
    count = len(angles)
    place = np.arange(count)[:, None] * [0.0, apart, 0.0]
    x = np.concatenate([joints(DRAWN) + offset for offset in place])
    at = 5 * np.arange(count)[:, None]  # ground, crank end, rocker end, ground, pen
    turned = np.array([joints(angle)[1] for angle in angles]) + place
    grounds, cranks = (at + [0, 3]).ravel(), (at + 1).ravel()
    bodies = (at + [1, 2, 4]).ravel()
    return Scene(
        particles=x,
        forces=[
            {"kind": "springs", "name": "bars", "particles": np.concatenate([at + [0, 1], at + [2, 3]]),
             "stiffness": stiffness},
            {"kind": "rigid_body", "name": "couplers", "particles": bodies, "group": np.arange(count).repeat(3),
             "strength": stiffness},
            {"kind": "unary", "name": "weight", "particles": (at + 4).ravel(), "vector": [0.0, 0.0, -weight]},
        ],
        anchors=[
            {"name": "ground", "particles": grounds},
            {"name": "crank", "particles": cranks, "targets": turned},
            {"name": "plane", "particles": (at + [2, 4]).ravel(), "axes": "y"},
        ],
        geometry=[{"name": f"coupler {i}", "kind": "polyline", "particles": 5 * i + np.array([1, 2, 4])}
                  for i in range(count)],
        settings={"tolerance": 1e-9, **settings},
    )  # fmt: skip


def joints(angle: float) -> np.ndarray:
    """Ground, crank end, rocker end, ground, pen (5, 3) [m] for a crank angle [degrees]: the rocker end is where two
    circles meet, the pen as far beyond it as the crank end before it."""
    turn = np.radians(angle)
    one, other = np.zeros(2), np.array([BASE, 0.0])
    crank = CRANK * np.array([np.cos(turn), np.sin(turn)])
    half = 0.5 * (other - crank)
    up = np.array([-half[1], half[0]]) / np.linalg.norm(half)
    rocker = crank + half + np.sqrt(BAR**2 - half @ half) * up
    plane = np.array([one, crank, rocker, other, 2.0 * rocker - crank])
    return np.column_stack([plane[:, 0], np.zeros(5), plane[:, 1]])
