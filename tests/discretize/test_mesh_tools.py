"""Clean meshes, two colours, hinges, neighbours, mapped points, polylines taken apart: counts and closed forms."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import hookean.discretize as hd
from discretize.shapes import CUBE, OCTAHEDRON, euler, grid, oriented, strip
from hookean.discretize.mapping import Closest
from hookean.errors import InputError
from hookean.values.mesh import Mesh
from soak import examples

few = settings(derandomize=True, deadline=None, max_examples=examples(25))


def turn(seed: int) -> np.ndarray:
    """A rotation."""
    q, r = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    q = q * np.sign(np.diag(r))
    return q * np.linalg.det(q)


# clean


def test_the_sides_of_a_cube_become_a_closed_mesh() -> None:
    """Six squares with vertices of their own, some of them 0.004 off: 8 vertices, V - E + F = 2, no boundary."""
    rng = np.random.default_rng(0)
    sides = [Mesh(CUBE.vertices[face] + rng.uniform(-0.002, 0.002, (4, 3)), np.array([[0, 1, 2, 3]]))
             for face in CUBE.faces]  # fmt: skip
    whole = hd.clean([*sides, sides[2]], 0.01)
    assert len(whole.vertices) == 8 and len(whole.faces) == 6
    assert euler(whole) == 2 and oriented(whole) and not len(hd.naked_edges(whole))
    assert hd.volume(whole) == pytest.approx(8.0, abs=24 * 0.002 * 2)


def test_duplicate_and_lost_faces_and_unused_vertices_go() -> None:
    points = np.array([[9, 9, 9], [0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 1, 0.001], [5, 5, 5]], float)
    faces = np.array([[1, 2, 3, 3], [3, 1, 2, 2], [2, 1, 3, 3], [1, 3, 4, 5], [4, 5, 4, 4], [1, 2, 3, 4]])
    whole = hd.clean([(points, faces)], 0.01)
    assert whole.vertices.tolist() == points[1:5].tolist()
    assert whole.faces.tolist() == [[0, 1, 2, 2], [0, 2, 3, 3], [0, 1, 2, 3]]


def test_cleaning_twice_changes_nothing_more() -> None:
    once = hd.clean([grid(4, 3), grid(3, 4)], 0.01)
    again = hd.clean([once], 0.01)
    assert (again.vertices == once.vertices).all() and (again.faces == once.faces).all()
    assert len(once.faces) == 9 + 3 + 3 and hd.area(once) == pytest.approx(15.0)
    with pytest.raises(InputError, match="at least one mesh"):
        hd.clean([])


# two colours


@few
@given(st.integers(1, 6), st.integers(1, 6), st.integers(0, 99))
def test_a_grid_is_a_checkerboard(n: int, m: int, seed: int) -> None:
    mesh = grid(n, m)
    order = np.random.default_rng(seed).permutation(n * m)
    mesh = Mesh(mesh.vertices, mesh.faces[order])
    second, black, white = hd.checkerboard(mesh)
    x, y, _ = np.floor(mesh.vertices[mesh.faces].mean(axis=1)).T
    odd = (x + y) % 2 == 1
    assert (second == (odd ^ odd[0])).all()
    assert np.array_equal(black, np.flatnonzero(~second)) and np.array_equal(white, np.flatnonzero(second))
    assert abs(len(black) - len(white)) == (n * m) % 2


def test_an_octahedron_has_two_colours_and_a_cube_has_not() -> None:
    second, _, white = hd.checkerboard(OCTAHEDRON)
    assert len(white) == 4 and not second[0]
    with pytest.raises(InputError, match="two colours cannot separate this face from face"):
        hd.checkerboard(CUBE)
    second, black, white = hd.checkerboard(CUBE, strict=False)
    assert not second[0] and sorted([*black, *white]) == list(range(6))


def test_rings_of_odd_length_have_no_two_colours() -> None:
    assert hd.checkerboard(strip(6, closed=True))[0].sum() == 3
    with pytest.raises(InputError, match="two colours"):
        hd.checkerboard(strip(5, closed=True))


# hinges


@few
@given(st.integers(1, 5), st.integers(1, 5))
def test_a_net_has_a_hinge_at_each_inner_edge(n: int, m: int) -> None:
    mesh = grid(n, m, triangles=True)
    start, end, tip_1, tip_2 = hd.hinge_points(mesh)
    assert len(start) == len(hd.edges(mesh)) - len(hd.naked_edges(mesh))
    v = mesh.vertices
    for a, b, c, right in ((start, end, tip_1, 1), (end, start, tip_2, 1)):
        assert (np.cross(v[b] - v[a], v[c] - v[a])[:, 2] * right > 0).all()
    assert hd.fold_angle(v[start], v[end], v[tip_1], v[tip_2]) == pytest.approx(np.zeros(len(start)), abs=1e-15)


def test_quads_fold_along_their_shorter_diagonals_too() -> None:
    """12 edges and 6 diagonals of a cube, outward faces: folds of -pi/2 and 0."""
    start, end, tip_1, tip_2 = hd.hinge_points(CUBE)
    assert len(start) == 18
    v = CUBE.vertices
    angles = np.sort(hd.fold_angle(v[start], v[end], v[tip_1], v[tip_2]))
    assert angles == pytest.approx([*[-np.pi / 2] * 12, *[0.0] * 6], abs=1e-15)


@few
@given(st.floats(-3.1, 3.1), st.integers(0, 99), st.floats(0.2, 5.0))
def test_the_fold_angle_is_that_of_the_hinge(angle: float, seed: int, size: float) -> None:
    """A tip turned about the fold by theta, in any place, order of sides and size; the force `hinge` rests there."""
    tip = [0.4, -np.cos(angle), np.sin(angle)]
    points = np.array([[0, 0, 0], [1, 0, 0], [0.3, 1, 0], tip]) * size @ turn(seed).T + seed
    a, b, c, d = points
    assert hd.fold_angle(a, b, c, d) == pytest.approx([angle], abs=1e-11)
    assert hd.fold_angle(b, a, d, c) == pytest.approx([angle], abs=1e-11)
    assert hd.fold_angle(b, a, c, d) == pytest.approx([-angle], abs=1e-11)


def test_faulty_folds() -> None:
    a, b = [0.0, 0, 0], [1.0, 0, 0]
    with pytest.raises(InputError, match="tip_1/0: its triangle has no area"):
        hd.fold_angle(a, b, [2.0, 0, 0], [0, 1.0, 0])
    with pytest.raises(InputError, match="end: it has 2 points, and another has 3"):
        hd.fold_angle([a] * 3, [b] * 2, [0, 1.0, 0], [0, -1.0, 0])


# neighbours


def test_neighbours_run_round_the_normal() -> None:
    mesh = grid(2, 2)
    rings, normals = hd.vertex_neighbours(mesh)
    assert [len(ring) for ring in rings] == [2, 3, 2, 3, 4, 3, 2, 3, 2]
    assert (normals == [0.0, 0.0, 1.0]).all()
    for i, ring in enumerate(rings):
        out = mesh.vertices[ring] - mesh.vertices[i]
        turns = np.cross(out[:-1], out[1:])[:, 2]
        assert (turns > 0).all() if len(ring) < 4 else turns.tolist() == [1.0] * 3
    assert rings[1].tolist() == [2, 4, 0]
    [one], normal = hd.vertex_neighbours(OCTAHEDRON, [2])
    assert set(one.tolist()) == {0, 1, 3, 4} and normal[0] == pytest.approx([0, 0, 1], abs=1e-15)
    with pytest.raises(InputError, match="vertices/1: vertex 9 does not exist; the mesh has 9"):
        hd.vertex_neighbours(mesh, [0, 9])


def test_all_neighbours_are_all_edges_twice() -> None:
    for mesh in (CUBE, OCTAHEDRON, grid(3, 4, triangles=True), strip(5, np.pi, closed=True)):
        rings, _ = hd.vertex_neighbours(mesh)
        pairs = sorted((min(i, j), max(i, j)) for i, ring in enumerate(rings) for j in ring.tolist())
        wanted = sorted(map(tuple, hd.edges(mesh).tolist()))
        assert pairs[::2] == pairs[1::2] == wanted


# mapped points


@few
@given(st.integers(0, 999))
def test_a_moved_mesh_carries_points_with_it(seed: int) -> None:
    """Exactly, to rounding, for any rigid motion and any points."""
    rng = np.random.default_rng(seed)
    ball = hd.refine(OCTAHEDRON, 2)
    points = rng.normal(size=(50, 3)) * 1.5
    move, shift = turn(seed), rng.normal(size=3)
    there = hd.mesh_map(points, ball, Mesh(ball.vertices @ move + shift, ball.faces))
    assert there == pytest.approx(points @ move + shift, abs=1e-12)


def test_barycentric_coordinates_stay_and_heights_are_scaled() -> None:
    """Over a square pulled to 3 by 2 and lifted: (x, y, h) goes to (3 x, 2 y, 1 + s h)."""
    rng = np.random.default_rng(1)
    flat = grid(3, 3, 1 / 3)
    points = rng.uniform(0.0, 1.0, (40, 3))
    wide = Mesh(flat.vertices * [3.0, 2.0, 1.0] + [0.0, 0.0, 1.0], flat.faces)
    for scale in (1.0, 0.0, -0.5):
        wanted = points * [3.0, 2.0, scale] + [0.0, 0.0, 1.0]
        assert hd.mesh_map(points, flat, wide, scale) == pytest.approx(wanted, abs=1e-13)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(3))
def test_the_closest_triangle_is_that_of_a_search_through_all(seed: int) -> None:
    """Triangles of sizes from 1e-3 to 1, slivers and segments among them."""
    rng = np.random.default_rng(seed)
    corners = rng.normal(size=(60, 1, 3)) + 10.0 ** rng.uniform(-3, 0, (60, 1, 1)) * rng.normal(size=(60, 3, 3))
    corners[::7, 2] = corners[::7, 1]
    faces = np.arange(180).reshape(-1, 3)
    points = rng.normal(size=(80, 3))
    found, at = Closest(corners.reshape(-1, 3), faces)(points)
    weights = rng.dirichlet(np.ones(3), 1000)
    weights[rng.random((1000, 3)) < 0.3] = 0.0
    weights = weights[weights.sum(axis=1) > 0]
    samples = np.einsum("wk,tkc->twc", weights / weights.sum(axis=1, keepdims=True), corners)
    away = np.linalg.norm(at - points, axis=1)
    for p, distance, triangle, place in zip(points, away, found, at, strict=True):
        others = np.linalg.norm(samples - p, axis=2).min(axis=1)
        assert distance <= others.min() + 1e-12
        a, b, c = corners[triangle]
        basis = np.stack([b - a, c - a], axis=1)
        inside, *_ = np.linalg.lstsq(basis, place - a, rcond=None)
        assert np.linalg.norm(basis @ inside - (place - a)) < 1e-9
        assert inside.min() > -1e-6 and inside.sum() < 1 + 1e-6


def test_faulty_maps() -> None:
    flat = grid(1, 1)
    with pytest.raises(InputError, match="target: its faces are not those of the source"):
        hd.mesh_map([[0, 0, 0]], flat, grid(1, 2))
    with pytest.raises(InputError, match="target: its triangle"):
        hd.mesh_map([[0, 0, 0]], flat, Mesh(flat.vertices * 0.0, flat.faces))


# polylines


@few
@given(st.integers(3, 9), st.booleans(), st.integers(1, 4))
def test_a_regular_polygon_has_its_corners(n: int, closed: bool, pieces: int) -> None:
    """Its corners turn by 2 pi / n, whatever points are on its sides."""
    turns = 2 * np.pi * np.arange(n + 1) / n
    round_ = np.stack([np.cos(turns), np.sin(turns), 0 * turns], axis=1)[: n + closed]
    steps = np.arange(pieces)[:, None] / pieces
    points = np.concatenate([*(a + steps * (b - a) for a, b in pairwise(round_)), round_[-1:]])
    for angle, found in ((2 * np.pi / n - 1e-6, True), (2 * np.pi / n + 1e-6, False)):
        corners, parts = hd.split_at_corners(points, min(angle, np.pi))
        count = (n if closed else n - 2) if found else 0
        assert len(corners) == count and len(parts) == max(1, count + (not closed))
        assert sum(len(part) - 1 for part in parts) == len(points) - 1
        assert all((a[-1] == b[0]).all() for a, b in pairwise(parts))


def test_a_closed_polyline_starts_at_its_first_corner() -> None:
    """The seam of a square in the middle of a side is no corner."""
    square = [[0.5, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 0], [0.5, 0, 0]]
    corners, parts = hd.split_at_corners(square)
    assert corners.tolist() == [[1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 0]]
    assert parts[-1].tolist() == [[0, 0, 0], [0.5, 0, 0], [1, 0, 0]]
    with pytest.raises(InputError, match="turning_angle: it is"):
        hd.split_at_corners(square, 4.0)
