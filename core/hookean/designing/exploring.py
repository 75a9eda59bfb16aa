"""Families of designs: the variables of a problem sampled between their bounds, an equilibrium for each sample, and the
samples of which none is better in every goal (the front of Pareto).

Samples are from scipy.stats.qmc: a grid, a Latin hypercube (McKay, Beckman and Conover 1979), or points of Sobol
(1967), scrambled by a seed.
"""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Executor
from dataclasses import dataclass, field
from functools import partial
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from hookean.designing.answer import once
from hookean.designing.checks import checked
from hookean.designing.equilibrium import Equilibrium, settle
from hookean.designing.problem import Problem
from hookean.designing.search import Search
from hookean.errors import InputError
from hookean.running.result import Result, plain

Floats = NDArray[np.float64]
Sampling = Literal["sobol", "latin_hypercube", "grid"]
SAMPLINGS = ("sobol", "latin_hypercube", "grid")
MOST = 100_000
CHUNK = 16  # samples that a worker gets at once


@dataclass(repr=False)
class Exploration:
    """Samples of a problem's variables and what their equilibria are like.

    `points` (n, u) are the values of all unknowns, `names` (u) what they are, with their units, `values` (n, g) one
    number for each goal: of a goal with a target the root of the sum of squares of what is missed, else the sum of its
    values, in its unit; less is better. `met` (n): whether the constraints are met. `statuses` (n) of the runs. `front`
    are the numbers of the samples at rest that meet the constraints and that no other such sample beats in all goals.
    """

    problem: Problem
    names: list[str]
    goals: list[str]
    units: list[str]
    points: Floats
    values: Floats
    met: NDArray[np.bool_]
    statuses: list[str]
    front: list[int] = field(default_factory=list)

    def result(self, number: int) -> Result:
        """The result of one sample, solved once more."""
        if not 0 <= number < len(self.points):
            raise InputError("number", f"{number} is not a sample; there are {len(self.points)}, counted from 0")
        search = checked(self.problem)
        return _rest(search, self.points[number]).result

    def rows(self) -> list[dict[str, Any]]:
        """A row for each sample: its values, status and goals by their names."""
        on = set(self.front)
        return [
            {"number": i, **dict(zip(self.names, map(float, self.points[i]), strict=True)), "status": self.statuses[i],
             **dict(zip(self.goals, map(float, self.values[i]), strict=True)), "met": bool(self.met[i]),
             "front": i in on}
            for i in range(len(self.points))
        ]  # fmt: skip

    def to_dict(self) -> dict[str, Any]:
        """As plain lists and numbers; None for goals of samples that have no equilibrium."""
        values = [[float(v) if np.isfinite(v) else None for v in row] for row in self.values]
        found = {name: getattr(self, name) for name in ("names", "goals", "units", "points", "statuses", "front")}
        return {**plain(found), "values": values, "met": self.met.tolist()}

    def __repr__(self) -> str:
        rest = sum(status == "converged" for status in self.statuses)
        return f"Exploration: {len(self.points)} samples, {rest} at rest, {len(self.front)} on the front."


def explore(
    problem: Any,
    count: int = 64,
    *,
    sampling: Sampling = "sobol",
    seed: int = 0,
    executor: Executor | None = None,
    progress: Callable[[int], None] | None = None,
) -> Exploration:
    """Sample the variables of a design problem between their bounds, and find the equilibrium of each sample.

    - `problem`: A Problem, or a dict or JSON text of one; every variable needs lower and upper.
    - `count`: How many samples; of a grid the most, with equal steps along each unknown.
    - `sampling`: `sobol`, `latin_hypercube` or `grid`; `seed` of the first two.
    - `executor`: Where samples are solved side by side, such as a ProcessPoolExecutor with the context `spawn` (threads
      of kernels do not outlive a fork); default: one after another. The same bits on any.
    - `progress`: Called with the number of samples that are done.

    Raises InputError where the problem does not fit its scene or has unbounded variables.
    """
    problem = Problem.read(problem)
    search = checked(problem)
    if not problem.goals:
        raise InputError("/goals", "an exploration needs at least one goal")
    points = samples(search, count, sampling, seed)
    chunks = [points[i : i + CHUNK] for i in range(0, len(points), CHUNK)]
    solve = partial(_solved, problem) if executor is not None else partial(_each, search)
    found: list[tuple[str, Floats, bool]] = []
    for rows in executor.map(solve, chunks) if executor is not None else map(solve, chunks):
        found += rows
        if progress is not None:
            progress(len(found))
    statuses = [status for status, _, _ in found]
    values, met = np.array([row for _, row, _ in found]), np.array([good for _, _, good in found])
    right = np.array([status == "converged" for status in statuses]) & met & np.isfinite(values).all(axis=1)
    kept = np.flatnonzero(right)
    front = [int(kept[i]) for i in pareto(values[kept])]
    goals, units = _called(search)
    return Exploration(problem, titles(search), goals, units, points, values, met, statuses, front)


