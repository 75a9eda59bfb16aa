"""Cutting patterns against developable surfaces, a sphere's gores and strips sewn together; lengths of cables."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import hookean
from hookean import InputError, Scene
from hookean.discretize import quads
from hookean.discretize.flatten import flatten, outline
from hookean.discretize.geodesics import cut_along, geodesic
from hookean.discretize.mesh_strips import face_rows, row_edges, strips
from hookean.discretize.outlines import offset
from hookean.values.mesh import Mesh
from hookean.workshop.cables import chains
from hookean.workshop.patterns import strains


def grid(u: np.ndarray, v: np.ndarray, place: Any) -> Mesh:
    """A quad mesh of a surface over parameters: u runs slowest, faces have sides along u and v."""
    points = np.array([place(a, b) for a in u for b in v], dtype=float)
    number = np.arange(len(points)).reshape(len(u), len(v))
    faces = np.stack([number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]], axis=-1).reshape(-1, 4)
    return Mesh(points, faces)


def apart(points: np.ndarray) -> np.ndarray:
    """All distances between points."""
    return np.linalg.norm(points[:, None] - points[None], axis=2)


@pytest.mark.parametrize("rows", [1, 3])
def test_a_cylinder_unrolls_exactly(rows: int) -> None:
    """A polygonal cylinder's planar quads: arc a of the section becomes n 2 R sin(a / 2 n), heights stay. To 1e-12."""
    radius, n = 2.0, 12
    turn = np.linspace(0.0, 2.0, n + 1)
    mesh = grid(turn, np.linspace(0.0, 3.0, 7), lambda a, z: [radius * np.cos(a), radius * np.sin(a), z])
    part = Mesh(mesh.vertices, mesh.faces) if rows == 3 else Mesh(mesh.vertices[:14], mesh.faces[:6])
    count = n if rows == 3 else 1
    side = 2.0 * radius * np.sin(2.0 / n / 2.0)
    flat = flatten(part)
    wanted = np.array([[i * side, z] for i in range(count + 1) for z in np.linspace(0.0, 3.0, 7)])
    np.testing.assert_allclose(apart(flat.points), apart(wanted), atol=1e-12 * 30)
    assert flat.distortion < 1e-9 and flat.areas.sum() == pytest.approx(count * side * 3.0, rel=1e-12)


def test_a_cone_unrolls_to_its_sector() -> None:
    """A cone of slant s and radius r over an angle a: the flat sector of its n planar faces opens by
    n 2 asin(r / s sin(a / 2 n)), which tends to a r / s; to 1e-9."""
    radius, height, n, whole = 1.5, 2.0, 16, 5.0
    slant = np.hypot(radius, height)
    turn = np.linspace(0.0, whole, n + 1)

    def place(a: float, t: float) -> list[float]:
        return [t * radius * np.cos(a), t * radius * np.sin(a), -t * height]

    mesh = grid(turn, np.linspace(0.2, 1.0, 6), place)
    flat = flatten(mesh)
    points = flat.points.reshape(n + 1, 6, 2)
    first, last = points[0, -1] - points[0, 0], points[-1, -1] - points[-1, 0]
    each = 2.0 * np.arcsin(radius / slant * np.sin(whole / n / 2.0))
    opened = abs(np.arctan2(first[0] * last[1] - first[1] * last[0], first @ last))
    assert opened == pytest.approx(n * each, abs=1e-9)  # less than half a turn
    assert flat.distortion < 1e-9
    # all corners lie at their slant distance from one apex
    apex = points[0, 0] - first / 4.0
    np.testing.assert_allclose(np.linalg.norm(points[:, -1] - apex, axis=1), slant, rtol=1e-9)


def sphere(around: int, up: int, radius: float = 3.0) -> Mesh:
    """A ball without its poles' caps: meridians are seams."""
    turn = np.linspace(0.0, 2.0 * np.pi, around + 1)[:-1]
    rise = np.linspace(-1.3, 1.3, up + 1)
    open_mesh = grid(
        turn, rise, lambda a, b: radius * np.array([np.cos(a) * np.cos(b), np.sin(a) * np.cos(b), np.sin(b)])
    )
    number = np.arange(around * (up + 1)).reshape(around, up + 1)
    near = np.roll(number, -1, axis=0)
    faces = np.stack([number[:, :-1], near[:, :-1], near[:, 1:], number[:, 1:]], axis=-1).reshape(-1, 4)
    return Mesh(open_mesh.vertices, faces)


