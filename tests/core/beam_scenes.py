"""Beams for tests: rows of them, and a rod by its differential equation, solved with scipy, not with the engine."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.integrate import solve_bvp
from scipy.spatial.transform import Rotation

from hookean import Scene

CLAMP = {"particles": [0], "rotations": "xyz"}
Spec = dict[str, Any]

SLENDER = {"E": 1e4, "G": 5e3, "A": 1.0, "Iy": 1e-4, "Iz": 1e-4, "J": 2e-4}
"""EI = 1, GJ = 1, EA = 1e4: of length 1 the axial strain of a force of 1 is 1e-4."""


def row(count: int, section: Spec | None = None, **more: Any) -> Spec:
    """`count` beams, one after the other."""
    pairs = [[i, i + 1] for i in range(count)]
    return {"kind": "beam", "particles": pairs, **(section or SLENDER), **more}


def straight(count: int, length: float = 1.0, along: Any = (1.0, 0.0, 0.0)) -> np.ndarray:
    """Particles of a straight row."""
    return np.linspace(0.0, length, count + 1)[:, None] * np.asarray(along, float)


def load(particle: int, force: Any = (0.0, 0.0, 0.0), moment: Any = (0.0, 0.0, 0.0)) -> Spec:
    """A force and a moment at a particle."""
    return {"kind": "unary", "particles": [particle], "vector": list(force), "moment": list(moment)}


def scene(x: np.ndarray, forces: list[Spec], anchors: list[Spec] | None = None, **settings: Any) -> Scene:
    """A scene of beams; a clamp at the first particle where no anchors are given."""
    anchors = [CLAMP] if anchors is None else anchors
    return Scene.read({"particles": x.tolist(), "forces": forces, "anchors": anchors, "settings": settings})


def rotation(result: Any, place: int) -> Rotation:
    """The orientation of a particle in a result, for scipy."""
    return Rotation.from_quat(np.roll(result.rotations["quaternions"][place], -1))  # the real part is last


def rod(frames: Any, length: float, curvature: np.ndarray, stiff: np.ndarray, axial: float, force: np.ndarray) -> Any:
    """The shape (3, k) of an elastic rod that is clamped at the origin with the frame `frames` (3, 3) by columns, has
    a `curvature` (3,) [rad/length] in its own frame without stress, the stiffness `stiff` (GJ, EIy, EIz) and `axial`
    (EA), and carries a dead `force` at its end.

    Kirchhoff's rod: r' = R e1 (1 + N / EA), q' = q kappa / 2, m' = -r' x n, n = force, m = 0 at the end.
    """

    def rates(s: np.ndarray, y: np.ndarray) -> np.ndarray:
        q = Rotation.from_quat(y[3:7].T)
        tangent = q.apply([1.0, 0.0, 0.0])
        own = q.inv().apply(y[7:].T) / stiff + curvature
        r = tangent * (1.0 + tangent @ force / axial)[:, None]
        w, v = y[6], y[3:6].T
        turned = 0.5 * (w[:, None] * own + np.cross(v, own))
        return np.vstack([r.T, turned.T, -0.5 * (v * own).sum(axis=1), -np.cross(r, force).T])

    start = np.concatenate([np.zeros(3), Rotation.from_matrix(frames).as_quat()])

    def ends(a: np.ndarray, b: np.ndarray) -> np.ndarray:
        return np.concatenate([a[:7] - start, b[7:]])

    s = np.linspace(0.0, length, 41)
    bent = Rotation.from_matrix(frames) * Rotation.from_rotvec(s[:, None] * curvature)
    points = np.cumsum(bent.apply([length / 40.0, 0.0, 0.0]), axis=0)
    guess = np.vstack([points.T, bent.as_quat().T, np.zeros((3, 41))])
    for part in np.linspace(0.1, 1.0, 10):
        full, force = force, part * np.asarray(force)
        found = solve_bvp(rates, ends, s, guess, tol=1e-8, max_nodes=20_000)
        assert found.success
        s, guess, force = found.x, found.y, full
    return found.sol
