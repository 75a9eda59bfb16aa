"""Force density: its answers are those of dense algebra, whichever way a net is solved, and what hangs on nothing is
left where it is."""

from __future__ import annotations

import os
import subprocess
import sys
from typing import Any

import numpy as np
import pytest
import scipy.sparse as sparse
from hypothesis import given, settings
from hypothesis import strategies as some

from hookean import Scene, discretize, relax
from hookean.linear import scalar_cg as _gradients
from hookean.linear import scalar_hierarchy as _levels
from hookean.linear.aggregation import coarsened
from hookean.linear.laplacian import Laplacian, laplacian
from hookean.solvers import force_density, solver
from hookean.solvers.auto import SOLVES
from hookean.system.system import System, compile
from soak import SOAK, THREADS

SEEDED = settings(max_examples=300 if SOAK else 30, derandomize=True, deadline=None)
EPS = float(np.finfo(float).eps)
WAYS = ("front", "levels", "smoothed", "last resort")


def put_on(patch: pytest.MonkeyPatch, way: str) -> None:
    """Make small nets take the way of large ones: conjugate gradients over nets of at least 8 rows, or over one net
    that is smoothed only; or a front after those gave up."""
    if way != "front":
        patch.setattr(force_density, "QUICK", -1.0)
    if way == "levels":
        patch.setattr(_levels, "SMALLEST", 8)
    if way == "smoothed":
        patch.setattr(_levels, "LARGEST_FACTOR", -1.0)
        patch.setattr(_levels, "SMALLEST", 1000)
    if way == "last resort":
        patch.setattr(_gradients, "MOST", 0)


def random_net(seed: int, contrast: float) -> dict[str, Any]:
    """A connected random net with doubled springs, springs from a particle to itself and of no stiffness, particles
    without springs, loads, soft anchors, and anchors that hold some axes only; each axis is held somewhere."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(2, 60))
    tree = np.column_stack([np.arange(1, n), (np.arange(1, n) * rng.random(n - 1)).astype(int)])
    more = rng.integers(0, n, (int(rng.integers(0, 2 * n)), 2))
    springs = np.concatenate([tree, more, tree[: n // 3]])
    k = 10.0 ** rng.uniform(-contrast, contrast, len(springs))
    k[len(tree) : len(tree) + len(more) // 4] = 0.0
    forces: list[dict[str, Any]] = [
        {"kind": "springs", "particles": springs, "stiffness": k, "rest_length": rng.random(len(springs)),
         "rest_factor": 0.0},
        {"kind": "unary", "particles": rng.integers(0, n, 3), "vector": rng.normal(size=(3, 3))},
    ]  # fmt: skip
    anchors = [{"particles": rng.integers(0, n, 2), "targets": rng.normal(size=(2, 3)), "axes": "xyz"}]
    if seed % 3:
        forces.append({"kind": "anchor_spring", "particles": rng.integers(0, n, 2), "strength": [0.5, 2.0]})
        anchors.append({"particles": rng.integers(0, n, 1), "axes": str(rng.choice(["x", "yz", "z"]))})
    x = rng.normal(size=(n + 2, 3))
    return {"particles": x, "forces": forces, "anchors": anchors}


def dense(system: System) -> tuple[np.ndarray, float]:
    """The shape at rest by numpy, and the largest condition number of its axes' matrices."""
    state = system.start()
    n, x, worst = len(state.x), state.x.copy(), 1.0
    whole, pull = np.zeros((n, n)), np.zeros((n, 3))
    for group in system.groups:
        index, p = group.block.indices, group.block.parameters
        if group.cls.__name__ == "Springs":
            for (a, b), k in zip(index, p[:, 0], strict=True):
                whole[[a, b], [a, b]] += k if a != b else 0.0
                whole[a, b] -= k if a != b else 0.0
                whole[b, a] -= k if a != b else 0.0
        elif group.cls.__name__ == "AnchorSpring":
            for (a,), row in zip(index, p, strict=True):
                whole[a, a] += row[0]
                pull[a] += row[0] * row[1:4]
        else:
            for (a,), row in zip(index, p, strict=True):
                pull[a] += row[:3]
    for axis in range(3):
        rows = np.flatnonzero((state.free[:, axis] > 0) & (np.diag(whole) > 0))
        rest = np.setdiff1d(np.arange(n), rows)
        matrix = whole[np.ix_(rows, rows)]
        x[rows, axis] = np.linalg.solve(matrix, pull[rows, axis] - whole[np.ix_(rows, rest)] @ x[rest, axis])
        worst = max(worst, float(np.linalg.cond(matrix))) if len(rows) else worst
    return x, worst


