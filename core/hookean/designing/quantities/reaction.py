"""Forces of anchors on their particles."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar, Literal, Self

import numpy as np
from pydantic import StrictInt, StrictStr, model_validator

from hookean.designing.quantities.base import AXES, Axes, Floats, Ints, Quantity, Slopes, across, matrix
from hookean.errors import InputError
from hookean.running.patch import named
from hookean.values.columns import Direction, fault
from hookean.values.fields import Field, Maybe

if TYPE_CHECKING:
    from hookean.designing.equilibrium import Equilibrium
    from hookean.designing.unknowns import Unknowns


class Reaction(Quantity):
    """Forces of an anchor on its particles [force], along axes; `total`: their sums, `size`: their sizes.

    With a `direction` the two components across it: a target of 0 turns the forces along it. A horizontal thrust is
    `axes` "xy".
    """

    kind: Literal["reaction"] = "reaction"
    anchor: StrictStr | StrictInt = Field(description="Name or number of an anchor")
    axes: Axes = Field(default="xyz", description="Which components")
    total: bool = Field(default=False, description="The sum over the particles")
    size: bool = Field(default=False, description="Sizes of the forces along the axes, in the place of components")
    direction: Maybe[Direction] = Field(default=None, description="Components across this direction instead [-]")
    unit: ClassVar[str] = "force"

    @model_validator(mode="after")
    def _one_way(self) -> Self:
        if self.direction is not None and (self.size or self.axes != "xyz"):
            raise fault("a direction takes all three axes, and no size")
        return self

    def _parts(self, found: Equilibrium, pointer: str) -> tuple[Ints, Floats]:
        """Places (k, axes) among all coordinates, and the forces there."""
        held = named(found.system.held, self.anchor, f"{pointer}/anchor")
        axes = [AXES[a] for a in self.axes if held.free[AXES[a]] == 0.0]
        if len(axes) < len(self.axes):
            raise InputError(f"{pointer}/axes", "the anchor does not hold its particles along all of these axes")
        forces = -found.system.evaluate(found.state)[0]
        return 3 * held.particles[:, None] + np.array(axes), forces[held.particles][:, axes]

    def values(self, found: Equilibrium, pointer: str) -> Floats:
        """The forces."""
        _, forces = self._parts(found, pointer)
        forces = forces.sum(axis=0, keepdims=True) if self.total else forces
        if self.direction is not None:
            forces = forces @ across(self.direction).T
        return np.asarray(np.linalg.norm(forces, axis=1) if self.size else forces.ravel())

    def slopes(self, found: Equilibrium, unknowns: Unknowns, pointer: str) -> Slopes:
        """From the tangent stiffness and the forces' own derivatives: a reaction is what is out of balance."""
        places, forces = self._parts(found, pointer)
        k, wide = places.shape
        by_place = found.tangent.tocsr()[places.ravel()]
        by_unknown = -unknowns.slopes(found)[0].tocsr()[places.ravel()]
        if self.total:
            sums = matrix(np.tile(np.arange(wide), k), np.arange(k * wide), np.ones(k * wide), (wide, k * wide))
            by_place, by_unknown, forces, k = sums @ by_place, sums @ by_unknown, forces.sum(axis=0, keepdims=True), 1
        if self.size:
            sizes = np.linalg.norm(forces, axis=1)[:, None]
            along = np.divide(forces, sizes, out=np.zeros_like(forces), where=sizes > 0.0)
            turn = matrix(np.repeat(np.arange(k), wide), np.arange(k * wide), along, (k, k * wide))
            by_place, by_unknown = turn @ by_place, turn @ by_unknown
        if self.direction is not None:
            from scipy.sparse import identity, kron

            turn = kron(identity(k), across(self.direction)).tocsr()
            by_place, by_unknown = turn @ by_place, turn @ by_unknown
        return by_place, by_unknown
