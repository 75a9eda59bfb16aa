"""A hypar roof from its form to its cases: what snow weighs, what carries it, what is used of the cables' strength."""

from __future__ import annotations

import numpy as np

import hookean

from .hypar_roof import drawn, scene


def test_snow_on_a_roof_weighs_its_plan_and_is_carried_by_the_masts() -> None:
    """The nodal forces of snow add up to q times the plan inside of the edge cables (shoelace formula), to 1e-12; what
    is out of balance is at most 1e-9 of the loads in each of 81 particles, and a cable uses T / (A f)."""
    roof = scene(divisions=8, snow=0.6)
    found = hookean.load_cases(roof, ["ULS snow"])
    case = found.cases["ULS snow"]
    assert case.result.converged
    x = case.result.particles.reshape(9, 9, 3)
    rim = np.concatenate([x[:-1, 0], x[-1, :-1], x[:0:-1, -1], x[0, :0:-1]])[:, :2]
    plan = 0.5 * abs(float(np.sum(rim[:, 0] * np.roll(rim[:, 1], -1) - rim[:, 1] * np.roll(rim[:, 0], -1))))
    snow = case.result.force("snow")["force"].sum(axis=0)
    np.testing.assert_allclose(snow, [0.0, 0.0, -1.5 * 0.6 * plan], rtol=1e-12, atol=1e-12 * plan)
    loads = case.result.loads["resultant"].sum(axis=0)
    reactions = case.result.reactions["force"].sum(axis=0)
    np.testing.assert_allclose(reactions + loads, 0.0, atol=81 * 1e-9 * np.linalg.norm(loads))
    breaks = 0.75 * np.pi * 0.02**2 / 4.0 * 1570e3  # kN
    edge = case.result.force("edge")
    np.testing.assert_allclose(edge["utilisation"], edge["force"] / breaks, rtol=1e-12)
    assert 0.1 < edge["utilisation"].max() < 1.0
    assert case.slack_count == 0


def test_the_roof_is_drawn_as_a_hypar() -> None:
    mesh = drawn(4, 10.0, 3.0)
    assert mesh.vertices[[0, 4, 20, 24], 2].tolist() == [0.0, 3.0, 3.0, 0.0]
