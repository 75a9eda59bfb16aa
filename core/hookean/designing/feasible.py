"""The values within the bounds that miss a problem's constraints least, whatever its goals."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from hookean.designing.limits import AT_BOUND
from hookean.designing.sensitivity import jacobian

if TYPE_CHECKING:
    from hookean.designing.search import Search

Floats = NDArray[np.float64]


def off_zero(start: Floats, lower: Floats, upper: Floats) -> float:
    """By how much to move unknowns whose start is at a bound: the first steps of SciPy's least squares are as long as
    the start is from 0, and 1e-10, by which it moves off a bound, is no length."""
    return 1.0 if ((start <= lower) | (start >= upper)).any() else 0.0


def nearer(search: Search) -> int:
    """Search for what meets the constraints by least squares of what they miss, from the best so far and, if that ends
    short of them, from the start; how often derivatives were asked for. The search keeps what is best."""
    from scipy.optimize import least_squares

    lower, upper = search.bounds
    upper = np.where(lower < upper, upper, lower + AT_BOUND)
    quantities = [(c.quantity, f"/constraints/{i}") for i, c in enumerate(search.problem.constraints)]
    low, high = (np.concatenate(side) for side in zip(*search.aims.limits, strict=True))
    sizes = np.concatenate([np.full(len(one[0]), by) for one, by in zip(search.aims.limits, search.sizes, strict=True)])

    def values(y: Floats) -> Floats:
        found = search.at(y)
        search.note(y)
        own = np.concatenate(search.aims.constraint_values(found)) if found.converged else np.full(len(low), np.nan)
        missed = (own - np.clip(own, low, high)) / sizes
        return missed if np.isfinite(missed).all() else np.full(len(low), 1e6)

    def slopes(y: Floats) -> Floats:
        own = np.concatenate(search.aims.constraint_values(search.at(y)))
        by = jacobian(search.at(y), search.unknowns, quantities) * search.scale / sizes[:, None]
        return np.nan_to_num(np.where(((own < low) | (own > high))[:, None], by, 0.0))

    tolerance, taken = search.problem.settings.tolerance, 0
    for start in (search.best[2].copy(), np.zeros(search.unknowns.count)):
        if search.best[0] > 0.0:
            start = np.clip(start, lower, upper)
            off = off_zero(start, lower, upper)
            found = least_squares(
                lambda z, off=off: values(z - off), start + off, lambda z, off=off: slopes(z - off),
                bounds=(lower + off, upper + off), method="trf", ftol=tolerance, xtol=tolerance,
                gtol=tolerance * 1e-4, max_nfev=search.problem.settings.max_iterations,
            )  # fmt: skip
            taken += int(found.njev)
    return taken
