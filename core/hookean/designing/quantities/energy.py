"""Energy in a force, or in all."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, ClassVar, Literal

import numpy as np
from pydantic import StrictInt, StrictStr

from hookean.compiled import dispatch
from hookean.designing.columns import Column
from hookean.designing.quantities.base import Floats, Quantity, Slopes, matrix
from hookean.designing.quantities.measured import Measured
from hookean.errors import InputError
from hookean.system.group import Group
from hookean.values.fields import Field

if TYPE_CHECKING:
    from hookean.designing.equilibrium import Equilibrium
    from hookean.designing.unknowns import Unknowns
    from hookean.forces.base import Block


class StrainEnergy(Quantity):
    """The energy stored in the elements of a force [force length]."""

    kind: Literal["strain_energy"] = "strain_energy"
    force: StrictStr | StrictInt = Field(description="Name or number of a force")
    unit: ClassVar[str] = "force length"

    def values(self, found: Equilibrium, pointer: str) -> Floats:
        """The sum over its elements."""
        own = self._own(found, pointer)
        return np.array([_energies(own, own.group.of(own.part)).sum()])

    def slopes(self, found: Equilibrium, unknowns: Unknowns, pointer: str) -> Slopes:
        """By places minus its forces; by its columns differences of each element's energy."""
        own = self._own(found, pointer)
        forces = found.system.element_forces(
            Group(own.group.cls, replace(own.group.of(own.part), plan=[]), []), found.state, own.memory
        )
        places = 3 * own.index[:, :, None] + np.arange(3)
        by_place = matrix(np.zeros(places.size, np.int64), places, -forces, (1, found.x.size))
        by_unknown = np.zeros(unknowns.count)

        def give(_: Any, block: Block) -> Floats:
            return _energies(own, block)

        for variable, part in unknowns.parts:
            if isinstance(variable, Column) and variable.number == own.number:
                for unknown, slope in variable.differences(found.system, give):
                    kept = unknown >= 0
                    by_unknown[part] += np.bincount(unknown[kept], slope[kept], part.stop - part.start)
        columns = np.flatnonzero(by_unknown)
        return by_place, matrix(np.zeros_like(columns), columns, by_unknown[columns], (1, unknowns.count))

    def _own(self, found: Equilibrium, pointer: str) -> Measured:
        own = Measured(found, self.force, pointer)
        gathered = own.group.cls.gathered(own.group.block, own.memory, found.x, None)
        if not own.group.cls.conservative or gathered is not None or own.group.block.rooms:
            said = f"{own.group.cls.kind_name} has no energy of single elements; give another force"
            raise InputError(f"{pointer}/force", said)
        return own


def _energies(own: Measured, block: Block) -> Floats:
    """The energy (m,) of each element, by the kernel of one after another."""
    kernel = dispatch.compiled(own.group.cls.kernel, "force")
    x = own.found.x[own.index]
    still, found = np.zeros(x.shape[1:]), np.zeros(len(x))
    index = np.arange(x.shape[1], dtype=np.int64)[None]
    for e in range(len(x)):
        f, w = np.zeros(still.shape), np.zeros(len(still))
        rows = slice(e, e + 1)
        found[e] = kernel(x[e], still, index, block.parameters[rows], own.memory[rows], f, w)
    return found
