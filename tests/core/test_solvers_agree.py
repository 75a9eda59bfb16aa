"""Solvers agree: on twelve canonical scenes every solver that applies finds the same energy and the same shape."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest

from hookean import Result, Scene, discretize, relax
from hookean.errors import InputError
from hookean.scene.solver_names import SOLVERS
from hookean.solvers import solver
from hookean.stability.time_steps import stable_time_step
from hookean.system.system import System, compile

Spec = dict[str, Any]


def grid(n: int, step: float = 1.0) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Points, edges and rim of an n x n grid."""
    mesh = discretize.grid(np.arange(n) * step, np.arange(n) * step)
    return mesh.vertices, discretize.edges(mesh), discretize.naked_vertices(mesh)


def chain(n: int, **springs: Any) -> Spec:
    """n + 1 particles along x, held at both ends, loaded."""
    x = np.column_stack([np.linspace(0.0, 10.0, n + 1), np.zeros((n + 1, 2))])
    pairs = np.column_stack([np.arange(n), np.arange(1, n + 1)])
    return {
        "particles": x,
        "forces": [
            {"kind": "springs", "particles": pairs, "stiffness": 1000.0, **springs},
            {"kind": "unary", "particles": np.arange(1, n), "vector": [0, 0, -20.0]},
        ],
        "anchors": [{"particles": [0, n]}],
    }


def cable() -> Spec:
    """The chapter's loaded cable: five segments of stiffness 1000, forces of -20."""
    return chain(5)


def arch() -> Spec:
    """A slack cable, 20 segments a tenth longer than its span."""
    return chain(20, rest_factor=1.1, stiffness=5000.0)


def mixed_cable() -> Spec:
    """Stiffnesses of four decades in series."""
    return chain(12, stiffness=10.0 ** np.linspace(2.0, 6.0, 12), rest_factor=1.02)


def force_density_net() -> Spec:
    """Rest length 0 on a saddle: linear, one solve."""
    x, edges, rim = grid(7)
    x[rim, 2] = 0.1 * (x[rim, 0] - 3.0) * (x[rim, 1] - 3.0)
    forces = [{"kind": "springs", "particles": edges, "stiffness": 10.0, "rest_length": 0.0}]
    return {"particles": x, "forces": forces, "anchors": [{"particles": rim}]}


def soft_force_density() -> Spec:
    """Rest length 0 between soft anchors, loaded: linear as well."""
    x, edges, rim = grid(5)
    return {
        "particles": x,
        "forces": [
            {"kind": "springs", "particles": edges, "stiffness": 10.0, "rest_length": 0.0, "damping": 1.0},
            {"kind": "anchor_spring", "particles": rim, "targets": x[rim] * 1.2, "strength": 50.0},
            {"kind": "self_weight", "total": 10.0},
        ],
        "settings": {"drag": 3.0},
    }


def hanging_net() -> Spec:
    """A net hung by four corners."""
    x, edges, _ = grid(6)
    return {
        "particles": x,
        "forces": [
            {"kind": "springs", "particles": edges, "stiffness": 200.0, "rest_factor": 0.9},
            {"kind": "self_weight", "total": 36.0},
        ],
        "anchors": [{"particles": [0, 5, 30, 35]}],
    }


def tent() -> Spec:
    """A pre-stressed net with a mast: no load."""
    x, edges, rim = grid(7)
    targets = x[[24]] + [[0.0, 0.0, 3.0]]
    forces = [{"kind": "springs", "particles": edges, "stiffness": 100.0, "rest_factor": 0.6}]
    return {"particles": x, "forces": forces, "anchors": [{"particles": rim}, {"particles": [24], "targets": targets}]}


def truss() -> Spec:
    """A space truss on four feet, one of them on a roller: nearly linear."""
    low, _, _ = grid(4)
    n = len(low)
    x = np.concatenate([low, low + [0.0, 0.0, 1.0]])
    near = np.linalg.norm(x[:, None] - x[None], axis=2)
    pairs = np.argwhere(np.triu((near > 0) & (near < 1.5)))
    return {
        "particles": x,
        "forces": [
            {"kind": "springs", "particles": pairs, "stiffness": 1e5},
            {"kind": "unary", "particles": np.arange(n, 2 * n), "vector": [0.0, 10.0, -100.0]},
        ],
        "anchors": [{"particles": [0, 3, 12]}, {"particles": [15], "axes": "z"}],
    }


