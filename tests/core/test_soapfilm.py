"""Soap films: minimal surfaces with known areas and heights, collapse, yarns, and what holds the vertices in place."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.interpolate import RectBivariateSpline
from scipy.optimize import fsolve

from hookean import Scene, relax
from hookean.forces import SoapFilm
from hookean.forces.soapfilm import halves, shapes
from hookean.result import Result, Status
from hookean.system import compile

Heights = Callable[[np.ndarray, np.ndarray], np.ndarray]
SEEDED = settings(derandomize=True, deadline=None, max_examples=50, database=None)
EPS = float(np.finfo(float).eps)


def film(x: np.ndarray, faces: np.ndarray, rim: Any, tolerance: float = 1e-10, **more: Any) -> Result:
    """A film relaxed by the default solver, its rim held."""
    scene = Scene(
        particles=x, meshes={"skin": {"vertices": x, "faces": faces}}, forces=[SoapFilm(mesh="skin", **more)],
        anchors=[{"particles": rim}], settings={"tolerance": tolerance, "position_tolerance": None},
    )  # fmt: skip
    return relax(scene)


def cut(quads: np.ndarray, kind: str) -> np.ndarray:
    """Quads, or triangles along one diagonal."""
    return quads if kind == "quads" else np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


def square(n: int, height: Heights, kind: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """n x n faces over [-1, 1]^2, and the rim."""
    t = np.linspace(-1, 1, n + 1)
    u, v = np.meshgrid(t, t, indexing="ij")
    x = np.stack([u, v, height(u, v)], axis=-1).reshape(-1, 3)
    number = np.arange((n + 1) ** 2).reshape(n + 1, n + 1)
    quads = np.stack([number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]], axis=-1).reshape(-1, 4)
    return x, cut(quads, kind), np.unique(np.concatenate([number[0], number[-1], number[:, 0], number[:, -1]]))


def tube(n: int, m: int, height: float, kind: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A tube of radius 1 between two rings, n faces around and m high, and the rings."""
    number = np.arange(n * (m + 1)).reshape(m + 1, n)
    turn, level = np.meshgrid(2 * np.pi * np.arange(n) / n, height * (np.arange(m + 1) / m - 0.5))
    x = np.stack([np.cos(turn), np.sin(turn), level], axis=-1).reshape(-1, 3)
    after = np.roll(number, -1, axis=1)
    quads = np.stack([number[:-1], after[:-1], after[1:], number[1:]], axis=-1).reshape(-1, 4)
    return x, cut(quads, kind), np.concatenate([number[0], number[-1]])


def height_at(x: np.ndarray, n: int, spot: tuple[float, float]) -> float:
    """Height over a spot: vertices have slid, so a quintic spline through the grid is solved for where it passes."""
    t = np.linspace(-1, 1, n + 1)
    grid = x.reshape(n + 1, n + 1, 3)
    splines = [RectBivariateSpline(t, t, grid[:, :, c], kx=5, ky=5) for c in range(3)]
    at = fsolve(lambda p: [s.ev(*p) - c for s, c in zip(splines, spot, strict=False)], spot, xtol=1e-12)
    return float(splines[2].ev(*at))


def slopes(errors: list[float]) -> np.ndarray:
    """Orders of convergence of errors at h, h/2, h/4."""
    return np.log2(np.abs(np.array(errors[:-1])) / np.abs(np.array(errors[1:])))


def area(result: Result) -> float:
    return float(result.force("soapfilm")["area"].sum())


SURFACES: dict[str, tuple[Heights, float, tuple[float, float], float]] = {
    "Scherk": (lambda x, y: np.log(np.cos(y) / np.cos(x)), 5.697512212, (0.5, 0.0), 0.130584240),
    "hypar frame": (lambda x, y: x * y, 5.117046, (0.5, 0.5), 0.223580),
}


