"""What rests on floors: its motions along them, and where it only just touches or is about to slide."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from hookean.system.state import State
from hookean.system.system import System

Floats = NDArray[np.float64]

NEAR = 1e-7  # part of the model's size within which a particle touches a floor
FAINT = 1e-6  # part of the largest force: a floor that carries less only just touches
POINT, NORMAL, STICKS = slice(0, 3), slice(3, 6), 7  # columns of a floor's parameters


@dataclass
class Resting:
    """`motions` (k, 3) of each particle that a floor carries, by number: along the floor, none where friction holds it.
    `said`: sentences on kinks."""

    motions: dict[int, Floats] = field(default_factory=dict)
    said: list[str] = field(default_factory=list)


def resting(system: System, state: State) -> Resting:
    """The particles that floors carry at a shape at rest."""
    found = Resting()
    if not system.contacts:
        return found
    forces = system.evaluate(state)[0]
    scale, left = float(np.abs(forces).max(initial=0.0)), forces * state.free
    carried = system.support(state, left)
    planes = np.concatenate([group.block.parameters for group in system.contacts])
    normals = planes[:, NORMAL]
    heights = state.x[: system.slots.count] @ normals.T - (planes[:, POINT] * normals).sum(axis=1)
    for i in np.flatnonzero((heights <= NEAR * system.size).any(axis=1)):
        free, at = state.free[i] > 0.0, heights[i] <= NEAR * system.size
        presses = (
            at & (normals @ carried[i] > FAINT * scale) & (np.abs(normals[:, free]).max(axis=1, initial=0.0) > 0.0)
        )
        if (at & ~presses).any() and free.any():
            found.said.append(f"floor: particle {i} only just touches; derivatives hold on one side")
        if not presses.any():
            continue
        rough = bool((planes[presses, STICKS] > 0.0).any())
        stuck = rough and not left[i].any()
        if rough and not stuck:
            found.said.append(f"floor: particle {i} is at the limit of friction; derivatives are those of sliding")
        found.motions[int(i)] = np.zeros((0, 3)) if stuck else _along(normals[presses], free)
    return found


def _along(normals: Floats, free: NDArray[np.bool_]) -> Floats:
    """Unit motions (k, 3) on free axes at right angles to normals (m, 3)."""
    axes = np.eye(3)[free]
    _, sizes, turned = np.linalg.svd(normals @ axes.T)
    return np.asarray(turned[int((sizes > 1e-9).sum()) :] @ axes)
