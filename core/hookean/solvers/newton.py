"""Newton: steps with the exact tangent stiffness, shifted until it is positive definite, with a line search.

(K + s W) dx = f on the free axes, W the stiffness that particles feel. The shift s grows where the tangent is not
definite or a step fails and fades where steps succeed, at once where they are small and none has needed it, so that the
last digits come quadratically. Where loads without
an energy make the tangent unsymmetric, a step solves with the whole of it. Where steps come to an equilibrium from
which the energy falls to second order, the run leaves it and goes on.
Lines that keep their force while they turn have steps of their own (`linear.directions`).
Source: Nocedal and Wright, Numerical Optimization, 2006, chapters 3 and 4.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

import numpy as np
from numpy.typing import NDArray

from hookean.linear.directions import Directions, begin, sharp
from hookean.linear.film_tangent import patterned
from hookean.linear.pattern import Pattern
from hookean.linear.sparse_factors import Factor
from hookean.linear.unsymmetric import skew_part
from hookean.solvers.base import Solver

if TYPE_CHECKING:
    from hookean.system.state import State
    from hookean.system.system import System

Floats = NDArray[np.float64]

NO_SHIFT = 1e-9  # part of the stiffness; a smaller shift is tried after none at all
MANY = 6_000  # unknowns from which on factors take so much longer than a step that they serve for several
NEAR = 1e-3  # of the model's size: after a step that moves less, the tangent is nearly what it was
ROUNDING = 1e-14  # part of the energies that their sum may be off by, and of the model's size


class Method(Solver):
    """Sparse Newton; best from a shape that is already near, for tight tolerances."""

    name: ClassVar[str] = "newton"
    together: ClassVar[int] = 3
    longest: ClassVar[int] = 3
    leaves: ClassVar[bool] = True

    def __init__(self) -> None:
        self.pattern: Pattern | None = None

    def refuse(self, system: System) -> str:
        """A sentence where a force has no tangent."""
        return system.no_tangent(steps=True)

    def start(self, system: System, state: State) -> None:
        """Start from rest with a small shift."""
        self.pattern = None
        state.v[:] = 0.0
        _, w, _ = system.evaluate(state)
        state.scratch = {"shift": np.array([1e-4, 0.0]), "unit": np.where(w > 0.0, w, w.mean() or 1.0)}
        if sharp(system):
            state.scratch["directions"] = begin(system)

    def advance(self, system: System, state: State, count: int, goal: float) -> int:
        """At most `count` Newton steps; fewer when no step helps any more, none when none helped."""
        shift, needed = float(state.scratch["shift"][0]), state.scratch["shift"][1:].any()
        free = _movable(system, state)
        if not free.any():
            return 0
        if len(system.slots):
            system.slots.fold(state)
        now, done, helped, kept = Judged.of(system, state), 0, False, None
        while done < count and now.largest > goal:
            again, kept = kept, None
            if again is None:
                self.pattern = patterned(system, state, free, self.pattern)
            turns = Directions(system, state, state.scratch["directions"]) if "directions" in state.scratch else None
            asked = shift
            step, shift = _step(self.pattern, system, state, now.left, shift, turns, again)
            needed |= shift > asked
            if step is None:
                break
            before = state.x
            length, after = _search(system, state, step, now, strict=turns is not None)
            if length > 0.0 and system.sunk(state)[0] >= 0:
                state.x = before  # where it comes to lie on a floor is for other solvers to find
                break
            if again is not None and length == 0.0:
                continue  # the tangent has changed, after all
            near = length == 1.0 and turns is None and np.abs(step).max() <= NEAR * system.size
            if near and shift == 0.0:
                kept = self._serves(system)
            if turns is not None:
                state.scratch["directions"] = turns.after(step)
            if length == 0.0:
                shift = max(shift, 1e-8) * 10.0
                if shift > 1e4:
                    break
                continue
            done += 1
            state.iteration += 1
            helped |= after.fallen > 0.0 or after.largest < 0.99 * now.largest
            # beside what is much stiffer, or has much more energy, a full step is all that shows
            helped |= length == 1.0 and shift == 0.0 and np.abs(step).max() > ROUNDING * system.size
            now = after
            if len(system.slots):
                system.slots.fold(state)
                now = Judged.of(system, state)  # moments have no energy but from the last reference on
            shift = shift * 0.1 if length == 1.0 else shift if length > 0.2 else shift * 10.0
            if shift < 1e-12 or (near and not needed):
                shift = 0.0
        state.scratch["shift"] = np.array([min(shift, 1.0), needed])
        return done if helped else 0

    def sharpen(self, state: State) -> None:
        """No shift at first: what was an equilibrium is stable."""
        if "shift" in state.scratch:
            state.scratch["shift"] = np.zeros(2)

    def _serves(self, system: System) -> Factor | None:
        """The factors of the step that was made last, where they are worth keeping for one more."""
        if self.pattern is None or len(self.pattern.dofs) < MANY or system.films is not None or len(system.slots):
            return None
        return self.pattern.factors.last


class Judged:
    """A shape: its energy and what of it may be rounding [force length], what is out of balance (n, 3) [force] and the
    largest."""

    def __init__(self, energy: float, noise: float, left: Floats) -> None:
        self.energy, self.noise, self.left = energy, noise, left
        self.fallen = 0.0  # by how much the energy fell to here, or by the work of forces that have none
        self.largest = float(np.sqrt((left**2).sum(axis=1).max(initial=0.0)))

    @classmethod
    def of(cls, system: System, state: State) -> Judged:
        f, _, energies = system.evaluate(state)
        left = f * state.free
        system.support(state, left)
        if system.films is not None:
            system.films.across(state.x, state.free, left)
        return cls(float(energies.sum()), ROUNDING * float(np.abs(energies).sum()), left)


def _step(
    pattern: Pattern, system: System, state: State, left: Floats, shift: float, turns: Directions | None,
    kept: Factor | None,
) -> tuple[Floats | None, float]:  # fmt: skip
    """The step of the smallest shift, from this one on, that makes the symmetric part of the tangent positive
    definite; by the factors `kept` of a shape beside this one, if there are any."""
    if kept is not None:
        return pattern.spread(kept.solve(pattern.gather(left))), shift
    values = pattern.tangent(system, state, turns)
    rhs, unit = pattern.gather(left), state.scratch["unit"][pattern.dofs // 3]
    skew = skew_part(system, state, pattern.dofs)
    while shift <= 1e4:
        shifted = values.copy()
        shifted[pattern.diagonal] += shift * unit
        solution = pattern.factors.solve(shifted, rhs, skew)
        if solution is not None:
            return pattern.spread(solution), shift
        shift = max(shift * 10.0, NO_SHIFT)
    return None, shift


def _search(system: System, state: State, step: Floats, before: Judged, *, strict: bool) -> tuple[float, Judged]:
    """Shorten the step until energy falls enough, or the largest force halves; zero length if nothing helps.

    `strict`: the energy must fall, if there is one: across kinks forces halve and double in turn for ever. Where some
    force has no energy of its own, the mean of what is out of balance at both ends shows what fell as well.
    """
    start, length = state.x.copy(), 1.0
    slope = float((before.left * step).sum())
    potential = all(group.conservative for group in system.groups)
    for _ in range(12):
        state.x = start + length * step
        now = Judged.of(system, state)
        now.fallen = before.energy - now.energy
        if not potential:
            now.fallen = max(now.fallen, 0.5 * length * (slope + float((now.left * step).sum())))
        falls = now.fallen >= 1e-4 * length * slope - before.noise
        halves = now.largest < 0.5 * before.largest and not (strict and potential)
        if np.isfinite(now.energy) and (falls or halves) and not _lost(system, state):
            return length, now
        length *= 0.5
    state.x = start
    return 0.0, before


def _lost(system: System, state: State) -> bool:
    """Whether an element has turned to where it has neither forces nor energy, which is no way to lower it."""
    return any(group.cls.amiss(group.block, state.x) for group in system.groups if group.cls.turns)


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
