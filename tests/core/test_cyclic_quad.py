"""Quads on circles: surfaces of revolution have them, others come to have them."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hookean import Scene, relax
from hookean.discretize import grid
from hookean.system.system import compile


def turned(count: int, tall: int) -> tuple[np.ndarray, np.ndarray]:
    """Part of a surface of revolution, by its parallels and meridians: quads are isosceles trapeziums, flat and on
    circles, and angles beside each other on a parallel are equal."""
    mesh = grid(np.linspace(0.0, 2.5, count), np.linspace(0.0, 1.5, tall))
    turn, height = mesh.vertices[:, 0], mesh.vertices[:, 1]
    radius = 1.2 + 0.3 * np.cos(1.7 * height)
    return np.column_stack([radius * np.cos(turn), radius * np.sin(turn), height]), mesh.faces


def model(x: np.ndarray, faces: Any, *kinds: dict[str, Any]) -> Scene:
    forces = [{"mesh": "m", **kind} for kind in kinds]
    settings = {"tolerance": 1e-10, "max_iterations": 50000}
    return Scene(particles=x, meshes={"m": {"vertices": x, "faces": faces}}, forces=forces, settings=settings)


def test_a_rectangle_has_the_circle_of_its_diagonal() -> None:
    """Half of it: 3, 4 and 5; and no force."""
    x = np.array([[0, 0, 0], [3, 0, 0], [3, 4, 0], [0, 4, 0.0]])
    found = relax(model(x, [[0, 1, 2, 3], [0, 1, 2, 2]], {"kind": "cyclic_quad"}))
    assert found.forces[0]["radius"] == pytest.approx(np.full(4, 2.5), rel=1e-12)
    assert found.particles == pytest.approx(x, abs=1e-12)


def test_it_is_co_circular_with_a_group_for_each_quad() -> None:
    """The same forces and energy as with these groups given, to the bit."""
    x, faces = turned(4, 3)
    x = x + 0.05 * np.random.default_rng(3).normal(size=x.shape)
    groups = np.repeat(np.arange(len(faces)), 4)
    given = {"kind": "co_circular", "particles": faces.ravel(), "group": groups, "strength": 4.0}
    systems = [compile(model(x, faces, {"kind": "cyclic_quad", "strength": 4.0}))]
    systems.append(compile(Scene(particles=x, forces=[given])))
    one, other = (system.evaluate(system.start()) for system in systems)
    assert (one[0] == other[0]).all() and (one[2] == other[2]).all()


def test_a_surface_of_revolution_stays_and_comes_back() -> None:
    """No force, to rounding; and from a disturbed one all corners come to circles, to 1e-6."""
    x, faces = turned(6, 5)
    system = compile(model(x, faces, {"kind": "cyclic_quad"}))
    assert np.abs(system.evaluate(system.start())[0]).max() <= 1e-12
    moved = x + 0.02 * np.random.default_rng(1).normal(size=x.shape)
    found = relax(model(moved, faces, {"kind": "cyclic_quad"}))
    assert found.converged and found.forces[0]["distance"].max() <= 1e-6
    # as flat as their corners say: the last singular value of a quad on a circle is zero
    apart = found.particles[faces] - found.particles[faces].mean(axis=1, keepdims=True)
    assert np.linalg.svd(apart, compute_uv=False)[:, 2].max() <= 2e-6
