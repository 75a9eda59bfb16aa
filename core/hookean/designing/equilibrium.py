"""The equilibrium of a scene as its variables change, with the tangent there in factors.

At rest f(x, u) = 0 on the free axes. A change du of the unknowns moves held particles by H du and the others by dx,
K dx = (df/du - K_fh H) du, with K = -df/dx, the tangent stiffness. Films move across themselves alone, and their
vertices so that they stay even (see `even_films`).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import cached_property, partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.designing.cycles import LEFT, Cycles
from hookean.designing.even_films import Even, evenness
from hookean.designing.factors import Factored, Orders, Patterned, same
from hookean.designing.resting import resting
from hookean.forces.base import lengths
from hookean.running.result import Result
from hookean.running.run import relax_state
from hookean.scene.scene import Scene
from hookean.solvers import Solver, solver
from hookean.system.group import Group
from hookean.system.state import State
from hookean.system.system import Held, System

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

TIGHT = 1e-11  # residual [-] to which shapes are brought
NEAR = 1e-6, 1e-8  # residuals [-] from which exact steps are tried first
SOFTER = 1e-6  # part of the stiffness by which yielding differs from rounding
SLIGHT, NONE = 1e-8, 1e-11  # parts of the model's size: steps after which no other is needed, or no other tangent
NOTHING = 1e-15  # part of the diagonal: entries of the tangent that are rounding
POLISH = 6  # exact steps after that, while each leaves less
ROUNDING = 10.0  # times the rounding floor: what is out of balance there is rounding
ROUGH = 1e-4  # part that such a step may leave of the little that is out of balance
FOLLOWED = 12  # exact steps by which a shape is followed as variables change
NEARBY = 0.1  # part of the model's size: the largest of these where forces are not linear
SETTLED, FINISHED = 1e-8, 1e-13  # parts of it: steps that may be rounding, and steps that are nothing


class Equilibrium:
    """A shape at rest: its state, the result of the run that found it, and its tangent stiffness.

    `tangent` (3n, 3n) is sparse, of all axes; `basis` (3n, r) the motions that are free. With `once` it is solved with
    once or twice, and the system does not change before that: then large nets need no factors.
    """

    def __init__(
        self,
        system: System,
        state: State,
        result: Result | None,
        orders: Orders | None = None,
        *,
        once: bool = False,
        method: Solver | None = None,
        even: Even | None = None,
    ) -> None:
        self.system, self.state, self._result, self.once, self._method = system, state, result, once, method
        self.even = even
        self.orders = orders or Orders()
        self._tangent = None if once else tangent(system, state)  # later the system has other values
        self.resting = resting(system, state)
        self.basis = _basis(system, state, self.resting.motions, even is not None)
        self._factor: Factored | None = None
        self.yielded: list[str] = []  # kinds of forces that have yielded on the way here

    def again(self) -> Equilibrium:
        """That of the state as it is now."""
        return Equilibrium(self.system, self.state, self._result, self.orders, once=self.once, method=self._method)

    @property
    def x(self) -> Floats:
        """Positions (n, 3) [length]."""
        return self.state.x

    @property
    def result(self) -> Result:
        """The result of the run that found the shape, or of one that starts from it."""
        if self._result is None:
            self._result = _relaxed(self.system, self.state)[0]
        return self._result

    @property
    def converged(self) -> bool:
        """Whether the shape is at rest; one without a run of its own was followed to rest."""
        return self._result is None or self._result.converged

    @property
    def tangent(self) -> Any:
        """The tangent stiffness of all axes."""
        if self._tangent is None:
            self._tangent = tangent(self.system, self.state)
        return self._tangent

    @cached_property
    def response(self) -> Any:
        """By what motions change what is 0 at rest: the tangent; of even films that and how their vertices follow."""
        return self.tangent if self.even is None else self.even.tangent(self.system, self.state, self.tangent)

    def counted(self, forces: Any) -> Any:
        """The part of forces (3n,) or (3n, u) that is 0 at rest."""
        if self.even is None:
            return forces
        return self.even.counts(self.system, self.x, self.state.free) @ forces

    def resisted(self, y: Floats, places: Ints) -> Floats:
        """K^T y (3n,) at some coordinates, of all axes, for a motion y (3n,); 0 at the others."""
        total = np.zeros(len(y))
        if self._tangent is not None or self.even is not None:
            total[places] = (self.response.T @ y)[places]
            return total
        for axes, blocks in _blocks(self.system, self.state, places // 3):
            total += np.bincount(axes.ravel(), np.einsum("eab,ea->eb", blocks, y[axes]).ravel(), len(total))
        kept = np.zeros(len(total))
        kept[places] = total[places]
        return kept

    @cached_property
    def _cycles(self) -> Cycles | None:
        """What solves without factors."""
        if (
            not self.once
            or self.even
            or self.resting.motions
            or len(self.basis.indices) < np.count_nonzero(self.state.free)
        ):
            return None
        cycles = Cycles(self.system, self.state, self._method)
        return cycles if cycles.usable else None

    @cached_property
    def _patterned(self) -> Patterned | None:
        """What solves by the solver's pattern, where that has all free motions and no others."""
        known = None if self._method is None else self._method.pattern
        if not self.once or self.even or known is None or self.system.contacts or not self.symmetric:
            return None
        found = Patterned(self.system, self.state, known)
        usable = found.factor is not None and len(found.pattern.dofs) == self.basis.shape[1]
        return found if usable else None

    @property
    def symmetric(self) -> bool:
        """Whether forces come from an energy, so that the tangent is symmetric."""
        return self.even is None and all(g.conservative or g.cls.constant for g in self.system.groups)

    @cached_property
    def reduced(self) -> Any:
        """The tangent (r, r) on the free motions, without entries that are rounding."""
        whole = (self.basis.T @ self.response @ self.basis).tocsc()
        size = np.abs(whole.diagonal())
        columns = np.repeat(np.arange(whole.shape[1]), np.diff(whole.indptr))
        whole.data[np.abs(whole.data) <= NOTHING * np.minimum(size[whole.indices], size[columns])] = 0.0
        whole.eliminate_zeros()
        return whole

    @property
    def factor(self) -> Factored:
        """The reduced tangent in factors."""
        if self._factor is None:
            skew = self.system.films is not None or len(self.basis.indices) > self.basis.shape[1]
            axes = None if skew else self.basis.indices % 3
            self._factor = Factored(self.reduced, axes, self.symmetric, self.orders)
        return self._factor

    def take_factor(self, other: Equilibrium) -> bool:
        """Use the factors of another equilibrium if both have the same tangent; whether that was so."""
        if self.system.films is None and same(self.reduced, other.reduced):
            self._factor = other.factor
            return True
        return False

    def solve(self, b: Floats, *, transposed: bool = False, left: float = LEFT) -> Floats:
        """K^-1 b, or K^-T b, (3n,) on the free motions; 0 on the others. NaN where K is singular. Without factors a
        part `left` of b may remain."""
        if self._factor is None and self._cycles is not None:
            found = self._cycles.solve(b, left)
            if found is not None:
                return found.ravel()
        if self._factor is None and self._patterned is not None:
            return self._patterned.solve(b)
        right = self.basis.T @ b
        if not len(right):
            return np.zeros(len(b))
        return np.asarray(self.basis @ self.factor.solve(right, transposed=transposed))


