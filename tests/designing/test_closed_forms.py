"""Derivatives through equilibrium with a closed form, each beside differences of whole relaxations, to 1e-6."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import hookean
from hookean.designing.sensitivity import sensitivity

from .test_gradients import cable, sag
from .test_optima import tent

TIGHT = {"tolerance": 1e-13}


def differences(scene: Callable[[float], dict[str, Any]], read: Callable[[Any], float], at: float) -> float:
    """The derivative of what a relaxed scene reads, by differences of order 4: steps of 1e-3 leave 1e-10 or so."""
    step = 1e-3 * at
    weights = {-2: 1 / 12, -1: -2 / 3, 1: 2 / 3, 2: -1 / 12}
    solved = {way: read(hookean.relax(hookean.Scene.read(scene(at + way * step)))) for way in weights}
    return sum(weight * solved[way] for way, weight in weights.items()) / step


def test_height_and_volume_of_a_cap_by_its_pressure() -> None:
    """p = 3 T h / (r s), s² = r² + h², of a pyramid of film over a regular rim with an inscribed circle of radius r:
    dh/dp = s³ / (3 T r), and dV/dp = A / 3 dh/dp."""
    sides, tension, height = 24, 2.0, 0.3
    r, area = np.cos(np.pi / sides), 0.5 * sides * np.sin(2.0 * np.pi / sides)
    slant = np.hypot(r, height)
    pressure = 3.0 * tension * height / (r * slant)

    def scene(p: float) -> dict[str, Any]:
        given = tent(sides, 0.2)
        given["forces"][1]["pressure"] = p
        return {**given, "settings": TIGHT}

    by_height = slant**3 / (3.0 * tension * r)
    variables = [{"force": "air", "field": "pressure", "tie": "all"}]
    goals = ({"kind": "position", "particles": [0], "axes": "z"}, {"kind": "volume", "mesh": "cap"})
    for goal, value, exact in zip(
        goals, (height, area * height / 3.0), (by_height, area / 3.0 * by_height), strict=True
    ):
        found = sensitivity(scene(pressure), goals=[goal], variables=variables)
        assert found.value == pytest.approx(value, rel=1e-9)
        assert found.gradient[0] == pytest.approx([exact], rel=1e-6)
    assert differences(scene, lambda r: r.particles[0, 2], pressure) == pytest.approx(by_height, rel=1e-6)


def test_the_rise_of_an_arch_by_its_thrust() -> None:
    """A funicular polygon of equal loads P, n links over a span: H f = n P span / 8 for an even n, so df/dH = -f / H.
    Densities q give H = q span / n; the arch is the hanging line under loads that point up."""
    n, span, load, density = 10, 12.0, 2.0, 7.0

    def scene(q: float) -> dict[str, Any]:
        return {
            "particles": [[span * i / n, 0.0, 0.0] for i in range(n + 1)],
            "forces": [
                {"kind": "springs", "name": "arch", "particles": [[i, i + 1] for i in range(n)], "stiffness": q,
                 "rest_length": 0.0},
                {"kind": "unary", "particles": list(range(1, n)), "vector": [0, 0, load]},
            ],
            "anchors": [{"name": "left", "particles": [0]}, {"particles": [n]}],
            "settings": TIGHT,
        }  # fmt: skip

    variables = [{"force": "arch", "field": "stiffness", "tie": "all"}]
    goals = [
        {"kind": "position", "particles": [n // 2], "axes": "z"},
        {"kind": "reaction", "anchor": "left", "axes": "x"},
    ]
    rise, thrust = (sensitivity(scene(density), goals=[goal], variables=variables) for goal in goals)
    h, f = density * span / n, n * load * span / (8.0 * density * span / n)
    assert (rise.value, abs(thrust.value)) == pytest.approx((f, h), rel=1e-9)
    by_thrust = rise.gradient[0] / (np.sign(thrust.value) * thrust.gradient[0])
    assert by_thrust == pytest.approx([-f / h], rel=1e-6)
    by_density = differences(scene, lambda r: r.particles[n // 2, 2], density)
    assert by_density * n / span == pytest.approx(-f / h, rel=1e-6)


def test_the_sag_of_a_cable_by_its_stiffness() -> None:
    """P = 2 k (1 - L0 / l) d of two links, l² = 1 + d²: dd/dk = -(1 - L0 / l) d / (k (1 - L0 / l + L0 d² / l³))."""
    stiffness, rest, load = 100.0, 1.0, 5.0
    d = sag(stiffness, rest, load)
    length = np.hypot(1.0, d)
    slack = 1.0 - rest / length
    exact = -slack * d / (stiffness * (slack + rest * d**2 / length**3))

    def scene(k: float) -> dict[str, Any]:
        given = cable(settings=TIGHT)
        given["forces"][0]["stiffness"] = k
        return given

    found = sensitivity(
        scene(stiffness),
        goals=[{"kind": "position", "particles": [1], "axes": "z"}],
        variables=[{"force": "string", "field": "stiffness", "tie": "all"}],
    )
    assert found.gradient[0] == pytest.approx([-exact], rel=1e-6)
    assert differences(scene, lambda r: -r.particles[1, 2], stiffness) == pytest.approx(exact, rel=1e-6)
