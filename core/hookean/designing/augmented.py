"""Many constraints: an augmented Lagrangian, which adds to the objective what constraints miss, and estimates their
multipliers from it.

With values c of constraints in parts of their size and d(c) what they miss of their limits, each round minimises
f + m/2 |d(c + l / m)|² between bounds, then l = m d(c + l / m). Where all goals have targets, or are sums of parts that
are at least 0, that is a sum of squares, solved by Levenberg and Marquardt's sparse steps; else by L-BFGS-B, with one
adjoint solve for goals and constraints together. m rises where a round has not brought constraints nearer.
Source: Nocedal and Wright, Numerical Optimization, 2006, chapter 17; Birgin and Martinez, 2014.
"""

from __future__ import annotations

from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from hookean.designing.answer import DesignStatus
from hookean.designing.feasible import nearer
from hookean.designing.levenberg import levenberg
from hookean.designing.limits import LIMIT
from hookean.designing.linearised import Linearised
from hookean.designing.roots import Roots
from hookean.designing.sensitivity import gradients

if TYPE_CHECKING:
    from hookean.designing.equilibrium import Equilibrium
    from hookean.designing.search import Search

Floats = NDArray[np.float64]

FIRST, MOST = 10.0, 1e9  # the first penalty m, and the largest
RISE, NEARER = 10.0, 0.25  # of the penalty, and the part of what was missed that a round has to come down to
HARDLY, HEAVY, STUCK = 0.9, 1e3, 2  # rounds that leave more of what is missed, from this penalty on, end the search
ROUNDS = 40
INNER = 300  # steps of one round
MET = 0.1 * LIMIT  # what may be missed at the end
FAR = 1e3  # times what residuals are: those where there is no equilibrium
SETTLED = 1e-2  # part of the multipliers by which they change at the end


class Penalised:
    """The objective of a round: what methods for bounds ask a search for."""

    def __init__(self, search: Search, size: float) -> None:
        self.search, self.size, self.penalty = search, size, FIRST
        self.low, self.high = (np.concatenate(side) for side in zip(*search.aims.limits, strict=True))
        parts = zip(search.aims.limits, search.sizes, strict=True)
        self.sizes = np.concatenate([np.full(len(limit[0]), by) for limit, by in parts])
        self.multipliers = np.zeros(len(self.low))
        self.unknowns, self.at = search.unknowns, search.at
        self.quantities = [(c.quantity, f"/constraints/{i}") for i, c in enumerate(search.problem.constraints)]
        self.aims = SimpleNamespace(size=search.aims.size / np.sqrt(size))
        self.problem: Any = search.problem
        self.roots = Roots(search.aims, search.first)

    def _own(self, found: Equilibrium) -> Floats:
        return np.concatenate(self.search.aims.constraint_values(found))

    def _beyond(self, found: Equilibrium, share: float) -> Floats:
        """By how much the values, moved by a share of the multipliers, miss their limits [-]."""
        own = self._own(found) + share * self.multipliers / self.penalty * self.sizes
        return np.asarray((own - np.clip(own, self.low, self.high)) / self.sizes)

    def missed(self, y: Floats) -> float:
        """The most by which a constraint is missed, or is off its limit although it has a multiplier."""
        shifted = self._beyond(self.at(y), 1.0) - self.multipliers / self.penalty
        return float(np.abs(shifted).max(initial=0.0))

    def take_up(self, y: Floats) -> float:
        """The multipliers of the round's end; by how much they have changed, in parts of the largest."""
        new = self.penalty * self._beyond(self.at(y), 1.0)
        changed = float(np.abs(new - self.multipliers).max(initial=0.0))
        self.multipliers = new
        return changed / max(float(np.abs(new).max(initial=0.0)), 1e-3)

    def objective(self, y: Floats) -> float:
        """f + m/2 |d|², in parts of the size of f; where there is no equilibrium more than any so far."""
        value, found = self.search.objective(y) / self.size, self.at(y)
        penalty = 0.5 * self.penalty * float((self._beyond(found, 1.0) ** 2).sum()) if found.converged else 0.0
        return value + penalty if np.isfinite(penalty) else 1e30

    def gradient(self, y: Floats) -> Floats:
        """Its derivatives by scaled unknowns, by one solve."""
        search, found = self.search, self.at(y)
        pushed = self.penalty * self._beyond(found, 1.0) / self.sizes
        ends = np.cumsum([len(limit[0]) for limit in search.aims.limits])[:-1]
        weights = [by / self.size for by in search.aims.slopes(found)] + np.split(pushed, ends)
        goals = [(g.quantity, f"/goals/{i}") for i, g in enumerate(search.problem.goals)]
        found_by = gradients(found, search.unknowns, goals + self.quantities, weights)
        return np.nan_to_num(found_by * search.scale)

    def residuals(self, y: Floats) -> Floats:
        """The same as residuals whose squares are summed, where goals have roots."""
        found = self.at(y)
        self.search.note(y)
        goals = self.roots.residuals(found)
        if not (found.converged and np.isfinite(goals).all()):
            goals = np.full(len(goals), FAR * (1.0 + np.sqrt(abs(self.search.best[1]))))
        missed = np.sqrt(0.5 * self.penalty) * self._beyond(found, 1.0)
        far = FAR * (1.0 + float(np.abs(goals).max(initial=0.0)))
        missed = missed if found.converged and np.isfinite(missed).all() else np.full(len(missed), far)
        return np.concatenate([goals / np.sqrt(self.size), missed])

    def linearised(self, y: Floats) -> Linearised:
        """Their derivatives, as sparse parts."""
        search, found = self.search, self.at(y)
        pushed = np.where(self._beyond(found, 1.0) != 0.0, np.sqrt(0.5 * self.penalty) / self.sizes, 0.0)
        weights = np.concatenate([self.roots.weights(found) / np.sqrt(self.size), pushed])
        parts = self.roots.quantities + self.quantities
        return Linearised(found, search.unknowns, parts, weights, search.scale, search.orders)


