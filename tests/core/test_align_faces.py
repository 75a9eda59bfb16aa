"""Faces that come into one plane: rigid bodies face to face, and what a load and a moment do to a pair."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from hookean import Scene, relax

CUBE = np.array([[i & 1, i >> 1 & 1, i >> 2] for i in range(8)]) - 0.5
TOP, BOTTOM = [4, 5, 6], [0, 2, 1]  # corners in turn about the outward normal


@pytest.mark.parametrize(("flip", "height"), [(False, 1.0), (True, 0.0)])
def test_a_tilted_cube_comes_to_lie_on_a_held_one(flip: bool, height: float) -> None:
    """Its bottom on the other's top with opposite normals: its centre is 1 above; with equal normals it hangs from the
    plane with its top, beside the other. It may slide and turn in the plane: three motions."""
    turn = Rotation.from_euler("xyz", [0.3, -0.4, 0.2]).as_matrix()
    other = CUBE @ turn.T + [2.0, 0.3, height + 0.4]
    face = [8 + i for i in (TOP if flip else BOTTOM)]
    forces = [
        {"kind": "rigid_body", "particles": range(16), "group": [0] * 8 + [1] * 8},
        {"kind": "align_faces", "particles": [TOP + face], "flip": flip},
    ]
    found = relax(Scene.read({"particles": np.vstack([CUBE, other]), "forces": forces,
                              "anchors": [{"particles": range(8)}], "settings": {"tolerance": 1e-9}}))  # fmt: skip
    assert found.converged and found.energy["total"] < 1e-12
    assert found.particles[8:].mean(axis=0)[2] == pytest.approx(height, abs=1e-6)
    assert found.particles[face, 2] == pytest.approx([0.5] * 3, abs=1e-6)
    assert (found.stability, found.soft_modes) == ("mechanism", 3)
    told = found.force("align_faces")
    assert told["distance"].max() < 1e-6 and told["angle"].max() < 1e-6


def test_a_force_moves_the_other_face_by_its_part_of_the_stiffness() -> None:
    """F / k along the normal: both faces feel half of it."""
    x = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 0], [0, 1, 0], [1, 0, 0.0]]
    force = {"kind": "align_faces", "particles": [range(6)], "strength": 200.0}
    load = {"kind": "unary", "particles": [3, 4, 5], "vector": [0, 0, 1.0]}
    held = [{"particles": [0, 1, 2]}, {"particles": [3, 4, 5], "axes": "xy"}]
    found = relax(Scene.read({"particles": x, "forces": [force, load], "anchors": held,
                              "settings": {"tolerance": 1e-10}}))  # fmt: skip
    assert found.converged and found.particles[3:, 2] == pytest.approx([3.0 / 200.0] * 3, abs=1e-9)


def test_a_moment_turns_the_other_face_by_its_part_of_the_moment() -> None:
    """M1 / M, sin of the angle: -dE/da of M (1 - cos a)."""
    x = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 0], [0, 1, 0], [1, 0, 0.0]])
    force = {"kind": "align_faces", "particles": [range(6)], "strength": 0.0, "moment": 50.0}
    load = {"kind": "unary", "particles": [5], "vector": [0, 0, 3.0]}
    held = [{"particles": [0, 1, 2, 3, 4]}, {"particles": [5], "axes": "xy"}]
    found = relax(Scene.read({"particles": x, "forces": [force, load], "anchors": held,
                              "settings": {"tolerance": 1e-10}}))  # fmt: skip
    rise = float(found.particles[5, 2])
    # E = M (1 - cos atan z) - F z: F = M z / (1 + z^2)^(3/2)
    assert found.converged and 50.0 * rise / (1.0 + rise**2) ** 1.5 == pytest.approx(3.0, rel=1e-8)
