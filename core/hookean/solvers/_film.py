"""Film: what soap films span, by steps across them, with their vertices evenly spread.

First a few steps of spreading (see _spread.py), of which the first mends a torn film. Then Newton steps along the axes
that count (see `hookean.films`) with the exact tangent of all forces: a film has no stiffness along itself, so that is
the whole equation. Each step leaves the square of what was left, and a part as small as the mesh's error, as axes turn
with the film. Where the tangent is not positive definite, that of spreading is mixed in. Where a step is long the
vertices follow along the film, so that triangles stay even.

Of flat triangles, the error is of order 2 in their size. Sources: Pinkall and Polthier, "Computing discrete minimal
surfaces and their conjugates", 1993; Dziuk and Hutchinson, "The discrete Plateau problem", Math. Comp. 68 (1999).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

import numpy as np
from numpy.typing import NDArray

from hookean.films import WHOLE
from hookean.forces.base import lengths
from hookean.forces.soapfilm import shapes
from hookean.linear.film_tangent import Across, across
from hookean.solvers._spread import Spread
from hookean.solvers.base import Solver

if TYPE_CHECKING:
    from hookean.linear.sparse_factors import Factor
    from hookean.system.balance import Balance
    from hookean.system.state import State
    from hookean.system.system import System

Floats = NDArray[np.float64]

STEPS = 300  # where so many do not do, other solvers may
LAPS = 8  # steps of spreading before the first across the film
WORTH = 1e-3  # part of the energy from which on a step of spreading is worth another one
FAR = 0.1  # of the sides of triangles, beyond which vertices spread with a step
NEAR = 1e-3  # of them, so short a step that the tangent has the same signs after it
LEAST, MOST = 1e-3, 1e3  # of the tangent of spreading that is mixed in
SHORTEST = 1e-3
STEADY = 1e-3  # of the mean stiffness, so that this is positive definite where nothing else acts
THIN, THINNER = 0.3, 0.5  # no step leaves a triangle with less quality than the one, and than this part of what it had


class Method(Solver):
    """Spreading and Newton steps across films."""

    name: ClassVar[str] = "film"
    longest: ClassVar[int] = 1

    def __init__(self) -> None:
        self.pattern: Across | None = None
        self._spread: Spread | None = None
        self._factor: Factor | None = None

    def refuse(self, system: System) -> str:
        """A sentence unless there are films with vertices of their own, and no floor."""
        films = system.films
        if films is None or not (films.kind != WHOLE).any():
            return "there is no soap film with vertices of its own"
        return "a film that touches a floor has no tangent" if system.contacts else system.no_tangent()

    def start(self, system: System, state: State) -> None:
        """Start from rest, with spreading."""
        self.pattern = self._spread = self._factor = None
        self.certain = False
        state.v[:] = 0.0
        state.scratch = {"film": np.array([float(LAPS), 0.0, float(STEPS)])}

    def advance(self, system: System, state: State, count: int, goal: float) -> int:
        """At most `count` steps; fewer when none helps any more."""
        done = 0
        while done < count:
            laps, shift, steps = state.scratch["film"]
            here = Shape(system, state)
            if laps > 0:
                gain = self._lap(system, state, here, first=laps == LAPS)
                laps = laps - 1 if gain > WORTH else 0
                moved = gain > 0.0
            elif here.largest <= goal or steps <= 0:
                break
            else:
                moved, shift = self._newton(system, state, here, shift)
                if not moved:
                    break
            state.scratch["film"] = np.array([laps, shift, steps - 1.0])
            done += moved
            state.iteration += moved
        return done

    def _spreading(self, system: System, state: State) -> Spread:
        films = system.films
        if self._spread is None or self._spread.films is not films:
            assert films is not None
            self._spread = Spread(system, films, state.free)
        return self._spread

    def _lap(self, system: System, state: State, here: Shape, *, first: bool) -> float:
        """One step of spreading; the part of the energy that it gained, 1 where it mended a film."""
        spread = self._spreading(system, state)
        mended = spread.sound(system, state) if first else None
        motion = spread.motion(system, state, spread.films.conductances(state.x) if mended is None else mended)
        if motion is None:
            return 0.0
        start, length = state.x.copy(), 1.0
        while length > SHORTEST:
            state.x[:] = start + length * motion
            now = Shape(system, state)
            if mended is not None and np.isfinite(now.energy):
                return 1.0
            if (fallen := now.fall(here)) > 0.0:
                return fallen / here.size
            length *= 0.5
        state.x[:] = start
        return 0.0

    def _newton(self, system: System, state: State, here: Shape, shift: float) -> tuple[bool, float]:
        """One Newton step, and the shift for the next; False where none helps."""
        self.pattern = across(system, state, state.free, self.pattern)
        spread = self._spreading(system, state)
        sides, far = spread.sides(state.x), 0.0
        tangent = Tangent(system, state, self.pattern, spread)
        length = 0.0
        while length == 0.0:
            step, shift = tangent.step(here.left, shift)
            if step is None:
                return False, 0.0
            far = float((lengths(step) / sides).max())
            if far > FAR:
                length = _search(system, state, here, step + _vertices(system, state, spread, step))
            if length == 0.0:
                length = _search(system, state, here, step)
            if length == 0.0:
                shift = max(10.0 * shift, LEAST)
        self.certain = shift == 0.0 and far <= NEAR
        self._factor = tangent.factor
        shift = 0.1 * shift if length == 1.0 else shift if length > 0.2 else max(10.0 * shift, LEAST)
        return True, shift if shift >= LEAST else 0.0

    def correction(self, system: System, state: State, found: Balance) -> Floats | None:
        """By the factors of the last step."""
        if not self.certain or self.pattern is None or self._factor is None:
            return None
        return self.pattern.spread(self._factor.solve(self.pattern.gather(found.forces)))


class Shape:
    """A shape as judged: what forces leave (n, 3) of what counts, `left`, and of what does not, `idle` [force]."""

    def __init__(self, system: System, state: State) -> None:
        films = system.films
        assert films is not None
        self.x = state.x.copy()
        f, _, energies = system.evaluate(state)
        f *= state.free
        self.left, self.energy, self.size = f.copy(), float(energies.sum()), float(np.abs(energies).sum())
        films.across(state.x, state.free, self.left)
        self.idle = f - self.left
        self.largest = float(lengths(self.left).max(initial=0.0))
        self._potential = all(group.conservative for group in system.groups)

    def fall(self, before: Shape) -> float:
        """By how much the energy fell since then [force length], but for the work of what does not count; where some
        force has no energy of its own, the work of what counts if that is more. -inf where that is no number."""
        motion = self.x - before.x
        fallen = before.energy - self.energy - 0.5 * float(((self.idle + before.idle) * motion).sum())
        if not self._potential:
            fallen = max(fallen, 0.5 * float(((self.left + before.left) * motion).sum()))
        return fallen if np.isfinite(fallen) else -np.inf


class Tangent:
    """What a step across films is solved with: the exact tangent of a shape, and that of spreading."""

    def __init__(self, system: System, state: State, pattern: Across, spread: Spread) -> None:
        self._system, self._state, self._pattern, self._spread = system, state, pattern, spread
        self._exact = pattern.tangent(system, state)
        self._safe = np.zeros(0)
        self.factor: Factor | None = None
        self.unit = float(np.abs(self._exact[pattern.diagonal]).mean()) or 1.0

    def step(self, left: Floats, shift: float) -> tuple[Floats | None, float]:
        """The step (n, 3) of the smallest shift with which the tangent is positive definite, and that."""
        pattern = self._pattern
        rhs = pattern.gather(left)
        while shift <= MOST:
            values = self._exact if shift == 0.0 else self._exact + shift * self._spreading()
            self.factor = pattern.factors.factor(values)
            if self.factor is not None and not self.factor.negatives:
                solution = self.factor.solve(rhs)
                if np.isfinite(solution).all():
                    return pattern.spread(solution), shift
            shift = max(10.0 * shift, LEAST)
        return None, shift

    def _spreading(self) -> Floats:
        """The tangent of spreading along the same axes, and a little for what else there is."""
        if not len(self._safe):
            self._safe = self._pattern.of_films(
                self._system, self._state, self._spread.films.conductances(self._state.x)
            )
            self._safe[self._pattern.diagonal] += STEADY * self.unit
        return self._safe


def _vertices(system: System, state: State, spread: Spread, step: Floats) -> Floats:
    """Motions (n, 3) along films and their edges with which their vertices stay evenly spread in a step."""
    pure = spread.films.pure[:, None]
    slid = spread.sliding(system, state, step)
    motion = spread.motion(system, state, spread.films.conductances(state.x), np.where(pure, 0.0, step + slid))
    if motion is None:
        return slid
    return np.where(pure, spread.films.along(state.x, state.free, motion), slid)


def _search(system: System, state: State, here: Shape, step: Floats) -> float:
    """Shorten the step until the energy falls enough or the largest force halves, and no triangle gets thin; zero
    length where nothing helps."""
    films, slope = system.films, float((here.left * step).sum())
    assert films is not None
    corners = films.corners
    _, before = shapes(here.x, corners)
    length = 1.0
    while length > SHORTEST:
        state.x[:] = here.x + length * step
        now, (_, after) = Shape(system, state), shapes(state.x, corners)
        good = now.fall(here) >= 1e-4 * length * max(slope, 0.0) or now.largest < 0.5 * here.largest
        if good and np.isfinite(now.energy) and not ((after < THIN) & (after < THINNER * before)).any():
            return length
        length *= 0.5
    state.x[:] = here.x
    return 0.0
