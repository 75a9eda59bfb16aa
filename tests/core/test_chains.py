"""Cables and nets of chains in force densities: the exact shape at any length, from any start, or the old way."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as some
from scipy.optimize import brentq, root

from hookean import Result, Scene, relax
from hookean.commands.examples import figure
from hookean.compiled import dispatch
from hookean.linear import profile_cholesky as _profile
from hookean.solvers import _complementary
from hookean.stability.time_steps import _scaled_stiffness
from hookean.system.balance import balance
from hookean.system.system import compile
from soak import SOAK

Spec = dict[str, Any]


def cable(segments: int, start: str = "arch", **more: Any) -> Spec:
    """A cable of EA 2800 and weight 50 over a span of 16.8; length 20 less 0.5 %. It starts as an arch, straight, or
    in disorder."""
    angle = np.linspace(-1.0, 1.0, segments + 1)
    x = np.column_stack([10.0 * np.sin(angle), np.zeros(segments + 1), 10.0 * (np.cos(angle) - np.cos(1.0))])
    pairs = np.column_stack([np.arange(segments), np.arange(1, segments + 1)])
    rest = np.full(segments, 19.9 / segments)
    if start == "straight":
        x[:, 2] = 0.0
    if start == "disorder":
        x[1:-1] += np.random.default_rng(1).normal(scale=5.0, size=(segments - 1, 3))
    return {
        "particles": x,
        "forces": [
            {"kind": "springs", "particles": pairs, "stiffness": 2800.0 / rest[0], "rest_length": rest, **more},
            {"kind": "unary", "particles": np.arange(1, segments), "vector": [0.0, 0.0, -50.0 / segments]},
        ],
        "anchors": [{"particles": [0, segments]}],
    }


def hanging(spec: Spec) -> np.ndarray:
    """Positions of a hanging cable's particles, to rounding, by its force polygon.

    Forces add up along it: segment i pulls with (H, V - i w), is L0 + T/k long and points that way; H and V are what
    makes the last end meet its anchor. Only two unknowns, whatever the number of segments.
    """
    springs, load = spec["forces"][0], -spec["forces"][1]["vector"][2]
    rest, k, x = np.asarray(springs["rest_length"]), springs["stiffness"], spec["particles"]
    count = len(rest)

    def line(unknown: np.ndarray) -> np.ndarray:
        pull = np.column_stack([np.full(count, unknown[0]), unknown[1] + load * np.arange(count)])
        tension = np.linalg.norm(pull, axis=1)
        return np.cumsum(pull / tension[:, None] * (rest + tension / k)[:, None], axis=0)

    span = (x[-1] - x[0])[[0, 2]]
    found = root(lambda u: line(u)[-1] - span, np.array([20.0, -25.0]), tol=1e-13)
    assert np.abs(found.fun).max() < 1e-9
    shape = np.zeros((count + 1, 3))
    shape[1:, [0, 2]] = line(found.x)
    return shape + x[0]


@pytest.mark.parametrize("segments", [2, 50, 1_000, 10_000, *([100_000] if SOAK else [])])
def test_a_cable_of_any_length_takes_as_many_steps_and_is_exact(segments: int) -> None:
    """Against the force polygon. What is left of force at a particle, the residual, adds up along the cable: n of them
    turn a tension T of some 20 by n r / T, and the shape with it, by n r / T times the span at most."""
    spec = cable(segments)
    found = relax(Scene.read(spec))
    assert found.converged and found.solver == "auto: complementary" and found.iterations <= 7
    left = found.out_of_balance
    assert np.abs(found.particles - hanging(spec)).max() <= 1e-9 + segments * left / 20.0 * 17.0


@pytest.mark.parametrize("start", ["straight", "disorder"])
def test_the_start_does_not_matter(start: str) -> None:
    """An arch that has to turn over, a straight compressed line, a heap: one shape, to the tolerance of 1e-6 of a
    load of 0.25, which n = 200 of could turn a tension of 20 by 2.5e-6 of the span of 17."""
    found = relax(Scene.read(cable(200, start)))
    assert found.solver == "auto: complementary"
    assert np.abs(found.particles - hanging(cable(200))).max() <= 5e-5


@pytest.mark.parametrize("stiffness", [1e2, 1e4, 1e6, 1e8])
def test_stiffness_does_not_matter(stiffness: float) -> None:
    """From rubber to springs 2e8 times as stiff as their load is heavy, where rounding leaves more than 1e-6."""
    spec = cable(100)
    spec["forces"][0]["stiffness"] = stiffness
    found = relax(Scene.read(spec))
    assert found.converged and found.solver == "auto: complementary"
    left = found.out_of_balance
    assert np.abs(found.particles - hanging(spec)).max() <= 1e-9 + 100 * left / 20.0 * 17.0


def test_particles_given_in_any_order() -> None:
    """A cable whose particles are numbered at random is renumbered inside."""
    spec = cable(300)
    mixed = np.random.default_rng(3).permutation(301)
    place = np.argsort(mixed)
    other = {
        "particles": spec["particles"][mixed],
        "forces": [
            {**spec["forces"][0], "particles": place[spec["forces"][0]["particles"]]},
            {**spec["forces"][1], "particles": place[spec["forces"][1]["particles"]]},
        ],
        "anchors": [{"particles": place[[0, 300]]}],
    }
    found = relax(Scene.read(other))
    assert found.solver == "auto: complementary"
    assert np.abs(found.particles[place] - hanging(spec)).max() <= 5e-5


def test_a_ring_hung_by_two_particles() -> None:
    """Both halves of a closed chain between two held particles hang like the one cable that each is."""
    spec = cable(40)
    x = np.concatenate([spec["particles"], spec["particles"][39:0:-1]])
    around = np.column_stack([np.arange(80), (np.arange(80) + 1) % 80])
    spec["particles"] = x
    spec["forces"][0].update(particles=around, rest_length=np.full(80, 19.9 / 40))
    spec["forces"][1]["particles"] = [*range(1, 40), *range(41, 80)]
    found = relax(Scene.read(spec))
    assert found.solver == "auto: complementary"
    expected = hanging(cable(40))
    assert np.abs(found.particles[:41] - expected).max() <= 1e-5
    assert np.abs(found.particles[41:] - expected[39:0:-1]).max() <= 1e-5


@pytest.mark.parametrize("mixed", [False, True])
def test_many_legs_that_meet_at_one_particle(mixed: bool) -> None:
    """Sixty equal legs of forty springs, in their order or numbered at random: the hub stays on their axis, and all
    legs hang alike. At a tolerance of 1e-6 of a load of 1, the 40 of a leg turn its tension of 40 or more, and with it
    10 of length, by 1e-5 at most."""
    legs, count = 60, 40
    along = 10.0 * np.arange(1, count + 1) / count
    angle = 2.0 * np.pi * np.arange(legs) / legs
    x = np.stack([np.cos(angle)[:, None] * along, np.sin(angle)[:, None] * along, np.zeros((legs, count))], axis=-1)
    x = np.concatenate([np.zeros((1, 3)), x.reshape(-1, 3)])
    number = 1 + np.arange(legs * count).reshape(legs, count)
    before = np.column_stack([np.zeros(legs, int), number[:, :-1]])
    place = np.random.default_rng(2).permutation(len(x)) if mixed else np.arange(len(x))
    found = relax(
        Scene.read(
            {
                "particles": x[np.argsort(place)],
                "forces": [
                    {"kind": "springs", "particles": place[np.stack([before, number], -1).reshape(-1, 2)],
                     "stiffness": 1e4},
                    {"kind": "unary", "particles": np.arange(len(x)), "vector": [0.0, 0.0, -1.0]},
                ],
                "anchors": [{"particles": place[number[:, -1]]}],
            }
        )
    )  # fmt: skip
    assert found.converged and found.solver == "auto: complementary"
    shape = found.particles[place]
    assert np.abs(shape[0, :2]).max() <= 1e-5 and shape[0, 2] < -0.1
    assert np.ptp(shape[number, 2], axis=0).max() <= 2e-5


def random_chains(seed: int) -> Spec:
    """Legs of a few springs that meet at a particle, held or loose, some closed to a ring: springs stiff, slack,
    compressed, of rest length 0 or without stiffness, soft anchors, loads on all, on one or on none."""
    rng = np.random.default_rng([7, seed])
    points, pairs, ends = [rng.normal(size=3)], [], []
    for _ in range(rng.integers(1, 6)):
        count, far, last = int(rng.integers(1, 15)), rng.normal(size=3) * 5.0, 0
        for i in range(1, count + 1):
            points.append(points[0] + (far - points[0]) * i / count + 0.1 * rng.normal(size=3) * rng.integers(0, 2))
            pairs.append((last, len(points) - 1))
            last = len(points) - 1
        ends.append(last)
    if len(ends) > 1 and rng.random() < 0.3:
        pairs.append((ends[0], ends[1]))
    x, springs = np.array(points), np.array(pairs)
    m = len(springs)
    rest = np.linalg.norm(x[springs[:, 0]] - x[springs[:, 1]], axis=1)
    rest = rest * rng.choice([0.5, 0.9, 0.995, 1.0, 1.05, 1.3], size=m if rng.random() < 0.5 else 1)
    k = np.ones(m) * 10.0 ** rng.uniform(1, 5, size=m if rng.random() < 0.5 else 1)
    rest[rng.random(m) < rng.choice([0.0, 0.2])] = 0.0
    k[rng.random(m) < rng.choice([0.0, 0.0, 0.1])] = 0.0
    forces: list[Spec] = [{"kind": "springs", "particles": springs, "stiffness": k, "rest_length": rest}]
    forces += [
        [{"kind": "self_weight", "total": 10.0 ** rng.uniform(-1, 2)}],
        [{"kind": "unary", "particles": np.arange(len(x)), "vector": rng.normal(size=x.shape)}],
        [{"kind": "unary", "particles": [0], "vector": rng.normal(size=3)}],
        [],
    ][rng.integers(0, 4)]
    if rng.random() < 0.3:
        soft = rng.choice(len(x), size=max(1, len(x) // 6), replace=False)
        forces.append({"kind": "anchor_spring", "particles": soft, "strength": 10.0 ** rng.uniform(-1, 4)})
    held = [end for end in ends if rng.random() < 0.8]
    return {"particles": x, "forces": forces, "anchors": [{"particles": held}] if held else []}


def solved(spec: Spec, solver: str) -> Result:
    """The scene by one solver, to 1e-9."""
    return relax(Scene.read({**spec, "settings": {"solver": solver, "tolerance": 1e-9, "max_iterations": 300_000}}))


def energy(found: Result) -> float:
    """Energy of the forces."""
    return sum(value for kind, value in found.energy.items() if kind not in ("kinetic", "total"))


@pytest.mark.parametrize("seed", range(200 if SOAK else 20))
def test_random_chains_come_no_higher_than_relaxation_and_are_stable(seed: int) -> None:
    """Where the complementary energy finds a shape: energy at most 1e-8 of its size above relaxation's, no negative
    curvature beyond rounding, and the same shape where the tangent is definite. Elsewhere nothing has moved."""
    spec = random_chains(seed)
    system = compile(Scene.read(spec))
    state = system.start()
    found = balance(system, state)
    if not _complementary.Method().advance(system, state, 100, max(1e-9, found.floor) * found.scale):
        assert np.array_equal(state.x, system.start().x)
        return
    auto, slow = solved(spec, "auto"), solved(spec, "relaxation")
    assert auto.converged and slow.converged
    size = sum(abs(value) for value in slow.energy.values())
    assert energy(auto) <= energy(slow) + 1e-8 * size
    state.x = auto.particles
    matrix, _, _ = _scaled_stiffness(system, state)
    values = np.linalg.eigvalsh(matrix.toarray())
    assert values[0] >= -1e-9 * values[-1]
    if values[0] > 1e-9 * values[-1]:
        assert np.abs(auto.particles - slow.particles).max() <= 1e-5 * system.size


def test_random_chains_are_taken_often_enough_for_the_test_above() -> None:
    """At least a tenth of them are in tension and loaded well enough; else the test above would say little."""
    taken = 0
    for seed in range(40):
        system = compile(Scene.read(random_chains(seed)))
        state = system.start()
        found = balance(system, state)
        taken += _complementary.Method().advance(system, state, 100, max(1e-9, found.floor) * found.scale) > 0
    assert taken >= 4


OTHERS: dict[str, Spec] = {
    "cutoff": {"upper_cutoff": 100.0},
    "plastic": {"plasticity": 0.5},
}


@pytest.mark.parametrize("name", OTHERS)
def test_springs_with_limits_are_left_to_relaxation(name: str) -> None:
    """A limit ends the convexity of a spring's energy; the method refuses with a sentence and auto relaxes."""
    spec = cable(20, **OTHERS[name])
    assert "cutoff or plasticity" in _complementary.Method().refuse(compile(Scene.read(spec)))
    found = relax(Scene.read(spec))
    assert found.converged and "complementary" not in found.solver


