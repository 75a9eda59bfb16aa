"""The last digits of a minimum: steps of Newton on what bounds and constraints leave free.

With multipliers l of the constraints c that hold, the Lagrangian f - l . c has derivatives by one solve, and second
derivatives H by their differences, two equilibria for each unknown. A step goes back to the limits by the shortest way
and, across their slopes, to where H has the slope vanish, or less far where that gains nothing (Levenberg 1944). From
there it goes back to the limits once more, for they are curved (second-order corrections).
Source: Nocedal and Wright, Numerical Optimization, 2006, chapter 18.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from hookean.designing.gains import Gains, constraint_slopes, gains
from hookean.designing.sensitivity import gradients

if TYPE_CHECKING:
    from hookean.designing.equilibrium import Equilibrium
    from hookean.designing.search import Search

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]

MOST = 60  # unknowns that are not at bounds, above which second derivatives take too many equilibria
STEPS, EQUILIBRIA = 12, 240  # the most of both; 3 steps in any case
SLOPE = 1e-7  # part of the objective: slopes below are those of a minimum to all digits that count
OFF = 1e-9  # part of the size of values: nearer to their limit they are at it
NOTHING = 1e-14  # part of the first objective: what is left is rounding
STEP = 1e-4  # of an unknown's size, of differences of second order: 1e-8, and rounding of slopes by 1e-5
STRAIGHT = 1e-12  # part of the largest curvature: that of directions that have less
DAMPINGS = (0.0, *(10.0**-k for k in range(10, 0, -1)))  # parts of the largest curvature, added to all
SHORT = (1e-3, 1e-4, 1e-5, 1e-6)  # of an unknown's size, of steps straight down: near a snap, where nothing else leads
SHORTER = (1.0, 0.9, 0.5)  # parts of a step to a limit, which may be nearer than by its slope
BACK = 3  # ways back to limits after a step
NOISE = 1e-10  # part of the objective by which it may differ at one shape, found on two ways
MUCH = 1e-8  # part of the objective: a last step that gains more is not near the minimum
GAIN = 1e-12  # part of the objective: a step that gains less is the last


@dataclass
class Here:
    """What a step begins with."""

    y: Floats
    found: Equilibrium
    gained: Gains
    slope: Floats  # of the Lagrangian (u,)
    free: Bools  # unknowns that no bound holds
    rows: NDArray[np.int64]  # limits that hold, among all values of constraints
    limits: Floats  # of these
    off: Floats  # what these are off their limits
    by: Floats  # derivatives (k, u) of all values of constraints


def polish(search: Search) -> bool:
    """Bring the best so far nearer to the minimum that it is at, if its slope is not that of one yet. Whether the last
    of the steps that are taken at once still gained much: in a narrow valley slopes of goals may nearly cancel, far
    from the minimum."""
    taken, gain = 0, 0.0
    for number in range(STEPS):
        here, before = _here(search), search.best[1]
        if here is None:
            return False
        taken += 2 * int(here.free.sum())
        if number >= 3 and taken > EQUILIBRIA:
            break
        if not _step(search, here):
            return False
        gain = before - search.best[1]
    return gain > MUCH * abs(search.best[1])


def _here(search: Search) -> Here | None:
    missed, value, y = search.best
    if missed > 0.0 or not abs(value) > NOTHING * search.first_value:
        return None
    found = search.at_best()
    gained = gains(search, found, y) if found.converged else None
    if gained is None:
        return None
    free, slope = ~gained.held, gained.left.sum(axis=0)
    rows = np.flatnonzero(gained.shares)
    values, low, high = limits_at(search, found)
    nearer = np.where(np.abs(values - low) < np.abs(values - high), low, high)
    off = (values - nearer)[rows]
    flat = not np.abs(slope).max(initial=0.0) > SLOPE * abs(value)
    if free.sum() > MOST or (flat and not (np.abs(off) > OFF * _sizes(search)[rows]).any()):
        return None
    by = constraint_slopes(search, found) if search.problem.constraints else np.zeros((0, len(free)))
    return Here(y, found, gained, slope, free, rows, nearer[rows], off, by)


def _sizes(search: Search) -> Floats:
    parts = zip(search.aims.limits, search.sizes, strict=True)
    return np.concatenate([np.zeros(0), *(np.full(len(limit[0]), size) for limit, size in parts)])


def limits_at(search: Search, found: Equilibrium) -> tuple[Floats, Floats, Floats]:
    none = [np.zeros(0)]
    values = np.concatenate(none + search.aims.constraint_values(found))
    low, high = (np.concatenate(none + [limit[side] for limit in search.aims.limits]) for side in (0, 1))
    return values, low, high


def _step(search: Search, here: Here) -> bool:
    """One step; whether another one may gain more."""
    before, value = _merit(search, here, here.y), abs(search.best[1])
    for number, step in enumerate(_newton(search, here)):
        y = np.clip(here.y + step, *search.bounds)
        for end in (_onto_limits(search, here, y), y) if len(here.rows) else (y,):
            merit = _merit(search, here, end)
            if merit < before or (number == 0 and merit - before <= NOISE * value and _flatter(search, here, end)):
                search.take(end)
                return before - merit > GAIN * value
    return False


def _flatter(search: Search, here: Here, y: Floats) -> bool:
    """Whether the slope that is left is less by half: of objectives that differ by rounding the less is not always
    nearer to the minimum."""
    across = null(here.by[here.rows][:, here.free])
    left = [across.T @ slope[here.free] for slope in (here.slope, _lagrangian(search, here, search.at(y)))]
    return bool(np.linalg.norm(left[1]) <= 0.5 * np.linalg.norm(left[0]))


def _onto_limits(search: Search, here: Here, y: Floats) -> Floats:
    """Unknowns from which the limits that hold are met, by the shortest way there; `y` where that does not lead on."""
    new, by, last = y, here.by[here.rows][:, here.free], np.inf
    for _ in range(BACK):
        found = search.at(new)
        off = limits_at(search, found)[0][here.rows] - here.limits if found.converged else np.array([np.inf])
        parts = float(np.abs(off / _sizes(search)[here.rows]).max())
        if not parts < last:
            return y
        if parts <= OFF:
            break
        new, last = new.copy(), parts
        new[here.free] -= np.linalg.lstsq(by, off, rcond=1e-10)[0]
        new = np.clip(new, *search.bounds)
    return new


def _merit(search: Search, here: Here, y: Floats) -> float:
    """The objective and what limits are missed by, each by more than its multiplier."""
    found = search.at(y)
    if not found.converged or search.missed(found) > 0.0:
        return np.inf
    values, low, high = limits_at(search, found)
    price = 2.0 * np.maximum(np.abs(here.gained.shares), np.abs(here.gained.shares).max(initial=0.0) * 1e-3)
    return float(sum(search.aims.objectives(found)) + price @ np.abs(values - np.clip(values, low, high)))


def _newton(search: Search, here: Here) -> list[Floats]:
    """Steps (u,), each more damped than the one before, then straight down; none without second derivatives."""
    free, count = here.free, int(here.free.sum())
    by = here.by[here.rows][:, free]
    hessian = _hessian(search, here)
    if hessian is None:
        return []
    back = np.linalg.lstsq(by, -here.off, rcond=1e-10)[0] if len(by) else np.zeros(count)
    across = null(by)
    slope = across.T @ (here.slope[free] + hessian @ back)
    curvature, turned = np.linalg.eigh(across.T @ hessian @ across)
    largest, steps = float(np.abs(curvature).max(initial=0.0)), []
    for damping in DAMPINGS:
        bent = np.maximum(np.abs(curvature), STRAIGHT * largest) + damping * largest
        step = np.zeros(len(free))
        step[free] = back - across @ (turned @ ((turned.T @ slope) / np.where(bent > 0.0, bent, np.inf)))
        if np.isfinite(step).all():
            length = _length(search, here, here.by @ step)
            steps += [step * length * part for part in (SHORTER if length < 1.0 else SHORTER[:1])]
    down, size = across @ (across.T @ here.slope[free]), float(np.linalg.norm(across.T @ here.slope[free]))
    for length in SHORT if size > 0.0 else ():
        step = np.zeros(len(free))
        step[free] = back - down * (length / size)
        steps.append(step)
    return steps


def _length(search: Search, here: Here, changes: Floats) -> float:
    """The part of a step, at most 1, after which the first limit holds that does not yet (equation 16.41 there)."""
    values, low, high = limits_at(search, here.found)
    room = np.where(changes > 0.0, high - values, low - values)
    room[here.rows] = np.copysign(np.inf, changes[here.rows])  # these are held by the step itself
    ways = (changes != 0.0) & (np.sign(room) == np.sign(changes))
    return float(min(1.0, (room[ways] / changes[ways]).min(initial=1.0)))


def null(by: Floats) -> Floats:
    """Directions (n, m) in which none of the rows (k, n) changes."""
    if not len(by):
        return np.eye(by.shape[1])
    _, sizes, turned = np.linalg.svd(by)
    return np.asarray(turned[int((sizes > 1e-10 * sizes.max(initial=0.0)).sum()) :].T)


def _hessian(search: Search, here: Here) -> Floats | None:
    """Second derivatives (n, n) of the Lagrangian by free unknowns."""
    (lower, upper), columns = search.bounds, []
    for unknown in np.flatnonzero(here.free):
        ends, slopes = [], []
        for way in (STEP, -STEP):
            away = here.y.copy()
            away[unknown] = np.clip(away[unknown] + way, lower[unknown], upper[unknown])
            found = search.at(away)
            if not found.converged:
                return None
            ends.append(away[unknown])
            slopes.append(_lagrangian(search, here, found))
        columns.append((slopes[0] - slopes[1]) / (ends[0] - ends[1]))
    whole = np.array(columns)[:, here.free]
    return np.asarray(0.5 * (whole + whole.T))


def _lagrangian(search: Search, here: Here, found: Equilibrium) -> Floats:
    """Its slope (u,), by one solve."""
    goals = [(g.quantity, f"/goals/{i}") for i, g in enumerate(search.problem.goals)]
    limited = [(c.quantity, f"/constraints/{i}") for i, c in enumerate(search.problem.constraints)]
    ends = np.cumsum([len(limit[0]) for limit in search.aims.limits])[:-1].astype(int)
    shares = np.split(-here.gained.shares, ends) if limited else []
    return gradients(found, search.unknowns, goals + limited, search.aims.slopes(found) + shares) * search.scale
