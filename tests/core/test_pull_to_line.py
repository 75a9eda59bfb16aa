"""Pulls to lines: what they share with planes is in test_pull_to_plane; here a bead on a wire."""

from __future__ import annotations

import numpy as np
import pytest

from hookean import Scene, relax


def test_a_bead_slides_along_its_wire_to_the_lowest_energy() -> None:
    """A bead on the z axis with a spring of rest length 0 to (3, 0, 4), stiffness c: across it rests at
    3 c / (k + c), along it at the height of the spring's end."""
    strength, spring = 90.0, 10.0
    forces = [
        {"kind": "pull_to_line", "particles": [1], "strength": strength},
        {"kind": "springs", "particles": [[0, 1]], "stiffness": spring, "rest_length": 0.0},
    ]
    x = [[3.0, 0.0, 4.0], [0.5, 0.5, 0.0]]
    found = relax(Scene(particles=x, forces=forces, anchors=[{"particles": [0]}], settings={"tolerance": 1e-12}))
    assert found.converged
    assert found.particles[1] == pytest.approx([3.0 * spring / (strength + spring), 0.0, 4.0], abs=1e-10)
    assert np.abs(found.forces[0]["force"][0, 2]) < 1e-12
