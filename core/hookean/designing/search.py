"""The search: variables of a scene for which its equilibrium meets goals and constraints.

Least squares by trust regions where all goals have targets (Branch, Coleman and Li 1999, with bounds), L-BFGS-B (Byrd and
others 1995) where some are minimised, sequential quadratic programming (Kraft 1988) with constraints; all from SciPy,
with exact derivatives through equilibrium.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.designing.equilibrium import Equilibrium, settle
from hookean.designing.problem import Goal, Problem
from hookean.designing.sensitivity import gradients, jacobian, warnings
from hookean.designing.unknowns import Moved, Unknowns
from hookean.errors import InputError
from hookean.running.result import Result, plain
from hookean.scene.scene import Scene
from hookean.system.system import System, compile

Floats = NDArray[np.float64]
Progress = Callable[[int, float], None]
"""Called with the iteration and the best objective so far."""

LIMIT = 1e-6  # part of a value, and of the largest of its kind, by which a constraint may be missed
AT_BOUND = 1e-9  # of an unknown's scale
DENSE = 4_000_000  # entries of a matrix of derivatives


class DesignStatus(StrEnum):
    """How a search ended."""

    CONVERGED = "converged"
    INFEASIBLE = "infeasible"
    MAX_ITERATIONS = "max_iterations"
    STALLED = "stalled"
    CANCELLED = "cancelled"


@dataclass(repr=False)
class Design:
    """The best that a search found: values of `variables`, of `goals` and `constraints`, and the `result` of the scene
    with them. The objective is the sum of weight (value - target)² over goals with a target and of weight x value over
    the others. `gain` of a bound or constraint is by how much the objective falls for each unit that it is eased."""

    status: DesignStatus
    message: str
    objective: float
    iterations: int
    method: str
    variables: list[dict[str, Any]]
    goals: list[dict[str, Any]]
    constraints: list[dict[str, Any]]
    result: Result
    scene: Scene
    warnings: list[str] = field(default_factory=list)

    def __repr__(self) -> str:
        lines = [f"Design: {self.status}. {self.message}"]
        lines += [f"  {entry['name']}: {_short(entry['value'])}" for entry in self.variables]
        lines += [f"  goal {entry['name']}: {_short(entry['value'])}, target {_short(entry['target'])}" for entry in self.goals]
        return "\n".join(lines)

    def to_dict(self) -> dict[str, Any]:
        """As plain lists and numbers, by the names of the HTTP answer."""
        return {
            "status": str(self.status),
            "message": self.message,
            "objective": self.objective,
            "iterations": self.iterations,
            "method": self.method,
            "variables": plain(self.variables),
            "goals": plain(self.goals),
            "constraints": plain(self.constraints),
            "warnings": self.warnings,
            "result": self.result.to_dict(),
            "scene": self.scene.model_dump(mode="json"),
        }


def _short(value: Any) -> str:
    """A few numbers as text."""
    flat = np.atleast_1d(np.asarray(np.nan if value is None else value, dtype=np.float64)).ravel()
    shown = ", ".join(f"{v:.4g}" for v in flat[:6])
    return shown if len(flat) <= 6 else f"{shown}, ... ({len(flat)})"


class Stopped(Exception):
    """The caller ended the search."""


class Search:
    """The functions that methods ask for, of unknowns in units of their scale, and the best shape so far."""

    def __init__(self, problem: Problem, progress: Progress | None, cancelled: Callable[[], bool] | None) -> None:
        self.problem, self.progress, self.cancelled = problem, progress, cancelled
        self.system: System = compile(problem.scene)
        if missing := self.system.no_tangent(sparse=False):
            raise InputError("/scene/forces", f"{missing}, so nothing can be differentiated through its equilibrium")
        self.unknowns = Unknowns(problem, self.system)
        self.state = self.system.start()
        self.scale = self.unknowns.scale
        self.found: Equilibrium | None = None
        self._at: Floats | None = None
        self._resting: Floats | None = None
        self.evaluations = 0
        self.best: tuple[float, float, Floats] = (np.inf, np.inf, self.unknowns.start.copy())
        self.first = self.at(np.zeros(self.unknowns.count))
        self.targets = [self._target(i, g) for i, g in enumerate(problem.goals)]
        self.limits = [self._limits(i) for i in range(len(problem.constraints))]
        self._note(np.zeros(self.unknowns.count))

    def at(self, y: Floats) -> Equilibrium:
        """The equilibrium at scaled unknowns; where there is none, the run's own result says so."""
        if self._at is not None and np.array_equal(self._at, y) and self.found is not None:
            return self.found
        if self.cancelled is not None and self.cancelled():
            raise Stopped
        if self._resting is not None:
            self.state.x = self._resting.copy()
        self.unknowns.put(self.system, self.state, self.unknowns.start + y * self.scale)
        self.found = settle(self.system, self.state)
        self._at = y.copy()
        if self.found.result.converged:
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
        raise InputError(f"/goals/{number}/target", f"{given.size} targets for {len(values)} values; give one or one for each")

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
        if not (found.result.converged and np.isfinite(whole).all()):
            return np.full(len(whole), 1e3 * (1.0 + np.sqrt(self.best[1] if np.isfinite(self.best[1]) else 1.0)))
        return whole

    def slopes(self, y: Floats) -> Floats:
        """Derivatives (k, u) of the residuals by scaled unknowns."""
        goals = self.problem.goals
        kept = [(g.quantity, f"/goals/{i}") for i, g in enumerate(goals) if self.targets[i] is not None]
        found = jacobian(self.at(y), self.unknowns, kept)
        weights = [
            np.full(len(target), np.sqrt(g.weight))
            for g, target in zip(goals, self.targets, strict=True)
            if target is not None
        ]
        return np.nan_to_num(np.concatenate(weights)[:, None] * found * self.scale)

    def objective(self, y: Floats) -> float:
        """The objective; where there is no equilibrium, more than any so far."""
        found = self.at(y)
        value = self._objective(found)
        self._note(y)
        if found.result.converged and np.isfinite(value):
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
        for values, (lower, upper) in zip(self.constraint_values(found), self.limits, strict=True):
            worst = max(worst, float((_beyond(values, lower, upper) / _sizes(values, lower, upper)).max(initial=0.0)))
        return worst

    def _note(self, y: Floats) -> None:
        """Remember the best shape: the one that misses its constraints least, then the one of the least objective."""
        found = self.at(y)
        if not found.result.converged:
            return
        missed = self.missed(found)
        missed = 0.0 if missed <= LIMIT else missed
        value = self._objective(found)
        if np.isfinite(value) and (missed, value) < self.best[:2]:
            self.best = (missed, value, y.copy())
        if self.progress is not None:
            self.progress(self.evaluations, self.best[1])


