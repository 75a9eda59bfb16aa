"""What rests on floors: its motions along them, and where it only just touches, is about to slide, or is held by
friction where the way to its rest has led it: there the shape depends on the path, and no equation of equilibrium has
its derivatives."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from hookean.forces.base import lengths
from hookean.system.state import State
from hookean.system.system import System

Floats = NDArray[np.float64]

NEAR = 1e-7  # part of the model's size within which a particle touches a floor
FAINT = 1e-6  # part of the largest force: a floor that carries less only just touches
STAYED = 1e-9  # part of the model's size: what moved less has been held from the start
POINT, NORMAL, STICKS = slice(0, 3), slice(3, 6), 7  # columns of a floor's parameters

TOUCHES = "only just touches; derivatives hold on one side"
SLIDES = "is at the limit of friction; derivatives are those of sliding"
STUCK = "is held by friction at a place that depends on its path; derivatives hold it there, and leave out the path"


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
    touching, sliding, stuck_at = [], [], []
    normals = planes[:, NORMAL]
    heights = state.x[: system.slots.count] @ normals.T - (planes[:, POINT] * normals).sum(axis=1)
    for i in np.flatnonzero((heights <= NEAR * system.size).any(axis=1)):
        free, at = state.free[i] > 0.0, heights[i] <= NEAR * system.size
        presses = (
            at & (normals @ carried[i] > FAINT * scale) & (np.abs(normals[:, free]).max(axis=1, initial=0.0) > 0.0)
        )
        if (at & ~presses).any() and free.any():
            touching.append(i)
        if not presses.any():
            continue
        rough = bool((planes[presses, STICKS] > 0.0).any())
        stuck = rough and not left[i].any()
        if rough and not stuck:
            sliding.append(i)
        if stuck:
            stuck_at.append(i)
        found.motions[int(i)] = np.zeros((0, 3)) if stuck else _along(normals[presses], free)
    moved = lengths(state.x[stuck_at] - system.start().x[stuck_at]) if stuck_at else np.zeros(0)
    stopped = np.asarray(stuck_at)[moved > STAYED * system.size].tolist() if stuck_at else []
    found.said = [_sentence(*each) for each in ((touching, TOUCHES), (sliding, SLIDES), (stopped, STUCK)) if each[0]]
    return found


def _sentence(particles: list[int], what: str) -> str:
    more = f" (and {len(particles) - 1} more)" if len(particles) > 1 else ""
    return f"floor: particle {particles[0]}{more} {what}"


def _along(normals: Floats, free: NDArray[np.bool_]) -> Floats:
    """Unit motions (k, 3) on free axes at right angles to normals (m, 3)."""
    axes = np.eye(3)[free]
    _, sizes, turned = np.linalg.svd(normals @ axes.T)
    return np.asarray(turned[int((sizes > 1e-9).sum()) :] @ axes)
