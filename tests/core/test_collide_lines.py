"""Capsules that collide: distances by brute force, contacts in closed form, and the list of neighbours."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.test_collide import evaluated
from hookean import InputError, Scene, relax
from hookean.forces import CollideLines, neighbours
from hookean.system.system import compile
from laws import laws
from laws.cases import case_of
from soak import examples


def sticks(rng: np.random.Generator, count: int, size: float) -> np.ndarray:
    """Ends (2 count, 3) of lines of any length up to 2, about points in a cube."""
    centre = np.repeat(rng.uniform(0.0, size, (count, 3)), 2, axis=0)
    half = rng.normal(size=(count, 3)) * rng.uniform(0.1, 0.5, (count, 1))
    return centre + np.stack([-half, half], axis=1).reshape(-1, 3)


def rods(x: np.ndarray, **columns: Any) -> dict[str, Any]:
    return {"kind": "collide_lines", "particles": np.arange(len(x)).reshape(-1, 2), **columns}


def distance(a: np.ndarray, b: np.ndarray, c: np.ndarray, d: np.ndarray) -> tuple[float, float, float]:
    """Of segments a-b and c-d: shortest distance, and how far along it is, from 0 to 1. The least of the four from an
    end to the other segment and of the lines where that is on both."""
    u, v = b - a, d - c
    pairs = [(s, float(np.clip((a + s * u - c) @ v / (v @ v), 0, 1))) for s in (0.0, 1.0)]
    pairs += [(float(np.clip((c + t * v - a) @ u / (u @ u), 0, 1)), t) for t in (0.0, 1.0)]
    inner = np.linalg.lstsq(np.column_stack([u, -v]), c - a, rcond=None)[0]
    if (inner >= 0).all() and (inner <= 1).all():
        pairs.append((float(inner[0]), float(inner[1])))
    return min((float(np.linalg.norm(a + s * u - c - t * v)), s, t) for s, t in pairs)


def of_all_pairs(x: np.ndarray, radius: np.ndarray, group: np.ndarray, k: float) -> tuple[np.ndarray, float]:
    """Forces and energy by the formula, pair by pair."""
    f, energy, ends = np.zeros_like(x), 0.0, x.reshape(-1, 2, 3)
    for i in range(len(ends)):
        for j in range(i):
            if group[i] == group[j] != 0:
                continue
            apart, s, t = distance(*ends[i], *ends[j])
            overlap = radius[i] + radius[j] - apart
            if overlap > 0.0:
                n = ends[i, 0] + s * (ends[i, 1] - ends[i, 0]) - ends[j, 0] - t * (ends[j, 1] - ends[j, 0])
                push = k * overlap * n / apart
                for row, part in ((2 * i, 1 - s), (2 * i + 1, s), (2 * j, t - 1), (2 * j + 1, -t)):
                    f[row] += part * push
                energy += 0.5 * k * overlap**2
    return f, energy


@pytest.mark.slow
@settings(derandomize=True, deadline=None, max_examples=examples(25), database=None)
@given(seed=st.integers(0, 2**32 - 1), count=st.integers(2, 25), density=st.floats(0.1, 2.0))
def test_forces_are_those_of_all_pairs(seed: int, count: int, density: float) -> None:
    """However the capsules move: by the formula, pair by pair. Where lines are nearly parallel, the place of a contact
    is less exact than its distance: forces to 1e-9 of the largest, energies to 1e-12."""
    rng = np.random.default_rng(seed)
    radius, group = rng.uniform(0.1, 0.3, count), rng.integers(0, 4, count)
    x = sticks(rng, count, (count / density) ** (1 / 3))
    system = compile(Scene(particles=x, forces=[rods(x, radius=radius, collision_group=group, strength=10.0)]))
    for amount in (0.0, 0.01, 0.01, 0.1, 10.0):
        x = x + amount * rng.normal(size=x.shape)
        f, _, energy = evaluated(system, x)
        expected, least = of_all_pairs(x, radius, group, 10.0)
        assert energy == pytest.approx(least, rel=1e-12, abs=1e-13)
        assert np.abs(f - expected).max() <= 1e-9 * max(np.abs(expected).max(), 1e-3)


def test_forces_do_not_depend_on_when_the_list_was_made() -> None:
    """To the bit: with the list of a shape before, a new one, and none."""
    rng = np.random.default_rng(1)
    x = sticks(rng, 150, 4.0)
    system = compile(Scene(particles=x, forces=[rods(x, radius=0.2)]))
    room = system.groups[0].block.rooms[0]
    evaluated(system, x)
    moved = x + rng.uniform(-0.007, 0.007, x.shape)  # less than half of the skin, 0.015
    before = room.copy()
    old = evaluated(system, moved)
    assert (room[0, :4] == before[0, :4]).all() and room[0, neighbours.COUNT] == 150
    room[0, neighbours.COUNT] = -1.0
    new = evaluated(system, moved)
    room[0, neighbours.PAIRS], room[0, neighbours.COUNT] = 3.0, -1.0
    none = evaluated(system, moved)
    assert room[0, neighbours.COUNT] == -1.0
    for one in (new, none):
        assert (one[0] == old[0]).all() and (one[1] == old[1]).all() and one[2] == old[2]


def test_a_bundle_of_long_capsules_is_listed() -> None:
    """400 side by side, each 40 radii long: all are within the sphere about each, and few are near."""
    y, z = (c.ravel() * 0.21 for c in np.meshgrid(np.arange(20.0), np.arange(20.0)))
    x = np.column_stack([np.tile([-2.0, 2.0], 400), np.repeat(y, 2), np.repeat(z, 2)])
    system = compile(Scene(particles=x, forces=[rods(x, radius=0.1)]))
    evaluated(system, x)
    assert system.groups[0].block.rooms[0][0, neighbours.COUNT] == 400


@settings(derandomize=True, deadline=None, max_examples=examples(25), database=None)
@given(seed=st.integers(0, 2**32 - 1))
def test_the_tangent_of_a_heap_is_the_gradient_of_its_forces_and_has_a_bound(seed: int) -> None:
    """Crossing lines, ends on lines and ends on ends: K = -df/dx by differences of order 4, to 1e-5 of the largest
    stiffness; w bounds it."""
    rng = np.random.default_rng(seed)
    x = sticks(rng, 8, 1.0)
    case = case_of("collide_lines", CollideLines(particles=np.arange(16).reshape(-1, 2), radius=0.2), x)
    found = np.zeros((48, 48))
    [(cls, block)] = CollideLines.gathered(case.block, case.block.memory, x, None) or []
    assert cls.tangent is not None
    for index, stiffness in zip(block.indices, cls.tangent(block, x), strict=True):
        axes = (3 * index[:, None] + np.arange(3)).ravel()
        np.add.at(found, (axes[:, None], axes), stiffness)
    scale = case.force(x)[1].max()
    step, column = 1e-6, rng.normal(size=x.shape)
    slope = sum(
        c * case.force(x + n * step * column)[0] for n, c in ((1, -2 / 3), (-1, 2 / 3), (2, 1 / 12), (-2, -1 / 12))
    )
    assert np.abs(found @ column.ravel() - slope.ravel() / step).max() <= 1e-5 * scale
    w = np.repeat(case.force(x)[1], 3)
    assert np.linalg.eigvalsh(found / np.sqrt(np.outer(w, w))).max() <= 1.0 + 1e-9


@pytest.mark.parametrize("solver", ["auto", "relaxation", "newton"])
def test_two_crossing_capsules_overlap_by_the_force_over_the_stiffness(solver: str) -> None:
    """The upper one is pressed down with F, shared by its ends so that it stays level: d = a + b - F / k. The lower one
    hands F to its supports by the lever rule, whose moments are those about its ends."""
    a, b, k, force, s, t = 0.3, 0.2, 500.0, 6.0, 0.3, 0.6
    x = np.array([[0, -t, 0], [0, 1 - t, 0], [-s, 0, 0.49], [1 - s, 0, 0.49]])
    scene = Scene(
        particles=x,
        forces=[
            rods(x, radius=[a, b], strength=k),
            {"kind": "unary", "particles": [2, 3], "vector": [[0, 0, -(1 - s) * force], [0, 0, -s * force]]},
        ],
        anchors=[{"particles": [0, 1]}, {"particles": [2, 3], "axes": "xy"}],
        settings={"solver": solver, "tolerance": 1e-10},
    )
    found = relax(scene)
    assert found.converged and found.stability == "stable"
    assert found.particles[2:, 2] == pytest.approx(a + b - force / k, abs=1e-8)
    support = np.asarray(found.reactions["force"])[:2]
    assert support == pytest.approx(np.array([[0, 0, (1 - t) * force], [0, 0, t * force]]), abs=1e-6)
    assert found.force("collide_lines")["force"] == pytest.approx(np.array([[0, 0, -force], [0, 0, force]]), abs=1e-6)


def test_capsules_of_a_chain_and_of_a_group_ignore_each_other() -> None:
    """Lines that share a particle overlap at it, always; those of one group may. Others do not ignore each other."""
    x = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 0.3, 0.0]])
    chain = {"kind": "collide_lines", "particles": [[0, 1], [1, 2], [2, 3]], "radius": 0.2}
    for group, touches in ((None, True), ([1, 0, 1], False), ([1, 2, 3], True)):
        columns = chain if group is None else {**chain, "collision_group": group}
        f, _, _ = evaluated(compile(Scene(particles=x, forces=[columns])), x)
        assert f[:, 1] == pytest.approx([-100.0 * touches, 0.0, 0.0, 100.0 * touches])  # k (0.4 - 0.3) at the ends
        alone, _, _ = evaluated(compile(Scene(particles=x, forces=[{**columns, "radius": 0.1}])), x)
        assert not alone.any()


def test_a_line_that_starts_and_ends_at_one_particle_is_a_sphere() -> None:
    """A ball of 0.4 that slides down onto a bar of 0.3 by a force P: it sinks in by P / k."""
    x = [[0, 0, 0], [2, 0, 0], [0.7, 0, 0.65]]
    scene = {
        "particles": x,
        "forces": [
            {"kind": "collide_lines", "particles": [[0, 1], [2, 2]], "radius": [0.3, 0.4], "strength": 50.0},
            {"kind": "unary", "particles": [2], "vector": [0, 0, -2.0]},
        ],
        "anchors": [{"particles": [0, 1]}, {"particles": [2], "axes": "xy"}],
        "settings": {"tolerance": 1e-10},
    }
    read = Scene.read(scene)
    assert compile(read).report.warnings == []
    result = relax(read)
    assert result.converged
    np.testing.assert_allclose(result.particles[2], [0.7, 0, 0.7 - 2.0 / 50.0], atol=1e-9)


def test_parallel_capsules_push_in_the_middle_of_where_they_are_beside_each_other() -> None:
    """From 1 to 2 of lines from 0 to 2 and 1 to 3: at 3/4 of the first and 1/4 of the second."""
    x = np.array([[0, 0, 0], [2, 0, 0], [1, 0, 0.5], [3, 0, 0.5]])
    f, _, energy = evaluated(compile(Scene(particles=x, forces=[rods(x, radius=0.3, strength=100.0)])), x)
    assert f[:, 2] == pytest.approx([-2.5, -7.5, 7.5, 2.5]) and energy == pytest.approx(0.5)
    short, _, _ = evaluated(
        compile(Scene(particles=x * [0, 1, 1], forces=[rods(x, radius=0.3, strength=100.0)])), x * [0, 1, 1]
    )
    assert short[:, 2] == pytest.approx([-5.0, -5.0, 5.0, 5.0])  # lines without length are spheres


def test_example_obeys_the_law_of_the_bound_where_it_is_pressed_hard() -> None:
    """Half of the sum of the radii, where sliding is stiffest."""
    force, x = CollideLines.example()
    case = case_of("pressed", force.replaced(radius=[1.0, 1.1, 0.9, 0.8, 0.9]), x)
    for seed in range(10):
        laws.lumped_stiffness_bounds_the_tangent(case, np.random.default_rng(seed), 0.1)


def test_contacts_alone_create_no_particles() -> None:
    """As loads do, they act on what is there; `lines` of theirs must meet it."""
    alone = Scene.read({"forces": [{"kind": "collide_lines", "lines": [[[0, 0, 0], [1, 0, 0]]]}]})
    with pytest.raises(InputError, match="no particles, and collide_lines alone create none; give their coordinates"):
        relax(alone)
