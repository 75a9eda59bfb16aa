"""Linear buckling of columns of springs that bend at their corners, against Euler's loads."""

from __future__ import annotations

import numpy as np
import pytest

import hookean
from hookean import Scene


@pytest.mark.parametrize(("low", "high", "part"), [(0, 0, 1.0), (1, 0, 2.0457), (1, 1, 4.0), (1, None, 0.25)])
def test_columns_of_bars_buckle_at_eulers_loads(low: int, high: int | None, part: float) -> None:
    """P = part x pi^2 EI / L^2 (Timoshenko and Gere, Theory of Elastic Stability, 1961, section 2.1; of one pin and one
    clamp 4.4934^2 EI / L^2). 1: clamped by a bar that is held and a corner of twice the stiffness, of half a bar; None:
    free. Bar chains come to it with the square of their bars: without that term to 1e-3."""
    found = []
    for n in (16, 32):
        x = np.zeros((n + 1, 3))
        x[:, 2] = np.arange(n + 1) * 2.0 / n
        corners = [[i - 1, i, i + 1] for i in range(1, n)]
        stiffness, held = [3.0] * (n - 1), [{"particles": [0]}, {"particles": np.arange(n + 1), "axes": "y"}]
        for wanted, near, beside, way in ((low, 0, 1, -1.0), (high, n, n - 1, 1.0)):
            if wanted == 1:
                x = np.vstack([x, x[near] + [0.0, 0.0, way * 2.0 / n]])
                corners.append([len(x) - 1, near, beside])
                stiffness.append(6.0)
                held.append({"particles": [len(x) - 1], "axes": "xyz" if near == 0 else "xy"})
            if wanted is not None and near == n:
                held.append({"particles": [n], "axes": "xy"})
        forces = [
            {"kind": "springs", "particles": [[i, i + 1] for i in range(n)], "stiffness": 1e8},
            {"kind": "bend", "particles": corners, "stiffness": stiffness},
            {"kind": "unary", "particles": [n], "vector": [0, 0, -1.0]},
        ]
        if high == 1:  # the bar that holds the direction moves along with the end
            forces.append({"kind": "springs", "particles": [[n, len(x) - 1]], "stiffness": 1e8})
        spec = {"particles": x, "forces": forces, "anchors": held, "settings": {"tolerance": 1e-9}}
        found.append(hookean.buckling(Scene.read(spec), count=1).factors[0])
    better = found[1] + (found[1] - found[0]) / 3.0
    assert better == pytest.approx(part * np.pi**2 * 3.0 / 4.0, rel=1e-3)
