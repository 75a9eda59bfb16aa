from __future__ import annotations

import math
import subprocess
import sys
from typing import Any

import compas.datastructures as cd
import numpy as np
import pytest
import rhino3dm as r
from hypothesis import given, settings
from hypothesis import strategies as st

import hookean.discretize as hd
from hookean.errors import InputError
from hookean.values.mesh import Mesh
from soak import examples

few = settings(derandomize=True, deadline=None, max_examples=examples(40))
size = st.integers(1, 8)
CUBE = (
    [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]],
    [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]],
)


def grid(n: int, m: int, turn: np.random.Generator | None = None) -> Mesh:
    """n by m unit quads; with `turn` faces in random order, each starting at a random corner, some flipped."""
    v = np.array([[i, j, 0] for j in range(m + 1) for i in range(n + 1)], float)
    k = [j * (n + 1) + i for j in range(m) for i in range(n)]
    f = np.array([[a, a + 1, a + n + 2, a + n + 1] for a in k])
    if turn is not None:
        f = f[turn.permutation(len(f))]
        f = np.array([np.roll(q[:: turn.choice([1, -1])], turn.integers(4)) for q in f])
    return Mesh(v, f)


def test_corners_follow_one_another_along_a_boundary() -> None:
    """Of a square with a square hole: its own corners counter-clockwise as its faces, the hole's the other way; also
    where faces are turned over, the neighbours of a corner are its neighbours along the boundary."""
    whole = grid(5, 4)
    middle = whole.vertices[whole.faces].mean(axis=1)
    holed = Mesh(whole.vertices, whole.faces[np.abs(middle - [2.5, 2.0, 0.0]).max(axis=1) > 1.0])
    found = hd.corners(holed, order="boundary")
    assert found.tolist() == [0, 5, 29, 24]
    rim = hd.corners(holed, 7.0, order="boundary").tolist()
    assert sorted(rim) == hd.naked_vertices(holed).tolist()
    inner = rim[18:]
    hole = holed.vertices[inner][:, :2] - [2.5, 2.0]
    turns = np.cross(np.pad(hole, ((0, 0), (0, 1))), np.pad(np.roll(hole, -1, axis=0), ((0, 0), (0, 1))))[:, 2]
    assert len(inner) == 10 and (turns < 0.0).all()
    for seed in range(5):
        rows = grid(5, 4, np.random.default_rng(seed))
        loop = rows.vertices[hd.corners(rows, 7.0, order="boundary")]
        assert np.linalg.norm(loop - np.roll(loop, 1, axis=0), axis=1) == pytest.approx(np.ones(18))
    with pytest.raises(InputError, match=r'order: unknown order .round.; give "index" or "boundary"'):
        hd.corners(whole, order="round")


@few
@given(size, size, st.integers(0, 999))
def test_grid_parts_are_counted_by_formula(n: int, m: int, seed: int) -> None:
    mesh = grid(n, m, np.random.default_rng(seed))
    e = hd.edges(mesh)
    assert len(e) == n * (m + 1) + m * (n + 1)
    assert (e[:, 0] < e[:, 1]).all() and len(np.unique(e, axis=0)) == len(e)
    assert np.linalg.norm(np.diff(mesh.vertices[e], axis=1)[:, 0], axis=1) == pytest.approx(np.ones(len(e)))
    x, y, _ = mesh.vertices.T
    rim = (x == 0) | (x == n) | (y == 0) | (y == m)
    assert np.array_equal(hd.naked_vertices(mesh), np.flatnonzero(rim))
    assert np.array_equal(hd.clothed_vertices(mesh), np.flatnonzero(~rim))
    assert len(hd.naked_edges(mesh)) == 2 * (n + m)
    assert hd.corners(mesh).tolist() == [0, n, m * (n + 1), (m + 1) * (n + 1) - 1]
    assert len(hd.diagonals(mesh)) == 2 * n * m
    t = mesh.vertices[hd.triangles(mesh)]
    area = 0.5 * np.linalg.norm(np.cross(t[:, 1] - t[:, 0], t[:, 2] - t[:, 0]), axis=1)
    assert area == pytest.approx(np.full(2 * n * m, 0.5))


@few
@given(size, size, st.integers(0, 999))
def test_warp_and_weft_of_a_grid_run_along_the_axes(n: int, m: int, seed: int) -> None:
    mesh = grid(n, m, np.random.default_rng(seed))
    families = hd.warp_weft(mesh)
    along = [np.abs(np.diff(mesh.vertices[f], axis=1)[:, 0]) @ [1.0, 2.0, 0.0] for f in families]
    for a in along:
        assert len(set(a.tolist())) == 1
    assert along[0][0] != along[1][0]
    first = np.diff(mesh.vertices[mesh.faces[0, :2]], axis=0)[0]
    assert abs(first) @ [1.0, 2.0, 0.0] == along[0][0]
    assert sum(map(len, families)) == len(hd.edges(mesh))


