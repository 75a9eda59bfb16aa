"""Components of Weaverbird and MeshEdit, on meshes whose parts can be counted and measured."""

from __future__ import annotations

import math
from typing import Any
from uuid import UUID

import numpy as np
import pytest

from canvas.native_values import called as run
from canvas.native_values import made, near
from hookean.discretize import measures
from hookean_canvas.run.natives import PLUGINS, Unfit, native_of, shapes

Mesh = tuple[str, list[tuple[float, ...]], list[tuple[int, ...]]]
QUAD: Mesh = ("mesh", [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0)], [(0, 1, 2, 3)])
ROOF: Mesh = (
    "mesh",
    [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (2, 0, 1), (2, 1, 1)],
    [(0, 1, 2, 3), (1, 4, 5, 2)],
)
GRID: Mesh = (
    "mesh",
    [(float(i), float(j), 0.0) for j in range(4) for i in range(4)],
    [(4 * j + i, 4 * j + i + 1, 4 * j + i + 5, 4 * j + i + 4) for j in range(3) for i in range(3)],
)


def parts(name: str, *given: Any) -> tuple[np.ndarray[Any, Any], list[tuple[int, ...]]]:
    vertices, faces = run(f"Weaverbird's {name}", *given)[0]
    return np.array(vertices), faces


def test_splitting_triangles_makes_four_of_each_and_keeps_the_area() -> None:
    for level in (0, 1, 2):
        vertices, faces = parts("Split Triangles Subdivision", ROOF, level)
        assert len(faces) == (2 if level == 0 else 4 * 4**level)
        assert measures.area((vertices, faces)) == pytest.approx(1.0 + math.sqrt(2.0))


@pytest.mark.parametrize(("naked", "corner"), [(0, 0.0), (1, 0.25), (2, 0.0)])
def test_constant_quads_are_as_many_as_corners_and_only_naked_vertices_move(naked: int, corner: float) -> None:
    """At a corner of two naked edges of length 1 the spline is (6 P + a + b) / 8, 1/8 of each edge further in."""
    vertices, faces = parts("Constant Quads Split Subdivision", GRID, 1, naked)
    assert len(faces) == 4 * 9 and all(len(face) == 4 for face in faces)
    assert near(vertices[0], (0.5 * corner, 0.5 * corner, 0.0))
    assert near(vertices[5], (1.0, 1.0, 0.0)) and near(vertices[6], (2.0, 1.0, 0.0))


def test_edges_faces_boundary_and_vertices_are_those_of_the_mesh() -> None:
    assert len(run("Weaverbird's Mesh Edges", ROOF)[0]) == 7
    rim = run("Weaverbird's Naked Boundary", ROOF)[0]
    assert len(rim) == 1 and len(rim[0]) == 7 and rim[0][0] == rim[0][-1]
    assert [len(ring) for ring in run("Weaverbird's Face Polylines", ROOF)[0]] == [5, 5]
    twice: Mesh = ("mesh", [*ROOF[1], (0.0, 0.0, 0.0), (5.0, 0.0, 0.0), (5.0, 5.0, 0.0)], [*ROOF[2], (6, 7, 8)])
    assert len(run("Weaverbird's Vertices", twice, True)[0]) == 8
    assert len(run("Weaverbird's Vertices Component", twice, False)[0]) == 9


@pytest.mark.parametrize(("inset", "distance", "inner"), [(0, 25.0, 1.0), (1, 0.25, 2.25)])
def test_a_frame_leaves_a_hole_as_wide_as_its_percents_or_lengths_leave_it(
    inset: int, distance: float, inner: float
) -> None:
    """A square of side 2: the hole has the side 2 (1 - 2 x 25 %) = 1, or 2 - 2 x 0.25 = 1.5."""
    vertices, faces = parts("Picture Frame", QUAD, [distance], inset)
    assert len(faces) == 4 and measures.area((vertices, faces)) == pytest.approx(4.0 - inner)
    normals = [np.cross(vertices[f[1]] - vertices[f[0]], vertices[f[2]] - vertices[f[0]])[2] for f in faces]
    assert min(normals) > 0.0