@pytest.mark.parametrize(
    ("change", "why"),
    [
        ({"settings": {"floor": {"point": [0, 0, -3.0]}}}, "a floor"),
        ({"anchors": [{"particles": [0, 20]}, {"particles": list(range(21)), "axes": "y"}]}, "axes held alone"),
        ({"anchors": [{"particles": [0]}], "forces": None}, "a loose end without load, in no definite place"),
    ],
)
def test_what_it_cannot_do_is_done_as_before(change: Spec, why: str) -> None:
    """The answer is relaxation's, to the last bit, and so is what is said of it."""
    spec = {**cable(20), **change}
    if spec["forces"] is None:
        spec["forces"] = cable(20)["forces"][:1]
    auto = relax(Scene.read(spec))
    slow = relax(Scene.read({**spec, "settings": {**spec.get("settings", {}), "solver": "relaxation"}}))
    assert auto.solver == "auto: relaxation", why
    assert auto.status is slow.status and np.array_equal(auto.particles, slow.particles)


def test_a_strut_that_stands_stays() -> None:
    """A shallow arch of two bars, held in its plane, that carries its load would be lower had it snapped through: a
    shape far from where it was drawn is not what was asked for."""
    spec: Spec = {
        "particles": [[-1.0, 0.0, 0.0], [0.0, 0.0, 0.3], [1.0, 0.0, 0.0]],
        "forces": [
            {"kind": "springs", "particles": [[0, 1], [1, 2]], "stiffness": 1000.0},
            {"kind": "unary", "particles": [1], "vector": [0.0, 0.0, -1.0]},
        ],
        "anchors": [{"particles": [0, 2]}, {"particles": [1], "axes": "y"}],
    }
    found = relax(Scene.read(spec))
    assert found.converged and found.particles[1, 2] > 0.29


