"""Incircles that touch: where they touch an edge, and meshes with circle packings."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hookean import Scene, relax
from hookean.system.system import compile


def model(x: np.ndarray, faces: Any, *more: dict[str, Any]) -> Scene:
    forces = [{"kind": "tangent_incircles", "mesh": "m", "stiffness": 10.0}, *more]
    settings = {"tolerance": 1e-10, "max_iterations": 50000}
    return Scene(particles=x, meshes={"m": {"vertices": x, "faces": faces}}, forces=forces, settings=settings)


def packing(rows: int) -> tuple[np.ndarray, np.ndarray]:
    """A patch of equilateral triangles."""
    i, j = np.meshgrid(np.arange(rows), np.arange(rows), indexing="ij")
    x = np.column_stack([(i + 0.5 * j).ravel(), (np.sqrt(0.75) * j).ravel(), 0.0 * i.ravel()])
    n = np.arange(rows * rows).reshape(rows, rows)
    one = np.stack([n[:-1, :-1], n[1:, :-1], n[:-1, 1:]], axis=-1).reshape(-1, 3)
    other = np.stack([n[1:, :-1], n[1:, 1:], n[:-1, 1:]], axis=-1).reshape(-1, 3)
    return x, np.concatenate([one, other])


def touch(a: np.ndarray, b: np.ndarray, c: np.ndarray) -> np.ndarray:
    """Where the incircle of a triangle touches its side a-b: the foot of the incentre."""
    sides = np.array([np.linalg.norm(b - c), np.linalg.norm(c - a), np.linalg.norm(a - b)])
    centre = sides @ np.array([a, b, c]) / sides.sum()
    u = (b - a) / sides[2]
    return np.asarray(a + (centre - a) @ u * u)


@pytest.mark.parametrize("seed", range(4))
def test_the_distance_is_that_of_the_points_where_the_circles_touch(seed: int) -> None:
    """By both incentres; and E = k u^2 / 2."""
    a, b, c, d = x = np.random.default_rng(seed).normal(size=(4, 3))
    apart = touch(a, b, c) - touch(a, b, d)
    force = {"kind": "tangent_incircles", "particles": [[0, 1, 2, 3]], "stiffness": 10.0}
    system = compile(Scene(particles=x, forces=[force]))
    energy = system.evaluate(system.start())[2].sum()
    assert energy == pytest.approx(5.0 * apart @ apart, rel=1e-12)
    found = system.scene.forces[0].measure(system.groups[0].block, x, np.zeros((1, 4, 3)))
    assert found["distance"] == pytest.approx([apart @ (b - a) / np.linalg.norm(b - a)], abs=1e-13)


def test_a_circle_packing_mesh_stays_and_comes_back() -> None:
    """Equilateral triangles have one circle each; disturbed ones come to L0 + L2 = L1 + L3 at all edges."""
    x, faces = packing(5)
    system = compile(model(x, faces))
    assert np.abs(system.evaluate(system.start())[0]).max() <= 1e-13
    moved = x + 0.08 * np.random.default_rng(1).normal(size=x.shape)
    found = relax(model(moved, faces))
    assert found.converged and np.abs(found.forces[0]["distance"]).max() <= 1e-7


def test_edges_of_quads_and_of_three_faces_do_not_count() -> None:
    """Of two triangles, a quad and a fin only the edge between the triangles is left; turned faces change nothing."""
    x = np.array([[0, 0, 0], [1, 0, 0.1], [1, 1, 0], [0, 1.2, 0], [2, 0, 0], [2, 1, 0.3], [0.5, -1, 1], [0.5, -1, -1]])
    faces = [[0, 1, 2], [0, 2, 3], [1, 4, 5, 2], [0, 1, 6], [0, 1, 7]]
    for turn in (1, -1):
        (group,) = compile(model(x, [face[::turn] for face in faces])).groups
        assert {frozenset(row[:2]) for row in group.block.indices.tolist()} == {frozenset((0, 2))}
        assert {frozenset(row[2:]) for row in group.block.indices.tolist()} == {frozenset((1, 3))}
