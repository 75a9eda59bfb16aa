"""The methods of a search, from SciPy: least squares by trust regions, L-BFGS-B, sequential quadratic programming."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from hookean.designing.answer import DesignStatus
from hookean.designing.augmented import augmented
from hookean.designing.feasible import nearer, off_zero
from hookean.designing.gains import at_minimum, is_steep
from hookean.designing.levenberg import levenberg
from hookean.designing.limits import AT_BOUND
from hookean.designing.polish import polish
from hookean.designing.sensitivity import jacobian

if TYPE_CHECKING:
    from hookean.designing.search import Search

Floats = NDArray[np.float64]

NO_STEP = "The search found no step that leads further; this is the best so far."
WANDERS = 100  # iterations of SLSQP, after which it makes no headway
MET = 1e-18  # part of the first objective, residuals 1e-9 of the first: goals are met
SLOW = 30  # evaluations of least squares, after which second derivatives are asked for
ATTEMPTS = 4  # of a search with constraints, each from the best so far
FLAT = 1e-30  # slopes of small weights or units are small: only none at all ends a search
ROUNDING = 1e-13  # part of the objective: less is no change


class Stopped(Exception):
    """The caller ended the search."""


class Unbounded(Exception):
    """The objective falls, or the shape grows, without end; the text is a sentence without its full stop."""


Ended = tuple[int, DesignStatus, str]
"""Iterations, how it ended, and a sentence where there is more to say."""


def _least_squares(search: Search) -> Ended:
    settings, (lower, upper) = search.problem.settings, search.bounds
    wide = lower < upper
    if not wide.all():  # what cannot vary is left out
        upper = np.where(wide, upper, lower + AT_BOUND)
    start = np.clip(np.zeros(search.unknowns.count), lower, upper)
    least = max(search.met, 0.0)
    size, taken = max(float(np.linalg.norm(search.residuals(start))), np.sqrt(least)) or 1.0, 0
    wanted, tight = (max(part * settings.tolerance, ROUNDING) for part in (1.0, 1e-3))
    for ftol, most in ((wanted, SLOW), (wanted, SLOW), (tight, settings.max_iterations)):
        most = min(most, settings.max_iterations - taken)
        used, status = _trust_region(search, start, (lower, upper), size, most, ftol)
        taken += used
        if status == 0 and taken >= settings.max_iterations:
            return taken, DesignStatus.MAX_ITERATIONS, ""
        if search.best[1] <= max(MET * search.first_value, least):
            return taken, DesignStatus.CONVERGED, ""
        polish(search)  # where goals conflict, steps by first derivatives alone lead on slowly
        if status == 0 and not at_minimum(search):
            break
        start = np.clip(search.best[2], lower, upper)
    if at_minimum(search):
        return taken, DesignStatus.CONVERGED, ""
    return _lbfgsb(search, taken)  # learns how much goals conflict, of which derivatives of residuals know nothing


def _trust_region(
    search: Search, start: Floats, bounds: tuple[Floats, Floats], size: float, most: int, ftol: float
) -> tuple[int, int]:
    """One run of SciPy's method: the evaluations that it took, and its status, 0 where these are the `most`."""
    from scipy.optimize import least_squares

    settings, (lower, upper) = search.problem.settings, bounds
    off = off_zero(start, lower, upper)
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "Setting `gtol`")
        found = least_squares(
            lambda z: search.residuals(z - off) / size, start + off, lambda z: search.slopes(z - off) / size,
            bounds=(lower + off, upper + off), method="trf",
            ftol=ftol, xtol=max(settings.tolerance, ROUNDING), gtol=FLAT,
            max_nfev=max(most, 1),
        )  # fmt: skip
    return int(found.njev if found.status else found.nfev), int(found.status)


def _levenberg_marquardt(search: Search) -> Ended:
    return *levenberg(search, *search.bounds)[:2], ""


def _augmented(search: Search, taken: int = 0) -> Ended:
    search.used = "augmented_lagrangian"
    iterations, ended = augmented(search, taken)
    if ended is DesignStatus.STALLED and at_minimum(search):
        ended = DesignStatus.CONVERGED
    elif ended is DesignStatus.CONVERGED and is_steep(search):  # of a round, whose own end may be none
        ended = DesignStatus.STALLED
    return iterations, ended, NO_STEP if ended is DesignStatus.STALLED else ""


