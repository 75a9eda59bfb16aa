"""How far a list of neighbours ranges: as far as takes the least time."""

from __future__ import annotations

import numpy as np
import pytest

from core.test_neighbours import cloud, packed, spheres
from hookean.forces import list_range, neighbours
from hookean.forces.base import Block


def wander(block: Block, x: np.ndarray, way: float, seed: int) -> None:
    """Forty steps of one way each in directions that change."""
    rng, still = np.random.default_rng(seed), np.zeros_like(x)
    for _ in range(40):
        turn = rng.normal(size=x.shape)
        x = x + way * turn / np.sqrt((turn**2).sum(axis=1))[:, None]
        packed(block, x, still)


def test_the_range_follows_the_motion_and_the_pairs() -> None:
    """At rest a list ends with the least range, and pairs that are too many are gone; where every sphere moves by a
    skin each time, it is more than thrice that; and the greatest where spheres are so far apart that most have no
    neighbour."""
    x = cloud(2, 400, ordered=True)
    block, skin = spheres(x), 0.075
    room, still = block.rooms[0], np.zeros_like(x)
    packed(block, x, still)
    first = room[0, neighbours.FOUND]
    for _ in range(1000):  # the first list is too long after some 130 uses, the next one after 200
        packed(block, x, still)
    assert room[0, neighbours.RANGE] == neighbours.LEAST * skin and room[0, neighbours.FOUND] < first
    wander(block, x, skin, 0)
    assert 3.0 * neighbours.LEAST * skin < room[0, neighbours.RANGE] < neighbours.MOST * skin
    thin = spheres(4.0 * x)
    wander(thin, 4.0 * x, skin, 0)
    assert thin.rooms[0][0, neighbours.RANGE] == neighbours.MOST * skin


@pytest.mark.parametrize("seed", range(20))
def test_the_range_that_suits_takes_the_least_time(seed: int) -> None:
    """Of a list that is of use in proportion to its range, where it suits to within a part in a thousand: of ranges a
    tenth longer and shorter, none takes less time an element and use, (MAKE + FIND p) / T + p."""
    rng = np.random.default_rng(seed)
    skin, beyond, each = 0.1, 0.1 * rng.uniform(1.25, 8.0), rng.uniform(0.1, 2.0)
    low, high = 0.0, 1e6
    for _ in range(60):
        uses = 0.5 * (low + high)
        low, high = (uses, high) if list_range.much(beyond, skin, uses, each) < 1.0 else (low, uses)
    round_ = list_range.ROUND * skin

    def takes(part: float) -> float:
        pairs = each * ((round_ + part * beyond) / (round_ + beyond)) ** 3
        return float((list_range.MAKE + list_range.FIND * pairs) / (part * uses) + pairs)

    assert 0.0 < uses < 1e6 and takes(1.0) < min(takes(0.9), takes(1.1))


def test_spheres_that_no_list_serves_twice_have_the_shortest() -> None:
    """A way of nine skins a step in directions that change: farther than half of the greatest range, 8. One of five
    would do for two uses, which takes more time where spheres have many neighbours, and less where they are far apart;
    slower again, the range grows again."""
    skin, x = 0.075, cloud(21, 400, ordered=True)
    for way, apart, least, most in (
        (9.0, 4.0, neighbours.LEAST, neighbours.LEAST),
        (5.0, 1.0, neighbours.LEAST, neighbours.LEAST),
        (5.0, 4.0, 2.0 * 5.0, neighbours.MOST),
    ):
        block = spheres(apart * x)
        wander(block, apart * x, way * skin, 21)
        assert least * skin <= block.rooms[0][0, neighbours.RANGE] <= most * skin
        wander(block, apart * x, skin, 22)
        assert block.rooms[0][0, neighbours.RANGE] > 3.0 * neighbours.LEAST * skin
