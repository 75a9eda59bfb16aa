"""Bouncy: it swings as its formula says, rebounds from floors, and rests where Newton's steps do."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hookean import Scene, relax
from hookean.solvers import solver
from hookean.system.state import State
from hookean.system.system import System, compile


def begun(spec: dict[str, Any], **settings: Any) -> tuple[System, State]:
    """A scene for bouncy, at its start."""
    system = compile(Scene.read({**spec, "settings": {"solver": "bouncy", **settings}}))
    return system, system.start()


def stepped(system: System, state: State, count: int) -> None:
    """So many iterations, and no early end."""
    assert solver("bouncy").advance(system, state, count, 0.0) == count


@pytest.mark.parametrize(("drag", "kept"), [(1.0, 0.995 / 1.005), (0.0, 1.0), (100.0, 0.5 / 1.5)])
def test_a_particle_swings_as_the_powers_of_its_matrix(drag: float, kept: float) -> None:
    """d = -(k / w) x, v' = kept (v + d - d0) + d, x' = x + v': linear, for a spring of rest length 0. Another as stiff
    is in the way, so that the particle feels a fifth of the stiffness it weighs, and swings longer."""
    spec = {
        "particles": [[0, 0, 0], [1, 2, 3], [1, 2, 3]],
        "forces": [
            {"kind": "springs", "particles": [[0, 1]], "stiffness": 7.0, "rest_length": 0.0},
            {"kind": "springs", "particles": [[1, 2]], "stiffness": 28.0, "rest_length": 0.0},
        ],
        "anchors": [{"particles": [0]}],
    }
    system, state = begun(spec, drag=drag)
    _, w, _ = system.evaluate(state)
    stiffness = np.array([[35.0, -28.0], [-28.0, 28.0]]) / w[1:, None]
    one, none = np.eye(2), np.zeros((2, 2))
    faster = np.hstack([-(1.0 + kept) * stiffness, kept * one, -kept * one])
    matrix = np.vstack([faster + np.hstack([one, none, none]), faster, np.hstack([-stiffness, none, none])])
    stepped(system, state, 20)
    expected = (np.linalg.matrix_power(matrix, 20) @ [1.0, 1.0, 0.0, 0.0, 0.0, 0.0])[:2]
    np.testing.assert_allclose(state.x[1:], np.outer(expected, [1.0, 2.0, 3.0]), atol=1e-12)
    stepped(system, state, 20)
    assert bool(state.x[2, 0] < -0.2) == (drag < 2.0)  # with little drag it overshoots


def test_a_ball_rises_to_the_square_of_the_restitution() -> None:
    """A load weighs 1, so the fall is that of g = 0.001 an iteration; path and rebound are exact within the step."""
    spec = {"particles": [[0, 0, 2]], "forces": [{"kind": "unary", "particles": [0], "vector": [0, 0, -1e-3]}]}
    system, state = begun(spec, drag=0.0, floor={"restitution": 0.8})
    heights = []
    for _ in range(170):
        stepped(system, state, 1)
        heights.append(float(state.x[0, 2]))
    after = heights[63:]  # it hits at sqrt(2 h / g) = 63.2 and is highest at 63.2 (1 + 0.8) = 113.8
    # the first iteration moves by 2 g, not g / 2: it hits 1.5 iterations earlier, and is highest 1.5 (1 + 0.8) earlier
    # or later; a speed of 1.5 g more is a height of 1.1 g, and the top is between two iterations, at most g / 8 below
    assert max(after) == pytest.approx(0.64 * 2.0, abs=2e-3)
    assert np.argmax(after) + 64 == pytest.approx(113.8, abs=4.0)


def test_what_jumps_comes_to_rest() -> None:
    """Before a corner of a curve the pull jumps from one line to the other, which adds to a swing at each crossing: a
    stiff particle there would swing for ever if drag alone ended it."""
    spec = {
        "particles": [[0.0, 1e-3, 0.0], [1.0, 1.0, 0.0]],
        "forces": [
            {"kind": "anchor_spring", "particles": [0], "targets": [[0, 0, 0]], "strength": 1e4},
            {
                "kind": "pull_to_curve",
                "points": [[0.0, 1e-3, 0.0]],
                "curve": [[0, 1, 0], [1, 0, 0], [0, -1, 0]],
                "strength": 1.0,
            },
        ],
        "anchors": [{"particles": [1]}],
    }
    assert relax(Scene.read({**spec, "settings": {"solver": "bouncy", "max_iterations": 2_000}})).converged


def test_soft_and_stiff_springs_of_one_chain_rest_as_by_newton() -> None:
    """Strengths from 1 to 1e6. A residual of 1e-9 of loads of 0.5 moves what is as soft as 1 by some 1e-8."""
    x = np.column_stack([np.linspace(0.0, 10.0, 13), np.zeros((13, 2))])
    spec = {
        "particles": x,
        "forces": [
            {"kind": "springs", "particles": [[i, i + 1] for i in range(12)], "stiffness": np.logspace(0, 6, 12)},
            {"kind": "unary", "particles": range(1, 12), "vector": [0, 0, -0.5]},
        ],
        "anchors": [{"particles": [0, 12]}],
    }
    settings = {"tolerance": 1e-9, "max_iterations": 1_000_000}
    found, exact = (
        relax(Scene.read({**spec, "settings": {"solver": name, **settings}})) for name in ("bouncy", "newton")
    )
    assert found.converged and exact.converged
    np.testing.assert_allclose(found.particles, exact.particles, atol=1e-6)


def test_a_soft_rod_that_nothing_holds_comes_to_rest_straight() -> None:
    """The slowest swing of a free rod of 20 lines is some (4.73 / 20)^2 / 4 = 1 / 70 radians an iteration, which drag
    halves in 140: rest at 1e-6 is a few thousand away. In physical time it is further by the mass over the strength."""
    along = np.linspace(0.0, 1.0, 21)
    x = np.column_stack([10.0 * along, 0.5 * np.sin(3.0 * along), 0.3 * np.cos(5.0 * along)])
    forces = [
        {"kind": "springs", "particles": [[i, i + 1] for i in range(20)], "stiffness": 10.0},
        {"kind": "bend", "particles": [[i, i + 1, i + 2] for i in range(19)], "stiffness": 10.0, "rest_angle": 0.0},
    ]
    found = relax(Scene.read({"particles": x, "forces": forces, "settings": {"solver": "bouncy"}}))
    assert found.converged and found.iterations < 10_000
    lines = np.diff(found.particles, axis=0)
    way = lines / np.linalg.norm(lines, axis=1)[:, None]
    # a moment of 1e-6 of the first ones, which were 10 times angles below 0.1, is left at most; 19 of them add up
    np.testing.assert_allclose(way, np.tile(way[0], (20, 1)), atol=1e-4)
