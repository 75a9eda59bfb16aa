"""Natives that draw by chance, and surfaces within curves: what holds of every draw, and known shapes."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy.spatial.distance import pdist

from canvas.native_values import called as run
from canvas.native_values import made, near
from hookean_canvas.run.natives import BY_NAME, PLUGINS, Unfit, as_kind, shapes

SQUARE = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 0)]
FOLDED = ("mesh", [(0, 0, 0), (4, 0, 0), (0, 1, 0), (0, 0, 1)], [(0, 1, 2), (0, 3, 1)])
"""Two triangles of area 2 each, in the planes z = 0 and y = 0."""


def test_random_numbers_fill_their_domain_and_depend_on_the_seed_alone() -> None:
    """The mean of n numbers is off by (b - a) / sqrt(12 n) on average; five times that is never met by chance."""
    found = run("Random", ("domain", 2, 5), 1000, 1)[0]
    assert all(2.0 <= value <= 5.0 for value in found)
    assert abs(np.mean(found) - 3.5) < 5.0 * 3.0 / math.sqrt(12.0 * 1000.0)
    assert found == run("Random", ("domain", 2, 5), 1000, 1)[0] != run("Random", ("domain", 2, 5), 1000, 2)[0]
    assert run("Random", ("domain", 0, 1), 0, -1) == [[]]


def test_a_reduced_list_keeps_the_order_of_what_is_left() -> None:
    left = run("Random Reduce", list(range(20)), 5, 3)[0]
    assert len(left) == 15 and left == sorted(set(left))
    assert run("Random Reduce", [1, 2], 5, 0)[0] == []


@pytest.mark.parametrize(
    ("name", "region", "inside"),
    [
        ("Populate 2D", SQUARE, lambda p: (p[:, :2] >= 0).all() and (p[:, :2] <= 2).all() and not p[:, 2].any()),
        ("Populate 3D", ("box", (1, 1, 1), (2, 3, 4)), lambda p: (p >= 1).all() and (p <= (2, 3, 4)).all()),
        ("Populate Geometry", SQUARE[:2], lambda p: (p[:, 0] >= 0).all() and not p[:, 1:].any()),
        ("Populate Geometry", FOLDED, lambda p: near(p[:, 1] * p[:, 2], np.zeros(len(p)))
         and (p[:, 0] / 4 + p[:, 1] + p[:, 2] <= 1 + 1e-12).all()),
    ],
)  # fmt: skip
def test_points_are_spread_within_their_region(name: str, region: Any, inside: Any) -> None:
    """All are inside, and farther apart than points that are only thrown in: the nearest two of n of these are some
    sqrt(2 A / pi) / n apart in the plane, and of points spread evenly some sqrt(A / n)."""
    value = region if region[0] != "box" else _box(*region[1:])
    found = np.array(run(name, value, 60, 7, None)[0])
    assert found.shape == (60, 3) and inside(found)
    assert pdist(found).min() > 0.3 * np.median(_nearest(found))
    assert np.array_equal(found, run(name, value, 60, 7, None)[0])


def _box(low: Any, high: Any) -> Any:
    return BY_NAME["Box 2Pt"].run(made(("point", *low)), made(("point", *high)), None)[0]


def _nearest(places: Any) -> Any:
    apart = np.linalg.norm(places[:, None] - places[None], axis=2) + 1e9 * np.eye(len(places))
    return apart.min(axis=1)


def test_points_on_triangles_follow_their_areas() -> None:
    """Half of the area is in each plane; evenly spread points differ from half by a few."""
    found = np.array(run("Populate Geometry", FOLDED, 200, 1, None)[0])
    assert 80 <= np.count_nonzero(found[:, 2] == 0.0) <= 120


def test_points_keep_away_from_those_that_are_given() -> None:
    given = [("point", 1.0, 1.0, 0.0)]
    found = np.array(run("Populate 2D", SQUARE, 5, 0, given)[0])
    assert len(found) == 5 and (np.linalg.norm(found - (1.0, 1.0, 0.0), axis=1) > 0.3).all()


def test_too_many_points_and_numbers_are_refused() -> None:
    for name, given in (("Random", (("domain", 0, 1), 10**9, 1)), ("Populate 2D", (SQUARE, -1, 1, None))):
        with pytest.raises(Unfit, match="the number must be from 0 to 20000"):
            run(name, *given)


def test_a_closed_planar_curve_bounds_a_surface() -> None:
    """A convex quadrilateral is a surface that divides; an L of area 3 is a trimmed face with its six vertices."""
    (surface,) = BY_NAME["Boundary Surfaces"].run([made(SQUARE)])[0]
    mesh = BY_NAME["Mesh Surface"].run(as_kind("surface", surface), 2, 2, False, False)[0]
    assert near(run("Area", mesh)[0], 4.0)
    bent = [(0, 0, 1), (2, 0, 1), (2, 1, 1), (1, 1, 1), (1, 2, 1), (0, 2, 1), (0, 0, 1)]
    (face,) = BY_NAME["Boundary Surfaces"].run([made(bent)])[0]
    faces, edges, vertices = BY_NAME["Deconstruct Brep"].run(face)
    assert (len(faces), len(edges), len(vertices)) == (1, 6, 6)
    assert near(sum(run("Length", edge)[0] for edge in edges), 8.0)


@pytest.mark.parametrize("edge", [SQUARE[:3], [(0, 0, 0), (1, 0, 0), (1, 1, 1), (0, 1, 0), (0, 0, 0)]])
def test_what_bounds_no_plane_is_refused(edge: Any) -> None:
    with pytest.raises(Unfit, match="not closed or not planar"):
        BY_NAME["Boundary Surfaces"].run([made(edge)])


def test_meshes_are_joined_and_welded() -> None:
    """Two unit squares side by side: 8 vertices, 6 when welded."""
    squares = [made(("mesh", [(x, 0, 0), (x + 1, 0, 0), (x + 1, 1, 0), (x, 1, 0)], [(0, 1, 2, 3)])) for x in (0, 1)]
    join = PLUGINS["Weaverbird's Join Meshes and Weld"].run
    assert [len(shapes.mesh_parts(join(squares, weld)[0])[0]) for weld in (False, True)] == [8, 6]
