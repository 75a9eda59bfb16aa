"""Constant tensions: Fermat's point, triangles of forces, the energy T l, and lines without length."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hookean import InputError, Scene, relax

CORNERS = np.array([[0.0, 0.0, 0.0], [3.0, 0.2, 0.0], [1.0, 2.5, 0.4]])


def strings(tension: Any, **settings: Any) -> Any:
    """Three strings from the corners of a triangle to one particle."""
    return relax(
        Scene(
            particles=[*CORNERS, [1.2, 0.7, 0.5]],
            forces=[{"kind": "constant_tension", "particles": [[0, 3], [1, 3], [2, 3]], "tension": tension}],
            anchors=[{"particles": [0, 1, 2]}],
            settings={"tolerance": 1e-10, **settings},
        )
    )


def between(found: Any) -> np.ndarray:
    """Cosines of the angles between strings 0-1, 1-2 and 2-0."""
    arms = found.particles[:3] - found.particles[3]
    arms /= np.linalg.norm(arms, axis=1)[:, None]
    return (arms * np.roll(arms, -1, axis=0)).sum(axis=1)


@pytest.mark.parametrize("solver", ["auto", "relaxation", "newton", "momentum"])
def test_three_equal_strings_meet_at_120_degrees(solver: str) -> None:
    """Fermat's point: three unit vectors that sum to zero. A residual of 1e-10 T turns them by as much."""
    found = strings(7.0, solver=solver)
    assert found.converged
    assert between(found) == pytest.approx(np.full(3, -0.5), abs=1e-8)
    assert found.forces[0]["force"] == pytest.approx(np.full(3, 7.0), rel=1e-12)


def test_unequal_strings_form_a_triangle_of_forces() -> None:
    """T1, T2, T3 close a triangle: cos of the angle between 1 and 2 is (T3^2 - T1^2 - T2^2) / (2 T1 T2)."""
    t = np.array([5.0, 4.0, 6.0])
    found, after, last = strings(t), np.roll(t, -1), np.roll(t, -2)
    assert found.converged
    assert between(found) == pytest.approx((last**2 - t**2 - after**2) / (2.0 * t * after), abs=1e-8)
    assert found.energy["total"] == pytest.approx(float(t @ found.forces[0]["length"]), rel=1e-12)


def test_a_string_over_a_weight_hangs_at_the_angle_of_its_tension() -> None:
    """A load P between two equal strings: 2 T sin(slope) = P, at any span."""
    found = relax(
        Scene(
            particles=[[-1, 0, 0], [1, 0, 0], [0.1, 0, -0.1]],
            forces=[
                {"kind": "constant_tension", "particles": [[0, 2], [1, 2]], "tension": 5.0},
                {"kind": "unary", "particles": [2], "vector": [0, 0, -6.0]},
            ],
            anchors=[{"particles": [0, 1]}],
            settings={"tolerance": 1e-10},
        )
    )
    assert found.converged
    assert found.particles[2] == pytest.approx([0.0, 0.0, -0.75], abs=1e-8)  # sine 0.6, slope 3 : 4


def test_a_tension_that_is_not_a_number_is_refused() -> None:
    with pytest.raises(InputError, match="/forces/0/tension: not a finite number"):
        strings(float("nan"))
    with pytest.raises(InputError, match="/forces/0/tension: 2 values for 3 elements"):
        strings([1.0, 2.0])
