"""Elastic supports: how far they give way, a beam on an elastic foundation, and what they refuse."""

from __future__ import annotations

import numpy as np
import pytest

from hookean import InputError, relax

from .beam_scenes import load, rotation, row, scene, straight


@pytest.mark.slow
def test_a_support_resists_as_stiff_as_it_is() -> None:
    """A rigid bar on springs: d = F / k at its middle and phi = M / kr; beyond half a turn it pulls the shorter way."""
    rigid = {"E": 1e9, "G": 1e9, "A": 1.0, "Iy": 1.0, "Iz": 1.0, "J": 1.0}
    support = {"kind": "support", "particles": [0], "stiffness": [10, 20, 40], "rotation_stiffness": [5, 5, 5]}
    found = relax(scene(straight(1), [row(1, rigid), support, load(0, (1, 1, 1), (4.0, 0, 0))], [], tolerance=1e-10))
    assert found.particles[0] == pytest.approx([0.1, 0.05, 0.025], abs=1e-7)
    assert rotation(found, 0).as_rotvec() == pytest.approx([0.8, 0.0, 0.0], abs=1e-7)
    assert found.force("support")["moment"][0] == pytest.approx([-4.0, 0.0, 0.0], abs=1e-7)
    with pytest.raises(InputError, match="rotation_stiffness of -1"):
        relax(scene(straight(1), [row(1), {**support, "rotation_stiffness": [-1, 0, 0]}]))
    with pytest.raises(InputError, match="no rotation"):
        relax(scene(straight(1), [{"kind": "springs", "particles": [[0, 1]]}, support]))


def test_a_long_beam_on_an_elastic_foundation() -> None:
    """Hetenyi, Beams on elastic foundation, 1946: under a load P on an infinite beam w = P b / 2k and M = P / 4b,
    b = (k / 4 EI)^1/4 [1/length], k the foundation's stiffness per length. Ends are 6 / b away, where e^-6 is left; a
    foundation in points h apart, and M between them, differ by (b h)^2 / 12 of each and less: 1e-3 at b h = 0.1."""
    count, h, p = 120, 0.1, 1e-3
    springs = {"kind": "support", "particles": list(range(count + 1)), "stiffness": [1.0, 1.0, 4.0 * h]}
    x = straight(count, count * h)  # EI = 1 and k = 4: b = 1
    found = relax(scene(x, [row(count), springs, load(count // 2, (0, 0, -p))], [], tolerance=1e-11))
    assert found.converged
    assert found.particles[count // 2, 2] == pytest.approx(-p / 8.0, rel=3e-3)
    assert np.abs(found.force("beam")["My1"][count // 2 - 1]) == pytest.approx(p / 4.0, rel=3e-3)


def test_targets_are_where_there_is_no_force() -> None:
    """A free beam is drawn to targets a step aside, and has no stress there."""
    step = np.array([0.1, -0.2, 0.3])
    support = {"kind": "support", "particles": [0, 1], "stiffness": [3, 3, 3], "targets": (straight(1) + step).tolist()}
    found = relax(scene(straight(1), [row(1), support], [], tolerance=1e-10))
    assert found.particles == pytest.approx(straight(1) + step, abs=1e-7)
    assert found.force("support")["force"] == pytest.approx(0.0, abs=1e-6)
