"""Lines of constant tension that vanish: Fermat's and Steiner's points, plane nets, derivatives where lines close up.

A closed line has T l / e with e = 1e-3 of the mean start length of all lines: where others pull its ends apart with
R < T, its length is e R / T.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.spatial import Voronoi

from hookean import ConstantTension, Scene, relax
from hookean.designing.sensitivity import sensitivity
from hookean.solvers.newton import Method as Newton
from hookean.system.balance import balance
from hookean.system.state import State
from hookean.system.system import compile

from ..laws import laws
from ..laws.cases import Case, case_of

EXACT = ["auto", "newton", "momentum", "relaxation"]


def web(particles: Any, lines: Any, held: Any, tension: Any = 1.0, **settings: Any) -> Scene:
    force = {"kind": "constant_tension", "name": "lines", "particles": lines, "tension": tension}
    anchors = [{"name": "held", "particles": held}]
    return Scene(particles=particles, forces=[force], anchors=anchors, settings={"tolerance": 1e-9, **settings})


def star(anchors: Any, start: Any, **more: Any) -> Scene:
    """One particle tied to each anchor."""
    return web([*anchors, start], [[i, len(anchors)] for i in range(len(anchors))], list(range(len(anchors))), **more)


def closing(scene: Scene) -> float:
    """e, from the scene as it is given."""
    ends = np.asarray(scene.particles)[np.asarray(scene.forces[0].particles)]
    return 1e-3 * float(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).mean())


WIDE = [[0.0, 0.0, 0.0], [4.0, 1.0, 0.0], [-3.0, 1.0, 0.0]]
"""A triangle with more than 120 degrees at its first corner."""


@pytest.mark.parametrize("solver", EXACT)
def test_fermats_point_at_an_anchor(solver: str) -> None:
    """Where a corner has more than 120 degrees, Fermat's point is the corner: its line vanishes and holds there what
    the other two pull with, R = T |u1 + u2| < T. At a distance e R / T from the corner u1 and u2 are turned by as much
    over the shorter of both, so R by twice that."""
    scene = star(WIDE, [0.5, 1.5, 0.3], tension=7.0, solver=solver)
    found, e = relax(scene), closing(scene)
    assert found.converged
    arms = np.array(WIDE[1:]) / np.linalg.norm(WIDE[1:], axis=1)[:, None]
    pull = 7.0 * np.linalg.norm(arms.sum(axis=0))
    near = 2.0 * 7.0 * e / np.sqrt(10.0)
    assert found.forces[0]["force"] == pytest.approx([pull, 7.0, 7.0], abs=near)
    assert found.particles[3] == pytest.approx(e * arms.sum(axis=0), abs=near / 7.0 * e + 1e-8)
    assert found.forces[0]["length"][0] == pytest.approx(e * found.forces[0]["force"][0] / 7.0, rel=1e-12)


@pytest.mark.parametrize("solver", EXACT)
def test_fermats_point_of_four_anchors(solver: str) -> None:
    """Of a convex quadrangle: where the diagonals cross. Of three corners and a point within: that point, where it
    balances the three with |u1 + u2 + u3| < 1."""
    corners = [[0.0, 0.0, 0.0], [4.0, 0.5, 0.0], [5.0, 3.0, 0.0], [-1.0, 2.0, 0.0]]
    (a, b, c, d) = np.array(corners)[:, :2]
    part, _ = np.linalg.solve(np.column_stack([c - a, b - d]), b - a)
    found = relax(star(corners, [1.0, 1.0, 0.2], solver=solver))
    assert found.converged
    assert found.particles[4] == pytest.approx([*(a + part * (c - a)), 0.0], abs=1e-7)

    inner = [[0.0, 0.0, 0.0], [6.0, 0.0, 0.0], [1.0, 5.0, 0.0], [2.0, 1.5, 0.0]]
    arms = np.array(inner[:3]) - inner[3]
    arms /= np.linalg.norm(arms, axis=1)[:, None]
    scene = star(inner, [3.0, 2.0, 0.4], solver=solver)
    found, e = relax(scene), closing(scene)
    assert found.converged
    # the shortest arm is 2.5 long: a step of e turns the three by 3 e / 2.5 together
    assert found.particles[4] == pytest.approx(inner[3] + e * arms.sum(axis=0), abs=1.2 * e * e + 1e-8)


RECTANGLE = np.array([[0.0, 0.0, 0.0], [0.0, 2.0, 0.0], [4.0, 0.0, 0.0], [4.0, 2.0, 0.0]])
POINTS = [[1.3, 0.8, 0.1], [2.5, 1.4, -0.2]]


@pytest.mark.parametrize("solver", EXACT)
def test_steiners_tree_of_a_rectangle(solver: str) -> None:
    """Two points between the sides of length a, b apart: least length b + sqrt(3) a, all angles 120 degrees."""
    a, b = 2.0, 4.0
    lines = [[0, 4], [1, 4], [4, 5], [2, 5], [3, 5]]
    found = relax(web([*RECTANGLE, *POINTS], lines, [0, 1, 2, 3], solver=solver))
    assert found.converged
    assert found.energy["total"] == pytest.approx(b + np.sqrt(3.0) * a, rel=1e-12)
    off = 0.5 * a / np.sqrt(3.0)
    assert found.particles[4:] == pytest.approx(np.array([[off, 0.5 * a, 0.0], [b - off, 0.5 * a, 0.0]]), abs=1e-7)


@pytest.mark.parametrize("solver", ["auto", "newton", "momentum"])
def test_a_tree_with_the_wrong_neighbours_loses_its_middle_line(solver: str) -> None:
    """The same points tied to the ends of the sides of length b instead, b > sqrt(3) a: both come to where the
    diagonals cross, and the line between them holds R = 2 a / sqrt(a² + b²) of each pair of arms."""
    a, b = 2.0, 4.0
    scene = web([*RECTANGLE, *POINTS], [[0, 4], [2, 4], [4, 5], [1, 5], [3, 5]], [0, 1, 2, 3], solver=solver)
    found, e = relax(scene), closing(scene)
    assert found.converged
    held = 2.0 * a / np.hypot(a, b)
    # the points move by e / 2 each: the arms turn by that over their length, half a diagonal
    assert found.forces[0]["force"][2] == pytest.approx(held, abs=2.0 * e / np.hypot(a, b))
    # e / 2 at l = 0, and (1 - R²) of that where it has its length; the rest is of the order of e²
    assert found.energy["total"] == pytest.approx(2.0 * np.hypot(a, b) + 0.5 * e * (1.0 - held**2), abs=e * e)


def foam(cells: int, seed: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The edges of the cells about random points of a square of 10 x 10, cut at its rim: points, lines, and which
    points are on the rim."""
    diagram = Voronoi(np.random.default_rng([8, seed]).uniform(0.0, 10.0, (cells, 2)))
    points = diagram.vertices
    inside = ((points > 0.0) & (points < 10.0)).all(axis=1)
    edges = np.array([pair for pair in diagram.ridge_vertices if min(pair) >= 0])
    edges = edges[inside[edges].any(axis=1)]
    edges = np.where(inside[edges[:, :1]], edges, edges[:, ::-1])  # from within
    cut = ~inside[edges[:, 1]]
    start, way = points[edges[cut, 0]], points[edges[cut, 1]] - points[edges[cut, 0]]
    part = np.where(way > 0.0, (10.0 - start) / way, -start / way).min(axis=1)
    edges[cut, 1] = len(points) + np.arange(cut.sum())
    used, edges = np.unique(edges, return_inverse=True)
    x = np.concatenate([points, start + part[:, None] * way])[used]
    rim = np.flatnonzero(used >= len(points))
    return np.column_stack([x, np.zeros(len(x))]), edges.reshape(-1, 2), rim


