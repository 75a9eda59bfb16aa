"""Directions: lines turn parallel to a vector or to the nearest axis, and may slide and stretch along it."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hookean import InputError, Scene, relax

START = np.array([[0.0, 0.0, 0.0], [0.4, 1.3, -0.7]])


def turned(load: Any = (0, 0, 0), **columns: Any) -> Any:
    """A line from an anchor with a load at its end, and a soft anchor (S = 10) where its end starts."""
    return relax(
        Scene(
            particles=START,
            forces=[
                {"kind": "direction", "particles": [[0, 1]], "stiffness": 30.0, **columns},
                {"kind": "anchor_spring", "particles": [1], "targets": START[1:], "strength": 10.0},
                {"kind": "unary", "particles": [1], "vector": load},
            ],
            anchors=[{"particles": [0]}],
            settings={"tolerance": 1e-11},
        )
    )


@pytest.mark.parametrize("direction", [None, [0, 1, 0], [0, -2, 0], [1, 1, 0.5]])
@pytest.mark.parametrize("load", [(0, 0, 0), (3.0, -2.0, 5.0)])
def test_the_end_moves_along_the_direction_as_if_it_were_free(direction: Any, load: Any) -> None:
    """The force is linear. Along d only the soft anchor acts: 10 (l - l0) = P; across it both: 40 l = 10 l0 + P.

    Without a direction d is the axis nearest to the start, y.
    """
    found = turned(load, **({} if direction is None else {"direction": direction}))
    d = np.array([0.0, 1.0, 0.0] if direction is None else direction, dtype=float)
    d /= np.linalg.norm(d)
    push = 10.0 * START[1] + load
    expected = push @ d * d / 10.0 + (push - push @ d * d) / 40.0
    offset = expected - expected @ d * d
    assert found.converged
    assert found.particles[1] == pytest.approx(expected, abs=1e-9)
    assert found.forces[0]["offset"][0] == pytest.approx(np.linalg.norm(offset), abs=1e-9)
    assert found.forces[0]["force"][0] == pytest.approx(-30.0 * offset, abs=1e-7)


def test_the_ends_of_a_line_have_opposite_forces() -> None:
    """The anchor at its start carries what the soft anchor and the load put on its end."""
    found = turned((1.0, 2.0, 3.0))
    pulled = 10.0 * (START[1] - found.particles[1])
    assert found.reactions["force"].sum(axis=0) == pytest.approx(-pulled - [1.0, 2.0, 3.0], abs=1e-8)


def test_a_direction_of_zero_length_is_refused() -> None:
    with pytest.raises(
        InputError, match="/forces/0/direction: a vector of zero length given; give one that is not 0, 0, 0"
    ):
        turned(direction=[0, 0, 0])
    with pytest.raises(InputError, match="/forces/0/direction/1: a vector of zero length"):
        turned(direction=[[1, 0, 0], [0, 0, 0]])
