"""Least squares of many unknowns and many goals with bounds: damped Gauss-Newton steps, cut at the bounds.

Unknowns at a bound that would leave it are held there; those that a step brings to one are put on it and the others'
step is worked out again. Damping falls while the linear model is right and rises where it is not; it is that of changes
in parts of the unknowns, so that one which grows without end gets there by factors.
Source: Kanzow, Yamashita and Fukushima, "Levenberg-Marquardt methods with strong local convergence properties for
solving nonlinear equations with convex constraints", 2004; Moré, "The Levenberg-Marquardt algorithm", 1978 (sizes, and
the fall that the model expects).
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
REFUSED = 4.0  # rise of the damping after a step that leads nowhere
FALLS = ((0.95, 0.003), (0.8, 0.2), (0.5, 0.6), (0.25, 1.0))  # of it, where more than this part of a fall came
RISE = 2.0  # of it where less does
TRUE = 0.25  # part of what is expected: the linear model holds
SLOW = 2  # steps one after another that lower the objective by no more than the tolerance
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
    r, factor, unit, slow = search.residuals(y), 1.0, 0.0, 0
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
        from_here, found = From(model, r, slope, y, held, (lower, upper)), None
        while found is None and factor <= MOST:
            found = _better(search, from_here, unit * factor)
            if found is None:
                factor *= REFUSED
        if found is None:
            return Ended(iteration, DesignStatus.CONVERGED, y)  # no step of any length leads further
        new, r_new, came = found
        factor = max(factor * next((fall for least, fall in FALLS if came > least), RISE), LEAST)
        fell, moved = cost - float(r_new @ r_new), float(np.abs(new - y).max(initial=0.0))
        y, r = new, r_new
        slow = slow + 1 if fell <= settings.tolerance * cost and came > TRUE else 0
        if slow >= SLOW or (slow and moved <= np.sqrt(settings.tolerance)):
            return Ended(iteration + 1, DesignStatus.CONVERGED, y)
    return Ended(settings.max_iterations, DesignStatus.MAX_ITERATIONS, y)


class From(NamedTuple):
    """Where a step begins: derivatives, residuals, their slope, unknowns, those that are held, and bounds."""

    model: Linearised
    r: Floats
    slope: Floats
    y: Floats
    held: Bools
    bounds: tuple[Floats, Floats]

    @property
    def sizes(self) -> Floats:
        """Sizes (u,) of the unknowns, at least their scale."""
        return np.maximum(1.0, np.abs(self.y))


def _better(search: Squared, at: From, damping: float) -> tuple[Floats, Floats, float] | None:
    """A step that lowers the objective: new unknowns, residuals, and the fall by that of the linear model, -g . s +
    m |s|² of a damped step s along the slope g."""
    new = _cut_step(at, damping)
    if new is None or np.array_equal(new, at.y):
        return None
    now, step = search.residuals(new), new - at.y
    expected = damping * float(((step / at.sizes) ** 2).sum()) - float(at.slope @ step)
    fell = float(at.r @ at.r) - float(now @ now)
    if not search.at(new).converged or not fell > 0.0:
        return None
    return new, now, fell / max(expected, np.finfo(float).tiny)


def _cut_step(at: From, damping: float) -> Floats | None:
    model, r, y, (lower, upper) = at.model, at.r, at.y, at.bounds
    free, new = ~at.held, y
    shift = np.zeros(len(y))
    for _ in range(PASSES):
        step = model.step(r + model.forward(shift) if shift.any() else r, damping, free, at.sizes)
        if step is None:
            return None
        new = y + shift + step
        beyond = free & ((new < lower) | (new > upper))
        if not beyond.any():
            return new
        shift = np.where(beyond, np.clip(new, lower, upper) - y, shift)
        free = free & ~beyond
    return np.clip(new, lower, upper)