def samples(search: Search, count: int, sampling: str, seed: int) -> Floats:
    """Values (n, u) of all unknowns between their bounds."""
    from scipy.stats import qmc

    if sampling not in SAMPLINGS:
        raise InputError("sampling", f"unknown {sampling!r}; known: {', '.join(SAMPLINGS)}")
    if isinstance(count, bool) or not isinstance(count, int) or not 1 <= count <= MOST:
        raise InputError("count", f"a whole number from 1 to {MOST} is expected")
    if isinstance(seed, bool) or not isinstance(seed, int) or seed < 0:
        raise InputError("seed", "a whole number from 0 is expected")
    lower, upper = _bounds(search)
    if sampling == "grid":
        return lower + (upper - lower) * _grid(len(lower), count)
    if sampling == "latin_hypercube":
        unit = qmc.LatinHypercube(len(lower), seed=seed).random(count)
    else:
        if len(lower) > qmc.Sobol.MAXDIM:
            raise InputError("sampling", f"sobol takes {qmc.Sobol.MAXDIM} unknowns at most; choose latin_hypercube")
        unit = qmc.Sobol(len(lower), seed=seed).random_base2((count - 1).bit_length())[:count]
    return np.asarray(lower + (upper - lower) * unit)


def _grid(unknowns: int, count: int) -> Floats:
    """Points of a grid in the unit cube, the last unknown fastest."""
    steps = int(count ** (1.0 / unknowns) + 1e-9)
    if steps < 2:
        raise InputError("count", f"a grid of {unknowns} unknowns has 2^{unknowns} samples at least; tie elements, or "
                         "choose sobol")  # fmt: skip
    axes = np.meshgrid(*[np.linspace(0.0, 1.0, steps)] * unknowns, indexing="ij")
    return np.stack([axis.ravel() for axis in axes], axis=1)


def _bounds(search: Search) -> tuple[Floats, Floats]:
    unknowns = search.unknowns
    for i, (variable, part) in enumerate(zip(unknowns.variables, unknowns.slices, strict=True)):
        for name, ends in (("lower", unknowns.lower[part]), ("upper", unknowns.upper[part])):
            if variable.variable.model_dump()[name] is None or not np.isfinite(ends).all():
                said = f"{variable.variable.title} is not bounded; an exploration samples between lower and upper"
                raise InputError(f"/variables/{i}/{name}", said)
    return unknowns.lower, unknowns.upper


def _solved(problem: Problem, points: Floats) -> list[tuple[str, Floats, bool]]:
    return _each(checked(problem), points)


def _each(search: Search, points: Floats) -> list[tuple[str, Floats, bool]]:
    """Status, goals and whether constraints are met, of each sample."""
    return [_one(search, values) for values in points]


def _one(search: Search, values: Floats) -> tuple[str, Floats, bool]:
    count = len(search.problem.goals)
    try:
        found = _rest(search, values)
    except InputError as error:
        return f"failed: {error.sentence}", np.full(count, np.nan), False
    if not found.converged:
        return str(found.result.status), np.full(count, np.nan), False
    own = search.aims.values(found)
    missed = search.aims.missed(own)
    row = [float(v.sum() if m is None else np.sqrt((m**2).sum())) for v, m in zip(own, missed, strict=True)]
    return "converged", np.array(row), search.missed(found) == 0.0


def _rest(search: Search, values: Floats) -> Equilibrium:
    """The equilibrium of one sample, from the drawn shape: it depends on no other sample."""
    state = search.system.start()
    search.unknowns.put(search.system, state, values)
    return settle(search.system, state)


def pareto(values: Floats) -> list[int]:
    """Numbers of the rows (n, g) that no other row beats: less in one goal and not more in any. In order of the first
    goal; of equal rows the first."""
    order = np.lexsort(values.T[::-1]) if len(values) else np.zeros(0, np.int64)
    kept: list[int] = []
    for i in order:
        if not any((values[j] <= values[i]).all() for j in kept):
            kept.append(int(i))
    return kept


def titles(search: Search) -> list[str]:
    """Names of all unknowns, each once, with their units."""
    found: list[str] = []
    units = search.system.scene.units
    for variable, part in zip(search.unknowns.variables, search.unknowns.slices, strict=True):
        count = part.stop - part.start
        name, unit = variable.variable.title, f" [{units.of(variable.unit)}]" if variable.unit else ""
        found += [f"{name}{unit}"] if count == 1 else [f"{name}[{i}]{unit}" for i in range(count)]
    return once(found)


def _called(search: Search) -> tuple[list[str], list[str]]:
    units = search.system.scene.units
    names, dimensions = [], []
    for goal in search.problem.goals:
        missed = " missed" if goal.aimed else ""
        names.append((goal.name or str(goal.quantity.kind_name)) + missed)
        dimensions.append(units.of(goal.quantity.unit) if goal.quantity.unit else "-")
    return once(names), dimensions
