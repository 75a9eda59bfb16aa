"""Areas of polygons: closed forms with springs around them, and which polygons are refused."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

from hookean import InputError, Scene, relax

AROUND = [[0, 1], [1, 2], [2, 3], [3, 0]]


@pytest.mark.parametrize("factor", [0.3, 1.0, 4.0])
def test_springs_around_make_a_square(factor: float) -> None:
    """Four springs of rest length 0 pull a 2 x 1 rectangle; the pressure of its area, p = K (A0 - A) / A0, pushes. Of
    all shapes with one area the square has the least sum of squared sides, and virtual work of scaling gives its side:
    4 k s^2 = 2 p s^2, so A = A0 (1 - 2 k / K)."""
    x = np.array([[0, 0, 0], [2.0, 0, 0], [2.0, 1.0, 0], [0, 1.0, 0]])
    forces = [
        {"kind": "polygon_area", "particles": AROUND, "stiffness": 50.0, "area_factor": factor},
        {"kind": "springs", "particles": AROUND, "stiffness": 5.0, "rest_length": 0.0},
    ]
    found = relax(Scene(particles=x, forces=forces, settings={"tolerance": 1e-11, "max_iterations": 50000}))
    area = 2.0 * factor * (1.0 - 2.0 * 5.0 / 50.0)
    assert found.converged
    assert found.forces[0]["area"] == pytest.approx(np.full(4, area), rel=1e-7)
    assert found.forces[1]["length"] == pytest.approx(np.full(4, np.sqrt(area)), rel=1e-5)


def test_a_rhombus_with_stiff_sides_opens_to_its_area() -> None:
    """Sides of length 1 that hardly stretch and a diagonal of length d: A = d sqrt(1 - d^2 / 4), of which A0 is a part
    that two shapes have: it comes to the nearer one."""
    half = 0.9
    x = np.array([[-half, 0, 0], [0, -np.sqrt(1 - half**2), 0], [half, 0, 0], [0, np.sqrt(1 - half**2), 0]])
    forces = [
        {"kind": "polygon_area", "lines": x[np.array(AROUND)], "stiffness": 1.0, "area_factor": 1.1},
        {"kind": "springs", "lines": x[np.array(AROUND)], "stiffness": 1e4},
    ]
    found = relax(Scene(forces=forces, settings={"tolerance": 1e-12, "max_iterations": 50000}))
    start = 2.0 * half * np.sqrt(1.0 - half**2)
    expected = brentq(lambda d: d * np.sqrt(1.0 - d * d / 4.0) - 1.1 * start, np.sqrt(2.0), 2.0)
    found_across = np.linalg.norm(found.particles[2] - found.particles[0])
    assert found.converged
    assert found_across == pytest.approx(expected, abs=1e-6)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"particles": AROUND[:3]}, "the edges of a polygon_area are open near particle 0; give closed polygons"),
        ({"particles": [*AROUND[:3], [0, 3]]}, "the edges of a polygon_area are open near particle 0"),
        ({"particles": AROUND, "group": [0, 0, 1, 1]}, "the edges of a polygon_area are open near particle 0"),
        ({"particles": [[0, 1], [1, 0]]}, "a polygon of a polygon_area has no area at the start"),
    ],
)
def test_polygons_are_closed_and_have_an_area(given: dict[str, Any], message: str) -> None:
    """An edge missing, one turned round, one polygon in two groups, two edges back and forth."""
    x = [[0, 0, 0], [2.0, 0, 0], [2.0, 1.0, 0], [0, 1.0, 0]]
    with pytest.raises(InputError, match=f"/forces/0: {message}"):
        relax(Scene(particles=x, forces=[{"kind": "polygon_area", **given}]))
