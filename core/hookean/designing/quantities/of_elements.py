"""What the elements of a force report: forces, lengths, force densities, load paths, and any column of a result."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar, Literal, Self

import numpy as np
from pydantic import StrictInt, StrictStr, model_validator

from hookean.designing.quantities.base import (
    NOTHING,
    Floats,
    Ints,
    Quantity,
    Slopes,
    combined,
    matrix,
    nothing,
    summed,
)
from hookean.designing.quantities.measured import Measured
from hookean.errors import InputError
from hookean.values.columns import Indices, fault
from hookean.values.fields import Field, Maybe

if TYPE_CHECKING:
    from hookean.designing.equilibrium import Equilibrium
    from hookean.designing.unknowns import Unknowns


class OfElements(Quantity):
    """Base of quantities of a force's elements. `equal`: minus the mean of all; `smooth`: minus the mean of those that
    meet them; `total`: the sum."""

    force: StrictStr | StrictInt = Field(description="Name or number of a force")
    elements: Maybe[Indices] = Field(default=None, description="Elements; default: all")
    equal: bool = Field(default=False, description="Values minus their mean, which are 0 if all are equal")
    smooth: bool = Field(default=False, description="Values minus the mean of those of elements that share a particle")
    total: bool = Field(default=False, description="The sum of the values")

    @model_validator(mode="after")
    def _one_way(self) -> Self:
        if self.equal + self.smooth + self.total > 1:
            raise fault("give at most one of equal, smooth, total")
        return self

    def _column(self, outputs: dict[str, str], pointer: str) -> str:
        """Which column of the result it is."""
        raise TypeError(f"{type(self).__name__} does not define a column")

    def values(self, found: Equilibrium, pointer: str) -> Floats:
        """The column."""
        whole = self._whole(found, pointer)
        rows = self._rows(whole, pointer)
        chosen = whole[rows]
        if self.total:
            return np.array([chosen.sum()])
        if self.smooth:
            return np.asarray(self._joints(found, rows, pointer) @ chosen)
        return np.asarray(chosen - chosen.mean() if self.equal and len(chosen) else chosen)

    @property
    def centred(self) -> bool:
        """Of `equal`."""
        return self.equal

    def differs_from(self, found: Equilibrium, pointer: str) -> float:
        """Of `equal` and `smooth` the largest value of the column."""
        if not (self.equal or self.smooth):
            return 0.0
        whole = self._whole(found, pointer)
        return float(np.abs(whole[self._rows(whole, pointer)]).max(initial=0.0))

    def slopes(self, found: Equilibrium, unknowns: Unknowns, pointer: str) -> Slopes:
        """By differences of what the force measures, with all elements changed at once."""
        by_place, by_unknown = self._whole_slopes(found, unknowns, pointer)
        rows = self._rows(np.zeros(by_place.shape[0]), pointer)
        by_place, by_unknown = by_place[rows], by_unknown[rows]
        if self.total:
            by_place, by_unknown = summed(by_place), summed(by_unknown)
        if self.smooth:
            joints = self._joints(found, rows, pointer)
            by_place, by_unknown = joints @ by_place, joints @ by_unknown
        return by_place, by_unknown

    def _joints(self, found: Equilibrium, rows: Ints, pointer: str) -> Any:
        """Weights (k, k): 1 for an element, -1 / count for those that share a particle with it."""
        from scipy.sparse import diags, identity

        index = Measured(found, self.force, pointer).index[rows]
        k, wide = index.shape
        at = matrix(np.repeat(np.arange(k), wide), index.ravel(), np.ones(index.size), (k, len(found.x)))
        near = (at @ at.T).tolil()
        near.setdiag(0.0)
        near = near.tocsr()
        near.eliminate_zeros()
        near.data[:] = 1.0
        count = np.diff(near.indptr)
        return (diags((count > 0).astype(float)) @ identity(k) - diags(1.0 / np.maximum(count, 1)) @ near).tocsr()

    def _rows(self, whole: Floats, pointer: str) -> Ints:
        if not len(whole) or (self.elements is not None and not len(self.elements)):
            raise InputError(pointer, NOTHING.format(kind=self.kind_name))
        if self.elements is None:
            return np.arange(len(whole))
        if self.elements.max() >= len(whole):
            said = f"element {int(self.elements.max())} does not exist; there are {len(whole)}, counted from 0"
            raise InputError(f"{pointer}/elements", said)
        return np.asarray(self.elements)

    def _whole(self, found: Equilibrium, pointer: str) -> Floats:
        """Values of all elements."""
        return Measured(found, self.force, pointer).column(self._column)

    def _whole_slopes(self, found: Equilibrium, unknowns: Unknowns, pointer: str) -> Slopes:
        """Derivatives of all elements."""
        return Measured(found, self.force, pointer).slopes(self._column, unknowns)


class Output(OfElements):
    """A column of what a result reports of a force's elements, such as strain."""

    kind: Literal["output"] = "output"
    column: str = Field(description="Which column of the result")

    def _column(self, outputs: dict[str, str], pointer: str) -> str:
        if self.column not in outputs:
            known = ", ".join(outputs) or "none"
            raise InputError(f"{pointer}/column", f"the result has no column {self.column!r} for it; it has {known}")
        return self.column


