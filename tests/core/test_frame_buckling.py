"""Linear buckling of frames of beams beside a small finite-element program for plane frames that is written here."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import scipy.linalg
from scipy.optimize import brentq
from scipy.special import jv

import hookean
from hookean import Scene

from .beam_scenes import CLAMP, load, row, scene, straight

Floats = np.ndarray
AXIAL, BENDING, PIECES = 1e6, 100.0, 16  # EA, EI, and beams to a member
BENT = [[12, 6, -12, 6], [6, 4, -6, 2], [-12, -6, 12, -6], [6, 2, -6, 4]]
PULLED = [[36, 3, -36, 3], [3, 4, -3, -1], [-36, -3, 36, -3], [3, -1, -3, 4]]


def plane(pairs: Any, x: Floats, held: list[int], force: Floats) -> float:
    """The first factor on a force (3 n,) of u, w and the rotation of each node: cubics with their geometric stiffness,
    of the normal forces alone (Przemieniecki, Theory of Matrix Structural Analysis, 1968, 15.2)."""
    size, parts = 3 * len(x), []
    stiff, stress = np.zeros((size, size)), np.zeros((size, size))
    for a, b in pairs:
        length = float(np.hypot(*(x[b] - x[a])))
        c, s = (x[b] - x[a]) / length
        turn = np.kron(np.eye(2), [[c, s, 0], [-s, c, 0], [0, 0, 1]])
        own, pulled, bends = np.zeros((6, 6)), np.zeros((6, 6)), np.ix_([1, 2, 4, 5], [1, 2, 4, 5])
        arms = np.outer([1, length, 1, length], [1, length, 1, length])
        own[np.ix_([0, 3], [0, 3])] = AXIAL / length * np.array([[1, -1], [-1, 1]])
        own[bends] = BENDING / length**3 * arms * BENT
        pulled[bends] = arms * PULLED / (30.0 * length)
        places = np.r_[3 * a : 3 * a + 3, 3 * b : 3 * b + 3]
        stiff[np.ix_(places, places)] += turn.T @ own @ turn
        parts.append((places, turn, own, pulled))
    free = np.setdiff1d(np.arange(size), held)
    moved = np.zeros(size)
    moved[free] = np.linalg.solve(stiff[np.ix_(free, free)], force[free])
    for places, turn, own, pulled in parts:
        stress[np.ix_(places, places)] += (own @ turn @ moved[places])[3] * turn.T @ pulled @ turn
    values = scipy.linalg.eigh(-stress[np.ix_(free, free)], stiff[np.ix_(free, free)], eigvals_only=True)
    return float(1.0 / values.max())


FRAMES: dict[str, tuple[list[list[float]], str, dict[int, tuple[float, float]]]] = {
    "clamped column": ([[0, 0], [0, 2]], "", {1: (0, -1)}),
    "clamped portal": ([[0, 0], [0, 3], [4, 3], [4, 0]], "xyz", {1: (0, -1), 2: (0, -1)}),
    "hinged portal": ([[0, 0], [0, 3], [4, 3], [4, 0]], "xz", {1: (0, -1), 2: (0, -1)}),
    "portal with a push": ([[0, 0], [0, 2], [5, 2], [5, 0]], "xyz", {1: (0.1, -1), 2: (0, -1)}),
    "gable": ([[0, 0], [0, 3], [3, 4.5], [6, 3], [6, 0]], "xyz", {2: (0, -1)}),
}
"""Corners, rotations that the feet hold (of a column only one foot), and the loads at corners."""


@pytest.mark.slow
@pytest.mark.parametrize("name", FRAMES)
def test_plane_frames_buckle_as_another_program_says(name: str) -> None:
    """Whether they only shorten before or bend as well: to 1e-5. The normal forces are those of the linear solution;
    what bending moments add in the plane is a part P / EA = 1e-4 of a correction."""
    corners, feet, loads = FRAMES[name]
    s, c = np.linspace(0.0, 1.0, PIECES + 1)[:, None], np.array(corners, float)
    x = np.concatenate([c[i] + (c[i + 1] - c[i]) * s[i > 0 :] for i in range(len(c) - 1)])
    pairs = [[i, i + 1] for i in range(len(x) - 1)]
    ends = [0, len(x) - 1] if feet else [0]
    held = [3 * end + axis for end in ends for axis in range(2 if feet == "xz" else 3)]
    force = np.zeros((len(x), 3))
    for corner, pull in loads.items():
        force[corner * PIECES, :2] = pull
    wanted = plane(pairs, x, held, force.ravel())
    beam = {"kind": "beam", "particles": pairs, "E": BENDING, "G": BENDING / 2.6, "A": AXIAL / BENDING, "Iy": 1.0,
            "Iz": 1.0, "J": 2.0, "normal": [0, 1, 0]}  # fmt: skip
    push = {"kind": "unary", "particles": range(len(x)), "vector": np.insert(force[:, :2], 1, 0.0, axis=1)}
    anchors = [{"particles": ends, "rotations": feet or "xyz"},
               {"particles": range(len(x)), "axes": "y", "rotations": "xz"}]  # fmt: skip
    spec = {"particles": np.insert(x, 1, 0.0, axis=1), "forces": [beam, push], "anchors": anchors}
    found = hookean.buckling(Scene.read(spec), count=1)
    assert found.factors[0] == pytest.approx(wanted, rel=1e-5)


def test_a_deep_cantilever_buckles_sideways_in_a_linear_analysis_too() -> None:
    """By the moments that its load brings: P = 4.0126 (EIz GJ)^0.5 / L^2 (Prandtl 1899; Timoshenko and Gere, 6.3). With
    errors of order 2, 8 and 16 beams lead to it within 1e-3."""
    section = {"E": 1.0, "G": 1.0, "A": 1e6, "Iy": 1e4, "Iz": 1.0, "J": 1.0}
    exact = 2.0 * brentq(lambda z: jv(-0.25, z), 1.9, 2.1)
    coarse, fine = (
        hookean.buckling(scene(straight(n), [row(n, section), load(n, (0, 0, -1.0))]), count=1).factors[0] / exact - 1.0
        for n in (8, 16)
    )
    assert (4.0 * fine - coarse) / 3.0 == pytest.approx(0.0, abs=1e-3)
    assert 3.5 < coarse / fine < 4.5


def test_beams_and_what_stands_beside_them_buckle_together() -> None:
    """A column on a clamp whose head a spring of stiffness k holds sideways: P = u^2 EI / L^2 at the root of
    tan u = u - u^3 EI / (k L^3), from EI y'' = P (d - y) - k d (L - x). To 1e-3 with ten beams."""
    k, section = 5.0, {"E": 1e7, "G": 5e6, "A": 1.0, "Iy": 1e-7, "Iz": 2e-7, "J": 2e-7}
    x = np.concatenate([straight(10, along=(0, 0, 1)), [[1.0, 0.0, 1.0]]])
    prop = {"kind": "springs", "particles": [[10, 11]], "stiffness": k}
    held = [CLAMP, {"particles": [11]}, {"particles": range(11), "axes": "y", "rotations": "xz"}]
    forces = [row(10, section, normal=[1, 0, 0]), prop, load(10, (0, 0, -1.0))]
    found = hookean.buckling(scene(x, forces, held), count=1).factors[0]
    root = brentq(lambda u: np.tan(u) - u + u**3 / k, 1.6, 4.4)
    assert found == pytest.approx(root**2, rel=1e-3)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["gable", "portal with a push"])
def test_frames_of_springs_that_bend_at_corners_buckle_as_frames(name: str) -> None:
    """On hinged feet, as bar chains (Hencky), which lead to the frame with the square of their bars: of 16 to a member
    within 1e-2, of 8 four times as far off, and both together within 2e-4."""
    corners, _, loads = FRAMES[name]
    off = []
    for pieces in (8, 16):
        s, c = np.linspace(0.0, 1.0, pieces + 1)[:, None], np.array(corners, float)
        flat = np.concatenate([c[i] + (c[i + 1] - c[i]) * s[i > 0 :] for i in range(len(c) - 1)])
        n = len(flat)
        force = np.zeros((n, 3))
        for corner, push in loads.items():
            force[corner * pieces, :2] = push
        pairs = np.column_stack([np.arange(n - 1), np.arange(1, n)])
        exact = plane(pairs, flat, [0, 1, 3 * n - 3, 3 * n - 2], force.ravel())
        x = np.insert(flat, 1, 0.0, axis=1)
        long = np.linalg.norm(np.diff(x, axis=0), axis=1)
        turns = np.column_stack([np.arange(n - 2), np.arange(1, n - 1), np.arange(2, n)])
        forces = [
            {"kind": "springs", "particles": pairs, "stiffness": AXIAL / long},
            {"kind": "bend", "particles": turns, "stiffness": BENDING},
            {"kind": "unary", "particles": range(n), "vector": force[:, [0, 2, 1]]},
        ]
        held = [{"particles": [0, n - 1]}, {"particles": range(n), "axes": "y"}]
        off.append(hookean.buckling(scene(x, forces, held), count=1).factors[0] / exact - 1.0)
    assert np.abs(off[1]) < 1e-2 and 3.8 < off[0] / off[1] < 4.2
    assert (4.0 * off[1] - off[0]) / 3.0 == pytest.approx(0.0, abs=2e-4)
