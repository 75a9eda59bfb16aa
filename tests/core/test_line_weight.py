"""Weight per current length: a catenary at any stiffness, which a cable with the weight of its start is not."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hookean import InputError, Scene, relax

WEIGHT, SPAN = 1.5, 2.0


def cable(pieces: int, load: dict[str, Any]) -> Any:
    """A cable of EA = 3 between two points, which its weight stretches by half."""
    x = np.zeros((pieces + 1, 3))
    x[:, 0] = np.linspace(0.0, SPAN, pieces + 1)
    x[:, 2] = 0.1 * x[:, 0] * (x[:, 0] - SPAN)
    pairs = np.column_stack([np.arange(pieces), np.arange(1, pieces + 1)])
    springs = {"kind": "springs", "particles": pairs, "stiffness": 3.0 * pieces / SPAN, "rest_length": SPAN / pieces}
    return relax(
        Scene(
            particles=x,
            forces=[springs, {"particles": pairs, **load}],
            anchors=[{"particles": [0, pieces]}],
            settings={"tolerance": 1e-9},
        )
    )


def missed(found: Any) -> float:
    """How far a cable's sag is from that of the catenary z = a cosh(x / a), a = H / q, with its horizontal force H."""
    a = abs(found.reactions["force"][0, 0]) / WEIGHT
    sag = -found.particles[:, 2].min()
    return float(abs(sag - a * (np.cosh(0.5 * SPAN / a) - 1.0)))


def test_an_elastic_cable_hangs_in_a_catenary() -> None:
    """d(T sin) = q ds holds at any stiffness, so that the shape is H / q cosh, to the square of the pieces' length.

    With the weight of its start length it is not, however fine. Source: Irvine, Cable Structures, 1981, section 1.
    """
    current = [missed(cable(n, {"kind": "line_weight", "weight": WEIGHT})) for n in (16, 32)]
    assert current[1] < current[0] / 3.5 and current[0] < 2e-3
    assert missed(cable(32, {"kind": "self_weight", "per_length": WEIGHT})) > 20.0 * current[1]


def test_each_piece_weighs_its_length() -> None:
    """At every particle H x (change of slope) = q x (mean length beside it); the reactions carry the whole weight."""
    found = cable(8, {"kind": "line_weight", "weight": WEIGHT, "name": "weight"})
    step = np.diff(found.particles, axis=0)
    slope, length = step[:, 2] / step[:, 0], np.linalg.norm(step, axis=1)
    assert found.converged
    across = abs(found.reactions["force"][0, 0])
    assert across * np.diff(slope) == pytest.approx(WEIGHT * 0.5 * (length[1:] + length[:-1]), abs=1e-7)
    weights = found.force("weight")
    assert weights["force"][:, 2] == pytest.approx(-WEIGHT * length, rel=1e-12)
    assert weights["length"] == pytest.approx(length, rel=1e-12)
    assert found.reactions["force"].sum(axis=0) == pytest.approx([0.0, 0.0, WEIGHT * length.sum()], abs=1e-7)


def test_gravity_without_a_direction_is_refused() -> None:
    with pytest.raises(
        InputError, match="/forces/1/direction: a vector of zero length given; give one that is not 0, 0, 0"
    ):
        cable(4, {"kind": "line_weight", "direction": [0, 0, 0]})


def test_per_plan_length_the_cable_is_a_parabola() -> None:
    """Snow q per plan length on a cable with horizontal force H: its particles, wherever they are, lie on the polygon
    z'' = q / H between supports at equal height, so H = q x (L - x) / (2 z) with the same H at each, and the vertical
    reactions are q L / 2."""
    found = cable(16, {"kind": "line_weight", "weight": WEIGHT, "per": "plan"})
    x, z = found.particles[1:-1, 0], found.particles[1:-1, 2]
    pull = abs(found.reactions["force"][0, 0])
    assert found.converged
    assert WEIGHT * x * (SPAN - x) / (-2.0 * z) == pytest.approx(np.full(len(x), pull), rel=1e-6)
    # half of the load of the last pieces lies at the supports
    assert found.reactions["force"][:, 2] == pytest.approx([WEIGHT * SPAN / 2] * 2, rel=1e-8)
