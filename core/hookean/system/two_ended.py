"""The elements with two ends, such as springs: which particles they join, and with what force."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hookean.compiled import dispatch
from hookean.system.group import Group
from hookean.system.state import State
from hookean.system.system import System

CHUNK = 2048  # elements at a time


def spring_forces(system: System, state: State) -> NDArray[np.float64]:
    """The force (m,) [force] in every element with two ends, tension +, in the order of `spring_ends`."""
    found = [np.zeros(0)]
    for group, memory in zip(system.groups, state.memory, strict=True):
        if _two_ended(group) and group.cls.central is not None:
            found.append(_central(group, state, memory))
        elif _two_ended(group):
            pulls = system.element_forces(group, state, memory)[:, 0]
            start, end = group.particles.T
            along = state.x.take(end, axis=0) - state.x.take(start, axis=0)
            length = np.sqrt(np.einsum("ij,ij->i", along, along))
            found.append(np.einsum("ij,ij->i", pulls, along) / np.where(length > 0.0, length, 1.0))
    return np.concatenate(found)


def _central(group: Group, state: State, memory: NDArray[np.float64]) -> NDArray[np.float64]:
    """The same of elements whose force acts along them, by their stiffness: many times quicker than the kernel."""
    b, found = group.block, np.empty(len(group.block.indices))
    central, pull = dispatch.compiled(group.cls.central, "central"), dispatch.compiled(tension)
    for first in range(0, len(found), CHUNK):  # few enough to stay in the nearest cache
        part = slice(first, first + CHUNK)
        stiffness = np.empty((len(found[part]), 5))
        central(state.x, b.indices[part], b.parameters[part], memory[part], stiffness)
        pull(b.indices[part], state.x, stiffness, found[part])
    return found


def tension(indices, x, stiffness, found):  # type: ignore[no-untyped-def]
    """Write the force along each element [force], tension +: its stiffness across times its length."""
    for e in range(indices.shape[0]):
        a, b = np.uint64(indices[e, 0]), np.uint64(indices[e, 1])
        dx, dy, dz = x[b, 0] - x[a, 0], x[b, 1] - x[a, 1], x[b, 2] - x[a, 2]
        found[e] = stiffness[e, 1] * np.sqrt(dx * dx + dy * dy + dz * dz)


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
