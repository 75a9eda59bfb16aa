"""Natives that make, measure and change curves and meshes, on shapes with known answers."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from canvas.native_values import called as run
from canvas.native_values import made, near, plain
from canvas.natives_table import XY
from hookean.discretize import measures
from hookean_canvas.run.natives import BY_NAME, Unfit, as_kind, shapes
from hookean_canvas.run.rhino import rhino3dm

SQUARE = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 0)]
TRIANGLES = ("mesh", [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [(0, 1, 2), (0, 2, 3)])
QUAD = ("mesh", [(0, 0, 0), (2, 0, 0), (2, 1, 0), (0, 1, 0)], [(0, 1, 2, 3)])
PAIR = ("mesh", [(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [(0, 1, 2), (3, 4, 5)])
"""Two triangles that meet at an edge whose vertices they do not share."""


def line(*ends: tuple[float, ...]) -> tuple[Any, ...]:
    return ("line", *ends)


@pytest.mark.parametrize(
    ("name", "given", "expected"),
    [
        ("Line", (("point", 0, 0, 0), ("point", 1, 2, 3)), [[(0, 0, 0), (1, 2, 3)]]),
        ("Line SDL", (("point", 1, 0, 0), ("vector", 0, 0, 5), 2.0), [[(1, 0, 0), (1, 0, 2)]]),
        ("PolyLine", ([("point", 0, 0, 0), ("point", 1, 0, 0), ("point", 1, 1, 0)], True),
         [[(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 0, 0)]]),
        ("Rectangle", (XY, ("domain", 0, 2), ("domain", 0, 2), 0.0), [SQUARE, 8.0]),
        ("Rectangle 2Pt", (XY, ("point", 0, 0, 0), ("point", 2, 2, 0), 0.0), [SQUARE, 8.0]),
        ("Polygon", (XY, 1.0, 4, 0.0),
         [[(1, 0, 0), (0, 1, 0), (-1, 0, 0), (0, -1, 0), (1, 0, 0)], 4.0 * math.sqrt(2.0)]),
        ("End Points", (SQUARE[:3],), [(0, 0, 0), (2, 2, 0)]),
        ("Length", (SQUARE,), [8.0]),
        ("Curve Middle", (SQUARE[:3],), [(2, 0, 0)]),
        ("Divide Curve", ([(0, 0, 0), (4, 0, 0)], 2, False),
         [[(0, 0, 0), (2, 0, 0), (4, 0, 0)], [(1, 0, 0)] * 3, [0.0, 0.5, 1.0]]),
        ("Divide Length", ([(0, 0, 0), (4, 0, 0)], 1.5),
         [[(0, 0, 0), (1.5, 0, 0), (3, 0, 0)], [(1, 0, 0)] * 3, [0.0, 0.375, 0.75]]),
        ("Divide Distance", ([(0, 0, 0), (4, 0, 0)], 1.5),
         [[(0, 0, 0), (1.5, 0, 0), (3, 0, 0)], [(1, 0, 0)] * 3, [0.0, 0.375, 0.75]]),
        ("Evaluate Curve", (SQUARE, 1.0), [(2, 0, 0), (0, 1, 0), math.pi / 2]),
        ("Evaluate Length", ([(0, 0, 0), (4, 0, 0)], 0.25, True), [(1, 0, 0), (1, 0, 0), 0.25]),
        ("Explode", (SQUARE[:3], True), [[[(0, 0, 0), (2, 0, 0)], [(2, 0, 0), (2, 2, 0)]], SQUARE[:3]]),
        ("Discontinuity", (SQUARE[:3], 1), [SQUARE[:3], [0.0, 1.0, 2.0]]),
        ("Join Curves", ([line((0, 0, 0), (1, 0, 0)), line((1, 1, 0), (1, 0, 0)), line((5, 0, 0), (6, 0, 0))], False),
         [[[(0, 0, 0), (1, 0, 0), (1, 1, 0)], [(5, 0, 0), (6, 0, 0)]]]),
        ("Join Curves", ([line((0, 0, 0), (1, 0, 0)), line((1, 1, 0), (1, 0, 0))], True),
         [[[(0, 0, 0), (1, 0, 0)], [(1, 1, 0), (1, 0, 0)]]]),
        ("Closed", (SQUARE,), [True, False]),
        ("Flip Curve", (SQUARE[:2], None), [[(2, 0, 0), (0, 0, 0)], True]),
        ("Sub Curve", (SQUARE, ("domain", 0, 1)), [SQUARE[:2]]),
        ("Shatter", (SQUARE, [1.0, 3.0]), [[SQUARE[:2], SQUARE[1:4], SQUARE[3:]]]),
        ("Move", (("point", 1, 2, 3), ("vector", 1, 0, 0)), [(2, 2, 3)]),
        ("Scale", (line((1, 0, 0), (2, 0, 0)), ("point", 0, 0, 0), 3.0), [[(3, 0, 0), (6, 0, 0)]]),
        ("Scale NU", (SQUARE[:2], XY, 2.0, 1.0, 1.0), [[(0, 0, 0), (4, 0, 0)]]),
        ("Mirror", (("point", 1, 2, 3), XY), [(1, 2, -3)]),
        ("Orient", (("point", 1, 2, 0), XY, ("plane", (5, 0, 0), (0, 1, 0), (-1, 0, 0))), [(3, 1, 0)]),
        ("Linear Array", (("point", 0, 0, 0), ("vector", 1, 0, 0), 3), [[(0, 0, 0), (1, 0, 0), (2, 0, 0)]]),
        ("Polar Array", (("point", 1, 0, 0), XY, 2, 2 * math.pi), [[(1, 0, 0), (-1, 0, 0)]]),
        ("Mesh Plane", ((made(XY), 2.0, 1.0), 2, 1),
         [([[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 0], [1, 1, 0], [2, 1, 0]], [(0, 1, 4, 3), (1, 2, 5, 4)]), 2.0]),
        ("Mesh Edges", (TRIANGLES,),
         [[[(0, 0, 0), (1, 0, 0)], [(1, 0, 0), (1, 1, 0)], [(1, 1, 0), (0, 1, 0)], [(0, 0, 0), (0, 1, 0)]],
          [[(0, 0, 0), (1, 1, 0)]], []]),
        ("Face Boundaries", (QUAD,), [[[(0, 0, 0), (2, 0, 0), (2, 1, 0), (0, 1, 0), (0, 0, 0)]]]),
        ("Face Normals", (QUAD,), [[(1, 0.5, 0)], [(0, 0, 1)]]),
        ("Area", (QUAD,), [2.0, (1, 0.5, 0)]),
        ("Area", (SQUARE,), [4.0, (1, 1, 0)]),
        ("Flip Mesh", (QUAD, True, True, True), [(QUAD[1], [(3, 2, 1, 0)])]),
        ("Cull Faces", (TRIANGLES, [True, False]), [([(0, 0, 0), (1, 0, 0), (1, 1, 0)], [(0, 1, 2)])]),
        ("Delete Faces", (TRIANGLES, [0]), [([(0, 0, 0), (1, 1, 0), (0, 1, 0)], [(0, 1, 2)])]),
        ("Weld Mesh", (PAIR, math.pi), [([(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)], [(0, 1, 2), (1, 3, 2)])]),
        ("Triangulate", (("mesh", [(0, 0, 0), (2, 0, 0), (3, 2, 0), (0, 1, 0)], [(0, 1, 2, 3)]),),
         [([(0, 0, 0), (2, 0, 0), (3, 2, 0), (0, 1, 0)], [(0, 1, 3), (1, 2, 3)]), 1]),
        ("Combine&Clean", ([("mesh", PAIR[1][:3], [(0, 1, 2)]), ("mesh", PAIR[1][3:], [(0, 1, 2)])],),
         [([(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)], [(0, 1, 2), (1, 3, 2)])]),
        ("MeshCorners", (QUAD, 0.75 * math.pi), [[(0, 0, 0), (2, 0, 0), (2, 1, 0), (0, 1, 0)]]),
        ("MeshCorners", (QUAD, 0.4 * math.pi), [[]]),
        ("removeDuplicatePts", ([("point", 0, 0, 0), ("point", 0, 0, 0.001), ("point", 1, 0, 0)], 0.01),
         [[(0, 0, 0), (1, 0, 0)]]),
        ("Delaunay Mesh", ([("point", 0, 0, 0), ("point", 1, 0, 5), ("point", 0, 1, 0)], XY),
         [([(0, 0, 0), (1, 0, 5), (0, 1, 0)], None)]),
        ("Mesh Closest Point", (("point", 1, 0.5, 3), QUAD), [(1, 0.5, 0), 0]),
        ("Mesh Closest Point", (("point", 5, 0.5, 0), QUAD), [(2, 0.5, 0), 0]),
    ],
    ids=lambda part: str(part)[:40],
)  # fmt: skip
def test_a_native_makes_the_known_shape(name: str, given: Any, expected: Any) -> None:
    found = run(name, *given)
    if name == "Delaunay Mesh":  # one triangle, whose first corner is free
        assert near(found[0][0], expected[0][0]) and sorted(found[0][1][0]) == [0, 1, 2]
    else:
        assert near(found[: len(expected)], expected), found


def test_a_pipe_is_prisms_that_meet_where_the_angle_is_halved() -> None:
    """The volume of cut prisms is that of their section, 3 r^2 for 12 sides, along the middle line; of a closed one,
    the same without caps. Every corner is r from the line of its piece."""
    open_path, radius = [(0, 0, 0), (3, 0, 0), (3, 4, 0), (3, 4, 5)], 0.5
    mesh = BY_NAME["Pipe"].run(made(open_path), radius, 1)[0]
    assert measures.volume(shapes.mesh_parts(mesh)) == pytest.approx(3.0 * radius**2 * 12.0, rel=1e-6)
    vertices = shapes.mesh_parts(mesh)[0][:48].reshape(4, 12, 3)
    for ring, place, way in zip(vertices, open_path, np.eye(3)[[0, 0, 1, 2]], strict=True):
        off = ring - place
        assert np.linalg.norm(off - (off @ way)[:, None] * way, axis=1) == pytest.approx(np.full(12, radius), abs=1e-6)
    ring = BY_NAME["Pipe"].run(made(SQUARE), radius, 1)[0]
    assert measures.volume(shapes.mesh_parts(ring)) == pytest.approx(3.0 * radius**2 * 8.0, rel=1e-6)
    curved = BY_NAME["Pipe"].run(BY_NAME["Circle"].run(made(XY), 2.0)[0], 0.1, 0)[0]
    assert measures.volume(shapes.mesh_parts(curved)) == pytest.approx(0.03 * 100.0 * 2.0 * math.sin(math.pi / 50.0))
    for path, r, said in ((open_path, 0.0, "the radius must be positive"), ([(0, 0, 0), (1, 0, 0), (0, 0, 0)], 0.1,
                          "the curve turns back on itself")):  # fmt: skip
        with pytest.raises(Unfit, match=said):
            BY_NAME["Pipe"].run(made(path), r, 0)


def test_surfaces_of_straight_lines() -> None:
    """Half way between two curves is the mean of their points; an extruded square of side 2 by 3 has 4 x 2 x 3."""
    high = [(0, 0, 4), (2, 0, 4), (2, 2, 6)]
    (surface,) = BY_NAME["Loft"].run([made(SQUARE[:3]), made(high)], None)[0]
    (u0, u1), (v0, v1) = ((d.T0, d.T1) for d in (surface.Domain(0), surface.Domain(1)))
    middle = plain(surface.PointAt(0.5 * (u0 + u1), 0.5 * (v0 + v1)))
    assert near(middle, (2, 0, 2)) and near(plain(surface.PointAt(u1, v1)), (2, 2, 6))
    assert len(BY_NAME["Loft"].run([made(SQUARE), made(high), made(SQUARE)], None)[0]) == 2
    walls = BY_NAME["Extrude"].run(made(SQUARE), made(("vector", 0, 0, 3)))[0]
    mesh = BY_NAME["Mesh Surface"].run(walls, 8, 2, False, False)[0]
    assert measures.area(shapes.mesh_parts(mesh)) == pytest.approx(24.0, rel=1e-6)
    with pytest.raises(Unfit, match="two curves or more are needed"):
        BY_NAME["Loft"].run([made(SQUARE)], None)


def test_rotate_turns_counter_clockwise_about_a_plane_an_axis_and_a_point() -> None:
    east, north = made(("point", 1, 0, 0)), (0, 1, 0)
    for name, rest in (
        ("Rotate", [made(XY)]),
        ("Rotate Axis", [made(line((0, 0, 0), (0, 0, 1)))]),
        ("Rotate 3D", [made(("point", 0, 0, 0)), made(("vector", 0, 0, 1))]),
    ):
        assert near(plain(BY_NAME[name].run(east, math.pi / 2, *rest)[0]), north), name


def test_circles_and_arcs_begin_at_their_start_angle() -> None:
    circle = BY_NAME["Circle"].run(made(XY), 2.0)[0]
    assert near(plain(circle.PointAt(0.0)), (2, 0, 0)) and circle.IsClosed
    arc, length = BY_NAME["Arc"].run(made(XY), 2.0, made(("domain", math.pi / 2, math.pi)))
    assert near([plain(arc.PointAtStart), plain(arc.PointAtEnd), length], [(0, 2, 0), (-2, 0, 0), math.pi])
    through, _, radius = BY_NAME["Arc 3Pt"].run(*(made(("point", *p)) for p in ((1, 0, 0), (0, 1, 0), (-1, 0, 0))))
    assert near([run("Length", through)[0], radius], [math.pi, 1.0])
    upright = BY_NAME["Circle CNR"].run(made(("point", 0, 0, 5)), made(("vector", 1, 0, 0)), 1.0)[0]
    assert near([upright.PointAt(t).X for t in (0.0, 1.0, 2.0)], [0, 0, 0])


@pytest.mark.parametrize("style", [0, 1, 2])
def test_an_interpolated_curve_passes_its_points(style: int) -> None:
    places = [(0, 0, 0), (1, 2, 0), (3, 1, 1), (4, 0, 0)]
    curve, _, domain = BY_NAME["Interpolate"].run([made(("point", *p)) for p in places], 3, False, style)
    apart = [math.dist(a, b) for a, b in pairwise(places)]
    steps = {0: [1.0] * 3, 1: apart, 2: [math.sqrt(one) for one in apart]}[style]
    at = np.concatenate([[0.0], np.cumsum(steps)])
    assert near((domain.T0, domain.T1), (at[0], at[-1]))
    assert near([plain(curve.PointAt(float(t))) for t in at], places)


def test_a_mesh_taken_apart_is_put_together_again() -> None:
    vertices, faces, colours, normals = BY_NAME["Deconstruct Mesh"].run(made(QUAD))
    assert colours == [] and near(plain(normals), [(0, 0, 1)] * 4)
    assert near(plain(BY_NAME["Construct Mesh"].run(vertices, faces, None)[0]), QUAD[1:])
    with pytest.raises(Unfit, match="does not exist"):
        BY_NAME["Construct Mesh"].run(vertices[:3], faces, None)


def test_edges_of_unwelded_meshes_are_those_of_their_places() -> None:
    """As Rhino's topology: vertices in one place are one."""
    naked, inner, _ = run("Mesh Edges", PAIR)
    assert (len(naked), len(inner)) == (4, 1)
    joined = run("Mesh Join", [("mesh", PAIR[1][:3], [(0, 1, 2)]), ("mesh", PAIR[1][3:], [(0, 1, 2)])])
    assert near(joined, [PAIR[1:]])
    welded = BY_NAME["Weld Mesh"].run(made(PAIR), math.pi)[0]
    apart = plain(BY_NAME["Unweld Mesh"].run(welded, 0.0)[0])
    assert len(apart[0]) == 6 and len(run("Disjoint Mesh", PAIR)[0]) == 1