@pytest.mark.thinned
@SEEDED
@given(seed=some.integers(0, 2**32 - 1), contrast=some.sampled_from([0.0, 2.0]))
@pytest.mark.parametrize("way", WAYS)
def test_answers_are_those_of_dense_algebra(way: str, seed: int, contrast: float) -> None:
    """To 4 roundings for each particle of the condition number and the size: at most 60 x 2 eps x condition."""
    with pytest.MonkeyPatch.context() as patch:
        put_on(patch, way)
        system = compile(Scene.read(random_net(seed, contrast)))
        state = system.start()
        expected, condition = dense(system)
        assert solver("force_density").advance(system, state, 1, 0.0) == 1
        size = max(np.abs(expected).max(), np.abs(system.x).max())
        assert np.abs(state.x - expected).max() <= 4.0 * len(expected) * EPS * condition * size


@pytest.mark.slow
@SEEDED
@given(seed=some.integers(0, 2**32 - 1))
@pytest.mark.parametrize("way", WAYS)
def test_what_hangs_on_nothing_is_left(way: str, seed: int) -> None:
    """A loop of springs beside the net that nothing holds: no iteration, and nothing has moved."""
    with pytest.MonkeyPatch.context() as patch:
        put_on(patch, way)
        net = random_net(seed, 0.0)
        n = len(net["particles"])
        count = int(np.random.default_rng(seed).integers(2, 40))
        loop = n + np.column_stack([np.arange(count), np.roll(np.arange(count), 1)])
        net["particles"] = np.concatenate([net["particles"], np.random.default_rng(seed).normal(size=(count, 3))])
        net["forces"].append({"kind": "springs", "particles": loop, "stiffness": 3.0, "rest_factor": 0.0})
        system = compile(Scene.read(net))
        state = system.start()
        before = state.x.copy()
        assert solver("force_density").advance(system, state, 1, 0.0) == 0
        assert np.array_equal(state.x, before)


def grid(side: int, height: Any) -> tuple[Scene, np.ndarray]:
    """A square net of rest length 0 and stiffness 1 over [-1, 1]^2 in a frame at a height; and that everywhere."""
    along = np.linspace(-1.0, 1.0, side + 1)
    mesh = discretize.grid(along, along, height(*np.meshgrid(along, along, indexing="ij")))
    start = mesh.vertices.copy()
    start[discretize.clothed_vertices(mesh)] *= 0.5
    force = {"kind": "springs", "particles": discretize.edges(mesh), "stiffness": 1.0, "rest_length": 0.0}
    held = [{"particles": discretize.naked_vertices(mesh)}]
    return Scene.read({"particles": start, "forces": [force], "anchors": held}), mesh.vertices


@pytest.mark.parametrize("side", [20, 150, *([500] if SOAK else [])])
def test_a_net_in_a_saddle_frame_is_the_saddle(side: int) -> None:
    """x^2 - y^2 has second differences that cancel: each inner vertex is the mean of its neighbours. 150 x 150 faces
    are too wide for a front.

    Rounding leaves at most 4 eps x 4 of force on a particle, and a unit of it on all moves none by more than
    side^2 / 8 (a string of `side` unit springs; the net is stiffer).
    """
    scene, expected = grid(side, lambda u, v: u * u - v * v)
    result = relax(scene)
    assert result.solver == "auto: force_density" and result.converged
    assert np.abs(result.particles - expected).max() <= 16.0 * EPS * side * side / 8.0


@pytest.mark.parametrize("side", [40, 150, 151])
def test_any_tolerance_is_met_by_solves_alone(side: int) -> None:
    """A second solve, of what rounding left in the first (Wilkinson 1963), comes to the floor that float64 allows; some
    more where the last particles are just above theirs, which depends on how a processor adds."""
    scene, _ = grid(side, lambda u, v: np.exp(u) * np.sin(3.0 * v))
    settings = scene.settings.model_copy(update={"tolerance": 1e-16})
    result = relax(scene.model_copy(update={"settings": settings}))
    assert result.converged and result.residual <= result.rounding_floor < 1e-12
    assert result.solver == "auto: force_density" and result.iterations <= SOLVES