def follow(before: Equilibrium) -> Equilibrium | None:
    """The equilibrium near one whose variables have changed since, by Newton's method alone; None unless that leads to
    a stable shape nearby. Forces that remember need a run of their own."""
    system, state = before.system, before.state
    if system.films is not None or system.contacts or system.yields:
        return None
    memory = [each.copy() for each in state.memory]
    start, size, last = state.x.copy(), system.size, np.inf
    now = Equilibrium(system, state, None, before.orders)
    now.take_factor(before)
    for _ in range(FOLLOWED):
        step = now.solve(_left(system, state).ravel()).reshape(-1, 3)
        length = float(lengths(step).max(initial=0.0))  # NaN where the tangent is singular
        slower = length > 0.5 * last
        if length <= (SETTLED if slower else FINISHED) * size:
            system.remember(state)
            if all(map(np.array_equal, memory, state.memory)):
                return now
            break
        if slower or now.factor.negatives or not np.isfinite(length):
            break
        state.x = state.x + step
        after = Equilibrium(system, state, None, before.orders)
        linear = after.take_factor(now)
        if not linear and length > NEARBY * size:
            break
        now, last = after, length
    state.x, state.memory = start, memory
    return None


def settle(system: System, state: State, orders: Orders | None = None, *, once: bool = False) -> Equilibrium:
    """Bring a state to rest with the scene's solver, and to the last digit by exact steps; `once`: see Equilibrium,
    and such steps begin earlier if they lead there."""
    before = [memory.copy() for memory in state.memory]
    for residual in (*NEAR, TIGHT) if once else (TIGHT,):
        result, method = _relaxed(system, state, residual)
        found = Equilibrium(system, state, result, orders, once=once, method=method)
        found, part = _polished(found)
        if part * result.residual <= max(TIGHT, ROUNDING * result.rounding_floor):
            break
    found = _evened(found)
    found.yielded = _yielded(system, state, before)
    return found


