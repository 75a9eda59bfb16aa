"""Smoothing: weighted means of neighbours, harmonic functions, meshes that are smooth already."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hookean import Scene, relax
from hookean.discretize import grid, naked_vertices
from hookean.system.system import compile

FAN = [[0, i, i % 6 + 1] for i in range(1, 7)]


def scene(x: np.ndarray, faces: Any, held: Any = (), **force: Any) -> Scene:
    anchors = [{"particles": held}] if len(held) else []
    mesh = {"m": {"vertices": x, "faces": faces}}
    forces = [{"kind": "smooth", "mesh": "m", "stiffness": 5.0, **force}]
    return Scene(particles=x, meshes=mesh, forces=forces, anchors=anchors, settings={"tolerance": 1e-12})


def start(scene: Scene) -> tuple[np.ndarray, float]:
    """Forces and energy at the start."""
    system = compile(scene)
    f, _, energies = system.evaluate(system.start())
    return f, float(energies.sum())


def fan(seed: int) -> np.ndarray:
    """A vertex in a ring of six, neither flat nor regular, in reach of what a Delaunay mesh has."""
    rng = np.random.default_rng(seed)
    turn = np.arange(6) * np.pi / 3.0 + rng.uniform(-0.2, 0.2, 6)
    ring = np.column_stack([np.cos(turn), np.sin(turn), rng.uniform(-0.3, 0.3, 6)])
    return np.vstack([rng.uniform(-0.3, 0.3, 3), ring * rng.uniform(0.8, 1.3, (6, 1))])


def cotangent(x: np.ndarray, apex: int, a: int, b: int) -> float:
    """Of the angle at the apex, by its cosine."""
    u, v = x[a] - x[apex], x[b] - x[apex]
    return float(1.0 / np.tan(np.arccos(u @ v / np.linalg.norm(u) / np.linalg.norm(v))))


def weights(x: np.ndarray, kind: str) -> np.ndarray:
    """Of the neighbours 1 to 6 of vertex 0: equal; by the cotangents across both faces; by the distance."""
    if kind == "uniform":
        found = np.ones(6)
    elif kind == "inverse_length":
        found = 1.0 / np.linalg.norm(x[1:] - x[0], axis=1)
    else:
        around = [(i, (i - 1) % 6, (i + 1) % 6) for i in range(6)]
        found = np.array([cotangent(x, b + 1, 0, i + 1) + cotangent(x, a + 1, 0, i + 1) for i, b, a in around])
    return found / found.sum()


@pytest.mark.parametrize("kind", ["uniform", "cotangent", "inverse_length"])
@pytest.mark.parametrize("seed", range(3))
def test_a_vertex_in_a_held_ring_goes_to_the_weighted_mean(kind: str, seed: int) -> None:
    """p = sum w p_j with the weights of the start shape (Pinkall and Polthier 1993 for cotangents); before, the vertex
    feels -k r and its neighbours k w_j r, r = p - sum w p_j."""
    x = fan(seed)
    w = weights(x, kind)
    model = scene(x, FAN, range(1, 7), weights=kind)
    f, energy = start(model)
    off = x[0] - w @ x[1:]
    assert f[0] == pytest.approx(-5.0 * off, abs=1e-12)
    assert f[1:] == pytest.approx(5.0 * w[:, None] * off, abs=1e-12)
    assert energy == pytest.approx(2.5 * off @ off, rel=1e-12)
    found = relax(model)
    assert found.converged and found.stability == "stable"
    assert found.particles[0] == pytest.approx(w @ x[1:], abs=1e-10)
    assert found.forces[0]["distance"] == pytest.approx(np.zeros(6), abs=1e-10)


def test_a_harmonic_function_on_a_grid() -> None:
    """x^2 - y^2 solves the five-point Laplace equation exactly: a grid with this height at its rim gets it inside."""
    t = np.linspace(-1.0, 1.0, 9)
    mesh = grid(t, t)
    x = mesh.vertices.copy()
    right = x[:, 0] ** 2 - x[:, 1] ** 2
    rim = naked_vertices(mesh)
    x[rim, 2] = right[rim]
    found = relax(scene(x, mesh.faces, rim))
    assert found.converged and found.stability == "stable"
    assert found.particles == pytest.approx(np.column_stack([x[:, :2], right]), abs=1e-9)


def test_no_vertex_of_a_flat_mesh_moves_with_cotangents() -> None:
    """Linear functions solve Laplace's equation on any flat mesh, also with obtuse triangles and quads (gradients of
    areas sum to zero): to rounding. With uniform weights the same mesh is pulled about."""
    rng = np.random.default_rng(4)
    t = np.arange(6.0)
    mesh = grid(t, t)
    x = mesh.vertices.copy()
    x[:, :2] += rng.uniform(-0.35, 0.35, (len(x), 2))
    x[:, 2] = 0.3 * x[:, 0] - 0.8 * x[:, 1] + 2.0
    some = [[a, b, c] if i % 3 else [a, b, c, d] for i, (a, b, c, d) in enumerate(mesh.faces.tolist())]
    some += [[a, c, d] for i, (a, b, c, d) in enumerate(mesh.faces.tolist()) if i % 3]
    assert np.abs(start(scene(x, some, weights="cotangent"))[0]).max() <= 1e-12
    assert np.abs(start(scene(x, some, weights="uniform"))[0]).max() > 0.1


def test_vertices_of_the_rim_have_a_force_if_all_are_asked_for() -> None:
    """A square of side 2: the mean of the two neighbours of a corner p is the middle, r = p, so E = 4 k 2 / 2. The r of
    both neighbours cancel, so the force is -k p. A square has no interior vertex."""
    x = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0.0]])
    f, energy = start(scene(x, [[0, 1, 2, 3]], vertices="all"))
    assert energy == pytest.approx(4.0 * 5.0, rel=1e-14)
    assert f == pytest.approx(-5.0 * x, abs=1e-13)
    assert start(scene(x, [[0, 1, 2, 3]]))[1] == 0.0


def test_a_vertex_without_weights_gets_uniform_ones() -> None:
    """Faces without area have no cotangents: the vertex goes to the mean."""
    x = np.array([[0.3, 0, 0], *([float(i), 0, 0] for i in range(1, 7))])
    found = relax(scene(x, FAN, range(1, 7), weights="cotangent"))
    assert found.particles[0] == pytest.approx([3.5, 0, 0], abs=1e-10)
