"""Hinges: angle, energy, moment, balance, rest angles, and shapes without a fold."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from hookean import Scene, relax
from hookean.forces import Hinge, Springs, Unary
from hookean.forces.dihedral import fold_angles
from hookean.system.system import compile
from soak import examples

EPS = float(np.finfo(float).eps)
FLAT = np.array([[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.7, 1.5, 0.0], [1.2, -0.6, 0.0]])
seeded = settings(derandomize=True, deadline=None, max_examples=examples(100), database=None)
seeds = st.integers(0, 2**32 - 1)


def folded(angle: float) -> np.ndarray:
    """The flat pair with its second tip turned up about the edge (the x axis)."""
    x = FLAT.copy()
    x[3, 1:] = FLAT[3, 1] * np.cos(angle), -FLAT[3, 1] * np.sin(angle)
    return x


def evaluate(x: np.ndarray, hinge: Hinge) -> tuple[np.ndarray, np.ndarray, float]:
    """Forces, lumped stiffness and energy of a hinge at `x`."""
    system = compile(Scene(particles=x, forces=[hinge]))
    f, w, energy = system.evaluate(system.start())
    return f, w, float(energy.sum())


def hinge(**more: float) -> Hinge:
    """One hinge on four particles."""
    return Hinge(particles=[[0, 1, 2, 3]], **more)


@pytest.mark.parametrize("angle", [-3.1, -np.pi / 2, -0.3, -1e-9, 0.0, 1e-9, 0.3, np.pi / 2, 3.1])
def test_energy_and_forces_of_a_known_fold(angle: float) -> None:
    """E = S angle^2 / 2; the tips carry S angle / height across their triangles, which is the moment about the edge.

    Rounding: an angle is known to a few eps of 1, so E to S |angle| 10 eps and forces to 10 eps S / height.
    """
    f, _, energy = evaluate(folded(angle), hinge(strength=7.0, rest_angle=0.0))
    assert abs(energy - 3.5 * angle**2) <= 7.0 * abs(angle) * 10 * EPS
    assert np.abs(f[2] - [0.0, 0.0, -7.0 * angle / 1.5]).max() <= 7.0 / 0.6 * 10 * EPS
    normal = np.array([0.0, np.sin(angle), np.cos(angle)])
    assert np.abs(f[3] + 7.0 * angle / 0.6 * normal).max() <= 7.0 / 0.6 * 10 * EPS


def test_angle_has_a_sign_and_both_tips_count() -> None:
    """Positive where the tips rise to the side of (end - start) x (tip 1 - start); edge reversed: tips swapped."""
    x = folded(0.4)
    rows = np.array([[0, 1, 2, 3], [1, 0, 3, 2], [0, 1, 3, 2]])
    assert np.abs(fold_angles(x, rows) - [0.4, 0.4, -0.4]).max() <= 10 * EPS


@seeded
@given(seed=seeds, rest=st.floats(-3.0, 3.0), factor=st.floats(-2.0, 2.0))
def test_force_is_minus_the_gradient_and_balances(seed: int, rest: float, factor: float) -> None:
    """f = -dE/dx to 1e-6 of the largest force; sum f = 0 and sum x cross f = 0 to 1e-12 of force x size.

    Triangles of heights from 0.2 to 5 and one of 1:50. Where the turn is within 0.01 of half a turn the energy has a
    crest, and differences across it say nothing.
    """
    rng = np.random.default_rng(seed)
    x = folded(rng.uniform(-3.0, 3.0)) + 0.1 * rng.uniform(-1, 1, (4, 3))
    x[2] = x[0] + (x[2] - x[0]) * 10 ** rng.uniform(-0.7, 0.5)
    force = hinge(strength=3.0, rest_angle=rest, angle_factor=factor)
    turn = fold_angles(x, np.array([[0, 1, 2, 3]]))[0] - rest * factor
    assume(np.abs(np.abs(turn) % (2 * np.pi) - np.pi) > 0.01)
    f, _, _ = evaluate(x, force)
    slope = np.zeros_like(x)
    for spot in np.ndindex(4, 3):
        for sign in (1.0, -1.0):
            moved = x.copy()
            moved[spot] += sign * 1e-5
            slope[spot] += sign * evaluate(moved, force)[2] / 2e-5
    scale = np.abs(f).max()
    assert np.abs(f + slope).max() <= 1e-6 * (scale + 3.0)
    size = np.ptp(x, axis=0).max()
    assert np.abs(f.sum(axis=0)).max() <= 1e-12 * (scale + 3.0 / size)
    assert np.abs(np.cross(x, f).sum(axis=0)).max() <= 1e-12 * (scale * size + 3.0)


def test_rest_angle_is_as_drawn_flat_or_given() -> None:
    """None: no force in the start shape; factor 0 or rest angle 0: flat is at rest; a factor halves the start angle."""
    x = folded(0.8)
    assert np.abs(evaluate(x, hinge())[0]).max() <= 10 * EPS
    half = evaluate(x, hinge(angle_factor=0.5))[2]
    assert half == pytest.approx(0.5 * 0.4**2, rel=1e-14)
    assert evaluate(x, hinge(angle_factor=0.0))[2] == pytest.approx(0.5 * 0.8**2, rel=1e-14)
    assert evaluate(FLAT, hinge(rest_angle=0.3))[2] == pytest.approx(0.5 * 0.3**2, rel=1e-14)


def test_turns_go_the_short_way() -> None:
    """From 3.0 to a rest angle of -3.0 it is 2 pi - 6 onwards, not 6 back; whole turns of the rest angle vanish."""
    short = 2.0 * np.pi - 6.0
    assert evaluate(folded(3.0), hinge(rest_angle=-3.0))[2] == pytest.approx(0.5 * short**2, rel=1e-13)
    turned = evaluate(folded(0.2), hinge(rest_angle=0.5 - 4 * np.pi))[2]
    assert turned == pytest.approx(0.5 * 0.3**2, rel=1e-13)


@pytest.mark.parametrize("load", [1.0, -1.0])
def test_a_loaded_flap_turns_to_the_root_of_theta_equals_cos_theta(load: float) -> None:
    """S theta = P h cos theta with S = P h = 1: theta = 0.7390851332 (the fixed point of cos).

    The flap's springs stretch by less than 2 P / k = 2e-8 of their length, which moves the angle by no more.
    """
    x = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.5, 1.0, 0.0], [0.5, -1.0, 0.0]])
    result = relax(
        Scene(
            particles=x,
            forces=[
                Hinge(particles=[[0, 1, 2, 3]], strength=1.0, name="flap"),
                Springs(particles=[[0, 3], [1, 3]], stiffness=1e8, damping=0.0),
                Unary(particles=[3], vector=[0.0, 0.0, load]),
            ],
            anchors=[{"particles": [0, 1, 2]}],
            settings={"tolerance": 1e-9, "solver": "newton"},
        )
    )
    assert result.converged
    measured = result.force("flap")
    assert measured["angle"][0] == pytest.approx(load * 0.7390851332151607, abs=1e-7)
    assert measured["moment"][0] == pytest.approx(load * 0.7390851332151607, abs=1e-7)


def test_reactions_and_loads_sum_to_zero() -> None:
    """At equilibrium anchors carry the load, to the rounding floor; the hinge adds nothing from outside."""
    result = relax(
        Scene(
            particles=folded(0.5),
            forces=[
                Hinge(particles=[[0, 1, 2, 3]], strength=2.0, angle_factor=0.3),
                Springs(particles=[[0, 3], [1, 3]], stiffness=1e3),
                Unary(particles=[3], vector=[0.0, 0.3, -1.0]),
            ],
            anchors=[{"particles": [0, 1, 2]}],
            settings={"tolerance": 1e-10},
        )
    )
    assert result.converged
    assert np.abs(result.reactions["force"].sum(axis=0) + [0.0, 0.3, -1.0]).max() <= 1e-9


def test_points_weld_to_the_particles_of_other_forces() -> None:
    """Hinges given by coordinates act on the particles there."""
    x = folded(0.6)
    system = compile(Scene(forces=[Springs(lines=[[x[0], x[1]], [x[2], x[3]]]), Hinge(points=[x[[0, 1, 2, 3]]])]))
    assert len(system.x) == 4
    assert system.groups[1].block.indices.tolist() == [[0, 1, 2, 3]]


def _shapes() -> dict[str, np.ndarray]:
    return {
        "all at one place": np.ones((4, 3)),
        "edge without length": FLAT[[0, 0, 2, 3]],
        "tip on the edge": np.array([[0, 0, 0], [2, 0, 0], [1, 0, 0], [1, -1, 0.5]], dtype=float),
        "tip at an end": FLAT[[0, 1, 0, 3]],
        "on a line": np.outer(np.arange(4.0), [0.3, -0.2, 0.9]),
        "tips at one place": FLAT[[0, 1, 2, 2]],
        "folded onto itself": FLAT * [1, 1, 0] + [[0, 0, 0], [0, 0, 0], [0, 0, 0], [0, 1.9, 0]],
        "1e-200 apart": FLAT * 1e-200,
        "1e-75 apart": FLAT * 1e-75,
        "1e11 apart": FLAT * 1e11,
        "a sliver": np.array([[0, 0, 0], [1, 0, 0], [0.5, 1e-7, 0], [0.5, -1, 0.5]]),
    }


@pytest.mark.parametrize("name", _shapes())
def test_degenerate_folds_stay_finite_and_bounded(name: str) -> None:
    """No nan, no infinity; forces at most S pi / (1e-8 x size): triangles flatter than that have none."""
    x = _shapes()[name]
    with np.errstate(all="raise", under="ignore"):
        f, w, energy = evaluate(x, hinge(strength=1.0, rest_angle=0.5))
    assert np.isfinite(f).all() and np.isfinite(w).all() and np.isfinite(energy)
    size = np.ptp(x, axis=0).max() or 1.0
    assert np.abs(f).max() <= np.pi / (1e-8 * size) * 10
    if "place" in name and "tips" not in name or "line" in name or "tip " in name or "length" in name:
        assert (f == 0).all() and (w == 0).all() and energy == 0.0


def test_a_fold_onto_itself_pushes_back_with_half_a_turn() -> None:
    """At 180 degrees the moment is S pi, one way or the other."""
    f, _, energy = evaluate(_shapes()["folded onto itself"], hinge(strength=1.0, rest_angle=0.0))
    assert energy == pytest.approx(0.5 * np.pi**2, rel=1e-14)
    assert abs(f[2, 2]) == pytest.approx(np.pi / 1.5, rel=1e-14)


@pytest.mark.parametrize("seed", range(20))
def test_a_hinge_is_the_same_whichever_end_of_it_is_named_first(seed: int) -> None:
    """Edge and wings turned around name the same fold: energy, forces and lumped stiffness stay at their particles.

    The feet of the wings lie anywhere on the line of the edge, and the moment is large.
    """
    rng = np.random.default_rng(seed)
    (left, right), (y, z) = rng.uniform(-3.0, 4.0, 2), rng.uniform(0.3, 2.0, 2)
    x = [[0, 0, 0], [1, 0, 0], [left, y, 0], [right, -y, z]]
    hinge = {"kind": "hinge", "strength": 7.0, "rest_angle": rng.choice([-2.5, 2.5])}
    found = []
    for corners in ([0, 1, 2, 3], [1, 0, 3, 2]):
        system = compile(Scene.read({"particles": x, "forces": [{**hinge, "particles": [corners]}]}))
        found.append(system.evaluate(system.start()))
    for one, other in zip(*found, strict=True):
        assert one == pytest.approx(other, rel=1e-12, abs=1e-12)


@pytest.mark.parametrize("swing", [0.05, 0.4])
def test_a_hinge_with_a_limit_yields(swing: float) -> None:
    """Perfectly plastic at the moment S x limit: folded by `swing` the rest angle follows by swing - limit, and back
    again: the moments of the loop are +-S limit; below the limit there is no trace."""
    limit, strength = 0.1, 7.0
    system = compile(Scene(particles=folded(0.0), forces=[hinge(strength=strength, limit=limit)]))
    state, moments = system.start(), []
    for angle in (swing, 0.0, -swing, 0.0, swing):
        state.x = folded(angle)
        system.remember(state)
        f, _, _ = system.evaluate(state)
        moments.append(-np.linalg.norm(f[2]) * 1.5 * np.sign(f[2, 2]))  # tip 1 is 1.5 above the edge
    most, back = strength * min(limit, swing), -strength * limit if swing > limit else 0.0
    assert moments == pytest.approx([most, back, -most, -back, most], abs=1e-13)


def vertex(sector: float, rise: float) -> tuple[np.ndarray, list[list[int]]]:
    """Four triangles round a vertex with the sectors a, a, pi - a, pi - a, of which the tips are raised a little, and
    the hinges between them: the second and the fourth are in one line."""
    turn = np.cumsum([0.0, sector, sector, np.pi - sector])
    x = np.vstack([np.zeros(3), np.column_stack([np.cos(turn), np.sin(turn), 0.0 * turn])])
    x[1:, 2] = rise * np.array([0.2, 0.0, 0.2, 0.1])
    return x, [[0, 1 + i, 1 + (i + 1) % 4, 1 + (i - 1) % 4] for i in range(4)]


@pytest.mark.parametrize("degrees", [50.0, 65.0])
@pytest.mark.parametrize("folding", [0.3, 0.7])
def test_a_vertex_of_miura_ori_folds_in_its_one_way(degrees: float, folding: float) -> None:
    """Opposite folds are equally large, and tan(h / 2) = tan(g / 2) cos(a) for those in one line, h: the one degree of
    freedom of a flat-foldable vertex with the sectors a, a (Tachi, "Generalization of rigid foldable quadrilateral
    mesh origami", 2009). One hinge folds a part of half a turn; at the end it and the springs that keep the faces
    rigid are without force: to 1e-6."""
    sector = np.radians(degrees)
    x, hinges = vertex(sector, 0.5)
    flat, _ = vertex(sector, 0.0)
    pairs = np.array([[0, 1], [0, 2], [0, 3], [0, 4], [1, 2], [2, 3], [3, 4], [4, 1]])
    length = np.linalg.norm(flat[pairs[:, 1]] - flat[pairs[:, 0]], axis=1)
    forces = [
        Springs(particles=pairs, stiffness=1e3, rest_length=length),
        Hinge(particles=hinges[:1], strength=1.0, rest_angle=np.pi, angle_factor=folding),
    ]
    found = relax(Scene(particles=x, forces=forces, settings={"tolerance": 1e-11, "max_iterations": 200000}))
    angle = fold_angles(found.particles, np.array(hinges))
    assert found.converged
    assert abs(angle[0]) == pytest.approx(folding * np.pi, abs=1e-6)
    assert np.abs(angle[2:]) == pytest.approx(np.abs(angle[:2]), abs=1e-6)
    assert np.tan(0.5 * abs(angle[1])) == pytest.approx(np.tan(0.5 * abs(angle[0])) * np.cos(sector), abs=1e-6)


def test_a_sliver_has_no_moment() -> None:
    """What is reported is what acts: a triangle without height has no fold, whatever its rest angle."""
    x = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.5, 0.0, 0.0], [0.5, -1.0, 0.0]])
    found = relax(
        Scene(particles=x, forces=[Hinge(particles=[[0, 1, 2, 3]], rest_angle=0.5)], anchors=[{"particles": range(4)}])
    )
    assert found.forces[0]["moment"] == pytest.approx([0.0]) and not found.reactions["force"].any()
