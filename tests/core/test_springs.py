"""Springs that yield: the loop of an elastic and perfectly plastic spring, and its limit as a length or as a part."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hookean import InputError, Scene
from hookean.system.system import compile

STIFFNESS, REST, LIMIT, AMPLITUDE = 200.0, 1.0, 0.03125, 0.25


def tensions(path: np.ndarray, **columns: Any) -> np.ndarray:
    """The tension of a spring at each length of a path, with what it has remembered so far."""
    spring = {"kind": "springs", "particles": [[0, 1]], "stiffness": STIFFNESS, "rest_length": REST, **columns}
    system = compile(Scene(particles=[[0, 0, 0], [REST, 0, 0]], forces=[spring]))
    state, found = system.start(), []
    for length in path:
        state.x[1, 0] = length
        system.remember(state)
        found.append(system.evaluate(state)[0][0, 0])
    return np.array(found)


def cycle() -> np.ndarray:
    """Once out and back and out again, in steps that divide the limit."""
    quarter = np.arange(0, 8 * 8 + 1) / 64.0 * AMPLITUDE  # of 1/256, an eighth of the limit
    out = REST + quarter
    return np.concatenate([out, out[::-1][1:], REST - quarter[1:], (REST - quarter)[::-1][1:], out[1:]])


def test_the_loop_of_a_yielding_spring_has_the_area_4_k_l_times_a_minus_l() -> None:
    """Tension between +-k L, elastic over 2 L after each turn: a parallelogram of height 2 k L and width 2 (A - L).

    All corners are on steps, so that the trapezoidal rule is exact, to rounding.
    """
    path = cycle()
    tension = tensions(path, yield_extension=LIMIT)
    turn = 64  # the first time at the largest length; from there a whole loop
    work = np.trapezoid(tension[turn:], path[turn:])
    assert [tension.max(), -tension.min()] == pytest.approx([STIFFNESS * LIMIT] * 2, rel=1e-13)
    assert path[turn] == path[-1] == path.max()
    assert work == pytest.approx(4.0 * STIFFNESS * LIMIT * (AMPLITUDE - LIMIT), rel=1e-12)


def test_below_its_yield_extension_a_spring_is_elastic() -> None:
    path = REST + (cycle() - REST) * LIMIT / AMPLITUDE
    assert tensions(path, yield_extension=LIMIT) == pytest.approx(STIFFNESS * (path - REST), abs=1e-12)


def test_a_length_is_the_same_as_a_part_of_the_rest_length() -> None:
    """To the bit; a length of 0 leaves plasticity, and another one replaces it."""
    path = cycle()
    part = tensions(path, plasticity=LIMIT / (0.5 * REST), rest_factor=0.5)
    assert (part == tensions(path, yield_extension=LIMIT, rest_factor=0.5)).all()
    assert (part == tensions(path, yield_extension=[LIMIT], plasticity=0.7, rest_factor=0.5)).all()
    assert (part != tensions(path, yield_extension=2.0 * LIMIT, rest_factor=0.5)).any()


def test_a_negative_yield_extension_is_refused() -> None:
    with pytest.raises(InputError, match=r"/forces/0/yield_extension: -0.1 given; at least 0 allowed"):
        tensions(cycle(), yield_extension=-0.1)