def test_steps_do_not_grow_with_the_net(monkeypatch: pytest.MonkeyPatch) -> None:
    """Conjugate gradients to rounding: at most 4 steps more for nine times the particles, and 22 in all. A step takes
    away nine tenths of what is left, so 16 digits of forces take 16, and some more as the net has more of them."""
    steps = []
    for side in (60, 300 if SOAK else 180):
        count = 0
        cycle = _levels.Hierarchy.cycle

        def counted(self: Any, b: Any, cycle: Any = cycle) -> Any:
            nonlocal count
            count += 1
            return cycle(self, b)

        with monkeypatch.context() as patch:
            patch.setattr(_levels.Hierarchy, "cycle", counted)
            patch.setattr(force_density, "QUICK", 0.0)
            assert relax(grid(side, lambda u, v: np.sin(3.0 * u) * v)[0]).converged
        steps.append(count)
    assert 5 <= steps[0] <= steps[1] <= steps[0] + 4 <= 26


def matrix(net: Laplacian) -> Any:
    return sparse.csr_matrix((net.values, net.columns, net.starts), shape=(len(net.diagonal),) * 2)


@SEEDED
@given(seed=some.integers(0, 2**32 - 1), contrast=some.sampled_from([0.0, 3.0]))
def test_coarser_nets_are_projections(seed: int, contrast: float) -> None:
    """P^T A P as scipy has it; the rows of P of what is not held add up to 1, so that a motion as one stays one."""
    system = compile(Scene.read(random_net(seed, contrast)))
    net, particles = laplacian(system, np.ascontiguousarray(system.start().free[:, 0]))
    found = coarsened(net, _levels.STRONG) if len(particles) else None
    if found is None:
        return
    p = sparse.csr_matrix((found[0][2], found[0][1], found[0][0]))
    expected = (p.T @ matrix(net) @ p).toarray()
    room = 1e-14 * np.abs(p.T) @ np.abs(matrix(net)) @ np.abs(p)
    assert (np.abs(matrix(found[1]).toarray() - expected) <= room.toarray()).all()
    loose = np.asarray(matrix(net).sum(axis=1)).ravel() <= 1e-14 * net.values[net.diagonal]
    assert np.abs(np.asarray(p.sum(axis=1)).ravel() - 1.0)[loose & (net.held == 0)].max(initial=0.0) <= 1e-12
    assert (np.asarray((p != 0).sum(axis=1)).ravel() > 0).all() and len(particles) == p.shape[0]
    held = np.asarray((np.abs(p.T) @ net.held) > 0).ravel()
    assert (held >= (found[1].held > 0)).all() and found[1].held.any() == net.held.any()


@pytest.mark.soak
def test_hubs_do_not_cost_their_square() -> None:
    """A particle joined to 30,000 others that are joined at random: a front would hold them all."""
    rng = np.random.default_rng(5)
    n = 30_000
    springs = np.concatenate([np.column_stack([np.arange(1, n), np.zeros(n - 1, int)]), rng.integers(1, n, (n, 2))])
    scene = Scene.read(
        {
            "particles": rng.normal(size=(n, 3)),
            "forces": [{"kind": "springs", "particles": springs, "stiffness": 1.0, "rest_length": 0.0}],
            "anchors": [{"particles": [1, 2]}],
            "settings": {"solver": "force_density", "tolerance": 1e-6},
        }
    )
    result = relax(scene)
    assert result.converged and result.iterations == 1


@pytest.mark.soak
def test_bits_do_not_depend_on_threads() -> None:
    """A net too wide for a front, in processes of one and of two threads: the same bytes."""
    script = (
        "import sys, json, hashlib; from hookean import Scene, relax;"
        "found = relax(Scene.read(json.load(sys.stdin)));"
        "assert found.solver == 'auto: force_density';"
        "print(hashlib.sha256(found.particles.tobytes()).hexdigest())"
    )
    written = grid(125, lambda u, v: np.sin(3.0 * u) * v)[0].canonical
    digests = []
    for threads in ("1", "2"):
        done = subprocess.run(
            [sys.executable, "-c", script],
            env={**os.environ, **dict.fromkeys(THREADS, threads)},
            input=written,
            capture_output=True,
            text=True,
            check=True,
        )
        digests.append(done.stdout)
    assert digests[0] == digests[1] and len(digests[0]) == 65
