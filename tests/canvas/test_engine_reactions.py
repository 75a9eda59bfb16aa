"""Reactions on the canvas: one for each anchor, in the order of the anchors, whatever their targets."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from canvas.canvasing import point, xyz
from canvas.test_engine import Cable, home, rhino, served
from hookean_client import canvas

__all__ = ["home", "rhino", "served"]


def pulls(cable: Cable, number: int) -> np.ndarray:
    """What holds a particle: the opposite of its springs, 1000 N/m and 1 m long at the start, and of its load."""
    x = np.array([xyz(p) for p in cable.out.particles])
    held = np.array([0.0, 0.0, -cable.load])
    for other in (number - 1, number + 1):
        if 0 <= other < len(x):
            span = x[other] - x[number]
            length = np.linalg.norm(span)
            held -= 1000.0 * (length - 1.0) * span / length
    return np.asarray(held)


def given(cable: Cable, places: Any, targets: Any, **axes: bool) -> list[str]:
    """The text of anchors with targets."""
    made = canvas.anchors(cable.springs, [point(*p) for p in places], [point(*t) for t in targets], **axes)
    return made if isinstance(made, list) else [made]


@pytest.mark.parametrize("order", [[0, 1, 2], [2, 0, 1], [1, 2, 0]])
def test_reactions_come_in_the_order_of_anchors_with_targets(order: list[int], home: Any) -> None:
    places, targets = [(0, 0, 0), (4, 0, 0), (10, 0, 0)], [(1, 1, 0), (4, 0, 2), (12, 0, 1)]
    cable = Cable()
    cable.anchors = given(cable, [places[i] for i in order], [targets[i] for i in order])
    cable.run()
    numbers = [(0, 4, 10)[i] for i in order]
    found = [xyz(v) for v in cable.out.reactions.Branch(0)]
    assert [cable.at(n) for n in numbers] == [tuple(map(float, targets[i])) for i in order]
    assert np.array(found) == pytest.approx(np.array([pulls(cable, n) for n in numbers]), abs=1e-3)
    cable.anchors = given(
        cable, [places[i] for i in order], [(x, y + 0.5, z) for x, y, z in (targets[i] for i in order)]
    )
    cable.run(lambda out: cable.player.settled)
    found = [xyz(v) for v in cable.out.reactions.Branch(0)]
    assert np.array(found) == pytest.approx(np.array([pulls(cable, n) for n in numbers]), abs=1e-3)


@pytest.mark.parametrize("doubled", [["xyz", "xyz"], ["xy", "yz"], ["z", "xyz"]])
def test_a_particle_with_two_anchors_has_its_reaction_once(doubled: list[str], home: Any) -> None:
    """Each direction is with the last anchor that holds it, whose target it is at; the others have none of it there.
    So all reactions add up to the loads, which sum to -110 N."""
    cable = Cable()
    places = [(0, 0, 0), (0, 0, 0), (10, 0, 0)]
    cable.anchors = [
        canvas.anchors(cable.bench.component("Anchors"), [point(*place)], None, *(axis in axes for axis in "xyz"))
        for place, axes in zip(places, [*doubled, "xyz"], strict=True)
    ]
    cable.run()
    found = np.array([xyz(v) for path in cable.out.reactions.Paths for v in cable.out.reactions.Branch(path)])
    assert found.shape == (3, 3)
    whole = pulls(cable, 0)
    for number, axes in enumerate(doubled):
        last = [axis in axes and all(axis not in later for later in doubled[number + 1 :]) for axis in "xyz"]
        assert found[number] == pytest.approx(np.where(last, whole, 0.0), abs=1e-3)
    assert found.sum(axis=0) == pytest.approx([0.0, 0.0, 110.0], abs=1e-3)