@few
@given(st.integers(3, 10), st.integers(2, 8), st.integers(0, 999))
def test_warp_and_weft_of_a_sphere_are_parallels_and_meridians(u: int, v: int, seed: int) -> None:
    mesh = hd.mesh_surface(r.Sphere(r.Point3d(0, 0, 0), 1.0).ToNurbsSurface(), u, v)
    if seed % 2:  # triangles that begin at any corner, as files hold them
        rng = np.random.default_rng(seed)
        f = mesh.faces.copy()
        for row in f[f[:, 2] == f[:, 3]] if v > 2 else ():
            t = np.roll(row[:3], rng.integers(3))
            f[(f == row).all(axis=1)] = [*t, t[2]]
        mesh = Mesh(mesh.vertices, f)
    warp, weft = hd.warp_weft(mesh)
    level = np.abs(np.diff(mesh.vertices[warp][..., 2], axis=1)[:, 0]) < 1e-9
    crossing = np.abs(np.diff(mesh.vertices[weft][..., 2], axis=1)[:, 0]) < 1e-9
    assert level.all() and not crossing.any()
    assert len(warp) == u * (v - 1) and len(weft) == u * v


def test_warp_and_weft_where_they_cannot_be() -> None:
    with pytest.raises(InputError, match=r"^mesh/faces/\d: warp and weft cannot agree"):
        hd.warp_weft(CUBE)
    warp, weft = hd.warp_weft(CUBE, strict=False)
    assert len(warp) + len(weft) == 12
    assert np.array_equal(np.sort(np.concatenate([warp, weft]), axis=0), np.sort(hd.edges(CUBE), axis=0))
    # pieces apart start anew, each at its first quad
    two = hd.join([grid(2, 1), Mesh(grid(1, 2).vertices + 9, grid(1, 2).faces)])
    assert [len(f) for f in hd.warp_weft(two)] == [4 + 3, 3 + 4]
    lone = hd.warp_weft(([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]))
    assert [f.tolist() for f in lone] == [[[0, 1]], [[1, 2], [0, 2]]]


def test_corner_angles_against_a_regular_polygon() -> None:
    for sides in range(3, 12):
        t = 2 * np.pi * np.arange(sides) / sides
        fan = [[0, 1 + k, 1 + (k + 1) % sides] for k in range(sides)]
        mesh = (np.r_[[[0, 0, 0]], np.c_[np.cos(t), np.sin(t), 0 * t]], fan)
        inside = math.pi * (1 - 2 / sides)
        assert len(hd.corners(mesh, inside + 1e-9)) == sides
        assert len(hd.corners(mesh, inside - 1e-9)) == 0
        assert len(hd.corners(mesh)) == (sides if sides < 8 else 0)


def test_diagonals_follow_the_pattern() -> None:
    mesh = grid(2, 1)
    assert hd.diagonals(mesh, "one").tolist() == [[0, 4], [1, 5]]
    assert hd.diagonals(mesh, "other").tolist() == [[1, 3], [2, 4]]
    assert hd.diagonals(mesh).tolist() == [[0, 4], [1, 3], [1, 5], [2, 4]]
    assert len(hd.diagonals(([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]))) == 0
    with pytest.raises(InputError, match="pattern"):
        hd.diagonals(mesh, "all")


@few
@given(st.lists(st.tuples(*[st.floats(-5, 5)] * 3), min_size=4, max_size=4), st.booleans())
def test_quads_split_along_the_shorter_diagonal(points: list[Any], triangle: bool) -> None:
    p = np.array(points)
    t = hd.triangles((p, [[0, 1, 2, 3]])).tolist()
    one, other = np.linalg.norm(p[2] - p[0]), np.linalg.norm(p[3] - p[1])
    if abs(one - other) > 1e-9:
        assert t == ([[0, 1, 2], [0, 2, 3]] if one < other else [[0, 1, 3], [1, 2, 3]])
    assert {frozenset(c) for c in map(tuple, t)} <= {frozenset(s) for s in ((0, 1, 2), (0, 2, 3), (0, 1, 3), (1, 2, 3))}
    assert hd.triangles((p, [[0, 1, 2]])).tolist() == [[0, 1, 2]]


def test_square_ties_split_along_the_first_diagonal() -> None:
    for turn in np.linspace(0, 1, 17):
        c, s = math.cos(turn), math.sin(turn)
        square = np.array([[0, 0, 0], [c, s, 0], [c - s, s + c, 0], [-s, c, 0]])
        assert hd.triangles((square, [[0, 1, 2, 3]])).tolist() == [[0, 1, 2], [0, 2, 3]]


def test_weld_and_join() -> None:
    a, b = grid(2, 2), grid(2, 2)
    shifted = Mesh(b.vertices + np.array([2.0, 0, 1e-8]), b.faces)
    whole = hd.join([a, shifted], 1e-6)
    assert len(whole.vertices) == 15 and len(whole.faces) == 8 and len(hd.naked_edges(whole)) == 12
    assert len(hd.join([a, shifted]).vertices) == 18
    squeezed = hd.weld(Mesh(a.vertices * [1e-9, 1, 1], a.faces), 1e-6)
    assert len(squeezed.vertices) == 3 and len(squeezed.faces) == 0
    tip = hd.weld(([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1e-9, 0]], [[0, 1, 2, 3]]), 1e-6)
    assert tip.faces.tolist() == [[1, 2, 0, 0]]


