"""Area and volume of meshes, and meshes over rows of points."""

from __future__ import annotations

import numpy as np
import pytest

from hookean.discretize import area, grid, quads, volume

CUBE = np.array([[x, y, z] for z in (0.0, 1.0) for y in (0.0, 1.0) for x in (0.0, 1.0)])
SIDES = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]


def test_a_box_has_its_area_and_its_volume() -> None:
    """Sides 2, 3 and 5: 62 and 30, wherever it stands; turned inside out the volume is below 0."""
    box = (CUBE * [2.0, 3.0, 5.0] + [7.0, -4.0, 1.0], SIDES)
    assert area(box) == pytest.approx(62.0, rel=1e-14)
    assert volume(box) == pytest.approx(30.0, rel=1e-13)
    assert volume((box[0], [side[::-1] for side in SIDES])) == pytest.approx(-30.0, rel=1e-13)


def test_triangles_count_once() -> None:
    """A regular tetrahedron of edge sqrt(8): area 8 sqrt(3), volume 8 / 3."""
    corners = np.array([[1.0, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]])
    mesh = (corners, [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]])
    assert area(mesh) == pytest.approx(8.0 * 3.0**0.5, rel=1e-14)
    assert abs(volume(mesh)) == pytest.approx(8.0 / 3.0, rel=1e-14)


def test_a_quad_is_the_mean_of_its_two_cuts() -> None:
    """The unit square with one corner lifted by 1: cuts of sqrt(2) / 2 + 1 / 2 and of (sqrt(2) + sqrt(2)) / 2."""
    z = np.array([[0.0, 0.0], [0.0, 1.0]])
    cuts = [0.5 * (2.0**0.5 + 2.0**0.5), 0.5 * (1.0 + 3.0**0.5)]
    assert area(grid([0.0, 1.0], [0.0, 1.0], z)) == pytest.approx(0.5 * sum(cuts), rel=1e-14)


def test_a_grid_is_numbered_along_y_first() -> None:
    mesh = grid([0.0, 1.0, 3.0], [0.0, 2.0])
    assert mesh.vertices.tolist() == [[0, 0, 0], [0, 2, 0], [1, 0, 0], [1, 2, 0], [3, 0, 0], [3, 2, 0]]
    assert mesh.faces.tolist() == [[0, 2, 3, 1], [2, 4, 5, 3]]
    assert area(mesh) == 6.0 and area(quads(mesh.vertices.reshape(3, 2, 3))) == 6.0
