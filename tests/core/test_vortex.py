"""Vortices: equilibrium in a rigid rotation's field, the work of a turn, cutoffs."""

from __future__ import annotations

import numpy as np
import pytest

from hookean import InputError, Scene, relax
from hookean.system.system import compile


def test_an_anchored_particle_is_turned_and_drawn_out() -> None:
    """n = 1: S a x r = k (r - r0). In the plane across a that is (k - i S) r = k r0: turned by atan(S / k) against r0,
    at |r0| / sqrt(1 + (S / k)^2). The motion settles where drag^2 k > m S^2: 10^2 x 50 > 20^2."""
    soft, swirl = 50.0, 20.0
    forces = [
        {"kind": "anchor_spring", "particles": [0], "strength": soft},
        {
            "kind": "vortex",
            "particles": [0],
            "strength": swirl,
            "exponent": 1.0,
            "origin": [1, 2, 9],
            "axis": [0, 0, 5],
        },
    ]
    settings = {"solver": "verlet", "tolerance": 1e-11, "drag": 10.0, "time_step": 0.02, "max_iterations": 20000}
    found = relax(Scene(particles=[[5.0, 2.0, -1.0]], forces=forces, settings=settings))
    turned = 4.0 * soft / (soft - 1j * swirl)
    assert found.converged
    assert found.particles[0] == pytest.approx([1.0 + turned.real, 2.0 + turned.imag, -1.0], abs=1e-10)
    assert found.forces[1]["distance"][0] == pytest.approx(4.0 / np.hypot(1.0, swirl / soft), rel=1e-10)


@pytest.mark.parametrize("exponent", [-2.0, -1.0, 0.0, 1.5])
def test_a_turn_gains_the_circulation(exponent: float) -> None:
    """The force is S d^n along the circle everywhere, so a turn gains 2 pi d S d^n: it has no potential."""
    turn = np.arange(12) * np.pi / 6.0
    axis = np.array([1.0, 2.0, -2.0]) / 3.0
    u = np.array([2.0, 1.0, 2.0]) / 3.0
    rim = 1.5 * (np.cos(turn)[:, None] * u + np.sin(turn)[:, None] * np.cross(axis, u))
    force = {"kind": "vortex", "particles": range(12), "strength": 3.0, "exponent": exponent, "axis": axis}
    system = compile(Scene(particles=rim + 4.0 * axis, forces=[force]))
    f = system.evaluate(system.start())[0]
    assert f == pytest.approx(3.0 * 1.5**exponent * np.cross(axis, rim / 1.5), abs=1e-13 * 3.0 * 1.5 ** abs(exponent))


@pytest.mark.parametrize(("cutoff", "acts"), [(0.0, True), (2.0, True), (0.5, False), (-0.5, True), (-2.0, False)])
def test_a_cutoff_limits_where_it_acts(cutoff: float, acts: bool) -> None:
    """At distance 1: positive below it only, negative above it only; on the axis nothing acts."""
    force = {"kind": "vortex", "particles": [0, 1], "cutoff": cutoff, "exponent": -1}
    system = compile(Scene(particles=[[1.0, 0, 3], [0, 0, 3.0]], forces=[force]))
    f = system.evaluate(system.start())[0]
    assert f.tolist() == [[0.0, 1.0 if acts else 0.0, 0.0], [0.0, 0.0, 0.0]]


def test_bad_input_is_refused() -> None:
    """An axis without direction, an exponent that would overflow."""
    with pytest.raises(InputError, match="/forces/0/axis: a vector of zero length given"):
        Scene(particles=np.eye(3), forces=[{"kind": "vortex", "particles": [0], "axis": [0, 0, 0]}])
    with pytest.raises(InputError, match=r"/forces/0/exponent: 12 given; exponents from -9 to 9 allowed"):
        Scene(particles=np.eye(3), forces=[{"kind": "vortex", "particles": [0], "exponent": 12}])