@few
@given(st.integers(5, 14), st.integers(0, 999), st.floats(0.2, 1.0))
def test_polygons_of_compas_are_cut_by_ears(sides: int, seed: int, least: float) -> None:
    rng = np.random.default_rng(seed)
    t = 2 * np.pi * np.arange(sides) / sides
    star = np.c_[np.cos(t), np.sin(t)] * rng.uniform(least, 1.0, sides)[:, None]
    axes = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    points = star @ axes[:2]
    mesh = hd.as_mesh(cd.Mesh.from_vertices_and_faces(points.tolist(), [list(range(sides))]))
    assert len(mesh.faces) == sides - 2
    p = points[mesh.faces[:, :3]]
    cross = 0.5 * np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]) @ np.cross(axes[0], axes[1])
    shoelace = 0.5 * np.sum(star[:, 0] * np.roll(star[:, 1], -1) - star[:, 1] * np.roll(star[:, 0], -1))
    assert (cross > 0).all() and cross.sum() == pytest.approx(shoelace, rel=1e-12)


def test_meshes_of_every_source_read_the_same() -> None:
    mesh = grid(3, 2)
    rhino = r.Mesh()
    for p in mesh.vertices.tolist():
        rhino.Vertices.Add(*p)
    for f in mesh.faces.tolist():
        rhino.Faces.AddFace(*f)
    compas = cd.Mesh.from_vertices_and_faces(mesh.vertices.tolist(), mesh.faces.tolist())
    for source in (mesh, rhino, compas, (mesh.vertices, mesh.faces)):
        assert np.array_equal(hd.as_mesh(source).faces, mesh.faces)
        assert np.array_equal(hd.vertices(source), mesh.vertices)
        assert np.array_equal(hd.edges(source), hd.edges(mesh))


def test_mesh_of_a_file(rhino_objects: Any) -> None:
    geometry = rhino_objects("v7_my_mesh.3dm")[0][0]
    mesh = hd.as_mesh(geometry)
    assert len(mesh.vertices) == len(geometry.Vertices) and len(mesh.faces) == geometry.Faces.Count
    assert len(hd.naked_edges(hd.weld(mesh, 1e-6))) <= len(hd.naked_edges(mesh))


@pytest.mark.parametrize(
    ("mesh", "says"),
    [
        ("mesh", "is not a mesh"),
        (([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 3]]), "^mesh/faces/0: .*3 or more of the 3 vertices"),
        (([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, -1]]), "counted from 0"),
        (([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1]]), "3 or more"),
        (([[0, 0, 0], [1, np.nan, 0], [0, 1, 0]], [[0, 1, 2]]), "^mesh/vertices/1: it is not finite"),
        (([[0, 0, 0], [2, 2, 0], [2, 0, 0], [0, 2, 0], [0.5, 0.9, 0]], [[0, 1, 2, 3, 4]]), "crosses itself"),
    ],
)
def test_bad_meshes_get_a_sentence(mesh: Any, says: str) -> None:
    with pytest.raises(InputError, match=says):
        hd.as_mesh(mesh)


def test_import_loads_no_heavy_package() -> None:
    code = (
        "import sys, hookean.discretize as d; d.divide([[0, 0, 0], [1, 0, 0]], 2); d.edges; d.mesh_surface\n"
        "print([m for m in ('rhino3dm', 'compas', 'scipy') if m in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
    assert all(callable(getattr(hd, name)) for name in hd.__all__)
    with pytest.raises(AttributeError):
        _ = hd.nothing_of_this_name


@pytest.mark.parametrize(
    ("x", "faces", "pointer", "message"),
    [
        (1.0, [[0, 1, 2, 3], [0.5, 1, 2]], "mesh/faces/1", "not a list of whole numbers"),
        (1e80, [[0, 1, 2, 3]], "mesh/vertices/1", "beyond 1e.70; use larger units"),
    ],
)
def test_a_mesh_without_whole_numbers_or_with_coordinates_that_overflow_is_refused(
    x: float, faces: Any, pointer: str, message: str
) -> None:
    """A corner 0.5 is no vertex; the area of a mesh of 1e80 has a square of a square that no float64 holds."""
    with pytest.raises(InputError, match=message) as error:
        hd.area(([[0, 0, 0], [x, 0, 0], [x, x, 0], [0, x, 0]], faces))
    assert error.value.faults[0].pointer == pointer
    whole = hd.as_mesh(([[0, 0, 0], [1, 0, 0], [1, 1, 0]], np.array([[0.0, 1.0, 2.0]])))
    assert whole.faces.tolist() == [[0, 1, 2, 2]]
