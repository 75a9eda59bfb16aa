"""A run that is played comes to rest at one iteration, however it is divided and whoever looks at it in between.

Source of the promise: "same input, same numbers, to the bit; no wall clock in physics" (docs/service.md, Sessions).
"""

from __future__ import annotations

import io
import random
from typing import Any

import numpy as np
import pytest

from hookean import Scene, Simulation

SOLVERS = ("verlet", "yoshida", "relaxation", "momentum", "bouncy", "newton", "multilevel")


def net(solver: str, side: int = 6, **settings: Any) -> Scene:
    """A square net without loads, which two lifted corners stretch: its forces alone give the scale of its residual."""
    pairs = [[i * side + j, i * side + j + 1] for i in range(side) for j in range(side - 1)]
    pairs += [[i * side + j, i * side + side + j] for i in range(side - 1) for j in range(side)]
    last = side - 1.0
    return Scene.read(
        {
            "particles": [[float(i), float(j), 0.0] for i in range(side) for j in range(side)],
            "forces": [{"kind": "springs", "particles": pairs, "stiffness": 100, "rest_factor": 0.8}],
            "anchors": [
                {
                    "particles": [0, side - 1, side * side - side, side * side - 1],
                    "targets": [[0, 0, 3], [0, last, 0], [last, 0, 0], [last, last, 3]],
                }
            ],
            "settings": {"solver": solver, "sub_iterations": 7, **settings},
        }
    )


def end(simulation: Simulation) -> tuple[Any, ...]:
    """How a run stands, to the bit."""
    state, found = simulation.state, simulation.balance
    return str(simulation.status), state.iteration, state.x.tobytes(), found.residual


def looked_at(simulation: Simulation) -> None:
    """All that is read of a run while it goes on."""
    frame = simulation.frame()
    assert frame.residual == simulation.balance.residual == simulation.result().residual
    assert simulation.message and simulation.energy is not None
    simulation.save(io.BytesIO())


def kept(simulation: Simulation) -> Simulation:
    """Saved, and loaded again."""
    file = io.BytesIO()
    simulation.save(file)
    return Simulation.load(io.BytesIO(file.getvalue()))


@pytest.mark.slow
@pytest.mark.parametrize("solver", SOLVERS)
def test_the_end_does_not_depend_on_calls_and_looks(solver: str) -> None:
    """In one call; in calls of 1 to 97 iterations with everything read after each; saved and loaded on the way."""
    straight = Simulation(net(solver, tolerance=1e-8))
    assert straight.play(10**6) == "converged"
    for seed in range(3):
        chance = random.Random(seed)
        other = Simulation(net(solver, tolerance=1e-8))
        while other.status == "running":
            other.play(chance.randrange(1, 98))
            looked_at(other)
            if seed == 2 and solver != "multilevel":  # which keeps a tangent of its own between steps
                other = kept(other)
        assert end(other) == end(straight)
        assert seed == 2 or other.message == straight.message  # which counts iterations from where it was loaded


@pytest.mark.parametrize("solver", ["verlet", "relaxation"])
def test_edits_at_the_same_iterations_give_the_same_end(solver: str) -> None:
    """An anchor moved after 60 iterations, and again at rest: by whatever steps the run came there."""
    ends = []
    for seed in (None, 0, 1):
        chance = random.Random(seed)
        run = Simulation(net(solver, tolerance=1e-7))
        while run.state.iteration < 60:
            left = 60 - run.state.iteration
            assert run.play(left if seed is None else min(left, chance.randrange(1, 20))) == "running"
            looked_at(run)
        for height in (1.0, 2.0):
            run.patch({"move": [{"anchor": 0, "shift": [0, 0, height]}]})
            while run.status == "running":
                run.play(10**6 if seed is None else chance.randrange(1, 500))
        ends.append(end(run))
    assert ends[0][0] == "converged" and ends[0] == ends[1] == ends[2]


def test_looking_changes_nothing_that_is_saved() -> None:
    """The state before and after everything was read, array by array; `look` alone judges."""
    simulation = Simulation(net("relaxation"))
    simulation.play(40)
    before = {name: array.copy() for name, array in simulation.state.arrays().items()}
    looked_at(simulation)
    after = simulation.state.arrays()
    assert before.keys() == after.keys()
    assert all(np.array_equal(before[name], after[name]) for name in before)


@pytest.mark.slow
def test_a_run_that_explodes_goes_back_to_one_shape() -> None:
    """A step of time far too long: whoever looks meanwhile, the last good shape is the same, and the sentence, too."""
    scene = net("verlet", time_step=1.0)
    straight = Simulation(scene)
    assert straight.play(10**6) == "diverged" and straight.finite
    chance = random.Random(0)
    other = Simulation(scene)
    while other.status == "running":
        other.play(chance.randrange(1, 30))
        _ = other.balance
    assert (other.state.x.tobytes(), other.state.iteration) == (straight.state.x.tobytes(), straight.state.iteration)
    assert other.message == straight.message
