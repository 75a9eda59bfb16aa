"""Complementary energy: Newton steps in the force densities of a net instead of its positions.

A stiff chain can only move along a curved path, which Newton steps in positions leave at once and return to in
hundreds of small ones. Its forces vary gently. With a force density q for every spring the positions x(q) are the
solution of a linear system (Schek), in balance with the loads whatever q is, and only the lengths do not fit yet: the
spring law asks for l(q) = L0 / (1 - q/k). Since the energy k (l - L0)^2 / 2 is convex in s = l^2 / 2, with derivative
q, its conjugate is L0^2 q / (1 - q/k) / 2, and the q sought is the highest point of

    D(q) = min over x of [sum q s(x) - F . x] - sum L0^2 q / (1 - q/k) / 2,

which is concave: no start matters. Its gradient is s(x(q)) - l(q)^2 / 2, and a Newton step in q one solution of
(sum of q I + (k L0 / l^3) d d^T) dx = - sum of (k L0 / l^3) (s - l^2 / 2) d, d from end to end of each spring.
Where the matrix of q is positive definite the shape found is the lowest of all (super stability).
Sources: Schek, "The force density method for form finding and computation of general networks", 1974; Kanno and
Ohsaki, "Minimum principle of complementary energy of cable networks by using second-order cone programming", 2003;
Connelly, "Rigidity and energy", 1982.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from hookean import kernels
from hookean.forces.anchor_spring import AnchorSpring
from hookean.forces.springs import Springs
from hookean.forces.unary import unary_kernel
from hookean.kernels import device
from hookean.solvers._profile import factor, first_entries, order, solve
from hookean.solvers.base import Solver

if TYPE_CHECKING:
    from hookean.state import State
    from hookean.system import System

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

CHAINS = 0.8  # of the free particles have at most two springs; others may be stable in more than one shape
WORK = 200  # products a particle in the factor of a net that is little more than chains
STEPS = 25
POLISH = 4
NEAR = 1e-5  # of the model's size: a last step this short has nothing left to correct


@device
def settle(x: Any, ends: Any, q: Any, k: Any, rest: Any, ground: Any, pull: Any, first: Any, starts: Any, matrix: Any,
           left: Any, gap: Any) -> Any:  # fmt: skip
    """Move the free particles to where force densities q balance the loads; False where nothing holds them.

    `gap` becomes half the squared length of each spring, less that of the length its force density asks for.
    """
    free = ground.shape[0]
    matrix[:] = 0.0
    for i in range(free):
        matrix[starts[i + 1] - 1] = ground[i]
        for c in range(3):
            left[c, i] = pull[i, c] - ground[i] * x[i, c]
    for e in range(ends.shape[0]):
        low, high = ends[e, 0], ends[e, 1]
        for c in range(3):
            force = q[e] * (x[high, c] - x[low, c])
            left[c, low] += force
            if high < free:
                left[c, high] -= force
        matrix[starts[low + 1] - 1] += q[e]
        if high < free:
            matrix[starts[high + 1] - 1] += q[e]
            matrix[starts[high] + low - first[high]] -= q[e]
    if not factor(matrix, starts, first):
        return False
    for c in range(3):
        solve(matrix, starts, first, left[c])
        for i in range(free):
            x[i, c] += left[c, i]
    for e in range(ends.shape[0]):
        gap[e] = 0.0
        if rest[e] > 0.0:
            low, high = ends[e, 0], ends[e, 1]
            asked = rest[e] / (1.0 - q[e] / k[e])
            for c in range(3):
                gap[e] += 0.5 * (x[high, c] - x[low, c]) ** 2
            gap[e] -= 0.5 * asked * asked
    return True


def share(tension, x, ends, q, k, rest, ground, pull, first, starts, matrix, left, gap):  # type: ignore[no-untyped-def]
    """Give all springs one tension; how D changes with its logarithm, nan where it holds nothing."""
    for e in range(ends.shape[0]):
        q[e] = tension / (rest[e] + tension / k[e]) if rest[e] > 0.0 else k[e]
    if not settle(x, ends, q, k, rest, ground, pull, first, starts, matrix, left, gap):
        return np.nan
    slope = 0.0
    for e in range(ends.shape[0]):
        slope += gap[e] * q[e] * (1.0 - q[e] / k[e])
    return slope


def attempt(  # type: ignore[no-untyped-def]
    part, careful, x, ends, q, dq, k, rest, ground, pull, first, starts, matrix, left, gap, now
):
    """Take force densities `now` a part of a step away; how D changes there along the step, nan where nothing holds.

    Where they grow it is the length asked for that grows evenly, so that none reaches k; with care none falls below a
    tenth of itself.
    """
    rate = dq.copy()
    for e in range(ends.shape[0]):
        now[e] = q[e] + part * dq[e]
        if dq[e] > 0.0:
            # the length asked for is L0 times this, and grows by dq / k times its square
            grown = 1.0 / (1.0 - q[e] / k[e])
            more = 1.0 + part * dq[e] / k[e] * grown
            now[e] = k[e] * (1.0 - 1.0 / (grown * more))
            rate[e] /= more * more
        elif careful and q[e] > 0.0 and now[e] < 0.1 * q[e]:
            now[e] = 0.1 * q[e]
            rate[e] = 0.0
    if not settle(x, ends, now, k, rest, ground, pull, first, starts, matrix, left, gap):
        return np.nan
    slope = 0.0
    for e in range(ends.shape[0]):
        slope += gap[e] * rate[e]
    return slope


def direction(x, ends, q, k, rest, ground, gap, first, starts, matrix, step, dq):  # type: ignore[no-untyped-def]
    """The Newton step of the force densities; how D changes along it, nan where the tangent is not definite."""
    free = ground.shape[0]
    matrix[:] = 0.0
    step[:] = 0.0
    for i in range(free):
        for c in range(3):
            matrix[starts[3 * i + c + 1] - 1] = ground[i]
    d, stiff = np.empty(3), np.zeros(ends.shape[0])
    for e in range(ends.shape[0]):
        low, high = ends[e, 0], ends[e, 1]
        if rest[e] > 0.0:
            asked = rest[e] / (1.0 - q[e] / k[e])
            stiff[e] = k[e] * rest[e] / (asked * asked * asked)
        for c in range(3):
            d[c] = x[high, c] - x[low, c]
        for c in range(3):
            near = starts[3 * low + c + 1] - 1 - c
            step[3 * low + c] += stiff[e] * gap[e] * d[c]
            far, across = 0, 0
            if high < free:
                far = starts[3 * high + c + 1] - 1 - c
                across = far - 3 * (high - low)
                step[3 * high + c] -= stiff[e] * gap[e] * d[c]
            for o in range(3):
                entry = stiff[e] * d[c] * d[o] + (q[e] if c == o else 0.0)
                if o <= c:
                    matrix[near + o] += entry
                if high < free:
                    if o <= c:
                        matrix[far + o] += entry
                    matrix[across + o] -= entry
    if not factor(matrix, starts, first):
        return np.nan
    solve(matrix, starts, first, step)
    slope = 0.0
    for e in range(ends.shape[0]):
        low, high = ends[e, 0], ends[e, 1]
        stretch = gap[e]
        for c in range(3):
            other = step[3 * high + c] if high < free else 0.0
            stretch += (x[high, c] - x[low, c]) * (other - step[3 * low + c])
        dq[e] = stiff[e] * stretch
        slope += gap[e] * dq[e]
    return slope


def out_of_balance(x, ends, k, rest, ground, pull, left):  # type: ignore[no-untyped-def]
    """The largest force that the springs' own law leaves on a particle; infinite where a spring has no length."""
    free = ground.shape[0]
    for i in range(free):
        for c in range(3):
            left[c, i] = pull[i, c] - ground[i] * x[i, c]
    for e in range(ends.shape[0]):
        low, high = ends[e, 0], ends[e, 1]
        length = np.sqrt((x[high, 0] - x[low, 0]) ** 2 + (x[high, 1] - x[low, 1]) ** 2 + (x[high, 2] - x[low, 2]) ** 2)
        if not length > 0.0 and rest[e] > 0.0:
            return np.inf  # no direction to push in: the highest energy, not the lowest
        density = k[e] * (length - rest[e]) / length if length > 0.0 else 0.0
        for c in range(3):
            force = density * (x[high, c] - x[low, c])
            left[c, low] += force
            if high < free:
                left[c, high] -= force
    worst = 0.0
    for i in range(free):
        worst = max(worst, left[0, i] ** 2 + left[1, i] ** 2 + left[2, i] ** 2)
    return np.sqrt(worst)


