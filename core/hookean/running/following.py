"""From one system to another: where the particles of the next one begin."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hookean.forces.base import lengths
from hookean.system.state import State
from hookean.system.system import System

Ints = NDArray[np.int64]


def followed(system: System, state: State, following: System) -> State:
    """The first state of the system `following`: particles that start where one of `system` starts (within the weld
    tolerance) are where that one is in `state`, with its velocity. Its revision is the next one.

    Of several that start there it is the one of the same number, else the nearest.
    """
    from scipy.spatial import cKDTree

    tolerance = following.scene.weld_tolerance
    apart, same = cKDTree(system.points).query(following.points)
    both = min(len(system.points), len(following.points))
    moved = lengths(following.points[:both] - system.points[:both])
    own = np.flatnonzero(moved <= tolerance)
    apart[own], same[own] = moved[own], own
    known = np.flatnonzero(apart <= tolerance)
    return taken_over(system, state, following, known, same[known])


def taken_over(system: System, state: State, following: System, known: Ints, same: Ints) -> State:
    """The first state of the system `following`, whose particles `known` go on from where the particles `same` of
    `system` are in `state`. Its revision is the next one."""
    begun = following.start()
    following.slots.take_over(begun, known, system.slots, state, same)
    following.hold(begun)
    following.put_outside(begun)
    begun.revision = state.revision + 1
    return begun
