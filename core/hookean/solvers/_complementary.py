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
from typing import TYPE_CHECKING, ClassVar

import numpy as np
from numpy.typing import NDArray

from hookean.compiled import dispatch
from hookean.forces.anchor_spring import AnchorSpring, slides
from hookean.forces.springs import Springs
from hookean.forces.unary import unary_kernel
from hookean.linear.profile_cholesky import fits, order
from hookean.solvers._climb import begin, onward, polish
from hookean.solvers.base import Solver

if TYPE_CHECKING:
    from hookean.system.balance import Balance
    from hookean.system.state import State
    from hookean.system.system import System

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

CHAINS = 0.8  # of the free particles have at most two springs; others may be stable in more than one shape
WORK = 200  # products a particle in the factor of a net that is little more than chains
STEPS = 25
NEAR = 1e-5  # of the model's size: a last step this short has nothing left to correct
FINE = 0.01  # of that: a correction this short is the last
FITS = 1e-3  # of squared rest lengths that lengths may be off by


class Method(Solver):
    """Newton in force densities; for cables and nets that are little more than chains of springs."""

    name: ClassVar[str] = "complementary"

    def __init__(self) -> None:
        self._moving: Ints = np.zeros(0, np.int64)
        self._step: Floats | None = None
        self.near: Floats | None = None  # positions (n, 3) at the highest point, as near as rounding let it come

    def refuse(self, system: System) -> str:
        """A sentence unless springs have no limits and all else is linear."""
        if system.contacts:
            return "a floor has no complementary energy; use auto"
        for group in system.groups:
            if group.cls is AnchorSpring and slides(group.block):
                return "an anchor spring may slide; use auto"
            if group.cls is AnchorSpring or group.cls.kernel is unary_kernel:
                continue
            if group.cls is not Springs:
                return f"{group.cls.__name__} is not a spring; use auto"
            if (group.block.parameters[:, 4:] != 0).any():
                return "a spring has a cutoff or plasticity; use auto"
        return ""

    def start(self, system: System, state: State) -> None:
        """Start from rest."""
        state.scratch.clear()
        state.v[:] = 0.0
        self._step = None

    def advance(self, system: System, state: State, count: int, goal: float) -> int:
        """All steps at once; none done, and nothing moved, where they do not lead to balance."""
        self._step, self.near, self.certain = None, None, False
        ground, pull = _linear(system, state)
        net = _net(system, state, ground, pull)
        if net is None:
            return 0
        moving = net.particles[: len(net.first)]
        x = state.x.take(net.particles, axis=0)
        ground, pull = ground[moving], pull.take(moving, axis=0)
        starts = np.zeros(len(moving) + 1, np.int64)
        np.cumsum(np.arange(1, len(moving) + 1) - net.first, out=starts[1:])
        given = (net.ends, net.k, net.rest, ground, pull, net.first, starts)
        q, gap, near = np.empty(len(net.k)), np.empty(len(net.k)), NEAR * system.size
        tangent, step = np.empty(9 * starts[-1] - 3 * len(moving)), np.empty((len(moving), 3))
        # what all springs are thought to bear at first
        tension = float(np.abs(pull).sum()) or 0.01 * float((net.k * net.rest).mean())
        if not dispatch.compiled(begin)(x, q, gap, *given, tension):
            return 0
        for done in range(1, min(count, STEPS) + 1):
            moved = dispatch.compiled(onward)(x, q, gap, *given, tangent)
            if moved == np.inf:
                break
            if moved > near:
                continue
            if (np.abs(gap) > FITS * net.rest * net.rest).any():
                break  # something is slack, and has no definite place
            self.near = state.x.copy()
            self.near[moving] = x[: len(moving)]
            if dispatch.compiled(polish)(x, *given, tangent, goal, FINE * near, step):
                state.x[moving] = x[: len(moving)]
                state.iteration += done
                self._moving, self._step = moving, step
                self.certain = True  # the matrix of q has a Cholesky factor
                return done
        return 0

    def correction(self, system: System, state: State, found: Balance) -> Floats | None:
        """The step after the last one, by the tangent of that."""
        if self._step is None:
            return None
        moved = np.zeros(state.x.shape)
        moved[self._moving] = self._step
        return moved