@pytest.mark.parametrize("kind", ["quads", "triangles"])
@pytest.mark.parametrize("name", SURFACES)
def test_minimal_surfaces_on_a_square(name: str, kind: str) -> None:
    """Area and height of the film, order 2 (+- 0.15): Scherk 1835; the hypar frame by series (six digits).

    Started from a shape with waves in it. The default solver balances to 1e-10. On the hypar cut along one diagonal the
    height over that diagonal converges faster than the area, to the last digit of the source.
    """
    surface, right_area, spot, right_height = SURFACES[name]
    areas, heights = [], []
    for n in (8, 16, 32):
        x, faces, rim = square(
            n, lambda u, v: surface(u, v) + 0.1 * np.cos(1.5 * np.pi * u) * np.cos(0.5 * np.pi * v), kind
        )
        x[rim, 2] = surface(x[rim, 0], x[rim, 1])
        result = film(x, faces, rim)
        assert result.converged and result.residual <= 1e-10
        areas.append(area(result) - right_area)
        heights.append(height_at(result.particles, n, spot) - right_height)
    assert slopes(areas) == pytest.approx([2, 2], abs=0.15)
    if (name, kind) == ("hypar frame", "triangles"):
        assert slopes(heights)[-1] > 2 and abs(heights[-1]) <= 2e-6
    else:
        assert slopes(heights)[-1] == pytest.approx(2, abs=0.15)
    assert abs(areas[-1]) <= 2e-3 and abs(heights[-1]) <= 1e-3


