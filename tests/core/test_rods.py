"""Rods drawn curved, whose rest curvature has a side: the elastica, bow girders, Kirchhoff's rod, coils; tangents."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_bvp, solve_ivp
from scipy.optimize import root

from hookean import Scene, relax
from hookean.solvers import solver
from hookean.system.system import System, compile

from .rods import AXIAL, RADIUS, RISE, SLOPE, apart, arch, bending, coil, rod, several, shaken


def orders(errors: list[float]) -> np.ndarray:
    """Order of convergence between successive doublings."""
    sizes = np.abs(errors)
    return np.log2(sizes[:-1] / sizes[1:])


# --- in a plane ------------------------------------------------------------------------------------------------------


def pinched_ring(force: float, axial: float) -> float:
    """Half the height of a ring of EI = R = 1 between two opposite forces: a quarter of it by the elastica, extensible.

    theta' = kappa, kappa' = (1 + e) F / 2 cos theta, e = -F sin theta / 2 EA; theta from 0 at a force to pi / 2, where
    the axis of symmetry is.
    """

    def slope(half: float, y: np.ndarray) -> np.ndarray:
        stretch = 1.0 - half * np.sin(y[1]) / axial
        return np.array([stretch * np.sin(y[1]), y[2], half * stretch * np.cos(y[1])])

    s = np.linspace(0.0, np.pi / 2, 101)
    y = np.array([1.0 - np.cos(s), s, np.ones_like(s)])
    for half in np.array([0.3, 0.6, 0.8, 1.0]) * force / 2:
        rates = partial(lambda half, _, y: slope(half, y), half)
        found = solve_bvp(rates, lambda a, b: np.array([a[0], a[1], b[1] - np.pi / 2]), s, y, tol=1e-7)
        assert found.success
        s, y = found.x, found.y
    return float(y[0, -1])


@pytest.mark.soak
def test_a_ring_pinched_by_two_forces() -> None:
    """F = 3 at EI = R = 1: half height 0.690; at the forces the curvature is reversed, where an angle without a side
    would take it for one to the same side. Order 2: slopes 2 +- 0.15, and 8 / 320^2 = 8e-5 at 320 bars.

    The forces would turn the ring over: it stands between the anchors that keep them on one line.
    """
    exact = pinched_ring(3.0, 1e4)
    assert exact == pytest.approx(0.690, abs=5e-4)
    errors = []
    for n in (40, 80, 160, 320):
        turn = 2 * np.pi * np.arange(n) / n
        x = np.column_stack([np.sin(turn), np.zeros(n), np.cos(turn)])
        loads = {"kind": "unary", "particles": [0, n // 2], "vector": [[0, 0, -3], [0, 0, 3]]}
        anchors = [{"particles": [0, n // 2], "axes": "xy"}, {"particles": [n // 4, 3 * n // 4], "axes": "z"}]
        result = relax(Scene(particles=x, forces=[*rod(x, 1e4, closed=True), loads], anchors=anchors))
        assert result.converged, result.message
        assert result.force("bend")["moment"].min() < -1.0  # the curvature at rest is 1
        errors.append((result.particles[0, 2] - result.particles[n // 2, 2]) / 2 - exact)
    assert np.abs(orders(errors) - 2.0).max() <= 0.15
    assert abs(errors[-1]) <= 8e-5


def snapped_arch(force: float) -> float:
    """Moment at the crown of the arch between pins, pushed through by a force there: half of it by the elastica.

    theta' = kappa = -1 / R + M, M' = (1 + e) (V cos theta - H sin theta), e = -(H cos theta + V sin theta) / EA.
    """
    s = np.linspace(0.0, RADIUS * SLOPE, 101)

    def slope(_: Any, y: np.ndarray, p: np.ndarray) -> np.ndarray:
        stretch = 1.0 - (p[0] * np.cos(y[2]) + force / 2 * np.sin(y[2])) / AXIAL
        push = force / 2 * np.cos(y[2]) - p[0] * np.sin(y[2])
        return np.array([stretch * np.cos(y[2]), stretch * np.sin(y[2]), y[3] - 1 / RADIUS, stretch * push])

    def limits(a: np.ndarray, b: np.ndarray, p: np.ndarray) -> np.ndarray:
        return np.array([a[0], a[1], a[3], b[0] - 0.5, b[2]])

    guess = np.array([s, -1.4 * RISE * np.sin(np.pi * s / s[-1] / 2), -0.25 * np.cos(np.pi * s / s[-1] / 2), 2 * s])
    found = solve_bvp(slope, limits, s, guess, p=[-20.0], tol=1e-8, max_nodes=20000)
    assert found.success and found.y[1, -1] < -RISE
    return float(found.y[3, -1])


def pushed(n: int, force: float, **bend: Any) -> Any:
    """The arch between pins under a force at its crown."""
    load = {"kind": "unary", "particles": [n // 2], "vector": [0, 0, -force]}
    anchors = [{"particles": [0, n]}]
    result = relax(Scene(particles=arch(n), forces=[*rod(arch(n), AXIAL, **bend), load], anchors=anchors))
    assert result.converged, result.message
    return result


@pytest.mark.soak
def test_a_shallow_arch_that_is_pushed_through_bends_against_its_curvature() -> None:
    """Rise 0.05, F = 20: snapped through it hangs 0.071 below its pins, and the moment at its crown is 1.87 (1.85 with
    25 bars). Order 2: slopes 2 +- 0.15, 25 / 80^2 = 4e-3 at 80 bars. Sections that spin turn their curvature over
    instead, and bear less than two thirds of that."""
    exact = snapped_arch(20.0)
    assert exact == pytest.approx(1.8675, abs=5e-4)
    moments = [-pushed(n, 20.0).force("bend")["moment"][n // 2 - 1] for n in (20, 40, 80)]
    errors = [m - exact for m in moments]
    assert np.abs(orders(errors) - 2.0).max() <= 0.15
    assert abs(errors[-1]) <= 4e-3
    assert np.abs(pushed(40, 20.0, sections="free").force("bend")["moment"]).max() < exact / 1.5


def test_an_arch_turned_inside_out_costs_the_energy_of_twice_its_curvature() -> None:
    """E = EI (2 kappa0)^2 L / 2 between anchors, exactly so for equal bars: sum of (2 phi0)^2 / 2 l over the corners.

    On the way, straight, it is a quarter of that. Free, the shape is the same one turned over, and costs nothing; so it
    does where sections spin, and there it costs a quarter on the way.
    """
    n = 24
    x, flat = arch(n), arch(n) * [1, 1, 0]
    mirrored = arch(n) * [1, 1, -1]
    length = np.linalg.norm(x[1] - x[0])
    most = (n - 1) * (2 * 2 * SLOPE / n) ** 2 / (2 * length)
    assert bending(x, mirrored, [0, n]) == pytest.approx(most, rel=1e-12)
    assert bending(x, mirrored, [0]) == pytest.approx(most, rel=1e-12)
    assert bending(x, flat, [0, n]) == pytest.approx(most / 4, rel=1e-12)
    assert bending(x, mirrored, []) <= 1e-24 * most
    assert bending(x, mirrored, [0, n], sections="free") <= 1e-24 * most
    assert bending(x, flat, [0, n], sections="free") == pytest.approx(most / 4, rel=1e-12)


def test_half_of_a_rod_turned_over_costs_energy_though_it_is_free() -> None:
    """An S of the same curvature as the arch that was drawn: no spin of all sections makes one of the other. E = sum of
    phi0^2 / l but for the corner in the middle, straight: half of its own is missing."""
    n = 24
    heading = SLOPE * (1 - 2 * (np.arange(n) + 0.5) / n)
    steps = np.where(np.arange(n) < n // 2, heading, -heading)
    shapes = [
        np.vstack([np.zeros(3), np.cumsum(np.column_stack([np.cos(h), 0 * h, np.sin(h)]), axis=0)])
        for h in (heading, steps)
    ]
    phi = 2 * SLOPE / n
    # the corner in the middle turns by nothing: 11 corners to each side cancel
    expected = sum(phi**2 for _ in range(n - 2)) + phi**2 / 2
    assert bending(*shapes, []) == pytest.approx(expected, rel=1e-12)
    assert bending(*shapes, [], sections="free") == pytest.approx(phi**2 / 2, rel=1e-12)


# --- in space --------------------------------------------------------------------------------------------------------


def bow(n: int) -> np.ndarray:
    """A quarter of a circle of radius 1 in the XY plane of n - 1/2 bars; its clamp is the middle of the first one."""
    turn = np.pi / 2 * (np.arange(n + 1) - 0.5) / (n - 0.5)
    return np.column_stack([np.sin(turn), 1.0 - np.cos(turn), np.zeros(n + 1)]) * 0.5 * turn[1] / np.sin(0.5 * turn[1])


def tip_of(n: int, force: list[float], **settings: Any) -> np.ndarray:
    """Where the tip of the clamped bow goes under a force there."""
    x = bow(n)
    load = {"kind": "unary", "particles": [n], "vector": force}
    settings = {"tolerance": 1e-9, "solver": "newton", **settings}
    result = relax(Scene(particles=x, forces=[*rod(x, 1e5), load], anchors=[{"particles": [0, 1]}], settings=settings))
    assert result.converged, result.message
    return np.asarray(result.particles[n] - x[n])


def test_a_bow_girder_bears_a_load_across_its_plane() -> None:
    """A quarter of a circle, clamped, with a force across at its tip: sinks by F R^3 (pi / 4 EI + (3 pi / 4 - 2) / GJ),
    of which the second part is nothing (Roark's Formulas for Stress and Strain, curved beams). Order 2.

    It can only because the clamp holds its first section, and twist does not give: by bending alone it would swing.
    """
    errors = [tip_of(n, [0, 0, 1e-4])[2] / 1e-4 - np.pi / 4 for n in (10, 20, 40)]
    assert np.abs(orders(errors) - 2.0).max() <= 0.15
    assert abs(errors[-1]) <= 4e-4


def kirchhoff_tip(force: np.ndarray) -> np.ndarray:
    """The same by Kirchhoff's rod without twist: r' = d3, d' = (kappa + kappa0) x d, m' = F x d3, m = EI kappa but
    for its part along d3, which nothing gives way to; shooting for m at the clamp, so that it is 0 at the tip."""

    def rates(_: float, y: np.ndarray, load: np.ndarray) -> np.ndarray:
        frame, moment = y[3:12].reshape(3, 3), y[12:]
        turn = moment - (moment @ frame[2]) * frame[2] + frame[0]  # drawn, it bends by 1 about its first director
        return np.concatenate([frame[2], np.cross(turn, frame).ravel(), -np.cross(frame[2], load)])

    def shot(moment: np.ndarray, load: np.ndarray) -> np.ndarray:
        frame = np.array([[0.0, 0, 1], [0, -1, 0], [1, 0, 0]])  # d1, d2, d3
        start = np.concatenate([np.zeros(3), frame.ravel(), moment])
        return np.asarray(solve_ivp(rates, (0, np.pi / 2), start, args=(load,), rtol=1e-11, atol=1e-12).y[:, -1])

    moment = np.zeros(3)
    for part in (0.25, 0.5, 0.75, 1.0):
        found = root(lambda m, load: shot(m, load)[12:], moment, args=(part * force,), tol=1e-12)
        moment = found.x
    assert np.abs(found.fun).max() <= 1e-10
    return shot(moment, force)[:3] - [1.0, 1.0, 0.0]


@pytest.mark.soak
def test_a_bow_in_large_deflection_is_kirchhoffs_rod_without_twist() -> None:
    """A force of 1.5 EI / R^2 askew at the tip, which moves by 0.8 R: order 2, and 1e-3 R at 40 bars."""
    force = np.array([0.4, -0.5, 1.35])
    exact = kirchhoff_tip(force)
    assert np.linalg.norm(exact) > 0.7
    errors = [np.linalg.norm(tip_of(n, list(force)) - exact) for n in (10, 20, 40)]
    assert np.abs(orders(errors) - 2.0).max() <= 0.15
    assert errors[-1] <= 1e-3


@pytest.mark.soak
def test_a_drawn_coil_stays_where_it_is_and_comes_back() -> None:
    """No force as drawn, and none to move it; shaken by a fifth of its bars, free or on a clamp, the same shape again.

    Energy E leaves distances off by sqrt(2 E / k) with k = EI / L^3 = 1.5e-4 of the softest motion, at E = 1e-16 of a
    residual of 1e-9: 1e-6.
    """
    x = coil()
    for anchors in ([], [{"particles": [0, 1]}]):
        settings = {"tolerance": 1e-9, "solver": "newton"}
        scene = Scene(particles=x, forces=rod(x, 1e4), anchors=anchors, settings=settings)
        system = compile(scene)
        force, w, energies = system.evaluate(system.start())
        assert np.abs(force).max() <= 1e-13 * w.max()
        assert energies.sum() <= 1e-26 * w.max()
        assert np.array_equal(relax(scene).particles, x)
        back = shaken(scene, 0.06)
        assert back.converged, back.message
        assert np.abs(apart(back.particles) - apart(x)).max() <= 1e-6


def whole_tangent(system: System, x: np.ndarray, *, sparse: bool = False) -> np.ndarray:
    """The tangent stiffness of a system, dense; the unknowns of elements last."""
    state = system.start()
    state.x = x
    elements = system.elements(x, state.memory, sparse=sparse)
    nodes = max(int(group.block.indices.max()) + 1 for group, _ in elements)
    whole = np.zeros((3 * nodes, 3 * nodes))
    for group, memory in elements:
        blocks = system.stiffness_blocks(group, state, memory)
        for block, index in zip(blocks, group.block.indices, strict=True):
            place = (3 * index[:, None] + np.arange(3)).ravel()
            np.add.at(whole, np.ix_(place, place), block)
    used = np.concatenate([np.arange(x.size), np.arange(x.size, 3 * nodes, 3)])
    return whole[np.ix_(used, used)]


def differences(system: System, x: np.ndarray, h: float = 1e-5) -> np.ndarray:
    """The tangent stiffness of a system, dense, by central differences of all forces."""
    state, columns = system.start(), []
    for spot in np.ndindex(*x.shape):
        sides = []
        for sign in (1.0, -1.0):
            state.x = x.copy()
            state.x[spot] += sign * h
            sides.append(system.evaluate(state)[0].ravel())
        columns.append((sides[1] - sides[0]) / (2 * h))
    return np.array(columns)


def test_a_free_coil_is_stable_but_for_rigid_motions() -> None:
    """Six eigenvalues of the tangent are zero, to rounding of its differences (1e-7 of the largest); the others are not
    negative, and the softest is that of a coil: not 1e-7 of EI / L^3."""
    x = coil(40, 2.0, 0.3)
    system = compile(Scene(particles=x, forces=rod(x, 100.0)))
    values = np.linalg.eigvalsh(whole_tangent(system, x))
    assert np.abs(values[:6]).max() <= 1e-7 * values[-1]
    assert values[6] > 3 * np.abs(values[:6]).max()
    assert values[6] > 1e-2 * 1.0 / (4 * np.pi) ** 3


@pytest.mark.parametrize("name", several())
def test_tangents_of_rods_are_the_gradients_of_their_forces(name: str) -> None:
    """Gathered and sparse, as drawn and away from it, against central differences of all forces.

    To 1e-7 of the largest entry gathered; the penalty of the sparse one leaves 1e-5 of what spins make of it.
    """
    x, corners, held = several()[name]
    stiffness = np.random.default_rng(1).uniform(0.3, 3.0, len(corners))
    forces = [{"kind": "bend", "particles": corners, "stiffness": stiffness}]
    system = compile(Scene(particles=x, forces=forces, anchors=[{"particles": held}] if held else []))
    for amount in (0.0, 0.05, 0.2):
        shape = x + amount * np.random.default_rng(2).uniform(-1, 1, x.shape)
        expected = differences(system, shape)
        size = np.abs(expected).max()
        assert np.abs(whole_tangent(system, shape) - expected).max() <= 1e-7 * size
        sparse, n = whole_tangent(system, shape, sparse=True), x.size
        spins = sparse[n:, n:]
        assert np.linalg.eigvalsh(spins).min(initial=1.0) > 0.0  # so that all negative eigenvalues are the shape's own
        condensed = sparse[:n, :n] - sparse[:n, n:] @ np.linalg.solve(spins, sparse[n:, :n])
        assert np.abs(condensed - expected).max() <= 1e-5 * size


@pytest.mark.parametrize("n", [60, 200])
def test_results_know_whether_a_rod_is_stable(n: int) -> None:
    """A coil: 6 motions meet no resistance where nothing holds it, none on a clamp. Factors are dense with 60 bars, and
    with 200 sparse, where spins are unknowns of their own."""
    x = coil(n)
    free = relax(Scene(particles=x, forces=rod(x, 1e3)))
    assert (free.stability, free.soft_modes) == ("mechanism", 6)
    held = relax(Scene(particles=x, forces=rod(x, 1e3), anchors=[{"particles": [0, 1]}]))
    assert held.stability == "stable"
    assert held.position_error is not None and held.position_error <= 1e-10


@pytest.mark.parametrize("n", [40, 150])
def test_unstable_modes_of_a_pressed_ring_are_the_negative_eigenvalues(n: int) -> None:
    """A ring whose bars are pushed together by what balances loads towards its centre: as many as of the central
    differences of its forces, which are right to 1e-8 of the largest eigenvalue.
    """
    turn = 2 * np.pi * np.arange(n) / n
    x = np.column_stack([np.cos(turn), np.sin(turn), np.zeros(n)])
    load = {"kind": "unary", "particles": np.arange(n), "vector": -30.0 * x / n}
    anchors = [{"particles": [0, n // 2], "axes": "yz"}, {"particles": [n // 4], "axes": "xz"}]
    springs, bend = rod(x, 1e3, closed=True)
    springs["rest_length"] = 2 * np.sin(np.pi / n) + 30.0 / n / (2 * np.sin(np.pi / n)) / springs["stiffness"]
    scene = Scene(particles=x, forces=[springs, bend, load], anchors=anchors, settings={"allow_unstable": True})
    result = relax(scene)
    assert result.converged, result.message
    system = compile(scene)
    state = system.start()
    values = np.linalg.eigvalsh(differences(system, result.particles)[np.ix_(*2 * [state.free.ravel() > 0])])
    assert (result.stability, result.iterations) == ("unstable", 0)
    assert result.soft_modes == (values < -1e-7 * values[-1]).sum()
    assert np.abs(values).min() > 1e-7 * values[-1], values[:8] / values[-1]


@pytest.mark.soak
def test_newton_comes_to_the_last_digits_of_a_long_coil_quadratically() -> None:
    """400 corners of three turns, on a clamp: from 1e-3 of the load to rounding in three steps.

    Which is eps k |x| = 2e-16 x 2 EA / l x 2 = 2e-11; a tangent without the spins takes a hundred steps for each digit.
    """
    x = coil(400)
    load = {"kind": "unary", "particles": [400], "vector": [2e-3, 1e-3, 1e-3]}
    scene = Scene(particles=x, forces=[*rod(x, 1e3), load], anchors=[{"particles": [0, 1]}])
    system = compile(scene)
    state, method, residuals = system.start(), solver("newton"), []
    method.start(system, state)
    for _ in range(200):
        if not method.advance(system, state, 1, 1e-12):
            break
        residuals.append(float(np.abs(system.evaluate(state)[0] * state.free).max()))
    near = next(i for i, r in enumerate(residuals) if max(residuals[i:]) < 2e-6)
    assert min(residuals[near : near + 4]) <= 2e-11, residuals
