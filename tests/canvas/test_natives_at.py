"""Natives that evaluate curves and surfaces, against closed forms; those of lists; older versions of natives."""

from __future__ import annotations

import math
from typing import Any
from uuid import UUID

import numpy as np
import pytest

from canvas.kangaroo_samples import Kangaroo
from canvas.native_values import called as run
from canvas.native_values import made, near, plain
from canvas.natives_table import XY
from hookean_canvas.archive import Type
from hookean_canvas.archive.parts import parts
from hookean_canvas.run import graph
from hookean_canvas.run.evaluate import Canvas
from hookean_canvas.run.natives import BY_NAME, PLUGINS, shapes
from hookean_canvas.run.natives.surfaces_at import Domain2
from hookean_canvas.run.rhino import rhino3dm

SQUARE = [(0, 0, 0), (4, 0, 0), (4, 4, 0), (0, 4, 0), (0, 0, 0)]


def native(name: str) -> Any:
    return (BY_NAME.get(name) or PLUGINS[name]).run


def saddle() -> Any:
    """z = x y on [0, 2] x [0, 2], ruled between two lines; its parameters are 0 to 1."""
    ends = (((0, 0, 0), (2, 0, 0)), ((0, 2, 0), (2, 2, 4)))
    lines = [rhino3dm.LineCurve(shapes.point(a), shapes.point(b)) for a, b in ends]
    return rhino3dm.NurbsSurface.CreateRuledSurface(*lines)


def ball(radius: float = 2.0) -> Any:
    return rhino3dm.NurbsSurface.CreateFromSphere(rhino3dm.Sphere(rhino3dm.Point3d(0, 0, 0), radius))


def circle(radius: float = 2.0) -> Any:
    return rhino3dm.ArcCurve.CreateFromCircle(rhino3dm.Circle(radius))


def ends(surface: Any) -> list[tuple[float, float]]:
    return [(surface.Domain(i).T0, surface.Domain(i).T1) for i in (0, 1)]


def test_a_surface_is_evaluated_at_its_parameters() -> None:
    """On a sphere the normal is radial and both directions are tangent; on z = x y they are known."""
    surface = saddle()
    (u0, u1), (v0, v1) = ends(surface)
    uv = made(("point", u0 + 0.25 * (u1 - u0), v0 + 0.5 * (v1 - v0), 0.0))
    at, normal, u, v, frame = native("Evaluate Surface")(surface, uv)
    x, y, z = plain(at)
    assert z == pytest.approx(x * y) and {x, y} == {0.5, 1.0}
    slopes = np.array([-y, x, 1.0]) * [1.0, -1.0, 1.0]  # the gradient of z - x y is (-y, -x, 1)
    n = shapes.xyz(normal)
    assert abs(n @ slopes) == pytest.approx(np.linalg.norm(slopes))
    for direction in (u, v):
        assert shapes.xyz(direction) @ n == pytest.approx(0.0, abs=1e-9)
        assert np.linalg.norm(shapes.xyz(direction)) == pytest.approx(1.0)
    assert shapes.xyz(frame.ZAxis) == pytest.approx(n) and plain(frame.Origin) == plain(at)


def test_the_closest_point_of_a_sphere_is_on_the_ray() -> None:
    p = np.array([1.0, 2.0, 2.5])
    at, uv, distance = native("Surface Closest Point")(shapes.point(p), ball())
    assert shapes.xyz(at) == pytest.approx(2.0 * p / np.linalg.norm(p), abs=1e-6)
    assert distance == pytest.approx(np.linalg.norm(p) - 2.0, abs=1e-9)
    assert plain(ball().PointAt(uv.X, uv.Y)) == pytest.approx(plain(at))


@pytest.mark.parametrize("surface", [saddle(), ball()], ids=["bilinear", "rational"])
def test_isotrim_is_the_same_surface_within_its_domain(surface: Any) -> None:
    (u0, u1), (v0, v1) = ends(surface)
    part = Domain2((u0 + 0.2 * (u1 - u0), u0 + 0.7 * (u1 - u0)), (v0 + 0.1 * (v1 - v0), v0 + 0.45 * (v1 - v0)))
    found = native("Isotrim")(surface, part)[0]
    assert ends(found) == [pytest.approx(part.u), pytest.approx(part.v)]
    for s in (0.0, 0.3, 1.0):
        for t in (0.0, 0.6, 1.0):
            u, v = part.u[0] + s * (part.u[1] - part.u[0]), part.v[0] + t * (part.v[1] - part.v[0])
            assert plain(found.PointAt(u, v)) == pytest.approx(plain(surface.PointAt(u, v)), abs=1e-12)
    whole = native("Isotrim")(surface, Domain2((u0, u1), (v0, v1)))[0]
    assert ends(whole) == [pytest.approx((u0, u1)), pytest.approx((v0, v1))]


