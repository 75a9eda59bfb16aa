"""Rods for tests: drawn shapes, bars and corners, and what to ask of them."""

from __future__ import annotations

from typing import Any

import numpy as np

from hookean import Scene
from hookean.running.run import relax_state
from hookean.solvers import solver
from hookean.system.system import compile

RISE, AXIAL = 0.05, 1e4
RADIUS = (0.25 + RISE**2) / (2 * RISE)
SLOPE = float(np.arcsin(0.5 / RADIUS))
"""A shallow arch of span 1: its rise, axial stiffness, radius, and slope at its ends."""


def corners_of(count: int, *, closed: bool = False) -> np.ndarray:
    """Corners of a row of particles."""
    i = np.arange(count)
    return (np.column_stack([i, i + 1, i + 2]) % count)[: count if closed else count - 2]


def rod(x: np.ndarray, axial: float, *, closed: bool = False, **bend: Any) -> list[dict[str, Any]]:
    """Bars of axial stiffness EA [force] of their start length, and corners of EI = 1."""
    pairs = corners_of(len(x) + (not closed), closed=closed)[:, :2] % len(x)
    length = np.linalg.norm(x[pairs[:, 1]] - x[pairs[:, 0]], axis=1)
    return [
        {"kind": "springs", "particles": pairs, "stiffness": axial / length, "damping": 0.0},
        {"kind": "bend", "particles": corners_of(len(x), closed=closed), **bend},
    ]


def arch(n: int) -> np.ndarray:
    """A shallow circular arch of span 1 in the XZ plane, its ends on the X axis."""
    turn = np.linspace(-SLOPE, SLOPE, n + 1)
    return np.column_stack([RADIUS * np.sin(turn), np.zeros(n + 1), RADIUS * (np.cos(turn) - np.cos(SLOPE))])


def bending(x: np.ndarray, shape: np.ndarray, held: list[int], **bend: Any) -> float:
    """Energy of a rod drawn at x, in another shape."""
    system = compile(Scene(particles=x, forces=[rod(x, 1.0, **bend)[1]], anchors=[{"particles": held}] if held else []))
    state = system.start()
    state.x = np.ascontiguousarray(shape)
    return float(system.evaluate(state)[2].sum())


def coil(n: int = 60, turns: float = 3.0, pitch: float = 0.1) -> np.ndarray:
    """A helix of radius 1."""
    turn = np.linspace(0.0, 2 * np.pi * turns, n + 1)
    return np.column_stack([np.cos(turn), np.sin(turn), pitch * turn])


def apart(x: np.ndarray) -> np.ndarray:
    """Distances between all particles: what a rigid motion keeps."""
    return np.asarray(np.linalg.norm(x[:, None] - x, axis=2))


def shaken(scene: Scene, amount: float) -> Any:
    """The scene's equilibrium from a shape away from the drawn one."""
    system = compile(scene)
    state = system.start()
    state.x += amount * np.random.default_rng(5).uniform(-1, 1, state.x.shape) * state.free
    return relax_state(system, state, solver(scene.settings.solver))


def several() -> dict[str, tuple[np.ndarray, np.ndarray, list[int]]]:
    """Rods of all kinds: drawn shape, corners, held particles."""
    ring = np.column_stack([np.cos(0.6 * np.pi * np.arange(10) / 3), np.sin(0.6 * np.pi * np.arange(10) / 3)])
    ring = np.column_stack([ring, 0.3 * np.sin(0.4 * np.pi * np.arange(10))])
    row = corners_of(12)
    mixed = np.vstack([corners_of(5), 5 + corners_of(7), [[1, 2, 6]]])
    return {
        "free": (coil(11), row, []),
        "held at its start": (coil(11), row, [0]),
        "held at its end": (coil(11), row, [11]),
        "held at both ends": (coil(11), row, [0, 11]),
        "closed": (ring, corners_of(10, closed=True), []),
        "two and a corner between them": (coil(11, 1.0, 0.2), mixed, [4]),
        "one corner, held": (coil(2, 0.4), corners_of(3), [0, 2]),
    }