def test_the_gores_of_a_sphere_have_their_closed_form() -> None:
    """n polyhedral gores: at latitude b the chord 2 R cos b sin(pi / n), and along the middle the distances of the
    chords' midpoints; to 1e-9. Widths tend to the classical gore, 2 R cos b pi / n, with 1 / n^2."""
    radius, around, up = 3.0, 12, 20
    mesh = sphere(around, up, radius)
    found = hookean.cutting_patterns(mesh, labels=np.arange(len(mesh.faces)) // up)
    assert len(found.strips) == around
    rise = np.linspace(-1.3, 1.3, up + 1)
    chord = 2.0 * radius * np.cos(rise) * np.sin(np.pi / around)
    middle = radius * np.stack([np.cos(rise) * np.cos(np.pi / around), np.sin(rise)], axis=1)
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(middle, axis=0), axis=1))])
    for strip in found.strips[:3]:
        x = np.sort(strip.points[:, 0]).reshape(up + 1, 2)
        np.testing.assert_allclose(x, np.repeat(along[:, None], 2, axis=1) + x[0, 0], atol=1e-9)
        order = np.argsort(strip.points[:, 0], kind="stable").reshape(up + 1, 2)
        np.testing.assert_allclose(np.abs(np.diff(strip.points[order, 1], axis=1)[:, 0]), chord, atol=1e-9)
        assert strip.flat.distortion < 1e-9
    classical = 2.0 * radius * np.cos(rise) * np.pi / around
    assert np.abs(chord / classical - 1.0).max() < (np.pi / around) ** 2 / 6.0
    assert found.compensation == (0.0, 0.0) and len(found.seams) == around
    assert max(abs(a - b) for a, b in found.seams.values()) < 1e-9


def test_a_seam_over_a_triangle_with_two_corners_at_one_place_is_refused() -> None:
    """The edge there has no direction."""
    mesh = grid(np.linspace(0, 2, 5), np.linspace(0, 2, 5), lambda a, z: [a * 0.0, z * 0.0, 0.0])
    with pytest.raises(InputError, match="at one place; weld the mesh first"):
        geodesic(mesh, 0, 13)


@pytest.mark.parametrize(
    ("start", "end"), [((0, 0), (12, 7)), ((0, 3), (12, 5)), ((0, 0), (5, 3)), ((12, 7), (2, 0)), ((0, 0), (0, 7))]
)
def test_a_geodesic_on_a_cylinder_is_a_straight_line_of_its_development(start: Any, end: Any) -> None:
    """To rounding: the polygonal cylinder unrolls to a plane."""
    mesh = grid(np.linspace(0, 2, 13), np.linspace(0, 3, 8), lambda a, z: [2 * np.cos(a), 2 * np.sin(a), z])
    found = geodesic(mesh, 8 * start[0] + start[1], 8 * end[0] + end[1])
    side = 4.0 * np.sin(1.0 / 12.0)
    wanted = np.hypot((end[0] - start[0]) * side, (end[1] - start[1]) * 3.0 / 7.0)
    assert found.length == pytest.approx(wanted, rel=1e-12)
    flat = np.arctan2(found.points[:, 1], found.points[:, 0])
    assert np.linalg.norm(np.diff(found.points, axis=0), axis=1).sum() == pytest.approx(wanted, rel=1e-12)
    assert (np.diff(flat) * (end[0] - start[0]) >= -1e-12).all()


def test_a_geodesic_on_a_sphere_tends_to_its_great_circle() -> None:
    """With the square of the mesh's side: as that is halved, the error falls by 4 +- 15 %."""
    errors = []
    for q in (8, 16):
        mesh = sphere(4 * q, 2 * q)
        a, b = q // 2, (q + q // 4) * (2 * q + 1) + (3 * q) // 2
        x, y = mesh.vertices[a] / 3.0, mesh.vertices[b] / 3.0
        errors.append(1.0 - geodesic(mesh, a, b).length / (3.0 * np.arccos(x @ y)))
    assert 0.0 < errors[1] < errors[0] < 4e-3
    assert 3.4 < errors[0] / errors[1] < 4.6


