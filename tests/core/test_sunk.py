"""No equilibrium has a particle below a floor, whichever solver finds it and wherever it starts."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import hookean
from hookean import Scene
from hookean.system.system import compile

AXIAL, LOAD = 500.0, 400.0


def pressed(load: float = LOAD, floor: dict[str, Any] | None = None, **more: Any) -> Scene:
    """Two bars between supports 0.2 above a floor, drawn 0.5 above it, with a load that presses their joint down."""
    return Scene.read(
        {
            "particles": [[0, 0, 0.2], [1, 0, 0.5], [2, 0, 0.2]],
            "forces": [
                {"kind": "springs", "particles": [[0, 1], [1, 2]], "axial_stiffness": AXIAL},
                {"kind": "floor", **(floor or {})},
                {"kind": "unary", "name": "push", "particles": [1], "vector": [0, 0, -load]},
            ],
            "anchors": [{"particles": [0, 2]}],
            **more,
        }
    )


def carried() -> float:
    """What the floor carries: the load, and the push of both bars, which are as long as drawn without force."""
    rest, length = np.hypot(1.0, 0.3), np.hypot(1.0, 0.2)
    return float(LOAD + 2.0 * AXIAL * (rest - length) / rest * 0.2 / length)


@pytest.mark.parametrize("form", ["find", "drawn"])
def test_a_load_case_presses_onto_a_floor_and_not_through_it(form: str) -> None:
    """By Newton steps from the form, which see no floor, it would come to rest a metre below."""
    scene = pressed(load_cases={"push": {"forces": ["push"]}}, stages={"form": form})
    found = hookean.load_cases(scene).cases["push"].result
    assert found.converged and found.particles[1, 2] == pytest.approx(0.0, abs=1e-9)
    assert found.contacts["particles"].tolist() == [1]
    assert found.contacts["force"][0, 2] == pytest.approx(carried(), rel=1e-6)


@pytest.mark.parametrize("solver", ["auto", "relaxation", "momentum"])
def test_solvers_that_know_floors_come_to_rest_on_them(solver: str) -> None:
    found = hookean.relax(pressed(settings={"solver": solver}))
    assert found.converged and found.particles[1, 2] == pytest.approx(0.0, abs=1e-9)
    assert found.contacts["force"][0, 2] == pytest.approx(carried(), rel=1e-6)


def test_newton_steps_alone_end_before_a_floor() -> None:
    """They do not converge, and name the way; a floor that is out of reach does not hinder them."""
    found = hookean.relax(pressed(settings={"solver": "newton"}))
    assert str(found.status) == "stalled" and found.particles[1, 2] >= 0.0
    assert "Newton steps end where a particle comes to a floor: use auto" in found.message
    free = hookean.relax(pressed(floor={"point": [0, 0, -3]}, settings={"solver": "newton"}))
    assert free.converged and free.particles[1, 2] < -1.0


def test_how_deep_a_particle_lies_is_known_of_those_that_can_move() -> None:
    """Particle 1 half a metre straight below a floor that leans by 3 in 5; those that are held may be where they are,
    and on the floor, or less than 1e-9 of the model below it, none is too deep."""
    system = compile(pressed(floor={"point": [0, 0, 1.0], "normal": [3, 0, 4]}))
    state = system.start()
    for height, depth in ((-0.25, 0.4), (0.25 - 1e-10, 0.0), (0.25, 0.0), (2.0, 0.0)):  # the floor is at 0.25 there
        state.x[1] = [1.0, 0.0, height]
        deepest, found = system.sunk(state)
        assert found == pytest.approx(depth, rel=1e-9) and deepest == (1 if depth else -1)
    assert compile(pressed(floor={"point": [0, 0, 0.3]})).sunk(state) == (-1, 0.0)