@pytest.mark.slow
@pytest.mark.parametrize("seed", [0, 1, 2])
def test_a_foam_collapses_to_the_same_energy_by_all_solvers(seed: int) -> None:
    """Sixty cells whose edges pull alike: most of them vanish. The energy is convex, so that all equilibria have the
    same. A run that does not come to rest reports that."""
    x, lines, rim = foam(60, seed)
    found = relax(web(x, lines, rim, tolerance=1e-6, solver="newton"))
    assert found.converged
    assert found.iterations <= 40
    closed = found.forces[0]["length"] < closing(web(x, lines, rim))
    assert closed.mean() > 0.3
    for solver in ("auto", "relaxation"):
        other = relax(web(x, lines, rim, tolerance=1e-6, solver=solver, max_iterations=20_000))
        assert other.converged or solver == "relaxation"
        if other.converged:
            assert other.energy["total"] == pytest.approx(found.energy["total"], rel=1e-7)
        else:
            assert other.status in ("max_iterations", "stalled", "diverged")
            assert other.residual > 1e-6


@pytest.mark.soak
@pytest.mark.parametrize("seed", [0, 1, 2])
def test_a_foam_collapses_to_the_same_energy_by_momentum_and_in_time(seed: int) -> None:
    x, lines, rim = foam(60, seed)
    least = relax(web(x, lines, rim, tolerance=1e-6, solver="newton")).energy["total"]
    for solver in ("momentum", "verlet"):
        found = relax(web(x, lines, rim, tolerance=1e-6, solver=solver, max_iterations=300_000))
        assert found.converged or solver == "verlet"
        if found.converged:
            assert found.energy["total"] == pytest.approx(least, rel=1e-6)


def test_a_foam_of_300_cells_takes_newton_some_twenty_steps() -> None:
    """As many as one of sixty cells, and each makes the energy less."""
    x, lines, rim = foam(300, 0)
    found = relax(web(x, lines, rim, tolerance=1e-6))
    assert found.converged
    assert found.iterations <= 60


