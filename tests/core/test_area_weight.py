"""Weight per area as it is now."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hookean import Scene, relax
from hookean.discretize import grid
from hookean.system.system import compile


@pytest.mark.parametrize("stretch", [1.0, 2.5])
def test_the_weight_is_that_of_the_area_as_it_is(stretch: float) -> None:
    """q A along g: 3 x 4, stretched along x after the start."""
    mesh = grid(np.linspace(0, 3.0, 4), np.linspace(0, 4.0, 3))
    force = {"kind": "area_weight", "mesh": "m", "weight": 0.7, "direction": [0, 3.0, -4.0]}
    scene = Scene(particles=mesh.vertices, meshes={"m": vars(mesh)}, forces=[force])
    system = compile(scene)
    state = system.start()
    state.x[:, 0] *= stretch
    f, _, _ = system.evaluate(state)
    assert f.sum(axis=0) == pytest.approx(0.7 * 12.0 * stretch * np.array([0, 0.6, -0.8]), abs=1e-13)


def test_a_triangle_is_shared_in_thirds() -> None:
    """A 3-4-5 triangle of area 6."""
    x = np.array([[0, 0, 0], [4, 0, 0], [0, 3, 0.0]])
    force = {"kind": "area_weight", "mesh": "m", "weight": 2.0}
    system = compile(Scene(particles=x, meshes={"m": {"vertices": x, "faces": [[0, 1, 2]]}}, forces=[force]))
    assert system.evaluate(system.start())[0] == pytest.approx(np.tile([0, 0, -4.0], (3, 1)), abs=1e-15)


def test_a_curtain_grows_by_the_weight_that_it_gains() -> None:
    """A curtain of width b on two springs k: its lower corners carry half of its weight, 2 k (L - L0) = q b L / 2, so
    L = L0 / (1 - q b / (4 k))."""
    width, start, stiffness, weight = 2.0, 3.0, 10.0, 4.0
    x = np.array([[0, 0, 0], [width, 0, 0], [width, 0, -start], [0, 0, -start]])
    forces: list[dict[str, Any]] = [
        {"kind": "area_weight", "mesh": "m", "weight": weight},
        {"kind": "springs", "particles": [[0, 3], [1, 2]], "stiffness": stiffness},
    ]
    held = [{"particles": [0, 1]}, {"particles": [2, 3], "axes": "xy"}]
    mesh = {"m": {"vertices": x, "faces": [[0, 1, 2, 3]]}}
    settings = {"tolerance": 1e-11}
    found = relax(Scene(particles=x, meshes=mesh, forces=forces, anchors=held, settings=settings))
    assert found.converged
    expected = start / (1.0 - weight * width / (4.0 * stiffness))
    assert found.particles[2:, 2] == pytest.approx([-expected, -expected], rel=1e-9)