def test_geodesic_seams_are_shorter_and_lie_straighter_in_the_cloth() -> None:
    """On a cap z = -(x^2 + y^2) / 10, beside seams along its rows: a geodesic has no curvature
    within the surface, so in the plane it bends only by what flattening distorts."""
    side = np.linspace(-3.0, 3.0, 13)
    mesh = grid(side, side, lambda a, b: [a, b, -0.1 * (a * a + b * b)])
    pairs = [(3 * 13, 3 * 13 + 12), (9 * 13, 9 * 13 + 12)]
    straight = hookean.cutting_patterns(mesh, seams=pairs)
    along = hookean.cutting_patterns(mesh, labels=np.repeat([0, 0, 0, 1, 1, 1, 1, 1, 1, 2, 2, 2], 12))
    assert len(straight.strips) == len(along.strips) == 3

    def bend(found: Any) -> float:
        """How far the seam of the first strip lies from its chord, as a part of that."""
        strip = found.strips[0]
        on = np.unique(np.concatenate([strip.seam[i : i + 1] for i in np.flatnonzero(strip.beside >= 0)]))
        points = strip.points[on]
        ends = points[[points[:, 0].argmin(), points[:, 0].argmax()]]
        chord = ends[1] - ends[0]
        off = (points - ends[0]) @ np.array([-chord[1], chord[0]]) / (chord @ chord)
        return float(np.abs(off).max())

    assert bend(straight) < 0.5 * bend(along)
    for start, end in pairs:
        row = mesh.vertices[np.arange(start, end + 1)]
        assert geodesic(mesh, start, end).length < np.linalg.norm(np.diff(row, axis=0), axis=1).sum()
    areas = [sum(strip.flat.areas.sum() for strip in found.strips) for found in (straight, along)]
    assert areas[0] == pytest.approx(areas[1], rel=1e-3)  # quads fold along one diagonal, or count by both


def test_a_cut_keeps_area_and_vertices() -> None:
    """Crossing seams on a flat sheet: areas of pieces by the shoelace formula."""
    side = np.linspace(0.0, 4.0, 5)
    mesh = grid(side, side, lambda a, b: [a, b, 0.0])
    cut, piece = cut_along(mesh, [(0, 24), (3, 21)])  # from corner to corner, and from (0, 3) to (4, 1): they cross
    np.testing.assert_array_equal(cut.vertices[:25], mesh.vertices)
    a, b, c = (cut.vertices[cut.faces[:, i]] for i in range(3))
    areas = 0.5 * np.cross(b - a, c - a)[:, 2]
    assert (np.sign(areas) == np.sign(areas[0])).all()
    found = np.sort(np.bincount(piece, np.abs(areas)))
    # they meet at (2, 2); corners of the sheet go round the pieces
    shapes = [
        [[0, 0], [4, 0], [4, 1], [2, 2]],
        [[4, 1], [4, 4], [2, 2]],
        [[4, 4], [0, 4], [0, 3], [2, 2]],
        [[0, 0], [2, 2], [0, 3]],
    ]
    wanted = [0.5 * abs(sum(p[0] * q[1] - p[1] * q[0] for p, q in zip(s, [*s[1:], s[0]], strict=True))) for s in shapes]
    np.testing.assert_allclose(found, np.sort(wanted), atol=1e-12)


def hypar(n: int = 16, span: float = 10.0, rise: float = 2.0) -> Mesh:
    """A saddle on a square frame."""
    side = np.linspace(-0.5, 0.5, n + 1)
    return grid(side, side, lambda a, b: [span * a, span * b, 4.0 * rise * a * b])