def augmented(search: Search, taken: int = 0) -> tuple[int, DesignStatus]:
    """Search from the best so far; iterations, which are rounds, with those `taken` before, and how it ended."""
    settings = search.problem.settings
    y = np.clip(search.best[2], *search.edges)
    round_ = Penalised(search, abs(search.objective(y)) or 1.0)
    before, tolerance, stuck = np.inf, max(1e-4, settings.tolerance), 0
    for _ in range(ROUNDS):
        if taken >= settings.max_iterations:
            return taken, DesignStatus.MAX_ITERATIONS
        own = settings.replaced(tolerance=tolerance, max_iterations=INNER)
        round_.problem = search.problem.replaced(settings=own)
        y = (_squares if round_.roots.possible else _smooth)(round_, y)
        taken += 1
        search.check_end()
        missed = round_.missed(y)
        changed = round_.take_up(y)
        if missed <= MET and changed <= SETTLED and tolerance <= settings.tolerance:
            return taken, DesignStatus.CONVERGED
        if missed > max(NEARER * before, MET):
            if round_.penalty >= MOST:
                break
            round_.penalty *= RISE
        stuck = stuck + 1 if missed > HARDLY * before and round_.penalty > HEAVY else 0
        if stuck >= STUCK:
            break
        before, tolerance = missed, max(0.1 * tolerance, settings.tolerance)
    if search.best[0] > 0.0:
        taken += nearer(search)
    return taken, DesignStatus.INFEASIBLE if search.best[0] > 0.0 else DesignStatus.STALLED


def _squares(round_: Penalised, y: Floats) -> Floats:
    """The end of a round by least squares."""
    return levenberg(round_, *round_.search.edges, start=y).y


def _smooth(round_: Penalised, y: Floats) -> Floats:
    """The same by L-BFGS-B."""
    from scipy.optimize import minimize

    most, tolerance = round_.problem.settings.max_iterations, round_.problem.settings.tolerance
    found = minimize(
        round_.objective, y, jac=round_.gradient, method="L-BFGS-B",
        bounds=list(zip(*round_.search.edges, strict=True)),
        options={"maxiter": most, "ftol": 1e-3 * tolerance, "gtol": 1e-2 * tolerance, "maxcor": 30,
                 "maxfun": 20 * most},
    )  # fmt: skip
    return np.asarray(found.x)
