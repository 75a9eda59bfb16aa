"""Angles round vertices: excess of pyramids, sheets that unroll."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hookean import Scene, relax
from hookean.discretize import grid
from hookean.system.system import compile


def model(x: np.ndarray, faces: Any, *more: dict[str, Any], kind: str = "developable", **given: Any) -> Scene:
    forces = [{"kind": kind, "mesh": "m", "strength": 3.0}, *more]
    settings = {"tolerance": 1e-10, "max_iterations": 50000}
    return Scene(particles=x, meshes={"m": {"vertices": x, "faces": faces}}, forces=forces, settings=settings, **given)


@pytest.mark.parametrize("sides", [3, 4, 6])
def test_the_apex_of_a_pyramid(sides: int) -> None:
    """n equal triangles with slant edges s and base edges b have n 2 asin(b / 2 s) at their apex: E = m excess^2 / 2,
    and by symmetry the apex feels m excess n d(angle)/dh downwards or upwards."""
    turn, height = 2.0 * np.pi * np.arange(sides) / sides, 0.7
    x = np.vstack([[0, 0, height], np.column_stack([np.cos(turn), np.sin(turn), 0.0 * turn])])
    faces = [[0, 1 + i, 1 + (i + 1) % sides] for i in range(sides)]
    system = compile(model(x, faces))
    f, _, energy = system.evaluate(system.start())
    base, slant = 2.0 * np.sin(np.pi / sides), np.sqrt(1.0 + height**2)
    excess = sides * 2.0 * np.arcsin(0.5 * base / slant) - 2.0 * np.pi
    assert energy.sum() == pytest.approx(1.5 * excess**2, rel=1e-12)
    fall = -2.0 * (0.5 * base / slant**2) / np.sqrt(1.0 - (0.5 * base / slant) ** 2) * height / slant
    assert f[0] == pytest.approx([0, 0, -3.0 * excess * sides * fall], abs=1e-12)


def test_with_its_base_held_a_pyramid_becomes_flat() -> None:
    """The only height at which the angles sum to 2 pi is 0; the energy goes with the fourth power of the height, so
    the residual of 1e-10 leaves (1e-10)^(1/3)."""
    turn = 2.0 * np.pi * np.arange(5) / 5
    x = np.vstack([[0, 0, 0.7], np.column_stack([np.cos(turn), np.sin(turn), 0.0 * turn])])
    faces = [[0, 1 + i, 1 + (i + 1) % 5] for i in range(5)]
    found = relax(model(x, faces, anchors=[{"particles": range(1, 6)}]))
    assert abs(found.particles[0, 2]) <= 2e-3 and np.abs(found.forces[0]["angle"]).max() <= 1e-5


def cylinder() -> tuple[np.ndarray, np.ndarray]:
    """Part of a cylinder, a rolled grid."""
    mesh = grid(np.linspace(0.0, 2.5, 7), np.linspace(0.0, 1.5, 5))
    turn = mesh.vertices[:, 0]
    return np.column_stack([np.cos(turn), np.sin(turn), mesh.vertices[:, 1]]), mesh.faces


@pytest.mark.slow
def test_a_rolled_sheet_stays_and_comes_back() -> None:
    """Rectangles have 4 x 90 degrees: no force, to rounding. A disturbed one comes to 2 pi at all inner vertices, with
    its quads made flat."""
    x, faces = cylinder()
    system = compile(model(x, faces))
    assert np.abs(system.evaluate(system.start())[0]).max() <= 1e-12
    assert len(system.groups[0].block.indices) == 4 * 5 * 3
    moved = x + 0.02 * np.random.default_rng(1).normal(size=x.shape)
    found = relax(model(moved, faces, {"kind": "planarize", "mesh": "m", "stiffness": 10.0}))
    assert found.converged
    assert np.abs(found.forces[0]["angle"]).max() <= 1e-7 and found.forces[1]["distance"].max() <= 1e-6


def test_faces_turned_round_change_nothing() -> None:
    """Angles have no side."""
    x, faces = cylinder()
    x = x + 0.05 * np.random.default_rng(5).normal(size=x.shape)
    turned = faces.copy()
    turned[::2] = turned[::2, ::-1]
    one, other = (compile(model(x, f)) for f in (faces, turned))
    expected = one.evaluate(one.start())[0]
    assert np.abs(other.evaluate(other.start())[0] - expected).max() <= 1e-13 * np.abs(expected).max() * 16
