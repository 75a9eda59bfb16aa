"""Multilevel: Newton steps solved by multigrid, with relaxation where they do not help, for large nets.

A step solves (K + s L) dx = f on the free axes by conjugate gradients preconditioned by algebraic multigrid: K the
exact tangent, L the Laplacian of its graph. The shift s is large where the start has no stiffness across itself (a flat
net) and fades as steps succeed; being a Laplacian it holds smooth motions no more than they need, however fine the
mesh. What Newton's line search crawls along, such as an edge that folds over, is mostly local: the particles that are
farthest out of balance are relaxed among the others, which hold still; all of them where that does not help.
Sources: Nocedal and Wright, Numerical Optimization, 2006, chapter 7; Vanek, Mandel, Brezina, Computing 56 (1996) 179;
Cai and Li, SIAM J. Sci. Comput. 33 (2011) 746, for the elimination of what is locally not linear.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

import numpy as np
from numpy.typing import NDArray

from hookean.solvers import relaxation
from hookean.solvers.base import Solver

if TYPE_CHECKING:
    from hookean.multigrid.tangent import Tangent
    from hookean.state import State
    from hookean.system import System

Floats = NDArray[np.float64]

FIRST_SHIFT, LEAST_SHIFT, LARGEST_SHIFT = 1.0, 1e-8, 1e4
WORTH = 1e-3  # a Newton step is worth another while it takes this part of the energy that all took
QUICK = 0.25  # or the largest force to this part
SOLVED = 0.1  # part of the forces that a linear system may leave
CONJUGATE = 25  # steps of conjugate gradients in one of them
OUT, RINGS, SHARE = 0.1, 4, 0.3  # local: forces from this part of the largest on, and what is around; of all at most
SMOOTHING = 100  # passes over all springs that relaxation may first take between Newton steps
LONGEST = 3000  # iterations of a local one
PUSHED = 0.01  # of all springs: nets that buckle have many shapes at rest
FEW = 1e-3  # so few push where supports are points, and have no room to buckle
ROUNDS = 3  # smoothings without half the largest force, after which all particles relax


class Method(Solver):
    """Newton and multigrid for large nets."""

    name: ClassVar[str] = "multilevel"
    longest: ClassVar[int] = SMOOTHING

    def __init__(self) -> None:
        self._relaxation = relaxation.Method()
        self._ready: Tangent | None = None
        self.largest = np.inf  # force [force] out of balance after the last Newton step
        self.pushed = False  # whether many springs pushed where Newton steps no longer helped
        self.work = 0.0  # passes over all springs; coarser levels count by their size

    def refuse(self, system: System) -> str:
        """A sentence where a particle meets a floor: what slides or sticks has no tangent."""
        return "multilevel has no tangent for a floor; use auto or relaxation" if system.contacts else ""

    def start(self, system: System, state: State) -> None:
        """Start from rest, with Newton steps."""
        self._relaxation.start(system, state)
        self._ready = None
        self.pushed, self.largest = False, np.inf
        state.scratch["newton"] = np.array([FIRST_SHIFT, 0.0])
        state.scratch["smoothing"] = np.array([0.0, SMOOTHING, np.inf, 0.0])

    def advance(self, system: System, state: State, count: int, goal: float) -> int:
        """At most `count` iterations: each a Newton step, a local relaxation, or an iteration of relaxation."""
        left, budget, best, rounds = state.scratch["smoothing"]
        if left > 0 or not self._readied(system, state).hierarchy.coarse:
            left = max(left, 1.0)
            done = self._relaxation.advance(system, state, min(count, int(left)), goal)
            self.work += done
            state.scratch["smoothing"][0] = left - done if done else 0.0
            return max(done, 1)
        shift, taken = state.scratch["newton"]
        step = Step(system, state, self._readied(system, state), shift)
        again = step.take(taken, goal)
        self.work += step.work
        self.largest = step.largest
        state.iteration += 1
        if not again:
            self.pushed = self.pushed or _share_pushed(system, state) > PUSHED
            rounds = 0.0 if step.largest < 0.5 * best else rounds + 1.0
            best = min(best, step.largest)
            left = self._smooth(system, state, budget, goal) if rounds < ROUNDS else budget
            budget *= 1.5 if rounds else 1.0
            rounds = 0.0 if left else rounds
        state.scratch["newton"] = np.array([step.shift, taken + step.fall])
        state.scratch["smoothing"] = np.array([np.ceil(left), budget, best, rounds])
        self._readied(system, state).keep(state)
        return 1

    def _smooth(self, system: System, state: State, budget: float, goal: float) -> float:
        """Relax the particles farthest out of balance; the iterations that all should have instead if they are many."""
        from hookean.multigrid.part import cut, widened

        blocks = self._readied(system, state).blocks
        f = system.evaluate(state)[0] * state.free
        size = np.sqrt((f * f).sum(axis=1))
        largest = float(size.max())
        moving = widened(blocks.starts, blocks.columns, size > OUT * largest, RINGS)
        moving &= (state.free > 0.0).any(axis=1)
        share = float(moving.mean())
        self.work += 1.0
        if share > SHARE:
            self._relaxation.start(system, state)
            return budget
        part, own, particles = cut(system, state, moving)
        method = relaxation.Method()
        method.start(part, own)
        done = method.advance(part, own, int(min(LONGEST, budget / share)), max(0.003 * largest, 0.5 * goal))
        self.work += done * share
        if np.isfinite(own.x).all():
            state.x[particles] = own.x
        return 0.0

    def _readied(self, system: System, state: State) -> Tangent:
        if self._ready is None:
            from hookean.multigrid.tangent import Tangent

            self._ready = Tangent(system, state)
        return self._ready


class Step:
    """One Newton step: its direction, and how far to go. `fall` [force length] of the energy, `largest` [force] out of
    balance after it, `work` [passes over all springs]."""

    def __init__(self, system: System, state: State, ready: Tangent, shift: float) -> None:
        self.system, self.state, self.ready, self.shift = system, state, ready, shift
        self.work, self.fall, self.largest = 0.0, 0.0, np.inf
        self.bent = False  # whether a direction of negative curvature was met

    def take(self, taken: float, goal: float) -> bool:
        """Take the step; whether another one is worth it after energy has fallen by `taken` in all before."""
        state = self.state
        energy, forces = self._judge()
        before = self.largest = _largest(forces)
        if before <= goal:
            return True
        direction = self._direction(forces)
        if direction is None:
            return False
        start = state.x.copy()
        length, now, left = self._search(start, direction, energy, float((forces * direction).sum()), before)
        if length == 0.0:
            state.x[:] = start
            self.shift = min(max(10.0 * self.shift, 1e-4), FIRST_SHIFT)
            return False
        self.fall, self.largest = max(energy - now, 0.0), _largest(left)
        self.shift *= (0.1 if not self.bent else 0.5) if length >= 1.0 else 1.0 if length >= 0.5 else 4.0
        if self.shift < LEAST_SHIFT:
            self.shift = 0.0
        return bool(self.largest < QUICK * before or self.fall > WORTH * (taken + self.fall))

    def _judge(self) -> tuple[float, Floats]:
        self.work += 1.0
        f, _, energies = self.system.evaluate(self.state)
        return float(energies.sum()), f * self.state.free

    def _direction(self, forces: Floats) -> Floats | None:
        """Where to go, with the smallest shift tried that makes the tangent positive definite."""
        while self.shift <= LARGEST_SHIFT:
            before = self.ready.work
            direction = self.ready.solve(self.system, self.state, self.shift, forces, SOLVED, CONJUGATE)
            self.work += self.ready.work - before
            if direction is not None:
                return direction
            self.shift, self.bent = max(10.0 * self.shift, 1e-5), True
        return None

    def _search(
        self, start: Floats, direction: Floats, energy: float, slope: float, before: float
    ) -> tuple[float, float, Floats]:
        """How far to go: on while energy falls, back until it falls enough or the largest force halves."""
        state, length = self.state, 1.0
        state.x[:] = start + direction
        now, left = self._judge()
        while self.shift >= 0.1 and length < 64.0:
            state.x[:] = start + 2.0 * length * direction
            further, forces = self._judge()
            if not further < now:
                state.x[:] = start + length * direction
                break
            length, now, left = 2.0 * length, further, forces
        while length > 1e-3:
            if np.isfinite(now) and (now <= energy - 1e-4 * length * slope or _largest(left) < 0.5 * before):
                return length, now, left
            length *= 0.5
            state.x[:] = start + length * direction
            now, left = self._judge()
        return 0.0, energy, left


def suits(system: System) -> bool:
    """Whether a system is of plain springs and constant loads alone, whose shape of least energy can be told."""
    from hookean.forces.springs import Springs

    plain = False
    for group in system.groups:
        if group.cls is Springs:
            plain = not (group.block.parameters[:, 4:] != 0.0).any()
        elif not group.cls.constant:
            return False
    return plain and not system.contacts


def lowest(system: System, state: State) -> bool:
    """Whether a shape at rest of plain springs and constant loads is the one of least energy, as far as can be told.

    With s the squares of the lengths, k (sqrt(s) - L0)^2 / 2 is convex in s: the energy is nowhere below the quadratic
    form of the force densities q = k (1 - L0 / l), which has its minimum at the shape where it is positive definite:
    always where all springs pull.
    Source: Connelly, Rigidity and energy, Inventiones mathematicae 66 (1982) 11.
    """
    from hookean.factor import Factors

    pairs, density = _densities(system, state)
    if (density < 0.0).mean() <= FEW:
        return True
    if (density < 0.0).mean() > PUSHED:
        return False
    import scipy.sparse as sparse

    n = len(state.x)
    low, high = pairs.min(axis=1), pairs.max(axis=1)
    diagonal = np.bincount(pairs.ravel(), np.repeat(density, 2), n)
    rows, columns = np.concatenate([high, np.arange(n)]), np.concatenate([low, np.arange(n)])
    form = sparse.csc_matrix((np.concatenate([-density, diagonal]), (rows, columns)), shape=(n, n))
    free = np.flatnonzero((state.free > 0.0).any(axis=1))
    form = form[free][:, free].tocsc()
    form.sort_indices()
    return Factors(form.indices, form.indptr).solve(form.data, np.ones(len(free))) is not None


def _share_pushed(system: System, state: State) -> float:
    return float((_densities(system, state)[1] < 0.0).mean())


def _densities(system: System, state: State) -> tuple[NDArray[np.int64], Floats]:
    """Ends (m, 2) and force densities (m,) of all springs; none of other forces."""
    from hookean.forces.springs import Springs

    pairs, found = [np.zeros((0, 2), np.int64)], [np.zeros(0)]
    for group, memory in zip(system.groups, state.memory, strict=True):
        if group.cls is Springs:
            index, p = group.block.indices, group.block.parameters
            d = state.x.take(index[:, 1], axis=0) - state.x.take(index[:, 0], axis=0)
            length = np.sqrt(np.einsum("ij,ij->i", d, d))
            rest = p[:, 2] * p[:, 3] + memory[:, 0]
            pairs.append(index)
            found.append(p[:, 0] * (1.0 - rest / np.where(length > 0.0, length, 1.0)))
    return np.concatenate(pairs), np.concatenate(found)


def _largest(forces: Floats) -> float:
    """The largest force (n, 3) on a particle."""
    return float(np.sqrt((forces * forces).sum(axis=1).max(initial=0.0)))
