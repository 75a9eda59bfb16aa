"""Scenes of the chapter's statements: Hooke's spring, square meshes, arcs and cables, a falling sphere."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.optimize import brentq

from hookean import Scene


def hooke(load: float, damping: float = 10.0, length: float = 80.0, **more: Any) -> Scene:
    """Figure 9.13: a vertical spring of 80 cm, k = 2 N/cm; its end starts `length` below the anchor."""
    return Scene(
        units={"length": "cm"},
        particles=[[0, 0, 0], [0, 0, -length]],
        forces=[
            {"kind": "springs", "particles": [[0, 1]], "stiffness": 2, "rest_length": 80, "damping": damping},
            {"kind": "unary", "particles": [1], "vector": [0, 0, -load]},
        ],
        anchors=[{"particles": [0]}],
        settings={"tolerance": 1e-12, **more},
    )


def grid(count: int, height: Any) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Points, quads and rim of a square of 2 x 2 in count x count cells, z = height(x, y) on the rim, 0 inside."""
    line = np.linspace(-1.0, 1.0, count + 1)
    x = np.stack([*np.meshgrid(line, line, indexing="ij"), np.zeros((count + 1,) * 2)], axis=-1).reshape(-1, 3)
    number = np.arange((count + 1) ** 2).reshape(count + 1, count + 1)
    quads = np.stack([number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]], axis=-1).reshape(-1, 4)
    rim = np.unique(np.concatenate([number[0], number[-1], number[:, 0], number[:, -1]]))
    x[rim, 2] = height(x[rim, 0], x[rim, 1])
    return x, quads, rim


def arc(chord: float, chord_rest: bool) -> Scene:
    """Figures 9.18 to 9.21: an arc of length 20 over a chord, 50 equal pieces, k 7000, -1 z on every particle."""
    half = brentq(lambda a: chord * a - 20.0 * np.sin(a), 0.1, np.pi - 1e-9)
    angle = np.linspace(-half, half, 51)
    radius = 10.0 / half
    springs = {"stiffness": 7000, "rest_length": None if chord_rest else 0.4, "rest_factor": 0.995}
    return hung(
        np.stack([radius * np.sin(angle), 0 * angle, radius * (np.cos(angle) - np.cos(half))], axis=1), 1, springs
    )


def hung(points: np.ndarray, load: float, springs: dict[str, Any]) -> Scene:
    """A cable through points, its ends held, the same load on every particle."""
    count = len(points)
    pairs = [[i, i + 1] for i in range(count - 1)]
    return Scene(
        particles=points,
        forces=[
            {"kind": "springs", "particles": pairs, **springs},
            {"kind": "unary", "particles": list(range(count)), "vector": [0, 0, -load]},
        ],
        anchors=[{"particles": [0, count - 1]}],
        settings={"tolerance": 1e-12},
    )


def ball(shell: bool, stiffness: float = 5000.0, time_step: float = 0.002) -> Scene:
    """A sphere of radius 1 in 12 x 8 faces, half a metre above the floor, springs on edges and both diagonals, -10 N on
    every particle; with shell of strength 500, angle factor 1."""
    around, up = 12, 8
    turn, tilt = np.meshgrid(2 * np.pi * np.arange(around) / around, np.pi * np.arange(1, up) / up)
    rings = np.stack([np.sin(tilt) * np.cos(turn), np.sin(tilt) * np.sin(turn), -np.cos(tilt)], axis=-1)
    x = np.vstack([[[0, 0, -1]], rings.reshape(-1, 3), [[0, 0, 1]]]) + [0, 0, 1.5]
    number = 1 + np.arange(around * (up - 1)).reshape(up - 1, around)
    after = np.roll(number, -1, axis=1)
    quads = np.stack([number[:-1], after[:-1], after[1:], number[1:]], axis=-1).reshape(-1, 4)
    caps = [[0, b, a] for a, b in zip(number[0], after[0], strict=True)]
    caps += [[len(x) - 1, a, b] for a, b in zip(number[-1], after[-1], strict=True)]
    forces: list[dict[str, Any]] = [
        {"kind": "springs", "mesh": "ball", "edges": edges, "stiffness": stiffness} for edges in ("all", "diagonals")
    ]
    forces.append({"kind": "unary", "particles": list(range(len(x))), "vector": [0, 0, -10]})
    if shell:
        forces.append({"kind": "shell", "mesh": "ball", "strength": 500, "angle_factor": 1})
    return Scene(
        particles=x,
        meshes={"ball": {"vertices": x, "faces": [*quads.tolist(), *caps]}},
        forces=forces,
        settings={"solver": "verlet", "time_step": time_step, "floor": True},
    )
