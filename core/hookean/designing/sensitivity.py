"""Derivatives through equilibrium, by the adjoint: one more solve with the tangent that is in factors already.

For a value g(x, u) at f(x, u) = 0, with K = -df/dx: K^T y = dg/dx on the free motions, and
dg/du = y . df/du + (dg/dx - K^T y) . dx_h/du + dg/du at fixed positions, where held particles move by dx_h.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.designing.equilibrium import Equilibrium, settle
from hookean.designing.kinks import kinks
from hookean.designing.located import system_of
from hookean.designing.problem import Problem
from hookean.designing.quantities.base import Quantity, measured
from hookean.designing.unknowns import Unknowns
from hookean.errors import InputError
from hookean.running.result import Result
from hookean.scene.load_cases import asleep
from hookean.stability.equilibrium import Stability

Floats = NDArray[np.float64]

ALONG = 1e-6  # part of a slope by places that counts as one along a film


@dataclass
class Sensitivity:
    """`value` of the goals, each by its weight, and its `gradient`: an array for each variable, in units of the goal by
    units of the variable. `values` are those of each goal. `warnings` are sentences where the gradient is one-sided or
    the shape is not stable."""

    value: float
    gradient: list[Floats]
    values: list[Floats]
    names: list[str]
    warnings: list[str]
    result: Result

    def to_dict(self) -> dict[str, Any]:
        """As plain lists and numbers."""
        return {
            "value": self.value,
            "gradient": [each.tolist() for each in self.gradient],
            "values": [each.tolist() for each in self.values],
            "variables": self.names,
            "warnings": self.warnings,
        }


def sensitivity(problem: Any, goals: Any = None, variables: Any = None) -> Sensitivity:
    """Derivatives of the goals of a problem at its scene's own equilibrium, by all its variables.

    `problem` is a Problem or a dict of one, or a scene with `goals` and `variables` apart. The value is the sum of
    weight x value over all values of all goals, without their targets. Raises InputError where the problem does not fit
    the scene or the tangent at the equilibrium is singular.
    """
    if goals is not None or variables is not None:
        problem = {"scene": problem, "goals": goals or (), "variables": variables or ()}
    problem = Problem.read(problem)
    if not problem.goals:
        raise InputError("/goals", "a sensitivity needs at least one goal")
    system = system_of(problem.scene)
    if missing := system.no_tangent(sparse=False):
        raise InputError("/scene/forces", f"{missing}, so nothing can be differentiated through its equilibrium")
    unknowns = Unknowns(problem, system)
    state = system.start()
    if unknowns.differ:
        unknowns.put(system, state, unknowns.start)
    found = settle(system, state, once=True)
    values = [measured(g.quantity, found, f"/goals/{i}") for i, g in enumerate(problem.goals)]
    total = sum(g.weight * each.sum() for g, each in zip(problem.goals, values, strict=True))
    weights = [np.full(len(each), g.weight) for g, each in zip(problem.goals, values, strict=True)]
    quantities = [(g.quantity, f"/goals/{i}") for i, g in enumerate(problem.goals)]
    gradient = gradients(found, unknowns, quantities, weights)
    if not np.isfinite(gradient).all():
        raise InputError("/scene", f"the tangent at the equilibrium is singular; {found.result.message}")
    parts = [gradient[s].reshape(v.shape) for v, s in zip(unknowns.variables, unknowns.slices, strict=True)]
    said = warnings(found) + unknowns.differing
    if found.system.films is not None and found.even is None:
        said += _along(found, _summed(found, unknowns, quantities, weights)[0])
    if unknowns.clipped:
        said.append(f"{unknowns.clipped} values of the scene are beyond the bounds; the shape has them at the bounds")
    return Sensitivity(float(total), parts, values, unknowns.names, said, found.result)


def gradients(
    found: Equilibrium, unknowns: Unknowns, quantities: list[tuple[Quantity, str]], weights: list[Floats]
) -> Floats:
    """The derivative (u,) of the sum of weights x values of quantities, by one solve."""
    by_place, by_unknown = _summed(found, unknowns, quantities, weights)
    adjoint = found.solve(by_place, transposed=True)
    if len(led := unknowns.led):
        by_unknown += unknowns.lead(by_place - found.resisted(adjoint, led))
    return np.asarray(unknowns.work(found, found.counted(adjoint).reshape(-1, 3)) + by_unknown)


def _summed(
    found: Equilibrium, unknowns: Unknowns, quantities: list[tuple[Quantity, str]], weights: list[Floats]
) -> tuple[Floats, Floats]:
    """Derivatives of that sum by places (3n,) and, at fixed places, by unknowns (u,)."""
    by_place, by_unknown = np.zeros(found.x.size), np.zeros(unknowns.count)
    for (quantity, pointer), weight in zip(quantities, weights, strict=True):
        placed, direct = quantity.slopes(found, unknowns, pointer)
        if quantity.centred and len(weight):
            weight = weight - weight.mean()
        by_place += placed.T @ weight
        by_unknown += direct.T @ weight
    return by_place, by_unknown


def jacobian(found: Equilibrium, unknowns: Unknowns, quantities: list[tuple[Quantity, str]]) -> Floats:
    """Derivatives (k, u) of the values of quantities, by as many solves as there are values or unknowns, whichever are
    fewer."""
    from scipy.sparse import vstack

    slopes = [quantity.slopes(found, unknowns, pointer) for quantity, pointer in quantities]
    by_place, by_unknown = vstack([s[0] for s in slopes]).tocsr(), vstack([s[1] for s in slopes]).tocsr()
    forces, moves = unknowns.slopes(found)
    right = (found.counted(forces) - found.response @ moves).tocsc()
    total = by_unknown.toarray() + (by_place @ moves).toarray()
    if by_place.shape[0] < unknowns.count:
        solved = np.array([found.solve(row, transposed=True) for row in by_place.toarray()]).reshape(by_place.shape)
        total = np.asarray(total + solved @ right)
    else:
        solved = np.array([found.solve(right[:, [j]].toarray().ravel()) for j in range(unknowns.count)])
        total = np.asarray(total + by_place @ solved.T)
    ends = np.cumsum([s[0].shape[0] for s in slopes])
    for (quantity, _), end, (own, _) in zip(quantities, ends, slopes, strict=True):
        if quantity.centred and own.shape[0]:
            total[end - own.shape[0] : end] -= total[end - own.shape[0] : end].mean(axis=0)
    return total


def warnings(found: Equilibrium) -> list[str]:
    """Sentences on what to mind about derivatives at an equilibrium."""
    said = []
    if not found.result.converged:
        said.append(f"the shape is not in equilibrium: {found.result.message}")
    if found.result.stability in (Stability.UNSTABLE, Stability.MECHANISM):
        kind = "unstable" if found.result.stability is Stability.UNSTABLE else "a mechanism"
        said.append(f"the shape is {kind} ({found.result.stability_reason}); its derivatives are those of this shape")
    said += [f"{kind} have yielded; derivatives are those of elastic behaviour from here on" for kind in found.yielded]
    if idle := asleep(found.system.scene):
        said.append(f"{', '.join(idle)}: of load cases, which do not act in this shape; take out what shall act")
    said += found.resting.said + kinks(found)
    return said


def _along(found: Equilibrium, by_place: Floats) -> list[str]:
    """A sentence where goals depend on where in a soap film its vertices lie: derivatives are those across it, while a
    whole solve also moves vertices along it, as they were led there."""
    films, slopes = found.system.films, by_place.reshape(-1, 3)
    assert films is not None
    along = np.abs(films.along(found.x, found.state.free, slopes)).max(initial=0.0)
    if along <= ALONG * np.abs(slopes).max(initial=0.0):
        return []
    return [
        "goals depend on where in a soap film its vertices lie; derivatives are those across it, which differ from"
        " those of whole solves by the error of the mesh"
    ]