def _evened(found: Equilibrium) -> Equilibrium:
    """That of films with their vertices where they are even, if there is one."""
    system, state, orders = found.system, found.state, found.orders
    even = evenness(system, state.free) if orders.even is None else orders.even
    if even is None or not found.converged:
        return found
    start, orders.even = state.x.copy(), even
    if even.reach(system, state, lambda: tangent(system, state)):
        there = state.x.copy()
        result, method = _relaxed(system, state)
        if result.converged and lengths(state.x - there).max(initial=0.0) <= SLIGHT * system.size:
            state.x = there
            return Equilibrium(system, state, result, orders, once=found.once, method=method, even=even)
    state.x = start
    return found


def _relaxed(system: System, state: State, residual: float = TIGHT) -> tuple[Result, Solver]:
    """The result of a run to a small residual [-], and the solver with what it ended with."""
    settings = system.scene.settings
    tight = settings.replaced(tolerance=min(settings.tolerance, residual), position_tolerance=None)
    system.scene = system.scene.replaced(settings=tight)
    method = solver(settings.solver)
    result = relax_state(system, state, method)
    system.scene = system.scene.replaced(settings=settings)
    return result, method


def _yielded(system: System, state: State, before: list[Floats]) -> list[str]:
    """Kinds of forces that were softer on the way to a shape than they are back from it."""
    found = []
    for group, now, then in zip(system.groups, state.memory, before, strict=True):
        if not np.array_equal(now, then):
            ways = [system.stiffness_blocks(group, state, memory) for memory in (now, then)]
            if np.abs(ways[0] - ways[1]).max(initial=0.0) > SOFTER * np.abs(ways[0]).max(initial=0.0):
                found.append(group.cls.kind_name)
    return found


def _polished(found: Equilibrium) -> tuple[Equilibrium, float]:
    """Exact steps, while each leaves less out of balance, and the part that they leave; one is enough where it is
    slight, for the next is its square."""
    system, state, once, result = found.system, found.state, found.once, found.result
    left = _left(system, state)
    first = float(lengths(left).max(initial=0.0))
    rounding = once and result.residual <= ROUNDING * result.rounding_floor  # nothing is left that a step would meet
    for _ in range(0 if rounding else POLISH):
        step = found.solve(left.ravel(), left=ROUGH).reshape(-1, 3)
        size = lengths(left).max(initial=0.0)
        if not np.isfinite(step).all() or size == 0.0:
            break
        start = state.x.copy()
        state.x = start + step
        now = _left(system, state)
        if lengths(now).max(initial=0.0) >= 0.5 * size:
            state.x = start
            break
        left = now
        length = lengths(step).max(initial=0.0) / system.size
        slight = length <= SLIGHT
        if slight and once:
            found = found.again() if length > NONE else found
            break
        if not slight:
            before, found = found, found.again()
            if not once:
                found.take_factor(before)
    result.take_shape(system, state)
    return found, float(lengths(left).max(initial=0.0)) / first if first > 0.0 else 0.0


def _left(system: System, state: State) -> Floats:
    """What is out of balance (n, 3) [force]."""
    left = system.evaluate(state)[0] * state.free
    if system.contacts:
        system.support(state, left)
    if system.films is not None:
        system.films.across(state.x, state.free, left)
    return left


def _basis(system: System, state: State, resting: dict[int, Floats], even: bool) -> Any:
    """The free motions (3n, r): free axes of particles that something holds; of films the axes that count, unless they
    are `even`; along the floor of what rests on it."""
    from scipy.sparse import csc_matrix

    parts = system.components(state)
    free = state.free.copy()
    loose = np.flatnonzero(parts.label >= 0)
    free[loose[~parts.joined[parts.label[loose]]]] = 0.0
    n = len(free)
    if system.films is None or even:
        free[list(resting)] = 0.0
        axes = np.flatnonzero(free.ravel() > 0.0)
        basis = csc_matrix((np.ones(len(axes)), (axes, np.arange(len(axes)))), shape=(3 * n, len(axes)))
        return _with_motions(basis, resting)
    frames, counts = system.films.frames(state.x, free)
    particle, rank = np.nonzero(counts > 0.0)
    rows = (3 * particle[:, None] + np.arange(3)).ravel()
    columns = np.repeat(np.arange(len(particle)), 3)
    return csc_matrix((frames[particle, rank].ravel(), (rows, columns)), shape=(3 * n, len(particle)))


