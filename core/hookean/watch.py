"""Watching a run: judges it between bursts of iterations, and says when it is over and why."""

from __future__ import annotations

import time
from dataclasses import replace

import numpy as np

from hookean import stability
from hookean.balance import Balance, balance
from hookean.result import Status
from hookean.solvers import Solver
from hookean.state import State
from hookean.system import System

FIRST_LOOK = 25  # iterations before the first look at the balance; later looks come at growing distances
PATIENCE = 20_000  # iterations without a better residual before a run counts as stalled, on top of those spent


def seldom(system: System) -> int:
    """Iterations from look to look that cost little beside them: about 50 ms of springs."""
    cheap = 8_000_000 // (sum(g.block.indices.size for g in system.groups) + 4_000)
    if any(g.cls.collapses for g in system.groups):
        cheap = 0  # looked at often, so that the last good shape is a late one
    return max(FIRST_LOOK, cheap)


class Watch:
    """Looks at a run between bursts of iterations and says when it is over."""

    def __init__(self, system: System, state: State, method: Solver) -> None:
        self.method = method
        self.settings = system.scene.settings
        self.started = time.monotonic()
        self.first = self.last = state.iteration
        self.best, self.best_at = np.inf, state.iteration
        self.good = state.copy()
        self.found: Balance = balance(system, state)
        self.size = system.size
        self.top, self.top_found = self.good, self.found  # of the best residual
        self.fault = ""
        self.collapse = ""

    @property
    def goal(self) -> float:
        """The out-of-balance force [force] that meets the tolerance."""
        found, tolerance = self.found, self.settings.tolerance
        # where the stiffest rests, but for rounding, something softer may not
        softer = found.residual <= found.floor and not found.met(tolerance)
        return max(tolerance, 0.0 if softer else found.floor) * found.scale

    def burst(self, system: System, state: State) -> int:
        """Iterations until the next look: about 50 ms of springs, or a twenty-fifth of those done."""
        spent = state.iteration - self.first
        due = min(max(seldom(system), spent // 25), self.method.longest, self.settings.max_iterations - spent)
        return max(1, due)

    def look(self, system: System, state: State, *, idle: bool = False, known: bool = False) -> Status:
        """Judge the state as it is now; `known` says that it is the one this began with."""
        self.last = state.iteration
        if not self._sane(system, state) or self._collapsed(system, state):
            return Status.DIVERGED
        if not known:
            self.found = balance(system, state)
        if self.method.anew > self.best_at:  # what the other way had reached is no measure of this one
            self.best, self.best_at = np.inf, self.method.anew
        if not known:
            self.good = state.copy()
        if self.found.residual < self.best:
            self.best, self.best_at = self.found.residual, state.iteration
            self.top, self.top_found = self.good, self.found
        if self.found.met(self.settings.tolerance) and self._resting(system, state):
            return Status.CONVERGED
        stuck = state.iteration > 2 * self.best_at - self.first + PATIENCE
        if idle or (stuck and not self.method.physical):  # what swings may swing for long
            return Status.STALLED
        if state.iteration - self.first >= self.settings.max_iterations:
            return Status.MAX_ITERATIONS
        limit = self.settings.time_limit
        if limit is not None and time.monotonic() - self.started > limit:
            return Status.TIME_LIMIT
        return Status.RUNNING

    def remember(self, system: System, state: State) -> None:
        """Let elements take note of a shape at rest; those that yield have another energy then."""
        system.remember(state)
        if system.yields:
            self.found = replace(self.found, energies=system.evaluate(state)[2])

    def _collapsed(self, system: System, state: State) -> bool:
        """Whether some force says that its shape is none any more."""
        for group in system.groups:
            for part in group.parts if group.cls.collapses else ():
                said = part.force.collapsed(group.of(part), state.x)
                if said:
                    self.collapse = f"/forces/{part.number}: {said}"
                    return True
        return False

    def _resting(self, system: System, state: State) -> bool:
        """In physical time a shape may pass through balance at full speed: then it has not arrived."""
        if not self.method.physical:
            return True
        moving = float((system.mass[:, None] * state.v**2 * state.free).sum())
        return moving <= (self.settings.tolerance + self.found.floor) * self.found.scale * self.size

    def _sane(self, system: System, state: State) -> bool:
        """Finite, and not a hundred thousand times the model's size away; else say which particle and force."""
        away = np.abs(state.x - system.x) * state.free
        if np.isfinite(state.v).all() and away.max(initial=0.0) <= 1e5 * self.size:
            return True
        bad = ~np.isfinite(state.x).all(axis=1) | ~np.isfinite(state.v).all(axis=1)
        if not bad.any():
            bad = away.max(axis=1) > 1e5 * self.size
        particle = int(np.argmax(bad))
        self.fault = f"particle {particle}"
        for group in system.groups:
            hit = (group.block.indices == particle).any(axis=1)
            for part in group.parts:
                if hit[part.rows].any() and group.cls.role != "load":
                    kind = group.cls.model_fields["kind"].default
                    self.fault += f" (of /forces/{part.number}, {kind})"
                    return False
        return False

    def sentence(self, system: System, status: Status) -> str:
        """What to tell a person of a run that ended with `status`."""
        found, unit = self.found, system.scene.units.force
        left = f"residual {found.residual:.3g}, {found.out_of_balance:.3g} {unit} out of balance"
        spent = self.last - self.first
        if status is Status.CONVERGED:
            rounding = " (the rounding floor)" if found.residual > self.settings.tolerance else ""
            return f"In equilibrium after {spent} iterations: {left}{rounding}."
        if status is Status.DIVERGED and self.collapse:
            return f"Collapsed after {spent} iterations; the last good shape is returned. {self.collapse}."
        if status is Status.DIVERGED:
            advice = stability.warning(system, self.good) if self.method.physical else ""
            anchored = any(len(anchor.particles) for anchor in system.held)
            advice = advice or ("Look for loads that nothing holds" if anchored else "No particle is held: add anchors")
            where = f" after {spent} iterations at {self.fault}" if self.fault else ""  # a state taken up knows no more
            return f"Diverged{where}; the last good shape is returned. {advice}."
        if status is Status.STALLED:
            return (
                f"Stalled after {spent} iterations at particle {found.worst}: {left}. Springs on their cutoff, loads "
                "that nothing holds, or a shape about to snap do this; look there, or raise the tolerance."
            )
        if status is Status.CANCELLED:
            return f"Cancelled after {spent} iterations: {left}."
        if status is Status.TIME_LIMIT:
            return f"Out of time ({self.settings.time_limit:g} s) after {spent} iterations: {left}. Raise time_limit."
        return f"Not in equilibrium after {spent} iterations: {left}. Raise max_iterations."