def _linear(system: System, state: State) -> tuple[Floats, Floats]:
    """Of each particle, the stiffness of anchor springs (n,), and loads with that stiffness times their targets (n, 3):
    what pulls at x is the second less the first times x."""
    n = len(state.x)
    ground, pull = np.zeros(n), system.evaluate(state, only="load")[0]
    for group in system.groups:
        if group.cls is AnchorSpring:
            particles, p = group.block.indices[:, 0], group.block.parameters
            ground += np.bincount(particles, p[:, 0], n)
            for axis in range(3):
                pull[:, axis] += np.bincount(particles, p[:, 0] * p[:, 1 + axis], n)
    return ground, pull


@dataclass(frozen=True)
class Net:
    """Springs of a system, the free particles first: `particles` has their numbers."""

    particles: Ints
    ends: Ints  # (m, 2) by their places among `particles`, lower first
    k: Floats
    rest: Floats
    first: Ints  # (free,) first column of each row of a matrix of the free ones


def _net(system: System, state: State, ground: Floats, pull: Floats) -> Net | None:
    """The net of a state; none where it is more than chains, or particles are held on some axes alone."""
    groups = [g.block for g in system.groups if g.cls is Springs]  # a system has one group of each force
    if not groups:
        return None
    springs = groups[0].indices, groups[0].parameters
    particles = np.empty(len(ground), np.int64)
    free = dispatch.compiled(chains)(state.free, *springs, ground, pull, CHAINS, particles)
    if not free:
        return None
    net = _numbered(free, particles, springs)
    if not fits(net.first, WORK):
        inner = net.ends[net.ends[:, 1] < free]
        found = order(free, inner[:, 0], inner[:, 1], WORK)
        if found is None:
            return None
        particles[:free] = particles[found]
        net = _numbered(free, particles, springs)
    return net


def _numbered(free: int, particles: Ints, springs: tuple[Ints, Floats]) -> Net:
    """The net in this order of the particles."""
    count = len(springs[0])
    net = Net(particles, np.empty((count, 2), np.int64), np.empty(count), np.empty(count), np.arange(free))
    some = dispatch.compiled(number)(*springs, particles, net.ends, net.k, net.rest, net.first)
    return Net(particles, net.ends[:some], net.k[:some], net.rest[:some], net.first)


def chains(free, indices, parameters, ground, pull, share, particles):  # type: ignore[no-untyped-def]
    """Put the free particles that something touches first; how many, 0 unless at least that share of them have two
    springs at most, some spring has a rest length, and none is held on some axes alone."""
    n = free.shape[0]
    springs, rests = np.zeros(n, np.int64), False
    for e in range(indices.shape[0]):
        one, other = indices[e, 0], indices[e, 1]
        if parameters[e, 0] > 0.0 and one != other and (free[one, 0] != 0.0 or free[other, 0] != 0.0):
            springs[one] += 1
            springs[other] += 1
            rests = rests or parameters[e, 2] * parameters[e, 3] > 0.0
    count, few, last = 0, 0, n
    for i in range(n):
        if free[i, 0] != free[i, 1] or free[i, 0] != free[i, 2]:
            return 0
        pulled = ground[i] > 0.0 or pull[i, 0] != 0.0 or pull[i, 1] != 0.0 or pull[i, 2] != 0.0
        if free[i, 0] != 0.0 and (springs[i] > 0 or pulled):  # what nothing touches stays where it is
            particles[count] = i
            count += 1
            few += springs[i] <= 2
        else:
            last -= 1
            particles[last] = i
    return count if rests and few >= share * count else 0


def number(indices, parameters, particles, ends, k, rest, first):  # type: ignore[no-untyped-def]
    """The springs that do something, by the places of their ends; how many."""
    place = np.empty(particles.shape[0], np.int64)
    for i in range(particles.shape[0]):
        place[particles[i]] = i
    count = 0
    for e in range(indices.shape[0]):
        one, other = place[indices[e, 0]], place[indices[e, 1]]
        low, high = min(one, other), max(one, other)
        if parameters[e, 0] > 0.0 and one != other and low < first.shape[0]:
            ends[count, 0], ends[count, 1] = low, high
            k[count], rest[count] = parameters[e, 0], parameters[e, 2] * parameters[e, 3]
            count += 1
            if high < first.shape[0]:
                first[high] = min(first[high], low)
    return count
