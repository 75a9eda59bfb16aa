"""How forces change with columns at fixed positions, df/du: as entries of a matrix, or times a motion of all particles,
where no matrix is needed."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from hookean.designing.columns import Column
from hookean.forces.base import Block, Force
from hookean.running.patch import lead_forces
from hookean.system.group import Group

if TYPE_CHECKING:
    from hookean.designing.equilibrium import Equilibrium

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

CHUNK = 4096  # elements at a time: what is known of them stays in the nearest cache
NOTHING = np.zeros(0, np.int64)


def pushes(found: Equilibrium, variable: Column) -> tuple[Ints, Ints, Floats]:
    """df/du of a column [force by unit]: places in (3n, unknowns), and values."""
    rows, columns, values = [NOTHING], [NOTHING], [np.zeros(0)]
    if _alone(found, variable):
        state, group, own = found.state, variable.group, variable.part.rows
        index, memory = group.block.indices[own], state.memory[found.system.groups.index(group)][own]

        def forces(force: Force | None, block: Block) -> Floats:
            return found.system.element_forces(Group(group.cls, block, []), state, memory)

        for unknown, slope in variable.differences(found.system, forces, linear=True):
            kept = unknown >= 0
            place = 3 * index[kept][:, :, None] + np.arange(3)
            rows.append(place.ravel())
            columns.append(np.repeat(unknown[kept], 3 * index.shape[1]))
            values.append(slope[kept].ravel())
    else:
        for number, slope in _together(found, variable):
            place = np.flatnonzero(slope)
            rows.append(place)
            columns.append(np.full(len(place), number))
            values.append(slope[place])
    return np.concatenate(rows), np.concatenate(columns), np.concatenate(values)


def work(found: Equilibrium, variable: Column, moved: Floats) -> Floats:
    """y . df/du of a column (unknowns,) for a motion y (n, 3) of the particles."""
    total = np.zeros(variable.entries.count)
    if not _alone(found, variable):
        for number, slope in _together(found, variable):
            total[number] = slope @ moved.ravel()
        return total
    state, cls = found.state, variable.group.cls
    memory = state.memory[found.system.groups.index(variable.group)][variable.part.rows]

    def powers(force: Force | None, block: Block) -> Floats:
        given = np.empty(len(memory))
        for first in range(0, len(memory), CHUNK):
            part = slice(first, first + CHUNK)
            some = block.some(part)
            forces = found.system.element_forces(Group(cls, some, []), state, memory[part])
            along = moved.take(some.indices.ravel(), axis=0).reshape(forces.shape)
            given[part] = np.einsum("eac,eac->e", forces, along)
        return given

    for unknown, slope in variable.differences(found.system, powers, linear=True):
        kept = unknown >= 0
        total += np.bincount(unknown[kept], slope[kept], len(total))
    return total


def _alone(found: Equilibrium, variable: Column) -> bool:
    """Whether the elements of a column's force do not feel one another, and are in one group."""
    system, state, group = found.system, found.state, variable.group
    several = sum(part.number == variable.number for other in system.groups for part in other.parts) > 1
    memory = state.memory[system.groups.index(group)]
    return not several and group.cls.gathered(group.block, memory, state.x, None) is None


def _together(found: Equilibrium, variable: Column) -> Iterator[tuple[int, Floats]]:
    """Derivatives (3n,) of all forces by one unknown at a time, where elements feel one another."""
    system, first = found.system, variable.force

    def forces(force: Force | None, block: Block) -> Floats:
        lead_forces(system, {variable.number: force})
        return system.evaluate(found.state)[0]

    for unknown in range(variable.entries.count):
        step = variable.step(unknown)
        change = np.where(variable.entries.tie == unknown, step, 0.0)
        yield unknown, variable.factor * variable.slope(system, change, forces).ravel() / step
    lead_forces(system, {variable.number: first})
