"""Natural frequencies of the equilibrium."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, ClassVar, Literal

import numpy as np
from pydantic import NonNegativeInt

from hookean.designing.columns import Column
from hookean.designing.drawn import Mass
from hookean.designing.quantities.base import Floats, Quantity, Slopes, matrix
from hookean.errors import InputError
from hookean.system.group import Group
from hookean.values.fields import Field

if TYPE_CHECKING:
    from hookean.designing.equilibrium import Equilibrium
    from hookean.designing.unknowns import Unknowns

STEP = 3e-4  # of an element's size: the tangent's derivative by differences of fourth order, to 1e-12
WAYS = ((1.0, 2.0 / 3.0), (-1.0, -2.0 / 3.0), (2.0, -1.0 / 12.0), (-2.0, 1.0 / 12.0))  # steps, and their weights


class Frequency(Quantity):
    """A natural frequency of the shape with the masses of the scene [1/time]: K phi = (2 pi f)² M phi.

    Its derivative is phi . (dK - (2 pi f)² dM) phi / (8 pi² f), for phi . M phi = 1, where no other mode
    has the same frequency.
    Source: Fox and Kapoor, "Rates of change of eigenvalues and eigenvectors", 1968.
    """

    kind: Literal["frequency"] = "frequency"
    mode: NonNegativeInt = Field(default=0, description="Which one, from the lowest, counted from 0")
    unit: ClassVar[str] = "1/time"

    def values(self, found: Equilibrium, pointer: str) -> Floats:
        """The frequency, negative where the shape is unstable."""
        return np.array([self._mode(found, pointer)[0]])

    def slopes(self, found: Equilibrium, unknowns: Unknowns, pointer: str) -> Slopes:
        """By differences of each element's tangent."""
        frequency, motion = self._mode(found, pointer)
        by_place, by_unknown = np.zeros(found.x.shape), np.zeros(unknowns.count)
        for group, memory in zip(found.system.groups, found.state.memory, strict=True):
            if not group.cls.constant and len(group.block.indices):
                _add_moved(found, group, memory, motion, by_place)
        for variable, part in unknowns.parts:
            if isinstance(variable, Column) and not variable.group.cls.constant:
                by_unknown[part] += _by_column(found, variable, motion, part.stop - part.start)
            elif isinstance(variable, Mass):
                by_unknown[part] -= variable.by_masses(_swings(found, frequency, motion))
        size = 1.0 / (8.0 * np.pi**2 * abs(frequency)) if frequency else 0.0
        rows, columns = np.flatnonzero(by_place), np.flatnonzero(by_unknown)
        return (
            matrix(np.zeros_like(rows), rows, size * by_place.ravel()[rows], (1, found.x.size)),
            matrix(np.zeros_like(columns), columns, size * by_unknown[columns], (1, unknowns.count)),
        )

    def _mode(self, found: Equilibrium, pointer: str) -> tuple[float, Floats]:
        """The frequency, and the mode (n, 3) of modal mass 1."""
        from hookean.analysis.frequencies import lowest

        system = found.system
        together = any(
            group.cls.gathered(group.block, memory, found.x, None) is not None
            for group, memory in zip(system.groups, found.state.memory, strict=True)
        )
        if system.films is not None or together or found.resting.motions or not found.symmetric:
            said = (
                "soap films, elements that feel one another, forces without an energy and what rests on a floor have no"
            )
            said += " frequency goals"
            raise InputError(pointer, said)
        mass = system.mass[found.basis.indices // 3]
        if self.mode >= len(mass):
            raise InputError(f"{pointer}/mode", f"mode {self.mode} does not exist; there are {len(mass)} free axes")
        squares, vectors = lowest(found.reduced, mass, self.mode + 1)
        square = float(squares[self.mode])
        motion = found.basis @ (vectors[:, self.mode] / np.sqrt(mass))
        return np.sign(square) * np.sqrt(abs(square)) / (2.0 * np.pi), motion.reshape(-1, 3)


def _swings(found: Equilibrium, frequency: float, motion: Floats) -> Floats:
    """(2 pi f)^2 phi . phi (n,) of each particle, with its orientation: phi . dM phi by its mass."""
    slots, squares = found.system.slots, (motion**2).sum(axis=1)
    own = squares[: slots.count].copy()
    own[slots.particles] += squares[slots.first]
    return np.asarray(np.sign(frequency) * (2.0 * np.pi * frequency) ** 2 * own)


def _softness(found: Equilibrium, group: Group, memory: Floats, x: Floats, motion: Floats) -> Floats:
    """phi . K phi (m,) of each element, on private places (m, arity, 3)."""
    count, arity = group.block.indices.shape
    index = np.arange(count * arity, dtype=np.int64).reshape(count, arity)
    alone = Group(group.cls, replace(group.block, indices=index, plan=[]), [])
    blocks = found.system.stiffness_blocks(alone, replace(found.state, x=x.reshape(-1, 3)), memory)
    own = motion.reshape(count, -1)
    return np.asarray(np.einsum("mi,mij,mj->m", own, blocks, own))


def _add_moved(found: Equilibrium, group: Group, memory: Floats, motion: Floats, total: Floats) -> None:
    """Add the derivatives by places (n, 3)."""
    index = group.block.indices
    x, own = found.x[index], motion[index]
    reach = np.ptp(x, axis=1).max(axis=1)
    step = STEP * np.where(reach > 0.0, reach, 1.0)
    for corner in range(index.shape[1]):
        for axis in range(3):
            slope = np.zeros(len(index))
            for steps, weight in WAYS:
                moved = x.copy()
                moved[:, corner, axis] += steps * step
                slope += weight * _softness(found, group, memory, moved, own)
            np.add.at(total[:, axis], index[:, corner], slope / step)


def _by_column(found: Equilibrium, variable: Column, motion: Floats, count: int) -> Floats:
    """The derivatives by the unknowns of a column."""
    group, rows = variable.group, variable.part.rows
    memory = found.state.memory[found.system.groups.index(group)][rows]
    index, total = group.block.indices[rows], np.zeros(count)

    def give(_: Any, block: Any) -> Floats:
        return _softness(found, Group(group.cls, block, []), memory, found.x[index], motion[index])

    for unknown, slope in variable.differences(found.system, give):
        kept = unknown >= 0
        total += np.bincount(unknown[kept], slope[kept], count)
    return total
