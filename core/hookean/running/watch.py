"""Watching a run: judges it between bursts of iterations, and reports its end and the reason."""

from __future__ import annotations

import time
from dataclasses import replace

import numpy as np

from hookean.compiled import dispatch
from hookean.films.endings import Endings
from hookean.running.heating import FAR, accept, cool, flown, gained, give_back, heated
from hookean.running.messages import owner, sentence
from hookean.running.result import Status
from hookean.solvers import Solver
from hookean.stability import time_steps
from hookean.stability.equilibrium import Equilibrium, Stability, amiss, assess, excess, leave
from hookean.stability.exact_reactions import finer
from hookean.system.balance import Balance, balance
from hookean.system.impulses import next_moment
from hookean.system.state import State
from hookean.system.system import System

UTMOST = 10**12  # parts of a step that is far too long
FIRST_LOOK = 25  # iterations before the first look at the balance; later looks come at growing distances
LEAVES = 20  # unstable equilibria that a run leaves
TRIES = 5  # tighter tolerances that a run takes without half the position error
PATIENCE = 20_000  # iterations without a better residual before a run counts as stalled, on top of those spent; and
# without less energy: spheres that settle have less long before they have a better residual


def seldom(system: System) -> int:
    """Iterations from look to look that cost little beside them: about 50 ms of springs."""
    cheap = 8_000_000 // (sum(g.block.indices.size for g in system.groups) + 4_000)
    if system.films is not None:
        cheap = 0  # looked at often, so that the last good shape is a late one
    return max(FIRST_LOOK, cheap)