def test_a_domain_is_divided_in_rows_and_a_surface_is_one() -> None:
    (parts_,) = native("Divide Domain²")(Domain2((0.0, 2.0), (0.0, 3.0)), 2, 3)
    assert parts_[1] == Domain2((0.0, 1.0), (1.0, 2.0)) and len(parts_) == 6
    surface = saddle()
    (whole,) = native("Divide Domain²")(surface, 1, 1)
    assert whole == [Domain2(*ends(surface))]
    assert native("Construct Domain²")(0.0, 1.0, 2.0, 3.0)[0] == Domain2((0.0, 1.0), (2.0, 3.0))
    domains = [rhino3dm.Interval(0, 1), rhino3dm.Interval(2, 3)]
    assert native("Construct Domain²")(*domains)[0] == Domain2((0.0, 1.0), (2.0, 3.0))


def test_flat_surfaces_and_their_simple_meshes_have_the_given_corners() -> None:
    corners = [(0, 0, 0), (3, 0, 0), (3, 2, 1), (0, 2, 0)]
    (surface,) = native("4Point Surface")(*(shapes.point(p) for p in corners))
    vertices, faces = plain(native("Simple Mesh")(surface)[0])
    assert sorted(map(tuple, vertices)) == sorted((float(x), float(y), float(z)) for x, y, z in corners)
    assert faces == [(0, 1, 2, 3)]
    (plane,) = native("Plane Surface")(made(XY), rhino3dm.Interval(-1, 2), rhino3dm.Interval(0, 5))
    vertices, _ = plain(native("Simple Mesh")(plane)[0])
    assert sorted(map(tuple, vertices)) == [(-1, 0, 0), (-1, 5, 0), (2, 0, 0), (2, 5, 0)]


def test_frames_across_a_circle_hold_its_axis_and_level_ones_are_horizontal() -> None:
    """A plane curve is followed without twist, so that a direction across it keeps its angle to the normal."""
    frames, at = native("Perp Frames")(circle(), 8, True)
    assert len(frames) == len(at) == 8
    for frame in frames:
        place, x, _, z = shapes.axes(frame)
        assert np.linalg.norm(place) == pytest.approx(2.0) and z @ place == pytest.approx(0.0, abs=1e-9)
        assert abs(z[2]) < 1e-9 and x[2] == pytest.approx(shapes.axes(frames[0])[1][2], abs=1e-9)
    level, _ = native("Horizontal Frames")(made([(0, 0, 0), (3, 4, 12)]), 2)
    for frame, origin in zip(level, ((0, 0, 0), (1.5, 2, 6), (3, 4, 12)), strict=True):
        assert near(plain(frame), (origin, (0.6, 0.8, 0.0), (-0.8, 0.6, 0.0)))


def test_points_are_found_on_in_and_outside_curves() -> None:
    at, t, distance = native("Curve Closest Point")(shapes.point((3.0, 4.0, 0.0)), circle())
    assert plain(at) == pytest.approx((1.2, 1.6, 0.0), abs=1e-6) and distance == pytest.approx(3.0)
    assert plain(circle().PointAt(t)) == pytest.approx(plain(at))
    assert near(run("Curve Closest Point", ("point", 5, 1, 2), SQUARE)[0], (4, 1, 0))
    for place, relation in (((1, 1, 5), 2), ((4, 1, 0), 1), ((5, 1, 0), 0)):
        found, flat = run("Point In Curve", ("point", *place), SQUARE)
        assert found == relation and near(flat, (*place[:2], 0))
    assert native("Point In Curve")(shapes.point((1.9, 0.0, 0.0)), circle())[0] == 2