def test_unified_faces_run_round_in_one_direction() -> None:
    """Two triangles of which the second is turned: one face is flipped, and the shared edge runs both ways."""
    turned = ("mesh", TRIANGLES[1], [(0, 1, 2), (0, 3, 2)])
    (_, faces), count = run("Unify Mesh", turned)
    first, second = (set(pairwise((*face, face[0]))) for face in faces)
    assert count == 1 and (2, 0) in first and (0, 2) in second


def test_boxes_and_spheres_enclose_their_volumes() -> None:
    """A box of 1 x 2 x 3; a sphere of 60 x 30 faces is within 1 % of 4/3 pi, and below it, since it is inscribed."""
    box = BY_NAME["Box 2Pt"].run(made(("point", 0, 0, 0)), made(("point", 1, 2, 3)), None)[0]
    mesh = BY_NAME["Mesh Box"].run(box, 2, 3, 4)[0]
    assert near(run("Volume", mesh), [6.0, (0.5, 1, 1.5)]) and near(run("Volume", box), [6.0, (0.5, 1, 1.5)])
    naked, _, other = run("Mesh Edges", mesh)
    assert naked == [] and other == []
    volume, centre = run("Volume", BY_NAME["Mesh Sphere"].run(made(XY), 1.0, 60, 30)[0])
    assert 0.99 < volume / (4 / 3 * math.pi) < 1.0 and near(centre, (0, 0, 0))