def braced() -> Spec:
    """A plane frame with ties, half of which go slack under a push from the side."""
    x, edges, _ = grid(4)
    x = x[:, [0, 2, 1]]
    number = np.arange(16).reshape(4, 4)
    ties = discretize.diagonals(discretize.grid(np.arange(4), np.arange(4)))
    start = np.linalg.norm(x[ties[:, 1]] - x[ties[:, 0]], axis=1)
    return {
        "particles": x,
        "forces": [
            {"kind": "springs", "particles": edges, "stiffness": 1e4},
            {"kind": "springs", "particles": ties, "stiffness": 3e3, "lower_cutoff": start},
            {"kind": "unary", "particles": [3, 7], "vector": [50.0, 0, -10.0]},
            {"kind": "anchor_spring", "particles": np.arange(16), "targets": x, "strength": 1.0},
        ],
        "anchors": [{"particles": number[:, 0]}, {"particles": np.arange(16), "axes": "y"}],
    }


def web() -> Spec:
    """Points in a cube, each tied to all others and to the corners: in tension everywhere, so there is one shape."""
    rng = np.random.default_rng(4)
    corners = 2.0 * np.array([[i, j, k] for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)])
    x = np.concatenate([corners, rng.uniform(-1, 1, (6, 3))])
    pairs = np.array([[i, j] for i in range(8, 14) for j in range(i)])
    k = np.where(pairs[:, 1] < 8, 10.0, 1.0) * rng.uniform(0.5, 2.0, len(pairs))
    return {
        "particles": x,
        "forces": [
            {"kind": "springs", "particles": pairs, "stiffness": k, "rest_factor": 0.1},
            {"kind": "unary", "particles": np.arange(8, 14), "vector": rng.normal(size=(6, 3))},
        ],
        "anchors": [{"particles": np.arange(8)}],
    }


def folded() -> Spec:
    """A strip of triangles that hinges keep stiff, clamped at one end, loaded at the other."""
    x, edges, _ = grid(4)
    x = x[:12]
    edges = edges[(edges < 12).all(axis=1)]
    number = np.arange(12).reshape(3, 4)
    quads = discretize.grid(np.arange(3), np.arange(4)).faces
    hinges = [[a, c, b, d] for a, b, c, d in quads]
    hinges += [[number[1, j], number[1, j + 1], number[2, j + 1], number[0, j]] for j in range(3)]
    for i, j in ((0, 1), (0, 2), (1, 1), (1, 2)):
        hinges.append([number[i, j], number[i + 1, j], number[i, j - 1], number[i + 1, j + 1]])
    return {
        "particles": x,
        "forces": [
            {"kind": "springs", "particles": np.concatenate([edges, quads[:, [0, 2]]]), "stiffness": 1000.0},
            {"kind": "hinge", "particles": hinges, "strength": 50.0},
            {"kind": "unary", "particles": number[:, 3], "vector": [0, 0, -1.0]},
        ],
        "anchors": [{"particles": [*number[:, 0], *number[:, 1]]}],
    }


def pillow() -> Spec:
    """A net that sags onto a floor in its middle; without friction its shape there is one."""
    spec = hanging_net()
    spec["settings"] = {"floor": {"point": [0, 0, -1.5], "static_friction": 0.0, "kinetic_friction": 0.0}}
    return spec


SCENES = {
    f.__name__: f
    for f in (
        cable, arch, mixed_cable, force_density_net, soft_force_density, hanging_net,
        tent, truss, braced, web, folded, pillow,
    )
}  # fmt: skip