class Force(OfElements):
    """The force, or else the moment, in elements of a force (tension is positive)."""

    kind: Literal["force"] = "force"
    unit: ClassVar[str] = "force"

    def _column(self, outputs: dict[str, str], pointer: str) -> str:
        found = next((name for name in ("force", "moment") if name in outputs), "")
        if not found:
            raise InputError(f"{pointer}/force", f"its elements report no force; they report {', '.join(outputs)}")
        return found


class Length(OfElements):
    """Lengths of the elements of a force between two particles [length]."""

    kind: Literal["length"] = "length"
    unit: ClassVar[str] = "length"

    def _column(self, outputs: dict[str, str], pointer: str) -> str:
        return "length"

    @property
    def positive(self) -> Quantity | None:
        """Each length."""
        return None if self.equal or self.smooth else self.replaced(total=False)

    def _ends(self, found: Equilibrium, pointer: str) -> Ints:
        index = Measured(found, self.force, pointer).index
        if index.shape[1] != 2:
            raise InputError(f"{pointer}/force", f"its elements have {index.shape[1]} particles, not 2, and no length")
        return index

    def _whole(self, found: Equilibrium, pointer: str) -> Floats:
        index = self._ends(found, pointer)
        return np.asarray(np.linalg.norm(found.x[index[:, 1]] - found.x[index[:, 0]], axis=1))

    def _whole_slopes(self, found: Equilibrium, unknowns: Unknowns, pointer: str) -> Slopes:
        index = self._ends(found, pointer)
        along = found.x[index[:, 1]] - found.x[index[:, 0]]
        size = np.linalg.norm(along, axis=1)[:, None]
        along = np.divide(along, size, out=np.zeros_like(along), where=size > 0.0)
        rows = np.repeat(np.arange(len(index)), 6)
        columns = 3 * index[:, :, None] + np.arange(3)
        by_place = matrix(rows, columns, np.stack([-along, along], axis=1), (len(index), found.x.size))
        return by_place, nothing(len(index), unknowns.count)


class ForceDensity(OfElements):
    """Force by length of elements between two particles [force/length]."""

    kind: Literal["force_density"] = "force_density"
    unit: ClassVar[str] = "force/length"

    def _parts(self) -> tuple[Force, Length]:
        return Force(force=self.force), Length(force=self.force)

    def _whole(self, found: Equilibrium, pointer: str) -> Floats:
        force, length = (part._whole(found, pointer) for part in self._parts())
        return np.asarray(force / length)

    def _whole_slopes(self, found: Equilibrium, unknowns: Unknowns, pointer: str) -> Slopes:
        force, length = (part._whole(found, pointer) for part in self._parts())
        slopes = [part._whole_slopes(found, unknowns, pointer) for part in self._parts()]
        return combined(slopes, [1.0 / length, -force / length**2])


class LoadPath(OfElements):
    """The sum of |force| x length over elements between two particles [force length]."""

    kind: Literal["load_path"] = "load_path"
    total: bool = Field(default=True, description="The sum of the values")
    unit: ClassVar[str] = "force length"

    @property
    def positive(self) -> Quantity | None:
        """That of each element."""
        return None if self.equal or self.smooth else self.replaced(total=False)

    def _whole(self, found: Equilibrium, pointer: str) -> Floats:
        force, length = Force(force=self.force)._whole(found, pointer), Length(force=self.force)._whole(found, pointer)
        return np.asarray(np.abs(force) * length)

    def _whole_slopes(self, found: Equilibrium, unknowns: Unknowns, pointer: str) -> Slopes:
        parts = Force(force=self.force), Length(force=self.force)
        force, length = (part._whole(found, pointer) for part in parts)
        slopes = [part._whole_slopes(found, unknowns, pointer) for part in parts]
        return combined(slopes, [np.sign(force) * length, np.abs(force)])
