"""Many unknowns and many constraints: the augmented Lagrangian, each part of it without a dense Jacobian.

What a constraint misses, moved by its multiplier, is one more goal: its range is the constraint's, shifted. With goals
that have targets the whole stays a problem of least squares, which Levenberg's and Marquardt's steps solve; else
L-BFGS-B does. Between parts the shifts are what is still missed, and weights rise where that falls slowly.
Source: Conn, Gould and Toint, "A globally convergent augmented Lagrangian algorithm for optimization with general
constraints and simple bounds", 1991.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from hookean.designing.answer import DesignStatus
from hookean.designing.levenberg import levenberg
from hookean.designing.limits import LIMIT
from hookean.designing.linearised import Linearised
from hookean.designing.sensitivity import gradients

if TYPE_CHECKING:
    from hookean.designing.equilibrium import Equilibrium
    from hookean.designing.search import Search
    from hookean.designing.unknowns import Unknowns

Floats = NDArray[np.float64]

PARTS = 30  # of a search
FIRST, RAISED = 10.0, 10.0  # weight of what is missed against the objective, and by how much it rises
SQUARED = 1e4  # the first of least squares, whose steps do not mind it
STEPS = 25  # of least squares in one part
FELL = 0.25  # part of what was missed before: more is slow
EXACT = 0.1 * LIMIT  # part of the size of values that may be missed at the end


class Augmented:
    """A search whose objective has the constraints in it; what `levenberg` asks for."""

    def __init__(self, search: Search) -> None:
        self.search, self.problem = search, search.problem
        self.unknowns: Unknowns = search.unknowns
        self.start = np.zeros(self.unknowns.count)
        self.low, self.high = (np.concatenate(side) for side in zip(*search.aims.limits, strict=True))
        by = zip(search.aims.limits, search.sizes, strict=True)
        self.sizes = np.concatenate([np.full(len(limits[0]), size) for limits, size in by])
        self.shift = np.zeros(len(self.low))
        first = SQUARED if all(goal.aimed for goal in search.problem.goals) else FIRST
        self.weight = first * (abs(search.objective(self.start)) or 1.0)

    @property
    def aims(self) -> Augmented:
        """Itself, for `size`."""
        return self

    @property
    def size(self) -> float:
        """What residuals are measured by."""
        return self.search.aims.size

    def at(self, y: Floats) -> Equilibrium:
        """The equilibrium at scaled unknowns."""
        return self.search.at(y)

    def missed(self, y: Floats) -> Floats:
        """What constraints miss at their shifted limits, by the size of their values (k,)."""
        values = np.concatenate(self.search.aims.constraint_values(self.at(y)))
        moved = values / self.sizes + self.shift
        return np.asarray(moved - np.clip(moved, self.low / self.sizes, self.high / self.sizes))

    def residuals(self, y: Floats) -> Floats:
        """Those of the goals, and what is missed, by the root of its weight."""
        return np.concatenate([self.search.residuals(y), np.sqrt(self.weight) * np.nan_to_num(self.missed(y))])

    def linearised(self, y: Floats) -> Linearised:
        """Their derivatives as sparse parts."""
        search, found = self.search, self.at(y)
        outside = np.sqrt(self.weight) / self.sizes * (self.missed(y) != 0.0)
        weights = np.concatenate([search.aims.weights(found), outside])
        quantities = [*search.aims.quantities(), *self._quantities()]
        return Linearised(found, self.unknowns, quantities, weights, search.scale, search.orders)

    def objective(self, y: Floats) -> float:
        """The goals' objective and the squares of what is missed."""
        value = self.search.objective(y)
        return value + self.weight * float((np.nan_to_num(self.missed(y)) ** 2).sum())

    def gradient(self, y: Floats) -> Floats:
        """Its derivatives by scaled unknowns."""
        whole, first, weights = 2.0 * self.weight * self.missed(y) / self.sizes, 0, []
        for limits in self.search.aims.limits:
            weights.append(whole[first : first + len(limits[0])])
            first += len(limits[0])
        found = gradients(self.at(y), self.unknowns, self._quantities(), weights) * self.search.scale
        return np.nan_to_num(self.search.gradient(y) + found)

    def _quantities(self) -> list[Any]:
        return [(c.quantity, f"/constraints/{i}") for i, c in enumerate(self.problem.constraints)]

    def update(self, y: Floats) -> None:
        """Shift the limits by what is still missed at them."""
        self.shift = self.missed(y)


def augmented(search: Search) -> tuple[int, DesignStatus]:
    """Search in parts, each from where the one before ended; iterations of all, and how it ended."""
    whole, before, iterations = Augmented(search), np.inf, 0
    aimed = all(goal.aimed for goal in search.problem.goals)
    most = search.problem.settings.max_iterations
    last = np.inf
    for _ in range(PARTS):
        steps, y = _by_squares(whole, most - iterations) if aimed else _by_slopes(whole, most - iterations)
        iterations += max(steps, 1)
        whole.start = y
        missed, value = search.missed(search.at(y)), search.objective(y)
        settled = abs(value - last) <= np.sqrt(search.problem.settings.tolerance) * abs(value) + 1e-15
        if missed <= EXACT and settled:
            return iterations, DesignStatus.CONVERGED
        if iterations >= most:
            return iterations, DesignStatus.MAX_ITERATIONS
        last = value
        whole.update(y)
        if missed > max(FELL * before, EXACT):
            whole.weight *= RAISED
            whole.shift /= RAISED
        before = missed
    return iterations, DesignStatus.STALLED


def _by_squares(whole: Augmented, most: int) -> tuple[int, Floats]:
    steps, _, y = levenberg(whole, *whole.search.bounds, whole.start, min(most, STEPS))
    return steps, y


def _by_slopes(whole: Augmented, most: int) -> tuple[int, Floats]:
    from scipy.optimize import minimize

    size = abs(whole.objective(whole.start)) or 1.0
    found = minimize(
        lambda y: whole.objective(y) / size, whole.start, jac=lambda y: whole.gradient(y) / size, method="L-BFGS-B",
        bounds=list(zip(*whole.search.bounds, strict=True)),
        options={"maxiter": max(most, 1), "maxcor": 30, "ftol": 1e-12, "gtol": 1e-9, "maxfun": 20 * max(most, 1)},
    )  # fmt: skip
    return int(found.nit), np.asarray(found.x)