@pytest.fixture(scope="module")
def form() -> hookean.Result:
    """The hypar as a net of equal force densities, held at its rim."""
    mesh = hypar()
    number = np.arange(17 * 17).reshape(17, 17)
    rim = np.concatenate([number[0], number[-1], number[1:-1, 0], number[1:-1, -1]])
    scene = Scene(
        meshes={"roof": hookean.MeshData(vertices=mesh.vertices, faces=mesh.faces)},
        forces=[hookean.Springs(name="cloth", mesh="roof", rest_factor=0.0, stiffness=50.0)],
        anchors=[hookean.Anchors(points=mesh.vertices[rim])],
        geometry=[hookean.Geometry(kind="mesh", mesh="roof")],
    )
    return hookean.relax(scene)


def test_a_hypars_strips_sewn_together_return_to_the_form(form: hookean.Result) -> None:
    """Strips of two rows, compensated for 1 %, with springs along all sides and diagonals of the flat cloth, its seams
    sewn and its rim on the frame: relaxed, it lies within 0.2 % of the span of the form."""
    found = hookean.cutting_patterns(form, rows=2, compensation=(0.01, 0.01))
    assert len(found.strips) == 8
    pairs, rest = [], []
    for strip in found.strips:
        local = np.concatenate([strip.faces[:, list(p)] for p in ((0, 1), (1, 2), (2, 3), (3, 0), (0, 2), (1, 3))])
        local = np.unique(np.sort(local, axis=1), axis=0)
        pairs.append(strip.vertices[local])
        rest.append(np.linalg.norm(strip.points[local[:, 0]] - strip.points[local[:, 1]], axis=1))
    x = found.mesh.vertices
    number = np.arange(17 * 17).reshape(17, 17)
    rim = np.concatenate([number[0], number[-1], number[1:-1, 0], number[1:-1, -1]])
    rest_length = np.concatenate(rest)
    cloth = hookean.Springs(particles=np.concatenate(pairs), rest_length=rest_length, stiffness=2e4 / rest_length)
    # from beside the form, so that it has to come back
    start = x + 0.05 * np.sin(np.arange(x.size).reshape(x.shape) * 1.7)
    held = [hookean.Anchors(particles=rim, targets=x[rim])]
    sewn = hookean.relax(Scene(particles=start, forces=[cloth], anchors=held, settings={"tolerance": 1e-10}))
    assert sewn.converged
    assert np.linalg.norm(sewn.particles - x, axis=1).max() < 0.002 * 10.0
    assert np.asarray(sewn.forces[0]["force"]).min() > 0.0  # it is taut


def test_the_report_of_distortions_holds_what_the_strips_have(form: hookean.Result) -> None:
    """More rows to a strip distort it more; stretches are those of lengths in the plane to lengths in space."""
    narrow, wide = (hookean.cutting_patterns(form, rows=rows) for rows in (1, 8))
    assert len(narrow.strips) == 16 and len(wide.strips) == 2
    worst = [max(row["largest distortion [-]"] for row in p.table()) for p in (narrow, wide)]
    assert worst[0] < worst[1] / 4.0
    row = wide.table()[1]
    strip = wide.strips[1]
    assert row["strip"] == "S2" and row["area [m²]"] == pytest.approx(strip.area)
    along = strip.vertices[strip.faces[0, :2]]
    space = np.linalg.norm(np.diff(wide.mesh.vertices[along], axis=0))
    plane = np.linalg.norm(np.diff(strip.points[strip.faces[0, :2]], axis=0))
    assert row["smallest stretch [-]"] - 1e-12 <= plane / space <= row["largest stretch [-]"] + 1e-12
    assert "2 strips" in wide.summary()[0]
    total = sum(strip.area for strip in narrow.strips)
    assert total == pytest.approx(sum(s.flat.areas.sum() for s in narrow.strips), rel=1e-3)


