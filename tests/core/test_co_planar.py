"""Co-planar groups: the plane of least squares, and the shapes that groups take."""

from __future__ import annotations

import numpy as np
import pytest

from hookean import Scene, relax
from hookean.system.system import compile


def cloud(count: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Particles and their strengths."""
    rng = np.random.default_rng(seed)
    return rng.normal(size=(count, 3)) * [3.0, 2.0, 0.7] + rng.normal(size=3), rng.uniform(1.0, 50.0, count)


def energy(kind: str, x: np.ndarray, strength: np.ndarray) -> float:
    """The energy of all particles as one group."""
    system = compile(Scene(particles=x, forces=[{"kind": kind, "particles": range(len(x)), "strength": strength}]))
    return float(system.evaluate(system.start())[2].sum())


@pytest.mark.parametrize(("kind", "axes"), [("co_planar", slice(2, 3)), ("co_linear", slice(1, 3))])
@pytest.mark.parametrize("count", [4, 9, 200])
def test_the_energy_is_that_of_the_least_squares(kind: str, axes: slice, count: int) -> None:
    """With sigma the singular values of sqrt(k) (x - mean): sigma_3^2 / 2, of a line (sigma_2^2 + sigma_3^2) / 2.

    Source: Golub and Van Loan, Matrix Computations, 2013, 6.1 (total least squares). Rounding: eps x sigma_1^2.
    """
    x, strength = cloud(count, count)
    apart = x - np.average(x, axis=0, weights=strength)
    sigma = np.linalg.svd(np.sqrt(strength)[:, None] * apart, compute_uv=False)
    found = energy(kind, x, strength)
    assert abs(found - 0.5 * (sigma[axes] ** 2).sum()) <= 1e-13 * sigma[0] ** 2


@pytest.mark.parametrize(("kind", "scale"), [("co_planar", [1.0, 1.0, 0.0]), ("co_linear", [1.0, 0.0, 0.0])])
def test_points_made_in_one_are_at_rest(kind: str, scale: list[float]) -> None:
    """An exact fit: what is left is the square of rounding, (eps x size)^2 k for each particle."""
    x, strength = cloud(12, 1)
    turn = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))[0]
    assert energy(kind, (x * scale) @ turn + [5.0, -2.0, 1.0], strength) < 12 * 50.0 * (1e-14 * 20.0) ** 2


@pytest.mark.parametrize(("kind", "rank"), [("co_planar", 2), ("co_linear", 1)])
def test_groups_come_into_shapes_of_their_own(kind: str, rank: int) -> None:
    """Each of two groups ends in a plane or line of its own, its centre where it was: nothing pushes from outside.

    Distances below 1e-9, where the residual is 1e-10 of k x length.
    """
    x = np.concatenate([cloud(7, 4)[0], cloud(5, 5)[0] @ np.array([[0, 1, 0], [0, 0, 1], [1, 0, 0.0]])])
    group = [3] * 7 + [-1] * 5
    force = {"kind": kind, "particles": range(12), "group": group, "strength": 10.0}
    found = relax(Scene(particles=x, forces=[force], settings={"tolerance": 1e-10, "max_iterations": 20000}))
    for rows in (slice(0, 7), slice(7, 12)):
        apart = found.particles[rows] - found.particles[rows].mean(axis=0)
        assert np.linalg.svd(apart, compute_uv=False)[rank:].max() < 1e-8
        assert np.abs(found.particles[rows].mean(axis=0) - x[rows].mean(axis=0)).max() < 1e-12 * np.abs(x).max()
    assert found.converged and found.forces[0]["distance"].max() < 1e-8


def test_a_plane_under_load_is_a_lever() -> None:
    """Particles at -1, 0, 1 on x with soft anchors S in z, a load P at the middle, the plane stiff: it stays flat.

    Virtual work of the common lift u: 3 S u = P, of the bow b (1, -2, 1): 6 S b = -2 P - k b 6 with k the strength of
    co_linear across its line: b = -2 P / (6 (S + k)).
    """
    x = np.array([[-1.0, 0, 0], [0, 0, 0], [1.0, 0, 0]])
    soft, stiff, load = 3.0, 40.0, 2.0
    forces = [
        {"kind": "co_linear", "particles": [0, 1, 2], "strength": stiff},
        {"kind": "pull_to_plane", "particles": [0, 1, 2], "strength": soft},
        {"kind": "unary", "particles": [1], "vector": [0, 0, load]},
    ]
    held = [{"particles": [0, 1, 2], "axes": "xy"}]
    found = relax(Scene(particles=x, forces=forces, anchors=held, settings={"tolerance": 1e-12}))
    lift, bow = load / (3.0 * soft), -2.0 * load / (6.0 * (soft + stiff))
    assert found.particles[:, 2] == pytest.approx(lift + bow * np.array([1.0, -2.0, 1.0]), abs=2e-3)
