"""Axes that become one line: a bar on a shaft, and two rigid bodies as a joint that turns and slides."""

from __future__ import annotations

import numpy as np
import pytest

from hookean import Scene, relax

CUBE = np.array([[i & 1, i >> 1 & 1, i >> 2] for i in range(8)]) - 0.5


def test_a_bar_on_a_held_axis_gives_way_by_its_load() -> None:
    """Bars of one length about one middle: a force F moves it by F / (4 k), and a moment M turns it by M / (k l^2), for
    small ones; 1e-4 of their squares."""
    k, force, couple = 1e3, 0.4, 0.2
    axes = {"kind": "concentric", "particles": [[0, 1, 2, 3]], "strength": k}
    load = {
        "kind": "unary",
        "particles": [2, 3],
        "vector": [[0, 0.5 * force - couple, 0], [0, 0.5 * force + couple, 0]],
    }
    bar = {"kind": "springs", "particles": [[2, 3]], "stiffness": 1e4}
    x = [[-1.0, 0, 0], [1.0, 0, 0], [-1.0, 0, 0], [1.0, 0, 0]]
    held = [{"particles": [0, 1]}, {"particles": [2], "axes": "x"}]
    scene = {"particles": x, "forces": [axes, load, bar], "anchors": held, "settings": {"tolerance": 1e-10}}
    found = relax(Scene.read(scene))
    assert found.converged
    y = found.particles[2:, 1]
    assert y.mean() == pytest.approx(force / (4.0 * k), rel=1e-3)
    assert 0.5 * (y[1] - y[0]) == pytest.approx(2.0 * couple / (k * 2.0**2), rel=1e-3)


def test_two_rigid_bodies_share_an_axis_along_which_they_slide_and_turn() -> None:
    """A cube whose vertical edge is to lie on that of a held one, drawn askew: it comes onto the line, and two motions
    meet no resistance."""
    other = CUBE @ np.array([[0.8, -0.6, 0.0], [0.6, 0.8, 0.0], [0.0, 0.0, 1.0]]) + [1.3, 1.2, 0.4]
    x = np.vstack([CUBE, other])
    forces = [
        {"kind": "rigid_body", "particles": range(16), "group": [0] * 8 + [1] * 8},
        {"kind": "concentric", "particles": [[3, 7, 8, 12]]},
    ]
    found = relax(Scene.read({"particles": x, "forces": forces, "anchors": [{"particles": range(8)}],
                              "settings": {"tolerance": 1e-9}}))  # fmt: skip
    assert found.converged and found.energy["total"] < 1e-12
    assert np.abs(found.particles[[8, 12], :2] - 0.5).max() < 1e-7
    assert found.force("concentric")["distance"].max() < 1e-7
    assert (found.stability, found.soft_modes) == ("mechanism", 2)


@pytest.mark.parametrize("off", [0.0, 1e2, 1e4, 1e6])
@pytest.mark.parametrize("kind", ["concentric", "align_faces"])
def test_stability_is_the_same_far_from_the_origin(kind: str, off: float) -> None:
    """Two axes of 12 coordinates on one line, which takes 4, leave 16 motions of two pairs; two faces of 18 in one
    plane, which takes 3, leave 15."""
    x = np.vstack([CUBE, 0.8 * CUBE + [0.2, 0.1, 0.75]]) + off
    particles = [[0, 1, 2, 5], [8, 9, 10, 13]] if kind == "concentric" else [[0, 1, 2, 8, 9, 10]]
    found = relax(Scene.read({"particles": x, "forces": [{"kind": kind, "particles": particles}]}))
    assert found.converged
    assert (found.stability, found.soft_modes) == ("mechanism", 16 if kind == "concentric" else 15)
