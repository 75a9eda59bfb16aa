"""Slope, curvature, height lines and ways of water on surfaces whose values are known in closed form."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

from hookean import InputError
from hookean.discretize import clothed_vertices, curvature, grid, height_lines, slope, triangles, water_lines
from hookean.values.mesh import Mesh

Array = NDArray[np.float64]


def sheet(height: Callable[[Array, Array], Array], count: int = 20, size: float = 2.0) -> Mesh:
    """A grid of quads over the square of this size about the origin, at heights z = height(x, y)."""
    places = np.linspace(-size / 2, size / 2, count + 1)
    flat = grid(places, places)
    x, y = flat.vertices[:, :2].T
    return Mesh(np.stack([x, y, height(x, y)], axis=1), flat.faces)


def sphere(count: int, radius: float) -> Mesh:
    """The part of a sphere over a square, normals outwards."""
    return sheet(lambda x, y: np.sqrt(radius**2 - x**2 - y**2), count, radius)


def test_slope_of_a_plane_and_of_a_wall() -> None:
    """tan of the slope is the length of the gradient; exact but for rounding, on either side of the sheet."""
    plane = sheet(lambda x, y: 0.3 * x - 0.4 * y)
    assert slope(plane) == pytest.approx(np.full(len(plane.vertices), np.degrees(np.arctan(0.5))), rel=1e-12)
    assert slope(Mesh(plane.vertices, plane.faces[:, ::-1])) == pytest.approx(slope(plane), rel=1e-12)
    wall = Mesh(plane.vertices[:, [0, 2, 1]] * [1, 0, 1], plane.faces)
    assert slope(wall) == pytest.approx(np.full(len(wall.vertices), 90.0), rel=1e-12)
    lonely = Mesh(np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [5, 5, 5]]), np.array([[0, 1, 2, 2]]))
    assert np.isnan(slope(lonely)).tolist() == [False, False, False, True]


def test_curvature_of_a_sphere_and_its_order() -> None:
    """H = 1/r, K = 1/r^2 (do Carmo, Differential Geometry, 3-3). On a grid both errors are of second order: at the top,
    where the grid is regular, a quarter at half the size, and 1 - h^2/(4 r^2) or closer at h."""
    radius, errors = 3.0, []
    for count in (10, 20):
        mesh = sphere(count, radius)
        top = int(mesh.vertices[:, 2].argmax())
        mean, gaussian = curvature(mesh)
        errors.append([abs(mean[top] * radius - 1.0), abs(gaussian[top] * radius**2 - 1.0)])
        bound = (1.0 / count) ** 2  # (h / r)^2
        assert max(errors[-1]) < bound
        assert np.isfinite(mean).sum() == len(clothed_vertices(mesh))
    assert np.divide(errors[0], errors[1]) == pytest.approx([4.0, 4.0], rel=0.05)


def test_signs_of_curvature() -> None:
    """A saddle z = a x y has K = -a^2 and H = 0 at its middle; a trough z = a x^2 / 2 has K = 0 and H = -a / 2, for it
    bulges away from its normals, which point upwards; turned over, the sign of H turns and that of K does not."""
    a, h = 0.2, 0.1
    saddle = sheet(lambda x, y: a * x * y)
    middle = int(np.linalg.norm(saddle.vertices[:, :2], axis=1).argmin())
    mean, gaussian = (values[middle] for values in curvature(saddle))
    assert abs(mean) < 1e-12 and gaussian == pytest.approx(-(a**2), rel=(a * h) ** 2 + h**2)
    trough = sheet(lambda x, y: a * x**2 / 2)
    mean, gaussian = (values[middle] for values in curvature(trough))
    assert mean == pytest.approx(-a / 2, rel=h**2) and abs(gaussian) < 1e-12
    turned = curvature(Mesh(trough.vertices, trough.faces[:, ::-1]))
    assert turned[0][middle] == pytest.approx(-mean, rel=1e-12)


def test_height_lines_of_a_plane_lie_at_multiples_of_the_step() -> None:
    """z = x / 2 from -0.5 to 0.5 with step 0.2: straight lines at -0.4, -0.2 ... 0.4, each 2 long, none counted twice
    although some go through vertices."""
    found = height_lines(sheet(lambda x, y: x / 2), 0.2)
    assert np.unique(found.heights.round(12)).tolist() == pytest.approx([-0.4, -0.2, 0.0, 0.2, 0.4])
    assert found.pieces[:, :, 2] == pytest.approx(np.stack([found.heights] * 2, axis=1))
    assert found.pieces[:, :, 0] == pytest.approx(2 * found.pieces[:, :, 2], abs=1e-12)
    lengths = np.linalg.norm(found.pieces[:, 0] - found.pieces[:, 1], axis=1)
    for height in (-0.4, 0.0, 0.2):
        assert lengths[np.isclose(found.heights, height)].sum() == pytest.approx(2.0, rel=1e-12)


def test_the_step_is_round_and_its_limits_are_named() -> None:
    slant = sheet(lambda x, y: x)  # 2 high
    assert height_lines(slant).step == 0.1
    assert height_lines(Mesh(1000 * slant.vertices, slant.faces)).step == 100.0
    assert len(height_lines(sheet(lambda x, y: 0 * x)).pieces) == 0
    with pytest.raises(InputError, match="a length above 0"):
        height_lines(slant, -1.0)
    with pytest.raises(InputError, match="at most 1000 levels"):
        height_lines(slant, 1e-4)


def test_water_stays_in_a_bowl_and_runs_off_a_hill() -> None:
    """In z = x^2 + y^2 all drops end at the vertex in the middle; on the hill turned over all end on the boundary,
    farther from the middle than they began. Every piece of every way goes down."""
    bowl = sheet(lambda x, y: x**2 + y**2)
    found = water_lines(bowl)
    assert len(found.lines) == 200 and found.stays.all()
    for line in found.lines:
        assert (np.diff(line[:, 2]) < 0).all() and line[-1] == pytest.approx([0, 0, 0], abs=1e-12)
    hill = water_lines(sheet(lambda x, y: -(x**2) - y**2))
    assert not hill.stays.any()
    for line in hill.lines:
        assert (np.diff(line[:, 2]) <= 0).all()
        assert np.abs(line[-1, :2]).max() == pytest.approx(1.0) and (np.abs(line[-1]) >= np.abs(line[0])).any()


def test_water_runs_straight_down_a_plane_and_along_a_valley() -> None:
    """On a plane a drop follows the gradient to the boundary; where two planes meet in a sloping valley it follows the
    valley from there, and on a level one it stays."""
    plane = sheet(lambda x, y: 0.5 * x + 0.25 * y)
    [line] = water_lines(plane, [[0.5, 0.3, 1.0]]).lines
    apart = line - line[0]
    assert 2 * apart[:, 1] == pytest.approx(apart[:, 0], abs=1e-12)
    assert line[-1, 0] == pytest.approx(-1.0)
    valley = sheet(lambda x, y: np.abs(x) + 0.2 * y, 10)
    found = water_lines(valley, [[0.53, 0.61, 0.0]])
    assert not found.stays[0] and found.lines[0][-1] == pytest.approx([0.0, -1.0, -0.2], abs=1e-12)
    level = water_lines(sheet(lambda x, y: np.abs(x), 10), [[0.53, 0.61, 0.0]])
    assert level.stays[0] and level.lines[0][-1, 0] == pytest.approx(0.0, abs=1e-12)


def test_random_surfaces_lose_or_keep_every_drop_below_its_start() -> None:
    """Ways end, go down, and end either on the boundary or at a vertex below all its neighbours."""
    random = np.random.default_rng(23)
    for _ in range(5):
        mesh = sheet(lambda x, y: random.normal(size=x.shape), 12)
        mesh = Mesh(mesh.vertices, triangles(mesh)[:, [0, 1, 2, 2]])
        found, cut = water_lines(mesh), mesh.faces[:, :3]
        assert len(found.lines) == 200
        for line, stays in zip(found.lines, found.stays, strict=True):
            assert (np.diff(line[:, 2]) <= 1e-12).all()
            if not stays:
                assert np.abs(line[-1, :2]).max() > 1 - 1e-9
                continue
            end = np.linalg.norm(mesh.vertices - line[-1], axis=1).argmin()
            around = mesh.vertices[np.unique(cut[(cut == end).any(axis=1)])]
            assert np.array_equal(mesh.vertices[end], line[-1]) and around[:, 2].min() == line[-1, 2]


def test_no_cut_of_a_quad_holds_water_up() -> None:
    """On a saddle z = x y all water runs off along its two low diagonals, also what falls on the high ones and meets
    the level middle."""
    saddle = sheet(lambda x, y: x * y)
    assert not water_lines(saddle).stays.any()
    assert not water_lines(saddle, [[0.55, 0.55, 0.3], [0.0, 0.0, 0.0]]).stays.any()


def test_faults_of_drops_are_named() -> None:
    with pytest.raises(InputError, match="no faces"):
        water_lines(Mesh(np.zeros((0, 3)), np.zeros((0, 4), np.int64)), [[0, 0, 0]])
    assert water_lines(Mesh(np.zeros((0, 3)), np.zeros((0, 4), np.int64))).lines == []