@pytest.mark.parametrize("kind", ["quads", "triangles"])
def test_the_catenoid(kind: str) -> None:
    """R 1, h 1: waist 0.84833794, area 5.99179698, order 2 (+- 0.15). Source: Euler 1744."""
    areas, waists = [], []
    for n in (16, 32, 64):
        result = film(*tube(n, n // 2, 1.0, kind))
        assert result.converged and result.residual <= 1e-10
        ring = result.particles.reshape(-1, n, 3)[n // 4, :, :2]
        areas.append(area(result) - 5.99179698)
        waists.append(np.linalg.norm(ring, axis=1).mean() - 0.84833794)
    assert slopes(areas) == pytest.approx([2, 2], abs=0.15) and slopes(waists) == pytest.approx([2, 2], abs=0.15)
    assert abs(areas[-1]) <= 3e-3 and abs(waists[-1]) <= 5e-4


@pytest.mark.parametrize("kind", ["quads", "triangles"])
@pytest.mark.parametrize("height", [1.4, 2.5])
def test_rings_too_far_apart(height: float, kind: str) -> None:
    """Beyond h/R = 1.3254868387 there is no catenoid (Goldschmidt 1831): that is told."""
    result = film(*tube(32, 20, height, kind))
    assert result.status is Status.DIVERGED and not result.converged
    assert result.message.startswith("Collapsed after") and "/forces/0: the film has collapsed" in result.message
    assert "bring the edges nearer" in result.message
    assert np.isfinite(result.particles).all() and np.abs(result.particles).max() <= 1.5
    assert film(*tube(32, 20, 1.29, kind), tolerance=1e-8).converged


def test_without_evenness_vertices_slide() -> None:
    """The area alone leaves vertices free to slide within the film: on the hypar they fold over, and none converges.

    With evenness the same mesh stays as it is: no triangle loses more than a third of its proportions.
    """
    x, faces, rim = square(16, lambda u, v: u * v, "triangles")
    corners = halves(np.column_stack([faces, faces[:, 2]]))[0]
    thin = {}
    for evenness in (0.0, 4.0):
        result = film(x, faces, rim, tolerance=1e-8, evenness=evenness)
        thin[evenness] = (shapes(result.particles, corners)[1].sum(axis=1) / shapes(x, corners)[1].sum(axis=1)).max()
        assert result.converged == (evenness > 0)
    assert thin[4.0] < 1.5 and thin[0.0] > 10.0


@SEEDED
@given(st.integers(0, 2**32 - 1))
def test_the_energy_is_tension_times_area(seed: int) -> None:
    """At the start, and whatever the shape with evenness 0: E = T A, quads as the mean of both cuts."""
    rng = np.random.default_rng(seed)
    x = rng.normal(size=(5, 3))
    faces = [[0, 1, 2, 3], [1, 2, 4, 4]]

    def half(p: int, q: int, r: int, y: np.ndarray) -> float:
        return 0.5 * float(np.linalg.norm(np.cross(y[q] - y[p], y[r] - y[p])))

    def whole(y: np.ndarray) -> float:
        cuts = (half(0, 1, 2, y), half(0, 2, 3, y), half(0, 1, 3, y), half(1, 2, 3, y))
        return 0.5 * sum(cuts) + half(1, 2, 4, y)

    for evenness, y in ((4.0, x), (0.0, rng.normal(size=(5, 3)))):
        force = SoapFilm(mesh="m", tension=3.0, evenness=evenness)
        system = compile(Scene(particles=x, meshes={"m": {"vertices": x, "faces": faces}}, forces=[force]))
        state = system.start()
        state.x = y
        assert system.evaluate(state)[2].sum() == pytest.approx(3.0 * whole(y), rel=1e-12)


def test_newton_ends_quadratically() -> None:
    """From a shape near the film: each Newton step leaves at most 100 times the square of the last imbalance."""
    from hookean.solvers import solver

    x, faces, rim = square(8, SURFACES["hypar frame"][0], "quads")
    near = film(x, faces, rim, tolerance=1e-4)
    scene = Scene(
        particles=x, meshes={"m": {"vertices": x, "faces": faces}}, forces=[SoapFilm(mesh="m")],
        anchors=[{"particles": rim}], settings={"solver": "newton"},
    )  # fmt: skip
    system = compile(scene)
    state = system.start()
    state.x = near.particles.copy()
    method = solver("newton")
    method.start(system, state)
    state.scratch["shift"][0] = 0.0
    left = [np.abs(system.evaluate(state)[0] * state.free).max()]
    while left[-1] > 1e-14 and len(left) < 8:
        method.advance(system, state, 1, 0.0)
        left.append(np.abs(system.evaluate(state)[0] * state.free).max())
    assert left[0] > 1e-7 and left[-1] <= 1e-14
    assert all(b <= 100.0 * a * a + 1e-14 for a, b in pairwise(left))


def test_yarns_pull_with_a_constant_force_per_start_width() -> None:
    """A strip 3 long, 2 wide, pulled to any length and width: warp 5 x 2 along, weft 7 x 3 across, by virtual work."""
    x = np.array([[0, 0, 0], [3, 0, 0], [3, 2, 0], [0, 2, 0.0]])
    force = SoapFilm(mesh="m", tension=0.0, warp=5.0, weft=7.0)
    for faces in ([[0, 1, 2, 3]], [[0, 1, 2], [3, 2, 0]]):
        system = compile(Scene(particles=x, meshes={"m": {"vertices": x, "faces": faces}}, forces=[force]))
        state = system.start()
        for along, across in ((1.0, 1.0), (1.7, 0.6)):
            state.x = x * [along, across, 1.0]
            f, _, energies = system.evaluate(state)
            assert energies.sum() == pytest.approx(5.0 * 2.0 * 3.0 * along + 7.0 * 3.0 * 2.0 * across, rel=1e-14)
            assert f[[1, 2], 0].sum() == pytest.approx(-10.0, rel=1e-14)
            assert f[[2, 3], 1].sum() == pytest.approx(-21.0, rel=1e-14)


def test_unequal_yarns_make_a_hypar_of_the_force_density_kind() -> None:
    """Yarns alone over a square, heights free: E = integral of warp |x_u| + weft |x_v|; a plane rim stays plane."""
    x, faces, rim = square(6, lambda u, v: 0.3 * np.cos(0.5 * np.pi * u) * np.cos(0.5 * np.pi * v), "quads")
    result = film(x, faces, rim, tension=0.0, warp=2.0, weft=1.0)
    assert result.converged and np.abs(result.particles[:, 2]).max() <= 1e-8


def test_faces_without_area_are_left_out() -> None:
    """A doubled corner and three points in a row add nothing; the rest is as without them."""
    x = np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 0.0]])
    force = SoapFilm(mesh="m")
    meshes = {"m": {"vertices": x, "faces": [[0, 1, 2], [0, 0, 3], [0, 2, 3]]}}
    system = compile(Scene(particles=x, meshes=meshes, forces=[force]))
    assert len(system.groups[0].block.indices) == 1
    assert system.evaluate(system.start())[2].sum() == pytest.approx(1.0, rel=4 * EPS)