def _beyond(values: Floats, lower: Floats, upper: Floats) -> Floats:
    """By how much values miss their limits; 0 where they do not."""
    return np.maximum(np.maximum(lower - values, values - upper), 0.0)


def _sizes(values: Floats, lower: Floats, upper: Floats) -> Floats:
    """The size of each value or its limits, at least a thousandth of the largest."""
    limits = [np.where(np.isfinite(limit), np.abs(limit), 0.0) for limit in (lower, upper)]
    sizes = np.maximum(np.abs(values), np.maximum(*limits))
    return np.asarray(np.maximum(sizes, 1e-3 * sizes.max(initial=0.0)) + np.finfo(float).tiny)


def design(
    problem: Any, *, progress: Progress | None = None, cancelled: Callable[[], bool] | None = None
) -> Design:
    """Find values of a problem's variables for which its equilibrium meets the goals best and the constraints at all.

    `problem` is a Problem, or a dict or JSON text of one. Always returns the best shape so far; failure is the status
    and the message. Raises InputError where the problem does not fit its scene.
    """
    problem = Problem.read(problem)
    search = Search(problem, progress, cancelled)
    method = _chosen(problem)
    ended: DesignStatus | None = None
    iterations, said = 0, ""
    if not search.first.result.converged:
        ended, said = DesignStatus.STALLED, f"The start has no equilibrium. {search.first.result.message}"
    else:
        try:
            iterations, ended, said = _METHODS[method](search)
        except Stopped:
            ended, said = DesignStatus.CANCELLED, "Stopped by the caller."
    return _answer(search, method, iterations or search.evaluations, ended, said)


def _chosen(problem: Problem) -> str:
    """The method that a problem is solved with."""
    wanted = problem.settings.method
    aimed = all(goal.target is not None for goal in problem.goals)
    if wanted == "auto":
        return "slsqp" if problem.constraints else "least_squares" if aimed else "l-bfgs-b"
    if problem.constraints and wanted != "slsqp":
        raise InputError("/settings/method", f"{wanted} takes no constraints; choose slsqp or auto")
    if wanted == "least_squares" and not aimed:
        raise InputError("/settings/method", "least_squares needs a target for each goal; choose l-bfgs-b or auto")
    return str(wanted)


Ended = tuple[int, DesignStatus, str]


def _bounds(search: Search) -> tuple[Floats, Floats]:
    unknowns = search.unknowns
    return (unknowns.lower - unknowns.start) / search.scale, (unknowns.upper - unknowns.start) / search.scale


