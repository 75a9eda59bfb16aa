"""Steps of given arc length along the equilibrium path of a structure under loads that grow by one factor."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.analysis.at_rest import AtRest
from hookean.analysis.matrices import Unknowns, against_turns, factor
from hookean.errors import InputError
from hookean.system.balance import ROUNDING
from hookean.system.state import State
from hookean.system.system import System

Floats = NDArray[np.float64]

ITERATIONS = 15  # Newton steps to a point; more are taken as a step that is too long
WANTED = 5  # of them: a step that takes more makes the next one shorter
CUTS = 30  # times a step is halved
BALANCED = 1e-11  # out of balance, as a part of the largest force
SETTLED = 1e-14  # a Newton step that moves nothing any more, as a part of the model's size
HALVINGS = 40  # of a bracket
PARTS = (0.5, 0.4, 0.65, 0.25, 0.8)  # of a bracket where its next point is tried, the first that is found
NEAR = 1e-6  # of a step: two points of one path on both sides of a change are nearer than that
FLAT = 1e-6  # of the rates about it: that of the load factor at a limit point
RETAKEN = 8  # times a step that leaves its path is taken again, half as long
STRAIGHT = 0.8  # cosine between a step and the path at both of its ends: one that turns more may have left its path
STIFFER = 3.0  # times the largest rate of the load factor so far: one beyond it may have left its path, too
LEVEL = 1e-3  # likewise, as near as halving comes


@dataclass(frozen=True)
class Point:
    """A point of a path: the shape `x` (n, 3), the load factor, the tangent movement (u,) for a unit of the factor,
    the number of negative eigenvalues of the tangent, and the movement (u,) that led to it from the point before."""

    x: Floats
    factor: float
    tangent: Floats
    negatives: int
    moved: Floats
    iterations: int = 0

    def rate(self) -> float:
        """The change of the load factor along the path, by its arc length; its sign is that of the way it goes."""
        size = float(np.linalg.norm(self.tangent))
        ahead = float(self.tangent @ self.moved)
        return float(np.copysign(1.0 / size, ahead if ahead != 0.0 else 1.0)) if size > 0.0 else 0.0


class Follower:
    """A structure at rest, and a system of the loads that grow."""

    def __init__(self, rest: AtRest, load_system: System, load_state: State) -> None:
        self.rest, self.loads, self.load_state = rest, load_system, load_state
        self.state = rest.state.copy()
        self.unknowns = Unknowns.of(rest.system, rest.state, rest.free)
        self.shortened = 1.0
        self.steepest = 0.0  # rate of the load factor at all points
        self.hinged = False  # whether the tangent is singular at the start
        self.constant = all(group.cls.constant for group in load_system.groups)

    def first(self) -> Point:
        """The point without the loads."""
        matrix = self.unknowns.tangent(self.rest.system, self.rest.state)
        self.hinged = factor(matrix) is None
        solved = self._solve(self.rest.state.x, 0.0)
        if solved is None or solved[2] or factor(self._held(matrix)) is None:
            said = "without these loads the structure has no stiffness against some motion; brace or prestress it"
            raise InputError("model", said)
        _, tangent, negatives = solved
        return Point(self.rest.state.x.copy(), 0.0, tangent, negatives, np.zeros_like(tangent))

    def reach(self, point: Point, increment: float) -> float:
        """The arc length of a first step of this load factor; its sign is kept as the way to go."""
        self.way = 1.0 if increment > 0.0 else -1.0
        return abs(increment) * float(np.linalg.norm(point.tangent))

    def onward(self, points: list[Point], reach: float) -> tuple[Point | None, list[tuple[str, Point]]]:
        """The next point, `reach` away or less, and the critical points before it: by shorter steps where one leaves
        its path. After `RETAKEN` of them the path goes on where the last one came to. The first step may be any number
        of times too long, since its length is given by a load factor."""
        tried, step = self.shortened, self.step(points, reach)
        for _ in range(RETAKEN if len(points) > 1 else CUTS):
            if step is None:
                break
            found = self.between(points[-1], step) if self._followed(points[-1], step) else None
            if found is not None:
                self.steepest = max(self.steepest, abs(step.rate()))
                return step, found
            self.shortened = tried = 0.5 * min(tried, self.shortened)
            step = self.step(points, reach)
        return step, (step and self.between(points[-1], step)) or []

    def step(self, points: list[Point], reach: float) -> Point | None:
        """The next point, `reach` away or less; None if no step is short enough to find one."""
        for _ in range(CUTS):
            found = self.at_arc(points[-1], reach * self.shortened)
            if found is not None:
                if found.iterations <= WANTED:
                    self.shortened = min(1.0, 1.5 * self.shortened)
                return found
            self.shortened *= 0.5
        return None

    def at_arc(self, last: Point, reach: float) -> Point | None:
        """The point at this arc length after another."""
        size = float(np.linalg.norm(last.tangent))
        if not (size > 0.0 and reach > 0.0):
            return None
        ahead = float(last.tangent @ last.moved) if last.moved.any() else getattr(self, "way", 1.0)
        turn = np.copysign(reach / size, ahead)
        moved, load, before = turn * last.tangent, last.factor + turn, np.inf
        for iteration in range(ITERATIONS):
            solved = self._solve(last.x + self.unknowns.spread(moved), load)
            if solved is None:
                return None
            left, tangent, negatives = solved
            change = _crisfield(moved, left, tangent, reach)
            if change is None:
                return None
            step = left + change * tangent
            far = float(np.abs(step).max(initial=0.0))
            still = far <= SETTLED * self.rest.system.size
            rounded = self.rounded and (still or far > 0.5 * before)  # steps that get no shorter are rounding, too
            if self.settled or rounded or (still and abs(change) <= BALANCED * abs(load)):
                x = last.x + self.unknowns.spread(moved)
                return Point(x, load, tangent, negatives, moved, iteration)
            moved, load, before = moved + step, load + change, far
        return None

    def at_factor(self, before: Point, after: Point, wanted: float) -> Point:
        """The point between two at a load factor between theirs."""

        def error(point: Point) -> float:
            return point.factor - wanted

        return self._root(before, after, error) or after

    def between(self, before: Point, after: Point) -> list[tuple[str, Point]] | None:
        """Critical points between two points of the path; None where the points between do not lead to one, since the
        step left its path for another one."""
        found: list[tuple[str, Point]] = []
        out, at_end = self._rate_out(before, after), after.rate()
        turns, steepest = out * at_end < 0.0, max(abs(out), abs(at_end))
        crossed, reach = abs(after.negatives - before.negatives), float(np.linalg.norm(after.moved))
        if turns:
            limit = self._root(before, after, Point.rate, first=out)
            if limit is not None and abs(limit.rate()) <= FLAT * steepest:
                found.append(("limit", limit))
            elif crossed != 1:
                return None
        if crossed and not (found and crossed == 1):
            point = self._crossing(before, after)
            if point is not None and found and float(np.linalg.norm(point.x - found[0][1].x)) <= NEAR * reach:
                point = self._crossing(before, after, last=True)  # that was the limit point: the other change
            if point is None:
                return None
            level = abs(point.rate()) <= LEVEL * steepest
            if crossed == 1 and turns:
                if not level:
                    return None
                found.append(("limit", point))  # bracketed, where its root could not be approached
            elif crossed > 1 or not level:  # else the limit point of a step beside this one
                found.append(("bifurcation", point))
        return sorted(found, key=lambda item: float(np.linalg.norm(item[1].moved)))

    def _followed(self, before: Point, after: Point) -> bool:
        """Whether a step seems to have followed its path: nearly straight; the load factor changed as its rates at both
        ends have it, not as with two limit points between; and the structure is not many times as stiff as anywhere
        before, as it is beyond a snap-through."""
        out, at_end = self._rate_out(before, after), after.rate()
        between = (after.factor - before.factor) / float(np.linalg.norm(after.moved))
        even = abs(between - 0.5 * (out + at_end)) <= 0.5 * max(abs(out), abs(at_end))
        stiff = abs(at_end) > STIFFER * max(self.steepest, abs(before.rate()))
        return _straight(before, after) and even and not stiff

    def _rate_out(self, before: Point, after: Point) -> float:
        """The rate at which the load factor leaves a point on the way to another."""
        size = float(np.linalg.norm(before.tangent))
        return float(np.copysign(1.0 / size, before.tangent @ after.moved)) if size > 0.0 else 0.0

    def _root(
        self, before: Point, after: Point, value: Callable[[Point], float], first: float | None = None
    ) -> Point | None:
        """Where a value of points between two is zero, by the Illinois method on the arc length."""
        low, high = 0.0, float(np.linalg.norm(after.moved))
        at_low, at_high = value(before) if first is None else first, value(after)
        best = after
        for _ in range(HALVINGS):
            if at_high == at_low:
                break
            middle = high - at_high * (high - low) / (at_high - at_low)
            if not min(low, high) < middle < max(low, high):
                break
            point = self.at_arc(before, middle)
            if point is None:  # the tangent is singular to the last bit: beside it
                middle = 0.5 * (low + high)
                point = self.at_arc(before, middle)
            if point is None:
                return None
            found, best = value(point), point
            if found == 0.0 or abs(high - low) <= 1e-9 * max(low, high):
                break
            if found * at_high < 0.0:
                low, at_low = high, at_high
            else:
                at_low *= 0.5
            high, at_high = middle, found
        return best

    def _crossing(self, before: Point, after: Point, *, last: bool = False) -> Point | None:
        """Where the number of negative eigenvalues first changes between two points, or comes to its `last`, by
        halving; None where no points of one path are found on both sides of it."""
        low, high = 0.0, float(np.linalg.norm(after.moved))
        least, found = before.x, after
        for _ in range(HALVINGS):
            parts = ((middle, self.at_arc(before, middle)) for middle in (low + part * (high - low) for part in PARTS))
            middle, point = next((pair for pair in parts if pair[1] is not None), (0.0, None))
            if point is None:
                break
            if point.negatives != after.negatives if last else point.negatives == before.negatives:
                low, least = middle, point.x
            else:
                high, found = middle, point
            if high - low <= 1e-9 * high:
                break
        apart = float(np.linalg.norm(found.x - least))
        return found if max(apart, high - low) <= NEAR * float(np.linalg.norm(after.moved)) else None

    def _held(self, matrix: Any) -> Any:
        """A tangent with a stiffness against turns of hinged joints that move nothing, if there are some."""
        return against_turns(matrix, self.unknowns.dofs, self.rest.system.slots.count)[0] if self.hinged else matrix

    def _solve(self, x: Floats, load: float) -> tuple[Floats, Floats, int] | None:
        """At a shape: the movement that what is out of balance makes, the tangent movement for a unit of the factor,
        and the number of negative eigenvalues. `settled`: whether it is in balance; `rounded`: whether what is left
        is no more than rounding of coordinates leaves, u w |x| with w the stiffness at a particle."""
        self.state.x = self.load_state.x = x
        inner, stiffness, _ = self.rest.system.evaluate(self.state)
        outer = self.loads.evaluate(self.load_state)[0]
        matrix = self.unknowns.tangent(self.rest.system, self.state)
        if not self.constant:
            matrix = _sum(matrix, load * self.unknowns.tangent(self.loads, self.load_state))
        found = _factored(self._held(matrix))
        if found is None:
            return None
        left, force = self.unknowns.gather(inner + load * outer), self.unknowns.gather(outer)
        whole = inner + load * outer
        scale = max(float(np.abs(load * outer).max(initial=0.0)), float(np.abs(whole).max(initial=0.0)))
        self.settled = bool(np.abs(left).max(initial=0.0) <= BALANCED * scale)
        floor = ROUNDING * stiffness[self.unknowns.dofs // 3] * np.abs(x).max(initial=0.0)
        self.rounded = bool(np.all(np.abs(left) <= np.maximum(floor, BALANCED * scale)))
        solution = found.solve(left), found.solve(force)
        if not all(np.isfinite(part).all() for part in solution):
            return None
        return np.asarray(solution[0]), np.asarray(solution[1]), found.negatives


def _straight(before: Point, after: Point) -> bool:
    """Whether the path leaves one point and arrives at another nearly along the step between them."""
    along = np.abs([before.tangent @ after.moved, after.tangent @ after.moved])
    sizes = np.array([np.linalg.norm(before.tangent), np.linalg.norm(after.tangent)]) * np.linalg.norm(after.moved)
    return bool(np.all(along >= STRAIGHT * sizes))


def _crisfield(moved: Floats, left: Floats, tangent: Floats, reach: float) -> float | None:
    """The change of the load factor that keeps the arc length: of two, that which turns the step least; None where
    there is none."""
    base = moved + left
    a, b = float(tangent @ tangent), 2.0 * float(tangent @ base)
    c = float(base @ base) - reach * reach
    inside = b * b - 4.0 * a * c
    if a == 0.0 or inside < 0.0:
        return None
    far = -0.5 * (b + np.copysign(np.sqrt(inside), b))
    roots = [far / a, c / far if far != 0.0 else 0.0]
    return float(max(roots, key=lambda root: float(moved @ (base + root * tangent))))


def _sum(matrix: Any, other: Any) -> Any:
    if other.shape != matrix.shape:
        other.resize(matrix.shape)
    return (matrix + other).tocsc()


def _factored(matrix: Any) -> Any:
    """Factors; of a matrix that is singular to the last bit those of one that is not quite."""
    import scipy.sparse as sparse

    found = factor(matrix)
    if found is None:
        size = 1e-14 * float(abs(matrix).max()) if matrix.nnz else 0.0
        found = factor(matrix + size * sparse.identity(matrix.shape[0], format="csc")) if size else None
    return found