class Watch:
    """Checks a run between bursts of iterations and ends it."""

    def __init__(self, system: System, state: State, method: Solver) -> None:
        self.method = method
        self.settings = system.scene.settings
        self.tolerance = self.settings.tolerance  # of the residual; tighter where the shape is to be known better
        self.rest: Equilibrium | None = None  # what is known of the equilibrium that was found
        self._left, self._tries, self._least = 0, 0, np.inf
        self._other: tuple[State, Equilibrium, float] | None = None  # an unstable film, and the side it was not left to
        self.started = time.monotonic()
        self.first = self.last = state.iteration
        self.best, self.best_at = np.inf, state.iteration
        self.good = state.copy()
        self.found: Balance = balance(system, state)
        self._lowest, self._fell_at = float(self.found.energies.sum()), state.iteration  # least energy, when noted
        self.size = system.size
        self.top, self.top_found = self.good, self.found  # of the best residual
        self.back = 0  # iterations that the last look took back
        self.origin, self.driven = self.good, False
        self.fault, self.lost = "", -1  # what is not sane, and the particle
        self.flew = False  # it moved too far, and no time step is to blame
        self.advised = ""
        self.collapse = ""
        self.films = Endings(physical=method.physical) if system.films is not None else None
        self._exploding(system, state, self.found, driven=False)  # notes the energy of the start
        # on the steps of a motion: how far they may be trusted; those of a run that is resumed are known
        self.notes = self._noted(system, state) if "parts" in state.scratch else []

    @property
    def goal(self) -> float:
        """The out-of-balance force [force] that meets the tolerance."""
        return self.found.goal(self.tolerance)

    def sentence(self, system: System, status: Status) -> str:
        """The message of a run that ended with `status`."""
        return sentence(self, system, status)

    def burst(self, system: System, state: State) -> int:
        """Iterations until the next look: about 50 ms of springs, or a twenty-fifth of those done."""
        spent = state.iteration - self.first
        due = min(max(seldom(system), spent // 25), self.method.longest, self.settings.max_iterations - spent)
        return max(1, due)

    def look(
        self, system: System, state: State, *, idle: bool = False, known: bool = False, driven: bool = False
    ) -> Status:
        """Judge the state as it is now; `known`: it is the one this began with, `driven` that a script moves
        it."""
        system.slots.fold(state)  # where a solver has not
        self.last, self.rest, self.back = state.iteration, None, 0
        self.driven, self.flew, self.advised = driven, False, ""
        if not self._sane(system, state):
            return self._burst(system, state, driven=driven)
        if self._collapsed(system, state, known=known):
            return self._turned_back(system, state) or self._fallen(system)
        found = self.found if known else balance(system, state)
        if self._exploding(system, state, found, driven=driven) and not self._cooled(system, state, found):
            return self._burst(system, state, driven=driven)
        self.found = found
        self.notes = self._noted(system, state)
        if self.method.anew > self.best_at:  # what the other way had reached is no measure of this one
            self.best, self.best_at = np.inf, self.method.anew
        if not known:
            self.good = state.copy()
        if self.found.residual < self.best:
            self.best, self.best_at = self.found.residual, state.iteration
            self.top, self.top_found = self.good, self.found
        rests = self.found.still(self.tolerance) and self._resting(system, state)
        if rests and not amiss(system, state):  # else the solver may go on, and mend it
            return Status.CONVERGED if self.found.met(self.tolerance) else Status.STALLED
        if state.iteration > self.best_at:
            self._note_energy(system, state)
        stuck = state.iteration > max(2 * self.best_at - self.first, self._fell_at) + PATIENCE
        if idle or (stuck and not self.method.physical):  # what swings may swing for long
            return Status.STALLED
        if state.iteration - self.first >= self.settings.max_iterations:
            return Status.MAX_ITERATIONS
        limit = self.settings.time_limit
        if limit is not None and time.monotonic() - self.started > limit:
            return Status.TIME_LIMIT
        return Status.RUNNING

    def finish(self, system: System, state: State) -> None:
        """Go on from equilibrium by exact steps until loads and reactions balance."""
        self.found = finer(system, state, self.found, self.method)
        self.good = state.copy()

    def onward(self, system: System, state: State) -> Status:
        """What follows from equilibrium: RUNNING where the solver leaves one that is unstable, or goes on until the
        shape is known to the position tolerance; else CONVERGED, or STALLED where neither can be had."""
        rest = self.rest = assess(system, state, self.found, self.method)
        leaves = self.method.leaves and not self.settings.allow_unstable and self._left < LEAVES
        leaves = leaves and rest.stability is Stability.UNSTABLE
        before = state.copy() if leaves else state
        if leaves and (side := leave(system, state, rest)):
            self._left += 1
            self._other = (before, rest, -side) if self.films is not None else None
            self.tolerance *= 0.1  # near an instability forces are small long before rest
            self.method.depart(system, state)
            self.found, self.rest = balance(system, state), None
            return self._again(state)
        much = excess(system, state, self.found, rest) if self.method.refines else 0.0
        if much <= 1.0 or self.found.beyond == 0.0:
            return Status.CONVERGED  # as well as it is asked for, or as rounding allows
        self._tries = 0 if much < 0.5 * self._least else self._tries + 1
        self._least = min(self._least, much)
        if self._tries > TRIES:
            return Status.STALLED
        self.tolerance = min(self.tolerance, self.found.beyond) * min(0.3, 0.3 / much)
        return self._again(state)

    def _again(self, state: State) -> Status:
        """Go on from a shape that met the last tolerance, or nearly."""
        self.best, self.best_at = np.inf, state.iteration
        self.method.sharpen(state)
        return Status.RUNNING

    def remember(self, system: System, state: State) -> None:
        """Let elements take note of a shape at rest; those that yield have another energy then."""
        system.remember(state)
        if system.yields:
            self.found = replace(self.found, energies=system.evaluate(state)[2])

    def _note_energy(self, system: System, state: State) -> None:
        """Note when the energy has fallen by more than the work of the goal's force along the size of the model; not
        where a part that nothing supports falls, nor of films: what keeps them even does work."""
        if self.found.falls or system.films is not None or not all(group.conservative for group in system.groups):
            return
        energy = float(self.found.energies.sum())
        if energy < self._lowest - self.goal * self.size:
            self._lowest, self._fell_at = energy, state.iteration

    def _exploding(self, system: System, state: State, found: Balance, *, driven: bool) -> bool:
        """Whether time steps are too long for the motion; else records which particle and force."""
        particle = heated(system, state, self.method, found, driven=driven) if self.method.physical else None
        if particle is not None:
            self.fault = f"particle {particle}{owner(system, particle)}"
        return particle is not None

    def _noted(self, system: System, state: State) -> list[str]:
        if not self.method.physical:
            return []
        slow = time_steps.slowed(system, self.method.parts(system, state))
        return [note for note in (slow, gained(system, state, self.method, self.found, driven=self.driven)) if note]

    def _burst(self, system: System, state: State, *, driven: bool) -> Status:
        """What follows where a motion has exploded: where its time steps may be divided, back to the last good state
        with twice as many parts; but what drives a motion does not go back."""
        dividing = self.method.physical and self.settings.divide_steps and not driven
        self.flew = (
            self.method.physical and self.lost >= 0 and flown(system, state, self.found, self.lost, driven=driven)
        )
        parts = 2 * self.method.parts(system, state)
        known = all(group.conservative for group in system.groups)  # energies show whether a step is too long
        if not dividing or self.flew or parts > (UTMOST if known else time_steps.often(system, self.good, self.method)):
            return self._fallen(system)
        good = self.good.copy()
        self.back = state.iteration - good.iteration
        state.x, state.v, state.memory = good.x, good.v, good.memory
        state.time, state.iteration, state.force_scale = good.time, good.iteration, good.force_scale
        state.scratch["parts"] = np.array([parts])
        give_back(state, good)
        accept(system, state, self.found)
        self.lost = -1
        return Status.RUNNING

    def _cooled(self, system: System, state: State, found: Balance) -> bool:
        """Whether steps are divided so often already that what they still add is of the forces' making, which jump
        where elements collapse: it is taken out of the motion."""
        parts = self.method.parts(system, state)
        if (
            not self.settings.divide_steps
            or self.driven
            or 2 * parts <= time_steps.often(system, self.good, self.method)
        ):
            return False
        cool(system, state, found)
        return True

    def _fallen(self, system: System) -> Status:
        """The end of a run that diverged; the last good shape of films is one that can be a film."""
        if self.films is not None and self.films.good is not None:
            self.good, self.found = self.films.good, balance(system, self.films.good)
        return Status.DIVERGED

    def _turned_back(self, system: System, state: State) -> Status | None:
        """RUNNING where a film that collapsed on one side of an unstable shape is given the other side of it."""
        if self._other is None:
            return None
        (before, rest, side), self._other = self._other, None
        state.x, state.v, state.memory = before.x, before.v, before.memory
        if not leave(system, state, rest, (side,)):
            return None
        self.method.depart(system, state)
        self.collapse, self.good, self.found = "", state.copy(), balance(system, state)
        return self._again(state)

    def _collapsed(self, system: System, state: State, *, known: bool) -> bool:
        """Whether films are no longer a valid shape, or have no equilibrium to begin with."""
        if self.films is not None:
            self.collapse = self.films.begin(system, state) if known else self.films.look(system, state)
        return bool(self.collapse)

    def _resting(self, system: System, state: State) -> bool:
        """In physical time a shape may pass through balance at full speed: then it has not arrived."""
        if not self.method.physical:
            return True
        if next_moment(system, state.time) < np.inf:
            return False
        found, label = self.found, self.found.components.label
        moving = system.mass * (state.v**2 * state.free).sum(axis=1)
        moving = np.bincount(label[label >= 0], moving[label >= 0], len(found.scales))
        return bool((moving <= (self.tolerance + found.floors) * found.scales * self.size).all())

    def _sane(self, system: System, state: State) -> bool:
        """Finite, and not a hundred thousand times the model's size away; else records which particle and force."""
        if dispatch.compiled(within)(state.x, state.v, system.x, state.free, FAR * self.size):
            return True
        away = np.abs(state.x - system.x) * state.free
        bad = ~np.isfinite(state.x).all(axis=1) | ~np.isfinite(state.v).all(axis=1)
        if not bad.any():
            bad = away.max(axis=1) > FAR * self.size
        particle = system.slots.owner(int(np.argmax(bad)))
        others = int(np.count_nonzero(bad)) - 1
        # where many are lost at once, the forces of the first in number need not be the cause
        also = f" and {others} other{'s' * (others > 1)}" if others else owner(system, particle)
        self.fault = f"particle {particle}{also}"
        self.lost = particle
        return False


def within(x, v, start, free, far):  # type: ignore[no-untyped-def]
    """Whether all speeds are finite, and no free axis is farther than `far` from the start."""
    for i in range(x.shape[0]):
        for c in range(3):
            if not (np.isfinite(v[i, c]) and abs(x[i, c] - start[i, c]) * free[i, c] <= far):
                return False
    return True