@pytest.mark.slow
def test_flattening_is_a_minimum(form: hookean.Result) -> None:
    """Of the energy sum of A ((s1 - 1)^2 + (s2 - 1)^2): any small change of a flat strip makes it larger (the energy of
    Liu et al. 2008, worked out here from singular values)."""
    strip = hookean.cutting_patterns(form, rows=8).strips[0]
    space, plane = form.particles[strip.vertices], strip.flat.points

    def energy(points: np.ndarray) -> float:
        total = 0.0
        for quad in strip.faces:
            for corners in ((0, 1, 2), (0, 2, 3), (0, 1, 3), (1, 2, 3)):
                a, b, c = (space[quad[i]] for i in corners)
                side = np.linalg.norm(b - a)
                high = np.linalg.norm(np.cross(b - a, c - a)) / side
                before = np.array([[side, (c - a) @ (b - a) / side], [0.0, high]])
                p, q, r = (points[quad[i]] for i in corners)
                sizes = np.linalg.svd(np.column_stack([q - p, r - p]) @ np.linalg.inv(before), compute_uv=False)
                total += 0.25 * side * high * ((sizes - 1.0) ** 2).sum()
        return total

    least, rng = energy(plane), np.random.default_rng(3)
    for _ in range(5):
        assert energy(plane + 1e-3 * rng.normal(size=plane.shape)) > least
    step = 1e-6 * rng.normal(size=plane.shape)
    slope = (energy(plane + step) - energy(plane - step)) / 2.0
    assert abs(slope) < 1e-6 * energy(plane + 1e-3 * step / 1e-6)


def test_compensation_makes_the_strips_smaller_along_warp_and_weft(form: hookean.Result) -> None:
    plain = hookean.cutting_patterns(form, rows=4).strips[0]
    smaller = hookean.cutting_patterns(form, rows=4, compensation=(0.02, 0.005)).strips[0]
    np.testing.assert_allclose(smaller.points * [1.02, 1.005], plain.points, atol=1e-12)
    np.testing.assert_allclose(np.ptp(plain.points, axis=0)[0], 10.0, rtol=0.1)  # warp along the strip


def test_the_strains_of_compensation_are_those_of_the_membrane() -> None:
    """Biaxial Hooke with a symmetric compliance [[1 / k1, -nu / k1], [-nu / k1, 1 / k2]]; and a square sheet of
    `membrane` pulled by the same forces per width at its corners, to the order of the strains of 4e-6."""
    np.testing.assert_allclose(strains((2e3, 1e3), (600e3, 500e3), 0.3), (1.7 / 600, 1 / 500 - 0.6 / 600))
    square = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
    n = np.array([3e-3, 2e-3])
    sheet = {
        "particles": square,
        "meshes": {"m": {"vertices": square, "faces": [[0, 1, 2], [0, 2, 3]]}},
        "forces": [
            {"kind": "membrane", "mesh": "m", "warp_stiffness": 800, "weft_stiffness": 600, "poisson": 0.3,
             "warp": [1, 0, 0]},
            {"kind": "unary", "particles": [0, 1, 2, 3],
             "vector": [[*(np.sign(np.array(at[:2]) - 0.5) * n / 2), 0] for at in square]},
        ],
        "anchors": [{"particles": [0]}, {"particles": [1], "axes": "yz"}, {"particles": [2, 3], "axes": "z"}],
        "settings": {"tolerance": 1e-12},
    }  # fmt: skip
    pulled = hookean.relax(hookean.Scene.read(sheet)).particles
    np.testing.assert_allclose([pulled[1, 0] - 1, pulled[3, 1] - 1], strains(tuple(n), (800, 600), 0.3), rtol=1e-4)


@pytest.mark.parametrize(("long", "wide", "skew"), [(4.0, 4.0, 0.0), (1.0, 3.0, 0.0), (4.0, 4.0, 0.7), (4.0, 1.5, 0.5)])
@pytest.mark.parametrize("along", ["warp", "weft"])
def test_the_warp_lies_along_the_rows(long: float, wide: float, skew: float, along: Any) -> None:
    """Of a flat piece of all rows, a parallelogram: edges of the rows along x are shorter by the compensation alone,
    whether the piece is square, wider than long, or skewed."""
    x, y = np.meshgrid(np.linspace(0, long, 5), np.linspace(0, wide, 5), indexing="ij")
    mesh = quads(np.stack([x + skew * y, y, np.zeros_like(x)], axis=-1))
    (strip,) = hookean.cutting_patterns(mesh, along=along, rows=99, compensation=(0.1, 0.0)).strips
    place = {int(vertex): i for i, vertex in enumerate(strip.vertices)}
    rows = [strip.points[place[b]] - strip.points[place[a]] for a, b in row_edges(mesh, along).tolist()]
    np.testing.assert_allclose(np.abs(np.array(rows))[:, 1], 0.0, atol=1e-9)
    drawn = [np.linalg.norm(mesh.vertices[b] - mesh.vertices[a]) for a, b in row_edges(mesh, along).tolist()]
    np.testing.assert_allclose(np.linalg.norm(rows, axis=1), np.array(drawn) / 1.1, rtol=1e-9)