def test_centres_of_a_polygon_are_those_of_corners_edges_and_area() -> None:
    """A right triangle: corners (1, 1), edges by their lengths 3, 4, 5, area (1, 4/3)."""
    corners, edges, area = run("Polygon Center", [(0, 0, 0), (3, 0, 0), (0, 4, 0), (0, 0, 0)])
    assert near(corners, (1, 4 / 3, 0)) and near(area, (1, 4 / 3, 0))
    assert near(edges, ((1.5 * 3 + 1.5 * 5) / 12, (2 * 5 + 2 * 4) / 12, 0))


def test_ellipses_rectangles_and_projections_are_as_drawn() -> None:
    found, one, other = native("Ellipse")(made(XY), 5.0, 3.0)
    assert near(plain(one), (4, 0, 0)) and near(plain(other), (-4, 0, 0))
    for t in np.linspace(found.Domain.T0, found.Domain.T1, 7):
        p = found.PointAt(float(t))
        assert math.isclose((p.X / 5) ** 2 + (p.Y / 3) ** 2, 1.0, rel_tol=1e-9)
    outline, around = run("Rectangle 3Pt", ("point", 0, 0, 0), ("point", 4, 0, 0), ("point", 7, 3, 0))
    assert around == pytest.approx(14.0) and near(outline, [(0, 0, 0), (4, 0, 0), (4, 3, 0), (0, 3, 0), (0, 0, 0)])
    assert near(run("Project", ("point", 1, 2, 3), XY)[0], (1, 2, 0))
    polyline, count = native("Curve To Polyline")(circle(), None, None, None, None)
    assert count == 100 and shapes.corners(polyline) is not None
    length = sum(np.linalg.norm(np.diff(shapes.corners(polyline), axis=0), axis=1))
    assert length == pytest.approx(2.0 * 100 * 2.0 * math.sin(math.pi / 100), rel=1e-6)


def test_sets_and_streams_are_joined_and_sifted() -> None:
    assert run("Set Union", [1, 2, 2], [3, 1]) == [[1, 2, 3]]
    assert run("Set Difference", [1, 2, 2, 4], [1]) == [[2, 4]]
    assert run("Set Intersection", [1, 2, 2, 4], [4, 2]) == [[2, 4]]
    assert run("Combine Data", None, 7) == [7, 1]
    assert native("Combine Data")(None, None) == (None, -1)
    assert native("Sift Pattern")([1, 2, 3], [0, 1], node=None) == ([1, None, 3], [None, 2, None])
    assert run("Pick'n'Choose", [0, 1, 1], [1, 2, 3], [4, 5, 6]) == [[1, 5, 6]]
    assert plain(native("Consecutive Domains")([1.0, 2.0], True)[0]) == [(0, 1), (1, 3)]
    assert plain(native("Consecutive Domains")([1.0, 2.0, 5.0], False)[0]) == [(1, 2), (2, 5)]


@pytest.mark.parametrize("plugin", [False, True])
def test_an_older_version_of_a_native_is_taken_as_the_present_one(plugin: bool) -> None:
    """Known by its name and the names of all inputs and outputs; a plug-in's component of the same name is another."""
    d = Kangaroo("older", "Older", "An id that nothing knows.")
    negative = d.native("Negative", value=d.slider("x", 3, 0, 9))
    d.panel("result", negative)
    root = d.archive()
    chunk = next(part.chunk for part in parts(root) if part.name == "Negative")
    chunk.put("GUID", Type.GUID, UUID(int=7))
    if plugin:
        chunk.put("Lib", Type.GUID, UUID(int=8))
        with pytest.raises(Exception, match="has no stand-in"):
            Canvas(graph.of(root))
    else:
        assert Canvas(graph.of(root)).run().panels["result"].values_in_order() == [-3.0]


def test_an_older_version_may_lack_an_input_and_have_others_in_another_order() -> None:
    """Series by its count and its start alone: the step is 1."""
    d = Kangaroo("fewer", "Fewer", "An older Series.")
    count, start = d.slider("Count", 3, 0, 9), d.slider("Start", 5, 0, 9)
    older = d.native_like("Series", str(UUID(int=7)), ["Count", "S"], "Series", count=count, s=start)
    d.panel("result", older)
    assert Canvas(graph.of(d.archive())).run().panels["result"].values_in_order() == [5.0, 6.0, 7.0]
    strange = Kangaroo("strange", "Strange", "An input that the present one lacks.")
    strange.panel("result", strange.native_like("Series", str(UUID(int=7)), ["Count", "Seed"], "Series"))
    with pytest.raises(Exception, match="has no stand-in"):
        Canvas(graph.of(strange.archive()))
