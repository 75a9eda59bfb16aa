"""What goals would gain from bounds and constraints, and which goals conflict: multipliers at the end of a search.

At a minimum the slope of the objective is a sum of those of what limits it: each limit's multiplier is the rate at
which the objective falls as the limit gives way (the envelope theorem). The same sums, made for the slope of each goal
by itself, give how much of it each goal gains; what they leave is what goals pull against one another.
Source: Nocedal and Wright, Numerical Optimization, 2006, chapter 12.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from hookean.designing.limits import AT_BOUND
from hookean.designing.sensitivity import gradients, jacobian

if TYPE_CHECKING:
    from hookean.designing.equilibrium import Equilibrium
    from hookean.designing.search import Search

Floats = NDArray[np.float64]

NEAR = 1e-5  # part of the size of a constraint's values: nearer to its limit it limits
SLIGHT = 1e-4  # part of a goal by which it would fall with unknowns of twice their size: less is rounding
SMALL = 1e-3  # part of the objective: slopes of goals that are met are less
AGAINST = -0.5  # cosine between slopes from which on goals conflict
STEEP = 1e-2  # part of the unknowns' sizes
MOST = 400  # constraints that limit, above which no multipliers are worked out


@dataclass
class Gains:
    """Of each goal a row: `bounds` (goals, u) and `constraints` (goals, k), by how much its part of the objective falls
    as a bound or limit gives way by 1, in its unit; `conflicts`: numbers of the goals that pull against it."""

    bounds: Floats
    constraints: Floats
    conflicts: list[list[int]]
    left: Floats  # slopes (goals, u) by scaled unknowns that no limit holds
    held: NDArray[np.bool_]  # unknowns (u,) at bounds
    shares: Floats  # multipliers (k,) of all values of constraints in the slope of the objective


def gains(search: Search, found: Equilibrium, y: Floats) -> Gains | None:
    """What would be gained at an equilibrium; None where derivatives do not exist or too many constraints limit."""
    slopes = _goal_slopes(search, found)
    low, high = search.bounds
    lower, upper = y <= low + AT_BOUND, y >= high - AT_BOUND
    held = lower | upper
    rows, sides = _limiting(search, found)
    if len(rows) > MOST or not np.isfinite(slopes).all():
        return None
    by: Floats = np.zeros((0, len(y)))
    shares: Floats = np.zeros((len(slopes), 0))
    if len(rows):
        by = constraint_slopes(search, found)[rows]
        holds = _holding(by[:, ~held] * -sides[:, None], slopes[:, ~held].sum(axis=0), _both(search)[rows])
        by = np.where(holds[:, None], by, 0.0)
        shares = np.asarray(np.linalg.lstsq(by[:, ~held].T, slopes[:, ~held].T, rcond=1e-10)[0].T, np.float64)
    left = slopes - shares @ by
    side = np.where(lower == upper, 0.0, np.where(upper, 1.0, -1.0))
    constraints = np.zeros((len(slopes), sum(len(limit[0]) for limit in search.aims.limits)))
    constraints[:, rows] = -shares * sides
    inner, whole = np.where(held, 0.0, left), np.zeros(constraints.shape[1])
    whole[rows] = shares.sum(axis=0)
    return Gains(-left * side / search.scale, constraints, _conflicts(search, found, inner), inner, held, whole)


def _holding(by: Floats, slope: Floats, both: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Which limits hold the objective: those with a multiplier in slope = sum of multipliers x slopes of limits (k, u).

    A limit pushes one way only, so that its multiplier is not negative, but for a value that is held from both sides.
    """
    from scipy.optimize import nnls

    signed = np.concatenate([by, -by[both]])
    size = np.linalg.norm(signed, axis=1)
    size[size == 0.0] = 1.0
    try:
        found = nnls((signed / size[:, None]).T, slope)[0]
    except RuntimeError:  # no end of its exchanges
        return np.ones(len(by), bool)
    holds = found[: len(by)] > 0.0
    holds[both] |= found[len(by) :] > 0.0
    return np.asarray(holds)


