"""Finer meshes: counts and areas by formula, one step of Catmull-Clark and Loop by hand, no gaps."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import hookean.discretize as hd
from discretize.shapes import CUBE, OCTAHEDRON, euler, grid, oriented, strip
from hookean.errors import InputError
from hookean.values.mesh import Mesh
from soak import examples

few = settings(derandomize=True, deadline=None, max_examples=examples(25))
MIXED = Mesh(
    np.array([[0, 0, 0], [1, 0, 0], [2, 0.5, 0.2], [0, 1, 0], [1, 1, 0.4]], float),
    np.array([[0, 1, 4, 3], [1, 2, 4, 4]]),
)


@pytest.mark.slow
@few
@given(st.integers(1, 5), st.integers(1, 5), st.integers(0, 3), st.booleans())
def test_a_grid_is_refined_into_the_finer_grid(n: int, m: int, level: int, three: bool) -> None:
    """(2^L n + 1)(2^L m + 1) vertices, 4^L faces for one, each of 4^-L of the area; the same boundary."""
    coarse = grid(n, m, triangles=three)
    fine = hd.refine(coarse, level)
    k = 2**level
    assert len(fine.vertices) == (k * n + 1) * (k * m + 1)
    assert len(fine.faces) == len(coarse.faces) * 4**level
    assert len(hd.naked_edges(fine)) == 2 * k * (n + m) and oriented(fine) and euler(fine) == 1
    one = [hd.area(Mesh(fine.vertices, face[None])) for face in fine.faces]
    assert one == pytest.approx(np.full(len(one), (0.5 if three else 1.0) / k**2), rel=1e-13)
    assert (fine.vertices[: len(coarse.vertices)] == coarse.vertices).all()


@pytest.mark.parametrize("mesh", [CUBE, OCTAHEDRON, MIXED, strip(5, np.pi, closed=True)])
def test_refining_keeps_topology_area_and_volume(mesh: Mesh) -> None:
    """Flat faces are cut in their planes; V - E + F stays, and closed meshes stay closed."""
    fine = hd.refine(mesh, 2)
    assert euler(fine) == euler(mesh)
    assert len(hd.naked_edges(fine)) == 4 * len(hd.naked_edges(mesh))
    if mesh in (CUBE, OCTAHEDRON):
        assert oriented(fine)
        assert hd.volume(fine) == pytest.approx(hd.volume(mesh), rel=1e-13)
        assert hd.area(fine) == pytest.approx(hd.area(mesh), rel=1e-13)


def test_quads_keep_the_direction_of_their_sides() -> None:
    fine = hd.refine(grid(2, 2), 2)
    first, last = (fine.vertices[fine.faces[:, k]] for k in (0, 1))
    assert np.allclose(last - first, [0.25, 0.0, 0.0])


def test_a_smooth_cube_is_that_of_catmull_and_clark() -> None:
    """Corners (F + 2 R) / 3 = 5/9, edge points 3/4, face points 1 (Catmull, Clark, 1978), of a cube of half side 1."""
    fine = hd.refine(CUBE, 1, smooth=True)
    assert np.abs(fine.vertices[:8]) == pytest.approx(np.full((8, 3), 5 / 9), rel=1e-14)
    edges, faces = fine.vertices[8:20], fine.vertices[20:]
    assert np.sort(np.abs(edges), axis=1) == pytest.approx(np.tile([0.0, 0.75, 0.75], (12, 1)), abs=1e-15)
    assert np.sort(np.abs(faces), axis=1) == pytest.approx(np.tile([0.0, 0.0, 1.0], (6, 1)), abs=1e-15)


def test_a_smooth_octahedron_is_that_of_loop() -> None:
    """Corners 1 - 4 beta = 33/64 with beta = (5/8 - (3/8 + cos(pi/2)/4)^2)/4 (Loop, 1987); edge points 3/8 + 1/8 0."""
    fine = hd.refine(OCTAHEDRON, 1, smooth=True)
    assert np.abs(fine.vertices[:6]).max(axis=1) == pytest.approx(np.full(6, 33 / 64), rel=1e-14)
    edges = np.sort(np.abs(fine.vertices[6:]), axis=1)
    assert edges == pytest.approx(np.tile([0.0, 0.375, 0.375], (12, 1)), abs=1e-15)


def test_smoothing_is_affine_and_keeps_planes_and_lone_corners() -> None:
    rng = np.random.default_rng(4)
    move, shift = rng.normal(size=(3, 3)), rng.normal(size=3)
    fine = hd.refine(MIXED, 2, smooth=True)
    moved = hd.refine(Mesh(MIXED.vertices @ move + shift, MIXED.faces), 2, smooth=True)
    assert moved.vertices == pytest.approx(fine.vertices @ move + shift, abs=1e-13)
    flat = hd.refine(grid(3, 2), 2, smooth=True)
    assert (flat.vertices[:, 2] == 0.0).all()
    assert flat.vertices[hd.corners(flat)] == pytest.approx(grid(3, 2).vertices[hd.corners(grid(3, 2))])
    inner = grid(4, 4)
    again = hd.refine(inner, 1, smooth=True).vertices[12]  # a regular vertex of a plane stays
    assert again == pytest.approx(inner.vertices[12], abs=1e-15)


@few
@given(st.integers(1, 6), st.integers(1, 4), st.sampled_from([0.0, 1.0]))
def test_a_strip_is_cut_along_its_length_alone(count: int, level: int, twist: float) -> None:
    """2^L faces for one; the rungs of the strip stay, and the rails keep their length."""
    band = strip(count, twist)
    if count == 1:  # which is along is the longer pair of sides
        band = Mesh(band.vertices * [3.0, 1.0, 1.0], band.faces)
    fine = hd.refine_strips(band, level)
    assert len(fine.faces) == count * 2**level and len(fine.vertices) == 2 * (count * 2**level + 1)
    assert oriented(fine) and euler(fine) == 1
    rungs = {(2 * i, 2 * i + 1) for i in range(count + 1)}
    assert rungs <= set(map(tuple, hd.edges(fine).tolist()))
    rim, before = (mesh.vertices[hd.naked_edges(mesh)] for mesh in (fine, band))
    assert np.linalg.norm(np.diff(rim, axis=1)) ** 2 * 2**level == pytest.approx(
        np.linalg.norm(np.diff(before, axis=1)) ** 2 + 2 * (2**level - 1), rel=1e-12
    )  # two rungs of length 1 are whole, the rest is in 2^L equal pieces
    assert (fine.vertices[: len(band.vertices)] == band.vertices).all()


@few
@given(st.integers(1, 4), st.integers(1, 4), st.integers(0, 2), st.sampled_from(["warp", "weft"]))
def test_one_direction_of_a_grid_is_refined(n: int, m: int, level: int, direction: str) -> None:
    fine = hd.refine_strips(grid(n, m), level, direction)
    k = 2**level
    across = (k * n, m) if direction == "warp" else (n, k * m)
    assert len(fine.vertices) == (across[0] + 1) * (across[1] + 1) and len(fine.faces) == across[0] * across[1]
    sizes = np.ptp(fine.vertices[fine.faces], axis=1)[:, :2]
    assert np.allclose(sizes, [n / across[0], m / across[1]])
    assert oriented(fine) and hd.area(fine) == pytest.approx(n * m)


def test_strips_of_triangles_have_no_gaps() -> None:
    """A fan round a pole, and a ring of quads about it: meridians are halved, or parallels."""
    mesh = hd.refine_strips(grid(3, 1, triangles=True), 2)
    assert euler(mesh) == 1 and oriented(mesh) and hd.area(mesh) == pytest.approx(3.0)
    turn = 2 * np.pi * np.arange(6) / 6
    rings = [np.stack([r * np.cos(turn), r * np.sin(turn), 0 * turn], axis=1) for r in (1.0, 2.0)]
    i, j = np.arange(6), (np.arange(6) + 1) % 6
    faces = np.concatenate([np.stack([i + 6, j + 6, j, i], axis=1), np.stack([i, j, i * 0 + 12, i * 0 + 12], axis=1)])
    dome = Mesh(np.concatenate([*rings, np.zeros((1, 3))]), faces)
    for direction, factor in (("warp", 2), ("weft", 1)):
        fine = hd.refine_strips(dome, 1, direction)
        assert euler(fine) == 1 and oriented(fine) and hd.area(fine) == pytest.approx(hd.area(dome))
        assert len(hd.naked_edges(fine)) == 6 * factor


@few
@given(st.integers(1, 5), st.integers(1, 5), st.booleans())
def test_each_edge_becomes_a_face(n: int, m: int, three: bool) -> None:
    mesh = grid(n, m, triangles=three)
    turned = hd.diagonalize(mesh)
    inner = len(hd.edges(mesh)) - len(hd.naked_edges(mesh))
    quad = turned.faces[:, 2] != turned.faces[:, 3]
    assert len(turned.faces) == len(hd.edges(mesh)) and quad.sum() == inner
    assert len(turned.vertices) == len(mesh.vertices) + len(mesh.faces)
    assert hd.area(turned) == pytest.approx(n * m) and euler(turned) == 1 and oriented(turned)
    assert len(hd.naked_edges(turned)) == len(hd.naked_edges(mesh))


def test_a_turned_cube_is_closed() -> None:
    """12 faces round 8 + 6 vertices. Cut along the cube's edges they are the cube, of volume 8; cut across, 12
    tetrahedra of 1/3 are missing: in the mean 6."""
    turned = hd.diagonalize(CUBE)
    assert len(turned.faces) == 12 and len(turned.vertices) == 14 and euler(turned) == 2 and oriented(turned)
    assert not len(hd.naked_edges(turned)) and hd.volume(turned) == pytest.approx(6.0)


@pytest.mark.parametrize(
    ("name", "options", "sentence"),
    [
        ("refine", {"level": -1}, "level: -1 levels were asked for; give a whole number of at least 0"),
        ("refine", {"level": 1.5}, "level: 1.5 levels were asked for; give a whole number of at least 0"),
        ("refine", {"level": 40}, "level: 40 levels make more than 20000000 faces; give a lower one"),
        ("refine_strips", {"direction": "up"}, "direction: unknown direction"),
    ],
)
def test_bad_options(name: str, options: dict[str, object], sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        getattr(hd, name)(CUBE, **options)


def test_edges_of_three_faces_cannot_be_turned() -> None:
    book = Mesh(np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [0, -1, 0]], float),
                np.array([[0, 1, 2, 2], [0, 1, 3, 3], [0, 1, 4, 4]]))  # fmt: skip
    with pytest.raises(InputError, match="an edge of it has 3 faces"):
        hd.diagonalize(book)
