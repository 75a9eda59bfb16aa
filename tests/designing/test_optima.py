"""Problems whose optimum has a closed form, each to 1e-6 (see also test_search: sag and thrust, least load path, the
Fermat point, two bars at 45 degrees, heights from their own densities)."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hookean.designing.search import design
from hookean.errors import InputError

TOLERANCE = 1e-6  # relative, of closed forms that are exact

STRESS, WEIGHT, MODULUS, BARS, HEIGHT, LOAD = 50.0, 3.0, 4e4, 8, 10.0, 20.0


def rope(**more: Any) -> dict[str, Any]:
    """A hanging rope of bars, stiff by E A and heavy by gamma A, with a load at its lower end."""
    bars = [[i, i + 1] for i in range(BARS)]
    return {
        "scene": {
            "particles": [[0, 0, -HEIGHT * i / BARS] for i in range(BARS + 1)],
            "forces": [
                {"kind": "springs", "name": "rope", "particles": bars, "axial_stiffness": MODULUS},
                {"kind": "line_weight", "name": "weight", "particles": bars, "weight": WEIGHT, "per": "start"},
                {"kind": "unary", "particles": [BARS], "vector": [0, 0, -LOAD]},
            ],
            "anchors": [{"particles": [0]}],
        },
        "variables": [
            {"force": "weight", "field": "weight", "lower": 1e-3, "name": "weight",
             "drives": [{"force": "rope", "field": "axial_stiffness", "factor": MODULUS / WEIGHT}]},
        ],
        "goals": [{"kind": "output", "force": "rope", "column": "strain", "target": STRESS / MODULUS}],
        **more,
    }  # fmt: skip


def test_a_rope_of_constant_stress_grows_exponentially() -> None:
    """sigma A_i = P + gamma h (A_i / 2 + the areas below), so A grows by (1 + a) / (1 - a) from bar to bar, with
    a = gamma h / (2 sigma): the exponential A = (P / sigma) exp(gamma z / sigma) of infinitely many bars."""
    found = design(rope())
    a = WEIGHT * HEIGHT / BARS / (2.0 * STRESS)
    areas = LOAD / STRESS / (1.0 - a) * ((1.0 + a) / (1.0 - a)) ** np.arange(BARS)[::-1]
    own = np.asarray(found.variables[0]["value"]) / WEIGHT
    assert found.status == "converged" and own == pytest.approx(areas, rel=TOLERANCE)
    middle = HEIGHT * (1.0 - 0.5 / BARS)  # of the top bar
    assert areas[0] == pytest.approx(LOAD / STRESS * np.exp(WEIGHT * middle / STRESS), rel=0.02)


def test_what_a_variable_drives_has_as_many_values() -> None:
    """Bars of one rope cannot follow the areas of another with fewer."""
    problem = rope()
    problem["scene"]["forces"][0]["particles"] = problem["scene"]["forces"][0]["particles"][:-1]
    with pytest.raises(InputError, match="it has 7 values, the variable 8") as error:
        design(problem)
    assert error.value.faults[0].pointer == "/variables/0/drives/0"


def tent(sides: int, height: float) -> dict[str, Any]:
    """A film from a point over the middle of a regular rim of radius 1 to its corners, under pressure."""
    turn = 2.0 * np.pi * np.arange(sides) / sides
    rim = [[np.cos(t), np.sin(t), 0.0] for t in turn]
    return {
        "meshes": {
            "cap": {
                "vertices": [[0.0, 0.0, height], *rim],
                "faces": [[0, 1 + i, 1 + (i + 1) % sides] for i in range(sides)],
            }
        },
        "forces": [
            {"kind": "soapfilm", "mesh": "cap", "tension": 2.0},
            {"kind": "pressure", "name": "air", "mesh": "cap", "pressure": 1.0},
        ],
        "anchors": [{"points": rim}],
    }


def test_the_pressure_of_a_cap_from_its_height() -> None:
    """T dA/dh = p dV/dh of a pyramid: p = 3 T h / (r sqrt(r² + h²)), r the radius of the circle within its rim."""
    sides, height = 24, 0.3
    found = design(
        {
            "scene": tent(sides, 0.2),
            "variables": [{"force": "air", "field": "pressure", "tie": "all", "lower": 0.0, "upper": 5.0}],
            "goals": [{"kind": "position", "particles": [0], "axes": "z", "target": height}],
        }
    )
    r = np.cos(np.pi / sides)
    assert found.variables[0]["value"] == pytest.approx(3 * 2.0 * height / (r * np.hypot(r, height)), rel=TOLERANCE)


def test_a_cable_of_given_sag_and_thrust() -> None:
    """A funicular line of equal loads: H = q a, sag f = n² P / (8 q) for an even n; both by the densities and loads."""
    n, span, sag, thrust = 10, 12.0, 1.5, 7.0
    nodes = list(range(1, n))
    found = design(
        {
            "scene": {
                "particles": [[span * i / n, 0.0, 0.0] for i in range(n + 1)],
                "forces": [
                    {"kind": "springs", "name": "cable", "particles": [[i, i + 1] for i in range(n)],
                     "stiffness": 3.0, "rest_length": 0.0},
                    {"kind": "unary", "name": "load", "particles": nodes, "vector": [0, 0, -1.0]},
                ],
                "anchors": [{"name": "left", "particles": [0]}, {"particles": [n]}],
            },
            "variables": [
                {"force": "cable", "field": "stiffness", "tie": "all", "lower": 0.1},
                {"force": "load", "field": "vector", "axes": "z", "tie": "all"},
            ],
            "goals": [
                {"kind": "position", "particles": [n // 2], "axes": "z", "target": -sag},
                {"kind": "reaction", "anchor": "left", "axes": "x", "target": -thrust},
            ],
        }
    )  # fmt: skip
    density = thrust * n / span
    assert found.variables[0]["value"] == pytest.approx(density, rel=TOLERANCE)
    assert np.ravel(found.variables[1]["value"])[0] == pytest.approx(-8.0 * density * sag / n**2, rel=TOLERANCE)
