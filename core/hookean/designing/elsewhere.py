"""Starts elsewhere: where no variable changes at first what misses its target or limits, because elements are slack or
nothing touches there, a search may begin again from values at which one does."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from hookean.designing.answer import once
from hookean.designing.limits import LIMIT
from hookean.designing.sensitivity import gradients
from hookean.errors import InputError

if TYPE_CHECKING:
    from hookean.designing.equilibrium import Equilibrium
    from hookean.designing.quantities.base import Quantity
    from hookean.designing.search import Search

Floats = NDArray[np.float64]

FLAT = 1e-12  # part of what is missed: variables that change it by less for each of their sizes do not change it
SAMPLES = 16  # shapes that are tried
REACH = 4.0  # of an unknown's size: the range of those without a bound
SEED = 5  # of the weights of values in a sum that is differentiated, and of the samples
FORCES = ("force", "force/length", "force length")

AGAIN = "no variable changes {} at the values of the scene; the search began again from other values"


def missing(search: Search, found: Equilibrium) -> list[tuple[str, Quantity, str, Floats]]:
    """Goals and constraints that are not met: what they are called, their quantity, pointer and what each value (k,)
    misses."""
    problem, aims = search.problem, search.aims
    whole: list[tuple[str, Quantity, str, Floats, float]] = []
    values = aims.values(found)
    names = once(goal.name or goal.quantity.kind_name for goal in problem.goals)
    for i, (goal, own, missed) in enumerate(zip(problem.goals, values, aims.missed(values), strict=True)):
        if missed is not None:
            pointer = f"/goals/{i}"
            size = float(np.abs(own - missed).max(initial=search.sized(goal.quantity, found, pointer)))
            size = max(size, float(np.abs(own).max(initial=0.0)))
            whole.append((f"goal {names[i]}", goal.quantity, pointer, missed, size))
    names = once(limited.name or limited.quantity.kind_name for limited in problem.constraints)
    kept = zip(problem.constraints, aims.constraint_values(found), aims.limits, search.sizes, strict=True)
    for i, (limited, own, limits, size) in enumerate(kept):
        whole.append(
            (f"constraint {names[i]}", limited.quantity, f"/constraints/{i}", own - np.clip(own, *limits), size)
        )
    return [entry[:4] for entry in whole if not np.abs(entry[3]).max(initial=0.0) <= LIMIT * (entry[4] or 1.0)]


def unchanged(search: Search, found: Equilibrium) -> list[tuple[str, Quantity, str]]:
    """Those of them that no variable changes at a shape: by a random sum of the values that miss something."""
    said: list[tuple[str, Quantity, str]] = []
    for name, quantity, pointer, missed in missing(search, found) if found.converged else ():
        weights = np.where(missed != 0.0, np.random.default_rng(SEED).uniform(0.5, 1.5, len(missed)), 0.0)
        slopes = gradients(found, search.unknowns, [(quantity, pointer)], [weights]) * search.scale
        if np.abs(slopes).max(initial=0.0) <= FLAT * float(np.abs(missed).max()):
            said.append((name, quantity, pointer))
    return said


def sentences(search: Search, found: Equilibrium) -> list[str]:
    """A sentence for each of these."""
    said = []
    for name, quantity, pointer in unchanged(search, found):
        idle = quantity.unit in FORCES and not quantity.values(found, pointer).any()
        more = ", where it is 0: its elements carry nothing; values at which they do may change it" if idle else ""
        said.append(f"no variable changes {name} at this shape{more}")
    return said


def other_start(search: Search) -> tuple[Floats | None, str]:
    """Values (u,) of unknowns at which variables change what none changes at the best, or it is met: of a sample within
    the bounds those that miss least, nearest to the start of them; and what that is called."""
    flat = unchanged(search, search.at_best())
    if not flat:
        return None, ""
    from scipy.stats import qmc  # half a second, and most searches need none of it

    best: Floats | None = None
    kept = (np.inf, np.inf, np.inf)
    still = {pointer for _, _, pointer in flat}
    low, high = search.bounds
    low, high = np.where(np.isfinite(low), low, -REACH), np.where(np.isfinite(high), high, REACH)
    for part in qmc.LatinHypercube(len(low), seed=SEED).random(SAMPLES):
        y = low + (high - low) * part
        try:
            there = search.at(y)
        except (InputError, ArithmeticError):
            continue
        if not there.converged or still <= {pointer for _, _, pointer in unchanged(search, there)}:
            continue
        merit = search.missed(there), float(sum(search.aims.objectives(there))), float(np.linalg.norm(y))
        if np.isfinite(merit).all() and merit < kept:
            best, kept = y, merit
    search.at_best()
    return None if best is None else search.given(best), ", ".join(name for name, _, _ in flat)
