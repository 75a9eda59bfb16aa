"""Natives beside the usual ones, each on values with a known answer: neighbours, planes, meetings, changed curves."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from canvas.native_values import called as run
from canvas.native_values import made, near, plain
from canvas.natives_table import XY
from hookean.discretize import curves as arc_lengths
from hookean_canvas.run.natives import BY_NAME, Unfit, shapes
from hookean_canvas.run.natives.planes import align_plane
from hookean_canvas.run.rhino import rhino3dm

P = [("point", x, y, 0) for x, y in ((0, 0), (1, 0), (3, 0), (3, 4))]
SQUARE = [(0, 0, 0), (4, 0, 0), (4, 4, 0), (0, 4, 0), (0, 0, 0)]
HALF = 1.0 / math.sqrt(2.0)
BOX = (
    "mesh", [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2)],
    [(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)],
)  # fmt: skip
UP = ("plane", (0, 0, 1), (1, 0, 0), (0, 1, 0))


def circle(radius: float = 2.0) -> Any:
    return rhino3dm.ArcCurve.CreateFromCircle(rhino3dm.Circle(radius))


def line(*ends: tuple[float, float, float]) -> tuple[Any, ...]:
    return ("line", *ends)


def size(curve: Any) -> float:
    return arc_lengths.length(curve)


CASES: list[tuple[str, tuple[Any, ...], tuple[Any, ...]]] = [
    ("Proximity 3D", (P, 1, None, None),
     ([[[(0, 0, 0), (1, 0, 0)]], [[(1, 0, 0), (0, 0, 0)]], [[(3, 0, 0), (1, 0, 0)]], [[(3, 4, 0), (3, 0, 0)]]],
      [[1], [0], [1], [2]])),
    ("Proximity 2D", (P, ("plane", (0, 0, 0), (1, 0, 0), (0, 0, 1)), 2, None, 1.5),
     ([[[(0, 0, 0), (1, 0, 0)]], [[(1, 0, 0), (0, 0, 0)]], [[(3, 0, 0), (3, 4, 0)]], [[(3, 4, 0), (3, 0, 0)]]],
      [[1], [0], [3], [2]])),
    ("Point Groups", (P, 2.0), ([[(0, 0, 0), (1, 0, 0), (3, 0, 0)], [(3, 4, 0)]], [[0, 1, 2], [3]])),
    ("Project Point", (("point", 1, 0.5, 9), ("vector", 0, 0, -1), [BOX]), ((1, 0.5, 2), 0)),
    ("Point Oriented", (("plane", (1, 0, 0), (0, 1, 0), (0, 0, 1)), 2.0, 3.0, 4.0), ((5, 2, 3),)),
    ("Point Cylindrical", (XY, math.pi / 2, 2.0, 5.0), ((0, 2, 5),)),
    ("Point Polar", (XY, math.pi / 2, math.pi / 4, math.sqrt(8.0)), ((0, 2, 2),)),
    ("To Polar", (("point", 0, -2, 2), XY), (1.5 * math.pi, math.pi / 4, math.sqrt(8.0))),
    ("Barycentric", (*P[:2], P[3], 1.0, 2.0, 1.0), ((1.25, 1, 0),)),
    ("Sort Along Curve", ([P[2], P[0], P[1]], [(0, 0, 0), (5, 0, 0)]), ([(0, 0, 0), (1, 0, 0), (3, 0, 0)], [1, 2, 0])),
    ("Adjust Plane", (XY, ("vector", 1, 0, 0)), (((0, 0, 0), (0, 0, -1), (0, 1, 0)),)),
    ("Align Plane", (XY, ("vector", 0, 3, 7)), (((0, 0, 0), (0, 1, 0), (-1, 0, 0)), math.pi / 2)),
    ("Align Planes", ([XY, ("plane", (5, 0, 0), (0, 1, 0), (-1, 0, 0))], None),
     ([((0, 0, 0), (1, 0, 0), (0, 1, 0)), ((5, 0, 0), (1, 0, 0), (0, 1, 0))],)),
    ("Flip Plane", (XY, True, False, False), (((0, 0, 0), (-1, 0, 0), (0, 1, 0)),)),
    ("Flip Plane", (XY, False, False, True), (((0, 0, 0), (0, 1, 0), (1, 0, 0)),)),
    ("Line + Line", (line((1, 0, 0), (3, 0, 0)), line((0, 1, 0), (1, 2, 0))), (((1, 0, 0), (1, 0, 0), (0, 1, 0)),)),
    ("Line + Pt", (line((1, 0, 0), (3, 0, 0)), ("point", 9, 0, 4)), (((1, 0, 0), (1, 0, 0), (0, 0, 1)),)),
    ("Plane Closest Point", (("point", 1, 2, 5), UP), ((1, 2, 1), (1, 2, 0), 4.0)),
    ("Plane Coordinates", (("point", 1, 2, 5), ("plane", (1, 0, 0), (0, 1, 0), (0, 0, 1))), (2.0, 5.0, 0.0)),
    ("Line | Plane", (line((1, 2, 0), (1, 2, 4)), UP), ((1, 2, 1), 0.25, (1, 2, 0))),
    ("Line | Line", (line((0, 0, 0), (4, 0, 0)), line((1, -1, 3), (1, 3, 3))), (0.25, 0.25, (1, 0, 0), (1, 0, 3))),
    ("Curve | Plane", ([(0, 0, 0), (0, 0, 4), (0, 3, 0)], UP), ([(0, 0, 1), (0, 2.25, 1)], [0.25, 1.75],
     [(0, 0, 0), (0, 2.25, 0)])),
    ("Curve | Line", ([(0, 0, 0), (4, 4, 0)], line((0, 2, 0), (4, 2, 0))), ([(2, 2, 0)], [0.5], 1)),
    ("Mesh | Ray", (BOX, ("point", 1, 1, 9), ("vector", 0, 0, -1)), ((1, 1, 2), True)),
    ("Mesh | Ray", (BOX, ("point", 1, 1, 9), ("vector", 0, 0, 1)), (None, False)),
    ("Mesh | Curve", (BOX, [(1, 0.5, 9), (1, 0.5, -9)]), ([(1, 0.5, 2), (1, 0.5, 0)], [None, None])),
    ("Fillet", ([(0, 0, 0), (4, 0, 0)], 1.0), ([(0, 0, 0), (4, 0, 0)],)),
    ("Reduce", ([(0, 0, 0), (1, 0.05, 0), (2, 0, 0), (2, 3, 0)], 0.1), ([(0, 0, 0), (2, 0, 0), (2, 3, 0)], 1)),
    ("Simplify Curve", ([(0, 0, 0), (1, 0, 0), (2, 0, 0)], None, None), ([(0, 0, 0), (2, 0, 0)], True)),
    ("Smooth Polyline", ([(0, 0, 0), (1, 2, 0), (2, 0, 0)], 0.5, 1), ([(0, 0, 0), (1, 1, 0), (2, 0, 0)],)),
    ("Polyline Collapse", ([(0, 0, 0), (0.1, 0, 0), (2, 0, 0)], 0.5), ([(0, 0, 0), (2, 0, 0)], 1)),
    ("Tween Curve", ([(0, 0, 0), (2, 0, 0)], [(0, 4, 0), (4, 4, 0)], 0.25), ([(0, 1, 0), (2.5, 1, 0)],)),
    ("Length Parameter", ([(0, 0, 0), (3, 0, 0), (3, 4, 0)], 1.25), (4.0, 3.0)),
    ("Length Domain", ([(0, 0, 0), (3, 0, 0), (3, 4, 0)], ("domain", 1 / 3, 1.25)), (3.0,)),
    ("Deconstuct Rectangle", ((shapes.plane((1, 0, 0), (1, 0, 0), (0, 1, 0)), 2.0, 3.0),),
     (((1, 0, 0), (1, 0, 0), (0, 1, 0)), (0, 2), (0, 3))),
    ("Control Polygon", ([(0, 0, 0), (3, 0, 0), (3, 4, 0)],), ([(0, 0, 0), (3, 0, 0), (3, 4, 0)],
     [(0, 0, 0), (3, 0, 0), (3, 4, 0)])),
    ("Curve Side", ([(0, 0, 0), (4, 0, 0)], ("point", 1, 2, 0), XY), (-1, True, False)),
    ("Curve Side", ([(0, 0, 0), (4, 0, 0)], ("point", 1, -2, 0), None), (1, False, True)),
    ("Point in Curves", (("point", 1, 1, 0), [[(9, 9, 0), (10, 9, 0), (10, 10, 0), (9, 9, 0)], SQUARE]),
     (2, 1, (1, 1, 0))),
    ("Extend Curve", ([(0, 0, 0), (2, 0, 0)], 0, 1.0, 3.0), ([(-1, 0, 0), (5, 0, 0)],)),
    ("Extend Curve", ([(0, 0, 0), (2, 0, 0), (2, 2, 0)], 0, 1.0, 1.0), ([(-1, 0, 0), (0, 0, 0), (2, 0, 0), (2, 2, 0),
     (2, 3, 0)],)),
]  # fmt: skip


@pytest.mark.parametrize(("name", "given", "expected"), CASES, ids=lambda part: str(part)[:40])
def test_a_native_does_what_its_tooltip_describes(name: str, given: Any, expected: Any) -> None:
    found = run(name, *given)
    assert near(found, list(expected)), found


def test_planes_meet_in_a_line_and_three_of_them_in_a_point() -> None:
    x, y, z = (1, 0, 0), (0, 1, 0), (0, 0, 1)
    frames = ((0, 0, 1), x, y), ((2, 0, 0), y, z), ((0, 3, 0), z, x)
    a, b, c = (made(("plane", *one)) for one in frames)
    both = plain(BY_NAME["Plane | Plane"].run(a, b)[0])
    assert near([row[0] for row in both], [2, 2]) and near([row[2] for row in both], [1, 1])
    assert near(plain(BY_NAME["Plane | Plane | Plane"].run(a, b, c)[0]), (2, 3, 1))
    with pytest.raises(Unfit, match="parallel"):
        BY_NAME["Plane | Plane"].run(a, a)


def test_a_plane_cuts_a_box_in_its_outline() -> None:
    """A square of side 2 at half height; the diagonals of faces that are cut add corners on its sides."""
    for name, given in (("Mesh | Plane", made(BOX)), ("Brep | Plane", rhino3dm.BoundingBox(0, 0, 0, 2, 2, 2).ToBrep())):
        (outline,) = BY_NAME[name].run(given, made(UP))[0]
        rows = shapes.corners(outline)
        assert rows is not None and outline.IsClosed and size(outline) == pytest.approx(8.0)
        assert np.ptp(rows, axis=0).tolist() == pytest.approx([2, 2, 0]) and set(rows[:, 2].round(9)) == {1.0}


def test_contours_lie_at_equal_distances_through_the_start() -> None:
    (branches,) = BY_NAME["Contour"].run(made(BOX), made(("point", 0, 0, 0.5)), made(("vector", 0, 0, 2)), 0.75)
    heights = [plain(one)[0][2] for (one,) in branches]
    assert heights == pytest.approx([0.5, 1.25, 2.0])
    assert [size(one) for (one,) in branches] == pytest.approx([8.0, 8.0, 8.0])


def test_a_circle_meets_a_plane_where_its_equation_says() -> None:
    """x^2 + y^2 = 4 and x = 1: y = +-sqrt 3."""
    frame = made(("plane", (1, 0, 0), (0, 1, 0), (0, 0, 1)))
    places, at, flat = BY_NAME["Curve | Plane"].run(circle(), frame)
    assert near(sorted(plain(one)[1] for one in places), [-math.sqrt(3), math.sqrt(3)])
    assert near([plain(circle().PointAt(t)) for t in at], [plain(one) for one in places]) and len(flat) == 2


def test_curves_are_nearest_where_they_are() -> None:
    """A circle of radius 2 and the line x = 5 are 3 apart; two skew lines by their common normal."""
    a, b, apart = BY_NAME["Curve Proximity"].run(circle(), made([(5, -3, 0), (5, 4, 0)]))
    assert apart == pytest.approx(3.0) and np.linalg.norm(np.array(plain(a)) - (2, 0, 0)) < 1e-3 > abs(plain(b)[1])
    found = BY_NAME["Curve Proximity"].run(made([(0, 0, 0), (4, 0, 0)]), made([(1, -1, 3), (1, 3, 3)]))
    assert found[2] == pytest.approx(3.0)


def test_curvature_torsion_and_frames_follow_a_circle_and_a_helix() -> None:
    at, k, around = BY_NAME["Curvature"].run(circle(), 1.0)
    assert near(list(plain(k)), [-0.25 * x for x in plain(at)])
    assert size(around) == pytest.approx(4 * math.pi) and plain(around.PointAt(0.7))[2] == pytest.approx(0.0)
    assert BY_NAME["Curvature"].run(made([(0, 0, 0), (4, 0, 0)]), 1.0)[2] is None
    _, flat = BY_NAME["Torsion"].run(circle(), 1.0)
    assert flat == pytest.approx(0.0)
    _, x, y = (np.array(row) for row in plain(BY_NAME["Curve Frame"].run(circle(), 1.0)[0]))
    assert x @ np.array(plain(at)) == pytest.approx(0.0) and y @ np.array(plain(at)) == pytest.approx(-2.0)


def test_an_arc_is_taken_apart_into_plane_radius_and_angles() -> None:
    arc = BY_NAME["Arc"].run(made(("plane", (1, 0, 0), (0, 1, 0), (0, 0, 1))), 2.0, made(("domain", 0.0, 1.5)))[0]
    frame, radius, angles = BY_NAME["Deconstruct Arc"].run(arc)
    assert near([plain(frame), radius, plain(angles)], [((1, 0, 0), (0, 1, 0), (0, 0, 1)), 2.0, (0.0, 1.5)])
    assert BY_NAME["Deconstruct Arc"].run(circle())[1] == pytest.approx(2.0)


def test_planar_and_extremes_measure_a_tilted_circle() -> None:
    """A circle of radius 2 turned by 30 degrees about x reaches 2 sin 30 = 1 over its plane, at y = 2 cos 30."""
    tilted = circle()
    tilted.Transform(rhino3dm.Transform.Rotation(math.pi / 6, rhino3dm.Vector3d(1, 0, 0), rhino3dm.Point3d(0, 0, 0)))
    flat, frame, apart = BY_NAME["Planar"].run(tilted)
    assert flat and apart < 1e-9 and abs(plain(frame)[0][2]) < 1e-6
    (high,), (low,) = BY_NAME["Extremes"].run(tilted, made(XY))
    assert near([plain(high), plain(low)], [(0, math.sqrt(3), 1), (0, -math.sqrt(3), -1)])


def test_fillets_shorten_a_square_by_what_arcs_save() -> None:
    """A corner of 90 degrees with radius r: 2 r of straight line become an arc of pi r / 2."""
    for name in ("Fillet", "Fillet Distance"):
        rounded = BY_NAME[name].run(made(SQUARE), 1.0)[0]
        assert rounded.IsClosed and size(rounded) == pytest.approx(16.0 - 4 * (2.0 - math.pi / 2))
    sharp = BY_NAME["Fillet"].run(made(SQUARE), 3.0)[0]
    assert size(sharp) == pytest.approx(16.0)  # no room for it


@pytest.mark.soak
def test_a_rebuilt_line_is_the_line_and_a_rebuilt_circle_stays_near() -> None:
    rebuilt = BY_NAME["Rebuild Curve"].run(made([(0, 0, 0), (4, 0, 0)]), 3, 6, False)[0]
    assert len(rebuilt.Points) == 6 and rebuilt.Degree == 3
    assert near([plain(rebuilt.PointAtStart), plain(rebuilt.PointAtEnd)], [(0, 0, 0), (4, 0, 0)])
    round_ = BY_NAME["Rebuild Curve"].run(circle(), 3, 24, False)[0]
    radii = [np.linalg.norm(plain(round_.PointAt(t))) for t in np.linspace(0.0, round_.Domain.T1, 50)]
    assert np.abs(np.array(radii) - 2.0).max() < 2e-3  # h^4 / 384 r'''' with pieces of 2 pi 2 / 21
    fine = BY_NAME["Fit Curve"].run(circle(), 3, 1e-4)[0]
    assert len(fine.Points) < 60


def test_a_seam_moves_and_the_curve_keeps_its_length() -> None:
    moved = BY_NAME["Seam"].run(made(SQUARE), 1.5)[0]
    assert moved.IsClosed and size(moved) == pytest.approx(16.0) and near(plain(moved.PointAtStart), (4, 2, 0))
    with pytest.raises(Unfit, match="not closed"):
        BY_NAME["Seam"].run(made([(0, 0, 0), (1, 0, 0)]), 0.5)


def test_dashes_and_gaps_share_a_curve() -> None:
    dashes, gaps = BY_NAME["Dash Pattern"].run(made([(0, 0, 0), (10, 0, 0)]), [3.0, 1.0])
    assert [size(one) for one in dashes] == pytest.approx([3, 3, 2]) and [size(one) for one in gaps] == pytest.approx(
        [1, 1]
    )


def test_a_curve_is_trimmed_by_regions() -> None:
    inside, outside = BY_NAME["Trim with Region"].run(made([(-2, 1, 0), (6, 1, 0)]), [made(SQUARE)], None)
    assert [size(one) for one in inside] == pytest.approx([4.0])
    assert [size(one) for one in outside] == pytest.approx([2.0, 2.0])


def test_a_blend_goes_on_along_both_tangents() -> None:
    a, b = made([(0, 0, 0), (1, 0, 0)]), made([(3, 2, 0), (3, 4, 0)])
    blend = BY_NAME["Blend Curve"].run(a, b, 1.0, 1.0, 1)[0]
    ends = [plain(blend.PointAtStart), plain(blend.PointAtEnd), plain(blend.TangentAtStart), plain(blend.TangentAtEnd)]
    assert near(ends, [(1, 0, 0), (3, 2, 0), (1, 0, 0), (0, 1, 0)])
    straight = BY_NAME["Connect Curves"].run([a, b], 0, False, 1.0)[0]
    assert size(straight) == pytest.approx(3.0 + math.sqrt(8.0))
    assert BY_NAME["Connect Curves"].run([a, b], 1, True, 1.0)[0].IsClosed


@pytest.mark.soak
def test_a_curve_is_pulled_onto_a_surface() -> None:
    flat = BY_NAME["Plane Surface"].run(made(XY), made(("domain", 0, 4)), made(("domain", 0, 4)))[0]
    pulled = BY_NAME["Pull Curve"].run(made([(1, 1, 3), (3, 1, 5)]), flat)[0]
    assert near([plain(pulled.PointAtStart), plain(pulled.PointAtEnd)], [(1, 1, 0), (3, 1, 0)])


def test_the_hull_of_points_goes_round_them() -> None:
    places = [made(("point", x, y, 0)) for x, y in ((0, 0), (4, 0), (4, 4), (0, 4), (2, 2), (1, 3))]
    hull, _, numbers = BY_NAME["Convex Hull"].run(places, made(XY))
    assert size(hull) == pytest.approx(16.0) and sorted(numbers) == [0, 1, 2, 3]


def test_several_curves_meet_with_their_numbers() -> None:
    curves = [made([(0, 0, 0), (4, 0, 0)]), made([(1, -1, 0), (1, 1, 0)]), made([(2, -1, 0), (2, 1, 0)])]
    places, first, second, _, _ = BY_NAME["Multiple Curves"].run(curves)
    assert near([plain(one) for one in places], [(1, 0, 0), (2, 0, 0)]) and (first, second) == ([0, 0], [1, 2])
    assert BY_NAME["Multiple Curves"].run(curves[1:])[0] == []


def test_derivatives_and_nearest_objects() -> None:
    """A line with parameters from 0 to 1: its derivative is the way to its end; of two points the second is nearer."""
    along = made([(0, 0, 0), (0, 5, 0)])
    at, first = BY_NAME["Derivatives"].run(along, 0.4, node=None)
    assert near([plain(at), plain(first)], [(0, 2, 0), (0, 5, 0)])
    near_by = [made(("point", 9, 0, 0)), made(("point", 1, 2.5, 0))]
    a, b, number = BY_NAME["Curve Nearest Object"].run(along, near_by)
    assert near([plain(a), plain(b), number], [(0, 2.5, 0), (1, 2.5, 0), 1])


def test_a_plane_keeps_its_axes_where_the_guide_is_its_normal() -> None:
    assert align_plane(made(XY), made(("vector", 0, 0, 5)))[1] == 0.0
