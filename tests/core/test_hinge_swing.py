"""Hinged beams that loads pull far back: they swing past shapes in which a beam has no forces."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import hookean
from hookean import Scene
from hookean.stability.equilibrium import amiss


def chain(particles: Any, load: list[float], solver: str, release: str = "z") -> hookean.Result:
    """Beams in a row from a clamp, hinged at their ends, under a load at the last one's."""
    count = len(particles) - 1
    row: dict[str, Any] = {"kind": "beam", "particles": [[i, i + 1] for i in range(count)], "E": 1000.0, "G": 400.0}
    row |= {"A": 0.5, "Iy": 0.05, "Iz": 0.03, "J": 0.04, "release_end": release, "normal": [0, 0, 1]}
    scene = {
        "particles": particles,
        "forces": [row, {"kind": "unary", "particles": [count], "vector": load}],
        "anchors": [{"particles": [0], "rotations": "xyz"}],
        "settings": {"solver": solver},
    }
    return hookean.relax(Scene.read(scene))


@pytest.mark.parametrize("way", ["auto", "newton", "relaxation", "momentum", "verlet"])
def test_two_hinged_beams_pulled_back_come_to_the_shape_of_least_energy(way: str) -> None:
    """The end of the same two beams in a corotational program with a hinge angle of its own, its energy minimised by
    BFGS: (0.19156, 0.71353, 0.00775), within the square of the slopes of 0.02 of one beam."""
    found = chain([[0, 0, 0], [1, 0.1, 0.2], [2, -0.1, 0.3]], [-1.0, 0.5, 1.0], way)
    assert found.converged and str(found.stability) == "stable"
    np.testing.assert_allclose(found.particles[2], [0.19156, 0.71353, 0.00775], atol=4e-4)


@pytest.mark.parametrize("points", [[[0, 0, 0], [1, 0.1, 0.2], [2, -0.1, 0.3], [3, 0.1, 0.2]], np.eye(4, 3, -1) * 2])
def test_a_chain_of_three_comes_to_the_shape_that_damped_motion_finds(points: Any) -> None:
    # both residuals are below 1e-6 of the load; the softest direction has about the stiffness P / l of a pendulum
    found = [chain(points, [-1.0, 0.2, 0.1], way) for way in ("auto", "verlet")]
    assert all(result.converged and str(result.stability) == "stable" for result in found)
    np.testing.assert_allclose(found[0].particles, found[1].particles, atol=1e-5)


def test_a_beam_that_has_turned_against_itself_is_named_and_no_number_beyond_reason() -> None:
    # pulled back along its line, the chain passes the shape in which its last beam lies on the one before
    result = chain([[0, 0, 0], [1, 0, 0], [2, 0, 0]], [-1.0, 0.001, 0.0], "auto", "yz")
    assert "between particles 0 and 1 (and 1 more) has turned by 180 degrees" in result.message
    assert "e+" not in result.message


def test_a_shape_in_which_a_beam_is_turned_against_itself_is_no_equilibrium() -> None:
    """No force acts there, so forces balance."""
    row = {"kind": "beam", "particles": [[0, 1]], "E": 1000.0, "G": 400.0, "A": 0.5, "Iy": 0.05, "Iz": 0.03, "J": 0.04}
    anchor = {"particles": [0], "rotations": "xyz"}
    scene = Scene.read({"particles": [[0, 0, 0], [1, 0, 0]], "forces": [row], "anchors": [anchor]})
    simulation = hookean.Simulation(scene)
    simulation.state.x[1] = [-1.0, 0.0, 0.0]  # its frame still points along x
    assert simulation.balance.residual == 0.0
    assert simulation.look() is not hookean.Status.CONVERGED
    assert "between particles 0 and 1 has turned" in amiss(simulation.system, simulation.state)


def hinged(
    solver: str = "auto", *, moment: Any = (0, 0.01, 0), vector: Any = (0, 0, 0), **given: Any
) -> hookean.Result:
    """Two beams that meet at a node, which has a moment about y."""
    beam = {"kind": "beam", "E": 1e6, "G": 4e5, "A": 0.01, "Iy": 1e-5, "Iz": 1e-5, "J": 1e-5}
    first = beam | {"particles": [[0, 1]], "release_end": "yz"}
    load = {"kind": "unary", "particles": [1], "vector": vector, "moment": moment}
    anchor = {"particles": [0, 2], "rotations": "xyz"}
    forces = [first, beam | {"particles": [[1, 2]], "release_start": "yz"} | given, load]
    points = [[0, 0, 0], [1, 0, 0], [2, 0, 0]]
    spec = {"particles": points, "forces": forces, "anchors": [anchor], "settings": {"solver": solver}}
    return hookean.relax(Scene.read(spec))


def test_a_moment_where_all_beams_are_hinged_is_named_at_once() -> None:
    result = hinged()
    assert result.status is hookean.Status.STALLED and result.iterations == 0
    assert "Nothing takes the moment (0, 0.01, 0) N m on particle 1" in result.message


@pytest.mark.parametrize("solver", ["auto", "newton", "relaxation", "momentum"])
def test_a_moment_of_rounding_where_all_beams_are_hinged_does_not_count(solver: str) -> None:
    """1e-12 N m beside 100 N, on particles whose rotations are as far from their axes as a beam of 1 m is, 1 m / √12:
    a part of 3.5e-14, below the tolerance."""
    found = hinged(solver, moment=[0, 1e-12, 0], vector=[0, 0, -100])
    assert found.converged, found.message
    assert hinged(solver, moment=[0, 1e-3, 0], vector=[0, 0, -100]).status is hookean.Status.STALLED


def test_a_moment_that_one_beam_takes_is_in_balance() -> None:
    assert hinged(release_start="").converged


def test_a_wire_beside_a_mast_takes_its_moment() -> None:
    """The mast is 1e12 times as stiff against turns; a wire of EI = 7.5e-5 N m² at its end turns by M L / EI."""
    mast = {"kind": "beam", "particles": [[0, 1]], "E": 2e11, "G": 8e10, "A": 0.1, "Iy": 1e-3, "Iz": 1e-3, "J": 2e-3}
    wire = {"kind": "beam", "particles": [[2, 3]], "E": 25e9, "G": 1e10, "A": 2e-7}
    wire |= {"Iy": 3e-15, "Iz": 3e-15, "J": 6e-15}
    load = {"kind": "unary", "particles": [3], "vector": [0, 0, 0], "moment": [0, 1e-5, 0]}
    spec = {"particles": [[0, 0, 0], [0, 0, 5], [10, 0, 0], [11, 0, 0]], "forces": [mast, wire, load]}
    found = hookean.relax(Scene.read({**spec, "anchors": [{"particles": [0, 2], "rotations": "xyz"}]}))
    assert found.converged
    w, _, y, _ = found.rotations["quaternions"][3]
    assert 2.0 * np.arctan2(y, w) == pytest.approx(1e-5 / 7.5e-5, rel=1e-4)
