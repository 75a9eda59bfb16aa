"""Stability: the largest time step an explicit scheme can take in a scene, told before it explodes."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.state import State
from hookean.system import System

Floats = NDArray[np.float64]


def critical_time_step(omega: float, damping_ratio: float = 0.0) -> float:
    """(2 / omega) (sqrt(1 + zeta^2) - zeta) [time]: the limit of central differences with explicit damping.

    `omega` [1/time] is the highest circular frequency, `damping_ratio` zeta [-] its part of critical damping. The
    `verlet` solver treats damping to second order and stays stable up to this step and a little beyond.
    """
    return 2.0 / omega * (np.sqrt(1.0 + damping_ratio**2) - damping_ratio) if omega > 0.0 else np.inf


def highest_mode(system: System, state: State) -> tuple[float, float]:
    """Highest circular frequency [1/time] of small vibrations about a state, and its damping ratio [-].

    From K u = omega^2 M u with every force's tangent stiffness, hinges included; zeta = u^T C u / (2 omega) with
    damping along springs and drag, u^T M u = 1. Held axes do not move.
    """
    from scipy.sparse.linalg import ArpackNoConvergence, eigsh

    matrix, free, scale = _scaled_stiffness(system, state)
    if matrix is None or matrix.shape[0] == 0 or matrix.nnz == 0:
        return 0.0, 0.0
    if matrix.shape[0] <= 60:
        values, vectors = np.linalg.eigh(matrix.toarray())
        top, mode = float(values[-1]), vectors[:, -1]
    else:
        start = 1.0 + 0.5 * np.sin(np.arange(matrix.shape[0]) * 12.9898)
        try:
            values, vectors = eigsh(matrix, k=1, which="LA", v0=start, tol=1e-6)
            top, mode = float(values[0]), vectors[:, 0]
        except ArpackNoConvergence:
            # the row bound is never too small
            return float(np.sqrt(abs(matrix).sum(axis=1).max())), 0.0
    if top <= 0.0:
        return 0.0, 0.0
    omega = float(np.sqrt(top))
    motion = np.zeros(state.x.size)
    motion[free] = mode * scale
    return omega, _damping(system, state, motion.reshape(state.x.shape)) / (2.0 * omega)


def stable_time_step(system: System, state: State) -> float:
    """The step [time] up to which explicit time stepping of this state is stable; infinite without stiffness."""
    return critical_time_step(*highest_mode(system, state))


def warning(system: System, state: State) -> str:
    """A sentence if the scene's time step is too large, with the step that would hold; else empty."""
    given = system.scene.settings.time_step
    _, w, _ = system.evaluate(state)
    bound = float(np.sqrt((w / system.mass).max())) if len(w) else 0.0
    # every mode is below this bound and its damping below that of springs alone: no need to look closer
    if not system.damped and given * bound < 2.0 * np.exp(-system.drag * given / system.mass.min()):
        return ""
    holds = stable_time_step(system, state)
    if given <= holds:
        return ""
    unit = system.scene.units.time
    return (
        f"/settings/time_step: {given:g} {unit} is too large for this stiffness, mass and damping; the motion will "
        f"explode. Steps up to {_down(holds):.4g} {unit} hold: use one of those, more mass or less stiffness"
    )


def _down(value: float) -> float:
    """Rounded down to four digits, so that the number told is itself safe."""
    digits = 10.0 ** (np.floor(np.log10(value)) - 3)
    return float(np.floor(value / digits * (1 + 1e-12)) * digits)


def _scaled_stiffness(system: System, state: State) -> tuple[Any, NDArray[np.int64], Floats]:
    import scipy.sparse as sparse

    free = np.flatnonzero(state.free.ravel() > 0)
    number = np.full(state.x.size, -1)
    number[free] = np.arange(len(free))
    rows, columns, values = [], [], []
    for group, memory in zip(system.groups, state.memory, strict=True):
        if group.cls.role == "load" or not len(group.block.indices):
            continue
        blocks = system.stiffness_blocks(group, state, memory)
        index = group.block.indices
        mine = number[(3 * index[:, :, None] + np.arange(3)).reshape(len(index), -1)]
        row, column = np.repeat(mine, mine.shape[1], axis=1).ravel(), np.tile(mine, (1, mine.shape[1])).ravel()
        take = (row >= 0) & (column >= 0)
        rows.append(row[take])
        columns.append(column[take])
        values.append(blocks.ravel()[take])
    scale = 1.0 / np.sqrt(np.repeat(system.mass, 3)[free])
    if not rows:
        return None, free, scale
    whole = sparse.csr_matrix(
        (np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))), shape=(len(free), len(free))
    )
    diagonal = sparse.diags(scale)
    return (diagonal @ whole @ diagonal).tocsr(), free, scale


def _damping(system: System, state: State, motion: Floats) -> float:
    """u^T C u of a motion u: damping forces are linear in the velocity."""
    trial = state.copy()
    trial.v = motion
    moving, _, _ = system.evaluate(trial, still=False)
    resting, _, _ = system.evaluate(trial)
    work = -float((motion * (moving - resting)).sum())
    return work + float((system.drag * motion**2).sum())
