"""Newton on nets that are hard for it: compressed, slack, stiff, begun in disorder; and at equilibria to refuse."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hookean import Result, Scene, relax
from hookean.discretize import clothed_vertices, diagonals, edges, grid, naked_vertices
from hookean.stability.time_steps import _scaled_stiffness
from hookean.system.system import compile
from soak import SOAK

Spec = dict[str, Any]
SEEDS = range(20 if SOAK else 2)


def net(kind: str, seed: int) -> Spec:
    """A square net of 8 x 8 particles under a load of 1 on each."""
    side, rng = 8, np.random.default_rng([5, seed])
    mesh = grid(np.arange(side), np.arange(side))
    x = mesh.vertices
    springs = np.concatenate([edges(mesh), *([diagonals(mesh)] if kind in ("sheet", "wrinkled") else [])])
    factor = {"compressed": 1.1, "slack": 1.3, "stiff": 1.0, "disorder": 0.9, "sheet": 0.9, "wrinkled": 1.05}[kind]
    rest = factor * np.linalg.norm(x[springs[:, 1]] - x[springs[:, 0]], axis=1)
    x += rng.normal(size=x.shape) * 1e-3
    if kind == "disorder":
        x[clothed_vertices(mesh)] += rng.normal(size=((side - 2) ** 2, 3)) * 5.0
    held = naked_vertices(mesh) if kind in ("compressed", "wrinkled") else [0, side - 1, side * (side - 1), side**2 - 1]
    return {
        "particles": x,
        "forces": [
            {"kind": "springs", "particles": springs, "stiffness": 1e5 if kind == "stiff" else 100.0,
             "rest_length": rest},
            {"kind": "self_weight", "total": float(side * side)},
        ],
        "anchors": [{"particles": held}],
    }  # fmt: skip


def solved(spec: Spec, solver: str) -> Result:
    """The scene by one solver, to 1e-8."""
    return relax(Scene.read({**spec, "settings": {"solver": solver, "tolerance": 1e-8, "max_iterations": 100_000}}))


def lowest(spec: Spec, x: np.ndarray) -> float:
    """Smallest eigenvalue of the tangent at positions x, by its largest."""
    system = compile(Scene.read(spec))
    state = system.start()
    state.x = x.copy()
    matrix, _, _ = _scaled_stiffness(system, state)
    values = np.linalg.eigvalsh(matrix.toarray())
    return float(values[0] / values[-1])


def energy(found: Result) -> float:
    """Energy of the forces."""
    return sum(value for kind, value in found.energy.items() if kind not in ("kinetic", "total"))


@pytest.mark.slow
@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("kind", ["compressed", "slack", "stiff", "disorder", "sheet"])
def test_newton_finds_the_stable_shape_that_relaxation_finds(kind: str, seed: int) -> None:
    """These have one shape that hangs: energies agree to 1e-8 of their size (a residual of 1e-8 leaves its square),
    and the tangent is definite."""
    spec = net(kind, seed)
    found, slow = solved(spec, "newton"), solved(spec, "relaxation")
    assert found.converged and slow.converged
    size = sum(abs(value) for value in slow.energy.values())
    assert abs(energy(found) - energy(slow)) <= 1e-8 * size
    assert lowest(spec, found.particles) > 0.0
    assert found.iterations < 200


@pytest.mark.slow
@pytest.mark.parametrize("seed", SEEDS)
def test_wrinkles_are_stable_ones(seed: int) -> None:
    """A sheet with more length than its frame has many shapes; the one found has no direction to fall in."""
    spec = net("wrinkled", seed)
    found = solved(spec, "newton")
    assert found.converged
    assert lowest(spec, found.particles) > 0.0


def test_newton_leaves_a_column_pressed_straight() -> None:
    """Two bars in line under a load of 10 along them, k = 100: all forces keep to the line, where at 0.9 long each
    they balance, and the least push would buckle them. What is stable hangs: 1.1 long each, below the foot."""
    spec: Spec = {
        "particles": [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 2.0]],
        "forces": [
            {"kind": "springs", "particles": [[0, 1], [1, 2]], "stiffness": 100.0, "rest_length": 1.0},
            {"kind": "unary", "particles": [2], "vector": [0.0, 0.0, -10.0]},
        ],
        "anchors": [{"particles": [0]}, {"particles": [2], "axes": "xy"}],
    }
    standing = solved(spec, "relaxation")
    assert standing.particles[2, 2] == pytest.approx(1.8) and lowest(spec, standing.particles) < -1e-3
    found = solved(spec, "newton")
    assert found.converged and lowest(spec, found.particles) > 0.0
    assert found.particles[:, 2] == pytest.approx([0.0, -1.1, -2.2], abs=1e-8)


def test_a_net_of_another_free_axis_gets_its_own_pattern() -> None:
    """One solver goes from a held net to one let go at a corner, as after a patch: both as if it had begun there."""
    from hookean.solvers import solver

    spec = net("sheet", 0)
    system = compile(Scene.read(spec))
    method, state = solver("newton"), system.start()
    method.start(system, state)
    method.advance(system, state, 20, 1e-8)
    state.free[0] = [0.0, 0.0, 1.0]
    fresh, again = state.copy(), solver("newton")
    for one, at in ((method, state), (again, fresh)):
        one.start(system, at)
        one.advance(system, at, 20, 1e-8)
    assert np.array_equal(state.x, fresh.x) and state.x[0, 2] < -0.1
