"""Tension: nets in which everything pulls are stable, and finding that out takes one pass over their elements.

A spring that pulls resists every motion of its ends against each other: k along itself, tension / length across. Where
springs that pull connect every particle with something that is held, no motion is free of resistance, and as nothing
pushes, no motion gains energy: the tangent is positive definite.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from hookean.compiled import dispatch
from hookean.forces.anchor_spring import AnchorSpring, slides
from hookean.system.components import root

if TYPE_CHECKING:
    from hookean.system.state import State
    from hookean.system.system import System

Floats = NDArray[np.float64]

CHUNK = 2048  # elements at a time: their stiffness stays in the nearest cache
SLACK = 1e-12  # part of the stiffness along an element that its tension must add across


def taut(system: System, state: State, free: Floats) -> bool:
    """Whether elements that pull hold all axes with `free` (n, 3) above 0, and none pushes: then the tangent is
    positive definite. False proves nothing."""
    n = len(free)
    parent, held = np.arange(n), np.zeros(n, np.int64)
    for group, memory in zip(system.groups, state.memory, strict=True):
        b = group.block
        if group.cls.constant or not len(b.indices):
            continue
        if group.cls is AnchorSpring:
            if slides(b):
                return False
            held[b.indices[b.parameters[:, 0] > 0.0, 0]] = 7
            continue
        if group.cls.central is None:
            return False
        for first in range(0, len(b.indices), CHUNK):
            part = slice(first, first + CHUNK)
            stiffness = np.empty((len(b.indices[part]), 5))
            dispatch.compiled(group.cls.central, "central")(
                state.x, b.indices[part], b.parameters[part], memory[part], stiffness
            )
            if not dispatch.compiled(bind)(b.indices[part], stiffness, SLACK, free, parent, held):
                return False
    return bool(dispatch.compiled(bound)(free, parent, held))


def bind(indices, stiffness, slack, free, parent, held):  # type: ignore[no-untyped-def]
    """Connect the moving ends of elements that pull, and note the axes on which what they pull at is held; False where
    one pushes."""
    for e in range(indices.shape[0]):
        along, across = stiffness[e, 0], stiffness[e, 1]
        if along < 0.0 or across < 0.0:
            return False
        if not (along > 0.0 and across > slack * along):
            continue
        a, b = indices[e, 0], indices[e, 1]
        free_a, free_b = free[a, 0] + free[a, 1] + free[a, 2], free[b, 0] + free[b, 1] + free[b, 2]
        if free_a > 0.0 and free_b > 0.0:
            i, j = root(parent, a), root(parent, b)
            if i < j:
                parent[j] = i
            else:
                parent[i] = j
        elif free_a > 0.0:
            held[a] = 7
        elif free_b > 0.0:
            held[b] = 7
    return True


def bound(free, parent, held):  # type: ignore[no-untyped-def]
    """Whether all that moves is connected with something held on every axis."""
    for i in range(free.shape[0]):
        if free[i, 0] + free[i, 1] + free[i, 2] > 0.0:
            bits = held[i]
            for c in range(3):
                if free[i, c] == 0.0:
                    bits |= 1 << c
            held[root(parent, i)] |= bits
    for i in range(free.shape[0]):
        if free[i, 0] + free[i, 1] + free[i, 2] > 0.0 and held[root(parent, i)] != 7:
            return False
    return True
