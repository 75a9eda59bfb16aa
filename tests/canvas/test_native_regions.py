"""Flat regions, cells in space, sections and projections, on shapes whose areas, volumes and places are known."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from canvas.native_values import called as run
from canvas.native_values import made, near
from hookean.discretize import measures
from hookean_canvas.run.natives import BY_NAME, NATIVES, PLUGINS, Unfit, as_kind, shapes
from hookean_canvas.run.rhino import rhino3dm

XY = ("plane", (0, 0, 0), (1, 0, 0), (0, 1, 0))


def ring(*corners: tuple[float, float]) -> list[tuple[float, float, float]]:
    return [(x, y, 0.0) for x, y in (*corners, corners[0])]


def box(x: float, y: float, wide: float, high: float) -> list[tuple[float, float, float]]:
    return ring((x, y), (x + wide, y), (x + wide, y + high), (x, y + high))


def area(outline: list[tuple[float, float, float]]) -> float:
    """The signed area in plan: positive for an outline, negative for a hole."""
    rows = np.array(outline)[:, :2]
    return 0.5 * float(np.sum(rows[:-1, 0] * rows[1:, 1] - rows[1:, 0] * rows[:-1, 1]))


def areas(name: str, *given: Any) -> list[float]:
    return sorted(area(outline) for outline in run(name, *given, XY)[0])


@pytest.mark.parametrize(
    ("name", "given", "expected"),
    [
        ("Region Union", ([box(0, 0, 2, 2), box(1, 1, 2, 2)],), [7.0]),
        ("Region Union", ([box(0, 0, 2, 2), box(2, 0, 2, 2)],), [8.0]),
        ("Region Union", ([box(0, 0, 1, 1), box(2, 0, 1, 1)],), [1.0, 1.0]),
        ("Region Union", ([box(0, 0, 1, 1), box(1, 1, 1, 1)],), [1.0, 1.0]),
        ("Region Union", ([box(0, 0, 2, 2), box(0, 0, 2, 2)],), [4.0]),
        ("Region Union", ([box(0, 0, 2, 2), box(5, 5, 0, 0)],), [4.0]),
        ("Region Union", ([box(5, 5, 0, 0)],), []),
        ("Region Difference", ([box(0, 0, 3, 3)], [box(1, 1, 1, 1)]), [-1.0, 9.0]),
        ("Region Difference", ([box(0, 0, 3, 3)], [box(1, -1, 1, 5)]), [3.0, 3.0]),
        ("Region Difference", ([box(0, 0, 2, 2)], [box(0, 0, 2, 2)]), []),
        ("Region Intersection", ([box(0, 0, 2, 2)], [box(1, 1, 2, 2)]), [1.0]),
        ("Region Intersection", ([box(0, 0, 2, 2)], [box(2, 0, 2, 2)]), []),
        ("Region Intersection", ([box(0, 0, 1, 1), box(3, 0, 1, 1)], [box(0.5, 0.5, 3, 3)]), [0.25, 0.25]),
    ],
)  # fmt: skip
def test_regions_of_boxes_have_the_areas_of_their_parts(
    name: str, given: tuple[Any, ...], expected: list[float]
) -> None:
    assert areas(name, *given) == pytest.approx(expected)


@pytest.mark.parametrize("seed", range(8))
def test_union_and_intersection_have_together_the_areas_of_both(seed: int) -> None:
    """|A or B| + |A and B| = |A| + |B|, and |A without B| = |A| - |A and B|, of stars that cross each other."""
    random = np.random.default_rng(seed)
    stars = []
    for _ in range(2):
        angles, far = np.sort(random.random(9)) * 2.0 * math.pi, 0.3 + random.random(9)
        middle = 0.4 * random.random(2)
        rows = middle + far[:, None] * np.column_stack([np.cos(angles), np.sin(angles)])
        stars.append(ring(*map(tuple, rows.tolist())))
    a, b = map(area, stars)
    both = sum(areas("Region Intersection", [stars[0]], [stars[1]]))
    assert sum(areas("Region Union", stars)) == pytest.approx(a + b - both, rel=1e-6)
    assert sum(areas("Region Difference", [stars[0]], [stars[1]])) == pytest.approx(a - both, rel=1e-6)


def test_open_curves_are_no_regions_and_outlines_need_no_plane() -> None:
    with pytest.raises(Unfit, match="a curve is open"):
        PLUGINS["Region Union"].run([made([(0, 0, 0), (1, 0, 0), (1, 1, 0)])], None)
    upright = [(0.0, x, z) for x, z, _ in box(0, 0, 2, 1)]
    (outline,) = run("Region Union", [upright], None)[0]
    assert near(sorted(map(tuple, outline[:4])), sorted(upright[:4]))


def test_cells_in_space_fill_the_box_and_are_nearest_to_their_points() -> None:
    random = np.random.default_rng(5)
    places = random.random((30, 3))
    size = rhino3dm.BoundingBox(shapes.point((-0.5, 0, 0)), shapes.point((1, 1, 2)))
    cells, touches = BY_NAME["Voronoi 3D"].run(shapes.points(places), size)
    volumes = [measures.volume(shapes.mesh_parts(cell)) for cell in cells]
    assert min(volumes) > 0.0 and sum(volumes) == pytest.approx(1.5 * 1.0 * 2.0)
    for i, cell in enumerate(cells):
        corners = shapes.mesh_parts(cell)[0]
        apart = np.linalg.norm(corners[:, None] - places, axis=2)
        assert np.all(apart[:, i] <= apart.min(axis=1) + 1e-9)
        assert touches[i] == bool(np.any(np.isclose(corners, [-0.5, 0, 0]) | np.isclose(corners, [1, 1, 2])))


def test_a_point_outside_the_box_has_no_cell_and_a_flat_box_is_refused() -> None:
    size = rhino3dm.BoundingBox(shapes.point((0, 0, 0)), shapes.point((1, 1, 1)))
    cells, touches = BY_NAME["Voronoi 3D"].run(shapes.points([(0.5, 0.5, 0.5), (3, 0, 0)]), size)
    assert cells[1] is None and touches[1] is False
    with pytest.raises(Unfit, match="no volume"):
        BY_NAME["Voronoi 3D"].run(shapes.points([(0, 0, 0)]), None)


def native(guid: str) -> Any:
    from uuid import UUID

    return NATIVES[UUID(guid)].run


def test_planes_at_offsets_or_distances_cut_curves_and_meshes() -> None:
    """A line from z = 0 to 4, and a pyramid of height 2 on a square of side 2: at height h the side is 2 - h."""
    line, plane = made([(0, 0, 0), (0, 0, 4)]), made(XY)
    cut = native("3e7e4827-6edd-4e10-93ac-cc234414d2b9")
    points, _ = cut(line, plane, [3.0, 1.0, 9.0], [5.0])
    assert [[round(p.Z, 9) for p in row] for row in points] == [[3.0], [1.0], []]
    points, parameters = cut(line, plane, None, [0.5, 1.0])
    assert [row[0].Z for row in points] == pytest.approx([0.5, 1.5])
    assert [line.PointAt(row[0]).Z for row in parameters] == pytest.approx([0.5, 1.5])
    with pytest.raises(Unfit, match="Offsets and Distances are missing"):
        cut(line, plane, None, None)
    every, _ = native("88cff285-7f5e-41b3-96d5-9588ff9a52b1")(
        line, made(("point", 0, 0, 0.5)), made(("vector", 0, 0, 1)), 1.0
    )
    assert [row[0].Z for row in every] == pytest.approx([0.5, 1.5, 2.5, 3.5])
    pyramid = made(("mesh", [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0), (0, 0, 2)],
                    [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)]))  # fmt: skip
    rings = native("246cda78-5e88-4087-ba09-ae082bbc4af8")(pyramid, plane, [0.5, 1.0], None)[0]
    lengths = [sum(_length(curve) for curve in row) for row in rings]
    assert lengths == pytest.approx([4 * 1.5, 4 * 1.0])


def _length(curve: Any) -> float:
    rows = shapes.corners(curve)
    assert rows is not None
    return float(np.linalg.norm(np.diff(rows, axis=0), axis=1).sum())


def test_a_curve_is_projected_to_the_faces_it_meets() -> None:
    mesh = made(("mesh", [(0, 0, 1), (2, 0, 1), (2, 2, 3), (0, 2, 3)], [(0, 1, 2, 3)]))
    project = native("d7ee52ff-89b8-4d1a-8662-3e0dd391d0af")
    (found,) = project(made([(1, -1, 0), (1, 3, 0)]), mesh, made(("vector", 0, 0, 1)))[0]
    rows = shapes.corners(found)
    assert rows is not None and near(rows[:, 2], 1.0 + rows[:, 1])
    assert rows[0, 1] == pytest.approx(0.0, abs=1e-6) and rows[-1, 1] == pytest.approx(2.0, abs=1e-6)
    assert project(made([(5, 0, 0), (6, 0, 0)]), mesh, made(("vector", 0, 0, 1))) == ([],)


def test_a_span_has_its_tangents_and_a_polygon_stands_on_its_edge() -> None:
    curve, length, _ = BY_NAME["Bezier Span"].run(*(made(one) for one in (
        ("point", 0, 0, 0), ("vector", 3, 0, 0), ("point", 3, 0, 0), ("vector", 3, 0, 0))))  # fmt: skip
    assert near(shapes.xyz(curve.PointAt(0.5)), (1.5, 0, 0)) and length == pytest.approx(3.0)
    assert near(shapes.unit(shapes.xyz(curve.TangentAt(0.0))), (1, 0, 0))
    polygon, centre, outer, inner = run("Polygon Edge", ("point", 0, 0, 0), ("point", 1, 0, 0), ("point", 0, 5, 0), 6)
    assert near(polygon[:2], [(0, 0, 0), (1, 0, 0)]) and near(centre, (0.5, math.sqrt(0.75), 0))
    assert (outer, inner) == pytest.approx((1.0, math.sqrt(0.75)))
    assert len(polygon) == 7 and area(polygon) == pytest.approx(6 * math.sqrt(3) / 4)
    assert as_kind("curve", made(polygon)).IsClosed
