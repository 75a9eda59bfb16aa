"""Pipes, graphs, Moebius transformations, strips and reciprocal figures: closed forms and what must not change."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hookean import InputError, Scene, relax
from hookean.discretize import (
    align_quads,
    area,
    bipartite,
    edges,
    interconnect_points,
    moebius_transformation,
    naked_edges,
    pipes,
    reciprocal_diagram,
    strips,
    turn_quads,
    unroll_strips,
    volume,
)
from hookean.values.mesh import Mesh

from .shapes import CUBE, euler, grid, oriented, strip

CUBE_LINES = CUBE.vertices[edges(CUBE)]


def frame(seed: int) -> np.ndarray:
    """Random points, joined to a few others each."""
    rng = np.random.default_rng(seed)
    x = np.array([[i, j, k] for i in range(3) for j in range(2) for k in range(2)]) + rng.uniform(-0.2, 0.2, (12, 3))
    pairs = [(a, b) for a in range(12) for b in range(a) if rng.random() < 0.25 and np.linalg.norm(x[a] - x[b]) < 2.3]
    return x[np.array(pairs)]


@pytest.mark.parametrize("sides", [3, 4, 7])
@pytest.mark.parametrize("lines", [CUBE_LINES, CUBE_LINES[:3], *(frame(seed) for seed in range(6))])
def test_pipes_are_closed_and_of_the_genus_of_their_graph(lines: np.ndarray, sides: int) -> None:
    """Each directed side once and its opposite once; V - E + F = 2 (n - m) of n nodes and m lines, as a handlebody has
    genus m - n + 1 in each part; a positive volume, so faces look outwards."""
    mesh = pipes(lines, 0.02, sides)
    assert oriented(mesh) and len(naked_edges(mesh)) == 0
    nodes = len(np.unique(lines.reshape(-1, 3), axis=0))
    assert euler(mesh) == 2 * (nodes - len(lines))
    assert volume(mesh) > 0.0


def test_one_pipe_is_a_prism() -> None:
    """Its volume is l n / 2 r^2 sin(2 pi / n), its surface that of the prism."""
    mesh = pipes([[[1, 2, 3], [3, 3, 5]]], 0.4, 5)
    base, side = 2.5 * 0.16 * np.sin(0.4 * np.pi), 2.0 * 0.4 * np.sin(0.2 * np.pi)
    assert volume(mesh) == pytest.approx(3.0 * base, rel=1e-14)
    assert area(mesh) == pytest.approx(2.0 * base + 5.0 * side * 3.0, rel=1e-14)


def test_rings_are_round_their_lines() -> None:
    """Every corner is at the radius from the axis of a line, and rings at a node lie on one sphere."""
    mesh = pipes(CUBE_LINES, 0.1)
    a, along = CUBE_LINES[:, 0], CUBE_LINES[:, 1] - CUBE_LINES[:, 0]
    off = mesh.vertices[:, None] - a
    away = np.linalg.norm(np.cross(off, along / 2.0), axis=2)
    assert np.abs(away - 0.1).min(axis=1).max() < 1e-15
    out = np.linalg.norm(np.abs(mesh.vertices) - 1.0, axis=1)
    assert out == pytest.approx(np.full(len(out), 0.1 * np.sqrt(1.0 + 1.05**2)), rel=1e-12)


@pytest.mark.parametrize(
    ("lines", "radius", "sides", "message"),
    [
        ([[[0, 0, 0], [0, 0, 0]]], 0.1, 6, "lines/0: it starts and ends at one node"),
        ([[[0, 0, 0], [1, 0, 0]], [[1, 0, 0], [0, 0, 0]]], 0.1, 6, "lines/1: it is the same as one before"),
        ([[[0, 0, 0], [1, 0, 0]], [[0, 0, 0], [2, 0, 0]]], 0.1, 6, "another line leaves its end in the same direction"),
        (CUBE_LINES, 1.0, 6, "lines/0: its length is 2, and its nodes take 2.1"),
        (CUBE_LINES, 0.0, 6, "radius: it is 0.0"),
        (CUBE_LINES, 0.1, 2, "sides: it is 2"),
    ],
)
def test_pipes_that_cannot_be_are_refused(lines: Any, radius: float, sides: int, message: str) -> None:
    with pytest.raises(InputError, match=message):
        pipes(lines, radius, sides)


def test_every_two_points_are_joined_once() -> None:
    """n (n - 1) / 2 lines, all different pairs."""
    x = np.random.default_rng(0).normal(size=(9, 3))
    lines = interconnect_points(x)
    assert len({frozenset(map(tuple, line)) for line in lines.tolist()}) == len(lines) == 36
    assert len(interconnect_points(x[:1])) == len(interconnect_points([])) == 0


def test_the_two_groups_of_a_cube() -> None:
    """Its corners with an even and an odd number of positive coordinates; an odd ring has none."""
    first, second = bipartite(CUBE_LINES)
    even = (first > 0).sum(axis=1) % 2
    assert len(first) == len(second) == 4
    assert (even == even[0]).all() and ((second > 0).sum(axis=1) % 2 != even[0]).all()
    x = np.eye(3)
    with pytest.raises(InputError, match="lines/1: it closes a ring of an odd number"):
        bipartite([[x[0], x[1]], [x[1], x[2]], [x[2], x[0]]])


def test_moebius_transformations_keep_cross_ratios_and_spheres() -> None:
    """|ab| |cd| / (|ac| |bd|) of any four points; the fixed circle; back by the opposite angle; a sphere stays one."""
    rng = np.random.default_rng(1)
    x, axis, centre = rng.normal(size=(40, 3)), [1.0, -2.0, 0.5], [0.3, 0.1, -0.4]
    moved = moebius_transformation(x, 0.8, axis, centre, 1.7)

    def ratio(p: np.ndarray) -> np.ndarray:
        a, b, c, d = p.reshape(4, -1, 3)
        norm = np.linalg.norm
        return np.asarray(norm(a - b, axis=1) * norm(c - d, axis=1) / norm(a - c, axis=1) / norm(b - d, axis=1))

    assert ratio(moved) == pytest.approx(ratio(x), rel=1e-12)
    assert moebius_transformation(moved, -0.8, axis, centre, 1.7) == pytest.approx(x, abs=1e-12)
    u = np.cross(axis, [0, 0, 1.0])
    fixed = centre + 1.7 * u / np.linalg.norm(u)
    assert moebius_transformation([fixed], 0.8, axis, centre, 1.7)[0] == pytest.approx(fixed, abs=1e-14)
    ball = x / np.linalg.norm(x, axis=1)[:, None] * 0.5 + [2.0, 0, 0]
    there = moebius_transformation(ball, 0.8, axis, centre, 1.7)
    table = np.column_stack([2.0 * there, np.ones(len(there))])
    found = np.linalg.lstsq(table, (there**2).sum(axis=1), rcond=None)
    assert found[1][0] < 1e-20
    with pytest.raises(InputError, match="points/0: it would go to infinity"):
        moebius_transformation([[0, 0, 1.0]], np.pi / 2)


def shuffled(mesh: Mesh, seed: int) -> Mesh:
    """The same quads, each from another corner."""
    rolls = np.random.default_rng(seed).integers(0, 4, len(mesh.faces))
    return Mesh(mesh.vertices, np.array([np.roll(f, k) for f, k in zip(mesh.faces, rolls, strict=True)]))


def test_quads_are_turned_to_one_direction() -> None:
    """On a flat grid, first sides that are all parallel and of one sense; turned by one, all at a right angle; four
    turns are none; and normals stay."""
    mesh = align_quads(shuffled(grid(4, 3), 2))
    first = mesh.vertices[mesh.faces[:, 1]] - mesh.vertices[mesh.faces[:, 0]]
    assert (first == first[0]).all()
    turned = turn_quads(mesh)
    second = turned.vertices[turned.faces[:, 1]] - turned.vertices[turned.faces[:, 0]]
    assert second @ first[0] == pytest.approx(np.zeros(12))
    assert turn_quads(mesh, 4).faces.tolist() == mesh.faces.tolist()
    assert oriented(mesh)


def test_a_cube_has_no_one_direction() -> None:
    """Its corners have three quads; not strict, each keeps the direction that reaches it first."""
    with pytest.raises(InputError, match=r"mesh/faces/.*cannot agree"):
        align_quads(CUBE)
    assert np.sort(align_quads(CUBE, strict=False).faces).tolist() == np.sort(CUBE.faces).tolist()


def cylinder(count: int = 12, rows: int = 2) -> Mesh:
    """A closed cylinder of quads, of radius 1 and height `rows`."""
    turn = np.arange(count) * 2.0 * np.pi / count
    x = np.array([[np.cos(a), np.sin(a), z] for z in range(rows + 1) for a in turn])
    i, j = np.arange(count), np.arange(rows)[:, None]
    a, b = j * count + i, j * count + (i + 1) % count
    return Mesh(x, np.stack([a, b, b + count, a + count], axis=2).reshape(-1, 4))


def test_a_cylinder_unrolls_to_rectangles() -> None:
    """Rings of it to strips as long as 12 chords and 1 high, columns to strips 2 long: in all the same area."""
    whole, chord = cylinder(), 2.0 * np.sin(np.pi / 12.0)
    across = {len(np.unique(strips(whole, way))): way for way in ("warp", "weft")}
    assert set(across) == {2, 12}
    rings = unroll_strips(whole, across[2], 0.5)
    columns = unroll_strips(whole, across[12])
    assert np.ptp(rings.vertices, axis=0) == pytest.approx([12.0 * chord, 2.5, 0.0], abs=1e-13)
    assert np.ptp(columns.vertices, axis=0) == pytest.approx([2.0, 12.0 * chord, 0.0], abs=1e-13)
    assert area(rings) == pytest.approx(area(whole), rel=1e-13)


@pytest.mark.parametrize("way", ["warp", "weft"])
@pytest.mark.parametrize("mesh", [strip(8, 0.4), cylinder(9, 4), grid(5, 4), grid(3, 2)])
def test_unrolled_faces_keep_the_lengths_of_their_sides(mesh: Mesh, way: str) -> None:
    """All four sides and the shorter diagonal of each face, in its place in the list; they look up."""
    flat = unroll_strips(mesh, way)
    assert len(flat.faces) == len(mesh.faces) and (flat.vertices[:, 2] == 0.0).all()
    before, after = mesh.vertices[mesh.faces], flat.vertices[flat.faces]
    for step in (1, 2):
        one, other = (np.linalg.norm(np.roll(x, -step, axis=1) - x, axis=2) for x in (before, after))
        assert (other.min(axis=1) if step == 2 else other) == pytest.approx(
            one.min(axis=1) if step == 2 else one, abs=1e-13
        )
    assert (np.cross(after[:, 2] - after[:, 0], after[:, 3] - after[:, 1])[:, 2] > 0.0).all()


def test_lines_of_a_reciprocal_figure_balance() -> None:
    """At a right angle to their edges, q times as long, and round each inner vertex a closed polygon: the sum of forces
    is zero. A regular net has q = 1, and its figure is the dual grid."""
    rng = np.random.default_rng(4)
    mesh = grid(5, 4, triangles=True)
    x = mesh.vertices + np.column_stack([0.1 * rng.normal(size=(len(mesh.vertices), 2)), np.zeros(len(mesh.vertices))])
    tilt = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    x = x @ tilt.T
    lines, q = reciprocal_diagram(Mesh(x, mesh.faces))
    naked = {tuple(sorted(pair)) for pair in naked_edges(mesh).tolist()}
    inner = np.array([pair for pair in edges(mesh).tolist() if tuple(sorted(pair)) not in naked])
    along, across = x[inner[:, 1]] - x[inner[:, 0]], lines[:, 1] - lines[:, 0]
    size = np.linalg.norm(along, axis=1)
    assert np.abs((along * across).sum(axis=1)).max() < 1e-9
    assert np.linalg.norm(across, axis=1) == pytest.approx(np.abs(q) * size, abs=1e-9)
    for vertex in np.setdiff1d(np.unique(inner), naked_edges(mesh)):
        sign = (inner[:, 0] == vertex).astype(float) - (inner[:, 1] == vertex)
        assert np.abs((sign * q) @ along).max() < 1e-8
        assert np.abs(sign @ across).max() < 1e-8
    lines, q = reciprocal_diagram(grid(4, 4))
    assert q == pytest.approx(np.ones(len(q)), abs=1e-9)
    assert np.unique(np.round(lines.reshape(-1, 3), 6), axis=0).shape == (16, 3)


def test_the_figure_of_a_net_in_plan_has_its_thrusts() -> None:
    """A net of random force densities hangs by its rim under vertical loads. Seen from above, forces balance at inner
    vertices without the loads: polygons of the figure close, lines are at a right angle to the edges in plan, and each
    is as long as its edge's horizontal thrust, q times the length in plan, to 1e-6 of rounding and equilibrium."""
    rng = np.random.default_rng(6)
    mesh = grid(6, 5)
    naked = {tuple(sorted(pair)) for pair in naked_edges(mesh).tolist()}
    pairs = np.array([pair for pair in edges(mesh).tolist() if tuple(sorted(pair)) not in naked])
    rim, q = np.unique(naked_edges(mesh)), rng.uniform(0.5, 2.0, len(pairs))
    inside = np.setdiff1d(np.arange(len(mesh.vertices)), rim)
    springs = {"kind": "springs", "name": "net", "particles": pairs, "stiffness": q, "rest_length": 0.0}
    load = {"kind": "unary", "particles": inside, "vector": [0, 0, -1]}
    scene = {"particles": mesh.vertices, "forces": [springs, load], "anchors": [{"particles": rim}]}
    result = relax(Scene.read({**scene, "settings": {"tolerance": 1e-10}}))
    own, x = result.force("net"), result.particles
    shape = Mesh(x, mesh.faces)
    order = rng.permutation(len(pairs))
    flip = np.where(rng.random(len(pairs))[:, None] < 0.5, pairs, pairs[:, ::-1])[order]
    lines, found = reciprocal_diagram(shape, flip, (own["force"] / own["length"])[order], direction=[0, 0, 1])
    assert found == pytest.approx(q, rel=1e-9)
    along, across = x[pairs[:, 1]] - x[pairs[:, 0]], lines[:, 1] - lines[:, 0]
    thrust = q * np.hypot(along[:, 0], along[:, 1])
    assert np.linalg.norm(across, axis=1) == pytest.approx(thrust, rel=1e-6)
    assert np.abs(across[:, 2]).max() < 1e-12
    assert np.abs((along * across).sum(axis=1)).max() < 1e-6
    for vertex in inside:
        sign = (pairs[:, 0] == vertex).astype(float) - (pairs[:, 1] == vertex)
        assert np.abs(sign @ across).max() < 1e-6
    with pytest.raises(InputError, match="across the loads"):
        reciprocal_diagram(shape, pairs, rng.uniform(0.5, 2.0, len(pairs)), direction=[0, 0, 1])
    with pytest.raises(InputError, match="is no edge of the mesh") as error:
        reciprocal_diagram(shape, [*pairs[:3].tolist(), [0, 20]], 1.0, direction=[0, 0, 1])
    assert error.value.faults[0].pointer == "pairs/3"
    with pytest.raises(InputError, match="give 49 numbers"):
        reciprocal_diagram(shape, pairs, [1.0, 2.0], direction=[0, 0, 1])
    with pytest.raises(InputError, match="three numbers that are not all 0"):
        reciprocal_diagram(shape, pairs, q, direction=[0, 0, 0])


