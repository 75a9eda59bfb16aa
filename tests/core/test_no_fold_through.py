"""Folds that stop at half a turn, and know on which side they are."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hookean import Scene, relax
from hookean.system.system import compile

EDGE = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.7, 1.5, 0.0]]


def folded(angle: float) -> np.ndarray:
    """Two triangles on the x axis, the second turned up by an angle; their tips are 1.5 and 0.6 from it."""
    return np.array([*EDGE, [1.2, -0.6 * np.cos(angle), 0.6 * np.sin(angle)]])


def started(angle: float, **given: Any) -> Any:
    force = {"kind": "no_fold_through", "particles": [[0, 1, 2, 3]], "strength": 4.0, **given}
    return compile(Scene(particles=folded(angle), forces=[force]))


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_beyond_half_a_turn_it_pushes_back_as_it_has_followed_the_fold(side: float) -> None:
    """Steps of 0.4 from flat to 3.6 rad: nothing up to pi, then the moment S (theta - pi) against the fold, on a tip
    h from the edge M / h; E = S (theta - pi)^2 / 2. A hinge would take 3.6 as a fold of 2.68 to the other side."""
    system = started(0.0)
    state = system.start()
    for angle in np.arange(0.4, 3.7, 0.4):
        state.x = folded(side * angle)
        f, _, energy = system.evaluate(state)
        more = max(angle - np.pi, 0.0)
        assert energy.sum() == pytest.approx(2.0 * more**2, abs=1e-14)
        assert f[2, 2] == pytest.approx(-side * 4.0 * more / 1.5, abs=1e-13)
        system.remember(state)


def test_it_starts_with_the_shape_that_is_drawn() -> None:
    """Drawn at 3.0 rad and moved to 3.3 within one step; drawn at 3.3 rad it is a fold of -2.98, and free."""
    system = started(3.0)
    state = system.start()
    state.x = folded(3.3)
    assert system.evaluate(state)[2].sum() == pytest.approx(2.0 * (3.3 - np.pi) ** 2, rel=1e-12)
    assert started(3.3).evaluate(started(3.3).start())[2].sum() == 0.0


def test_a_flap_that_is_pulled_over_stops_near_the_other() -> None:
    """A flap on a held edge and face, driven by a hinge S1 that wants 3.1 rad: beyond a limit of 2.8 it rests where
    S1 (3.1 - theta) = S2 (theta - 2.8). Springs of the flap hold its shape, as nothing pulls in its plane."""
    first, second = 2.0, 30.0
    x = folded(2.5)
    pairs = [[0, 3], [1, 3]]
    forces: list[dict[str, Any]] = [
        {"kind": "hinge", "particles": [[0, 1, 2, 3]], "strength": first, "rest_angle": 3.1},
        {"kind": "no_fold_through", "particles": [[0, 1, 2, 3]], "strength": second, "limit": 2.8},
        {"kind": "springs", "particles": pairs, "stiffness": 1e4},
    ]
    found = relax(Scene(particles=x, forces=forces, anchors=[{"particles": [0, 1, 2]}], settings={"tolerance": 1e-11}))
    rest = 3.1
    expected = (first * rest + second * 2.8) / (first + second)
    assert found.converged
    assert found.forces[1]["angle"] == pytest.approx([expected], abs=1e-8)
    assert found.forces[1]["moment"] == pytest.approx([second * (expected - 2.8)], rel=1e-6)


def test_the_edges_of_a_mesh_are_those_of_its_triangles() -> None:
    """Of three triangles in a strip two edges; a quad beside them has none."""
    x = np.array([[0, 0, 0], [1, 0, 0.1], [0, 1, 0], [1, 1, 0.2], [2, 0, 0], [3, 0, 0], [3, 1, 0.0]])
    faces = [[0, 1, 2], [1, 3, 2], [1, 4, 3], [4, 5, 6, 3]]
    force = {"kind": "no_fold_through", "mesh": "m"}
    system = compile(Scene(particles=x, meshes={"m": {"vertices": x, "faces": faces}}, forces=[force]))
    edges = {frozenset(row[:2]) for row in system.groups[0].block.indices.tolist()}
    assert edges == {frozenset((1, 2)), frozenset((1, 3))}


@pytest.mark.parametrize("seed", range(3))
def test_relaxation_settles_a_net_of_folds(seed: int) -> None:
    """Triangles at random heights, all of whose folds have a limit near what they start with: folds pass it and come
    back below it, and the bound of the stiffness holds on either side."""
    rng = np.random.default_rng(seed)
    x = np.column_stack([*(c.ravel() for c in np.mgrid[0:4, 0:4].astype(float)), np.zeros(16)])
    x += rng.uniform(-0.15, 0.15, x.shape)
    faces = [f for i in (0, 1, 2, 4, 5, 6, 8, 9, 10) for f in ([i, i + 4, i + 1], [i + 1, i + 4, i + 5])]
    forces: list[dict[str, Any]] = [
        {"kind": "no_fold_through", "mesh": "m", "strength": 3.0, "limit": 0.15},
        {"kind": "anchor_spring", "particles": range(16), "strength": 5.0},
    ]
    settings = {"solver": "relaxation", "max_iterations": 2000}
    found = relax(Scene(particles=x, meshes={"m": {"vertices": x, "faces": faces}}, forces=forces, settings=settings))
    assert found.converged, found.message
    assert np.abs(found.forces[0]["angle"]).max() < 1.0