def _lbfgsb(search: Search, taken: int = 0) -> Ended:
    """Again from the best so far where it ends at no minimum: one poor step is enough for that."""
    from scipy.optimize import minimize

    search.used = "l-bfgs-b"
    settings, start, before = search.problem.settings, search.best[2], np.inf
    size = abs(search.objective(start)) or 1.0
    while True:
        found = minimize(
            lambda y: search.objective(y) / size, start, jac=lambda y: search.gradient(y) / size, method="L-BFGS-B",
            bounds=list(zip(*search.edges, strict=True)),
            options={"maxiter": settings.max_iterations - taken, "ftol": settings.tolerance * 1e-3, "gtol": 1e-12,
                     "maxcor": 30, "maxfun": 20 * settings.max_iterations},
        )  # fmt: skip
        taken, (_, value, start) = taken + int(found.nit), search.best
        search.check_end()
        if taken >= settings.max_iterations and not at_minimum(search):
            return taken, DesignStatus.MAX_ITERATIONS, ""
        if at_minimum(search):
            return taken, DesignStatus.CONVERGED, ""
        if not before - value > settings.tolerance * abs(value):
            polish(search)  # near shapes that hardly resist, its line searches lead too far
            if at_minimum(search):
                return taken, DesignStatus.CONVERGED, ""
            if not value - search.best[1] > settings.tolerance * abs(value):
                return taken, DesignStatus.STALLED, NO_STEP
            value, start = search.best[1:]
        before = value


class Margins:
    """Constraints as functions that SLSQP wants at least 0, or 0, in parts of the size of each value."""

    def __init__(self, search: Search) -> None:
        self.search = search
        lower, upper = (np.concatenate(side) for side in zip(*search.aims.limits, strict=True))
        first = search.aims.constraint_values(search.first)
        size = np.concatenate([np.full(len(v), by) for v, by in zip(first, search.sizes, strict=True)])
        equal = lower == upper
        low, high = np.flatnonzero(np.isfinite(lower)), np.flatnonzero(np.isfinite(upper) & ~equal)
        self.rows = np.concatenate([low, high])
        self.limits = np.concatenate([lower[low], upper[high]])
        self.scales = np.concatenate([1.0 / size[low], -1.0 / size[high]])
        self.equal = equal[self.rows]
        start = np.zeros(search.unknowns.count)
        kept = self.slopes(start).any(axis=1) | (self.values(start) < 0.0)  # the others no unknown changes
        self.rows, self.limits, self.scales, self.equal = (
            each[kept] for each in (self.rows, self.limits, self.scales, self.equal)
        )

    def values(self, y: Floats) -> Floats:
        """How far values are within their limits."""
        values = np.concatenate(self.search.aims.constraint_values(self.search.at(y)))
        return np.asarray(self.scales * (values[self.rows] - self.limits))

    def slopes(self, y: Floats) -> Floats:
        """Their derivatives by scaled unknowns."""
        search = self.search
        quantities = [(c.quantity, f"/constraints/{i}") for i, c in enumerate(search.problem.constraints)]
        found = jacobian(search.at(y), search.unknowns, quantities) * search.scale
        return np.asarray(np.nan_to_num(self.scales[:, None] * found[self.rows]))

    def given(self) -> list[dict[str, Any]]:
        """As SciPy takes them."""
        kinds = [("eq", self.equal), ("ineq", ~self.equal)]
        return [
            {"type": kind, "fun": lambda y, c=chosen: self.values(y)[c], "jac": lambda y, c=chosen: self.slopes(y)[c]}
            for kind, chosen in kinds
            if chosen.any()
        ]


def _slsqp(search: Search) -> Ended:
    from scipy.optimize import minimize

    settings, start, iterations = search.problem.settings, np.zeros(search.unknowns.count), 0
    bounds = list(zip(*search.edges, strict=True))
    before = np.inf
    for _ in range(ATTEMPTS):
        size = abs(search.objective(start)) or 1.0
        found = minimize(
            lambda y, size=size: search.objective(y) / size, start,
            jac=lambda y, size=size: search.gradient(y) / size, method="SLSQP", bounds=bounds,
            constraints=Margins(search).given() if search.aims.limits else [],
            options={"maxiter": min(settings.max_iterations - iterations, WANDERS + 1),
                     "ftol": max(settings.tolerance * 1e-3, ROUNDING)},
        )  # fmt: skip
        iterations += int(found.nit)
        if iterations >= settings.max_iterations:
            return iterations, DesignStatus.MAX_ITERATIONS, ""
        if found.nit > WANDERS and not at_minimum(search):
            polish(search)
            break
        if search.best[0] > 0.0:
            iterations += nearer(search)
            if search.best[0] > 0.0:
                return iterations, DesignStatus.INFEASIBLE, ""
        elif found.status == 0:
            if least := at_minimum(search):
                search.rest_at(found.x)
            if least or not before - search.best[1] > settings.tolerance * size:
                ended = search.best[1]
                polish(search)  # which may lead on along a valley, to where limits do not hold yet
                if not (least and ended - search.best[1] > settings.tolerance * abs(ended)):
                    break
        before, start = search.best[1], search.best[2].copy()  # what it measures by was the objective at its start
    if at_minimum(search):
        return iterations, DesignStatus.CONVERGED, ""
    return _augmented(search, iterations) if search.aims.limits else _lbfgsb(search, iterations)


METHODS: dict[str, Callable[[Search], Ended]] = {
    "least_squares": _least_squares,
    "levenberg_marquardt": _levenberg_marquardt,
    "l-bfgs-b": _lbfgsb,
    "slsqp": _slsqp,
    "augmented_lagrangian": _augmented,
}
