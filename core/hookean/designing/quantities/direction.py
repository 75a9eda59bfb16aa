"""Directions of elements between two particles."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar, Literal

import numpy as np
from pydantic import StrictInt, StrictStr

from hookean.designing.quantities.base import AXES, Axes, Floats, Ints, Quantity, Slopes, matrix, nothing
from hookean.designing.quantities.measured import Measured
from hookean.errors import InputError
from hookean.values.columns import Indices
from hookean.values.fields import Field, Maybe

if TYPE_CHECKING:
    from hookean.designing.equilibrium import Equilibrium
    from hookean.designing.unknowns import Unknowns


class Direction(Quantity):
    """Unit vectors from the first particle of each element of a force to its second, an element after the other [-]."""

    kind: Literal["direction"] = "direction"
    force: StrictStr | StrictInt = Field(description="Name or number of a force of elements between two particles")
    elements: Maybe[Indices] = Field(default=None, description="Elements; default: all")
    axes: Axes = Field(default="xyz", description="Which components")
    unit: ClassVar[str] = "-"

    def values(self, found: Equilibrium, pointer: str) -> Floats:
        """(b - a) / |b - a|."""
        unit, _ = _along(found, self._ends(found, pointer))
        return np.asarray(unit[:, [AXES[a] for a in self.axes]].ravel())

    def slopes(self, found: Equilibrium, unknowns: Unknowns, pointer: str) -> Slopes:
        """(I - u u^T) / |b - a|."""
        ends, axes = self._ends(found, pointer), [AXES[a] for a in self.axes]
        unit, size = _along(found, ends)
        by = ((np.eye(3) - unit[:, :, None] * unit[:, None, :]) / size[:, None])[:, axes]
        k = by.shape[0] * len(axes)
        columns = np.repeat(3 * ends[:, None, :, None] + np.arange(3), len(axes), axis=1)
        shape = (k, found.x.size)
        by_place = matrix(np.repeat(np.arange(k), 6), columns, np.stack([-by, by], axis=2), shape)
        return by_place, nothing(k, unknowns.count)

    def _ends(self, found: Equilibrium, pointer: str) -> Ints:
        index = Measured(found, self.force, pointer).index
        if index.shape[1] != 2:
            said = f"its elements have {index.shape[1]} particles, not 2, and no direction"
            raise InputError(f"{pointer}/force", said)
        if self.elements is None:
            return np.asarray(index)
        if len(self.elements) and self.elements.max() >= len(index):
            said = f"element {int(self.elements.max())} does not exist; there are {len(index)}, counted from 0"
            raise InputError(f"{pointer}/elements", said)
        return np.asarray(index[self.elements])


def _along(found: Equilibrium, ends: Ints) -> tuple[Floats, Floats]:
    along = found.x[ends[:, 1]] - found.x[ends[:, 0]]
    size = np.maximum(np.linalg.norm(along, axis=1)[:, None], np.finfo(float).tiny)
    return along / size, size