@dataclass(frozen=True)
class Net:
    """Springs of a system, the free particles first: `particles` says which is which. `ends` (m, 2), lower first."""

    particles: Ints
    ends: Ints
    k: Floats
    rest: Floats
    ground: Floats  # (free,) stiffness of anchor springs
    pull: Floats  # (free, 3) loads, and anchor springs' stiffness times target
    first: Ints


class Climb:
    """The way to the highest point of D: force densities `q`, positions `x` and the misfit of lengths."""

    def __init__(self, net: Net, x: Floats) -> None:
        self.net, self.x = net, x
        free, m = len(net.first), len(net.k)
        self.starts = _starts(net.first)
        self.first3 = np.repeat(3 * net.first, 3)
        self.starts3 = _starts(self.first3)
        self.matrix, self.matrix3 = np.empty(self.starts[-1]), np.empty(self.starts3[-1])
        self.left, self.step = np.empty((3, free)), np.empty(3 * free)
        self.q, self.gap, self.dq, self.now = np.empty(m), np.empty(m), np.empty(m), np.empty(m)
        self.springs = (net.k, net.rest, net.ground)
        self.given = (*self.springs, net.pull, net.first, self.starts, self.matrix, self.left, self.gap)

    def share(self, tension: float) -> float:
        """Give all springs one tension [force]; how D changes with its logarithm, nan where it holds nothing."""
        return float(kernels.compiled(share)(tension, self.x, self.net.ends, self.q, *self.given))

    def begin(self, tension: float) -> bool:
        """From the best tension that all springs could share, within a factor of 2; False where there is none."""
        slope = self.share(tension)
        factor = 4.0 if slope > 0.0 else 0.25
        rising = slope > 0.0
        for _ in range(60):
            if np.isnan(slope) or (slope > 0.0) != rising:
                break
            tension *= factor
            slope = self.share(tension)
        return not np.isnan(self.share(tension / factor**0.5))

    def onward(self) -> bool:
        """One Newton step, shortened until D does not fall beyond it; False where there is none."""
        ends = self.net.ends
        slope = kernels.compiled(direction)(
            self.x, ends, self.q, *self.springs, self.gap, self.first3, self.starts3, self.matrix3, self.step, self.dq
        )
        if np.isnan(slope):
            return False
        for part, careful in ((1.0, False), *((0.5**i, True) for i in range(10))):
            there = kernels.compiled(attempt)(part, careful, self.x, ends, self.q, self.dq, *self.given, self.now)
            if there >= -0.9 * slope:
                self.q, self.now = self.now, self.q
                return True
        return False

    def out_of_balance(self) -> float:
        """The largest force left on a particle."""
        net = self.net
        return float(kernels.compiled(out_of_balance)(self.x, net.ends, *self.springs, net.pull, self.left))

    def polish(self, goal: float) -> bool:
        """Correct positions by what the springs' own law leaves; False, and back, unless that comes to the goal.

        Rounding of lengths makes force densities uncertain by k / T times as much, and with them x(q).
        """
        start, left = self.x.copy(), self.out_of_balance()
        free, tangent = len(self.left[0]), (self.matrix3, self.starts3, self.first3)
        for _ in range(POLISH):
            if left <= goal:
                return True
            step = self.left.T.flatten()
            kernels.compiled(solve)(*tangent, step)
            self.x[:free] += step.reshape(free, 3)
            left = self.out_of_balance()
        if left > goal:
            self.x = start
        return left <= goal