def test_a_net_is_more_than_chains() -> None:
    """In a square net most particles have four springs: not for this method."""
    found = relax(figure("9.24-membrane").scene(divisions=7))
    assert found.converged and "complementary" not in found.solver


@settings(max_examples=200 if SOAK else 30, derandomize=True, deadline=None)
@given(seed=some.integers(0, 2**32 - 1), size=some.integers(1, 40), reach=some.integers(0, 12))
def test_profile_factors_solve_what_dense_ones_do(seed: int, size: int, reach: int) -> None:
    """Of a random symmetric matrix of any profile: the same answer as numpy's to 1e-13 of the condition number, and
    no factor where an eigenvalue is negative."""
    rng = np.random.default_rng(seed)
    first = np.maximum(np.arange(size) - rng.integers(0, reach + 1, size), 0)
    matrix = np.zeros((size, size))
    for i in range(size):
        matrix[i, first[i] : i] = rng.normal(size=i - first[i])
    matrix += matrix.T
    lowest = np.linalg.eigvalsh(matrix)[0]
    factor, solve = dispatch.compiled(_profile.factor), dispatch.compiled(_profile.solve)
    starts = np.concatenate([[0], np.cumsum(np.arange(size) - first + 1)])
    for shift, positive in ((0.1 - lowest, True), (-0.1 - lowest, False)):
        whole = matrix + shift * np.eye(size)
        rows = np.concatenate([whole[i, first[i] : i + 1] for i in range(size)])
        assert factor(rows, starts, first) is positive
        if positive:
            b = rng.normal(size=size)
            x = b.copy()
            solve(rows, starts, first, x)
            expected = np.linalg.solve(whole, b)
            assert np.abs(x - expected).max() <= 1e-13 * np.linalg.cond(whole) * np.abs(expected).max()