def test_loop_moves_vertices_of_a_closed_mesh_by_its_rule() -> None:
    """Loop (1987) on an octahedron, valence 4: beta = (5/8 - (3/8)^2) / 4, a vertex at 1 goes to 1 - 4 beta, an edge's
    middle to 3/8 + 1/8 of the far vertices, which cancel."""
    places = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)]
    faces = [(0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5)]
    vertices, made_of = run("Weaverbird's Loop Subdivision", ("mesh", places, faces), 1, 0)[0]
    assert len(vertices) == 18 and len(made_of) == 32
    assert near(vertices[0], (1 - (5 / 8 - 9 / 64), 0, 0))
    assert near(sorted(np.abs(vertices[6])), [0.0, 0.375, 0.375])


def test_naked_edges_stay_where_they_are_fixed() -> None:
    vertices = np.array(run("Weaverbird's Catmull-Clark Subdivision", QUAD, 2, 0)[0][0])
    assert near([vertices[:, 0].min(), vertices[:, 0].max()], [0.0, 2.0])
    rounded = np.array(run("Weaverbird's Catmull-Clark Subdivision", QUAD, 2, 1)[0][0])
    assert rounded[:, 0].min() > 0.01


def test_a_box_has_six_faces_twelve_edges_and_eight_vertices_and_its_faces_divide() -> None:
    box = BY_NAME["Box 2Pt"].run(made(("point", 0, 0, 0)), made(("point", 1, 2, 3)), None)[0].ToBrep()
    faces, edges, vertices = BY_NAME["Deconstruct Brep"].run(box)
    assert (len(faces), len(edges), len(vertices)) == (6, 12, 8)
    assert near(sum(run("Length", edge)[0] for edge in edges), 4.0 * (1 + 2 + 3))
    places, normals, _ = run("Divide Surface", as_kind("surface", faces[0]), 2, 1)
    assert [len(row) for row in places] == [2, 2, 2] and near([math.dist(n, (0, 0, 0)) for n in normals[0]], [1.0, 1.0])
    assert near(np.mean(places[1], axis=0), np.mean([*places[0], *places[2]], axis=0))


