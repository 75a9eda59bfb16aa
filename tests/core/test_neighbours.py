"""The list of neighbours: all pairs in its range and no others, in one order; and sums that do not show when it was
made."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hookean import Scene
from hookean.compiled import dispatch
from hookean.forces import KINDS, cells, list_range, neighbours
from hookean.forces.base import Block
from hookean.system.system import compile
from soak import examples

FORCE = KINDS["collide"]


def spheres(x: np.ndarray, radius: Any = 0.5, **more: Any) -> Block:
    """The compiled block of spheres about all particles, k = 10."""
    force = {"kind": "collide", "particles": list(range(len(x))), "radius": radius, "strength": 10.0, **more}
    return compile(Scene(particles=x, forces=[force])).groups[0].block


def whole(block: Block, x: np.ndarray) -> tuple[np.ndarray, np.ndarray, float]:
    """Forces (n, 3), lumped stiffness (n,) and energy."""
    f, w = np.zeros_like(x), np.zeros(len(x))
    kernel = dispatch.compiled(FORCE.kernel, "force")
    energy = kernel(x, np.zeros_like(x), block.indices, block.parameters, block.memory, f, w)
    return f, w, float(energy)


def packed(block: Block, x: np.ndarray, load: np.ndarray) -> np.ndarray:
    """Forces (n, 3) added to a load as the loops of solvers do it."""
    four, f = np.zeros((2, len(x), 4))
    four[:, :3], f[:, :3] = x, load
    given = FORCE.pack(block, block.memory, False)
    assert given is not None
    dispatch.compiled(FORCE.kernel, "force")(four, np.zeros_like(four), *given, f, np.zeros(len(x)))  # type: ignore[misc]
    assert not f[:, 3].any()
    return f[:, :3]


def of_all_pairs(x: np.ndarray, radius: np.ndarray, k: float) -> tuple[np.ndarray, float]:
    """Forces and energy by the formula, pair by pair."""
    apart = x[None] - x[:, None]
    distance = np.sqrt((apart**2).sum(axis=2)) + np.eye(len(x))
    overlap = np.where(np.eye(len(x)), 0.0, np.maximum(radius[:, None] + radius - distance, 0.0))
    return -k * np.einsum("ij,ijc->ic", overlap / distance, apart), 0.25 * k * float((overlap**2).sum())


def cloud(seed: int, count: int, *, ordered: bool, density: float = 1.2) -> np.ndarray:
    """Centres at random; ordered by cells, or not."""
    x = np.random.default_rng(seed).uniform(0.0, (count / density) ** (1 / 3), (count, 3))
    return x[np.lexsort(np.floor(x).T)] if ordered else x


def pairs_of(block: Block) -> np.ndarray:
    """The pairs of elements (k, 2) in the list."""
    room = block.rooms[0]
    pairs = neighbours.pairs_in(room.ctypes.data)[0][: int(room[0, neighbours.FOUND])]
    order = neighbours.order_in(room.ctypes.data, len(block.indices)).astype(np.int64)
    found: np.ndarray = order[np.column_stack([pairs & 0xFFFFFFFF, pairs >> 32])]
    return found


@settings(derandomize=True, deadline=None, max_examples=examples(60), database=None)
@given(
    seed=st.integers(0, 2**32 - 1),
    count=st.integers(1, 200),
    shape=st.sampled_from([(1, 1, 1), (1, 1, 0), (30, 1, 0), (1, 0, 0), (0, 0, 1000), (1, 1e6, 1e10)]),
    large=st.integers(0, 2),
    ordered=st.booleans(),
)
def test_the_list_has_all_pairs_in_its_range_and_no_others(
    seed: int, count: int, shape: tuple[float, ...], large: int, ordered: bool
) -> None:
    """Once each, by their rows, in boxes of all shapes, flat, long, and too long for a cell each; as every distance
    tells. A negative control is below."""
    rng = np.random.default_rng(seed)
    x = rng.uniform(0.0, 1.0, (count, 3)) * shape * (count / 1.2) ** (1 / 3)
    x = x[np.lexsort(np.floor(x).T)] if ordered else x
    radius = rng.uniform(0.3, 0.6, count)
    radius[:large] *= 8.0
    block = spheres(x, radius)
    whole(block, x)
    room = block.rooms[0]
    if room[0, neighbours.COUNT] != count:
        assert large or shape.count(0) == 2  # more than there is place for: large ones, or all on a line
        return
    found = pairs_of(block)
    apart = np.sqrt(((x[:, None] - x) ** 2).sum(axis=2)) - radius[:, None] - radius - room[0, neighbours.RANGE]
    i, j = np.nonzero(np.triu(apart < 0.0, 1))
    assert {(a, b) for a, b in np.sort(found, axis=1).tolist()} == set(zip(i.tolist(), j.tolist(), strict=True))
    pairs = neighbours.pairs_in(room.ctypes.data)[0][: len(found)]
    assert len(found) == len(i) and (np.diff((pairs & 0xFFFFFFFF) << 32 | pairs >> 32) > 0).all()


def suits(room: np.ndarray, beyond: float, skin: float) -> float:
    """How often a list of this range and of the present pairs is of use where the range is the best."""
    each = room[0, neighbours.FOUND] / room[0, neighbours.SIZE]
    growth = list_range.much(beyond, skin, 1.0, each) - list_range.much(beyond, skin, 0.0, each)
    return max((1.0 - list_range.much(beyond, skin, 0.0, each)) / growth, 0.0)


@pytest.mark.parametrize("ordered", [True, False])
def test_forces_in_loops_do_not_show_the_age_of_the_list(ordered: bool) -> None:
    """To the bit: with a list of the shape before, new ones of the least and the greatest range, and none; and they are
    the sums over all pairs, to 1e-12 of the largest. Spheres in order have no table of their own."""
    x = cloud(3, 700, ordered=ordered)
    block, load = spheres(x), np.random.default_rng(4).normal(size=x.shape)
    room, skin = block.rooms[0], 0.075
    assert room[0, neighbours.AS_GIVEN] == ordered
    packed(block, x, load)
    moved = x + np.random.default_rng(5).uniform(-0.03, 0.03, x.shape)  # less than half of the range, 2 skins
    before = room[0, : neighbours.USED].copy()
    found = [packed(block, moved, load)]
    assert (room[0, : neighbours.USED] == before).all() and room[0, neighbours.USED] == 1.0
    for part in (neighbours.LEAST, neighbours.MOST):
        room[0, [neighbours.RANGE, neighbours.COUNT]] = part * skin, len(x)
        # moved too far for this range, and of use for as long as it takes to keep it
        room[0, neighbours.USED] = suits(room, part * skin, skin)
        far = packed(block, moved + 10.0, load)
        assert room[0, neighbours.RANGE] == part * skin and np.abs(far - found[0]).max() < 1e-9
        room[0, neighbours.USED] = suits(room, part * skin, skin)
        found.append(packed(block, moved, load))
        assert room[0, neighbours.RANGE] == part * skin
    place = room[0, neighbours.PAIRS]
    room[0, [neighbours.COUNT, neighbours.PAIRS]] = -1.0, 1.0
    found.append(packed(block, moved, load))
    assert room[0, neighbours.COUNT] == -1.0
    room[0, neighbours.PAIRS] = place
    for one in found[1:]:
        assert (one == found[0]).all()
    expected, _ = of_all_pairs(moved, np.full(len(x), 0.5), 10.0)
    assert np.abs(found[0] - load - expected).max() <= 1e-12 * np.abs(expected).max()


@pytest.mark.parametrize("seed", range(4))
def test_sums_are_those_over_all_pairs(seed: int) -> None:
    """Forces and energy to 1e-12 of the largest, along a walk that makes new lists."""
    rng = np.random.default_rng(seed)
    x = cloud(seed, 400, ordered=seed % 2 == 0)
    radius = rng.uniform(0.3, 0.6, 400)
    block = spheres(x, radius)
    for step in (0.0, 0.01, 0.01, 0.1, 1.0, 0.01):
        x = x + step * rng.normal(size=x.shape)
        expected, least = of_all_pairs(x, radius, 10.0)
        f, _, energy = whole(block, x)
        assert np.abs(f - expected).max() <= 1e-12 * np.abs(expected).max()
        assert energy == pytest.approx(least, rel=1e-12)
        assert np.abs(packed(block, x, np.zeros_like(x)) - expected).max() <= 1e-12 * np.abs(expected).max()


def test_a_list_without_one_touching_pair_is_noticed() -> None:
    """The negative control: one pair less, and the sums differ from those over all pairs by its force."""
    x = cloud(7, 300, ordered=True)
    block = spheres(x)
    room = block.rooms[0]
    whole(block, x)
    pairs = neighbours.pairs_in(room.ctypes.data)[0][: int(room[0, neighbours.FOUND])]
    i, j = pairs & 0xFFFFFFFF, pairs >> 32
    overlap = 1.0 - np.sqrt(((x[i] - x[j]) ** 2).sum(axis=1))
    out = int(np.argmax(overlap))
    pairs[out:-1] = pairs[out + 1 :].copy()
    room[0, neighbours.FOUND] -= 1.0
    expected, _ = of_all_pairs(x, np.full(len(x), 0.5), 10.0)
    for f in (whole(block, x)[0], packed(block, x, np.zeros_like(x))):
        assert np.abs(f - expected).max() == pytest.approx(
            10.0 * overlap[out] * np.abs(x[i[out]] - x[j[out]]).max() / (1.0 - overlap[out]), rel=1e-9
        )


def test_packed_spheres_have_the_radii_and_groups_of_now() -> None:
    """Parameters written after the list was made: forces are those of a new scene, to the bit."""
    x = cloud(9, 200, ordered=True)
    block, still = spheres(x), np.zeros_like(x)
    packed(block, x, still)
    block.parameters[:, cells.RADIUS] = 0.6
    assert (packed(block, x, still) == packed(spheres(x, 0.6), x, still)).all()
    block.parameters[:, cells.GROUP] = 1.0
    assert not packed(block, x, still).any()


def test_a_sphere_that_is_nowhere_leaves_the_others_as_they_are() -> None:
    """Its coordinates are not numbers, or infinite: nothing touches it, and forces of the others are the bits of a
    scene in which it is far away; once it is back, it is felt again."""
    x = cloud(11, 200, ordered=True)
    block, still = spheres(x), np.zeros_like(x)
    away, back = x.copy(), packed(spheres(x), x, still)
    away[0] = 1e3
    expected = packed(spheres(x), away, still)
    for nowhere in (np.nan, np.inf):
        lost = x.copy()
        lost[0] = nowhere
        assert (packed(block, lost, still)[1:] == expected[1:]).all()
        assert (packed(block, x, still) == back).all() and np.abs(back[0]).max() > 0.0


def test_several_crowds_on_particles_in_any_order_are_packed() -> None:
    """Two forces in one block, on consecutive particles and on the others in disorder, which do not feel each other:
    forces in loops are those over all pairs of each, to 1e-12 of the largest."""
    rng, x = np.random.default_rng(13), cloud(13, 300, ordered=True, density=2.4)
    parts = np.arange(120, 240), rng.permutation(np.r_[:120, 240:300])
    forces = [{"kind": "collide", "particles": part, "radius": 0.5, "strength": 10.0} for part in parts]
    block = compile(Scene(particles=x, forces=forces)).groups[0].block
    expected = np.zeros_like(x)
    for part in parts:
        expected[part], _ = of_all_pairs(x[part], np.full(len(part), 0.5), 10.0)
    for moved in (x, x + [5.0, 0.0, 0.0]):
        difference = packed(block, moved, np.zeros_like(x)) - expected
        assert np.abs(difference).max() <= 1e-12 * np.abs(expected).max() * (1.0 + np.abs(moved).max())


def test_a_motion_of_all_together_needs_no_new_list() -> None:
    """Far beyond the range, and with small ways of their own: the list stays, and the forces are those of a new one, to
    the bit; ways of their own beyond it make a new one."""
    x = cloud(7, 300, ordered=True)
    block = spheres(x)
    room = block.rooms[0]
    whole(block, x)
    seen = room[0].copy()
    moved = x + [3.0, -2.0, 50.0] + np.random.default_rng(8).uniform(-0.01, 0.01, x.shape)
    found, quick = whole(block, moved), packed(block, moved, np.zeros_like(x))
    kept = neighbours.HEAD + (neighbours.HERE + neighbours.SUMS + 1) * len(x)
    assert (room[0, kept : kept + 5 * len(x)] == seen[kept : kept + 5 * len(x)]).all()
    room[0, neighbours.COUNT] = -1.0
    new, lean = whole(block, moved), packed(block, moved, np.zeros_like(x))
    assert (new[0] == found[0]).all() and (new[1] == found[1]).all() and new[2] == found[2]
    assert (lean == quick).all()
    apart = moved.copy()
    apart[0, 0] += 5.0
    whole(block, apart)
    left = 0.5 * (room[0, neighbours.RANGE] - 0.075)  # of a new list all are as near to their places
    assert abs(room[0, kept] - apart[0, 0]) <= left < 5.0


@pytest.mark.parametrize("speed", [0.01, 0.05])
def test_the_list_of_an_even_motion_serves_longer(speed: float) -> None:
    """Half of a range of R skins s allows a way of R s / 2 from where spheres are, and before it that to their places,
    0.9 (R - 1) s / 2 at most: uses are these by the way of each use, to one and a half (whole numbers) and 5 % (speeds
    are counted from their mean, that of 300 directions)."""
    x = cloud(11, 300, ordered=True)
    block, way = spheres(x), np.random.default_rng(12).normal(size=x.shape)
    way *= speed / np.sqrt((way**2).sum(axis=1))[:, None]
    room, skin, before, uses = block.rooms[0], 0.075, np.zeros(2), []
    for _ in range(400):
        x = x + way
        packed(block, x, np.zeros_like(x))
        if room[0, neighbours.USED] == 0.0:
            least, most = 0.5 * before[0] / speed, 0.5 * (before[0] + 0.9 * (before[0] - skin)) / speed
            uses.append((before[1] + 1.0, least, most))
        before = room[0, [neighbours.RANGE, neighbours.USED]].copy()
    x = x + way * (1.5 / speed)  # farther at once than a list may range: its half would be too far ahead
    packed(block, x, np.zeros_like(x))
    off = np.sqrt(((neighbours.seen_in(room.ctypes.data)[:, :3] - x) ** 2).sum(axis=1)).max()
    assert 0.0 < off <= 0.5 * (room[0, neighbours.RANGE] - skin)
    found = np.array(uses[-5:])  # the first lists learn the motion
    assert (found[:, 0] > 1.4 * found[:, 1]).all()
    assert (np.abs(found[:, 0] - found[:, 2]) <= 1.5 + 0.05 * found[:, 2]).all()


@pytest.mark.parametrize("seed", range(3))
def test_a_motion_that_turns_back_shows_no_age_of_the_list(seed: int) -> None:
    """Spheres that fly evenly, so that their places are ahead, and that turn back at any step: all pairs in reach, and
    forces of loops those of a list made for the step, to the bit."""
    rng = np.random.default_rng(seed)
    x = cloud(seed, 300, ordered=seed % 2 == 0)
    block, fresh, still = spheres(x), spheres(x), np.zeros_like(x)
    way, ahead = rng.normal(size=x.shape), 0
    way *= 0.03 / np.sqrt((way**2).sum(axis=1))[:, None]
    for step in range(60):
        x = x + way
        if step % 20 == 13 + seed:
            way = np.where(rng.random(len(x))[:, None] < 0.5, -way, way)
        fresh.rooms[0][0, neighbours.COUNT] = -1.0
        assert (packed(block, x, still) == packed(fresh, x, still)).all()
        ahead += block.rooms[0][0, neighbours.AHEAD] > 0.5
        if step % 5 == 0:
            expected, _ = of_all_pairs(x, np.full(len(x), 0.5), 10.0)
            assert np.abs(whole(block, x)[0] - expected).max() <= 1e-12 * np.abs(expected).max()
    assert ahead > 20


def test_spheres_that_swing_keep_their_places() -> None:
    """To and fro by less than the range allows, after a flight that made a list ahead: places come back to where the
    spheres are, and the list is made no more."""
    x = cloud(13, 300, ordered=True)
    block, way = spheres(x), np.random.default_rng(14).normal(size=x.shape)
    way *= 0.03 / np.sqrt((way**2).sum(axis=1))[:, None]
    room, still, made = block.rooms[0], np.zeros_like(x), 0
    for _ in range(20):
        x = x + way
        packed(block, x, still)
    assert room[0, neighbours.AHEAD] > 0.5
    for step in range(100):
        packed(block, x + (0.8 * way if step % 2 else -0.8 * way), still)
        made += step >= 20 and room[0, neighbours.USED] == 0.0
    assert made <= 4  # of a range that settles


@pytest.mark.parametrize("ordered", [True, False])
@pytest.mark.parametrize("fall", [0.0, -0.5])
@pytest.mark.parametrize("group", [0, 3])
def test_the_few_that_stray_join_the_list_again(ordered: bool, fall: float, group: int) -> None:
    """Ten of 700 spheres fly through the others, which swing and may all fall: one list serves, has each pair once, in
    order, and all in reach; forces are those of a list made for the step, to the bit."""
    rng = np.random.default_rng(17)
    x = cloud(17, 700, ordered=ordered)
    groups = group * (np.arange(700) % 4 == 0)
    block, fresh, still = spheres(x, collision_group=groups), spheres(x, collision_group=groups), np.zeros_like(x)
    room, way, fast = block.rooms[0], np.zeros_like(x), rng.choice(700, 10, replace=False)
    way[fast] = rng.normal(size=(10, 3))
    way *= 0.08 / np.maximum(np.sqrt((way**2).sum(axis=1)), 1e-9)[:, None]
    packed(block, x, still)
    for step in range(12):
        x = x + way + [0.0, 0.0, fall]
        swung = x + rng.uniform(-0.02, 0.02, x.shape)
        fresh.rooms[0][0, neighbours.COUNT] = -1.0
        assert (packed(block, swung, still) == packed(fresh, swung, still)).all()
        assert room[0, neighbours.USED] == step + 1.0
    assert room[0, neighbours.STRAYS] == 10.0
    pairs = neighbours.pairs_in(room.ctypes.data)[0][: int(room[0, neighbours.FOUND])]
    assert (np.diff((pairs & 0xFFFFFFFF) << 32 | pairs >> 32) > 0).all()
    fresh.rooms[0][0, neighbours.COUNT] = -1.0
    (f, w, energy), (force, stiffness, least) = whole(block, x), whole(fresh, x)
    assert (f == force).all() and (w == stiffness).all() and energy == least
    assert room[0, neighbours.USED] > 12.0  # the skin of `whole` is in the same list


def test_a_list_that_too_many_leave_is_made_again() -> None:
    """One in 32 may join it anew, and one more; the list that another one leaves is a new one."""
    x = cloud(18, 640, ordered=True)
    block, fresh, still = spheres(x), spheres(x), np.zeros_like(x)
    room, most = block.rooms[0], neighbours.most_strays(640)
    assert most == 640 // 32 + 1
    packed(block, x, still)
    for strays, used in ((range(most), 1.0), (range(most), 2.0), (range(most + 1), 0.0)):
        x[strays] += 0.2
        fresh.rooms[0][0, neighbours.COUNT] = -1.0
        assert (packed(block, x, still) == packed(fresh, x, still)).all()
        assert (room[0, neighbours.USED], room[0, neighbours.STRAYS]) == (used, most * (used > 0.0))


def test_beside_a_large_sphere_a_list_is_made_again() -> None:
    """It is in no cell, so that those about a stray would miss it: forces are those over all pairs."""
    x = cloud(19, 300, ordered=True)
    radius = np.full(300, 0.5)
    radius[150] = 4.0
    block, still = spheres(x, radius), np.zeros_like(x)
    packed(block, x, still)
    assert block.rooms[0][0, neighbours.WIDTH] == 0.0 < block.rooms[0][0, neighbours.FOUND]
    x[:2] = x[150] + [[2.0, 0.0, 0.0], [0.0, 3.0, 0.0]]
    expected, _ = of_all_pairs(x, radius, 10.0)
    assert np.abs(packed(block, x, still) - expected).max() <= 1e-12 * np.abs(expected).max()
    assert block.rooms[0][0, neighbours.USED] == 0.0


@pytest.mark.slow
def test_a_stray_that_meets_too_many_makes_a_new_list() -> None:
    """Pairs that join are as many as there is place for, 64 of a stray: of 200 spheres in one place it has more."""
    x = cloud(20, 2000, ordered=True)
    x[:200] = 50.0 + np.random.default_rng(20).uniform(0.0, 0.3, (200, 3))
    block, still = spheres(x), np.zeros_like(x)
    room = block.rooms[0]
    packed(block, x, still)
    assert room[0, neighbours.COUNT] == 2000.0
    x[1999] = 50.0
    expected, _ = of_all_pairs(x, np.full(2000, 0.5), 10.0)
    assert np.abs(packed(block, x, still) - expected).max() <= 1e-12 * np.abs(expected).max()
    assert room[0, neighbours.USED] == 0.0