def hung(pieces: int, stiffness: float, length: float, weight: float) -> np.ndarray:
    """Positions (n + 1, 2) of a chain between anchors 1 apart, by its horizontal force alone: by symmetry the vertical
    force of each piece is known, and each piece is L0 / n (1 + T / EA) long in the direction of its force."""
    vertical = weight / pieces * (0.5 * (pieces - 1) - np.arange(pieces))

    def drawn(horizontal: float) -> np.ndarray:
        tension = np.hypot(horizontal, vertical)
        along = np.column_stack([np.full(pieces, horizontal), -vertical]) / tension[:, None]
        steps = (length / pieces * (1.0 + tension / stiffness))[:, None] * along
        return np.concatenate([np.zeros((1, 2)), np.cumsum(steps, axis=0)])

    found = brentq(lambda h: drawn(h)[-1, 0] - 1.0, 1e-6 * weight, weight, xtol=1e-15 * weight, rtol=1e-15)
    return drawn(found)


@pytest.mark.parametrize("pieces", [200, 500, 1000, 2000])
@pytest.mark.parametrize("stiffness", [1e7, 1e8])
def test_slack_stiff_chains_fall_from_the_straight_line(stiffness: float, pieces: int) -> None:
    """A chain of 10 drawn straight between anchors 1 apart, EA of 1e7 and 1e8 N, under 1000 N. Rounding leaves
    u k x / F of the loads, k = EA n / L0: 6e-5 at most here. The oracle's sums of n pieces round to n u L0."""
    x = np.column_stack([np.linspace(0.0, 1.0, pieces + 1), *np.zeros((2, pieces + 1))])
    forces = [
        {"kind": "springs", "particles": [[i, i + 1] for i in range(pieces)], "stiffness": stiffness * pieces / 10.0,
         "rest_length": 10.0 / pieces},
        {"kind": "unary", "particles": list(range(pieces + 1)), "vector": [0.0, 0.0, -1000.0 / pieces]},
    ]  # fmt: skip
    found = relax(Scene.read({"particles": x, "forces": forces, "anchors": [{"particles": [0, pieces]}]}))
    assert found.converged and found.stability == "stable", found.message
    assert found.rounding_floor <= 1.2e-16 * 4 * stiffness * pieces / 10.0 * 5.0 / (1000.0 / pieces)
    assert np.abs(found.particles[:, [0, 2]] - hung(pieces, stiffness, 10.0, 1000.0)).max() <= 1e-9


def test_a_chain_too_stiff_for_its_load_hangs_right_and_is_no_equilibrium() -> None:
    """EA of 1e8 N under 1 N in 2000 pieces: rounding of coordinates alone leaves 0.06 of a load."""
    x = np.column_stack([np.linspace(0.0, 1.0, 2001), *np.zeros((2, 2001))])
    springs = {
        "kind": "springs",
        "particles": [[i, i + 1] for i in range(2000)],
        "stiffness": 2e10,
        "rest_length": 5e-3,
    }
    load = {"kind": "unary", "particles": list(range(2001)), "vector": [0.0, 0.0, -1.0 / 2000]}
    found = relax(Scene.read({"particles": x, "forces": [springs, load], "anchors": [{"particles": [0, 2000]}]}))
    assert found.status == "stalled" and found.rounding_floor > 1e-3 and "Rounding alone" in found.message
    assert np.abs(found.particles[:, [0, 2]] - hung(2000, 1e8, 10.0, 1.0)).max() <= 1e-6
