"""Goals as residuals whose squares add up to the objective, also such that are minimised, where their values are sums
of parts that are at least 0: w v = (sqrt(w v))².

Steps of Gauss and Newton by roots know how parts trade places, which the slope of their sum does not. Roots are those
of v + e, with e a small part of the first values: they have a derivative at 0, and the objective is more by a constant.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hookean.designing.aims import Aims
from hookean.designing.equilibrium import Equilibrium
from hookean.designing.quantities.base import Quantity

Floats = NDArray[np.float64]

LITTLE = 1e-6  # e, in parts of the mean of the first values


class Roots:
    """The goals of a problem, each by residuals; `possible` unless one is minimised and has no such parts."""

    def __init__(self, aims: Aims, first: Equilibrium) -> None:
        self.aims, self._parts, self._little = aims, [], []
        self.possible = True
        for number, (goal, among) in enumerate(zip(aims.goals, aims.ranges, strict=True)):
            parts = goal.quantity if among is not None else goal.quantity.positive
            self.possible = self.possible and parts is not None
            self._parts.append((parts or goal.quantity, f"/goals/{number}"))
            mean = float(np.abs(self._parts[-1][0].values(first, f"/goals/{number}")).mean())
            self._little.append(LITTLE * (mean or 1.0))

    @property
    def quantities(self) -> list[tuple[Quantity, str]]:
        """What residuals are functions of, and their pointers."""
        return self._parts

    def residuals(self, found: Equilibrium) -> Floats:
        """sqrt(weight) (value - target), or sqrt(weight (value + e)) of parts of goals that are minimised."""
        return self._both(found)[0]

    def weights(self, found: Equilibrium) -> Floats:
        """The derivative (k,) of each residual by its value."""
        return self._both(found)[1]

    def _both(self, found: Equilibrium) -> tuple[Floats, Floats]:
        residuals, weights = [np.zeros(0)], [np.zeros(0)]
        rows = zip(self.aims.goals, self.aims.ranges, self._parts, self._little, strict=True)
        for goal, among, (quantity, pointer), little in rows:
            own, root = quantity.values(found, pointer), np.sqrt(goal.weight)
            if among is None:
                size = np.sqrt(np.maximum(own, 0.0) + little)
                residuals.append(root * size)
                weights.append(root / (2.0 * size))
                continue
            missed = own - np.clip(own, *among)
            residuals.append(root * missed)
            weights.append(np.where((missed == 0.0) & (among[0] < among[1]), 0.0, root))
        return np.concatenate(residuals), np.concatenate(weights)
