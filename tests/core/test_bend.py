"""Bend against closed forms: the elastica, Hencky's bar chain, cantilevers; balance and degenerate corners."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.linalg import eigh
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

from hookean import Scene, relax
from hookean.forces import Bend, Springs, Unary
from hookean.system.system import compile
from soak import examples

EPS = float(np.finfo(float).eps)
EA = 1e7  # axial stiffness in units of EI / L^2: strains P / EA ~ 1e-6 or less
seeded = settings(derandomize=True, deadline=None, max_examples=examples(100), database=None)


def chain(headings: Any, length: float) -> np.ndarray:
    """Particles of a chain of bars of one length in the XZ plane, by the angle of each bar."""
    steps = np.column_stack([np.cos(headings), np.zeros(len(headings)), np.sin(headings)]) * length
    return np.vstack([np.zeros(3), np.cumsum(steps, axis=0)])


def rod(x: np.ndarray, stiffness: float = 1.0) -> list[Any]:
    """Nearly inextensible bars of their start length, and corners that want to be straight."""
    i = np.arange(len(x))
    length = np.linalg.norm(x[1] - x[0])
    return [
        Springs(particles=np.column_stack([i[:-1], i[1:]]), stiffness=EA / length, damping=0.0),
        Bend(particles=np.column_stack([i[:-2], i[1:-1], i[2:]]), stiffness=stiffness, angle_factor=0.0),
    ]


def solved(x: np.ndarray, anchors: list[Any], *loads: Any) -> np.ndarray:
    """The equilibrium shape."""
    scene = Scene(
        particles=x, forces=[*rod(x), *loads], anchors=anchors, settings={"tolerance": 1e-9, "solver": "newton"}
    )
    result = relax(scene)
    assert result.converged, result.message
    return result.particles


def slopes(errors: list[float]) -> np.ndarray:
    """Order of convergence between successive doublings."""
    sizes = np.abs(errors)
    return np.log2(sizes[:-1] / sizes[1:])


@pytest.mark.slow
def test_bent_rod_between_pins_at_half_its_length() -> None:
    """Rise / L = k / K(k) with 2 E(k) / K(k) - 1 = 1/2: 0.373306 (Love, Mathematical Theory of Elasticity, 1927, 263).

    Order 2: each halving of the bars quarters the error (slope 2 +- 0.15); at 64 bars 0.23 / 64^2 = 6e-5 is left, and
    Richardson's extrapolation leaves the axial strain P / EA = 2e-6 and terms of order 4: 1e-5.
    """
    m = brentq(lambda m: 2 * ellipe(m) / ellipk(m) - 1.5, 0.1, 0.9)
    exact = np.sqrt(m) / ellipk(m)
    assert exact == pytest.approx(0.373306, abs=5e-7)
    arc = brentq(lambda a: np.sin(a) / a - 0.5, 1.0, 3.0)
    rises = []
    for n in (8, 16, 32, 64):
        x = chain(arc * (1 - 2 * (np.arange(n) + 0.5) / n), 1.0 / n)
        shape = solved(x, [{"particles": [0, n], "targets": [[0, 0, 0], [0.5, 0, 0]]}])
        rises.append(shape[:, 2].max())
    errors = [r - exact for r in rises]
    assert np.abs(slopes(errors) - 2.0).max() <= 0.15
    assert abs(errors[-1]) <= 6e-5
    assert abs((4 * rises[-1] - rises[-2]) / 3 - exact) <= 1e-5


def clamped(n: int, headings: np.ndarray, load: list[float]) -> np.ndarray:
    """Tip of a rod of length 1 clamped at the origin along x: the clamp is the middle of a held bar."""
    length = 1.0 / (n - 0.5)
    x = chain(np.concatenate([[0.0], headings]), length) - [0.5 * length, 0.0, 0.0]
    return np.asarray(solved(x, [{"particles": [0, 1]}], Unary(particles=[n], vector=load))[n])


@pytest.mark.slow
def test_elastica_column_with_sixty_degrees_at_its_free_end() -> None:
    """P / Pcr = (2 K / pi)^2 = 1.1517: x / l = 2 E / K - 1 = 0.7410, y / l = 2 k / K = 0.5932, k = sin 30 degrees.

    Timoshenko and Gere, Theory of Elastic Stability, 1961, table 2-4. Order 2; at 64 bars 0.36 / 64^2 = 9e-5; after
    extrapolation terms of order 3 and 4 (the clamp in a half bar) leave 1e-5.
    """
    k = np.sin(np.radians(30.0))
    big_k, big_e = ellipk(k * k), ellipe(k * k)
    exact = np.array([2 * big_e / big_k - 1, 2 * k / big_k])
    assert (2 * big_k / np.pi) ** 2 == pytest.approx(1.1517, abs=5e-5)
    assert exact == pytest.approx([0.7410, 0.5932], abs=5e-5)
    tips = []
    for n in (16, 32, 64):
        start = np.radians(60.0) * np.sin(np.pi / 2 * np.linspace(0, 1, n - 1))
        tips.append(clamped(n, start, [-(big_k**2), 0.0, 0.0])[[0, 2]])
    errors = np.array(tips) - exact
    for column in errors.T:
        assert np.abs(slopes(list(column)) - 2.0).max() <= 0.15
    assert np.abs(errors[-1]).max() <= 9e-5
    # half bars: the length of a bar is 1 / (n - 1/2)
    ratio = (63.5 / 31.5) ** 2
    assert np.abs((ratio * tips[2] - tips[1]) / (ratio - 1) - exact).max() <= 1e-5


@pytest.mark.slow
def test_cantilever_with_a_large_tip_load() -> None:
    """P L^2 / EI = 2: w / L = 0.49346, u / L = 0.16064 (Mattiasson, Int. J. Numer. Meth. Eng. 17, 1981, table 1).

    At 64 bars the error of order 2 is 0.17 / 64^2 = 4e-5; extrapolated, the five digits of the table hold.
    """
    tips = [clamped(n, np.zeros(n - 1), [0.0, 0.0, 2.0])[[2, 0]] for n in (16, 32, 64)]
    found = np.array(tips) * [1, -1] + [0, 1]
    exact = np.array([0.49346, 0.16064])
    assert np.abs(found[-1] - exact).max() <= 5e-5
    ratio = (63.5 / 31.5) ** 2
    assert np.abs((ratio * found[2] - found[1]) / (ratio - 1) - exact).max() <= 1e-5
    assert np.log2((found[1] - found[0])[1] / (found[2] - found[1])[1]) == pytest.approx(2.0, abs=0.15)


def transverse(forces: list[Any], x: np.ndarray) -> np.ndarray:
    """Tangent stiffness of the sideways (z) movements of the inner particles."""
    system = compile(Scene(particles=x, forces=forces))
    state = system.start()
    whole = np.zeros((3 * len(x), 3 * len(x)))
    for group, memory in zip(system.groups, state.memory, strict=True):
        for block, index in zip(system.stiffness_blocks(group, state, memory), group.block.indices, strict=True):
            place = (3 * index[:, None] + np.arange(3)).ravel()
            whole[np.ix_(place, place)] += block
    inner = slice(5, -3, 3)
    return whole[inner, inner]


@pytest.mark.parametrize(("n", "printed"), [(2, 8.0), (4, 9.37258), (10, 9.78870), (40, 9.86453)])
def test_hencky_bar_chain_buckles_at_its_exact_load(n: int, printed: float) -> None:
    """P_n = (4 n^2 EI / L^2) sin^2(pi / 2n), pinned (Wang et al., Hencky Bar-Chain/Net, 2020, 2.2); n = 10: 9.78870.

    The smallest P at which bending stiffness minus P times the geometric stiffness of unit compression is singular.
    Tangents by central differences of step 1e-6 l: relative error 1e-6^2 + eps / 1e-6 = 2e-10, times the spread of
    eigenvalues (2n / pi)^2 = 650 at n = 40: 1.5e-7.
    """
    x = np.column_stack([np.linspace(0.0, 1.0, n + 1), np.zeros(n + 1), np.zeros(n + 1)])
    i = np.arange(n + 1)
    corners = Bend(particles=np.column_stack([i[:-2], i[1:-1], i[2:]]))
    # stiffness 0.5 at twice the length: compression 0.5 / n everywhere
    bars = Springs(particles=np.column_stack([i[:-1], i[1:]]), stiffness=0.5, rest_factor=2.0, damping=0.0)
    geometric = -transverse([bars], x) * 2.0 * n
    loads = eigh(transverse([corners], x), geometric, eigvals_only=True)
    exact = 4.0 * n**2 * np.sin(np.pi / (2 * n)) ** 2
    assert exact == pytest.approx(printed, abs=5e-6)
    assert loads[0] == pytest.approx(exact, rel=2e-7)


def corner(x: np.ndarray, **more: Any) -> tuple[np.ndarray, np.ndarray, float]:
    """Forces, lumped stiffness and energy of one corner."""
    system = compile(Scene(particles=x, forces=[Bend(particles=[[0, 1, 2]], **more)]))
    f, w, energy = system.evaluate(system.start())
    return f, w, float(energy.sum())


@seeded
@given(seed=st.integers(0, 2**32 - 1), rest=st.floats(0.0, 3.0))
def test_force_is_minus_the_gradient_and_balances(seed: int, rest: float) -> None:
    """f = -dE/dx to 1e-6 of EI / l^2 + largest force; sums of force and moment 0 to 1e-12 of their sizes.

    The strength follows the start lengths, so differences are taken of the kernel of one system. Corners nearer than
    0.02 to straight or folded are left to the tests below: with a rest angle the energy has a cone there.
    """
    rng = np.random.default_rng(seed)
    x = np.array([[-1.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.8, 0.6, 0.0]]) + 0.4 * rng.uniform(-1, 1, (3, 3))
    system = compile(Scene(particles=x, forces=[Bend(particles=[[0, 1, 2]], stiffness=2.0, rest_angle=rest)]))
    state = system.start()
    state.x = x + 0.3 * rng.uniform(-1, 1, (3, 3))
    u, v = np.diff(state.x, axis=0)
    assume(np.linalg.norm(np.cross(u, v)) > 0.02 * np.linalg.norm(u) * np.linalg.norm(v))
    f, _, _ = system.evaluate(state)
    slope = np.zeros_like(x)
    for spot in np.ndindex(3, 3):
        for sign in (1.0, -1.0):
            moved = state.copy()
            moved.x[spot] += sign * 1e-5
            slope[spot] += sign * system.evaluate(moved)[2].sum() / 2e-5
    scale = np.abs(f).max() + 2.0
    assert np.abs(f + slope).max() <= 1e-6 * scale
    assert np.abs(f.sum(axis=0)).max() <= 1e-12 * scale
    assert np.abs(np.cross(state.x, f).sum(axis=0)).max() <= 1e-12 * scale * np.ptp(state.x, axis=0).max()


@pytest.mark.parametrize("angle", [0.0, 1e-12, 1e-7, 0.01, 1.0, 3.0])
def test_energy_and_forces_of_a_known_corner(angle: float) -> None:
    """E = EI angle^2 / (2 l), l the mean of 1 and 3; smooth through straight: end forces EI angle / (l length)."""
    x = np.array([[-1.0, 0, 0], [0, 0, 0], [3 * np.cos(angle), 0, 3 * np.sin(angle)]])
    f, _, energy = corner(x, stiffness=5.0, rest_angle=0.0)
    assert energy == pytest.approx(5.0 * angle**2 / 4.0, rel=1e-13, abs=1e-30)
    moment = 5.0 * angle / 2.0
    assert f[0] == pytest.approx([0, 0, -moment], rel=1e-13, abs=10 * EPS * angle)
    assert f[2] == pytest.approx(np.array([np.sin(angle), 0, -np.cos(angle)]) * moment / 3, rel=1e-12, abs=1e-15)


def test_rest_angle_is_as_drawn_straight_or_given() -> None:
    """None: no force as drawn; factor 0: straight; measured angle and moment agree."""
    x = np.array([[-1.0, 0, 0], [0, 0, 0], [0.6, 0.8, 0]])
    angle = np.arccos(0.6)
    assert np.abs(corner(x)[0]).max() <= 10 * EPS
    assert corner(x, angle_factor=0.5)[2] == pytest.approx(angle**2 / 8, rel=1e-13)
    result = relax(
        Scene(
            particles=x,
            forces=[Bend(particles=[[0, 1, 2]], stiffness=3.0, rest_angle=0.2)],
            anchors=[{"particles": [0, 1, 2]}],
        )
    )
    measured = result.force("bend")
    assert measured["angle"][0] == pytest.approx(angle, rel=1e-14)
    assert measured["moment"][0] == pytest.approx(3.0 * (angle - 0.2), rel=1e-13)


def test_a_free_corner_finds_its_rest_angle() -> None:
    """Unloaded, with stiff bars: the turning angle becomes the rest angle, in whatever plane the corner lies."""
    x = np.array([[-1.0, 0, 0], [0, 0, 0], [0.9, 0.1, 0.3]])
    forces = [
        Springs(particles=[[0, 1], [1, 2]], stiffness=100.0),
        Bend(particles=[[0, 1, 2]], stiffness=1.0, rest_angle=1.2),
    ]
    result = relax(Scene(particles=x, forces=forces, anchors=[{"particles": [0, 1]}], settings={"tolerance": 1e-9}))
    assert result.converged
    assert result.force("bend")["angle"][0] == pytest.approx(1.2, abs=1e-7)


def test_a_straight_corner_with_a_rest_angle_stays_until_something_bends_it() -> None:
    """There is no side to bend to: no force, but the energy of the turn that is missing; 1e-6 aside it bends fully."""
    x = np.array([[-1.0, -2, 3], [0, 0, 0], [1, 2, -3]])
    f, w, energy = corner(x, rest_angle=0.5)
    length = np.sqrt(14.0)
    assert (f == 0).all() and (w > 0).all()
    assert energy == pytest.approx(0.125 / length, rel=1e-14)
    x[2] += [1e-6 * length, 0, 0]
    f, _, _ = corner(x, rest_angle=0.5)
    assert np.linalg.norm(f[0]) == pytest.approx(0.5 / length / length, rel=1e-5)


@pytest.mark.parametrize("angle", [0.05, 0.5, 1.5, 2.5, 3.1])
@pytest.mark.parametrize("rest", [0.0, 0.3, 2.0, 3.1])
def test_lumped_stiffness_bounds_the_tangent(angle: float, rest: float) -> None:
    """diag(w) - K has no negative eigenvalue, bent far from rest too, to 1e-7 of the largest w (differences)."""
    x = np.array([[-1.0, 0, 0], [0, 0, 0], [1.7 * np.cos(angle), 0, 1.7 * np.sin(angle)]])
    system = compile(Scene(particles=x, forces=[Bend(particles=[[0, 1, 2]], rest_angle=rest)]))
    state = system.start()
    _, w, _ = system.evaluate(state)
    tangent = system.stiffness_blocks(system.groups[0], state, state.memory[0])[0]
    assert np.linalg.eigvalsh(np.diag(np.repeat(w, 3)) - tangent).min() >= -1e-7 * w.max()


def _shapes() -> dict[str, np.ndarray]:
    line = np.outer(np.arange(3.0), [0.3, -0.2, 0.9])
    return {
        "all at one place": np.ones((3, 3)),
        "first bar without length": line[[0, 0, 1]],
        "second bar without length": line[[0, 1, 1]],
        "folded onto itself": line[[0, 1, 0]],
        "straight": line,
        "1e-200 apart": line * 1e-200,
        "1e-70 apart": line[[0, 2, 1]] * 1e-70,
        "1e11 apart": line * 1e11,
        "1e-12 beside 1": np.array([[0, 0, 0], [1, 0, 0], [1, 1e-12, 0]]),
    }


@pytest.mark.parametrize("rest", [0.0, 0.5, 4.0])
@pytest.mark.parametrize("name", _shapes())
def test_degenerate_corners_stay_finite(name: str, rest: float) -> None:
    """No nan, no infinity; bars without length or 1e8 times as short as the other do not bend."""
    x = _shapes()[name]
    bent = Bend(particles=[[0, 1, 2]], rest_angle=rest / 2.0, angle_factor=2.0)
    system = compile(Scene(particles=line_of(3), forces=[bent]))
    state = system.start()
    state.x = np.ascontiguousarray(x)
    with np.errstate(all="raise", under="ignore"):
        f, w, energy = system.evaluate(state)
        corner(x, rest_angle=rest / 2.0, angle_factor=2.0)
    assert np.isfinite(f).all() and np.isfinite(w).all() and np.isfinite(energy).all()
    if "without" in name or "place" in name or "beside" in name:
        assert (f == 0).all() and (w == 0).all() and energy.sum() == 0.0


def line_of(count: int) -> np.ndarray:
    """Particles along x, 1 apart."""
    return np.column_stack([np.arange(float(count)), np.zeros(count), np.zeros(count)])
