"""A part of a net by itself: some particles that move, and around them those that hold still."""

from __future__ import annotations

from dataclasses import replace
from functools import reduce
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from hookean.compiled import dispatch
from hookean.system.group import Group
from hookean.system.state import State
from hookean.system.system import System

if TYPE_CHECKING:
    from hookean.linear.tangent_blocks import Ints

Chosen = NDArray[np.bool_]


def widened(starts: Ints, columns: Ints, chosen: Chosen, rings: int) -> Chosen:
    """The chosen particles (n,) and those within some rings of neighbours, in a pattern of blocks."""
    for _ in range(rings):
        wider = chosen.copy()
        dispatch.compiled(widen)(starts, columns, chosen, wider)
        chosen = wider
    return chosen


def widen(starts, columns, chosen, wider):  # type: ignore[no-untyped-def]
    """Add the neighbours of the chosen ones to `wider`."""
    for i in range(starts.shape[0] - 1):
        for s in range(starts[i] + 1, starts[i + 1]):
            j = columns[s]
            if chosen[i]:
                wider[j] = True
            if chosen[j]:
                wider[i] = True


def cut(system: System, state: State, moving: Chosen) -> tuple[System, State, NDArray[np.int64]]:
    """The system and the state of the particles (n,) that move, of all elements that touch them or that these feel, and
    of the others that all of them hang on, which hold still; and which particles of the whole they are."""
    touched = moving.copy()
    taken = []
    for group in system.groups:
        touching = np.flatnonzero(reduce(np.logical_or, (moving.take(end) for end in group.block.indices.T)))
        rows, block = group.cls.taken(group.block, touching)
        taken.append((rows, block))
        touched[block.indices] = True
    particles = np.flatnonzero(touched)
    number = np.zeros(len(moving), np.int64)
    number[particles] = np.arange(len(particles))
    groups, memory = [], []
    for group, (rows, block), own in zip(system.groups, taken, state.memory, strict=True):
        groups.append(Group(group.cls, replace(block, indices=number[block.indices]), []))
        memory.append(own[rows])
    x, v, mass = system.x[particles], system.v[particles], system.mass[particles]
    part = replace(system, x=x, v=v, mass=mass, groups=groups, held=[], carried=[])
    free = state.free[particles] * moving[particles][:, None]
    return part, State(state.x[particles], np.zeros_like(x), free, memory=memory), particles