def _both(search: Search) -> NDArray[np.bool_]:
    """Which values of constraints have one limit from both sides."""
    return np.concatenate([low == high for low, high in search.aims.limits])


def at_minimum(search: Search) -> bool:
    """Whether the best so far is a minimum of first order: nothing but bounds and constraints has a slope left, or all
    goals are met. Slopes are those by unknowns in parts of their sizes: far from where a search began they are slight
    by the scale of the start, even on a long way down."""
    if search.best[0] <= 0.0 and search.best[1] <= search.met:
        return True
    left = _left(search)
    if left is None:
        return False
    whole, bounds, least, steepest = left
    slight = np.sqrt(search.problem.settings.tolerance) * max(least, steepest)
    return bool(whole.max(initial=0.0) <= slight and (bounds >= -slight).all())


def is_steep(search: Search) -> bool:
    """Whether the best so far is no minimum by far: by the slopes that nothing holds, a step of a hundredth of the
    unknowns' sizes would take all of the objective. So it is at the edge of a snap, where no step leads on."""
    left = _left(search)
    if left is None:
        return False
    whole, _, least, steepest = left
    return bool(STEEP * whole.max(initial=0.0) > max(least, abs(search.best[1]), STEEP**2 * steepest))


def _left(search: Search) -> tuple[Floats, Floats, float, float] | None:
    """At the best so far, by unknowns in parts of their sizes: slopes that neither bounds nor constraints hold, what
    bounds gain, a slight slope, and the steepest of a goal; None without derivatives or with too many constraints."""
    y = search.best[2]
    found = search.at(y)
    gained = gains(search, found, y) if found.converged else None
    if gained is None:
        return None
    whole, bounds = gained.left.sum(axis=0), gained.bounds.sum(axis=0)
    steepest = float(np.abs(_goal_slopes(search, found)).max(initial=0.0))
    least = SMALL * max(search.first_value, abs(search.best[1]))
    return np.abs(whole) * np.maximum(1.0, np.abs(y)), bounds * search.scale, least, steepest


def _goal_slopes(search: Search, found: Equilibrium) -> Floats:
    """Derivatives (goals, u) of each goal's part of the objective by scaled unknowns."""
    parts = enumerate(zip(search.problem.goals, search.aims.slopes(found), strict=True))
    rows = [
        gradients(found, search.unknowns, [(g.quantity, f"/goals/{i}")], [by]) * search.scale for i, (g, by) in parts
    ]
    return np.array(rows).reshape(-1, search.unknowns.count)


def _limiting(search: Search, found: Equilibrium) -> tuple[NDArray[np.int64], Floats]:
    """Values of constraints at their limits, among all, and on which side: 1 at the upper one, -1 at the lower one.
    Where both are the same the value is taken to be at its upper one."""
    rows, sides, first = [np.zeros(0, np.int64)], [np.zeros(0)], 0
    values = search.aims.constraint_values(found)
    for own, (low, high), size in zip(values, search.aims.limits, search.sizes, strict=True):
        side = np.where(own >= high - NEAR * size, 1.0, np.where(own <= low + NEAR * size, -1.0, 0.0))
        rows.append(first + np.flatnonzero(side))
        sides.append(side[side != 0.0])
        first += len(own)
    return np.concatenate(rows), np.concatenate(sides)


def constraint_slopes(search: Search, found: Equilibrium) -> Floats:
    """Derivatives (k, u) of all values of constraints by scaled unknowns."""
    quantities = [(c.quantity, f"/constraints/{i}") for i, c in enumerate(search.problem.constraints)]
    return jacobian(found, search.unknowns, quantities) * search.scale


def _conflicts(search: Search, found: Equilibrium, left: Floats) -> list[list[int]]:
    """Of each goal the goals whose slopes point the other way."""
    objectives = np.abs(search.aims.objectives(found))
    sizes = np.linalg.norm(left, axis=1)
    pulling = sizes > SLIGHT * np.maximum(objectives, np.finfo(float).tiny)
    unit = left / np.where(sizes > 0.0, sizes, 1.0)[:, None]
    against = (unit @ unit.T < AGAINST) & pulling[:, None] & pulling
    return [np.flatnonzero(row).tolist() for row in against]