def test_another_direction_is_refused() -> None:
    with pytest.raises(InputError, match="along: 'diag' given; warp or weft is expected"):
        hookean.cutting_patterns(hypar(), along="diag")  # type: ignore[arg-type]


def test_seams_have_allowances_and_marks_that_meet(form: hookean.Result) -> None:
    found = hookean.cutting_patterns(form, rows=4, allowance=0.05, edge_allowance=0.2, mark_every=2)
    first, second = found.strips[0], found.strips[1]
    for strip in found.strips:
        sides = strip.points[strip.seam]
        # every point of the cut lies at least as far out as its nearest seam asks, and no further than a corner
        for i, other in enumerate(strip.beside.tolist()):
            a, b = sides[i], sides[(i + 1) % len(sides)]
            way = (b - a) / np.linalg.norm(b - a)
            out = np.array([way[1], -way[0]])
            away = (strip.cut - a) @ out
            beside = (strip.cut - a) @ way
            near = (beside > -1e-9) & (beside < np.linalg.norm(b - a) + 1e-9) & (away > 0)
            if near.any():
                assert away[near].min() <= (0.05 if other >= 0 else 0.2) + 1e-9
    names = {mark.name for mark in first.marks}
    assert names and names == {mark.name for mark in second.marks if mark.name.startswith("1-2/")}
    for mark in first.marks:
        vertex = int(mark.name.split("/")[1])
        assert vertex % 2 == 0
        np.testing.assert_array_equal(mark.point, first.points[np.flatnonzero(first.vertices == vertex)[0]])
        other = next(m for m in second.marks if m.name == mark.name)
        np.testing.assert_array_equal(other.point, second.points[np.flatnonzero(second.vertices == vertex)[0]])


def test_an_outline_moves_outwards() -> None:
    """A square by 1 and 2: closed forms of its corners."""
    square = [[0, 0], [4, 0], [4, 4], [0, 4]]
    np.testing.assert_allclose(offset(square, 1.0), [[-1, -1], [5, -1], [5, 5], [-1, 5]], atol=1e-12)
    np.testing.assert_allclose(offset(square, [2, 1, 1, 1]), [[-1, -2], [5, -2], [5, 5], [-1, 5]], atol=1e-12)
    step = offset([[0, 0], [2, 0], [4, 0], [4, 4], [0, 4]], [1, 2, 1, 1, 1])
    np.testing.assert_allclose(step[1:3], [[2, -1], [2, -2]], atol=1e-12)


def test_rows_run_along_warp_or_weft() -> None:
    mesh = hypar(4)
    warp, weft = face_rows(mesh, "warp"), face_rows(mesh, "weft")
    assert sorted(np.bincount(warp).tolist()) == sorted(np.bincount(weft).tolist()) == [4, 4, 4, 4]
    for rows in (warp, weft):  # rows that follow each other lie side by side
        by_row = [set(np.unique(mesh.faces[rows == i]).tolist()) for i in range(4)]
        assert all(by_row[i] & by_row[i + 1] for i in range(3)) and not by_row[0] & by_row[2]
    assert (warp.reshape(4, 4) == warp.reshape(4, 4)[:, :1]).all() != (
        weft.reshape(4, 4) == weft.reshape(4, 4)[:, :1]
    ).all()
    assert strips(mesh, "warp", 3).max() == 1


