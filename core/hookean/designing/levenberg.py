"""Least squares of many unknowns and many goals with bounds: damped Gauss-Newton steps, cut at the bounds.

Unknowns at a bound that would leave it are held there; those that a step brings to one are put on it and the others'
step is worked out again. Damping falls while the linear model is right and rises where it is not.
Source: Kanzow, Yamashita and Fukushima, "Levenberg-Marquardt methods with strong local convergence properties for
solving nonlinear equations with convex constraints", 2004.
"""

from __future__ import annotations

from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from hookean.designing.answer import DesignStatus
from hookean.designing.linearised import Linearised

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]

START = 1e-3  # of the mean square slope: the first damping
LEAST, MOST = 1e-14, 1e16  # of it
BOLD, GENTLE = 0.01, 0.3  # falls of the damping: after steps that were right at once, and after others
PASSES = 4  # of one step, each with more unknowns held at bounds
ROUNDING = 1e-15  # of the targets: residuals below are nothing


class Squared(Protocol):
    """What is minimised: residuals by scaled unknowns, and their derivatives."""

    problem: Any
    unknowns: Any
    aims: Any

    @property
    def at(self) -> Any:
        """The equilibrium at scaled unknowns."""
        ...

    def residuals(self, y: Floats) -> Floats:
        """Residuals (k,)."""
        ...

    def linearised(self, y: Floats) -> Linearised:
        """Their derivatives."""
        ...


class Ended(NamedTuple):
    """Iterations, how a search ended, and the scaled unknowns there."""

    iterations: int
    status: DesignStatus
    y: Floats


def levenberg(search: Squared, lower: Floats, upper: Floats, start: Floats | None = None) -> Ended:
    """Search from zero or a start between bounds."""
    settings = search.problem.settings
    y = np.clip(np.zeros(search.unknowns.count) if start is None else start, lower, upper)
    r, factor, unit = search.residuals(y), 1.0, 0.0
    nothing = (settings.tolerance * 1e-2 * search.aims.size) ** 2
    for iteration in range(settings.max_iterations):
        cost = float(r @ r)
        if cost <= max(nothing, (ROUNDING * search.aims.size) ** 2):
            return Ended(iteration, DesignStatus.CONVERGED, y)
        model = search.linearised(y)
        slope = model.transposed(r)
        held = ((y <= lower) & (slope > 0.0)) | ((y >= upper) & (slope < 0.0)) | (lower >= upper)
        reach = float(np.abs(np.where(held, 0.0, slope)).max(initial=0.0))
        if not reach > ROUNDING * cost:
            return Ended(iteration, DesignStatus.CONVERGED, y)
        unit = unit or START * float(slope @ slope) / cost
        found, first = None, factor
        while found is None and factor <= MOST:
            found = _better(search, model, r, y, unit * factor, held, (lower, upper))
            if found is None:
                factor *= 10.0
        if found is None:
            return Ended(iteration, DesignStatus.CONVERGED, y)  # no step of any length leads further
        new, r_new, quality = found
        fall = BOLD if factor == first else GENTLE  # in a long valley each bold fall costs steps that are refused
        factor = max(factor * (fall if quality > 0.7 else GENTLE if quality > 0.25 else 2.0), LEAST)
        fell, moved = cost - float(r_new @ r_new), float(np.abs(new - y).max(initial=0.0))
        y, r = new, r_new
        if fell <= settings.tolerance * cost and quality > 0.25 and moved <= np.sqrt(settings.tolerance):
            return Ended(iteration + 1, DesignStatus.CONVERGED, y)
    return Ended(settings.max_iterations, DesignStatus.MAX_ITERATIONS, y)


def _better(
    search: Squared, model: Linearised, r: Floats, y: Floats, damping: float, held: Bools, bounds: tuple[Floats, Floats]
) -> tuple[Floats, Floats, float] | None:
    """A step that lowers the objective: new unknowns, residuals, and the fall by that of the linear model."""
    new = _cut_step(model, r, y, damping, held, bounds)
    if new is None or np.array_equal(new, y):
        return None
    now, cost = search.residuals(new), float(r @ r)
    slope = model.transposed(r)
    expected = -float(slope @ (new - y))  # at least half of the fall of the model along a step of Gauss and Newton
    fell = cost - float(now @ now)
    if not search.at(new).converged or not fell > 0.0:
        return None
    return new, now, fell / max(expected, np.finfo(float).tiny)


def _cut_step(
    model: Linearised, r: Floats, y: Floats, damping: float, held: Bools, bounds: tuple[Floats, Floats]
) -> Floats | None:
    lower, upper = bounds
    free, new = ~held, y
    shift = np.zeros(len(y))
    for _ in range(PASSES):
        step = model.step(r + model.forward(shift) if shift.any() else r, damping, free)
        if step is None:
            return None
        new = y + shift + step
        beyond = free & ((new < lower) | (new > upper))
        if not beyond.any():
            return new
        shift = np.where(beyond, np.clip(new, lower, upper) - y, shift)
        free = free & ~beyond
    return np.clip(new, lower, upper)