def test_control_points_are_those_of_the_nurbs_form() -> None:
    points = [(0, 0, 0), (1, 1, 0), (2, -1, 0), (3, 0, 0)]
    curve = BY_NAME["Nurbs Curve"].run([made(("point", *p)) for p in points], 3, False)[0]
    found, weights, knots = run("Control Points", curve)
    assert near(found, points) and weights == [1.0] * 4 and knots == [0.0] * 3 + [1.0] * 3


@pytest.mark.parametrize(
    ("kind", "value", "expected"),
    [
        ("domain", 5.0, (0, 5)), ("domain", "1 to 3", (1, 3)),
        ("plane", ("point", 1, 2, 3), ((1, 2, 3), (1, 0, 0), (0, 1, 0))),
        ("vector", line((0, 0, 0), (1, 2, 3)), (1, 2, 3)), ("number", line((0, 0, 0), (3, 4, 0)), 5.0),
        ("curve", line((0, 0, 0), (3, 4, 0)), [(0, 0, 0), (3, 4, 0)]), ("path", "{0;1}", (0, 1)), ("path", 3, (3,)),
        ("line", SQUARE[:2], [(0, 0, 0), (2, 0, 0)]),
    ],
)  # fmt: skip
def test_values_of_one_kind_are_taken_as_another(kind: str, value: Any, expected: Any) -> None:
    assert near(plain(as_kind(kind, made(value))), expected)