def test_what_cannot_be_flattened_is_one_sentence() -> None:
    ball = sphere(8, 6)
    for call, said in [
        (lambda: flatten(ball), "several boundaries"),
        (lambda: outline(np.array([[0, 1, 2, 2], [1, 0, 3, 3], [2, 1, 3, 3], [0, 2, 3, 3]])), "closed; cut it open"),
        (lambda: flatten(Mesh(np.zeros((0, 3)), np.zeros((0, 4), int))), "has no faces"),
        (lambda: flatten(Mesh(np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0.0]]), np.array([[0, 1, 2, 2]]))), "has no area"),
        (
            lambda: hookean.cutting_patterns(ball, labels=np.zeros(len(ball.faces), int)),
            "strip 1: .*several boundaries",
        ),
        (lambda: hookean.cutting_patterns(hypar(), labels=[0]), "1 labels for 256 faces"),
        (lambda: hookean.cutting_patterns(hypar(), rows=0), "a whole number from 1"),
        (lambda: hookean.cutting_patterns(hypar(), seams=[(0, 999)]), "vertex 999 is on no face"),
        (lambda: hookean.cutting_patterns(hypar(), seams=[(4, 4)]), "to itself has no length"),
        (lambda: hookean.cutting_patterns(hypar(), seams=[(0, 9)], labels=[0]), "labels are given, too"),
        (lambda: hookean.cutting_patterns(hypar(), compensation=(2.0, 0.0)), "two strains"),
        (lambda: hookean.cutting_patterns(hypar(), allowance=-1.0), "at least 0"),
        (lambda: hookean.cutting_patterns(hypar(), mark_every=-1), "a whole number from 0"),
    ]:
        with pytest.raises(InputError, match=said):
            call()


def test_faces_that_run_both_ways_round_are_flattened_alike() -> None:
    mesh = hypar(6)
    turned = mesh.faces.copy()
    turned[1::2] = turned[1::2, ::-1]
    np.testing.assert_allclose(
        apart(flatten(Mesh(mesh.vertices, turned)).points), apart(flatten(mesh).points), atol=1e-8
    )


def test_cables_have_their_unstressed_and_cut_lengths() -> None:
    """Two crossing cables of EA over four spans: each is one, of length l EA / (EA + T), cut to L0 / (1 + s) - 2 f
    (Schek 1974)."""
    x = [[0, 0, 0], [-2, 0, 0], [2, 0, 0], [0, -3, 0], [0, 3, 0]]
    net = {"kind": "constant_tension", "name": "net", "particles": [[1, 0], [0, 3], [4, 0], [0, 2]], "tension": 40.0}
    scene = Scene.read(
        {
            "particles": x,
            "forces": [net],
            "anchors": [{"particles": [1, 2, 3, 4]}],
            "stages": {"freeze": {"net": {"axial_stiffness": 1e4}}},
        }
    )
    found = hookean.cables(scene, stretch=0.002, fitting=0.05)
    rows = found.table()
    assert [row["cable"] for row in rows] == ["net 1", "net 2"]
    wanted = np.array([4.0, 6.0]) * 1e4 / 1.004e4
    np.testing.assert_allclose([row["unstressed length [m]"] for row in rows], np.array([4.0, 6.0]) / 1.004, rtol=1e-12)
    np.testing.assert_allclose([row["cut length [m]"] for row in rows], wanted / 1.002 - 0.1, rtol=1e-12)
    np.testing.assert_allclose([row["largest force [N]"] for row in rows], 40.0, rtol=1e-12)
    np.testing.assert_allclose(found.cables[0].clamps, [0.0, 2.0 / 1.004, 4.0 / 1.004], rtol=1e-12)
    assert found.cables[0].particles.tolist() == [1, 0, 2]
    with pytest.raises(InputError, match="shorter than its fittings"):
        hookean.cables(scene, fitting=3.0)
    with pytest.raises(InputError, match="at least 0"):
        hookean.cables(scene, stretch=-0.1)


def test_chains_go_straight_on_and_close() -> None:
    ring = np.array([[0, 1], [1, 2], [2, 3], [3, 0]])
    x = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.0]])
    [(rows, particles)] = chains(x, ring)
    assert rows.tolist() == [0, 1, 2, 3] and particles.tolist() == [0, 1, 2, 3, 0]
    fork = np.array([[0, 1], [1, 2], [1, 3]])
    x = np.array([[0, 0, 0], [1, 0, 0], [2, 0.1, 0], [1, 1, 0.0]])
    assert sorted(len(rows) for rows, _ in chains(x, fork)) == [1, 2]
