"""How the best shape of a search stands to goals, constraints and bounds."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from hookean.designing.answer import Design, DesignStatus, once
from hookean.designing.elsewhere import sentences
from hookean.designing.gains import Gains, gains
from hookean.designing.limits import AT_BOUND, FAR, LIMIT, beyond
from hookean.designing.second_look import UNMOVED, not_found_again
from hookean.designing.sensitivity import warnings

if TYPE_CHECKING:
    from hookean.designing.equilibrium import Equilibrium
    from hookean.designing.search import Search

Floats = NDArray[np.float64]
Entries = list[dict[str, Any]]

LISTED = 10  # names in a sentence


def answer(search: Search, method: str, iterations: int, ended: DesignStatus, said: str) -> Design:
    """The best shape so far as a Design."""
    missed, value, y = search.best
    search.cancelled = None
    found = search.at_best() if np.isfinite(missed) else search.at(np.zeros(search.unknowns.count))
    y = y if np.isfinite(missed) else np.zeros(search.unknowns.count)
    broken = [
        name for name, met in zip(_names(search.problem.constraints), _met(search, found), strict=True) if not met
    ]
    if broken and ended in (DesignStatus.CONVERGED, DesignStatus.STALLED) and said != UNMOVED:
        ended = DesignStatus.INFEASIBLE
    gained = gains(search, found, y) if found.converged and not broken else None
    variables = _variables(search, search.given(y), gained)
    goals = _goals(search, found, gained)
    if not said:
        said = _sentence(ended, broken, iterations, value)
    said = " ".join([said, *_conflicts(goals), *_held(variables, broken)])
    scene = search.unknowns.scene(search.system.scene)
    again = [] if ended is DesignStatus.CANCELLED else not_found_again(search, found, scene)
    return Design(
        status=ended,
        message=said,
        objective=float(value) if np.isfinite(value) else float(sum(search.aims.objectives(found))),
        iterations=iterations,
        method=method,
        variables=variables,
        goals=goals,
        constraints=_constraints(search, found, gained),
        result=found.result,
        scene=scene,
        warnings=[
            *warnings(found),
            *search.unknowns.differing,
            *search.notes,
            *sentences(search, found),
            *(_far(search, y) if ended is DesignStatus.CONVERGED else []),
            *again,
        ],
    )


def _far(search: Search, y: Floats) -> list[str]:
    """A sentence for each variable that went far where no bound ends its way: the least may be nowhere."""
    low, high = search.bounds
    far = (np.abs(y) > FAR) & ~np.isfinite(np.where(y > 0.0, high, low))
    parts = zip(search.unknowns.names, search.unknowns.slices, strict=True)
    names = [name for name, part in parts if far[part].any()]
    said = f"went beyond {FAR:g} times its size, where the objective hardly falls any more; give it bounds"
    return [f"{name} {said}" for name in names]


def _sentence(ended: DesignStatus, broken: list[str], iterations: int, value: float) -> str:
    if broken:
        return (
            f"No values within the bounds were found that meet the constraints: {_listed(broken)}. These are the"
            " nearest."
        )
    steps = f"{iterations} iteration{'s' * (iterations != 1)}"
    if ended is DesignStatus.MAX_ITERATIONS:
        return f"Stopped after {steps} with an objective of {value:.4g}; raise max_iterations to go on."
    return f"Found after {steps}: objective {value:.4g}."


def _conflicts(goals: Entries) -> list[str]:
    """A sentence that names goals that pull against one another."""
    names = [entry["name"] for entry in goals if entry["conflicts"]]
    return [f"These goals conflict: {_listed(names)}."] if names else []


def _held(variables: Entries, broken: list[str]) -> list[str]:
    """Where constraints cannot be met, which variables are at their bounds."""
    names = [entry["name"] for entry in variables if np.any(entry["at_bound"])]
    return [f"At their bounds: {_listed(names)}."] if broken and names else []


def _listed(names: list[str]) -> str:
    """Names in a sentence, of many the first ones."""
    more = f" and {len(names) - LISTED} more" if len(names) > LISTED else ""
    return ", ".join(names[:LISTED]) + more


def _names(parts: Any) -> list[str]:
    return once(part.name or str(part.quantity.kind_name) for part in parts)


def _variables(search: Search, values: Floats, gained: Gains | None) -> Entries:
    unknowns, entries = search.unknowns, []
    gain = np.zeros(unknowns.count) if gained is None else gained.bounds.sum(axis=0)
    for variable, part, name in zip(unknowns.variables, unknowns.slices, unknowns.names, strict=True):
        own, slack = values[part], AT_BOUND * search.scale[part]
        bound = (own <= unknowns.lower[part] + slack) | (own >= unknowns.upper[part] - slack)
        entries.append(
            {
                "name": name,
                "value": _shaped(variable, own),
                "unit": variable.unit,
                "at_bound": _shaped(variable, bound),
                "gain": None if gained is None else _shaped(variable, np.where(bound, gain[part], 0.0)),
            }
        )
    return entries


def _shaped(variable: Any, own: Any) -> Any:
    """Numbers of a variable in the shape that its values have in an answer."""
    shape = variable.shape
    if variable.variable.tie == "all" and len(own) == 1:
        return own[0].item()
    if getattr(variable, "shifts", False) and len(shape) == 2 and shape[0] == 1:
        return own
    return own.reshape(shape)


def _goals(search: Search, found: Equilibrium, gained: Gains | None) -> Entries:
    entries: Entries = []
    values, names = search.aims.values(found), _names(search.problem.goals)
    parts = zip(search.problem.goals, values, search.aims.ranges, search.aims.missed(values), names, strict=True)
    for i, (goal, own, among, missed, name) in enumerate(parts):
        entry = {"name": name, "kind": goal.quantity.kind_name, "value": _single(own), "target": None}
        size = float(np.abs(own).max(initial=0.0))
        if among is not None and missed is not None:
            entry["target"] = _single(own - missed if (among[0] < among[1]).any() else among[0])
            aimed = float(np.abs(np.asarray(entry["target"])).max(initial=0.0))
            size = max(size, aimed, search.sized(goal.quantity, found, f"/goals/{i}"))
        entry["met"] = None if missed is None else bool(np.abs(missed).max(initial=0.0) <= LIMIT * (size or 1.0))
        others = [] if gained is None or entry["met"] else gained.conflicts[i]
        entry |= {"weight": goal.weight, "unit": goal.quantity.unit, "conflicts": others}
        entry["gains"] = {} if gained is None or entry["met"] else _gains_of(search, gained, i)
        entries.append(entry)
    for entry in entries:
        entry["conflicts"] = [names[j] for j in entry["conflicts"] if not entries[j]["met"]]
    return entries


def _gains_of(search: Search, gained: Gains, goal: int) -> dict[str, Any]:
    """By how much a goal's part of the objective falls as bounds of each variable and limits of each constraint give
    way by 1; those that limit nothing are left out."""
    found: dict[str, Any] = {}
    unknowns = search.unknowns
    for variable, part, name in zip(unknowns.variables, unknowns.slices, unknowns.names, strict=True):
        own = np.where(_bound(search, part), gained.bounds[goal, part], 0.0)
        if own.any():
            found[name] = _shaped(variable, own)
    first = 0
    for name, limits in zip(_names(search.problem.constraints), search.aims.limits, strict=True):
        own = gained.constraints[goal, first : first + len(limits[0])]
        if own.any():
            found[name] = _single(own)
        first += len(own)
    return found


def _bound(search: Search, part: slice) -> NDArray[np.bool_]:
    low, high = search.bounds
    y = search.best[2]
    return np.asarray((y[part] <= low[part] + AT_BOUND) | (y[part] >= high[part] - AT_BOUND))


def _met(search: Search, found: Equilibrium) -> list[bool]:
    parts = zip(search.aims.constraint_values(found), search.aims.limits, search.sizes, strict=True)
    return [bool((beyond(own, *limits) <= LIMIT * by).all()) for own, limits, by in parts]


def _constraints(search: Search, found: Equilibrium, gained: Gains | None) -> Entries:
    entries: Entries = []
    values, first = search.aims.constraint_values(found), 0
    names, whole = _names(search.problem.constraints), None if gained is None else gained.constraints.sum(axis=0)
    for constraint, own, name, met in zip(search.problem.constraints, values, names, _met(search, found), strict=True):
        gain = None if whole is None else _single(whole[first : first + len(own)])
        first += len(own)
        entry = {"name": name, "kind": constraint.quantity.kind_name, "value": _single(own), "met": met, "gain": gain}
        entries.append({**entry, "unit": constraint.quantity.unit})
    return entries


def _single(values: Floats) -> Any:
    """One value as a number, several as an array."""
    return float(values[0]) if len(values) == 1 else values
