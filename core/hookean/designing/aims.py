"""What the goals and constraints of a problem ask for, one number for each of their values."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hookean.designing.equilibrium import Equilibrium
from hookean.designing.problem import Goal, Problem
from hookean.designing.quantities.base import Quantity, largest_force, measured
from hookean.errors import InputError

Floats = NDArray[np.float64]
Range = tuple[Floats, Floats]

ROUNDED = 1e-12  # of a value: it is at its target


class Aims:
    """Ranges of goals, a target being one without width; None for those that are minimised. Limits of constraints."""

    def __init__(self, problem: Problem, first: Equilibrium) -> None:
        self.goals, self.constraints = problem.goals, problem.constraints
        values = [measured(g.quantity, first, f"/goals/{i}") for i, g in enumerate(self.goals)]
        limited = [measured(c.quantity, first, f"/constraints/{i}") for i, c in enumerate(self.constraints)]
        self.ranges = [_range(i, goal, own) for i, (goal, own) in enumerate(zip(self.goals, values, strict=True))]
        self.limits = [
            _ends(f"/constraints/{i}", constraint.lower, constraint.upper, own)
            for i, (constraint, own) in enumerate(zip(self.constraints, limited, strict=True))
        ]

    def values(self, found: Equilibrium) -> list[Floats]:
        """Values of all goals."""
        return [g.quantity.values(found, f"/goals/{i}") for i, g in enumerate(self.goals)]

    def constraint_values(self, found: Equilibrium) -> list[Floats]:
        """Values of all constraints."""
        return [c.quantity.values(found, f"/constraints/{i}") for i, c in enumerate(self.constraints)]

    def quantities(self) -> list[tuple[Quantity, str]]:
        """Quantities of goals with targets, and their pointers."""
        return [(goal.quantity, f"/goals/{i}") for i, goal in enumerate(self.goals) if self.ranges[i] is not None]

    def missed(self, values: list[Floats]) -> list[Floats | None]:
        """Values less their targets; None for goals that are minimised."""
        pairs = zip(values, self.ranges, strict=True)
        return [None if among is None else own - np.clip(own, *among) for own, among in pairs]

    def residuals(self, found: Equilibrium) -> Floats:
        """sqrt(weight) (value - target) of all goals with targets."""
        pairs = zip(self.goals, self.missed(self.values(found)), strict=True)
        parts = [np.sqrt(goal.weight) * missed for goal, missed in pairs if missed is not None]
        return np.concatenate(parts) if parts else np.zeros(0)

    def rounding(self, found: Equilibrium) -> float:
        """The objective where all values are at their targets but for rounding; less than any, if one is minimised."""
        if any(among is None for among in self.ranges):
            return -np.inf
        whole = 0.0
        for i, (goal, own) in enumerate(zip(self.goals, self.values(found), strict=True)):
            forces = largest_force(found) if goal.quantity.unit == "force" else 0.0
            least = max(forces, goal.quantity.differs_from(found, f"/goals/{i}"))
            whole += goal.weight * float(np.maximum(own**2, least**2).sum())
        return ROUNDED**2 * whole

    def weights(self, found: Equilibrium) -> Floats:
        """The weight (k,) of each residual; 0 for values within their ranges."""
        parts = [np.zeros(0)]
        for goal, among, own in zip(self.goals, self.ranges, self.values(found), strict=True):
            if among is not None:
                within = (among[0] < among[1]) & (own >= among[0]) & (own <= among[1])
                parts.append(np.where(within, 0.0, np.sqrt(goal.weight)))
        return np.concatenate(parts)

    def objectives(self, found: Equilibrium) -> list[float]:
        """The part of each goal in the objective."""
        values = self.values(found)
        return [
            goal.weight * float((own if missed is None else missed**2).sum())
            for goal, own, missed in zip(self.goals, values, self.missed(values), strict=True)
        ]

    def slopes(self, found: Equilibrium) -> list[Floats]:
        """Derivatives of these parts by the values."""
        values = self.values(found)
        return [
            goal.weight * (np.ones(len(own)) if missed is None else 2.0 * missed)
            for goal, own, missed in zip(self.goals, values, self.missed(values), strict=True)
        ]

    @property
    def size(self) -> float:
        """What residuals are measured by: the targets."""
        squares = 0.0
        for goal, among in zip(self.goals, self.ranges, strict=True):
            for side in among or ():
                squares += 0.5 * goal.weight * float((np.where(np.isfinite(side), side, 0.0) ** 2).sum())
        return float(np.sqrt(squares)) or 1.0


def _range(number: int, goal: Goal, values: Floats) -> Range | None:
    """The range (k,) of each value of a goal; None: it is minimised."""
    if not goal.aimed:
        return None
    if goal.target is None:
        return _ends(f"/goals/{number}", goal.lower, goal.upper, values)
    given = np.asarray(goal.target, dtype=np.float64)
    axes = len(getattr(goal.quantity, "axes", "x"))
    if given.size == len(values):
        target = given.ravel()
    elif given.size == 1:
        target = np.full(len(values), float(given.ravel()[0]))
    elif given.size == axes and len(values) % axes == 0:
        target = np.tile(given.ravel(), len(values) // axes)
    else:
        said = f"{given.size} targets for {len(values)} values; give one or one for each"
        raise InputError(f"/goals/{number}/target", said)
    return target, target


def _ends(pointer: str, lower: float | Floats | None, upper: float | Floats | None, values: Floats) -> Range:
    """The least and the largest values allowed."""
    found = []
    for name, given, default in (("lower", lower, -np.inf), ("upper", upper, np.inf)):
        array = np.asarray(default if given is None else given, dtype=np.float64)
        if array.ndim and len(array) != len(values):
            said = f"{len(array)} limits for {len(values)} values; give one or one for each"
            raise InputError(f"{pointer}/{name}", said)
        found.append(np.broadcast_to(array, values.shape))
    if (found[0] > found[1]).any():
        raise InputError(f"{pointer}/lower", "lower is more than upper; no value can meet both")
    return found[0], found[1]
