"""Kinks of forces at a shape: contacts that just touch, springs at the length where they become slack or let go. There
the derivative on one side differs from that on the other: forces change by a different amount on the way forth than on
the way back. On a smooth path that difference is of second order, a quarter at half the step; at a kink it is a half.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from hookean.designing.equilibrium import Equilibrium
from hookean.solvers.force_density import nonlinear
from hookean.system.group import Group
from hookean.system.state import State

Floats = NDArray[np.float64]

NEAR = 1e-7  # part of the model's size within which a kink counts
UNLIKE = 1e-3  # part of a change of force by which both sides of a smooth one differ at most: NEAR times its curvature
FALL = 1.0 / 3.0  # of that difference at half the step: more than a quarter, less than a half
SEED = 20  # of the direction in which particles are moved


def kinks(found: Equilibrium) -> list[str]:
    """A sentence for each kind of force with a kink at the shape; and one for all where it is not of one element."""
    system, state = found.system, found.state
    if not nonlinear(system):
        return []
    reach = NEAR * system.size
    move = np.random.default_rng(SEED).uniform(-1.0, 1.0, state.x.shape) * reach

    def side(way: float) -> State:
        return replace(state, x=state.x + way * move)

    # the stiffness of a particle times its step is as much as its force changes, whichever way it goes
    given = [system.evaluate(side(way)) for way in (-1.0, 0.0, 1.0)]
    stiffness = np.maximum(given[0][1], given[2][1]) * reach
    at = _unlike(lambda way: system.evaluate(side(way))[0], [forces for forces, _, _ in given], stiffness)
    if not at.any():
        return []
    said = []
    for group, memory in zip(system.groups, state.memory, strict=True):
        alone = Group(group.cls, replace(group.block, plan=[]), [])

        def forces(way: float, alone: Group = alone, memory: Floats = memory) -> Floats:
            return system.element_forces(alone, side(way), memory).reshape(len(memory), -1)

        own = _unlike(forces, [forces(way) for way in (-1.0, 0.0, 1.0)])
        if own.any():
            said.append(_sentence(group.cls.kind_name, f"element {int(np.argmax(own))}", int(own.sum())))
    return said or [_sentence("forces", f"particle {int(np.argmax(at))}", int(at.sum()))]


def _unlike(forces: Callable[[float], Floats], given: list[Floats], least: Floats | float = 0.0) -> NDArray[np.bool_]:
    """Rows of forces that change on the way from a step before to the shape otherwise than from there to a step after:
    by a part of the change, or of the `least` that one is, and at half the step by more than a smooth one would."""
    before, after = given[1] - given[0], given[2] - given[1]
    size = np.maximum(np.maximum(_sizes(before), _sizes(after)), least)
    rounding = 1e-13 * max(float(np.abs(each).max(initial=0.0)) for each in given)
    whole = _sizes(after - before)
    found = np.asarray(whole > UNLIKE * size + rounding)
    if found.any():
        found &= _sizes(forces(0.5) - given[1] + (forces(-0.5) - given[1])) > FALL * whole
    return found


def _sizes(rows: Floats) -> Floats:
    return np.asarray(np.sqrt(np.einsum("ij,ij->i", rows, rows)))


def _sentence(kind: str, first: str, count: int) -> str:
    more = f" and {count - 1} more" if count > 1 else ""
    return (
        f"{kind}: {first}{more} at a kink (a contact that just touches, a limit just met); derivatives hold on one side"
    )
