"""Linear buckling factors."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar, Literal

import numpy as np
from pydantic import NonNegativeInt, StrictStr

from hookean.designing.quantities.base import Floats, Quantity, Slopes, matrix, nothing
from hookean.errors import InputError
from hookean.system.system import compile
from hookean.values.fields import Field

if TYPE_CHECKING:
    from hookean.designing.equilibrium import Equilibrium
    from hookean.designing.unknowns import Unknowns

STEP = 1e-4  # of an unknown's size: differences of second order, to 1e-8
MOST = 1e6  # the factor of what does not buckle
UNKNOWNS = 100  # each takes two analyses more


class BucklingFactor(Quantity):
    """How many times its loads make the structure buckle [-], as `hookean.buckling` finds it in the shape without them;
    at most 1e6, which also stands for structures that do not buckle.

    Derivatives are differences of whole analyses, so at most 100 unknowns may vary.
    """

    kind: Literal["buckling_factor"] = "buckling_factor"
    mode: NonNegativeInt = Field(default=0, description="Which one, from the lowest, counted from 0")
    loads: tuple[StrictStr, ...] = Field(default=(), description="Names of the loads that grow; default: all")
    unit: ClassVar[str] = "-"

    def values(self, found: Equilibrium, pointer: str) -> Floats:
        """The factor."""
        from hookean.designing.equilibrium import as_held

        return np.array([self._factor(as_held(found.system.scene, found.system.held), pointer)])

    def slopes(self, found: Equilibrium, unknowns: Unknowns, pointer: str) -> Slopes:
        """Differences."""
        if unknowns.count > UNKNOWNS:
            said = f"{unknowns.count} unknowns vary; buckling factors allow {UNKNOWNS}: tie elements to groups"
            raise InputError(pointer, said)
        scene = unknowns.scene(found.system.scene)
        system = compile(scene)
        own = type(unknowns)(unknowns.problem.replaced(scene=scene), system)
        state, by = system.start(), np.zeros(unknowns.count)
        for i, step in enumerate(STEP * own.scale):
            ways = (-1.0, 1.0) if own.start[i] - step >= own.lower[i] else (0.0, 1.0)
            sides = []
            for way in ways:
                values = own.start.copy()
                values[i] += way * step
                own.put(system, state, values)
                sides.append(self._factor(own.scene(system.scene), pointer))
            by[i] = (sides[1] - sides[0]) / ((ways[1] - ways[0]) * step)
        columns = np.flatnonzero(by)
        by_unknown = matrix(np.zeros_like(columns), columns, by[columns], (1, unknowns.count))
        return nothing(1, found.x.size), by_unknown

    def _factor(self, scene: object, pointer: str) -> float:
        from hookean.analysis.buckling import buckling

        try:
            factors = buckling(scene, self.mode + 1, loads=self.loads or None).factors  # type: ignore[arg-type]
        except InputError as error:
            raise InputError(pointer, error.sentence) from None
        return min(float(factors[self.mode]), MOST) if len(factors) > self.mode else MOST
