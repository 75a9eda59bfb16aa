"""Critical loads of beams: which side of them a straight beam is stable on."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import jv

from hookean import relax

from .beam_scenes import CLAMP, load, row, scene, straight

UP = (0.0, 0.0, 1.0)
COLUMN = {"E": 1e7, "G": 5e6, "A": 1.0, "Iy": 1e-7, "Iz": 2e-7, "J": 2e-7}
"""EI = 1; P / EA = 4e-6 at most, by which the column is shorter and its critical load larger."""


def supports(case: str, last: int) -> list[dict[str, Any]]:
    """Anchors of a column along z."""
    foot = {"particles": [0], "rotations": "z"} if case == "hinged" else CLAMP
    head = {"particles": [last], "axes": "xy", "rotations": "xyz" if case == "clamped" else ""}
    return [foot] if case == "cantilever" else [foot, head]


PROPPED = brentq(lambda k: np.tan(k) - k, 4.3, 4.6) ** 2

EULER = {"cantilever": np.pi**2 / 4.0, "hinged": np.pi**2, "propped": PROPPED, "clamped": 4.0 * np.pi**2}
"""Critical loads by EI / L^2 (Timoshenko and Gere, Theory of elastic stability, 2.1 and 2.2)."""


@pytest.mark.parametrize("case", EULER)
def test_columns_buckle_at_eulers_load(case: str) -> None:
    """Stable at 0.999 and unstable at 1.001 of it. The error of n cubics is about (pi / n)^4 / 720 for a half wave in L
    (n = 8: 3e-5), and the clamped column has two waves (5e-4)."""
    for part, expected in ((0.999, "stable"), (1.001, "unstable")):
        forces = [row(8, COLUMN, normal=[1, 0, 0]), load(8, (0, 0, -part * EULER[case]))]
        found = relax(scene(straight(8, along=UP), forces, supports(case, 8), solver="newton", allow_unstable=True))
        assert found.converged and found.stability == expected, part
        assert np.abs(found.particles[:, :2]).max() < 1e-6  # still straight


@pytest.mark.slow
def test_a_column_leaves_its_axis_above_that_load() -> None:
    """At 1.015 of the critical load a cantilever's tip has turned by about 20 degrees, P / Pc = 4 K(k)^2 / pi^2 with
    k = sin(alpha / 2) (the elastica; Timoshenko and Gere, 2.7): to 0.3 degrees with 16 beams."""
    from scipy.special import ellipk

    alpha = np.radians(20.0)
    critical = float(ellipk(np.sin(0.5 * alpha) ** 2)) ** 2
    found = relax(scene(straight(16, along=UP), [row(16, COLUMN, normal=[1, 0, 0]), load(16, (0, 0, -critical))]))
    assert found.converged and found.stability == "stable"
    tip = found.rotations["quaternions"][-1]
    assert np.degrees(2.0 * np.arccos(tip[0])) == pytest.approx(20.0, abs=0.3)


def sideways(count: int) -> float:
    """Critical load at the tip of a deep cantilever by (EIz GJ)^0.5 / L^2, to 1e-4 of it."""
    section = {"E": 1.0, "G": 1.0, "A": 1e6, "Iy": 1e4, "Iz": 1.0, "J": 1.0}
    low, high = 4.0, 4.1
    while high - low > 4e-4:
        middle = 0.5 * (low + high)
        forces = [row(count, section), load(count, (0, 0, -middle))]
        found = relax(scene(straight(count), forces, solver="newton", allow_unstable=True, tolerance=1e-9))
        assert found.converged and found.stability in ("stable", "unstable")
        low, high = (middle, high) if found.stability == "stable" else (low, middle)
    return 0.5 * (low + high)


@pytest.mark.slow
def test_a_deep_cantilever_buckles_sideways() -> None:
    """P = 4.0126 (EIz GJ)^0.5 / L^2: 4.0126 is twice the first zero of J_-1/4 (Prandtl 1899; Timoshenko and Gere, 6.3),
    for a section so deep that it hardly sags before, EIz / EIy = 1e-4. Errors are of order 2: 8 and 16 beams lead to
    it within 1e-3."""
    exact = 2.0 * brentq(lambda z: jv(-0.25, z), 1.9, 2.1)
    coarse, fine = sideways(8) / exact - 1.0, sideways(16) / exact - 1.0
    assert (4.0 * fine - coarse) / 3.0 == pytest.approx(0.0, abs=1e-3)
    assert 3.5 < coarse / fine < 4.5 and fine < 4e-3