def _least_squares(search: Search) -> Ended:
    from scipy.optimize import least_squares

    settings, (lower, upper) = search.problem.settings, _bounds(search)
    wide = lower < upper
    if not wide.all():  # what cannot vary is left out
        upper = np.where(wide, upper, lower + AT_BOUND)
    start = np.clip(np.zeros(search.unknowns.count), lower, upper)
    found = least_squares(
        search.residuals, start, search.slopes, bounds=(lower, upper), method="trf",
        ftol=settings.tolerance, xtol=settings.tolerance, gtol=settings.tolerance * 1e-4, max_nfev=settings.max_iterations,
    )  # fmt: skip
    ended = DesignStatus.MAX_ITERATIONS if found.status == 0 else DesignStatus.CONVERGED
    return int(found.njev), ended, ""


def _lbfgsb(search: Search) -> Ended:
    from scipy.optimize import minimize

    settings = search.problem.settings
    found = minimize(
        search.objective, np.zeros(search.unknowns.count), jac=search.gradient, method="L-BFGS-B",
        bounds=list(zip(*_bounds(search), strict=True)),
        options={"maxiter": settings.max_iterations, "ftol": settings.tolerance * 1e-3, "gtol": 1e-12, "maxcor": 30,
                 "maxfun": 20 * settings.max_iterations},
    )  # fmt: skip
    ended = DesignStatus.MAX_ITERATIONS if found.status == 1 else DesignStatus.CONVERGED
    return int(found.nit), ended, ""


def _slsqp(search: Search) -> Ended:
    from scipy.optimize import minimize

    settings = search.problem.settings
    size = abs(search.objective(np.zeros(search.unknowns.count))) or 1.0
    rows = [
        (row, limit, sign)
        for row, (lower, upper) in enumerate(zip(*(np.concatenate(side) for side in zip(*search.limits, strict=True)), strict=True))
        for limit, sign in ((lower, 1.0), (upper, -1.0))
        if np.isfinite(limit) and not (lower == upper and sign < 0.0)
    ] if search.limits else []  # fmt: skip
    flat = np.concatenate([_sizes(v, *limits) for v, limits in zip(search.constraint_values(search.first), search.limits, strict=True)]) if search.limits else np.zeros(0)
    both = np.concatenate([low == up for low, up in search.limits]) if search.limits else np.zeros(0, bool)
    which = np.array([row for row, _, _ in rows], dtype=np.int64)
    limit, sign = np.array([r[1] for r in rows]), np.array([r[2] for r in rows])
    quantities = [(c.quantity, f"/constraints/{i}") for i, c in enumerate(search.problem.constraints)]

    def margins(y: Floats) -> Floats:
        found = search.at(y)
        values = np.concatenate(search.constraint_values(found))
        return np.asarray(sign * (values[which] - limit) / flat[which])

    def slopes(y: Floats) -> Floats:
        found = jacobian(search.at(y), search.unknowns, quantities) * search.scale
        return np.nan_to_num((sign / flat[which])[:, None] * found[which])

    constraints = []
    for kind, chosen in (("eq", both[which]), ("ineq", ~both[which])) if len(rows) else ():
        if chosen.any():
            constraints.append(
                {"type": kind, "fun": lambda y, c=chosen: margins(y)[c], "jac": lambda y, c=chosen: slopes(y)[c]}
            )
    found = minimize(
        lambda y: search.objective(y) / size, np.zeros(search.unknowns.count), jac=lambda y: search.gradient(y) / size,
        method="SLSQP", bounds=list(zip(*_bounds(search), strict=True)), constraints=constraints,
        options={"maxiter": settings.max_iterations, "ftol": settings.tolerance * 1e-3},
    )  # fmt: skip
    ended = DesignStatus.MAX_ITERATIONS if found.status == 9 else DesignStatus.CONVERGED
    return int(found.nit), ended, ""


_METHODS: dict[str, Callable[[Search], Ended]] = {
    "least_squares": _least_squares,
    "l-bfgs-b": _lbfgsb,
    "slsqp": _slsqp,
}


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


def _sentence(
    search: Search, ended: DesignStatus, broken: list[dict[str, Any]], iterations: int, value: float
) -> str:
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
        name = goal.name or str(goal.quantity.kind)  # type: ignore[attr-defined]
        entries.append(
            {"name": name, "kind": goal.quantity.kind, "value": _single(values),  # type: ignore[attr-defined]
             "target": None if target is None else _single(target), "weight": goal.weight}
        )  # fmt: skip
    return entries


def _constraints(search: Search, found: Equilibrium) -> list[dict[str, Any]]:
    entries = []
    for constraint, values, (lower, upper) in zip(
        search.problem.constraints, search.constraint_values(found), search.limits, strict=True
    ):
        met = _beyond(values, lower, upper) <= LIMIT * _sizes(values, lower, upper)
        kind = constraint.quantity.kind  # type: ignore[attr-defined]
        entries.append(
            {"name": constraint.name or str(kind), "kind": kind, "value": _single(values), "met": bool(met.all())}
        )
    return entries


def _single(values: Floats) -> Any:
    """One value as a number, several as an array."""
    return float(values[0]) if len(values) == 1 else values
