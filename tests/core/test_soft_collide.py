"""Closed meshes against each other: vertices by solid angles and closest points, and blocks on each other."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.test_pulls import on_triangles
from hookean import Scene, relax
from hookean.errors import InputError
from hookean.forces import KINDS
from hookean.running.simulation import Simulation
from hookean.system.system import compile
from soak import examples

SEEDED = settings(derandomize=True, deadline=None, max_examples=examples(25), database=None)
BALL = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1.0]])
SIDES = np.array([[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]])
BLOCK = np.array([[x, y, z] for z in (0, 1.0) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))])
FACES = np.array([[3, 2, 1, 0], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]])


def scene(bodies: list[np.ndarray], faces: np.ndarray, *more: dict[str, Any], k: float = 7.0, **others: Any) -> Scene:
    x, count = np.concatenate(bodies), len(bodies[0])
    every = np.concatenate([faces + i * count for i in range(len(bodies))])
    force = {"kind": "soft_collide", "mesh": "m", "strength": k}
    meshes = {"m": {"vertices": x, "faces": every}}
    return Scene(particles=x, meshes=meshes, forces=[force, *more], weld_tolerance=1e-9, **others)


def winding(p: np.ndarray, corners: np.ndarray) -> float:
    """How often a closed mesh (m, 3, 3) goes round p, by solid angles (van Oosterom and Strackee, 1983)."""
    a, b, c = (corners - p).transpose(1, 0, 2)
    x, y, z = (np.linalg.norm(v, axis=1) for v in (a, b, c))
    volume = np.einsum("ij,ij->i", a, np.cross(b, c))
    rest = x * y * z + (a * b).sum(1) * z + (b * c).sum(1) * x + (c * a).sum(1) * y
    return float(np.arctan2(volume, rest).sum() / (2.0 * np.pi))


@SEEDED
@given(seed=st.integers(0, 2**32 - 1))
def test_vertices_inside_are_pushed_to_the_closest_point(seed: int) -> None:
    """Of irregular octahedra over each other: depths by solid angles and brute force. The force on a body is k d from
    each of its vertices, less that of the vertices in it; all forces and moments sum to zero."""
    rng, k = np.random.default_rng(seed), 7.0
    bodies = [BALL * rng.uniform(0.4, 1.5, (6, 1)) + rng.uniform(-0.8, 0.8, 3) for _ in range(4)]
    system = compile(scene(bodies, SIDES, k=k))
    f, _, energies = system.evaluate(system.start())
    energy, total = 0.0, np.zeros((4, 3))
    for i, one in enumerate(bodies):
        for j, other in enumerate(bodies):
            for p in one:
                if i != j and winding(p, other[SIDES]) > 0.5:
                    close = on_triangles(p, other[SIDES]) - p
                    nearest = close[np.argmin((close**2).sum(axis=1))]
                    energy += 0.5 * k * nearest @ nearest
                    total[i] += k * nearest
                    total[j] -= k * nearest
    size = max(np.abs(f).max(), 1.0)
    assert energies.sum() == pytest.approx(energy, rel=1e-11, abs=1e-20)
    assert f.reshape(4, 6, 3).sum(axis=1) == pytest.approx(total, abs=1e-11 * size)
    assert np.abs(f.sum(axis=0)).max() <= 1e-12 * size
    assert np.abs(np.cross(system.x, f).sum(axis=0)).max() <= 1e-12 * size


def test_a_vertex_right_over_edges_and_corners_is_inside_once() -> None:
    """Rays from the middle of a grid of cubes pass through edges and corners of their faces: no vertex is lost."""
    small, big = 0.5 * BLOCK + 0.25, BLOCK
    system = compile(scene([small, big], FACES, k=1.0))
    f, _, energies = system.evaluate(system.start())
    assert energies.sum() == pytest.approx(8 * 0.5 * 0.25**2, rel=1e-13)  # all corners are 1/4 inside
    assert np.abs(f[:8]).max(axis=1) == pytest.approx(np.full(8, 0.25), rel=1e-13)


@pytest.mark.parametrize("solver", ["relaxation", "newton"])
def test_vertices_pressed_on_a_face_sink_in_by_their_part_of_the_stiffness(solver: str) -> None:
    """P / k, below the top of a block that is held and carries all of it."""
    k, load = 200.0, np.array([1.0, 2.0, 3.0, 4.0])
    upper = BLOCK * [1.0, 1.0, 2.0] + [0.52, 0.47, 0.99]
    weights = {"kind": "unary", "particles": [8, 9, 10, 11], "vector": [[0, 0, -p] for p in load]}
    held = [{"particles": [*range(8), *range(12, 16)]}, {"particles": [8, 9, 10, 11], "axes": "xy"}]
    lower = BLOCK * [2.0, 2.0, 1.0]
    given = scene([lower, upper], FACES, weights, k=k, anchors=held, settings={"tolerance": 1e-11, "solver": solver})
    found = relax(given)
    assert found.converged
    assert found.particles[8:12, 2] == pytest.approx(1.0 - load / k, abs=1e-9)
    carried = [f for p, f in zip(found.reactions["particles"], found.reactions["force"], strict=True) if p < 8]
    assert np.sum(carried, axis=0) == pytest.approx([0.0, 0.0, load.sum()], abs=1e-8)


def test_bodies_thrown_at_each_other_keep_momentum_and_energy() -> None:
    """Two octahedra of springs: momentum and angular momentum to rounding, energy to 1e-4 by velocity Verlet, whose
    error goes by the square of w dt = 0.03."""
    one, other = BALL, 0.8 * BALL + [2.2, 0.3, 0.2]
    pairs = np.array([[i, j] for i in range(6) for j in range(i)])
    springs = {"kind": "springs", "particles": np.concatenate([pairs, pairs + 6]), "stiffness": 50.0, "damping": 0.0}
    v = np.repeat([[1.0, 0, 0], [-1.0, 0.1, 0]], 6, axis=0)
    settings = {"solver": "verlet", "time_step": 0.001, "drag": 0.0, "sub_iterations": 1500}
    given = scene([one, other], SIDES, {**springs, "rest_factor": 1.0}, k=100.0, velocities=v, settings=settings)
    running = Simulation(given)
    x = running.state.x.copy()
    energy = 0.5 * (v**2).sum() + running.system.evaluate(running.state)[2].sum()
    running.step()
    end = running.state
    assert np.abs(end.v - v).max() > 0.5
    assert end.v.sum(axis=0) == pytest.approx(v.sum(axis=0), abs=1e-10)
    assert np.cross(end.x, end.v).sum(axis=0) == pytest.approx(np.cross(x, v).sum(axis=0), abs=1e-9)
    after = 0.5 * (end.v**2).sum() + running.system.evaluate(end)[2].sum()
    assert after == pytest.approx(energy, rel=1e-4)


def test_an_open_mesh_is_no_body() -> None:
    with pytest.raises(InputError, match="/meshes/m/faces: the mesh is not closed at the edge of vertices"):
        compile(scene([BALL], SIDES[1:]))


def test_a_mesh_without_particles_at_its_corners_is_named() -> None:
    kind = KINDS["soft_collide"]
    force, x = kind.example()
    mesh = {"vertices": x, "faces": [[*face] for face in kind.example_faces]}
    with pytest.raises(InputError, match="/meshes/skin/faces: no face has particles at all of its corners; put a"):
        relax(Scene(particles=[[9.0, 9.0, 9.0]], forces=[force], meshes={"skin": mesh}))
