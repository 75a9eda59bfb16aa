"""Planar quads and polygons: distances of diagonals, surfaces that are flat by quads, others that become so."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hookean import InputError, Scene, relax
from hookean.discretize import grid, naked_vertices
from hookean.system.system import compile


def translational(count: int) -> tuple[np.ndarray, np.ndarray]:
    """One curve moved along another: each quad is a parallelogram."""
    t = np.linspace(-1.0, 1.0, count)
    mesh = grid(t, t)
    x = mesh.vertices.copy()
    x[:, 2] = 0.5 * x[:, 0] ** 2 - 0.3 * np.sin(2.0 * x[:, 1])
    return x, mesh.faces


def model(x: np.ndarray, faces: Any, *more: dict[str, Any], **given: Any) -> Scene:
    forces = [{"kind": "planarize", "mesh": "m", "stiffness": 20.0}, *more]
    settings = {"tolerance": 1e-10}
    return Scene(particles=x, meshes={"m": {"vertices": x, "faces": faces}}, forces=forces, settings=settings, **given)


def test_the_distance_of_opposite_edges_of_a_tetrahedron() -> None:
    """a / sqrt 2 for edges of length a; the diagonals of the quad halve each other, so each corner takes k d / 2."""
    x = np.array([[1, 1, 1], [1, -1, -1], [-1, -1, 1], [-1, 1, -1.0]])  # edges of 2 sqrt 2, distance 2
    system = compile(model(x, [[0, 1, 2, 3]]))
    f, _, energy = system.evaluate(system.start())
    assert energy.sum() == pytest.approx(0.5 * 20.0 * 2.0**2, rel=1e-14)
    assert f == pytest.approx(20.0 * np.outer([-1, 1, -1, 1], [0, 0, 1.0]), abs=1e-13)


def test_a_translational_surface_stays() -> None:
    """Its quads are flat: no force, to rounding."""
    x, faces = translational(7)
    system = compile(model(x, faces))
    assert np.abs(system.evaluate(system.start())[0]).max() <= 1e-13


def test_a_surface_becomes_flat_by_quads() -> None:
    """A translational surface that was disturbed, with its rim held and soft anchors off: all distances go to zero.

    A quadratic energy about d = 0: with residual 1e-10 distances are below 1e-7.
    """
    x, faces = translational(7)
    rng = np.random.default_rng(2)
    x = x + 0.03 * rng.normal(size=x.shape)
    system = compile(model(x, faces))
    first = np.abs(system.evaluate(system.start())[0]).max()
    found = relax(model(x, faces))
    assert first > 0.1
    assert found.converged
    assert found.forces[0]["distance"].max() <= 1e-7


@pytest.mark.parametrize("place", ["particles", "points"])
@pytest.mark.parametrize("corners", [5, 6, 9])
def test_a_polygon_becomes_flat(corners: int, place: str) -> None:
    """By its quads of four corners in a row: afterwards the third singular value of the corners is zero."""
    rng = np.random.default_rng(corners)
    turn = 2.0 * np.pi * np.arange(corners) / corners
    x = np.column_stack([np.cos(turn), np.sin(turn), 0.15 * rng.normal(size=corners)])
    rows: Any = [range(corners)] if place == "particles" else [x]
    force = {"kind": "planarize", place: rows, "stiffness": 5.0}
    found = relax(Scene(particles=x, forces=[force], settings={"tolerance": 1e-11}))
    assert found.converged and len(found.forces[0]["distance"]) == corners
    y = found.particles - found.particles.mean(axis=0)
    assert np.linalg.svd(y, compute_uv=False)[2] <= 1e-6
    assert np.linalg.svd(y, compute_uv=False)[1] >= 0.5


def test_planar_quads_under_load_carry_it_by_their_planes() -> None:
    """One corner of a held square is pushed up by P: d = P / (2 k) x 2, as it has half of the distance's share: the
    diagonal's middle rises by z / 2 and k (z / 2) / 2 = P, so z = 4 P / k (to first order exact: d is z / 2)."""
    x = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.0]])
    load = {"kind": "unary", "particles": [2], "vector": [0, 0, 1e-4]}
    held = [{"particles": [0, 1, 3]}, {"particles": [2], "axes": "xy"}]
    scene = model(x, [[0, 1, 2, 3]], load, anchors=held)
    found = relax(scene)
    # the common normal leans by z / sqrt 2: d = z / 2 cos, relative change z^2 / 4
    assert found.particles[2, 2] == pytest.approx(4.0 * 1e-4 / 20.0, rel=1e-8)
    assert found.forces[0]["force"] == pytest.approx([2e-4], rel=1e-8)


def test_rows_of_three_corners_are_refused() -> None:
    with pytest.raises(InputError, match="each element needs 4 particles"):
        compile(Scene(particles=np.eye(3), forces=[{"kind": "planarize", "particles": [[0, 1, 2]]}]))


def test_rim_of_the_grid_is_where_it_was() -> None:
    """With the rim of a flat grid held, an inner vertex that was lifted comes back into the plane."""
    t = np.arange(4.0)
    mesh = grid(t, t)
    x = mesh.vertices.copy()
    x[5, 2] = 0.2
    found = relax(model(x, mesh.faces, anchors=[{"particles": naked_vertices(mesh)}]))
    assert found.converged and np.abs(found.particles[:, 2]).max() <= 1e-6


def test_parallel_diagonals_have_no_distance_and_no_force() -> None:
    """What is reported is what acts: nothing, where the diagonals have no common normal to speak of."""
    x = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [1.0, 1e-9, 1.0]])
    force = {"kind": "planarize", "particles": [[0, 1, 2, 3]], "stiffness": 2.0}
    found = relax(Scene(particles=x, forces=[force], anchors=[{"particles": range(4)}]))
    assert found.forces[0]["force"] == pytest.approx([0.0]) and found.forces[0]["distance"] == pytest.approx([0.0])
    assert not found.reactions["force"].any()