def _starts(first: Ints) -> Ints:
    """Where each row begins, and the last one ends, if rows go from their first entry to the diagonal."""
    starts = np.zeros(len(first) + 1, np.int64)
    np.cumsum(np.arange(1, len(first) + 1) - first, out=starts[1:])
    return starts


class Method(Solver):
    """Newton in force densities; for cables and nets that are little more than chains of springs."""

    name: ClassVar[str] = "complementary"

    def refuse(self, system: System) -> str:
        """A sentence unless springs have no limits and all else is linear."""
        if system.contacts:
            return "a floor has no complementary energy; take auto"
        for group in system.groups:
            if group.cls is AnchorSpring or group.cls.kernel is unary_kernel:
                continue
            if group.cls is not Springs:
                return f"{group.cls.__name__} is not a spring; take auto"
            if (group.block.parameters[:, 4:] != 0).any():
                return "a spring has a cutoff or plasticity; take auto"
        return ""

    def start(self, system: System, state: State) -> None:
        """Start from rest."""
        state.scratch.clear()
        state.v[:] = 0.0

    def advance(self, system: System, state: State, count: int, goal: float) -> int:
        """All steps at once; none done, and nothing moved, where they do not lead to balance."""
        net = _net(system, state)
        if net is None:
            return 0
        free = len(net.first)
        climb = Climb(net, state.x[net.particles])
        load = float(np.abs(net.pull).sum())
        if not climb.begin(load if load > 0.0 else 0.01 * float((net.k * net.rest).mean())):
            return 0
        near = NEAR * system.size
        for done in range(1, min(count, STEPS) + 1):
            before = climb.x[:free].copy()
            if not climb.onward():
                return 0
            if np.abs(climb.x[:free] - before).max() <= near and climb.polish(goal):
                state.x[net.particles[:free]] = climb.x[:free]
                state.iteration += done
                return done
        return 0


