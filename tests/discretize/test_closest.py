"""Distances from curves against closed forms, and polylines along them."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import rhino3dm as _rhino3dm
from hypothesis import given, settings
from hypothesis import strategies as st

from hookean.discretize.closest import distances, polyline
from hookean.errors import InputError

rhino: Any = _rhino3dm
RADIUS = 3.0
CIRCLE = rhino.Circle(RADIUS).ToNurbsCurve()
coordinate = st.floats(-10.0, 10.0)


@settings(deadline=None)  # the first call imports
@given(coordinate, coordinate, coordinate)
def test_distance_from_a_circle_is_the_closed_form(x: float, y: float, z: float) -> None:
    # sqrt((r - R)^2 + z^2); a parameter off by 2^-26 of a 64th of a quarter is off by 1e-9 of a radius, its distance by
    # the square of that over the distance, or to first order where this is 0: rounding, after Gauss-Newton steps
    expected = np.hypot(np.hypot(x, y) - RADIUS, z)
    assert distances([[x, y, z]], CIRCLE)[0] == pytest.approx(expected, abs=1e-13)


@settings(deadline=None)
@given(st.floats(0.0, 2.0 * np.pi))
def test_points_on_a_curve_are_on_it(angle: float) -> None:
    point = RADIUS * np.array([np.cos(angle), np.sin(angle), 0.0])
    assert distances([point], CIRCLE)[0] < 1e-14 * 10 * RADIUS


def test_distance_beyond_an_end_is_that_from_the_end() -> None:
    line = np.array([[0.0, 0, 0], [2, 0, 0], [2, 1, 0]])
    assert distances([[-3.0, 4, 0], [2, 4, 0], [1, 0, 0], [2, 0, 5]], line).tolist() == [5.0, 3.0, 0.0, 5.0]


def test_a_polyline_keeps_kinks_and_ends_and_lies_on_its_curve() -> None:
    corners = np.array([[0.0, 0, 0], [4, 0, 0], [4, 1, 0]])
    assert polyline(corners, 1).tolist() == corners.tolist()
    assert polyline(corners, 5).tolist() == [[0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0], [4, 0, 0], [4, 1, 0]]
    round_ = polyline(CIRCLE, 400)
    assert 401 <= len(round_) <= 405 and (round_[0] == round_[-1]).all()
    assert np.abs(np.linalg.norm(round_, axis=1) - RADIUS).max() < 1e-14 * 10 * RADIUS
    # a rational quarter of a circle at even parameters runs at most sqrt(2) times as fast as on average
    longest = np.linalg.norm(np.diff(round_, axis=0), axis=1).max()
    assert longest < np.sqrt(2.0) * 2.0 * np.pi * RADIUS / 400
    with pytest.raises(InputError):
        polyline(CIRCLE, 0)