def test_rectangles_are_recognised_by_their_corners() -> None:
    frame, width, height = as_kind("rectangle", made(SQUARE))
    assert near([plain(frame)[0], width, height], [(0, 0, 0), 2.0, 2.0])
    assert shapes.rectangle(made([(0, 0, 0), (2, 0, 0), (3, 2, 0), (0, 2, 0), (0, 0, 0)])) is None
    assert shapes.corners(rhino3dm.ArcCurve.CreateFromCircle(rhino3dm.Circle(1.0))) is None


def test_the_mesh_of_a_round_brep_is_as_near_to_it_as_its_normals_turn_little() -> None:
    """Rows of 9 degrees: the middle of a face of a unit ball is 1 - cos(4.5 degrees) of each way inside, at most; a
    solid of flat faces needs no more than their corners."""
    ball = rhino3dm.Sphere(rhino3dm.Point3d(0, 0, 0), 1.0).ToBrep()
    vertices, faces = shapes.mesh_parts(BY_NAME["Mesh Brep"].run(ball, None)[0])
    middles = np.array([np.mean(vertices[list(face)], axis=0) for face in faces])
    assert np.linalg.norm(middles, axis=1).min() > 1.0 - 2.0 * (1.0 - np.cos(np.pi / 40)) - 1e-6
    assert len(faces) == 800
    box = shapes.plane((0, 0, 0), (1, 0, 0), (0, 1, 0))
    made = BY_NAME["Center Box"].run(box, 1.0, 1.0, 1.0)[0]
    corners = shapes.mesh_parts(as_kind("mesh", made))[0]
    assert len(np.unique(np.round(corners, 9), axis=0)) == 8
