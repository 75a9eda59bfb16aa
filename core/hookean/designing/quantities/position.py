"""Where particles are."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar, Literal

import numpy as np

from hookean.designing.quantities.base import (
    AXES,
    Axes,
    Floats,
    Ints,
    Quantity,
    Slopes,
    matrix,
    nothing,
    particle_places,
)
from hookean.values.columns import Indices
from hookean.values.fields import Field

if TYPE_CHECKING:
    from hookean.designing.equilibrium import Equilibrium
    from hookean.designing.unknowns import Unknowns


class Position(Quantity):
    """Coordinates of particles [length], a row of axes for each particle."""

    kind: Literal["position"] = "position"
    particles: Indices = Field(description="Particles")
    axes: Axes = Field(default="xyz", description="Which coordinates")
    unit: ClassVar[str] = "length"

    def _places(self, found: Equilibrium, pointer: str) -> Ints:
        return particle_places(found, self.particles, pointer)[:, [AXES[a] for a in self.axes]].ravel()

    def values(self, found: Equilibrium, pointer: str) -> Floats:
        """The coordinates."""
        return np.asarray(found.x.ravel()[self._places(found, pointer)])

    def slopes(self, found: Equilibrium, unknowns: Unknowns, pointer: str) -> Slopes:
        """Ones."""
        places = self._places(found, pointer)
        k = len(places)
        by_place = matrix(np.arange(k), places, np.ones(k), (k, found.x.size))
        return by_place, nothing(k, unknowns.count)
