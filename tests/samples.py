"""Scenes that several test files start from."""

from __future__ import annotations

from hookean import Scene


def cable(**settings: object) -> Scene:
    """Figure 9.11: span 10, five springs of length 2, loads of -20 z on all six particles, both ends held."""
    return Scene(
        particles=[[2.0 * i, 0.0, 0.0] for i in range(6)],
        forces=[
            {"kind": "springs", "name": "cable", "particles": [[i, i + 1] for i in range(5)], "stiffness": 1000},
            {"kind": "unary", "particles": list(range(6)), "vector": [0, 0, -20]},
        ],
        anchors=[{"name": "ends", "particles": [0, 5]}],
        settings=settings,
    )
