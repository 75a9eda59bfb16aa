"""A simulation that begins at a given shape: the same equilibrium, and what anchors hold is held there."""

from __future__ import annotations

import numpy as np
import pytest

import hookean
from hookean import InputError, Scene
from hookean.running.placing import placed, resumed
from serving import CABLE

SCENE = Scene.read(CABLE)


def test_a_result_goes_on_from_its_shape():
    """No particle moves, to the bit, and the shape is in equilibrium as it was."""
    result = hookean.relax(SCENE)
    again = resumed(result)
    assert np.array_equal(again.state.x, result.particles) and again.status == result.status
    assert again.result().residual == result.residual


def test_the_stability_of_a_shape_that_another_run_found_is_known():
    """A cable in tension is stable (its tangent is positive definite), whichever run came to its shape."""
    result = hookean.relax(SCENE)
    simulation = hookean.Simulation(SCENE)
    simulation.relax()
    for found in (resumed(result).result(), simulation.result()):
        assert found.stability == result.stability == "stable" and found.position_error is not None


def test_a_shape_that_is_moved_as_a_whole_rests_as_it_did():
    """Equilibrium does not change by a translation (Newton's first law). Both shapes have residuals below the
    tolerance r = 1e-6; the stiffness of a hanging cable against its load is at least P / l, so positions differ by at
    most r l = 2e-6 m for pieces of l = 2 m, times the five pieces."""
    result = hookean.relax(SCENE)
    shift = np.array([3.0, -2.0, 5.0])
    moved = placed(SCENE, result.particles + shift).relax()
    assert np.abs(moved.particles - shift - result.particles).max() < 1e-5


@pytest.mark.parametrize(
    ("rows", "said"),
    [([[0, 0, 0]], r"give \(6, 3\)"), ([[0, 0, np.inf]] * 6, "not finite"), ("far", "give numbers")],
)
def test_positions_that_are_none_are_refused(rows: object, said: str):
    with pytest.raises(InputError, match=said):
        placed(SCENE, rows)  # type: ignore[arg-type]
