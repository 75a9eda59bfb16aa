"""Loads per area: true, plan and that of the start; their resultants."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hookean import AreaWeight, LineWeight, Scene, relax
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


@pytest.mark.parametrize("turned", [1.0, -1.0])
def test_a_load_per_plan_area_is_that_of_the_shadow(turned: float) -> None:
    """A roof of 3 x 4 in plan that rises by 1 : 2 carries q x 12, whatever its true area and orientation; per start
    area a stretched roof carries q times its area at the start."""
    mesh = grid(np.linspace(0, 3.0, 4), np.linspace(0, 4.0, 3))
    x = np.array(mesh.vertices)
    x[:, 2] = 0.5 * x[:, 0]
    faces = np.array(mesh.faces)[:, :: int(turned)]
    force = {"kind": "area_weight", "mesh": "m", "weight": 0.7, "per": "plan"}
    system = compile(Scene(particles=x, meshes={"m": {"vertices": x, "faces": faces}}, forces=[force]))
    assert system.evaluate(system.start())[0].sum(axis=0) == pytest.approx([0, 0, -0.7 * 12.0], abs=1e-13)
    system = compile(system.scene.model_copy(update={"forces": [{**force, "per": "start"}]}))
    state = system.start()
    state.x[:, 1] *= 3.0
    assert system.evaluate(state)[0].sum(axis=0) == pytest.approx([0, 0, -0.7 * 12.0 * np.sqrt(1.25)], abs=1e-13)


@pytest.mark.parametrize("per", ["true", "plan", "start"])
def test_the_tangent_of_each_way_is_exact(per: str) -> None:
    """The symmetric part of -df/dx, by central differences of the forces: to the square of their step, 1e-10 of it."""
    force, x = AreaWeight.example()
    lines, _ = LineWeight.example()
    for one in (force.model_copy(update={"per": per}), lines.model_copy(update={"per": per})):
        meshes = {"skin": {"vertices": x, "faces": AreaWeight.example_faces}}
        system = compile(Scene(particles=x, meshes=meshes, forces=[one]))
        (group,) = system.groups
        state, size = system.start(), 3 * len(x)
        exact, numeric, step = np.zeros((size, size)), np.zeros((size, size)), 1e-5
        blocks = system.stiffness_blocks(group, state, state.memory[0])
        for index, block in zip(group.block.indices, blocks, strict=True):
            at = (3 * index[:, None] + np.arange(3)).ravel()
            np.add.at(exact, (at[:, None], at), block)
        for i in range(size):
            sides = []
            for sign in (1.0, -1.0):
                state.x = x.copy()
                state.x.flat[i] += sign * step
                sides.append(system.evaluate(state)[0].ravel())
            numeric[:, i] = (sides[1] - sides[0]) / (2.0 * step)
        assert exact == pytest.approx(0.5 * (numeric + numeric.T), abs=1e-9)


def test_loads_are_reported_with_resultant_and_centre() -> None:
    """Snow on a roof: q x its plan area through the middle of the roof, and no moment about it; a couple has no
    resultant, and its moment is that of the couple."""
    mesh = grid(np.linspace(0, 2.0, 3), np.linspace(0, 1.0, 3))
    x = np.array(mesh.vertices)
    forces: list[dict[str, Any]] = [
        {"kind": "springs", "particles": [[0, 1]]},
        {"kind": "area_weight", "name": "snow", "mesh": "m", "weight": 3.0, "per": "plan"},
        {"kind": "unary", "particles": [0, 6], "vector": [[0, 0, 5.0], [0, 0, -5.0]]},
    ]
    scene = Scene(
        particles=x, meshes={"m": vars(mesh)}, forces=forces, anchors=[{"particles": np.arange(len(x))}]
    )  # fmt: skip
    loads = relax(scene).to_dict()["loads"]
    assert (loads["force"], loads["kind"], loads["name"]) == ([1, 2], ["area_weight", "unary"], ["snow", ""])
    assert loads["resultant"][0] == pytest.approx([0, 0, -6.0], abs=1e-14)
    assert loads["centre"][0] == pytest.approx([1.0, 0.5, 0.0], abs=1e-14)
    assert loads["moment"][0] == pytest.approx([0, 0, 0], abs=1e-14)
    assert loads["resultant"][1] == pytest.approx([0, 0, 0], abs=1e-14)
    assert loads["centre"][1] == pytest.approx([1.0, 0.0, 0.0], abs=1e-14)
    assert loads["moment"][1] == pytest.approx([0, 10.0, 0], abs=1e-14)
