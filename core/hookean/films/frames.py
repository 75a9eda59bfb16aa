"""Frames: the axes of particles along which forces count, as kernels."""

from __future__ import annotations

from typing import Any

import numpy as np

from hookean.compiled.marks import device
from hookean.forces.soapfilm import plane

FOLDED = 0.1  # part of the areas around a particle below which their sum is no normal
STEEP = 0.02  # part of a normal on the free axes below which motion on these leaves the film where it is
TURN = 0.5  # cosine of the turn from which on an edge has a corner
SLANT = 1e-6  # part of an edge's direction on held axes that may be rounding


def lay_frames(x, free, corners, signs, kind, ends, room, axes, counts):  # type: ignore[no-untyped-def]
    """Write `axes` and `counts`. Room (n, 5): sums of areas as vectors and as numbers, and whether
    a face there is folded over or has no area."""
    room[:] = 0.0
    g, n = np.zeros((3, 3)), np.zeros(3)
    for t in range(corners.shape[0]):
        area = plane(x, corners, t, g, n)
        for i in range(3):
            a = corners[t, i]
            room[a, 3] += area
            for k in range(3):
                room[a, k] += signs[t, i] * area * n[k]
    for t in range(corners.shape[0]):
        plane(x, corners, t, g, n)
        flat = n[0] != 0.0 or n[1] != 0.0 or n[2] != 0.0
        for i in range(3):
            a = corners[t, i]
            facing = signs[t, i] * (n[0] * room[a, 0] + n[1] * room[a, 1] + n[2] * room[a, 2])
            if not flat or facing < 0.0:
                room[a, 4] = 1.0
    for a in range(x.shape[0]):
        held = 0
        for i in range(3):
            held += free[a, i] == 0.0
            counts[a, i] = free[a, i]
            for k in range(3):
                axes[a, i, k] = 1.0 if i == k else 0.0
        if kind[a] == 2 and held < 3:
            within(room[a], free[a], held, axes[a], counts[a])
        elif kind[a] != 0 and held < 3:
            turn = TURN if kind[a] == 1 else -2.0
            along_edge(x[ends[a, 0]], x[a], x[ends[a, 1]], turn, free[a], held, axes[a], counts[a])


@device
def within(normal: Any, free: Any, held: Any, axes: Any, counts: Any) -> None:
    """The one direction that counts within a film: the normal, or what of it is free."""
    size = np.sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2])
    if not size > FOLDED * normal[3] or normal[4] > 0.0:
        return
    square = 0.0
    for k in range(3):
        part = normal[k] / size * free[k]
        square += part * part
        counts[k] = 0.0
    if held > 0 and not square > STEEP * STEEP:
        return
    counts[0] = 1.0
    for k in range(3):
        axes[0, k] = normal[k] / size * free[k] / np.sqrt(square)
    complete(axes)


@device
def along_edge(before: Any, here: Any, after: Any, turn: Any, free: Any, held: Any, axes: Any, counts: Any) -> None:
    """The directions that count at an edge: those across it that are free."""
    one, two, dot, whole = 0.0, 0.0, 0.0, 0.0
    for k in range(3):
        one += (here[k] - before[k]) * (here[k] - before[k])
        two += (after[k] - here[k]) * (after[k] - here[k])
        dot += (here[k] - before[k]) * (after[k] - here[k])
        whole += (after[k] - before[k]) * (after[k] - before[k])
    if not (dot > turn * np.sqrt(one) * np.sqrt(two) and whole > 0.0):
        return
    size = np.sqrt(whole)
    for k in range(3):
        if free[k] == 0.0 and np.abs(after[k] - before[k]) > SLANT * size:
            return  # it cannot move along the edge
    for k in range(3):
        axes[0, k] = (after[k] - before[k]) / size
    complete(axes)
    counts[0] = 0.0
    counts[1] = 1.0 if held < 2 else 0.0
    counts[2] = 1.0 if held < 1 else 0.0
    if held > 0:  # a held axis is at right angles to the edge
        h = 0 if free[0] == 0.0 else 1 if free[1] == 0.0 else 2
        for i in range(3):
            axes[2, i] = 1.0 if i == h else 0.0
        for i in range(3):
            j, k = (i + 1) % 3, (i + 2) % 3
            axes[1, i] = axes[2, j] * axes[0, k] - axes[2, k] * axes[0, j]


@device
def complete(axes: Any) -> None:
    """Two more axes at right angles to the first."""
    least = 0
    for i in range(1, 3):
        if np.abs(axes[0, i]) < np.abs(axes[0, least]):
            least = i
    size = np.sqrt(1.0 - axes[0, least] * axes[0, least])
    for k in range(3):
        axes[1, k] = ((1.0 if k == least else 0.0) - axes[0, least] * axes[0, k]) / size
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        axes[2, i] = axes[0, j] * axes[1, k] - axes[0, k] * axes[1, j]


def keep_what_counts(axes, counts, kind, f):  # type: ignore[no-untyped-def]
    """Take from f what lies along axes that do not count."""
    for a in range(f.shape[0]):
        if kind[a] == 0:
            continue
        x, y, z = f[a, 0], f[a, 1], f[a, 2]
        for k in range(3):
            f[a, k] = 0.0
        for i in range(3):
            part = counts[a, i] * (axes[a, i, 0] * x + axes[a, i, 1] * y + axes[a, i, 2] * z)
            for k in range(3):
                f[a, k] += part * axes[a, i, k]
