"""Soft anchors that slide: the force at which they do, and where their targets are afterwards."""

from __future__ import annotations

from typing import Any

import pytest

from hookean import Scene, relax
from hookean.running.simulation import Simulation

STRENGTH, ROPE = 200.0, 50.0


def pulled(solver: str = "auto", **anchor: Any) -> Scene:
    """A particle held at (4, 0, 0) by a soft anchor, and pulled to the origin by a spring of rest length 0."""
    forces = [
        {"kind": "springs", "particles": [[0, 1]], "stiffness": ROPE, "rest_length": 0.0, "damping": 0.0},
        {"kind": "anchor_spring", "particles": [1], "strength": STRENGTH, **anchor},
    ]
    settings = {"tolerance": 1e-12, "solver": solver}
    return Scene(particles=[[0, 0, 0], [4.0, 0, 0]], forces=forces, anchors=[{"particles": [0]}], settings=settings)


@pytest.mark.parametrize("solver", ["auto", "relaxation", "momentum", "newton"])
@pytest.mark.parametrize("anchor", [{"limit": 0.1}, {"sticky": 20.0}, {"limit": 0.1, "sticky": 35.0}])
def test_an_anchor_slides_at_its_strength_times_its_limit(solver: str, anchor: dict[str, float]) -> None:
    """Beyond its limit its force is S x limit = 20 exactly, so that the spring draws it to 20 / 50 from the origin."""
    found = relax(pulled(solver, **anchor))
    assert found.converged
    assert found.particles[1] == pytest.approx([STRENGTH * 0.1 / ROPE, 0, 0], abs=1e-9)
    assert found.forces[1]["force"][0] == pytest.approx([STRENGTH * 0.1, 0, 0], rel=1e-9, abs=1e-12)


@pytest.mark.parametrize("anchor", [{}, {"limit": 1.0}, {"sticky": 170.0}, {"limit": 0.9, "sticky": 161.0}])
def test_below_its_limit_it_is_elastic(anchor: dict[str, float]) -> None:
    """S (4 - x) = k x: x = 3.2, with a force of 160 at a distance of 0.8, as without any limit."""
    found = relax(pulled(**anchor))
    assert found.converged
    assert found.particles[1] == pytest.approx([3.2, 0, 0], abs=1e-9)


def test_its_target_stays_where_it_slid_to() -> None:
    """Drawn to 0.4 from the origin its target has followed to 0.4 + limit; there it returns once the spring is gone,
    and no nearer to where it was, as it never slides below its limit."""
    simulation = Simulation(pulled(limit=0.1))
    assert simulation.relax().particles[1] == pytest.approx([0.4, 0, 0], abs=1e-9)
    simulation.patch({"forces": {"0": {"stiffness": 0.0}}})
    assert simulation.relax().particles[1] == pytest.approx([0.5, 0, 0], abs=1e-8)
