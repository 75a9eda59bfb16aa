"""The elements with two ends, such as springs: which particles they join, and with what force."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hookean.system.group import Group
from hookean.system.state import State
from hookean.system.system import System


def spring_forces(system: System, state: State) -> NDArray[np.float64]:
    """The force (m,) [force] in every element with two ends, tension +, in the order of `spring_ends`."""
    found = [np.zeros(0)]
    for group, memory in zip(system.groups, state.memory, strict=True):
        if _two_ended(group):
            pulls = system.element_forces(group, state, memory)[:, 0]
            start, end = group.particles.T
            along = state.x.take(end, axis=0) - state.x.take(start, axis=0)
            length = np.sqrt(np.einsum("ij,ij->i", along, along))
            found.append(np.einsum("ij,ij->i", pulls, along) / np.where(length > 0.0, length, 1.0))
    return np.concatenate(found)


def spring_ends(system: System) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Particles (m, 2) and number of the force in the scene (m,) of every element with two ends."""
    pairs, numbers = [np.zeros((0, 2), np.int64)], [np.zeros(0, np.int64)]
    for group in system.groups:
        if _two_ended(group):
            pairs.append(group.particles)
            number = np.zeros(len(group.block.indices), np.int64)
            for part in group.parts:
                number[part.rows] = part.number
            numbers.append(number)
    return np.concatenate(pairs), np.concatenate(numbers)


def _two_ended(group: Group) -> bool:
    return bool(group.cls.role == "internal" and group.particles.shape[1] == 2)
