"""Angles between lines: a two-bar linkage against a moment, couples of lines that do not meet, parallel lines."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hookean import InputError, Scene, relax
from hookean.forces import Angle, Force
from hookean.system.system import compile

DOTTIE = 0.7390851332151607  # the fixed point of the cosine


def evaluate(x: Any, force: Force) -> tuple[np.ndarray, np.ndarray, float]:
    """Forces, lumped stiffness and energy of one force at `x`."""
    system = compile(Scene(particles=x, forces=[force]))
    f, w, energy = system.evaluate(system.start())
    return f, w, float(energy.sum())


def linkage(load: float, apart: bool = False, **columns: Any) -> Any:
    """A bar of length 1 along x that turns about its start, and a held one along x: joined to it, or elsewhere.

    The angle starts at 0.3; the load acts along z on the end of the bar, whose spring stretches by 2 P / k = 2e-8.
    """
    start = [np.cos(0.3), 0.0, np.sin(0.3)]
    held = [[-4, 3, 1], [-2.5, 3, 1]] if apart else [[-1, 0, 0], [0, 0, 0]]
    return relax(
        Scene(
            particles=[*held, [0, 0, 0], start],
            forces=[
                {"kind": "angle", "particles": [[0, 1, 2, 3]], "name": "joint", **columns},
                {"kind": "springs", "particles": [[2, 3]], "stiffness": 1e8, "damping": 0.0},
                {"kind": "unary", "particles": [3], "vector": [0.0, 0.0, load]},
            ],
            anchors=[{"particles": [0, 1, 2]}],
            settings={"tolerance": 1e-9, "solver": "newton"},
        )
    )


@pytest.mark.parametrize("apart", [False, True])
@pytest.mark.parametrize("size", [1.0, 7.0])
def test_a_loaded_bar_turns_to_the_root_of_theta_equals_cos_theta(apart: bool, size: float) -> None:
    """S theta = P l cos theta with S = P l: theta = 0.739085, whether or not the lines meet."""
    found = linkage(size, apart, rest_angle=0.0, strength=size)
    joint = found.force("joint")
    assert found.converged
    assert joint["angle"][0] == pytest.approx(DOTTIE, abs=1e-7)
    assert joint["moment"][0] == pytest.approx(size * DOTTIE, abs=1e-6)


def test_both_lines_have_the_same_moment_as_couples() -> None:
    """At right angles, lengths 2 and 5, S (pi/2 - 0.2) = M: forces M / l at each end, towards each other."""
    x = [[0, 0, 0], [2, 0, 0], [7, 1, 0], [7, 6, 0]]
    f, _, energy = evaluate(x, Angle(particles=[[0, 1, 2, 3]], strength=3.0, rest_angle=0.2))
    moment = 3.0 * (np.pi / 2 - 0.2)
    a, b = moment / 2.0, moment / 5.0
    assert f == pytest.approx(np.array([[0, -a, 0], [0, a, 0], [-b, 0, 0], [b, 0, 0]]), abs=1e-14)
    assert energy == pytest.approx(0.5 * moment**2 / 3.0, rel=1e-14)


@pytest.mark.parametrize("angle", [0.0, 1e-9, 0.5, np.pi / 2, 3.0, np.pi - 1e-9, np.pi])
def test_the_energy_is_that_of_the_angle_from_0_to_pi(angle: float) -> None:
    """S (angle - 1)^2 / 2; by default the start angle is at rest."""
    x = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 2.0], [3 * np.cos(angle), 3 * np.sin(angle), 2.0]])
    _, _, energy = evaluate(x, Angle(particles=[[0, 1, 2, 3]], strength=4.0, rest_angle=1.0))
    assert energy == pytest.approx(2.0 * (angle - 1.0) ** 2, rel=1e-12)
    f, _, energy = evaluate(x, Angle(particles=[[0, 1, 2, 3]]))
    assert np.abs(f).max() == 0.0 and energy == 0.0


@pytest.mark.parametrize("straight", [0.0, np.pi])
def test_parallel_lines_at_rest_are_as_stiff_as_others(straight: float) -> None:
    """At an angle of 0 or pi the tangent is that of E = S |across|^2 / (2 l^2) for small motions across: S / l^2."""
    x = [[0, 0, 0], [1, 0, 0], [4, 0, 0], [4 + 2 * np.cos(straight), 0, 0]]
    scene = Scene(particles=x, forces=[Angle(particles=[[0, 1, 2, 3]], strength=6.0, rest_angle=straight)])
    system = compile(scene)
    state, (group,) = system.start(), system.groups
    (block,) = system.stiffness_blocks(group, state, state.memory[0])
    assert block[9:, 9:] == pytest.approx(np.diag([0.0, 1.5, 1.5]), abs=1e-12)
    assert block[3:6, 9:] == pytest.approx(-np.cos(straight) * np.diag([0.0, 3.0, 3.0]), abs=1e-12)


def test_parallel_lines_with_another_rest_angle_stay() -> None:
    """They have no plane to turn in: no force; a line of zero length has no angle at all."""
    x = [[0, 0, 0], [1, 0, 0], [4, 0, 0], [6, 0, 0]]
    f, _, energy = evaluate(x, Angle(particles=[[0, 1, 2, 3]], strength=2.0, rest_angle=1.0))
    assert (f == 0.0).all() and energy == 1.0
    f, w, energy = evaluate([*x[:3], x[2]], Angle(particles=[[0, 1, 2, 3]], strength=2.0, rest_angle=1.0))
    assert not f.any() and not w.any() and energy == 0.0


@pytest.mark.parametrize(("given", "shown"), [(-0.1, "-0.1"), (3.2, "3.2"), (90, "90")])
def test_angles_that_lines_cannot_have_are_refused(given: float, shown: str) -> None:
    said = f"/forces/0/rest_angle: {shown} given; angles from 0 to pi allowed, in radians"
    with pytest.raises(InputError, match=said):
        linkage(1.0, rest_angle=given)
