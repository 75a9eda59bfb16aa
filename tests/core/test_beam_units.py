"""The same structure of beams in other units: as many iterations, and the same shape."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hookean import Scene, relax
from hookean.running.result import Result

Spec = dict[str, Any]
TUBE = {"A": 1.49e-3, "Iy": 1.69e-6, "Iz": 1.69e-6, "J": 3.38e-6}
POWER = {"A": 2, "Iy": 4, "Iz": 4, "J": 4}


def tower(length: float, force: float, **settings: Any) -> Spec:
    """Three storeys of steel tubes under weight and wind, with a torque and a stay; in units that are `length` times
    smaller than metres and `force` times smaller than newtons."""
    x = [[a, b, 3.0 * level] for level in range(4) for a, b in ((0, 0), (5, 0), (5, 4), (0, 4))]
    up = [[i, i + 4] for i in range(12)]
    round_ = [[4 * level + i, 4 * level + (i + 1) % 4] for level in (1, 2, 3) for i in range(4)]
    section = {name: value * length ** POWER[name] for name, value in TUBE.items()}
    moduli = {"E": 210e9 * force / length**2, "G": 81e9 * force / length**2}
    particles = [*range(4, 16)]
    return {
        "particles": (length * np.array([*x, [9.0, 0, 0]])).tolist(),
        "forces": [
            {"kind": "beam", "particles": up + round_, **moduli, **section},
            {"kind": "springs", "particles": [[13, 16]], "axial_stiffness": 1e6 * force, "force": 2e3 * force},
            {"kind": "unary", "particles": particles, "vector": [800.0 * force, 0, -2e3 * force]},
            {"kind": "unary", "particles": [12], "vector": [0, 0, 0], "moment": [0, 0, 500.0 * force * length]},
        ],
        "anchors": [{"particles": [0, 1, 2, 3], "rotations": "xyz"}, {"particles": [16]}],
        "settings": {"tolerance": 1e-10, **settings},
    }


def solved(length: float, force: float, **settings: Any) -> tuple[Result, np.ndarray, np.ndarray]:
    """The result, and its particles and reactions in metres and newtons."""
    found = relax(Scene.read(tower(length, force, **settings)))
    assert found.converged
    return found, found.particles / length, np.asarray(found.reactions["force"]) / force


@pytest.mark.parametrize("solver", ["auto", "newton", "relaxation"])
def test_a_frame_is_the_same_to_the_bit_in_units_of_powers_of_four(solver: str) -> None:
    """Multiplying by a power of two only changes exponents, and by one of four those of square roots, too: without a
    number in the engine that has a unit, nothing else changes."""
    wanted, x, pulls = solved(1.0, 1.0, solver=solver)
    for length, force in ((4.0**5, 1.0), (4.0**2, 4.0**-3), (1.0, 4.0**-5)):
        found, there, pulled = solved(length, force, solver=solver)
        assert found.iterations == wanted.iterations
        np.testing.assert_array_equal(there, x)
        np.testing.assert_array_equal(pulled, pulls)


def test_metres_and_millimetres_take_the_same_steps() -> None:
    """N and m, N and mm, kN and m: a factor of 1000 rounds, by 1e-16 of each number, which a tower that is 1e4 times
    stiffer along its tubes than across turns into 1e-12."""
    wanted, x, _ = solved(1.0, 1.0)
    for length, force in ((1e3, 1.0), (1.0, 1e-3), (1e3, 1e-3)):
        found, there, _ = solved(length, force)
        assert found.iterations == wanted.iterations < 20
        np.testing.assert_allclose(there, x, atol=1e-11)