def test_steps_go_on_from_a_saved_state_to_the_bit() -> None:
    """The directions are in what the solver remembers."""
    x, lines, rim = foam(20, 3)
    system = compile(web(x, lines, rim))

    def stepped(keep: bool) -> np.ndarray:
        state, method = system.start(), Newton()
        method.start(system, state)
        for _ in range(3):
            assert method.advance(system, state, 3, 0.0) == 3
            if keep:
                state, method = State.of({name: array.copy() for name, array in state.arrays().items()}), Newton()
        return state.x

    assert np.array_equal(stepped(True), stepped(False))
    assert not np.array_equal(stepped(False), system.x)


def shrunk(part: float) -> Case:
    """The example, and two more lines between points `part` of e apart: one pulls, one pushes."""
    force, x = ConstantTension.example()
    e = 1e-3 * float(np.linalg.norm(x[force.particles[:, 1]] - x[force.particles[:, 0]], axis=1).mean())
    pairs = np.concatenate([force.particles, [[4, 5], [6, 7]]])
    case = case_of("closed", ConstantTension(particles=pairs, tension=[*force.tension, 2.0, -3.0]),
                   np.concatenate([x, x + [3.0, 0.0, 0.0]]))  # fmt: skip
    case.block.parameters[:, 1] = e
    case.x[5], case.x[7] = case.x[4] + part * e * np.array([0.6, 0.0, 0.8]), case.x[6] + [0.0, -part * e, 0.0]
    return case


@pytest.mark.parametrize("part", [0.05, 0.5])
def test_laws_hold_where_lines_close_up(part: float) -> None:
    for seed in range(5):
        for law in (laws.force_is_the_gradient, laws.nothing_from_outside, laws.tangent_is_the_gradient_of_the_force):
            law(shrunk(part), np.random.default_rng(seed))
        laws.lumped_stiffness_bounds_the_tangent(shrunk(part), np.random.default_rng(seed), 0.15)


def test_force_and_energy_are_continuous_where_a_line_begins_to_close() -> None:
    below, above = shrunk(1.0 - 1e-12), shrunk(1.0 + 1e-12)
    (f, w, energy), (g, v, other) = below.force(below.x), above.force(above.x)
    assert f == pytest.approx(g, abs=1e-11 * 3.0)
    assert w == pytest.approx(v, rel=1e-11)
    assert energy == pytest.approx(other, rel=1e-15)


def test_a_shape_with_closed_lines_is_stable_and_known_to_its_position_error() -> None:
    """A line that is closed holds its ends with T / e on all axes; one Newton step more moves by no more than is said,
    within its factor of 3."""
    found = relax(star(WIDE, [0.5, 1.5, 0.3], solver="relaxation", tolerance=1e-4))
    exact = relax(star(WIDE, [0.5, 1.5, 0.3], solver="newton", tolerance=1e-12))
    assert found.stability == exact.stability == "stable"
    off = float(np.abs(found.particles - exact.particles).max())
    assert found.position_error is not None
    assert off / 3.0 <= found.position_error <= 3.0 * off + 1e-15


def test_derivatives_where_a_line_is_closed() -> None:
    """By its own tension T0: from T0 l / e = |R| and R that hardly changes, dx/dT0 = -x / T0, to a part of e over the
    length of the arms; and by differences of equilibria."""
    scene = star(WIDE, [0.5, 1.5, 0.3], tension=[8.0, 7.0, 7.0])
    goals = [{"kind": "position", "particles": [3], "axes": "y"}]
    found = sensitivity(scene, goals=goals, variables=[{"force": "lines", "field": "tension"}])
    e = closing(scene)
    assert found.gradient[0][0] == pytest.approx(-found.value / 8.0, rel=2.0 * e)
    assert not found.warnings

    def height(tension: list[float]) -> float:
        return sensitivity(star(WIDE, [0.5, 1.5, 0.3], tension=tension), goals=goals,
                           variables=[{"force": "lines", "field": "tension"}]).value  # fmt: skip

    for line in range(3):
        step = 1e-3 * np.eye(3)[line]
        both = [height(list(np.array([8.0, 7.0, 7.0]) + way * step)) for way in (1.0, -1.0)]
        assert found.gradient[0][line] == pytest.approx((both[0] - both[1]) / 2e-3, rel=1e-5)


def test_residuals_are_measured_by_what_lines_pull_with() -> None:
    """However stiff closed lines are, the scale is the mean of the forces of the lines."""
    x, lines, rim = foam(60, 0)
    scene = web(x, lines, rim, solver="newton")
    found = relax(scene)
    system = compile(scene)
    state = system.start()
    state.x[:] = found.particles
    assert balance(system, state).scale == pytest.approx(np.abs(found.forces[0]["force"]).mean(), rel=1e-9)
