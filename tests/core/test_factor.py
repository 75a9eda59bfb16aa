"""Sparse factors: both libraries solve what numpy solves, and neither takes a matrix that is not positive definite."""

from __future__ import annotations

import os
import subprocess
import sys

import numpy as np
import pytest
import scipy.sparse as sparse
from hypothesis import given, settings
from hypothesis import strategies as some

from hookean import Scene, relax
from hookean.discretize import corners, edges, grid
from hookean.linear import sparse_factors as factor
from hookean.linear.sparse_factors import Factors
from hookean.solvers.newton import Pattern
from hookean.system.system import compile
from soak import SOAK, THREADS

from ..laws.scenes import random_scene

LIBRARIES = ("rslab", "splu")


@pytest.fixture(params=LIBRARIES)
def library(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> str:
    """Each library in turn, whichever is installed."""
    if request.param == "splu":
        monkeypatch.setattr(factor, "supernodal", lambda: None)
    else:
        pytest.importorskip("rslab")
    return str(request.param)


def random_symmetric(seed: int, size: int) -> np.ndarray:
    """A sparse symmetric matrix with nothing on its diagonal."""
    rng = np.random.default_rng(seed)
    upper = np.triu(rng.normal(size=(size, size)) * (rng.random((size, size)) < 3.0 / size), 1)
    return upper + upper.T


def factors(matrix: np.ndarray) -> tuple[Factors, np.ndarray]:
    """Factors of a dense matrix's pattern, and its values; the diagonal is in the pattern even where it is 0."""
    lower = sparse.csc_matrix(np.tril(matrix) + 7.0 * np.eye(len(matrix)))
    lower.data[lower.indptr[:-1]] = np.diag(matrix)
    return Factors(lower.indices, lower.indptr), lower.data


@settings(max_examples=200 if SOAK else 25, derandomize=True, deadline=None)
@given(seed=some.integers(0, 2**32 - 1), size=some.integers(1, 60))
@pytest.mark.parametrize("name", LIBRARIES)
def test_solutions_are_numpys_and_indefinite_matrices_have_none(name: str, seed: int, size: int) -> None:
    """A shift puts the smallest eigenvalue 0.1 above or below zero: x to 1e-13 of the condition number, or None. The
    order found for the first matrix serves the others."""
    with pytest.MonkeyPatch.context() as patch:
        if name == "splu":
            patch.setattr(factor, "supernodal", lambda: None)
        matrix = random_symmetric(seed, size)
        lowest = np.linalg.eigvalsh(matrix)[0]
        b = np.random.default_rng(seed).normal(size=size)
        found, _ = factors(matrix + np.eye(size))
        for shift in (0.1, 2.0, -0.1):
            whole = matrix + (shift - lowest) * np.eye(size)
            x = found.solve(factors(whole)[1], b)
            if shift < 0.0:
                assert x is None
            else:
                expected = np.linalg.solve(whole, b)
                assert x is not None
                assert np.abs(x - expected).max() <= 1e-13 * np.linalg.cond(whole) * np.abs(expected).max()


def test_singular_and_broken_matrices_have_no_factors(library: str) -> None:
    """An entry of the diagonal that is zero, negative or not a number: None, never numbers."""
    for bad in (0.0, -1.0, np.nan):
        matrix = np.diag([1.0, bad, 3.0])
        matrix[2, 0] = matrix[0, 2] = 0.5
        found, values = factors(matrix)
        assert found.solve(values, np.ones(3)) is None, bad


@pytest.mark.parametrize("seed", range(200 if SOAK else 30))
def test_a_pattern_is_the_lower_triangle_of_the_tangent(seed: int) -> None:
    """Of random scenes with all forces: the same entries as summing every element's block into a dense matrix (sums of
    a few terms in another order: 1e-14 of the largest)."""
    system = compile(Scene.read(random_scene(seed)))
    state = system.start()
    if 3 * len(state.x) > 1500:
        pytest.skip("dense")
    pattern = Pattern(system, state.free.copy())
    dense = np.zeros((state.x.size, state.x.size))
    for group, memory in zip(system.groups, state.memory, strict=True):
        if group.cls.role != "load":
            index = (3 * group.block.indices[:, :, None] + np.arange(3)).reshape(len(group.block.indices), -1)
            np.add.at(dense, (index[:, :, None], index[:, None, :]), system.stiffness_blocks(group, state, memory))
    free = np.flatnonzero(state.free.ravel())
    dense = dense[np.ix_(free, free)]
    values, size = pattern.tangent(system, state), len(free)
    lower = sparse.csc_matrix((values, pattern.factors.rows, pattern.factors.starts), shape=(size, size))
    assert np.abs(lower.toarray() - np.tril(dense)).max(initial=0.0) <= 1e-14 * np.abs(dense).max(initial=0.0)
    assert np.array_equal(pattern.factors.rows[pattern.diagonal], np.arange(size))


def net(side: int, solver: str) -> Scene:
    """A net hung by its corners."""
    mesh = grid(np.arange(side), np.arange(side))
    return Scene.read(
        {
            "particles": mesh.vertices,
            "forces": [
                {"kind": "springs", "particles": edges(mesh), "stiffness": 100.0, "rest_factor": 0.95},
                {"kind": "self_weight", "total": 10.0},
            ],
            "anchors": [{"particles": corners(mesh)}],
            "settings": {"solver": solver, "tolerance": 1e-10},
        }
    )


def test_both_libraries_lead_newton_to_one_shape(monkeypatch: pytest.MonkeyPatch) -> None:
    """A residual of 1e-10 of a load leaves 1e-10 of the deflection, 1e-8 of a size of some 15 with room."""
    pytest.importorskip("rslab")
    first = relax(net(12, "newton"))
    monkeypatch.setattr(factor, "supernodal", lambda: None)
    second = relax(net(12, "newton"))
    assert first.converged and second.converged
    assert np.abs(first.particles - second.particles).max() <= 1e-8


@pytest.mark.slow
def test_bits_do_not_depend_on_threads() -> None:
    """Newton on a net of 1,600 particles in processes of one and of two threads: the same bytes."""
    script = (
        "import sys, json, hashlib; from hookean import Scene, relax;"
        "found = relax(Scene.read(json.load(sys.stdin)));"
        "print(hashlib.sha256(found.particles.tobytes()).hexdigest())"
    )
    written = net(40, "newton").canonical
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
