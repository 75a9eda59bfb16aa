"""From one system to another: where the particles of the next one begin."""

from __future__ import annotations

import numpy as np

from hookean.system.state import State
from hookean.system.system import System


def followed(system: System, state: State, following: System) -> State:
    """The first state of the system `following`: particles that start where one of `system` starts (within the weld
    tolerance) are where that one is in `state`, with its velocity. Its revision is the next one."""
    from scipy.spatial import cKDTree

    begun = following.start()
    apart, same = cKDTree(system.points).query(following.points)
    known = np.flatnonzero(apart <= following.scene.weld_tolerance)
    following.slots.take_over(begun, known, system.slots, state, same[known])
    following.hold(begun)
    following.put_outside(begun)
    begun.revision = state.revision + 1
    return begun
