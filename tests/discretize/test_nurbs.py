"""NURBS as plain numbers are rhino3dm's own curves and surfaces, and what does not fit is said."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import rhino3dm
from hypothesis import given, settings
from hypothesis import strategies as st

from hookean.discretize import divide, mesh_surface, nurbs_curve, nurbs_surface
from hookean.errors import InputError
from soak import examples

SQUARE = [[[0.0, 0.0, 0.0], [0.0, 2.0, 0.0]], [[1.0, 0.0, 0.0], [1.0, 2.0, 1.0]]]
numbers = st.floats(-10, 10).map(lambda x: round(x, 3))
weights = st.floats(0.2, 5).map(lambda x: round(x, 3))


@st.composite
def surface(draw: st.DrawFn) -> tuple[Any, dict[str, Any]]:
    """A surface of rhino3dm and its numbers."""
    p, q = draw(st.integers(1, 3)), draw(st.integers(1, 3))
    rows, columns = p + 1 + draw(st.integers(0, 2)), q + 1 + draw(st.integers(0, 2))
    made = rhino3dm.NurbsSurface.Create(3, True, p + 1, q + 1, rows, columns)
    made.KnotsU.CreateUniformKnots(1.0)
    made.KnotsV.CreateUniformKnots(0.5)
    points, heavy = np.zeros((rows, columns, 3)), np.zeros((rows, columns))
    for i in range(rows):
        for j in range(columns):
            x, y, z, w = draw(numbers) + 30 * i, draw(numbers) + 30 * j, draw(numbers), draw(weights)
            points[i, j], heavy[i, j] = (x, y, z), w
            made.Points[(i, j)] = rhino3dm.Point4d(x * w, y * w, z * w, w)
    knots = {"knots_u": list(made.KnotsU), "knots_v": list(made.KnotsV)}
    return made, {"degree_u": p, "degree_v": q, "points": points, "weights": heavy, **knots}


@settings(max_examples=examples(30), deadline=None)
@given(surface(), st.integers(1, 7), st.integers(1, 7))
def test_a_surface_as_numbers_is_the_surface(pair: tuple[Any, dict[str, Any]], u: int, v: int) -> None:
    made, form = pair
    wanted, found = mesh_surface(made, u, v), mesh_surface(nurbs_surface(**form), u, v)
    assert (found.faces == wanted.faces).all()
    assert np.abs(found.vertices - wanted.vertices).max() < 1e-11


def test_a_curve_takes_rhinos_knots_and_the_books() -> None:
    points = [[0, 0, 0], [1, 2, 0], [3, 1, 1], [4, 0, 0], [6, 2, 0]]
    short = [0, 0, 0, 1, 2, 2, 2]
    one = nurbs_curve(3, points, short)
    assert (divide(one, 9) == divide(nurbs_curve(3, points, [0, *short, 2], [1.0] * 5), 9)).all()
    made = rhino3dm.NurbsCurve(3, False, 4, 5)
    for i, point in enumerate(points):
        made.Points[i] = rhino3dm.Point4d(*point, 1.0)
    for i, knot in enumerate(short):
        made.Knots[i] = knot
    assert np.abs(divide(one, 9) - divide(made, 9)).max() < 1e-12


@pytest.mark.parametrize(
    ("changed", "pointer"),
    [
        ({"degree_u": 2}, "points"),
        ({"degree_v": 0}, "degree_v"),
        ({"degree_v": True}, "degree_v"),
        ({"points": [[0, 0, 0]]}, "points"),
        ({"points": [[[0, 0, 0], [0, 0, float("nan")]]] * 2}, "points"),
        ({"points": [[["a"]]]}, "points"),
        ({"knots_u": [0, 1, 2]}, "knots_u"),
        ({"knots_u": [1, 0]}, "knots_u"),
        ({"knots_v": [1, 1]}, "knots_v"),
        ({"weights": [[1, 1], [1, 0]]}, "weights"),
        ({"weights": [1, 1]}, "weights"),
    ],
)
def test_what_does_not_fit_is_said(changed: dict[str, Any], pointer: str) -> None:
    form = {"degree_u": 1, "degree_v": 1, "points": SQUARE, "knots_u": [0, 1], "knots_v": [0, 1]}
    assert (mesh_surface(nurbs_surface(**form), 1, 1).vertices[-1] == [1, 2, 1]).all()
    with pytest.raises(InputError) as caught:
        nurbs_surface(**{**form, **changed})
    assert caught.value.pointer == pointer
