"""Auto: picks by the scene, and reports its choice.

Linear scenes take one force-density solve, cables and nets of chains Newton steps in the force densities, soap films
Newton steps across them, large nets of springs Newton steps by multigrid. Everything else relaxes, and so do nets whose
shape by those steps may not be the lowest, unless they are too large to wait for relaxation; where relaxation is slow
or the tolerance tight, Newton steps finish, and where those do not help, relaxation goes on. Beams begin with them, and
so do linear nets under weights that follow their shape, and nets of constant tension alone.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

import numpy as np

from hookean.linear import directions
from hookean.solvers import _complementary, _film, force_density, multilevel, newton, relaxation
from hookean.solvers.base import Floats, Solver
from hookean.stability import nets
from hookean.system.balance import Balance, balance

if TYPE_CHECKING:
    from hookean.system.state import State
    from hookean.system.system import System

# a tangent larger than this costs more to factor than the relaxation it saves
LARGEST_NEWTON = 60_000  # unknowns
LARGEST_FILM = 1_000_000  # particles, of some five gigabytes
LARGEST_BLOCKS = 12_000_000  # entries of all element blocks, 24 bytes each; a shell's have 36 x 36
LEAST_MULTILEVEL = 4_000  # particles from which on multigrid is quicker than relaxation
MANY = 30_000  # particles from which on relaxation takes minutes, and creases as well
CREASED = "Some springs are in compression and may wrinkle the net; other equilibrium shapes may exist."
FIRST_NEWTON = 4_000
NEWTON_STEPS = 60
SHARP_STEPS = 1_000  # from near an equilibrium: along a curved path, if need be
SOLVES = 5  # of a linear scene: each takes off what rounding left in the one before; mostly two are enough


class Method(Solver):
    """Force density where it is exact, complementary energy for chains, multigrid for large nets, else relaxation
    with a Newton finish."""

    name: ClassVar[str] = "auto"
    leaves: ClassVar[bool] = True
    refines: ClassVar[bool] = True

    def __init__(self) -> None:
        self.used: list[str] = []
        self._linear = force_density.Method()
        self._complementary = _complementary.Method()
        self._relaxation = relaxation.Method()
        self._newton = newton.Method()
        self._film = _film.Method()
        self._films = False
        self._multilevel = multilevel.Method()
        self._levels = False
        self._last: Solver | None = None

    def start(self, system: System, state: State) -> None:
        """Look at the system and choose."""
        self.used, self._steps, self.remark, self.work = [], 0, "", 0.0
        self._chains = self._levels = self._near = False
        self._solves = 0 if self._linear.refuse(system) else SOLVES
        self._prepared, self._last = False, None
        if self._solves:
            self._linear.start(system, state)
        else:
            self._prepare(system, state)

    def _prepare(self, system: System, state: State) -> None:
        """Choose among the ways that take more than one solve."""
        self._chains = not self._complementary.refuse(system)
        self._begin(system, state)

    def _begin(self, system: System, state: State) -> None:
        """Newton steps by multigrid for large nets, else relaxation, and Newton steps where the tangent is small."""
        self._prepared = True
        entries = sum(len(g.block.indices) * (3 * g.cls.arity) ** 2 for g in system.groups if not g.cls.constant)
        unknowns = 3 * (len(state.x) - len(system.slots))
        self._small = unknowns <= LARGEST_NEWTON and entries <= LARGEST_BLOCKS and not system.no_tangent(steps=True)
        self._levels = len(state.x) >= LEAST_MULTILEVEL and nets.suits(system)
        self._films = len(state.x) <= LARGEST_FILM and not self._film.refuse(system)
        if self._levels:
            self._start = state.copy()
            self._multilevel.start(system, state)
        elif self._films:
            self._film.start(system, state)
        else:
            self._relax_from_here(system, state)

    def advance(self, system: System, state: State, count: int, goal: float) -> int:
        """Some iterations of whatever is due."""
        done = self._advance(system, state, count, goal)
        if self._last is not None:
            last = self._last
            self.certain, self.tangent = last.certain, last.tangent
            self.pattern, self.solved = last.pattern, last.solved
        return done

    def _advance(self, system: System, state: State, count: int, goal: float) -> int:
        if self._solves:
            done = self._linear.advance(system, state, count, goal)
            self._solves = self._solves - 1 if done else 0
            if done:
                self._use(self._linear)
                return done
        if not self._prepared:
            self._prepare(system, state)
        if self._chains:
            self._chains = False
            done = self._complementary.advance(system, state, count, goal)
            if done:
                self._use(self._complementary)
                return done
            if self._complementary.near is not None:  # too stiff for its own last digits
                state.x[:] = self._complementary.near
                self._begin(system, state)
                self.sharpen(state)
        if self._levels:
            return self._by_levels(system, state, count, goal)
        if self._films:
            done = self._film.advance(system, state, min(count, self._film.longest), goal)
            self.work += done
            if done:
                self._use(self._film)
                return done
            self._films = False
            self._relax_from_here(system, state)
        if self._steps > 0:
            return self._finish(system, state, count, goal)
        due, pause, steps = state.scratch["next_newton"]
        if state.iteration < due or not self._small:
            self._use(self._relaxation)
            most = min(count, max(int(due) - state.iteration, 1)) if self._small else count
            done = self._relaxation.advance(system, state, most, goal)
            self.work += done
            return done
        self._steps, self._pause = int(steps), float(pause)
        self._newton.start(system, state)
        if self._steps >= SHARP_STEPS and self._near:
            self._newton.sharpen(state)
        return self._finish(system, state, count, goal)

    def _relax_from_here(self, system: System, state: State) -> None:
        self._relaxation.start(system, state)
        first, steps = (state.iteration + FIRST_NEWTON, NEWTON_STEPS)
        # beams are so much stiffer along than across that relaxation takes long, and lines that vanish become as stiff
        if len(system.slots) or not force_density.nonlinear(system, weights=True) or directions.alone(system):
            first, steps = state.iteration, SHARP_STEPS
        state.scratch["next_newton"] = np.array([first, FIRST_NEWTON, steps])

    def _by_levels(self, system: System, state: State, count: int, goal: float) -> int:
        """Newton steps by multigrid, where they lead to the shape of least energy; else relaxation from the start."""
        self._use(self._multilevel)
        work = self._multilevel.work
        done = self._multilevel.advance(system, state, min(count, self._multilevel.longest), goal)
        self.work += self._multilevel.work - work
        found = balance(system, state).met(system.scene.settings.tolerance)  # as the run is judged
        pulled = found and nets.pulled(system, state)
        self._multilevel.certain = found and not pulled and len(state.x) < MANY and nets.super_stable(system, state)
        if found and len(state.x) >= MANY:
            self.remark = "" if pulled else CREASED
        elif found and not pulled and not self._multilevel.certain:
            self._levels = False
            self.used.remove("multilevel")
            self.anew = state.iteration
            state.x[:], state.v[:] = self._start.x, self._start.v
            self._relax_from_here(system, state)
        return done

    def _finish(self, system: System, state: State, count: int, goal: float) -> int:
        """Newton steps from here; relaxation afterwards starts again, and waits twice as long before the next."""
        done = self._newton.advance(system, state, min(count, self._newton.longest, self._steps), goal)
        self._steps = self._steps - done if done else 0
        self.work += done
        if done:
            self._use(self._newton)
        if self._steps <= 0:
            self._relaxation.start(system, state)
            pause = 2.0 * self._pause
            state.scratch["next_newton"] = np.array([state.iteration + pause, pause, NEWTON_STEPS])
        return max(done, 1)

    def _use(self, method: Solver) -> None:
        self._last = method
        if method.name not in self.used:
            self.used.append(method.name)

    def depart(self, system: System, state: State) -> None:
        """Newton steps: what goes to the nearest equilibrium would come back."""
        self._solves, self._steps, self._chains = 0, 0, False
        self._begin(system, state)

    def sharpen(self, state: State) -> None:
        """Newton steps are due: the shape is near."""
        self._near = True
        if "next_newton" in state.scratch:
            state.scratch["next_newton"][::2] = state.iteration, SHARP_STEPS

    def correction(self, system: System, state: State, found: Balance) -> Floats | None:
        """By what the solver that came last has in factors."""
        return None if self._last is None else self._last.correction(system, state, found)