def test_a_net_that_nothing_balances_has_no_figure() -> None:
    """A vertex with three edges to one side; a mesh that is not flat."""
    x = np.array([[0.0, 0, 0], [4, 0, 0], [2, 3, 0], [2, 1, 0]])
    faces = [[0, 1, 3, 3], [1, 2, 3, 3], [2, 0, 3, 3]]
    assert len(reciprocal_diagram(Mesh(x, np.array(faces)))[1]) == 3
    x[3] = [9, 1, 0]
    with pytest.raises(InputError, match="is not flat"):
        reciprocal_diagram(Mesh(x + np.array([[0, 0, 0], [0, 0, 0], [0, 0, 0], [0, 0, 1.0]]), np.array(faces)))


@pytest.mark.parametrize(("scale", "away"), [(1.0, 1e15), (1e100, 0.0)])
def test_pipes_that_rounding_would_bend_are_refused(scale: float, away: float) -> None:
    """Float64 rounds coordinates of 1e15 to 1/8, more than a radius of 0.05; squares of squares of 1e100 overflow."""
    lines = np.array([[[0, 0, 0], [1, 0, 0]], [[0, 0, 0], [0, 1, 0]], [[0, 0, 0], [0, 0, 1.0]]]) * scale + away
    with pytest.raises(InputError, match="too large for float64 beside a radius"):
        pipes(lines, 0.05 * scale)
