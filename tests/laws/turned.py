"""Slots in the laws: what the rows of orientations mean for moments and rigid motions, by scipy and not by the engine.

Rows of a case: n particles, r slots l theta, r references l rho; the orientation is exp(theta) exp(rho).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.linalg import expm
from scipy.spatial.transform import Rotation

if TYPE_CHECKING:
    from .cases import Case


def skew(a: np.ndarray) -> np.ndarray:
    """The matrix of a cross product with `a`."""
    return np.array([[0.0, -a[2], a[1]], [a[2], 0.0, -a[0]], [-a[1], a[0], 0.0]])


def tangent(theta: np.ndarray) -> np.ndarray:
    """T(theta), the integral of exp(s theta) from 0 to 1: omega = T dtheta/dt. By the exponential of a 6 x 6 matrix
    (Van Loan, 1978)."""
    whole = np.zeros((6, 6))
    whole[:3, :3], whole[:3, 3:] = skew(theta), np.eye(3)
    return np.asarray(expm(whole)[:3, 3:])


def movable(case: Case) -> int:
    """Rows that may move: all but references."""
    return len(case.x) - len(case.arms)


def moment_of(case: Case, x: np.ndarray, f: np.ndarray) -> np.ndarray:
    """Moment (3,) of all forces about the mean of the particles: r x F, and M = l T^-T f at slots."""
    n = len(case.x) - 2 * len(case.arms)
    total = np.cross(x[:n] - x[:n].mean(axis=0), f[:n]).sum(axis=0)
    for row, arm in enumerate(case.arms, n):
        total = total + arm * np.linalg.solve(tangent(x[row] / arm).T, f[row])
    return np.asarray(total)


def moved_rigidly(case: Case, x: np.ndarray, turn: np.ndarray, shift: np.ndarray) -> np.ndarray:
    """All rows after a rotation and a shift: Q exp(theta) exp(rho) = exp(Q theta) Q exp(rho)."""
    r = len(case.arms)
    n = len(x) - 2 * r
    moved = x @ turn.T
    moved[:n] += shift
    if r:
        arms = np.asarray(case.arms)[:, None]
        rho = Rotation.from_matrix(turn) * Rotation.from_rotvec(x[n + r :] / arms)
        moved[n + r :] = arms * rho.as_rotvec()
    return np.ascontiguousarray(moved)