def test_pyramids_are_as_high_as_their_distances_and_the_last_one_is_used_again() -> None:
    vertices, faces = parts("Stellate/Cumulation", GRID, [1.0, 3.0])
    assert len(faces) == 36
    assert near(vertices[16:, 2], [1.0] + [3.0] * 8)


def test_thickening_a_flat_mesh_makes_a_closed_box_and_a_closed_one_two_shells() -> None:
    vertices, faces = parts("Mesh Thicken", GRID, [0.5], 0)
    assert measures.volume((vertices, faces)) == pytest.approx(9.0 * 0.5)
    sides = [tuple(side) for face in faces for side in zip(face, (*face[1:], face[0]), strict=True)]
    assert sorted(sides) == sorted((b, a) for a, b in sides)
    top, _ = parts("Offset Mesh", GRID, [0.5], 0)
    assert near(top, np.array(GRID[1]) + [0.0, 0.0, 0.5])


@pytest.mark.parametrize("naked", [0, 1, 2])
def test_smoothing_keeps_a_plane_of_even_quads_but_for_what_may_move_on_its_rim(naked: int) -> None:
    bumped: Mesh = ("mesh", [(*p[:2], 1.0 if k == 5 else 0.0) for k, p in enumerate(GRID[1])], GRID[2])
    vertices, _ = parts("Laplacian Smoothing", bumped, 1, naked, 0.0)
    assert near(vertices[5], (1.0, 1.0, 0.0)) and near(vertices[6], (2.0, 1.0, 0.25))
    assert near(vertices[0], (0.5, 0.5, 0.0) if naked == 1 else (0.0, 0.0, 0.0))
    assert near(vertices[1], (1.0, 0.0, 0.0))


def test_distances_that_are_missing_are_told() -> None:
    with pytest.raises(Unfit, match="Distance is missing"):
        PLUGINS["Weaverbird's Stellate/Cumulation"].run(made(QUAD), [])


def test_mesh_edit_measures_turns_and_cuts_meshes() -> None:
    points, starts, ends = run("Mesh NakedEdge", ROOF)
    assert len(points) == 6 and len(starts) == len(ends) == 6 and (1, 2) not in zip(starts, ends, strict=True)
    area, centre = run("Mesh Area", QUAD)
    assert area == pytest.approx(4.0) and near(centre, (1, 1, 0))
    assert run("Mesh Flip", QUAD)[0][1] == [(3, 2, 1, 0)]
    kite: Mesh = ("mesh", [(0, 0, 0), (2, -1, 0), (4, 0, 0), (2, 1, 0)], [(0, 1, 2, 3)])
    assert all({1, 3} <= set(face) for face in run("Mesh Triangulate", kite, True)[0][1])
    assert all({0, 2} <= set(face) for face in run("Mesh Triangulate", kite, False)[0][1])
    vertices, faces = run("Weaverbird's Mesh Thicken", QUAD, [0.5], 0)[0]
    volume, middle = run("Mesh Volume", ("mesh", vertices, faces))
    assert volume == pytest.approx(2.0) and near(middle, (1, 1, 0.25))


def test_faces_are_turned_to_the_first_one() -> None:
    turned: Mesh = ("mesh", ROOF[1], [ROOF[2][0], ROOF[2][1][::-1]])
    assert shapes.mesh_parts(PLUGINS["Weaverbird's Unify Face Windings"].run(made(turned))[0])[1] == list(ROOF[2])


@pytest.mark.parametrize("name", ["Weaverbird's Naked boundary", "Mesh Naked Edge", "Mesh Unify Normals", "mesh flip"])
def test_names_of_plug_ins_are_known_whatever_their_spaces_and_capitals(name: str) -> None:
    assert native_of(UUID(int=7), name, plugin=True) is not None
    assert native_of(UUID(int=7), f"{name}s", plugin=True) is None
