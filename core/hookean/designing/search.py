"""The search: variables of a scene for which its equilibrium meets goals and constraints.

Where all goals have targets least squares by trust regions with bounds (Branch, Coleman and Li 1999), where some are
minimised L-BFGS-B (Byrd and others 1995), with constraints sequential quadratic programming (Kraft 1988), all from
SciPy, and with many constraints an augmented Lagrangian, with exact derivatives through equilibrium.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from hookean.designing.aims import Aims
from hookean.designing.answer import Design, DesignStatus
from hookean.designing.elsewhere import AGAIN, other_start
from hookean.designing.equilibrium import Equilibrium, follow, settle
from hookean.designing.factors import Orders
from hookean.designing.gains import at_minimum
from hookean.designing.limits import FAR, LIMIT, beyond, size
from hookean.designing.linearised import Linearised
from hookean.designing.located import system_of
from hookean.designing.methods import METHODS, Stopped, Unbounded
from hookean.designing.polish import STEPS, polish
from hookean.designing.problem import Problem
from hookean.designing.quantities.base import Quantity, largest_force
from hookean.designing.second_look import SADDLE, SYMMETRIC, UNMOVED, saddle, stationary, unmoved
from hookean.designing.sensitivity import gradients, jacobian
from hookean.designing.summary import answer
from hookean.designing.unknowns import Unknowns
from hookean.errors import InputError
from hookean.system.system import System
from hookean.values.columns import LARGEST

Floats = NDArray[np.float64]
EDGE = 1e6  # of its size: no search goes further
MOST = 0.5 * LARGEST  # nor beyond this value, whose differences are numbers that forces take
LIMITS = 100  # values of constraints, four times as many where goals have no roots, above which SLSQP takes long
FALL = 1e-6  # part of the objective that a search from elsewhere has to gain
SLACK = 2e-6  # part of the objective, by which the best may seem better than where a method rests
SLIGHT = 1e-3  # part of the largest force: forces below are measured by that
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
        self.system: System = system_of(problem.scene)
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
        self._best_x: Floats | None = None
        self.evaluations, self.used = 0, ""
        self.notes: list[str] = []
        """Sentences for the answer."""
        self.best: tuple[float, float, Floats] = (np.inf, np.inf, self.unknowns.start.copy())
        self.first = self.at(np.zeros(self.unknowns.count))
        self.aims = Aims(problem, self.first)
        first = self.aims.constraint_values(self.first)
        self.sizes = [
            size(values, *limits, self.sized(constraint.quantity, self.first, f"/constraints/{i}"))
            for i, (constraint, values, limits) in enumerate(
                zip(problem.constraints, first, self.aims.limits, strict=True)
            )
        ]
        self.first_value = abs(self._objective(self.first))
        self.met = self.aims.rounding(self.first)
        self.note(np.zeros(self.unknowns.count))

    @property
    def bounds(self) -> tuple[Floats, Floats]:
        """Bounds of scaled unknowns."""
        unknowns = self.unknowns
        return (unknowns.lower - unknowns.start) / self.scale, (unknowns.upper - unknowns.start) / self.scale

    @property
    def edges(self) -> tuple[Floats, Floats]:
        """The same where nothing else keeps a search from going on without end, or to numbers that nothing takes."""
        (lower, upper), start = self.bounds, self.unknowns.start
        below, above = np.minimum(start, -MOST), np.maximum(start, MOST)  # a start beyond is kept
        least, most = (below - start) / self.scale, (above - start) / self.scale
        return np.maximum(lower, np.maximum(least, -EDGE)), np.minimum(upper, np.minimum(most, EDGE))

    def given(self, y: Floats) -> Floats:
        """Values (u,) of the unknowns; rounding does not take them beyond their bounds."""
        unknowns = self.unknowns
        return np.asarray(np.clip(unknowns.start + y * self.scale, unknowns.lower, unknowns.upper))

    def at(self, y: Floats) -> Equilibrium:
        """The equilibrium at scaled unknowns; if the run found none, its result reports that."""
        if self._at is not None and np.array_equal(self._at, y) and self.found is not None:
            return self.found
        if self.cancelled is not None and self.cancelled():
            raise Stopped
        if self._resting is not None:
            self.state.x = self._resting.copy()
        try:
            self.unknowns.put(self.system, self.state, self.given(y))
        except InputError:
            if np.abs(y).max() > FAR:  # no force takes numbers of any size
                raise Unbounded(self._endless(y)) from None
            raise
        followed = follow(self.found) if self.found is not None and self.found.converged else None
        self.found = followed or settle(self.system, self.state, self.orders)
        self._at = y.copy()
        if self.found.converged:
            self._resting = self.state.x.copy()
        self.evaluations += 1
        return self.found

    def at_best(self) -> Equilibrium:
        """The equilibrium at the best so far, from its own shape: there may be others, also at the same values."""
        pairs = ((self._at, self.best[2]), (self.state.x, self._best_x))
        if not all(a is not None and b is not None and np.array_equal(a, b) for a, b in pairs):
            self._resting, self.found = self._best_x, None
        return self.at(self.best[2])

    def residuals(self, y: Floats) -> Floats:
        """sqrt(weight) (value - target) of all goals with targets."""
        found = self.at(y)
        whole = self.aims.residuals(found)
        self.note(y)
        if not (found.converged and np.isfinite(whole).all()):
            return np.full(len(whole), 1e3 * (1.0 + np.sqrt(self.best[1] if np.isfinite(self.best[1]) else 1.0)))
        return whole

    def slopes(self, y: Floats) -> Floats:
        """Derivatives (k, u) of the residuals by scaled unknowns."""
        found = self.at(y)
        by = jacobian(found, self.unknowns, self.aims.quantities())
        return np.nan_to_num(self.aims.weights(found)[:, None] * by * self.scale)

    def linearised(self, y: Floats) -> Linearised:
        """The same as sparse parts."""
        found, aims = self.at(y), self.aims
        return Linearised(found, self.unknowns, aims.quantities(), aims.weights(found), self.scale, self.orders)

    def objective(self, y: Floats) -> float:
        """The objective; where there is no equilibrium, more than any so far."""
        found = self.at(y)
        value = self._objective(found)
        self.note(y)
        if found.converged and np.isfinite(value):
            return value
        return float(abs(self.best[1]) * 1e3 + 1e3) if np.isfinite(self.best[1]) else 1e30

    def _objective(self, found: Equilibrium) -> float:
        return float(sum(self.aims.objectives(found)))

    def check_end(self) -> None:
        """Raise Unbounded where the best so far is no minimum and a variable has left all sizes."""
        missed, _, y = self.best
        if missed == 0.0 and np.abs(y).max() > FAR:
            falls, much = self._falls(y)
            if much or (falls and not at_minimum(self)):
                raise Unbounded(self._endless(y))
        if missed == 0.0 and np.abs(self.at_best().x).max() > FAR * self.system.size:
            slope = self.gradient(y)
            name, way = self._called(int(np.argmax(np.abs(slope)))), "falls" if slope.min() > 0.0 else "varies"
            raise Unbounded(f"The shape grows beyond {FAR:g} times its size as {name} {way}; give that bounds")

    def _falls(self, y: Floats) -> tuple[bool, bool]:
        """Whether the objective is less twice as far out, too, or nothing is at rest there; and whether it is less by a
        tenth: no slope is slight beside a value that large."""
        kept = self.best[1]
        found = self.at(np.clip(2.0 * y, *self.bounds))
        fall = kept - self._objective(found) if found.converged and self.missed(found) == 0.0 else 0.0
        self.at_best()
        return not found.converged or fall > 0.0, fall > 0.1 * abs(kept)

    def _called(self, number: int) -> str:
        """The variable of an unknown."""
        parts = zip(self.unknowns.names, self.unknowns.slices, strict=True)
        return next(name for name, part in parts if part.start <= number < part.stop)

    def _endless(self, y: Floats) -> str:
        """Which variable has left all sizes, as a sentence."""
        number = int(np.argmax(np.abs(y)))
        name, way = self._called(number), "grows" if y[number] > 0.0 else "falls"
        said = f"{name} {way} beyond {FAR:g} times its size; give it bounds, or the goals targets"
        return f"The objective falls without end: {said}"

    def gradient(self, y: Floats) -> Floats:
        """Its derivatives by scaled unknowns."""
        found = self.at(y)
        kept = [(g.quantity, f"/goals/{i}") for i, g in enumerate(self.problem.goals)]
        return np.nan_to_num(gradients(found, self.unknowns, kept, self.aims.slopes(found)) * self.scale)

    def sized(self, quantity: Quantity, found: Equilibrium, pointer: str) -> float:
        """What values of a quantity are measured by where they are small: the model's size for lengths, a part of its
        largest force for forces, the values themselves for their differences."""
        natural = float(self.system.size) if quantity.unit == "length" else 0.0
        if quantity.unit == "force":
            natural = SLIGHT * largest_force(found)
        return max(natural, quantity.differs_from(found, pointer))

    def missed(self, found: Equilibrium) -> float:
        """How far constraints are missed: the root of the sum of squares, by the sizes of their values [-]; 0 where
        none is missed by more than `LIMIT`."""
        kept = zip(self.aims.constraint_values(found), self.aims.limits, self.sizes, strict=True)
        parts = np.concatenate([np.zeros(0), *(beyond(values, *limits) / by for values, limits, by in kept)])
        return float(np.linalg.norm(parts)) if parts.max(initial=0.0) > LIMIT else 0.0

    def rest_at(self, y: Floats) -> None:
        """Take a shape at which a method has come to rest for the best: others may only seem better by what they miss
        their constraints by."""
        found = self.at(y)
        value = self._objective(found)
        slack = SLACK * max(abs(value), abs(self.best[1]))
        if found.converged and self.missed(found) == 0.0 and value - self.best[1] <= slack:
            self.take(y)

    def take(self, y: Floats) -> None:
        """Take a shape for the best, which it is to its last digits, unless it misses a limit."""
        found = self.at(y)
        if found.converged and self.missed(found) == 0.0:
            self.best, self._best_x = (0.0, self._objective(found), y.copy()), self.state.x.copy()

    def note(self, y: Floats) -> None:
        """Remember the best shape: the one that misses its constraints least, then the one of the least objective."""
        found = self.at(y)
        if not found.converged:
            return
        missed = self.missed(found)
        value = self._objective(found)
        if np.isfinite(value) and (missed, value) < self.best[:2]:
            self.best, self._best_x = (missed, value, y.copy()), self.state.x.copy()
            if self.keep is not None:
                self.keep(self.given(y))
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
    search = Search(Problem.read(problem), progress, cancelled, start=start, keep=keep)
    ended = _ended(search)
    if ended.elsewhere is not None:
        again = _from(search, ended.elsewhere, keep)
        other = _ended(again)
        if again.best[:2] < (search.best[0], search.best[1] - FALL * abs(search.best[1])):
            again.notes = [AGAIN.format(ended.still)]
            search, ended = again, other._replace(iterations=ended.iterations + other.iterations)
    return answer(search, ended.method, ended.iterations, ended.status, ended.said)


class Ended(NamedTuple):
    """How a search ended; `elsewhere`: values (u,) from which another one may change what none changes, `still`."""

    method: str
    iterations: int
    status: DesignStatus
    said: str
    elsewhere: Floats | None
    still: str


def _ended(search: Search) -> Ended:
    """The search by the method of its problem."""
    method = chosen(search)
    elsewhere: Floats | None = None
    status, still = DesignStatus.STALLED, ""
    iterations, said = 0, f"The start has no equilibrium. {search.first.result.message}"
    if search.first.converged:
        try:
            iterations, status, said = METHODS[method](search)
            if method in ("l-bfgs-b", "slsqp", "augmented_lagrangian"):
                search.check_end()
            if status in (DesignStatus.CONVERGED, DesignStatus.STALLED):
                iterations, status, said = _polished(search, iterations, status, said)
            status, said = _looked_again(search, status, said)
            if status in (DesignStatus.CONVERGED, DesignStatus.INFEASIBLE) and not said:
                elsewhere, still = other_start(search)
        except Stopped:
            status, said = DesignStatus.CANCELLED, "Stopped by the caller."
        except Unbounded as error:
            status, said = DesignStatus.UNBOUNDED, f"{error}."
            if search.best[0] > 0.0:  # what grows are penalties
                status, said = DesignStatus.INFEASIBLE, ""
    return Ended(search.used or method, iterations or search.evaluations, status, said, elsewhere, still)


def _polished(search: Search, iterations: int, ended: DesignStatus, said: str) -> tuple[int, DesignStatus, str]:
    """The last digits: sought until steps gain little, or all iterations are used."""
    while polish(search):
        iterations += STEPS
        if iterations >= search.problem.settings.max_iterations:
            return iterations, DesignStatus.MAX_ITERATIONS, ""
    return iterations, ended, said


def _looked_again(search: Search, ended: DesignStatus, said: str) -> tuple[DesignStatus, str]:
    """Whether the end is what it seems."""
    if ended is DesignStatus.STALLED and at_minimum(search):
        ended, said = DesignStatus.CONVERGED, ""
    if ended is DesignStatus.CONVERGED and stationary(search):
        ended, said = DesignStatus.STALLED, SYMMETRIC
    if ended is DesignStatus.CONVERGED and saddle(search):
        ended, said = DesignStatus.STALLED, SADDLE
    if ended is DesignStatus.INFEASIBLE and unmoved(search):
        ended, said = DesignStatus.STALLED, UNMOVED
    return ended, said


def _from(before: Search, start: Floats, keep: Keep | None) -> Search:
    """A search of the same problem from other values; it shows and keeps what is better than the one before."""
    (missed, least, _), progress = before.best, before.progress

    def better(values: Floats) -> None:
        if keep is not None and again.best[:2] < (missed, least):
            keep(values)

    def shown(iteration: int, value: float) -> None:
        if progress is not None:
            progress(before.evaluations + iteration, value if missed > 0.0 else min(least, value))

    again = Search(before.problem, shown, before.cancelled, start=start)
    again.keep = better
    return again


def chosen(search: Search) -> str:
    """The method that a problem is solved with."""
    problem = search.problem
    wanted = problem.settings.method
    aimed = all(goal.aimed for goal in problem.goals)
    if wanted == "auto":
        if problem.constraints:
            limits = sum(len(low) for low, _ in search.aims.limits)
            roots = all(goal.aimed or goal.quantity.positive is not None for goal in problem.goals)
            return "augmented_lagrangian" if limits > (LIMITS if roots else 4 * LIMITS) else "slsqp"
        if not aimed:
            return "l-bfgs-b"
        values = len(search.aims.weights(search.first))
        return "levenberg_marquardt" if min(values, search.unknowns.count) > MANY else "least_squares"
    if problem.constraints and wanted not in ("slsqp", "augmented_lagrangian"):
        said = f"{wanted} takes no constraints; choose slsqp, augmented_lagrangian or auto"
        raise InputError("/settings/method", said)
    if wanted == "augmented_lagrangian" and not problem.constraints:
        raise InputError("/settings/method", f"{wanted} needs constraints; choose l-bfgs-b or auto")
    if wanted in ("least_squares", "levenberg_marquardt") and not aimed:
        raise InputError("/settings/method", f"{wanted} needs a target for each goal; choose l-bfgs-b or auto")
    return str(wanted)
