"""Newton: steps with the exact tangent stiffness, shifted until it is positive definite, with a line search.

(K + s I) dx = f on the free axes. The shift s grows where the tangent is not definite or a step fails and fades where
steps succeed, so that the last digits come quadratically. Only stable equilibria are accepted: where steps come to one
from which the energy falls to second order, they go on along a direction of negative curvature.
Source: Nocedal and Wright, Numerical Optimization, 2006, chapters 3 and 4.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

import numpy as np
from numpy.typing import NDArray

from hookean.factor import Factors
from hookean.solvers.base import Solver

if TYPE_CHECKING:
    from hookean.state import State
    from hookean.system import System

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

ROUNDING = 1e-9  # part of the mean stiffness below which a shift, or a negative curvature, is none


class Method(Solver):
    """Sparse Newton; best from a shape that is already near, for tight tolerances."""

    name: ClassVar[str] = "newton"
    longest: ClassVar[int] = 3

    def __init__(self) -> None:
        self._pattern: Pattern | None = None

    def start(self, system: System, state: State) -> None:
        """Start from rest with a small shift."""
        self._pattern = None
        state.v[:] = 0.0
        _, w, _ = system.evaluate(state)
        state.scratch = {"shift": np.array([1e-4, float(w.mean()) if len(w) else 1.0])}

    def advance(self, system: System, state: State, count: int, goal: float) -> int:
        """At most `count` Newton steps; fewer when no step helps any more, none when none helped."""
        shift, unit = state.scratch["shift"]
        free = _movable(system, state)
        if not free.any() or unit <= 0.0:
            return 0
        if self._pattern is None or not np.array_equal(self._pattern.free, free):
            self._pattern = Pattern(system, free)
        pattern = self._pattern
        energy, left = _energy_and_left(system, state)
        done, helped = 0, False
        while done < count:
            if np.sqrt((left**2).sum(axis=1).max()) <= goal:
                # a last step with next to no shift has seen a definite tangent
                if not done or shift <= ROUNDING or not _leave(system, state, pattern, unit, energy):
                    break
                energy, left = _energy_and_left(system, state)
                done, helped = done + 1, True
                state.iteration += 1
                continue
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


def _leave(system: System, state: State, pattern: Pattern, unit: float, energy: float) -> bool:
    """Move along a direction in which the energy falls from an equilibrium; False where there is none."""
    direction = pattern.falling(system, state, unit)
    if direction is None:
        return False
    start, length = state.x.copy(), 0.01 * system.size
    for _ in range(20):
        for sign in (1.0, -1.0):
            state.x = start + sign * length * direction
            now = _energy_and_left(system, state)[0]
            if np.isfinite(now) and now < energy:
                return True
        length *= 0.5
    state.x = start
    return False


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
    """Where element blocks go in the lower triangle of the sparse tangent: worked out once, filled at every step."""

    def __init__(self, system: System, free: Floats) -> None:
        n = len(free)
        self.free = free
        self.dofs = np.flatnonzero(free.ravel() > 0)
        lower = [_lower(g.block.indices) if g.cls.role != "load" else np.zeros((0, 3), np.int64) for g in system.groups]
        own = np.arange(n, dtype=np.int64) * (n + 1)
        pairs, which = np.unique(
            np.concatenate([*(low[:, 1] * n + low[:, 0] for low in lower), own]), return_inverse=True
        )
        place = self._arrange(pairs % n, pairs // n)
        ends = np.cumsum([len(low) for low in lower], dtype=np.int64)
        self.takes, places = [], [np.zeros(0, np.int64)]
        for group, low, end in zip(system.groups, lower, ends, strict=True):
            wide = 3 * group.block.indices.shape[1]
            corner = low[:, 2, None, None] + wide * np.arange(3)[:, None] + np.arange(3)
            mine = place[which[end - len(low) : end]]
            self.takes.append(corner[mine >= 0])
            places.append(mine[mine >= 0])
        self.places = np.concatenate(places)

    def _arrange(self, row: Ints, column: Ints) -> Ints:
        """Lay out the matrix for pairs of particles sorted by column and row, (i, i) first in each column.

        Returns the place (pairs, 3, 3) of each entry by the axes of its row and its column; -1 where it has none.
        """
        free = self.free > 0
        n = len(free)
        rank = np.cumsum(free, axis=1) - 1  # of each free axis among its particle's
        axes = free.sum(axis=1)[row]
        first = np.searchsorted(column, np.arange(n))
        above = np.cumsum(axes) - axes
        above -= above[first][column]  # entries of the column over those of the pair
        height = np.add.reduceat(axes, first)[:, None] - rank
        starts = np.concatenate([[0], np.cumsum(height[free])])
        begin = np.zeros(free.shape, np.int64)
        begin[free] = starts[:-1]
        place: Ints = (begin - rank)[column][:, None, :] + (above[:, None] + rank[row])[:, :, None]
        kept = free[row][:, :, None] & free[column][:, None, :]
        kept &= (row > column)[:, None, None] | np.tri(3, dtype=bool)
        place[~kept] = -1
        number = np.zeros(free.shape, np.int32)
        number[free] = np.arange(len(self.dofs))
        rows = np.zeros(starts[-1], np.int32)
        rows[place[kept]] = np.broadcast_to(number[row][:, :, None], place.shape)[kept]
        self.diagonal, self.count = starts[:-1], len(rows)
        self.factors = Factors(rows, starts.astype(np.int32))
        return place

    def tangent(self, system: System, state: State) -> Floats:
        """Values of the lower triangle of the sparse tangent stiffness."""
        values = [np.zeros(0)]
        for group, memory, take in zip(system.groups, state.memory, self.takes, strict=True):
            if len(take):
                values.append(system.stiffness_blocks(group, state, memory).ravel()[take])
        summed: Floats = np.bincount(self.places, np.concatenate(values), self.count).astype(np.float64)
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
            solution = self.factors.solve(shifted, rhs)
            if solution is not None:
                step = np.zeros(left.size)
                step[self.dofs] = solution
                return step.reshape(left.shape), shift
            shift = max(shift * 10.0, 1e-9)
        return None, shift

    def falling(self, system: System, state: State, unit: float) -> Floats | None:
        """A motion (n, 3), its largest part 1, of negative curvature; None where the tangent has none but rounding.

        By inverse iteration with a shift that is little more than the most negative eigenvalue.
        """
        values = self.tangent(system, state)
        seed = 1.0 + 0.5 * np.sin(12.9898 * np.arange(len(self.dofs)))

        def solve(shift: float, b: Floats) -> Floats | None:
            shifted = values.copy()
            shifted[self.diagonal] += shift * unit
            return self.factors.solve(shifted, b)

        if solve(ROUNDING, seed) is not None:
            return None
        low, high, found = ROUNDING, 2.0, solve(2.0, seed)
        for _ in range(12):
            middle = float(np.sqrt(low * high))
            solution = solve(middle, seed)
            if solution is None:
                low = middle
            else:
                high, found = middle, solution
        for _ in range(4):
            found = solve(high, found / np.abs(found).max()) if found is not None else None
        if found is None:
            return None
        motion = np.zeros(self.free.size)
        motion[self.dofs] = found / np.abs(found).max()
        return motion.reshape(self.free.shape)


def _lower(index: Ints) -> Ints:
    """Row and column particle of what is not above the diagonal, and its corner in the flat blocks of all elements."""
    m, arity = index.shape
    row, column = np.repeat(index, arity, axis=1).ravel(), np.tile(index, (1, arity)).ravel()
    i, j = np.divmod(np.arange(arity * arity), arity)
    corner = (9 * arity * arity * np.arange(m)[:, None] + 9 * arity * i + 3 * j).ravel()
    below = row >= column
    return np.column_stack([row[below], column[below], corner[below]])


def _movable(system: System, state: State) -> Floats:
    """Free axes (n, 3); none where something slides on a contact.

    What rests on a floor and sticks is held for these steps; the balance afterwards tells if that was true.
    """
    if not system.contacts:
        return state.free.copy()
    free = state.free.copy()
    left = system.evaluate(state)[0] * free
    stuck = np.abs(system.support(state, left)).sum(axis=1) > 0
    if (stuck & (left != 0.0).any(axis=1)).any():
        return np.zeros_like(free)
    free[stuck] = 0.0
    return free