@cache
def solved(name: str, method: str) -> Result | None:
    """The scene by one solver, to 1e-9; None where the solver refuses it."""
    spec = SCENES[name]()
    settings = {**spec.get("settings", {}), "solver": method, "tolerance": 1e-9, "max_iterations": 400_000}
    spec["settings"] = settings
    system = compile(Scene.read(spec))
    if method in ("verlet", "yoshida"):
        # masses that make all particles alike keep time stepping quick; the equilibrium does not know them
        state = system.start()
        _, w, _ = system.evaluate(state)
        spec["masses"] = np.maximum(w, w[w > 0].min())
        system = compile(Scene.read(spec))
        settings["time_step"] = 0.5 * stable_time_step(system, system.start())
        settings["drag"] = min(0.2 * float(np.median(w)), 0.5 * float(spec["masses"].min()))
    try:
        return relax(Scene.read(spec))
    except InputError as refused:
        assert refused.pointer == "/settings/solver" and len(refused.sentence) > 30
        return None


def tangent_at(system: System, x: np.ndarray) -> float:
    """Smallest eigenvalue of the tangent on free axes, over its largest."""
    from hookean.stability.time_steps import _scaled_stiffness

    state = system.start()
    state.x = x.copy()
    matrix, _, _ = _scaled_stiffness(system, state)
    values = np.linalg.eigvalsh(matrix.toarray())  # type: ignore[attr-defined]
    return float(values[0] / values[-1])


def test_there_are_twelve_scenes_and_every_solver_takes_part() -> None:
    """Each solver takes at least two of the scenes; all but force_density (linear) and yoshida (no floor) take all."""
    systems = [compile(Scene.read(f())) for f in SCENES.values()]
    takes = {method: sum(not solver(method).refuse(system) for system in systems) for method in SOLVERS}
    print(takes)
    assert len(SCENES) == 12 and min(takes.values()) >= 2
    assert all(takes[m] == 12 for m in ("auto", "relaxation", "momentum", "bouncy", "verlet", "newton"))


@pytest.mark.thinned
@pytest.mark.parametrize("method", [m for m in SOLVERS if m != "relaxation"])
@pytest.mark.parametrize("name", SCENES)
def test_two_solvers_find_the_same_energy_and_shape(name: str, method: str) -> None:
    """Energy to 1e-8 of its size; where the tangent is positive definite the shape to 1e-5 of the model's size.

    At a residual r (1e-9 of the load) energies differ by r^2 / stiffness, far less; shapes by r / stiffness.
    """
    reference, other = solved(name, "relaxation"), solved(name, method)
    assert reference is not None and reference.converged, reference
    if other is None:
        assert solver(method).refuse(compile(Scene.read(SCENES[name]())))
        return
    assert other.converged, other.message
    system = compile(Scene.read(SCENES[name]()))

    def energy(result: Result) -> float:
        return sum(value for kind, value in result.energy.items() if kind not in ("kinetic", "total"))

    sizes = sum(abs(value) for kind, value in reference.energy.items() if kind not in ("kinetic", "total"))
    assert abs(energy(other) - energy(reference)) <= 1e-8 * sizes
    if tangent_at(system, reference.particles) > 1e-9:
        apart = np.abs(other.particles - reference.particles).max()
        assert apart <= 1e-5 * system.size


@pytest.mark.parametrize("name", SCENES)
def test_equilibria_are_stable(name: str) -> None:
    """What relaxation finds is a minimum: no eigenvalue of the tangent on free axes is below -1e-7 of the largest."""
    found = solved(name, "relaxation")
    assert found is not None
    assert tangent_at(compile(Scene.read(SCENES[name]())), found.particles) >= -1e-7


@pytest.mark.slow
def test_newton_leaves_a_saddle() -> None:
    """The braced frame free to buckle sideways but drawn flat: kept, it is unstable; left, the energy is lower, the
    tangent by differences positive, and few steps were taken."""
    spec = braced()
    spec["anchors"] = spec["anchors"][:1]
    kept, left = (
        relax(Scene.read({**spec, "settings": {"solver": "newton", "tolerance": 1e-12, "allow_unstable": keep}}))
        for keep in (True, False)
    )
    assert kept.converged and kept.stability == "unstable"
    assert left.converged and left.stability == "stable" and left.iterations < 1000
    assert left.energy["total"] < kept.energy["total"]
    assert tangent_at(compile(Scene.read(spec)), left.particles) > 0.0
