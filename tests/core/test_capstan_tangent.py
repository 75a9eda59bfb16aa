"""Newton steps of cables with friction: their tangent against differences of the forces, and shapes at rest."""

from __future__ import annotations

import numpy as np
import pytest

from hookean import Scene, load_cases, relax
from hookean.compiled import dispatch
from hookean.forces import capstan_tangent
from hookean.forces.capstan import RUN_WAY, TABLE
from hookean.forces.sliding_cable import SlidingCable
from hookean.system.system import compile

STEP = 1e-6


@pytest.mark.thinned
@pytest.mark.parametrize("seed", range(8))
def test_the_tangent_is_the_gradient_of_the_force(seed: int) -> None:
    """Of cables of up to seven lines, given either way round, that slip over most saddles; to 1e-8 of the largest, by
    central differences of step 1e-6. Slips make it unsymmetric."""
    rng = np.random.default_rng(seed)
    count = int(rng.integers(2, 8))
    x = np.cumsum(rng.normal(0.0, 1.0, (count + 1, 3)) + [1.0, 0.0, 0.0], axis=0)
    pairs = np.column_stack([np.arange(count), np.arange(1, count + 1)])
    turned = rng.random(count) < 0.4
    pairs[turned] = pairs[turned, ::-1]
    friction = rng.uniform(0.02, 0.3, count)
    cable = SlidingCable(particles=pairs[:: (-1) ** seed], friction=friction, axial_stiffness=100.0, force=20.0)
    (group,) = compile(Scene(particles=x, forces=[cable])).groups
    y, memory = x + rng.normal(0.0, 0.15, x.shape), rng.normal(0.0, 0.02, (count, 1))
    b, kernel = group.block, dispatch.compiled(group.cls.kernel, "force")
    numeric = np.zeros((x.size, x.size))
    for i in range(x.size):
        sides = []
        for sign in (1.0, -1.0):
            moved, f = y.copy(), np.zeros_like(x)
            moved.flat[i] += sign * STEP
            kernel(moved, np.zeros_like(x), b.indices, b.parameters, memory, f, np.zeros(len(x)))
            sides.append(f.ravel())
        numeric[:, i] = (sides[1] - sides[0]) / (2.0 * STEP)
    ((index, blocks),) = capstan_tangent.tangents(b, memory, y)
    found, at = np.zeros_like(numeric), (3 * index[0][:, None] + np.arange(3)).ravel()
    np.add.at(found, (at[:, None], at), blocks[0])
    np.testing.assert_allclose(found, numeric, atol=1e-8 * np.abs(numeric).max())
    table = np.zeros((count, TABLE))
    dispatch.compiled(capstan_tangent.states)(y, b.indices, b.parameters, memory, table)
    assert table[:, RUN_WAY].any() and np.abs(found - found.T).max() > 1e-3 * np.abs(found).max()


@pytest.mark.parametrize("mu", [0.02, 0.3])
def test_newton_steps_come_to_the_shape_of_relaxation(mu: float) -> None:
    """Twelve lines over eleven loads that slide along verticals: in at most 20 steps, 3e-9 from where relaxation ends,
    which leaves 1e-9 of the forces."""
    turn = np.linspace(0.0, np.pi, 13)
    x = np.column_stack([-3.0 * np.cos(turn), 0.0 * turn, -0.5 * np.sin(turn)])
    forces = [
        {
            "kind": "sliding_cable",
            "particles": [[i, i + 1] for i in range(12)],
            "friction": mu,
            "axial_stiffness": 500.0,
        },
        {"kind": "unary", "particles": range(1, 12), "vector": [[0, 0, -1.5 - 0.15 * i] for i in range(11)]},
    ]
    anchors = [{"particles": [0, 12]}, {"particles": range(1, 12), "axes": "xy"}]
    found = [
        relax(Scene(particles=x, forces=forces, anchors=anchors, settings={"solver": solver, "tolerance": 1e-9}))
        for solver in ("newton", "relaxation")
    ]
    assert all(one.converged and one.stability == "unknown" for one in found)
    assert found[0].iterations <= 20 < found[1].iterations
    np.testing.assert_allclose(found[0].particles, found[1].particles, atol=3e-9 * 6.0)


def test_what_cables_with_friction_carry_balances_in_every_case() -> None:
    """Reactions, elastic supports and loads, forces and moments, to 1e-9 of their size at the default tolerance: cases
    end with whole Newton steps. Friction takes no part from outside."""
    scene = Scene(
        particles=[[0, 0, 0], [1, 0, 1], [3, 0, 1.5], [4, 0, 0]],
        forces=[
            {"kind": "sliding_cable", "particles": [[0, 1], [1, 2], [2, 3]], "axial_stiffness": 1e4, "force": 10.0,
             "friction": 0.15},
            {"kind": "unary", "name": "p", "particles": [1], "vector": [0, 0.5, 3]},
            {"kind": "support", "particles": [1, 2], "stiffness": [100.0, 100.0, 100.0]},
        ],
        anchors=[{"particles": [0, 3]}],
        load_cases={"p": {"forces": ["p"]}},
        combinations={"more": {"p": 4.0}, "back": {"p": -2.0}},
    )  # fmt: skip
    for case in load_cases(scene).cases.values():
        found = case.result
        assert found.converged and found.stability == "unknown"
        at = np.concatenate([found.particles[found.reactions["particles"]], found.particles[[1]]])
        what = np.concatenate([found.reactions["force"], found.loads["resultant"]])
        size = np.abs(what).sum()
        np.testing.assert_allclose(what.sum(axis=0), 0.0, atol=1e-9 * size)
        np.testing.assert_allclose(np.cross(at, what).sum(axis=0), 0.0, atol=4e-9 * size)
