"""Multilevel: Newton steps solved by multigrid, and relaxation of what creases, for large nets.

A step solves (K + s L) dx = f on the free axes by conjugate gradients preconditioned by algebraic multigrid: K the
exact tangent, L the Laplacian of its graph. The shift s is large where the start has no stiffness across itself (a flat
net) and fades as steps succeed; being a Laplacian it holds smooth motions no more than they need, however fine the
mesh. Where that is not positive definite, the step goes along the direction that shows it, or springs that push are
taken not to push across themselves; and on along any direction while energy falls about as steeply. Where Newton steps
crawl, as along edges that crease and fold over, they take turns with relaxation of the particles whose springs turn
most in a step and those farthest out of balance, among the others, which hold still: a creased strip is soft, and soft
across few particles is what relaxation is quick at.
Sources: Nocedal and Wright, Numerical Optimization, 2006, chapter 7; Vanek, Mandel, Brezina, Computing 56 (1996) 179;
Cai and Li, SIAM J. Sci. Comput. 33 (2011) 746, for the elimination of what is locally not linear; Teran, Sifakis,
Irving, Fedkiw, Robust quasistatic finite elements, 2005, for tangents without what makes them indefinite.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from hookean.compiled import dispatch
from hookean.forces.base import lengths
from hookean.solvers import relaxation
from hookean.solvers.base import Solver

if TYPE_CHECKING:
    from hookean.linear.tangent import Tangent
    from hookean.system.balance import Balance
    from hookean.system.state import State
    from hookean.system.system import System

Floats = NDArray[np.float64]

FIRST_SHIFT, LEAST_SHIFT, LARGEST_SHIFT = 1.0, 1e-8, 1e4
WORTH = 1e-3  # a Newton step is worth another while it takes this part of the energy that all took
QUICK = 0.25  # or the largest force to this part
HELD = 3e-3  # a shift that is no larger fades only where the largest force does not halve
ROUNDING = 1e-13  # part of the energies that their sums may be off by
FAR = 0.7  # a step goes on while energy falls by this part of what its slope at the start promises
SOLVED = 0.1  # part of the forces that a linear system may leave
CONJUGATE, MOST = 25, 200  # steps of conjugate gradients in one of them: at first, and where Newton is about to end
GENTLE = 3e-4  # least shift of steps that take turns with relaxation
CALM = 0.05  # angle [rad] up to which springs turn where the tangent of the step before does for the next
STRAIGHT = 1e-3  # angle [rad] up to which springs turn where Newton alone may end
TURNED, OUT, RINGS = 0.5, 0.2, 6  # what creases: parts of the largest turn and force, and the rings around
SHARE = 0.4  # of all particles, at most
SMOOTHING = 100  # passes over all springs that relaxation may take between Newton steps
LONGEST = 5000  # iterations of a local one
ROUNDS = 12  # turns without half the largest force, after which all particles relax
BURST = 250_000  # particles times Newton steps in one go


class Method(Solver):
    """Newton and multigrid for large nets."""

    name: ClassVar[str] = "multilevel"
    together: ClassVar[int] = 1
    longest: ClassVar[int] = 100

    def __init__(self) -> None:
        self._relaxation = relaxation.Method()
        self.tangent = None
        self._judged: Judged | None = None  # the shape as it is, while one advance lasts
        self.largest = np.inf  # force [force] out of balance after the last Newton step
        self.work = 0.0  # passes over all springs; coarser levels count by their size

    def refuse(self, system: System) -> str:
        """A sentence where there are films, or where a particle meets a floor: what slides or sticks has no tangent."""
        if system.films is not None:
            return "multilevel does not support soap films; use auto"
        if any(group.cls.rewired for group in system.groups):
            return "multilevel does not support contacts that come and go; use auto, newton or relaxation"
        return "multilevel does not support floors; use auto or relaxation" if system.contacts else ""

    def start(self, system: System, state: State) -> None:
        """Start from rest, with Newton steps."""
        self._relaxation.start(system, state)
        self.tangent = None
        self.largest = np.inf
        state.scratch["newton"] = np.array([FIRST_SHIFT, CONJUGATE, 0.0])
        state.scratch["turns"] = np.array([0.0, 1.0, 0.0, np.inf])
        state.scratch["all"] = np.array([0.0, SMOOTHING])
        state.scratch["creased"] = np.zeros(len(state.x))
        state.scratch["calm"] = np.zeros(1)

    def advance(self, system: System, state: State, count: int, goal: float) -> int:
        """At most `count` iterations: each a Newton step with what relaxes after it, or an iteration of relaxation; the
        fewer the larger the net, so that a run can be judged and stopped in between."""
        ready = self._readied(system, state)
        self._judged = None
        several, done = min(count, max(1, BURST // len(state.x))), 0
        while done < several and (self.largest > goal or not done):
            left = state.scratch["all"][0]
            if left > 0 or not ready.hierarchy.coarse:
                relaxed = self._relaxation.advance(system, state, min(count - done, int(left) or count), goal)
                self.work += relaxed
                state.scratch["all"][0] = left - relaxed if relaxed and left else 0.0
                return done + (max(relaxed, 1) if ready.hierarchy.coarse else relaxed)
            self._step(system, state, goal)
            done += 1
        return done

    def correction(self, system: System, state: State, found: Balance) -> Floats | None:
        """By the tangent of the last step, where what is left to go is little beside that."""
        if self.tangent is None:
            return None
        return self.tangent.correction(found.forces * state.free, state.x, CONJUGATE)

    def _step(self, system: System, state: State, goal: float) -> None:
        """One Newton step, and what relaxes after it."""
        ready = self._readied(system, state)
        shift, most, taken = state.scratch["newton"]
        gentle = state.scratch["turns"][0] > 0
        calm = state.scratch["calm"][0] > 0
        step = Step(system, state, ready, GENTLE if gentle else shift, CONJUGATE if gentle else int(most), calm)
        before = state.x.copy()
        again = step.take(self._judged, taken, goal)
        now = self._judged = step.judged
        state.iteration += 1
        self.work += step.work
        self.largest = now.largest
        if not gentle and step.cut and step.length >= 1.0:
            most, again = min(2.0 * most, MOST), True
        state.scratch["newton"] = np.array([step.shift, most, taken + step.fall])
        if now.largest > goal:
            turned = ready.blocks.turned(before, step.direction)
            state.scratch["calm"][0] = step.quick and turned.max(initial=0.0) < CALM
            if self._takes_turns(state, step, float(turned.max()), again):
                self._smooth(system, state, now.forces, turned, goal)
                self._judged = None
        ready.keep(state)

    def _takes_turns(self, state: State, step: Step, turned: float, again: bool) -> bool:
        """Whether relaxation is due: for one turn, two, four ... each time that Newton alone did not go on well, and
        until springs turn little."""
        turns, patience, rounds, best = state.scratch["turns"]
        straight, once = step.length >= 1.0 and not step.bent, False
        if turns > 0:
            turns = max(turns - 1.0, 0.0 if straight and turned < STRAIGHT else 1.0)
            if turns == 0.0:
                state.scratch["newton"][:2] = GENTLE, CONJUGATE
        elif not again:
            once = straight and turned < STRAIGHT
            if not once:
                turns, patience, rounds, best = patience, 2.0 * patience, 0.0, np.inf
        rounds = 0.0 if step.judged.largest < 0.5 * best else rounds + 1.0
        state.scratch["turns"] = np.array([turns, patience, rounds, min(best, step.judged.largest)])
        return bool(turns > 0 or once)

    def _smooth(self, system: System, state: State, forces: Floats, turned: Floats, goal: float) -> None:
        """Relax what creases; all particles, from the next iteration on, where that is many or has not helped."""
        from hookean.linear.subsystem import cut, widened

        blocks = self._readied(system, state).blocks
        size = lengths(forces)
        largest = float(size.max())
        now = (turned > TURNED * turned.max()) | (size > OUT * largest)
        now = widened(blocks.starts, blocks.columns, now, RINGS) & state.moving
        creased = state.scratch["creased"] > 0.0
        creased = next((some for some in (creased | now, now, creased) if some.mean() <= SHARE), creased)
        state.scratch["creased"] = creased.astype(float)
        if state.scratch["turns"][2] >= ROUNDS or not creased.any():
            self._all(system, state)
            return
        part, own, particles = cut(system, state, creased)
        method = relaxation.Method()
        method.start(part, own)
        share = float(creased.mean())
        done = method.advance(part, own, int(min(LONGEST, SMOOTHING / share)), max(0.001 * largest, 0.5 * goal))
        self.work += done * share
        if np.isfinite(own.x).all():
            state.x[particles] = own.x

    def _all(self, system: System, state: State) -> None:
        """Relax all particles from the next iteration on."""
        kept = dict(state.scratch)
        self._relaxation.start(system, state)
        state.scratch.update({name: value for name, value in kept.items() if name not in state.scratch})
        state.scratch["calm"][0] = 0.0
        budget = state.scratch["all"][1]
        state.scratch["all"] = np.array([budget, np.ceil(1.5 * budget)])
        state.scratch["turns"][2:] = 0.0, np.inf

    def _readied(self, system: System, state: State) -> Tangent:
        if self.tangent is None:
            from hookean.linear.tangent import Tangent

            self.tangent = Tangent(system, state)
        return self.tangent


class Judged(NamedTuple):
    """What is known of a shape: its energy and what of it may be rounding [force length], what is out of balance (n, 3)
    [force] and the largest."""

    energy: float
    noise: float
    forces: Floats
    largest: float


class Step:
    """One Newton step: its `direction` (n, 3) [length], and the `length` to go along it [-], 0 where none helps.
    `fall` [force length] of the energy, the shape as `judged` after it, `work` [passes over all springs]."""

    def __init__(self, system: System, state: State, ready: Tangent, shift: float, most: int, calm: bool) -> None:
        self.system, self.state, self.ready, self.shift, self.most = system, state, ready, shift, most
        self.work, self.fall, self.length = 0.0, 0.0, 0.0
        self.direction = np.zeros_like(state.x)
        self.bent = False  # whether a tangent was seen not to be positive definite
        self.cut = False  # whether conjugate gradients ended before they were done
        self.calm, self.quick = calm, False  # whether the last tangent does; whether the largest force fell well

    def take(self, judged: Judged | None, taken: float, goal: float) -> bool:
        """Take the step, of a shape that may be `judged` already; whether another one is worth it after energy has
        fallen by `taken` in all before."""
        before = self.judged = judged or self._judge()
        if before.largest <= goal:
            return True
        work = self.ready.work
        direction = self._direction(before.forces)
        self.work += self.ready.work - work
        if direction is None:
            return False
        start, self.direction = self.state.x.copy(), direction
        self.length = self._search(start, before)
        if self.length == 0.0:
            self.state.x[:] = start
            self.shift = min(max(10.0 * self.shift, 1e-4), FIRST_SHIFT)
            return False
        self.fall = max(before.energy - self.judged.energy, 0.0)
        fell = self.judged.largest < QUICK * before.largest
        self.shift *= self._eased(self.judged.largest < 0.5 * before.largest)
        if self.shift < LEAST_SHIFT:
            self.shift = 0.0
        self.quick = self.length >= 1.0 and fell
        return fell or self.fall > WORTH * (taken + self.fall)

    def _eased(self, halved: bool) -> float:
        """By how much the next shift is smaller or larger. One that is small stays while forces are halved."""
        if self.length < 1.0:
            return 1.0 if self.length >= 0.5 else 4.0
        if self.bent:
            return 0.5
        return 1.0 if self.shift <= HELD and halved else 0.1

    def _judge(self) -> Judged:
        self.work += 1.0
        f, _, energies = self.system.evaluate(self.state)
        largest: float = dispatch.compiled(leave)(f, self.state.free)
        return Judged(float(energies.sum()), ROUNDING * float(np.abs(energies).sum()), f, largest)

    def _direction(self, forces: Floats) -> Floats | None:
        """Where to go: by the last tangent while the shape is calm, else by its own, also along a direction that bends
        down; where that gives none, by that of a net in which nothing pushes across, and with larger shifts."""
        if self.calm and self.ready.ready and (direction := self._solved(forces)) is not None:
            return direction
        while self.shift <= LARGEST_SHIFT:
            for pulling in (False, True):
                taken_up = self.ready.take_up(self.system, self.state, self.shift, pulling=pulling)
                if taken_up and (direction := self._solved(forces)) is not None:
                    return direction
                self.bent = True
            self.shift = max(10.0 * self.shift, 1e-5)
        return None

    def _solved(self, forces: Floats) -> Floats | None:
        steps = self.ready.steps
        direction, positive = self.ready.solve(forces, SOLVED, self.most)
        self.bent |= not positive
        self.cut = self.ready.steps - steps >= self.most
        return direction

    def _search(self, start: Floats, before: Judged) -> float:
        """How far to go: on while energy falls steeply, back until it falls enough or the largest force halves."""
        length, slope = 1.0, float((before.forces * self.direction).sum())
        now = self._at(start, length)
        while length < 64.0 and before.energy - now.energy > FAR * length * slope + before.noise:
            further = self._at(start, 2.0 * length)
            if not further.energy < now.energy:
                self.state.x[:] = start + length * self.direction
                break
            length, now = 2.0 * length, further
        while length > 1e-3:
            falls = now.energy <= before.energy - 1e-4 * length * slope + before.noise
            falls = falls or now.largest < 0.5 * before.largest
            if np.isfinite(now.energy) and falls:
                self.judged = now
                return length
            length *= 0.5
            now = self._at(start, length)
        return 0.0

    def _at(self, start: Floats, length: float) -> Judged:
        self.state.x[:] = start + length * self.direction
        return self._judge()


def leave(f, free):  # type: ignore[no-untyped-def]
    """Take from forces what is held; the largest that is left."""
    largest = 0.0
    for i in range(f.shape[0]):
        square = 0.0
        for c in range(3):
            f[i, c] *= free[i, c]
            square += f[i, c] * f[i, c]
        if square > largest or np.isnan(square):
            largest = square
    return np.sqrt(largest)
