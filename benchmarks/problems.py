"""The benchmark's problems, for any size, and the one measure that every solver is judged by.

Linear springs (force k (l - l0), compression allowed), loads on particles and fixed particles. The sizes of one
problem approximate one object: a cable keeps EA and its total weight (k grows, the load shrinks with its number of
segments), a net keeps k on each edge, which is what a continuous sheet does, and its total load.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

SIDES = {1_000: 31, 10_000: 99, 100_000: 315, 1_000_000: 999}
"""Faces along a side of a net of about so many particles."""


@dataclass(frozen=True)
class Problem:
    """Start positions `x` (n, 3), springs (m, 2) with `k` and `l0` (m,), `load` (n, 3) and the fixed particles."""

    name: str
    x: Floats
    springs: Ints
    k: Floats
    l0: Floats
    load: Floats
    fixed: Ints

    @property
    def free(self) -> NDArray[np.bool_]:
        """Which particles may move (n,)."""
        free = np.ones(len(self.x), dtype=bool)
        free[self.fixed] = False
        return free


def left_over(p: Problem, x: Floats) -> tuple[float, float]:
    """Largest out-of-balance force on a free particle, and the force it is measured by."""
    d = x[p.springs[:, 1]] - x[p.springs[:, 0]]
    length = np.linalg.norm(d, axis=1)
    tension = p.k * (length - p.l0)
    pull = d * (tension / np.where(length > 0, length, 1.0))[:, None]
    left = p.load.copy()
    for end, sign in ((0, 1.0), (1, -1.0)):
        for c in range(3):
            left[:, c] += np.bincount(p.springs[:, end], sign * pull[:, c], len(x))
    scale = max(float(np.linalg.norm(p.load, axis=1).mean()), float(np.abs(tension).mean()))
    return float(np.linalg.norm(left[p.free], axis=1).max()), scale


def residual(p: Problem, x: Floats) -> float:
    """Largest out-of-balance force by the larger of mean load and mean spring force [-]."""
    left, scale = left_over(p, x)
    return left / scale if np.isfinite(left) else float("inf")


def rounding(p: Problem, x: Floats) -> float:
    """The residual that rounding of the coordinates leaves in the exact answer, in the measure of `residual`."""
    stiffness = np.bincount(p.springs.ravel(), np.repeat(p.k, 2), len(x))
    _, scale = left_over(p, x)
    return float((stiffness * np.abs(x).max(axis=1)).max() * np.finfo(float).eps / 2.0 / scale)


def scene(p: Problem, solver: str = "auto", tolerance: float = 1e-6) -> Any:
    """The problem as a scene of hookean."""
    from hookean.scene.scene import Scene

    springs = {"kind": "springs", "particles": p.springs, "stiffness": p.k, "rest_length": p.l0}
    loaded = np.flatnonzero(p.load.any(axis=1))
    loads = [{"kind": "unary", "particles": loaded, "vector": p.load[loaded]}] if len(loaded) else []
    return Scene.read(
        {
            "particles": p.x,
            "forces": [springs, *loads],
            "anchors": [{"particles": p.fixed}],
            "settings": {"solver": solver, "tolerance": tolerance},
        }
    )


def make(name: str, size: int) -> Problem:
    """A problem by name: a cable of `size` segments, or a net of about `size` particles."""
    return PROBLEMS[name](size if name == "cable" else SIDES.get(size, size))


def cable(segments: int) -> Problem:
    """An arc of length 20 and radius 10 between two ends, of slightly shortened springs, under its weight."""
    angle = np.linspace(-1.0, 1.0, segments + 1)
    x = np.column_stack([10.0 * np.sin(angle), np.zeros(segments + 1), 10.0 * (np.cos(angle) - np.cos(1.0))])
    springs = np.column_stack([np.arange(segments), np.arange(1, segments + 1)])
    part = 50.0 / segments
    load = np.zeros_like(x)
    load[:, 2] = -part
    return Problem("cable", x, springs, np.full(segments, 7000.0 / part), 0.995 * _lengths(x, springs), load,
                   np.array([0, segments]))  # fmt: skip


def membrane(side: int) -> Problem:
    """A square net of 10 x 10, unstressed, held at its corners, under a total load of 500."""
    x, at, springs = _net(side)
    return Problem("membrane", x, springs, _k(springs), _lengths(x, springs), _down(x, 500.0), _corners(at))


def sheet(side: int) -> Problem:
    """The membrane with both diagonals of each face, all springs shortened to 0.9."""
    x, at, springs = _net(side)
    crossed = [np.stack([at[:-1, :-1], at[1:, 1:]], -1), np.stack([at[1:, :-1], at[:-1, 1:]], -1)]
    springs = np.concatenate([springs, *(c.reshape(-1, 2) for c in crossed)])
    return Problem("sheet", x, springs, _k(springs), 0.9 * _lengths(x, springs), _down(x, 500.0), _corners(at))


def soapfilm(side: int) -> Problem:
    """A net of rest length 0 in a wavy frame; nothing loaded."""
    x, at, springs = _net(side)
    rim = np.unique(np.concatenate([at[0], at[-1], at[:, 0], at[:, -1]]))
    a, b = x[rim, 0], x[rim, 1]
    x[rim, 2] = a * b / 10.0 + 0.5 * np.sin(np.pi * (a + b) / 5.0)
    return Problem("soapfilm", x, springs, _k(springs), np.zeros(len(springs)), np.zeros_like(x), rim)


def tent(side: int) -> Problem:
    """A net of half its flat length, over four low corners and five inner supports, under a total load of 20."""
    x, at, springs = _net(side)
    l0 = 0.5 * _lengths(x, springs)
    low, middle, high = round(0.25 * side), round(0.5 * side), round(0.75 * side)
    inner = np.array([at[low, low], at[low, high], at[high, low], at[high, high], at[middle, middle]])
    fixed = np.concatenate([_corners(at), inner])
    x[fixed, 2] = [0.0, 2.0, 2.5, 0.5, 1.5, 0.5, 0.5, 1.5, 3.0]
    return Problem("tent", x, springs, _k(springs), l0, _down(x, 20.0), fixed)


PROBLEMS = {"cable": cable, "membrane": membrane, "soapfilm": soapfilm, "sheet": sheet, "tent": tent}


def _net(side: int) -> tuple[Floats, Ints, Ints]:
    along = np.linspace(-5.0, 5.0, side + 1)
    a, b = (c.ravel() for c in np.meshgrid(along, along, indexing="ij"))
    x = np.column_stack([a, b, np.zeros(len(a))])
    at = np.arange(len(x)).reshape(side + 1, side + 1)
    ways = (np.stack([at[:-1], at[1:]], -1), np.stack([at[:, :-1], at[:, 1:]], -1))
    return x, at, np.concatenate([way.reshape(-1, 2) for way in ways])


def _lengths(x: Floats, springs: Ints) -> Floats:
    return np.asarray(np.linalg.norm(x[springs[:, 1]] - x[springs[:, 0]], axis=1))


def _k(springs: Ints) -> Floats:
    return np.full(len(springs), 100.0)


def _down(x: Floats, total: float) -> Floats:
    load = np.zeros_like(x)
    load[:, 2] = -total / len(x)
    return load


def _corners(at: Ints) -> Ints:
    return at[[0, 0, -1, -1], [0, -1, 0, -1]]
