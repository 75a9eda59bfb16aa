"""Kinks of forces at a shape: contacts that just touch, springs at the length where they become slack or let go. There
the derivative on one side differs from that on the other."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from hookean.designing.equilibrium import Equilibrium
from hookean.system.group import Group

Floats = NDArray[np.float64]

NEAR = 1e-7  # part of the model's size within which a kink counts
UNLIKE = 1e-3  # part of a change of force by which both sides of a smooth one differ at most: NEAR times its curvature
SEED = 20  # of the direction in which particles are moved


def kinks(found: Equilibrium) -> list[str]:
    """A sentence for each kind of force with a kink at the shape; and one for all where it is not of one element."""
    system, state = found.system, found.state
    move = np.random.default_rng(SEED).uniform(-1.0, 1.0, state.x.shape) * NEAR * system.size
    sides = [replace(state, x=state.x + way * move) for way in (-1.0, 0.0, 1.0)]
    at = _unlike([system.evaluate(side)[0] for side in sides])
    if not at.any():
        return []
    said = []
    for group, memory in zip(system.groups, state.memory, strict=True):
        alone = Group(group.cls, replace(group.block, plan=[]), [])
        own = _unlike([system.element_forces(alone, side, memory).reshape(len(memory), -1) for side in sides])
        if own.any():
            said.append(_sentence(group.cls.kind_name, f"element {int(np.argmax(own))}", int(own.sum())))
    return said or [_sentence("forces", f"particle {int(np.argmax(at))}", int(at.sum()))]


def _unlike(given: list[Floats]) -> NDArray[np.bool_]:
    """Rows that change on the way from the first to the second otherwise than from there to the third."""
    before, after = given[1] - given[0], given[2] - given[1]
    size = np.maximum(_sizes(before), _sizes(after))
    rounding = 1e-13 * max(float(np.abs(each).max(initial=0.0)) for each in given)
    return np.asarray(_sizes(after - before) > UNLIKE * size + rounding)


def _sizes(rows: Floats) -> Floats:
    return np.asarray(np.sqrt(np.einsum("ij,ij->i", rows, rows)))


def _sentence(kind: str, first: str, count: int) -> str:
    more = f" and {count - 1} more" if count > 1 else ""
    return (
        f"{kind}: {first}{more} at a kink (a contact that just touches, a limit just met); derivatives hold on one side"
    )
