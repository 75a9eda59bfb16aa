"""Smoothing along a mesh: heights that stay, flat meshes, spheres."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from core.test_smooth import FAN, fan
from core.test_volume import icosahedron
from hookean import Scene, relax
from hookean.discretize import grid, naked_vertices
from hookean.system.system import compile


def scene(x: np.ndarray, faces: Any, held: Any = (), kind: str = "tangential_smooth") -> Scene:
    anchors = [{"particles": held}] if len(held) else []
    mesh = {"m": {"vertices": x, "faces": faces}}
    force = {"kind": kind, "mesh": "m", "stiffness": 5.0}
    return Scene(particles=x, meshes=mesh, forces=[force], anchors=anchors, settings={"tolerance": 1e-11})


@pytest.mark.parametrize("seed", range(4))
def test_a_vertex_in_a_held_ring_keeps_its_height(seed: int) -> None:
    """The normal is along the area vector of the ring, sum p_j x p_j+1 / 2, which the vertex does not change. The force
    on it is across this, so it ends at mean + h n with the height h it had."""
    x = fan(seed)
    ring = x[1:]
    normal = np.cross(ring, np.roll(ring, -1, axis=0)).sum(axis=0)
    normal /= np.linalg.norm(normal)
    off = x[0] - ring.mean(axis=0)
    height = off @ normal
    system = compile(scene(x, FAN))
    f, _, energy = system.evaluate(system.start())
    assert energy.sum() == pytest.approx(2.5 * (off @ off - height**2), rel=1e-12)
    assert f[0] == pytest.approx(-5.0 * (off - height * normal), abs=1e-13)
    found = relax(scene(x, FAN, range(1, 7)))
    assert found.converged
    assert found.particles[0] == pytest.approx(ring.mean(axis=0) + height * normal, abs=1e-9)


def test_on_a_flat_mesh_it_is_smooth() -> None:
    """Nothing has a height there: the same forces as those of uniform weights, to rounding."""
    t = np.arange(6.0)
    mesh = grid(t, t)
    x = mesh.vertices.copy()
    x[:, :2] += np.random.default_rng(4).uniform(-0.3, 0.3, (len(x), 2))
    both = [compile(scene(x, mesh.faces, kind=kind)) for kind in ("smooth", "tangential_smooth")]
    one, other = (system.evaluate(system.start())[0] for system in both)
    assert np.abs(one).max() > 0.5 and other == pytest.approx(one, abs=1e-13)


def test_a_mesh_with_regular_rings_stays() -> None:
    """An icosahedron: each vertex is straight over the mean of its neighbours. `smooth` would shrink it."""
    x, faces = icosahedron()
    both = [compile(scene(x, faces, kind=kind)) for kind in ("smooth", "tangential_smooth")]
    one, other = (np.abs(system.evaluate(system.start())[0]).max() for system in both)
    assert one > 0.5 and other <= 1e-13


def test_a_bump_becomes_even_and_stays_a_bump() -> None:
    """A disturbed paraboloid over a held rim: afterwards every vertex is over the mean of its neighbours, to 1e-8, and
    the middle is still within a tenth of its height, as vertices moved along the mesh."""
    t = np.linspace(-1.0, 1.0, 9)
    mesh = grid(t, t)
    x = mesh.vertices.copy()
    x[:, :2] += np.random.default_rng(1).uniform(-0.06, 0.06, (len(x), 2))
    x[:, 2] = 0.4 * (2.0 - x[:, 0] ** 2 - x[:, 1] ** 2)
    found = relax(scene(x, mesh.faces, naked_vertices(mesh)))
    assert found.converged and found.forces[0]["distance"].max() <= 1e-8
    assert found.particles[:, 2].max() == pytest.approx(0.8, abs=0.08)
