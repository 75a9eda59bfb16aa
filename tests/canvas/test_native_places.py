"""Natives that bend geometry, put points on shapes, judge what is inside, and cut a plane into cells: by formulas."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from canvas.native_values import called, made, near
from canvas.natives_table import XY
from hookean_canvas.run.natives import BY_NAME, PLUGINS, Unfit, as_kind, shapes
from hookean_canvas.run.rhino import rhino3dm

CUBE = BY_NAME["Mesh Box"].run(
    BY_NAME["Box 2Pt"].run(shapes.point((0, 0, 0)), shapes.point((2, 2, 2)), None)[0], 2, 2, 2
)[0]
GRID = (
    "mesh",
    [(x, y, 0.0) for x in range(3) for y in range(3)],
    [(0, 3, 4, 1), (1, 4, 5, 2), (3, 6, 7, 4), (4, 7, 8, 5)],
)


def box(*corners: tuple[float, float, float]) -> Any:
    return BY_NAME["Box 2Pt"].run(*map(shapes.point, corners), None)[0]


def flat(width: float, height: float) -> Any:
    """A flat surface with parameters from 0 to its sizes."""
    return BY_NAME["Plane Surface"].run(made(XY), rhino3dm.Interval(0, width), rhino3dm.Interval(0, height))[0]


def ball(radius: float) -> Any:
    """The surface of a sphere about the origin, normals outwards."""
    return rhino3dm.Sphere(rhino3dm.Point3d(0, 0, 0), radius).ToBrep().Faces[0].UnderlyingSurface().ToNurbsSurface()


@pytest.mark.parametrize(
    ("name", "given", "expected"),
    [
        ("Numbers to Points", ([1, 2, 3, 4], "XZ"), ([(1, 0, 2), (3, 0, 4)],)),
        ("Numbers to Points", ([1, 2, 3], "ZYX"), ([(3, 2, 1)],)),
        ("Points to Numbers", ([("point", 1, 2, 3), ("point", 4, 5, 6)], "zx"), ([3, 1, 6, 4],)),
        ("Weighted Average", ([1.0, 4.0], [1.0, 2.0]), (3.0,)),
        ("Weighted Average", ([("point", 0, 0, 0), ("point", 4, 0, 0)], [1.0, 3.0]), ((3, 0, 0),)),
        ("Weighted Average", ([1.0, 2.0, 6.0], [1.0]), (3.0,)),
        ("Fibonacci", (0.0, 1.0, 7), ([0, 1, 1, 2, 3, 5, 8],)),
        ("Fibonacci", (2.0, 1.0, 1), ([2],)),
        ("Move To Plane", (("point", 1, 2, 3), XY, True, True), ((1, 2, 0),)),
        ("Move To Plane", (("point", 1, 2, 3), XY, False, True), ((1, 2, 3),)),
        ("Move To Plane", ([(0, 0, -3), (1, 0, -2)], XY, True, True), ([(0, 0, -1), (1, 0, 0)],)),
        ("Move To Plane", ([(0, 0, -1), (1, 0, 1)], XY, True, True), ([(0, 0, -1), (1, 0, 1)],)),
        ("Rotate Direction", (("point", 2, 0, 0), ("point", 1, 0, 0), ("vector", 3, 0, 0), ("vector", 0, 0, 1)),
         ((1, 0, 1),)),
        ("Curve | Curve", ([(0, 0, 0), (4, 0, 0)], [(1, -1, 0), (1, 1, 0), (3, 1, 0), (3, -1, 0)]),
         ([(1, 0, 0), (3, 0, 0)],)),
        ("Curve | Curve", ([(0, 0, 0), (4, 0, 0)], [(1, -1, 1), (1, 1, 1)]), ([],)),
        ("Box Corners", (box((0, 0, 0), (1, 2, 3)),),
         ((0, 0, 0), (1, 0, 0), (1, 2, 0), (0, 2, 0), (0, 0, 3), (1, 0, 3), (1, 2, 3), (0, 2, 3))),
        ("Mesh UnifyNormals", (GRID,), ((GRID[1], GRID[2]),)),
        ("Mesh FromPoints", ([("point", x, y, 0) for x in range(3) for y in range(3)], 3, 3), ((GRID[1], GRID[2]),)),
    ],
)  # fmt: skip
def test_a_native_does_what_its_tooltip_describes(name: str, given: Any, expected: Any) -> None:
    assert near(called(name, *given)[: len(expected)], list(expected))


def test_a_box_is_bent_into_a_twisted_one_corner_by_corner_and_linearly_between() -> None:
    """A flat surface of 4 by 2 with a height of 3 is a straight box: x, y and z grow by 4, 2 and 3."""
    target = BY_NAME["Surface Box"].run(flat(4, 2), flat(4, 2), 3.0)[0]
    bent = shapes.mesh_parts(BY_NAME["Box Morph"].run(CUBE, box((0, 0, 0), (2, 2, 2)), target)[0])[0]
    assert np.allclose(bent, shapes.mesh_parts(CUBE)[0] * (2, 1, 1.5))
    line = BY_NAME["Box Morph"].run(
        shapes.polyline([(0, 0, 0), (2, 2, 2)]), box((0, 0, 0), (2, 2, 2)), box((1, 1, 1), (3, 3, 5))
    )[0]
    assert np.allclose(shapes.corners(line), [(1, 1, 1), (3, 3, 5)])
    circle = BY_NAME["Circle"].run(made(XY), 1.0)[0]
    oval = BY_NAME["Box Morph"].run(circle, box((-1, -1, 0), (1, 1, 1)), box((-2, -1, 0), (2, 1, 1)))[0]
    assert {round(abs(oval.PointAt(t).X / 2) ** 2 + oval.PointAt(t).Y ** 2, 9) for t in np.linspace(0.1, 6, 9)} == {1.0}


def test_geometry_over_a_sphere_is_at_the_heights_of_its_box() -> None:
    surface = ball(5.0)
    ends = [surface.Domain(k) for k in (0, 1)]
    over = BY_NAME["Surface Morph"].run(CUBE, box((0, 0, 0), (2, 2, 2)), surface, *ends, rhino3dm.Interval(0, 4))[0]
    for start, end in zip(shapes.mesh_parts(CUBE)[0], shapes.mesh_parts(over)[0], strict=True):
        assert np.linalg.norm(end) == pytest.approx(5.0 + 2.0 * start[2])


@pytest.mark.parametrize("geometry", [BY_NAME["Center Box"].run(made(XY), 1.0, 1.0, 1.0)[0].ToBrep()])
def test_what_cannot_be_bent_is_refused_in_a_sentence(geometry: Any) -> None:
    with pytest.raises(Unfit, match="untrimmed surfaces alone are bent"):
        BY_NAME["Box Morph"].run(geometry, box((0, 0, 0), (1, 1, 1)), box((0, 0, 0), (2, 2, 2)))


def test_a_point_is_pulled_to_the_nearest_of_all_shapes() -> None:
    place = shapes.point((1, 1, 7))
    shapes_ = [made(XY), CUBE, shapes.polyline([(0, 0, 20), (9, 0, 20)]), ball(1.0), shapes.point((1, 1, 30))]
    for count, height in ((1, 0.0), (2, 2.0), (5, 2.0)):
        at, distance = BY_NAME["Pull Point"].run(place, shapes_[:count])
        assert near([shapes.xyz(at).tolist(), distance], [[1, 1, height], 7 - height])
    at, normal, distance = BY_NAME["Brep Closest Point"].run(shapes.point((0, 3, 4)), ball(1.0))
    assert np.allclose(shapes.xyz(at), (0, 0.6, 0.8), atol=1e-6) and distance == pytest.approx(4.0)
    assert abs(shapes.xyz(normal) @ (0, 0.6, 0.8)) == pytest.approx(1.0)


def test_frames_of_a_surface_and_a_curve_follow_them() -> None:
    frames, at = BY_NAME["Surface Frames"].run(flat(4, 2), 2, 1)
    assert [len(row) for row in frames] == [len(row) for row in at] == [2, 2, 2]
    assert near([shapes.xyz(row[0].Origin).tolist() for row in frames], [[0, 0, 0], [2, 0, 0], [4, 0, 0]])
    assert all(near([shapes.xyz(f.XAxis).tolist()], [[1, 0, 0]]) for row in frames for f in row)
    circle = BY_NAME["Circle"].run(made(XY), 2.0)[0]
    frames, _ = BY_NAME["Curve Frames"].run(circle, 4)
    for frame in frames:  # the curve bends towards its centre
        assert np.allclose(shapes.xyz(frame.YAxis), -shapes.xyz(frame.Origin) / 2.0, atol=1e-6)
    straight, _ = BY_NAME["Curve Frames"].run(shapes.polyline([(0, 0, 0), (3, 0, 0)]), 3)
    assert all(near([shapes.xyz(frame.XAxis).tolist()], [[1, 0, 0]]) for frame in straight)


def test_cells_are_what_is_nearer_to_their_point() -> None:
    rows = np.random.default_rng(3).random((9, 2)) * 4.0
    square = BY_NAME["Rectangle"].run(made(XY), rhino3dm.Interval(0, 4), rhino3dm.Interval(0, 4), 0.0)[0]
    frame = as_kind("rectangle", square)
    cells = BY_NAME["Voronoi"].run(shapes.points(np.c_[rows, np.zeros(9)]), None, frame, made(XY))[0]
    areas = [BY_NAME["Area"].run(cell)[0] for cell in cells]
    assert sum(areas) == pytest.approx(16.0)  # they fill the square
    for i, cell in enumerate(cells):
        for corner in shapes.corners(cell)[:, :2]:
            away = np.linalg.norm(rows - corner, axis=1)
            assert away[i] <= away.min() + 1e-9
    round_ = BY_NAME["Voronoi"].run(shapes.points([(2, 2, 0)]), 1.0, frame, made(XY))[0][0]
    assert BY_NAME["Area"].run(round_)[0] == pytest.approx(48 * math.tan(math.pi / 48))


def test_smoothing_moves_to_the_mean_of_neighbours_and_no_further_than_the_limit() -> None:
    vertices, faces = np.array(GRID[1], float), GRID[2]
    vertices[4, 2] = 1.0
    bump = shapes.mesh(vertices, faces)
    for strength, limit, height in ((0.5, None, 0.5), (1.0, None, 0.0), (1.0, 0.25, 0.75), (1.0, 0.0, 1.0)):
        found = shapes.mesh_parts(BY_NAME["Smooth Mesh"].run(bump, strength, True, 1, limit)[0])[0]
        assert np.allclose(np.delete(found, 4, axis=0), np.delete(vertices, 4, axis=0)), "naked vertices stay"
        assert found[4, 2] == pytest.approx(height)
    loose = shapes.mesh_parts(BY_NAME["Smooth Mesh"].run(bump, 1.0, False, 1, None)[0])[0]
    assert np.allclose(loose[0], (0.5, 0.5, 0.0)), "the mean of the two beside the corner"


@pytest.mark.parametrize(
    ("place", "inside"), [((1, 1, 1), True), ((0.1, 1.9, 0.1), True), ((3, 1, 1), False), ((2.0, 1, 1), None)]
)
def test_a_point_is_inside_by_the_solid_angle(place: tuple[float, ...], inside: bool | None) -> None:
    for strict in (False, True):
        expected = not strict if inside is None else inside
        assert called("Mesh Inclusion", CUBE, ("point", *place), strict) == [expected]
        assert BY_NAME["Point In Brep"].run(box((0, 0, 0), (2, 2, 2)).ToBrep(), shapes.point(place), strict) == (
            expected,
        )


def test_a_cylinder_has_its_radius_and_its_length() -> None:
    wall = BY_NAME["Cylinder"].run(made(("plane", (1, 2, 3), (0, 1, 0), (0, 0, 1))), 2.0, 5.0)[0]
    for u in np.linspace(wall.Domain(0).T0, wall.Domain(0).T1, 5):
        for v in (wall.Domain(1).T0, wall.Domain(1).T1):
            x, y, z = shapes.xyz(wall.PointAt(u, v)) - (1, 2, 3)
            assert math.hypot(y, z) == pytest.approx(2.0)
            assert min(abs(x), abs(x - 5.0)) < 1e-9


def test_jitter_keeps_all_items_and_says_where_they_were() -> None:
    items = [f"item {i}" for i in range(20)]
    assert BY_NAME["Jitter"].run(items, 0.0, 1) == (items, list(range(20)))
    found, places = BY_NAME["Jitter"].run(items, 1.0, 1)
    assert sorted(found) == sorted(items) and found != items and found == [items[i] for i in places]
    assert BY_NAME["Jitter"].run(items, 1.0, 2)[0] != found
    with pytest.raises(Unfit, match="between 0 and 1"):
        BY_NAME["Jitter"].run(items, 2.0, 1)


def test_a_brep_into_an_input_for_meshes_is_its_mesh() -> None:
    mesh = as_kind("mesh", box((0, 0, 0), (1, 2, 3)).ToBrep())
    assert BY_NAME["Volume"].run(mesh)[0] == pytest.approx(6.0)


@pytest.mark.parametrize(
    ("name", "given", "sentence"),
    [
        ("Numbers to Points", ([1.0, 2.0], "XYZ"), "2 numbers are not a multiple of 3"),
        ("Numbers to Points", ([1.0], "X Q"), "it is made of X, Y and Z"),
        ("Weighted Average", ([1.0], [0.0]), "a sum other than 0"),
        ("Cylinder", (XY, 0.0, 1.0), "Radius must be positive"),
        ("Mesh FromPoints", ([("point", 0, 0, 0)], 2, 2), "1 points are not 2 rows of 2"),
        ("Pull Point", (("point", 0, 0, 0), []), "there is no geometry"),
    ],
)  # fmt: skip
def test_bad_input_is_refused_in_a_sentence(name: str, given: Any, sentence: str) -> None:
    with pytest.raises(Unfit, match=sentence):
        (BY_NAME.get(name) or PLUGINS[name]).run(*map(made, given))