def _with_motions(basis: Any, resting: dict[int, Floats]) -> Any:
    """Free motions (3n, r), and those of particles that rest on a floor."""
    from scipy.sparse import csc_matrix, hstack

    if not resting:
        return basis
    particle = np.repeat(list(resting), [len(motions) for motions in resting.values()])
    rows = 3 * particle[:, None] + np.arange(3)
    values = np.concatenate(list(resting.values()))
    columns = np.repeat(np.arange(len(particle)), 3)
    along = csc_matrix((values.ravel(), (rows.ravel(), columns)), shape=(basis.shape[0], len(particle)))
    along.eliminate_zeros()
    return hstack([basis, along], format="csc")


def tangent(system: System, state: State) -> Any:
    """-df/dx (3n, 3n) [force/length] as a sparse matrix, held axes included; of forces without an energy it is not
    symmetric."""
    from scipy.sparse import coo_matrix

    size = state.x.size
    none = np.zeros(0, np.int64)
    rows, columns, values = [none], [none], [np.zeros(0)]
    for axes, blocks in _blocks(system, state, None):
        rows.append(np.broadcast_to(axes[:, :, None], blocks.shape).ravel())
        columns.append(np.broadcast_to(axes[:, None, :], blocks.shape).ravel())
        values.append(blocks.ravel())
    places = np.concatenate(rows), np.concatenate(columns)
    return coo_matrix((np.concatenate(values), places), shape=(size, size)).tocsc()


def _blocks(system: System, state: State, particles: Ints | None) -> Iterator[tuple[Ints, Floats]]:
    """The axes (m, 3 arity) and tangents (m, 3 arity, 3 arity) of the elements of each group; of those alone that have
    some of the `particles`, if given."""
    for group, memory in system.elements(state.x, state.memory):
        if group.cls.constant or not len(group.block.indices):
            continue
        if particles is not None and group.cls.tangent is None:
            some = np.zeros(len(state.x), dtype=bool)
            some[particles] = True
            rows = np.flatnonzero(some[group.block.indices].any(axis=1))
            group, memory = Group(group.cls, group.block.some(rows), []), memory[rows]
        given = system.stiffness_blocks if group.conservative else partial(_slopes, system)
        blocks = given(group, state, memory)
        yield (3 * group.block.indices[:, :, None] + np.arange(3)).reshape(len(blocks), -1), blocks


def _slopes(system: System, group: Group, state: State, memory: Floats) -> Floats:
    """-df/dx of each element (m, 3 arity, 3 arity) by central differences of its forces, as it is."""
    index = group.block.indices
    count, arity = index.shape
    blocks = np.zeros((count, 3 * arity, 3 * arity))
    reach = np.ptp(state.x[index], axis=1).max(axis=1)
    step = 1e-6 * np.where(reach > 0.0, reach, 1.0)
    for corner in range(arity):
        for axis in range(3):
            sides = [
                _moved(system, group, state, memory, corner, axis, sign * step).reshape(count, -1) for sign in (-1, 1)
            ]
            blocks[:, :, 3 * corner + axis] = (sides[0] - sides[1]) / (2.0 * step)[:, None]
    return blocks


def _moved(system: System, group: Group, state: State, memory: Floats, corner: int, axis: int, step: Floats) -> Floats:
    """Forces of elements (m, arity, 3), each with one of its corners moved."""
    index = group.block.indices
    count, arity = index.shape
    private = state.x[index].reshape(-1, 3).copy()
    private[corner::arity, axis] += step
    alone = replace(group.block, indices=np.arange(count * arity, dtype=np.int64).reshape(count, arity), plan=[])
    return system.element_forces(Group(group.cls, alone, []), replace(state, x=private), memory)


def as_held(scene: Scene, held: list[Held]) -> Scene:
    """A scene with these anchors where they are held."""
    anchors = list(scene.anchors)
    for anchor in held:
        if anchor.number >= 0:
            old = anchors[anchor.number]
            given = old.particles if old.points is None else old.points
            if given is not None and len(given) == len(anchor.targets):
                anchors[anchor.number] = old.replaced(targets=anchor.targets)
    return scene.replaced(anchors=tuple(anchors))
