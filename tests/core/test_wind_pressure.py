"""Wind as velocity pressure times a coefficient: closed forms of plates and a cylinder."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hookean import InputError, Scene
from hookean.system.system import compile

Q = 0.6


def force_on(x: Any, faces: Any, **given: Any) -> np.ndarray:
    force = {"kind": "wind_pressure", "mesh": "m", "pressure": Q, **given}
    system = compile(Scene(particles=x, meshes={"m": {"vertices": x, "faces": faces}}, forces=[force]))
    return np.asarray(system.evaluate(system.start())[0])


def plate(degrees: float) -> tuple[np.ndarray, np.ndarray]:
    """A plate of 2 x 3 whose outward normal is at an angle to -x, where a wind along x comes from; and the normal."""
    angle = np.radians(degrees)
    normal = np.array([-np.cos(angle), 0.0, np.sin(angle)])
    across = np.array([np.sin(angle), 0.0, np.cos(angle)])
    x = np.array([[0, 0], [2, 0], [2, 3], [0, 3]]) @ np.array([across, [0.0, 1.0, 0.0]])
    if np.cross(x[1] - x[0], x[3] - x[0]) @ normal < 0.0:
        x = x[::-1]
    return np.ascontiguousarray(x), normal


@pytest.mark.parametrize(
    ("degrees", "cp"), [(0.0, 0.8), (20.0, 0.56), (50.0, 0.2), (115.0, 0.2 - 65.0 / 90.0), (170.0, -0.8), (180.0, -0.8)]
)
def test_a_plate_has_the_coefficient_of_its_angle(degrees: float, cp: float) -> None:
    """we = q Cp, EN 1991-1-4, 5.2: pressure towards the outside where Cp > 0; Cp is linear between 0, 50 and 140
    degrees and constant beyond."""
    x, normal = plate(degrees)
    f = force_on(x, [[0, 1, 2, 3]], coefficient=[0.8, 0.2, -0.8], angles=[0.0, 50.0, 140.0])
    assert f.sum(axis=0) == pytest.approx(-Q * cp * 6.0 * normal, abs=1e-13)


def test_regions_have_their_own_coefficients() -> None:
    x = [[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 0], [1, 1, 0], [2, 1, 0]]
    f = force_on(x, [[0, 1, 4, 3], [1, 2, 5, 4]], coefficient=[0.5, -1.5])
    np.testing.assert_allclose(f[[0, 3], 2], -Q * 0.5 / 4.0, atol=1e-15)
    np.testing.assert_allclose(f[[2, 5], 2], Q * 1.5 / 4.0, atol=1e-15)


def test_a_cylinder_in_potential_flow_has_no_drag() -> None:
    """Cp = 1 - 4 sin(angle)^2 round a cylinder: the pressure has no resultant (d'Alembert)."""
    turns = 2.0 * np.pi * np.arange(96) / 96
    ring = np.column_stack([np.cos(turns), np.sin(turns)])
    x = np.concatenate([np.column_stack([ring, np.full(96, z)]) for z in (0.0, 1.0)])
    i, j = np.arange(96), (np.arange(96) + 1) % 96
    angles = np.linspace(0.0, 180.0, 97)
    f = force_on(
        x, np.column_stack([i, j, 96 + j, 96 + i]), coefficient=1.0 - 4.0 * np.sin(np.radians(angles)) ** 2,
        angles=angles, direction=[1.0, 0.0, 0.0],
    )  # fmt: skip
    assert np.abs(f).max() > 0.01 * Q
    np.testing.assert_allclose(f.sum(axis=0), 0.0, atol=1e-12)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"angles": [0.0, 90.0], "coefficient": [1.0]}, "1 values for 2 angles"),
        ({"angles": [90.0, 0.0], "coefficient": [1.0, 2.0]}, "increasing angles from 0 to 180"),
        ({"angles": [0.0], "coefficient": [1.0]}, "at least two"),
        ({"angles": [0.0, 200.0], "coefficient": [1.0, 0.0]}, "from 0 to 180"),
        ({"coefficient": [1.0, 2.0, 3.0]}, "3 values of coefficient for 1 faces of m"),
    ],
)
def test_tables_that_do_not_fit_are_refused(given: Any, said: str) -> None:
    with pytest.raises(InputError, match=said):
        force_on(plate(30.0)[0], [[0, 1, 2, 3]], **given)
