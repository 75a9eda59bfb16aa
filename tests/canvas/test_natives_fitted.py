"""Natives that fit lines, circles and curves, each on values with a known answer."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from canvas.native_values import called as run
from canvas.native_values import near, plain
from hookean_canvas.run.natives import BY_NAME, Unfit, shapes
from hookean_canvas.run.natives.along import straight
from hookean_canvas.run.rhino import rhino3dm

RING = [("point", 3, 0, 1), ("point", 0, 3, 1), ("point", -3, 0, 1), ("point", 0, -3, 1)]
GUIDE = ("line", (0, 0, 0), (1, 0, 0))
HALF = math.sqrt(0.5)


def points(*rows: tuple[float, ...]) -> list[Any]:
    return [("point", *row) for row in rows]


def test_a_line_is_fitted_from_the_first_to_the_last_point() -> None:
    assert near(run("Fit Line", points((0, 1, 0), (1, -1, 0), (3, -1, 0), (4, 1, 0)))[0], ((0, 0, 0), (4, 0, 0)))
    assert near(run("Fit Line", points((2, 2, 0), (1, 1, 0), (0, 0, 0)))[0], ((2, 2, 0), (0, 0, 0)))


def test_a_circle_is_fitted_to_points_on_it() -> None:
    _, radius, off = run("Circle Fit", RING)
    assert near([radius, off], [3, 0])
    with pytest.raises(Unfit, match="on a line"):
        run("Circle Fit", points((0, 0, 0), (1, 0, 0), (2, 0, 0)))


def test_the_incircle_of_3_4_5_has_the_radius_1() -> None:
    _, plane, radius = run("InCircle", *points((0, 0, 0), (4, 0, 0), (0, 3, 0)))
    assert near([radius, plane[0]], [1, (1, 1, 0)])


def test_lines_are_cut_by_points_and_by_planes() -> None:
    assert near(run("Line 4Pt", GUIDE, *points((2, 5, 0), (7, 0, 1)))[0], ((2, 0, 0), (7, 0, 0)))
    planes = [("plane", (x, 0, 0), (0, 1, 0), (0, 0, 1)) for x in (-1, 3)]
    assert near(run("Line 2Plane", GUIDE, *planes)[0], ((-1, 0, 0), (3, 0, 0)))


def test_a_curve_through_points_in_a_row_is_straight_and_keeps_the_directions_of_its_ends() -> None:
    row = points((0, 0, 0), (1, 0, 0), (3, 0, 0))
    assert near(run("Interpolate (t)", row, ("vector", 2, 0, 0), ("vector", 1, 0, 0), 1)[1], 3)
    curve = BY_NAME["Interpolate (t)"].run([shapes.point(at) for at in ((0, 0, 0), (1, 1, 0), (3, 0, 0))],
                                           shapes.vector((0, 1, 0)), shapes.vector((0, -5, 0)), 2)[0]  # fmt: skip
    ends = [curve.PointAtStart, curve.PointAtEnd, curve.TangentAtStart, curve.TangentAtEnd]
    assert near([plain(one) for one in ends], [(0, 0, 0), (3, 0, 0), (0, 1, 0), (0, -1, 0)])


def test_a_quarter_of_a_circle_is_a_curve_of_weights_and_knots() -> None:
    corner = points((1, 0, 0), (1, 1, 0), (0, 1, 0))
    assert near(run("Nurbs Curve PWK", corner, [1.0, HALF, 1.0], [0.0, 0.0, 1.0, 1.0])[1], math.pi / 2)
    with pytest.raises(Unfit, match="as many weights as points"):
        run("Nurbs Curve PWK", corner, [1.0], [0.0, 0.0, 1.0, 1.0])


@pytest.mark.parametrize("kind", ["polyline", "nurbs", "uneven"])
def test_a_line_that_crosses_itself_is_divided_in_order(kind: str) -> None:
    """Both points at the crossing are on their own parts, also where a point is sought by samples."""
    corners = [(-1, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, -1, 0)]
    curve = shapes.polyline(corners)
    if kind != "polyline":
        curve = curve.ToNurbsCurve()
    if kind == "uneven":
        curve.Domain = rhino3dm.Interval(0.0, 40.0)
    scale = 10.0 if kind == "uneven" else 1.0
    places, _, at = BY_NAME["Divide Curve"].run(curve, 6, False)
    wanted = [(-1, 0, 0), (0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 0), (0, -1, 0)]
    assert near([plain(one) for one in places], wanted)
    assert near(at, [t * scale for t in (0, 0.5, 1, 2, 3, 3.5, 4)])


def test_the_nearest_point_of_a_polyline_and_its_lengths_are_had_at_once() -> None:
    run = straight(shapes.polyline([(0, 0, 0), (2, 0, 0), (2, 1, 0)]))
    assert run is not None and straight(shapes.polyline([(0, 0, 0), (1, 0, 0)]).ToNurbsCurve()) is None
    found = [run.nearest(np.array(at, dtype=float)) for at in ((1.5, 3, 0), (5, 0.25, 0), (-9, 0, 0))]
    assert near([*found, *run.at_lengths([0.5, 2.5])], [2.0, 1.25, 0.0, 0.25, 1.5])


def test_a_mesh_is_read_once_for_a_component_and_again_for_the_next() -> None:
    mesh = shapes.mesh([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)])
    with shapes.kept([mesh, None, 3.0]):
        first, faces = shapes.mesh_parts(mesh)
        first += 9.0
        faces.clear()
        mesh.Transform(rhino3dm.Transform.Translation(5.0, 5.0, 5.0))
        again, whole = shapes.mesh_parts(mesh)
        assert near(again[0].tolist(), [0, 0, 0]) and whole == [(0, 1, 2)]
    assert near(shapes.mesh_parts(mesh)[0][0].tolist(), [5, 5, 5])
