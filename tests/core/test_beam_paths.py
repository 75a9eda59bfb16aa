"""Load-displacement paths of two frames, through both limit points, against the differential equation of the elastica.

Both frames are known from curves, so the numbers come from the extensible elastica, which is solved here with scipy:
r' = t (1 + N / EA), theta' = M / EI, M' = -r' x n.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import scipy.optimize
from scipy.integrate import solve_ivp

import hookean
from hookean import Scene

Floats = np.ndarray


def flat(x: Floats, held: list[dict[str, Any]], loaded: int, axial: float, bending: float) -> Scene:
    """A row of beams in the plane x z, with a unit load down on one of its particles."""
    every = range(len(x))
    section = {"E": 1.0, "G": 1.0, "A": axial, "Iy": bending, "Iz": bending, "J": bending}
    beam = {"kind": "beam", "particles": np.column_stack([every[:-1], every[1:]]), "normal": [0, 1, 0], **section}
    load = {"kind": "unary", "particles": [loaded], "vector": [0, 0, -1.0]}
    plane = {"particles": every, "axes": "y", "rotations": "xz"}
    return Scene.read({"particles": x, "forces": [beam, load], "anchors": [*held, plane]})


def run(n: Floats, y: Floats, length: float, axial: float, bending: float) -> Floats:
    """The end x, z, theta, M of a piece of an elastica from its start `y`, under the force `n` across its sections."""

    def rates(_: float, y: Floats) -> list[float]:
        t = np.array([np.cos(y[2]), np.sin(y[2])])
        r = t * (1.0 + n @ t / axial)
        return [r[0], r[1], y[3] / bending, n[0] * r[1] - n[1] * r[0]]

    return solve_ivp(rates, (0.0, length), y, method="DOP853", rtol=1e-9, atol=1e-10).y[:, -1]


def solved(faults: Callable[[Floats], Floats], guess: Floats) -> Floats:
    found, _, fine, said = scipy.optimize.fsolve(faults, guess, full_output=True, xtol=1e-11)
    assert fine == 1, said
    return np.asarray(found)


TOGGLE = 12.943, 0.386, 1.885e6, 9.27e3  # half of the span, rise [in], EA [lb], EI [lb in^2]


@pytest.mark.slow
def test_williams_toggle_has_both_limit_points() -> None:
    """Williams, An approach to the non-linear behaviour of the members of a rigid jointed plane framework with
    finite deflections, 1964: a clamped toggle under a load on its apex, which snaps through. Half of it is an
    elastica whose ends keep their direction; its load is a function of the sag, with a maximum and a minimum. To
    1e-4 with ten beams a side."""
    half, rise, axial, bending = TOGGLE
    slope, size, count = np.arctan2(rise, half), np.hypot(half, rise), 10
    x = np.linspace([0, 0, 0], [half, 0, rise], count + 1)
    x = np.concatenate([x, (x * [-1, 1, 1] + [2 * half, 0, 0])[-2::-1]])
    held = [{"particles": [0, 2 * count], "rotations": "xyz"}]
    path = hookean.load_path(flat(x, held, count, axial, bending), steps=22, increment=9.0)
    assert [point.kind for point in path.critical_points] == ["limit", "limit"]

    def load(sag: float) -> float:
        def faults(u: Floats) -> Floats:
            end = run(np.array([u[0], -u[1]]), np.array([0.0, 0.0, slope, u[2]]), size, axial, bending)
            return (end[:3] - [half, rise - sag, slope]) / [half, rise, slope]

        return 2.0 * float(solved(faults, np.array([-800.0, 16.0, -50.0]))[1])

    for point, (low, high), sign in zip(path.critical_points, ((0.2, 0.26), (0.35, 0.44)), (1.0, -1.0), strict=True):
        best = scipy.optimize.minimize_scalar(
            lambda sag, sign=sign: -sign * load(sag), bounds=(low, high), method="bounded", options={"xatol": 1e-5}
        )
        sag = rise - point.particles[count, 2]
        assert point.factor == pytest.approx(abs(best.fun), rel=1e-4)
        assert sag == pytest.approx(best.x, rel=2e-3)  # flat there: 1e-3 of the sag changes the load by 1e-6


LEE = 120.0, 4320.0, 1440.0  # length of both members, EA, EI; the load acts at a fifth of the beam


@pytest.mark.slow
def test_lees_frame_has_both_limit_points() -> None:
    """Lee, Manuel and Rossow, Large deflections and stability of elastic frames, 1968: two members on hinges, which
    snap through and back. Both are elasticas that share their corner; of the forces at the lower hinge the
    horizontal one grows steadily along the path, so that the load is a function of it, with a maximum and a minimum.
    To 1e-4 with ten beams a member. And to 2.6 % the largest and the least load of both curves (of the sag and of the
    sway) of Simo and Vu-Quoc, A three-dimensional finite-strain rod model, part II, 1986, as they are read off in the
    reference data of AeroBeams.jl: what is read off the two differs by as much."""
    length, axial, bending = LEE
    count, at = 10, 12
    one = np.linspace([0, 0, 0], [0, 0, length], count + 1)
    x = np.concatenate([one, np.linspace([0, 0, length], [length, 0, length], count + 1)[1:]])
    held = [{"particles": [0, 2 * count]}]
    path = hookean.load_path(flat(x, held, at, axial, bending), steps=24, increment=1.0)
    assert [point.kind for point in path.critical_points] == ["limit", "limit"]

    def frame(force: float, guess: Floats) -> tuple[Floats, Floats]:
        """Angle, upward force and load for the horizontal force at the lower hinge, and the shape at the load."""

        def pieces(u: Floats) -> tuple[Floats, Floats]:
            n = np.array([force, u[1]])
            corner = run(n, np.array([0.0, 0.0, u[0], 0.0]), length, axial, bending)
            there = run(n, corner - [0.0, 0.0, 0.5 * np.pi, 0.0], 0.2 * length, axial, bending)
            return there, run(n + [0.0, u[2]], there, 0.8 * length, axial, bending)

        u = solved(lambda u: (pieces(u)[1][[0, 1, 3]] - [length, length, 0.0]) / length, guess)
        return u, pieces(u)[0][:2]

    for point, guess, forces, published in (
        (path.critical_points[0], [2.24, -1.42, 1.855], [-0.30, -0.34, -0.38], (18.67, 18.76)),
        (path.critical_points[1], [0.22, -0.49, -0.94], [-0.50, -0.53, -0.56], (-9.23, -9.47)),
    ):
        found = [frame(force, np.array(guess)) for force in forces]
        loads = np.polynomial.Polynomial.fit(forces, [u[2] for u, _ in found], 2)
        best = float(loads.deriv().roots()[0])
        assert min(forces) < best < max(forces)
        u, there = frame(best, found[1][0])
        assert point.factor == pytest.approx(u[2], rel=1e-4)
        # in thousands, of E = 7.2e6
        assert np.full(2, 10.0 * point.factor) == pytest.approx(published, rel=0.026)
        # flat there: the middle of three points is off by 1e-2 of the movement at most
        assert point.particles[at, [0, 2]] == pytest.approx(there, abs=1e-2 * length)