def _net(system: System, state: State) -> Net | None:
    """The net of a state; none where it is more than chains, or particles are held on some axes alone."""
    held = state.free[:, 0] == 0.0
    if not all(np.array_equal(state.free[:, 0], state.free[:, axis]) for axis in (1, 2)):
        return None
    n = len(held)
    one, other, k, rest = _springs(system, held)
    ground, pull = np.zeros(n), system.evaluate(state, only="load")[0]
    for group in system.groups:
        if group.cls is AnchorSpring:
            particles, p = group.block.indices[:, 0], group.block.parameters
            ground += np.bincount(particles, p[:, 0], n)
            for axis in range(3):
                pull[:, axis] += np.bincount(particles, p[:, 0] * p[:, 1 + axis], n)
    springs = np.bincount(one, minlength=n) + np.bincount(other, minlength=n)
    # what nothing touches stays where it is
    free = ~held & ((springs > 0) | (ground > 0) | (pull[:, 0] != 0) | (pull[:, 1] != 0) | (pull[:, 2] != 0))
    count = int(free.sum())
    if not count or not (rest > 0).any() or (springs[free] <= 2).sum() < CHAINS * count:
        return None
    particles = np.concatenate([np.flatnonzero(free), np.flatnonzero(~free)])
    low, high = _numbered(particles, one, other)
    inner = high < count
    found = order(count, low[inner], high[inner], WORK)
    if found is None:
        return None
    particles[:count] = particles[found]
    low, high = _numbered(particles, one, other)
    inner = high < count
    first = first_entries(count, low[inner], high[inner])
    chosen = particles[:count]
    ends = np.column_stack([low, high])
    return Net(particles, ends, k, rest, ground[chosen], np.ascontiguousarray(pull[chosen]), first)


def _numbered(particles: Ints, one: Ints, other: Ints) -> tuple[Ints, Ints]:
    """Ends of the springs, lower first, by their places among `particles`."""
    place = np.empty(len(particles), np.int64)
    place[particles] = np.arange(len(particles))
    return np.minimum(place[one], place[other]), np.maximum(place[one], place[other])


def _springs(system: System, held: NDArray[np.bool_]) -> tuple[Ints, Ints, Floats, Floats]:
    """Both ends, stiffness and rest length of the springs that do something."""
    groups = [g for g in system.groups if g.cls is Springs]
    if not groups:
        return np.zeros(0, np.int64), np.zeros(0, np.int64), np.zeros(0), np.zeros(0)
    ends, p = groups[0].block.indices, groups[0].block.parameters  # a system has one group of each force
    one, other = ends.T
    acts = np.flatnonzero((p[:, 0] > 0) & (one != other) & ~(held[one] & held[other]))
    p = p[acts]
    return one[acts], other[acts], p[:, 0].copy(), p[:, 2] * p[:, 3]
