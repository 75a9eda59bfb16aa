"""Lines that go straight ahead on meshes: turns in the plane, great circles, and lines that come back to them."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hookean import Scene, relax
from hookean.discretize import grid
from hookean.errors import InputError
from hookean.forces import PullToSurface
from hookean.system.system import compile

from .test_pull_to_surface import sphere


def scene(x: np.ndarray, faces: Any, path: Any, *more: Any, **others: Any) -> Scene:
    forces = [{"kind": "geodesic_strip", "mesh": "m", "path": path, "strength": 3.0}, *more]
    settings = {"tolerance": 1e-10, "max_iterations": 50000}
    meshes = {"m": {"vertices": x, "faces": faces}}
    return Scene(particles=x, meshes=meshes, forces=forces, settings=settings, **others)


def band(heights: Any, count: int = 9) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A strip of quads on the unit sphere, its parallels at some heights: vertices, quads, rows of vertices."""
    mesh = grid(0.3 * np.arange(count), np.asarray(heights, float))
    turn, z = mesh.vertices[:, 0], mesh.vertices[:, 1]
    flat = np.sqrt(1.0 - z * z)
    rows = [np.flatnonzero(z == height) for height in heights]
    rows = np.array([row[np.argsort(turn[row])] for row in rows])
    return np.column_stack([flat * np.cos(turn), flat * np.sin(turn), z]), mesh.faces, rows


@pytest.mark.parametrize("turn", [0.0, 0.4, -1.1])
def test_in_a_plane_the_angles_differ_by_twice_the_turn(turn: float) -> None:
    """A line that turns by a has pi - a on one side and pi + a on the other: E = m (2 a)^2 / 2."""
    way = np.array([[-1.0, 0.0], [np.cos(turn), np.sin(turn)]])
    rim = [way[0], [0.1, -1.0], way[1], [-0.2, 1.0]]
    x = np.column_stack([np.vstack([[0.0, 0.0], rim]), np.zeros(5)])
    faces = [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]]
    system = compile(scene(x, faces, [1, 0, 3]))
    assert system.evaluate(system.start())[2].sum() == pytest.approx(0.5 * 3.0 * (2.0 * turn) ** 2, abs=1e-14)
    found = system.scene.forces[0].measure(system.groups[0].block, x, np.zeros((4, 3, 3)))
    assert np.abs(found["angle"]) == pytest.approx(np.full(4, 2.0 * abs(turn)), abs=1e-14)


def test_the_equator_is_straight_and_other_parallels_are_not() -> None:
    """Of a strip of the same width on both sides. On the sphere a parallel at height z has the geodesic curvature
    z / sqrt(1 - z^2): the angles differ by twice that times the step, to the order of the square of the step."""
    step = 0.3
    for middle in (0.0, 0.4):
        low, high = (np.sin(np.arcsin(middle) + side * 0.15) for side in (-1.0, 1.0))
        x, faces, rows = band([low, middle, high])
        system = compile(scene(x, faces, rows[1]))
        found = system.scene.forces[0].measure(
            system.groups[0].block, x, np.zeros((len(system.groups[0].block.indices), 3, 3))
        )
        length = 2.0 * np.sin(0.5 * step) * np.sqrt(1.0 - middle**2)
        expected = 2.0 * length * middle / np.sqrt(1.0 - middle**2)
        assert np.abs(found["angle"]) == pytest.approx(expected, abs=1e-13 if middle == 0.0 else 0.05 * expected)


def test_a_disturbed_line_on_a_sphere_comes_back_to_the_great_circle() -> None:
    """The rims of the strip and the ends of its line are held, the rest of the line is pulled to the sphere, on which
    it was moved away from the equator: by the mirror of the strip, that is where it is straight."""
    x, faces, rows = band([-0.2, 0.0, 0.2])
    moved, inner = x.copy(), rows[1, 1:-1]
    moved[inner, 2] += 0.08 * np.sin(np.arange(1, 8))
    moved[inner] /= np.linalg.norm(moved[inner], axis=1)[:, None]
    pull = PullToSurface.on(sphere(1.0), particles=inner, strength=100.0)
    held = [*rows[0], *rows[2], rows[1, 0], rows[1, -1]]
    found = relax(scene(moved, faces, rows[1], pull, anchors=[{"particles": held}]))
    assert found.converged
    assert found.particles[inner, 2] == pytest.approx(np.zeros(7), abs=1e-7)
    assert np.abs(found.forces[0]["angle"]).max() <= 1e-7


def test_the_edges_of_a_strip_stay_parallel() -> None:
    """With `equal_length` on the cross edges of either side, a disturbed strip about the equator comes back to one
    width along its length: by symmetry that of its held ends."""
    x, faces, rows = band([-0.2, 0.0, 0.2])
    moved = x.copy()
    moved[rows[:, 1:-1].ravel(), 2] += 0.03 * np.sin(np.arange(21) * 2.1)
    moved /= np.linalg.norm(moved, axis=1)[:, None]
    across = np.concatenate([np.stack([rows[0], rows[1]], axis=1), np.stack([rows[1], rows[2]], axis=1)])
    even = {"kind": "equal_length", "particles": across, "group": np.repeat([0, 1], 9), "stiffness": 50.0}
    inner = rows[:, 1:-1].ravel()
    pull = PullToSurface.on(sphere(1.0), particles=inner, strength=100.0)
    slide = {"kind": "equal_length", "particles": np.stack([rows[:, :-1], rows[:, 1:]], axis=2).reshape(-1, 2),
             "group": np.repeat([0, 1, 2], 8), "stiffness": 20.0}  # fmt: skip
    held = [*rows[:, 0], *rows[:, -1]]
    found = relax(scene(moved, faces, rows[1], pull, even, slide, anchors=[{"particles": held}]))
    assert found.converged
    wide = np.linalg.norm(found.particles[across[:, 0]] - found.particles[across[:, 1]], axis=1)
    assert wide == pytest.approx(np.full(18, np.linalg.norm(x[rows[0, 0]] - x[rows[1, 0]])), abs=1e-6)
    assert found.particles[rows[1], 2] == pytest.approx(np.zeros(9), abs=1e-6)


def test_a_closed_line_is_straight_where_it_closes() -> None:
    """Given with its first vertex again: as many vertices count as it has."""
    mesh = grid(np.arange(9.0), np.array([-0.2, 0.0, 0.2]))
    turn = mesh.vertices[:, 0] * 2.0 * np.pi / 8.0
    x = np.column_stack([np.cos(turn), np.sin(turn), mesh.vertices[:, 1]])
    middle = np.flatnonzero(mesh.vertices[:, 1] == 0.0)
    path = middle[np.argsort(mesh.vertices[middle, 0])]
    (group,) = compile(scene(x, mesh.faces, [*path[:-1], path[0]])).groups
    assert len(np.unique(group.block.indices[:, 0])) == 8


@pytest.mark.parametrize(
    ("path", "message"),
    [
        ([0, 4, 99], "/forces/0: vertex 99 in a path; the faces of the mesh have vertices 0 to 8"),
        ([0, 4, 8], "/forces/0: a path leaves the edges of the mesh"),
        ([0, 1, 2], "/forces/0: a path leaves the edges of the mesh, or passes a vertex that has not faces all round"),
    ],
)
def test_a_path_runs_along_edges_within_the_mesh(path: Any, message: str) -> None:
    mesh = grid(np.arange(3.0), np.arange(3.0))
    with pytest.raises(InputError, match=message):
        compile(scene(mesh.vertices, mesh.faces, path))
