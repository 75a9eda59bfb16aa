"""The search: variables of a scene for which its equilibrium meets goals and constraints.

Where all goals have targets least squares by trust regions with bounds (Branch, Coleman and Li 1999), where some are
minimised L-BFGS-B (Byrd and others 1995), with constraints sequential quadratic programming (Kraft 1988); all from
SciPy, with exact derivatives through equilibrium.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.designing.answer import Design, DesignStatus
from hookean.designing.equilibrium import Equilibrium, follow, settle
from hookean.designing.factors import Orders
from hookean.designing.limits import AT_BOUND, LIMIT, beyond, size
from hookean.designing.linearised import Linearised
from hookean.designing.methods import METHODS, Stopped
from hookean.designing.problem import Goal, Problem
from hookean.designing.quantities.base import Quantity
from hookean.designing.sensitivity import gradients, jacobian, warnings
from hookean.designing.unknowns import Moved, Unknowns
from hookean.errors import InputError
from hookean.system.system import System, compile

Floats = NDArray[np.float64]
MANY = 40  # unknowns and values of goals, above which derivatives are not dense
Progress = Callable[[int, float], None]
"""Called with the iteration and the best objective so far."""
Keep = Callable[[Floats], None]
"""Called with the values (u,) of all unknowns each time they are the best so far."""


class Search:
    """The functions that methods ask for, of unknowns in units of their scale, and the best shape so far."""

    def __init__(
        self,
        problem: Problem,
        progress: Progress | None = None,
        cancelled: Callable[[], bool] | None = None,
        *,
        start: Any = None,
        keep: Keep | None = None,
    ) -> None:
        self.problem, self.progress, self.cancelled, self.keep = problem, progress, cancelled, keep
        self.system: System = compile(problem.scene)
        if missing := self.system.no_tangent(sparse=False):
            raise InputError("/scene/forces", f"{missing}, so nothing can be differentiated through its equilibrium")
        self.unknowns = Unknowns(problem, self.system)
        if start is not None:
            self.unknowns.begin(start)
        self.state = self.system.start()
        self.scale = self.unknowns.scale
        self.orders = Orders()
        self.found: Equilibrium | None = None
        self._at: Floats | None = None
        self._resting: Floats | None = None
        self.evaluations = 0
        self.best: tuple[float, float, Floats] = (np.inf, np.inf, self.unknowns.start.copy())
        self.first = self.at(np.zeros(self.unknowns.count))
        self.targets = [self._target(i, g) for i, g in enumerate(problem.goals)]
        self.limits = [self._limits(i) for i in range(len(problem.constraints))]
        self.sizes = [
            size(values, *limits, self.system.size if constraint.quantity.unit == "length" else 0.0)
            for constraint, values, limits in zip(
                problem.constraints, self.constraint_values(self.first), self.limits, strict=True
            )
        ]
        self._note(np.zeros(self.unknowns.count))

    def at(self, y: Floats) -> Equilibrium:
        """The equilibrium at scaled unknowns; if the run found none, its result reports that."""
        if self._at is not None and np.array_equal(self._at, y) and self.found is not None:
            return self.found
        if self.cancelled is not None and self.cancelled():
            raise Stopped
        if self._resting is not None:
            self.state.x = self._resting.copy()
        self.unknowns.put(self.system, self.state, self.unknowns.start + y * self.scale)
        followed = follow(self.found) if self.found is not None and self.found.converged else None
        self.found = followed or settle(self.system, self.state, self.orders)
        self._at = y.copy()
        if self.found.converged:
            self._resting = self.state.x.copy()
        self.evaluations += 1
        return self.found

    def goal_values(self, found: Equilibrium) -> list[Floats]:
        """Values of all goals."""
        return [g.quantity.values(found, f"/goals/{i}") for i, g in enumerate(self.problem.goals)]

    def constraint_values(self, found: Equilibrium) -> list[Floats]:
        """Values of all constraints."""
        return [c.quantity.values(found, f"/constraints/{i}") for i, c in enumerate(self.problem.constraints)]

    def _target(self, number: int, goal: Goal) -> Floats | None:
        """The targets (k,) of a goal; None: it is minimised."""
        if goal.target is None:
            return None
        values = goal.quantity.values(self.first, f"/goals/{number}")
        given = np.asarray(goal.target, dtype=np.float64)
        if given.size == len(values):
            return given.ravel()
        if given.size == 1:
            return np.full(len(values), float(given.ravel()[0]))
        axes = len(getattr(goal.quantity, "axes", "x"))
        if given.size == axes and len(values) % axes == 0:
            return np.tile(given.ravel(), len(values) // axes)
        raise InputError(
            f"/goals/{number}/target", f"{given.size} targets for {len(values)} values; give one or one for each"
        )

    def _limits(self, number: int) -> tuple[Floats, Floats]:
        """The least and the largest values of a constraint."""
        constraint = self.problem.constraints[number]
        values = constraint.quantity.values(self.first, f"/constraints/{number}")
        found = []
        for name, given, default in (("lower", constraint.lower, -np.inf), ("upper", constraint.upper, np.inf)):
            array = np.asarray(default if given is None else given, dtype=np.float64)
            if array.ndim and len(array) != len(values):
                said = f"{len(array)} limits for {len(values)} values; give one or one for each"
                raise InputError(f"/constraints/{number}/{name}", said)
            found.append(np.broadcast_to(array, values.shape))
        if (found[0] > found[1]).any():
            raise InputError(f"/constraints/{number}/lower", "lower is more than upper; no value can meet both")
        return found[0], found[1]

    def residuals(self, y: Floats) -> Floats:
        """sqrt(weight) (value - target) of all goals with targets."""
        found = self.at(y)
        parts = [
            np.sqrt(goal.weight) * (values - target)
            for goal, values, target in zip(self.problem.goals, self.goal_values(found), self.targets, strict=True)
            if target is not None
        ]
        whole = np.concatenate(parts) if parts else np.zeros(0)
        self._note(y)
        if not (found.converged and np.isfinite(whole).all()):
            return np.full(len(whole), 1e3 * (1.0 + np.sqrt(self.best[1] if np.isfinite(self.best[1]) else 1.0)))
        return whole

    def slopes(self, y: Floats) -> Floats:
        """Derivatives (k, u) of the residuals by scaled unknowns."""
        found = jacobian(self.at(y), self.unknowns, self._aimed())
        return np.nan_to_num(self._weights()[:, None] * found * self.scale)

    def linearised(self, y: Floats) -> Linearised:
        """The same as sparse parts."""
        return Linearised(self.at(y), self.unknowns, self._aimed(), self._weights(), self.scale, self.orders)

    @property
    def target_size(self) -> float:
        """What residuals are measured by: the targets, or what was missed at first where these are 0."""
        targets = [target for target in self.targets if target is not None]
        return float(np.linalg.norm(self._weights() * np.concatenate(targets))) or 1.0

    def _aimed(self) -> list[tuple[Quantity, str]]:
        """Quantities of goals with targets."""
        goals = enumerate(self.problem.goals)
        return [(goal.quantity, f"/goals/{i}") for i, goal in goals if self.targets[i] is not None]

    def _weights(self) -> Floats:
        """The weight (k,) of each residual."""
        pairs = zip(self.problem.goals, self.targets, strict=True)
        return np.concatenate([np.full(len(t), np.sqrt(g.weight)) for g, t in pairs if t is not None])

    def objective(self, y: Floats) -> float:
        """The objective; where there is no equilibrium, more than any so far."""
        found = self.at(y)
        value = self._objective(found)
        self._note(y)
        if found.converged and np.isfinite(value):
            return value
        return float(abs(self.best[1]) * 1e3 + 1e3) if np.isfinite(self.best[1]) else 1e30

    def _objective(self, found: Equilibrium) -> float:
        total = 0.0
        for goal, values, target in zip(self.problem.goals, self.goal_values(found), self.targets, strict=True):
            total += goal.weight * float((values if target is None else (values - target) ** 2).sum())
        return total

    def gradient(self, y: Floats) -> Floats:
        """Its derivatives by scaled unknowns."""
        found = self.at(y)
        weights = []
        for goal, values, target in zip(self.problem.goals, self.goal_values(found), self.targets, strict=True):
            weights.append(goal.weight * (np.ones(len(values)) if target is None else 2.0 * (values - target)))
        kept = [(g.quantity, f"/goals/{i}") for i, g in enumerate(self.problem.goals)]
        return np.nan_to_num(gradients(found, self.unknowns, kept, weights) * self.scale)

    def missed(self, found: Equilibrium) -> float:
        """The most by which a constraint is missed, by the size of its values [-]."""
        worst = 0.0
        for values, limits, by in zip(self.constraint_values(found), self.limits, self.sizes, strict=True):
            worst = max(worst, float(beyond(values, *limits).max(initial=0.0)) / by)
        return worst

    def _note(self, y: Floats) -> None:
        """Remember the best shape: the one that misses its constraints least, then the one of the least objective."""
        found = self.at(y)
        if not found.converged:
            return
        missed = self.missed(found)
        missed = 0.0 if missed <= LIMIT else missed
        value = self._objective(found)
        if np.isfinite(value) and (missed, value) < self.best[:2]:
            self.best = (missed, value, y.copy())
            if self.keep is not None:
                self.keep(self.unknowns.start + y * self.scale)
        if self.progress is not None:
            self.progress(self.evaluations, self.best[1])


def design(
    problem: Any,
    *,
    progress: Progress | None = None,
    cancelled: Callable[[], bool] | None = None,
    start: Any = None,
    keep: Keep | None = None,
) -> Design:
    """Find values of a problem's variables for which its equilibrium meets the goals best and the constraints at all.

    `problem` is a Problem, or a dict or JSON text of one. The search starts from the values of the scene, or from
    `start`: values (u,) of all unknowns in the order of the variables, as `keep` was called with. Always returns the
    best shape so far; failure is the status and the message. Raises InputError where the problem does not fit its
    scene.
    """
    problem = Problem.read(problem)
    search = Search(problem, progress, cancelled, start=start, keep=keep)
    method = chosen(search)
    ended: DesignStatus | None = None
    iterations, said = 0, ""
    if not search.first.converged:
        ended, said = DesignStatus.STALLED, f"The start has no equilibrium. {search.first.result.message}"
    else:
        try:
            iterations, ended, said = METHODS[method](search)
        except Stopped:
            ended, said = DesignStatus.CANCELLED, "Stopped by the caller."
    return _answer(search, method, iterations or search.evaluations, ended, said)


def chosen(search: Search) -> str:
    """The method that a problem is solved with."""
    problem = search.problem
    wanted = problem.settings.method
    aimed = all(goal.target is not None for goal in problem.goals)
    if wanted == "auto":
        if problem.constraints or not aimed:
            return "slsqp" if problem.constraints else "l-bfgs-b"
        values = sum(len(target) for target in search.targets if target is not None)
        return "levenberg_marquardt" if min(values, search.unknowns.count) > MANY else "least_squares"
    if problem.constraints and wanted != "slsqp":
        raise InputError("/settings/method", f"{wanted} takes no constraints; choose slsqp or auto")
    if wanted in ("least_squares", "levenberg_marquardt") and not aimed:
        raise InputError("/settings/method", f"{wanted} needs a target for each goal; choose l-bfgs-b or auto")
    return str(wanted)


def _answer(search: Search, method: str, iterations: int, ended: DesignStatus, said: str) -> Design:
    """The best shape, and how it stands to goals, constraints and bounds."""
    missed, value, y = search.best
    search.cancelled = None
    found = search.at(y if np.isfinite(missed) else np.zeros(search.unknowns.count))
    values = search.unknowns.start + (y * search.scale if np.isfinite(missed) else 0.0)
    constraints = _constraints(search, found)
    broken = [entry for entry in constraints if not all(np.atleast_1d(entry["met"]))]
    if broken and ended is not DesignStatus.CANCELLED:
        ended = DesignStatus.INFEASIBLE
    if not said:
        said = _sentence(search, ended, broken, iterations, value)
    return Design(
        status=ended,
        message=said,
        objective=float(value) if np.isfinite(value) else search._objective(found),
        iterations=iterations,
        method=method,
        variables=_variables(search, values),
        goals=_goals(search, found),
        constraints=constraints,
        result=found.result,
        scene=search.unknowns.scene(search.system.scene),
        warnings=warnings(found),
    )


def _sentence(search: Search, ended: DesignStatus, broken: list[dict[str, Any]], iterations: int, value: float) -> str:
    if broken:
        names = ", ".join(entry["name"] for entry in broken)
        return f"No values within the bounds were found that meet the constraints: {names}. These are the nearest."
    if ended is DesignStatus.MAX_ITERATIONS:
        return f"Stopped after {iterations} iterations with an objective of {value:.4g}; raise max_iterations to go on."
    return f"Found after {iterations} iterations: objective {value:.4g}."


def _variables(search: Search, values: Floats) -> list[dict[str, Any]]:
    unknowns, entries = search.unknowns, []
    for variable, part in zip(unknowns.variables, unknowns.slices, strict=True):
        own, slack = values[part], AT_BOUND * search.scale[part]
        bound = (own <= unknowns.lower[part] + slack) | (own >= unknowns.upper[part] - slack)
        shape = variable.shape
        single = variable.variable.tie == "all" and len(own) == 1
        value: Any = float(own[0]) if single else own.reshape(shape)
        at: Any = bool(bound[0]) if single else bound.reshape(shape)
        if isinstance(variable, Moved) and not single and variable.shifts and len(shape) == 2 and shape[0] == 1:
            value, at = own, bound
        entries.append({"name": variable.variable.title, "value": value, "at_bound": at})
    return entries


def _goals(search: Search, found: Equilibrium) -> list[dict[str, Any]]:
    entries = []
    for goal, values, target in zip(search.problem.goals, search.goal_values(found), search.targets, strict=True):
        name = goal.name or str(goal.quantity.kind_name)
        entries.append(
            {"name": name, "kind": goal.quantity.kind_name, "value": _single(values),
             "target": None if target is None else _single(target), "weight": goal.weight, "unit": goal.quantity.unit}
        )  # fmt: skip
    return entries


def _constraints(search: Search, found: Equilibrium) -> list[dict[str, Any]]:
    entries = []
    found_values = search.constraint_values(found)
    for constraint, values, limits, by in zip(
        search.problem.constraints, found_values, search.limits, search.sizes, strict=True
    ):
        met = beyond(values, *limits) <= LIMIT * by
        kind = constraint.quantity.kind_name
        entries.append(
            {
                "name": constraint.name or str(kind),
                "kind": kind,
                "value": _single(values),
                "met": bool(met.all()),
                "unit": constraint.quantity.unit,
            }
        )
    return entries


def _single(values: Floats) -> Any:
    """One value as a number, several as an array."""
    return float(values[0]) if len(values) == 1 else values
