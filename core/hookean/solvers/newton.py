"""Newton: steps with the exact tangent stiffness, shifted until it is positive definite, with a line search.

(K + s I) dx = f on the free axes. The shift s grows where the tangent is not definite or a step fails and fades where
steps succeed, so that the last digits come quadratically, and only stable equilibria are accepted.
Source: Nocedal and Wright, Numerical Optimization, 2006, chapters 3 and 4.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from hookean.solvers.base import Solver

if TYPE_CHECKING:
    from hookean.state import State
    from hookean.system import System

Floats = NDArray[np.float64]


class Method(Solver):
    """Sparse Newton; best from a shape that is already near, for tight tolerances."""

    name: ClassVar[str] = "newton"
    longest: ClassVar[int] = 3

    def start(self, system: System, state: State) -> None:
        """Start from rest with a small shift."""
        state.v[:] = 0.0
        _, w, _ = system.evaluate(state)
        state.scratch = {"shift": np.array([1e-4, float(w.mean()) if len(w) else 1.0])}

    def advance(self, system: System, state: State, count: int, goal: float) -> int:
        """At most `count` Newton steps; fewer when no step helps any more, none when none helped."""
        shift, unit = state.scratch["shift"]
        pattern = Pattern(system, state)
        if not len(pattern.dofs) or unit <= 0.0:
            return 0
        energy, left = _energy_and_left(system, state)
        done, helped = 0, False
        while done < count and np.sqrt((left**2).sum(axis=1).max()) > goal:
            step, shift = pattern.step(system, state, left, shift, unit)
            if step is None:
                break
            before, size = energy, np.abs(left).max()
            length, energy, left = _search(system, state, step, energy, left)
            if length == 0.0:
                shift = max(shift, 1e-8) * 10.0
                if shift > 1e4:
                    break
                continue
            done += 1
            state.iteration += 1
            helped = helped or energy < before or np.abs(left).max() < 0.99 * size
            shift = shift * 0.1 if length == 1.0 else shift if length > 0.2 else shift * 10.0
            if shift < 1e-12:
                shift = 0.0
        state.scratch["shift"] = np.array([min(shift, 1.0), unit])
        return done if helped else 0


def _energy_and_left(system: System, state: State) -> tuple[float, Floats]:
    f, _, energies = system.evaluate(state)
    left = f * state.free
    system.support(state, left)
    return float(energies.sum()), left


def _search(system: System, state: State, step: Floats, energy: float, left: Floats) -> tuple[float, float, Floats]:
    """Shorten the step until energy falls enough, or the largest force halves; zero length if nothing helps."""
    start = state.x.copy()
    slope = float((left * step).sum())
    largest = float(np.abs(left).max())
    length = 1.0
    for _ in range(12):
        state.x = start + length * step
        now, forces = _energy_and_left(system, state)
        if np.isfinite(now) and (now <= energy - 1e-4 * length * slope or np.abs(forces).max() < 0.5 * largest):
            return length, now, forces
        length *= 0.5
    state.x = start
    return 0.0, energy, left


class Pattern:
    """Where element blocks go in the sparse tangent: worked out once, filled at every step."""

    def __init__(self, system: System, state: State) -> None:
        free = state.free.copy()
        left, stuck = system.evaluate(state)[0] * free, None
        if system.contacts:
            # what rests on a floor and sticks is held for these steps; the balance afterwards tells if that was true
            stuck = np.abs(system.support(state, left)).sum(axis=1) > 0
            free[stuck & (left == 0.0).all(axis=1)] = 0.0
        self.slides = bool(stuck is not None and (stuck & (left != 0.0).any(axis=1)).any())
        self.dofs = np.flatnonzero(free.ravel() > 0) if not self.slides else np.zeros(0, np.int64)
        number = np.full(free.size, -1)
        number[self.dofs] = np.arange(len(self.dofs))
        keys, self.takes = [], []
        for group in system.groups:
            index = group.block.indices
            mine = number[(3 * index[:, :, None] + np.arange(3)).reshape(len(index), -1)]
            row = np.repeat(mine, mine.shape[1], axis=1).ravel()
            column = np.tile(mine, (1, mine.shape[1])).ravel()
            take = np.flatnonzero((row >= 0) & (column >= 0)) if group.cls.role != "load" else np.zeros(0, np.int64)
            self.takes.append(take)
            keys.append(column[take].astype(np.int64) * len(self.dofs) + row[take])
        diagonal = np.arange(len(self.dofs), dtype=np.int64) * (len(self.dofs) + 1)
        unique, place = np.unique(np.concatenate([*keys, diagonal]), return_inverse=True)
        self.place, self.count = place, len(unique)
        size = max(len(self.dofs), 1)
        self.rows = (unique % size).astype(np.int32)
        self.starts = np.searchsorted(unique // size, np.arange(len(self.dofs) + 1)).astype(np.int32)
        self.diagonal = place[len(place) - len(self.dofs) :]

    def tangent(self, system: System, state: State) -> Floats:
        """Values of the sparse tangent stiffness."""
        values = []
        for group, memory, take in zip(system.groups, state.memory, self.takes, strict=True):
            if len(take):
                values.append(system.stiffness_blocks(group, state, memory).ravel()[take])
        values.append(np.zeros(len(self.dofs)))
        summed: Floats = np.bincount(self.place, np.concatenate(values), self.count).astype(np.float64)
        return summed

    def step(
        self, system: System, state: State, left: Floats, shift: float, unit: float
    ) -> tuple[Floats | None, float]:
        """The step of the smallest shift that makes the tangent positive definite."""
        values = self.tangent(system, state)
        rhs = left.ravel()[self.dofs]
        while shift <= 1e4:
            shifted = values.copy()
            shifted[self.diagonal] += shift * unit
            solution = self._solve(shifted, rhs)
            if solution is not None:
                step = np.zeros(left.size)
                step[self.dofs] = solution
                return step.reshape(left.shape), shift
            shift = max(shift * 10.0, 1e-9)
        return None, shift

    def _solve(self, values: Floats, rhs: Floats) -> Floats | None:
        """Solution, or None unless the matrix is positive definite."""
        import scipy.sparse as sparse
        from scipy.sparse.linalg import splu

        size = len(self.dofs)
        matrix = sparse.csc_matrix((values, self.rows, self.starts), shape=(size, size))
        options: dict[str, Any] = {"SymmetricMode": True}
        try:
            factor = splu(matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=options)
        except RuntimeError:
            return None
        if not (factor.U.diagonal() > 0).all():
            return None
        solution: Floats = factor.solve(rhs)
        return solution if np.isfinite(solution).all() else None
