"""What a force's elements report at an equilibrium, and its derivatives, with all elements changed at once."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from hookean.designing.columns import Column, numbered, placed
from hookean.designing.quantities.base import Floats, matrix, nothing
from hookean.errors import InputError
from hookean.system.group import Group
from hookean.system.system import System

if TYPE_CHECKING:
    from hookean.designing.equilibrium import Equilibrium
    from hookean.designing.quantities.base import Slopes
    from hookean.designing.unknowns import Unknowns
    from hookean.forces.base import Block


class Measured:
    """What a force's elements report at an equilibrium, and its derivatives by differences."""

    def __init__(self, found: Equilibrium, force: Any, pointer: str) -> None:
        self.found, self.pointer = found, pointer
        system: System = found.system
        self.number = numbered(system.scene, force, f"{pointer}/force")
        self.group, self.part = placed(system, self.number, f"{pointer}/force")
        self.memory = found.state.memory[system.groups.index(self.group)][self.part.rows]
        self.index = self.group.block.indices[self.part.rows]

    def column(self, choose: Any) -> Floats:
        """The values (m,) of the column that `choose` names."""
        return self._values(self.group.of(self.part), self._chosen(choose))

    def _chosen(self, choose: Any) -> str:
        return str(choose(self.group.cls.outputs, self.pointer))

    def _values(self, block: Block, column: str, x: Floats | None = None, force: Any = None) -> Floats:
        system, state = self.found.system, self.found.state
        state = state if x is None else replace(state, x=x)
        own = replace(block, memory=self.memory, plan=[])
        forces = system.element_forces(Group(self.group.cls, own, []), state, self.memory)
        found = np.asarray((force or self.part.force).measure(own, state.x, forces)[column])
        if found.ndim != 1:
            raise InputError(self.pointer, f"{column} of {self.group.cls.kind_name} is a vector; goals need numbers")
        return found

    def slopes(self, choose: Any, unknowns: Unknowns) -> Slopes:
        """Derivatives of the column."""
        column, (m, arity) = self._chosen(choose), self.index.shape
        group, memory = self.group, self.found.state.memory[self.found.system.groups.index(self.group)]
        if group.cls.gathered(group.block, memory, self.found.x, None) is not None:
            said = f"elements of {group.cls.kind_name} feel one another; {column} cannot be a goal"
            raise InputError(f"{self.pointer}/force", said)
        private = self.found.x[self.index].reshape(-1, 3)
        alone = replace(group.of(self.part), indices=np.arange(m * arity, dtype=np.int64).reshape(m, arity), plan=[])
        reach = np.ptp(self.found.x[self.index], axis=1).max(axis=1) if m else np.zeros(0)
        steps = 1e-6 * np.where(reach > 0.0, reach, 1.0)
        by_corner = np.zeros((m, arity, 3))
        for corner in range(arity):
            for axis in range(3):
                sides = []
                for sign in (1.0, -1.0):
                    moved = private.copy()
                    moved[corner::arity, axis] += sign * steps
                    sides.append(self._values(alone, column, moved))
                by_corner[:, corner, axis] = (sides[0] - sides[1]) / (2.0 * steps)
        places = 3 * self.index[:, :, None] + np.arange(3)
        rows = np.repeat(np.arange(m), 3 * arity)
        by_place = matrix(rows, places, by_corner, (m, self.found.x.size))
        by_unknown = nothing(m, unknowns.count)
        for variable, part in unknowns.parts:
            if isinstance(variable, Column) and variable.number == self.number:
                by_unknown = by_unknown + self._by_column(variable, column, part.start, unknowns.count)
        return by_place, by_unknown

    def _by_column(self, variable: Column, column: str, first: int, count: int) -> Any:
        """Derivatives (m, u) by a column of the force itself."""
        total = nothing(len(self.index), count)
        give = lambda force, block: self._values(block, column, force=force)  # noqa: E731
        for unknown, slope in variable.differences(self.found.system, give):
            rows = np.flatnonzero(unknown >= 0)
            total = total + matrix(rows, unknown[rows] + first, slope[rows], total.shape)
        return total
