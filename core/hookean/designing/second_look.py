"""A second look at the end of a search: whether a relaxation of the returned scene finds its shape again, and whether
the start only seemed best because derivatives vanish there by symmetry."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from hookean.designing.gains import constraint_slopes, gains
from hookean.designing.limits import LIMIT, beyond
from hookean.designing.polish import limits_at, null
from hookean.designing.sensitivity import jacobian
from hookean.errors import InputError
from hookean.forces.base import lengths
from hookean.running.run import relax
from hookean.scene.scene import Scene
from hookean.solvers.force_density import nonlinear

if TYPE_CHECKING:
    from hookean.designing.equilibrium import Equilibrium
    from hookean.designing.search import Search

Floats = NDArray[np.float64]

APART = 1e-3  # part of the model's size by which two shapes are not the same
BESIDE = 1e-2  # of unknowns' sizes, the step of a second look; the objective changes by its square
FLAT = 1e-9  # part of the objective: slopes below are 0
BETTER = 1e-8  # part of the objective: a fall that is not rounding
SEED = 11
BACK = 4  # steps back to the limits, each by 1e-2 of what is left

SYMMETRIC = (
    "The start is stationary by symmetry: no variable changes the objective there at first, but values beside it are"
    " better. Start from values that are a little off it."
)
SADDLE = (
    "The values are stationary by symmetry: along the limits that hold no variable changes the objective at first, but"
    " values on both sides are better. Start from values that are a little off it."
)
UNMOVED = (
    "No variable changes at first what misses its limits at the start, but values beside it are nearer. Start from"
    " values that are a little off it."
)


def not_found_again(search: Search, found: Equilibrium, scene: Scene) -> list[str]:
    """A warning where the scene of the answer has another equilibrium from its drawn shape, or the same films and goals
    that depend on where the vertices of these lie."""
    if not found.converged or not nonlinear(search.system):
        return []
    try:
        again = relax(scene)
    except InputError as error:
        return [f"the returned scene cannot be relaxed: {error.sentence}"]
    if not again.converged:
        return [f"a relaxation of the returned scene from its drawn shape does not converge: {again.message}"]
    moved, unit = found.x.copy(), search.system.scene.units.length
    moved[: len(again.particles)] -= again.particles
    moved[len(again.particles) :] = 0.0
    across = _across_films(search, found, moved)
    whole, other = (float(lengths(rows).max(initial=0.0)) for rows in (moved, across))
    least = APART * search.system.size
    if other > least:
        return [
            f"a relaxation of the returned scene from its drawn shape ends up to {whole:.3g} {unit} away, at another"
            " equilibrium; draw the scene nearer to the shape of this result"
        ]
    if whole > least and (names := _changed(search, found, across - moved)):
        return [
            f"a relaxation of the returned scene from its drawn shape ends at the same films, with vertices up to"
            f" {whole:.3g} {unit} away along them; it changes what depends on where they lie: {', '.join(names)}"
        ]
    return []


def _across_films(search: Search, found: Equilibrium, moved: Floats) -> Floats:
    """What motions (n, 3) to a shape have across its films, whose vertices may lie anywhere in them. Directions are
    those of the shape halfway: the chord of a bow is along it there."""
    films, across = search.system.films, moved.copy()
    if films is not None:
        films.across(found.x - 0.5 * moved, found.state.free, across)
    return across


def _changed(search: Search, found: Equilibrium, moved: Floats) -> list[str]:
    """Goals and constraints that change with motions (n, 3) by more than shapes may differ."""
    problem = search.problem
    names: list[str] = []
    entries: list[tuple[str, Any]] = [(f"goals/{i}", goal) for i, goal in enumerate(problem.goals)]
    entries += [(f"constraints/{i}", limited) for i, limited in enumerate(problem.constraints)]
    for pointer, entry in entries:
        own = entry.quantity.values(found, f"/{pointer}")
        size = max(float(np.abs(own).max(initial=0.0)), search.sized(entry.quantity, found, f"/{pointer}"))
        change = entry.quantity.slopes(found, search.unknowns, f"/{pointer}")[0] @ moved.ravel()
        if np.abs(change).max(initial=0.0) > APART * (size or 1.0):
            names.append(entry.name or entry.quantity.kind_name)
    return names


def stationary(search: Search) -> bool:
    """Whether the best is the start, with slopes that are 0 and better values beside it."""
    missed, value, best = search.best
    if missed > 0.0 or best.any():
        return False
    size = max(abs(value), np.finfo(float).tiny)
    if not np.abs(search.gradient(best)).max(initial=0.0) <= FLAT * size:
        return False
    found = any(
        search.objective(y) < value - BETTER * size and search.missed(search.at(y)) == 0.0 for y in _beside(search)
    )
    search.best = (missed, value, best)
    return found


def saddle(search: Search) -> bool:
    """Whether values on both sides of the best are better, along the limits that hold: it is stationary, and no
    minimum. One direction is tried; beside a minimum no value on both sides is better."""
    missed, value, best = search.best
    found = search.at_best()
    gained = gains(search, found, best) if missed == 0.0 and found.converged and search.problem.constraints else None
    if gained is None or not (rows := np.flatnonzero(gained.shares)).size:
        return False
    free = ~gained.held
    by = constraint_slopes(search, found)[rows][:, free]
    across = null(by)
    if not across.shape[1]:
        return False
    aside = across @ np.random.default_rng(SEED).normal(size=across.shape[1])
    held = np.concatenate([column[None, rows] for column in limits_at(search, found)[1:]])
    values = limits_at(search, found)[0][rows]
    goal = np.where(np.abs(values - held[0]) < np.abs(values - held[1]), *held)
    size = max(abs(value), np.finfo(float).tiny)
    step = np.zeros(len(best))
    step[free] = BESIDE * aside / np.abs(aside).max()
    sides = [_along(search, best + way * step, free, by, rows, goal) for way in (1.0, -1.0)]
    search.best = (missed, value, best)
    return max(sides) < value - BETTER * size


def _along(search: Search, y: Floats, free: Any, by: Floats, rows: Any, goal: Floats) -> float:
    """The objective beside `y`, back at the limits that hold; infinite where the way does not lead there."""
    y = y.copy()
    for _ in range(BACK):
        found = search.at(np.clip(y, *search.bounds))
        if not found.converged:
            return np.inf
        y[free] += np.linalg.lstsq(by, goal - limits_at(search, found)[0][rows], rcond=1e-10)[0]
    y = np.clip(y, *search.bounds)
    found = search.at(y)
    return search.objective(y) if found.converged and search.missed(found) == 0.0 else np.inf


def unmoved(search: Search) -> bool:
    """Whether the best is the start, and no variable changes there what misses its limits."""
    if search.best[2].any() or not search.best[0] > 0.0:
        return False
    found, y = search.at(search.best[2]), search.best[2]
    quantities = [(c.quantity, f"/constraints/{i}") for i, c in enumerate(search.problem.constraints)]
    slopes = np.abs(jacobian(found, search.unknowns, quantities) * search.scale).max(axis=1, initial=0.0)
    values = search.aims.constraint_values(found)
    misses = [beyond(own, *limits) for own, limits in zip(values, search.aims.limits, strict=True)]
    sizes = np.concatenate([np.full(len(own), size) for own, size in zip(misses, search.sizes, strict=True)])
    flat = bool((slopes <= FLAT * sizes)[np.concatenate(misses) > LIMIT * sizes].all())
    best = search.best
    nearer = flat and any(search.missed(search.at(beside)) < best[0] for beside in _beside(search))
    search.at(y)
    return nearer


def _beside(search: Search) -> list[Floats]:
    """Unknowns a little off the start, to both sides: each by 0.5 to 1.5 steps."""
    rng, count = np.random.default_rng(SEED), search.unknowns.count
    step = BESIDE * rng.uniform(0.5, 1.5, count) * rng.choice([-1.0, 1.0], count)
    return [np.clip(way * step, *search.bounds) for way in (1.0, -1.0)]
