"""The same input gives the same numbers to the bit: in any process, for any thread count, resumed or not."""

from __future__ import annotations

import io

import numpy as np
import pytest

from hookean import Scene
from hookean.solvers import solver
from hookean.system.state import State
from hookean.system.system import System, compile
from soak import SOAK, THREADS

from .probe import digest, hashes, prepared
from .scenes import FAMILIES, random_scene
from .test_cache import probe

SOLVERS = ("verlet", "yoshida", "relaxation", "momentum", "bouncy")


@pytest.mark.soak
def test_fresh_processes_and_thread_counts_give_the_same_bits() -> None:
    """SHA-256 of shapes after relaxing, momentum steps and 200 Verlet steps: here, there, with 1 or 2 threads."""
    here = hashes()
    assert len(here) >= 3 * len(FAMILIES) and len(set(here.values())) > len(FAMILIES)
    for count in ("1", "2") if SOAK else ("1",):
        assert probe("hashes", PYTHONHASHSEED=count, **dict.fromkeys(THREADS, count)) == here


def saved(state: State) -> State:
    """The state written to a file and read again."""
    file = io.BytesIO()
    np.savez(file, **state.arrays())
    file.seek(0)
    with np.load(file) as arrays:
        return State.of(dict(arrays))


def everything(state: State) -> str:
    """SHA-256 of all arrays of a state."""
    return "".join(f"{name} {digest(array)} " for name, array in sorted(state.arrays().items()))


def advanced(system: System, method: str, pieces: list[int], keep: str) -> State:
    """A run in pieces; between them the state is copied, written to a file, or left alone."""
    state = system.start()
    solver(method).start(system, state)
    for count in pieces:
        solver(method).advance(system, state, count, 0.0)
        state = {"copy": state.copy, "file": lambda s=state: saved(s), "": lambda s=state: s}[keep]()
    return state


def yielding() -> System:
    """Springs that yield and are not damped: what they remember decides the motion."""
    rng = np.random.default_rng(8)
    x = rng.uniform(-1.0, 1.0, (12, 3))
    pairs = np.column_stack([np.repeat(np.arange(12), 3), (np.repeat(np.arange(12), 3) + np.tile([1, 3, 5], 12)) % 12])
    springs = {
        "kind": "springs", "particles": pairs, "stiffness": 200.0, "damping": 0.0, "plasticity": 0.05,
        "rest_factor": 0.6,
    }  # fmt: skip
    return compile(Scene(particles=x, forces=[springs], anchors=[{"particles": [0, 5]}], settings={"drag": 0.0}))


@pytest.mark.thinned
@pytest.mark.parametrize("keep", ["copy", "file", ""])
@pytest.mark.parametrize("method", SOLVERS)
@pytest.mark.parametrize("family", [*FAMILIES, "yielding"])
def test_a_run_in_pieces_is_the_run_in_one(family: str, method: str, keep: str) -> None:
    """200 steps in one go, and in 17 pieces with the state copied or saved between: the same bits everywhere."""
    system = yielding() if family == "yielding" else prepared(random_scene(FAMILIES.index(family)))
    if solver(method).refuse(system):
        method = "verlet"
    whole = advanced(system, method, [200], "")
    pieces = advanced(system, method, [1, 2, 3, *[12] * 13, 38], keep)
    assert whole.iteration == pieces.iteration == 200
    assert everything(whole) == everything(pieces)
    assert not np.array_equal(whole.x, system.x)


def test_one_bit_shows() -> None:
    """Negative control: a start that differs by one part in 1e12 ends in another digest."""
    system = prepared(random_scene(0))
    whole = advanced(system, "verlet", [200], "")
    system.x[3, 0] *= 1.0 + 1e-12
    assert everything(advanced(system, "verlet", [200], "")) != everything(whole)
