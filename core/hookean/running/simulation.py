"""Simulation: a live system, frame by frame, patched while it runs, saved and resumed bit for bit."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import IO, Any

import numpy as np

from hookean.errors import InputError
from hookean.running import saving
from hookean.running.drawing.draw import drawn
from hookean.running.drawing.edits import Draw
from hookean.running.following import followed
from hookean.running.frame import Frame, framed
from hookean.running.history import Before, History, Setup
from hookean.running.patch import Patch, apply
from hookean.running.result import Result, Status, gather, kinetic
from hookean.running.run import Progress, relax_state
from hookean.running.saving import Saved
from hookean.running.script import Playing, Script
from hookean.running.stream import Stream
from hookean.running.watch import Watch, seldom
from hookean.scene.scene import Scene
from hookean.solvers import solver
from hookean.stability import time_steps
from hookean.stability.equilibrium import assess
from hookean.system.addressed import edited_scene
from hookean.system.balance import Balance, balance
from hookean.system.state import State
from hookean.system.system import System, compile

OFTEN = 30  # frames of a run that is played, at most, from judgement to judgement: half a second on the screen

Source = Stream | str | Path | Iterable[str]


class Simulation:
    """A running system: stepped, patched while it runs, saved and resumed bit for bit.

    A `script` (see `running.script`) leads anchors and columns of forces through time, a `stream` (path, `-` for
    standard input, lines of CSV) gives the values of its drives. They need a solver of physical time.
    """

    def __init__(
        self, scene: Scene, script: Script | Mapping[str, Any] | str | None = None, stream: Source | None = None
    ) -> None:
        self.system = compile(scene, empty=True)
        self._playing: Playing | None = None
        if script is not None or stream is not None:
            self._playing = Playing(Script.read({} if script is None else script), stream, self.system)
        self.state = self.system.start()
        self.history = History()
        self._last: tuple[Before, History, Status] | None = None  # before the last change
        self._begin(start=True)

    @property
    def scene(self) -> Scene:
        """The scene as patches have left it, with anchors as they were given; see `edited_scene`."""
        return self.system.scene

    def edited_scene(self) -> Scene:
        """The scene as patches have left it, anchors included: moved, released, and those pinned while it ran. Its
        particles start where they did."""
        return edited_scene(self.system)

    @property
    def over(self) -> bool:
        """Whether the stream that drives it has ended."""
        return self._playing is not None and self._playing.over

    @property
    def driven(self) -> bool:
        """Whether a script or stream still has something to do."""
        return self._playing is not None and not self._playing.finished

    def _begin(self, *, start: bool, warn: bool = True) -> None:
        """Take up the scene's solver; `start` lets it forget what it did before."""
        name = self.scene.settings.solver
        self.solver = solver("verlet" if name == "auto" else name)
        refusal = self.solver.refuse(self.system)
        if self._playing is not None and not self.solver.physical:
            refusal = f"{name} has no physical time, which a script needs; use verlet, yoshida or auto"
        if refusal:
            raise InputError("/settings/solver", refusal)
        if warn:
            self._warn()
        if start:
            self.solver.start(self.system, self.state)
        self._watch = Watch(self.system, self.state, self.solver)
        self._judged()
        self.status = Status.RUNNING
        self._said = ""
        self._note()

    def _judged(self) -> None:
        """The goal of what follows, kept with the state so that a resumed run stops where this one does."""
        self._seen: Balance | None = self._watch.found
        if not self.solver.physical:
            self.state.scratch["goal"] = np.array([self._watch.goal])

    def _warn(self) -> None:
        """Report a time step that is too long for the present shape."""
        warnings = self.system.report.warnings
        warnings[:] = [w for w in warnings if not w.startswith("/settings/time_step")]
        if self.solver.physical and (said := time_steps.warning(self.system, self.state, self.solver)):
            warnings.append(said)
        self._noted: list[str] = []

    def _note(self) -> None:
        """Report what the last look found out about the steps that were taken."""
        notes, warnings = self._watch.notes if self.status is Status.RUNNING else [], self.system.report.warnings
        if notes != self._noted:
            warnings[:] = [w for w in warnings if w not in self._noted] + notes
            self._noted = list(notes)

    def step(self, frames: int = 1) -> Status:
        """Advance by whole frames of `sub_iterations` steps; a diverged step restores the last good state."""
        for _ in range(frames):
            self.iterate(self.scene.settings.sub_iterations)
            if self.status is not Status.RUNNING:
                break
        return self.status

    def iterate(self, count: int) -> Status:
        """Advance by at most `count` iterations of the solver, and judge where that led."""
        while True:
            self.advance(count)
            status, count = self.look(), self._watch.back
            if not count:
                return status

    def play(self, count: int) -> Status:
        """Advance by `count` iterations, or a few more, of a run that ends where it is at rest.

        It is judged at iterations that follow from the system alone: the states are the same however it is divided
        into calls, whatever is read between.
        """
        until, together = self.state.iteration + count, self.solver.together
        every = together or min(seldom(self.system), OFTEN * self.scene.settings.sub_iterations)
        while self.status is Status.RUNNING and self.state.iteration < until:
            before = self.state.iteration
            due = together or every - before % every
            several = due if together else min(due, until - before)
            self.advance(several)
            done = self.state.iteration - before
            if several == due or done < several:
                self.look()
            if not done:
                break
        return self.status

    def advance(self, count: int) -> None:
        """Advance by at most `count` iterations of the solver; `look` judges where that led."""
        if self.status is Status.DIVERGED:
            return
        self._seen = None
        playing = self._playing
        while count and playing is not None and not playing.finished:
            step = self.solver.covers(self.system, self.state)
            if playing.before(self.system, self.state, step):
                self._warn()
                self.state.scratch.pop("parts", None)
                step = self.solver.covers(self.system, self.state)
                playing.before(self.system, self.state, step)
            several = min(count, playing.quiet(self.state.time, step))
            self.solver.advance(self.system, self.state, several, 0.0)
            playing.after(self.system, self.state)
            count -= several
        if count:
            goal = 0.0 if self.solver.physical else float(self.state.scratch["goal"][0])
            self.solver.advance(self.system, self.state, count, goal)

    def look(self) -> Status:
        """Judge the state as it is now; one that diverged goes back to the last good one. `balance`,
        `message` and `frame()` change nothing."""
        if self.status is Status.DIVERGED:
            return self.status
        self.status = self._watch.look(self.system, self.state, driven=self.driven)
        self._said = ""
        if self.status is Status.CONVERGED and self.driven:
            self.status = Status.RUNNING  # at rest, but not for long
        if self.status is Status.CONVERGED:
            self.status = self._watch.onward(self.system, self.state)
        if self.status is Status.DIVERGED:
            revision, self.state = self.state.revision, self._watch.good.copy()
            self.state.revision = revision  # the shape goes back, not the count of patches
        elif self.status is Status.CONVERGED and not self.solver.physical:
            self._watch.remember(self.system, self.state)
        elif self.status in (Status.STALLED, Status.MAX_ITERATIONS, Status.TIME_LIMIT):
            self.status = Status.RUNNING  # somebody is watching; they decide when to stop
        self._judged()
        self._note()
        return self.status

    @property
    def finite(self) -> bool:
        """Whether all positions and velocities are finite."""
        return bool(np.isfinite(self.state.x).all() and np.isfinite(self.state.v).all())

    @property
    def balance(self) -> Balance:
        """How far the shape is from equilibrium now."""
        if self._seen is None:
            self._seen = self._balance()
        return self._seen

    def _balance(self) -> Balance:
        """The balance of the present state, which stays as it is: judging notes the scale of forces."""
        return balance(self.system, replace(self.state))

    @property
    def energy(self) -> float | None:
        """Of all forces and of motion now [force length]; None where a force, such as pressure, has none."""
        if not all(group.conservative for group in self.system.groups):
            return None
        moving = kinetic(self.system, self.state) if self.solver.physical else 0.0
        return float(self.balance.energies.sum()) + moving

    @property
    def message(self) -> str:
        """Its status, in a sentence."""
        if self.status is Status.RUNNING:
            found, unit = self.balance, self.scene.units.force
            said = f"Running: residual {found.residual:.3g}, {found.out_of_balance:.3g} {unit} out of balance."
            return " ".join([said, *(f"{note}." for note in self._watch.notes)])
        return self._said or self._watch.sentence(self.system, self.status)

    def frame(self) -> Frame:
        """The state as a client sees it."""
        return framed(self.system, self.state, self.balance.residual, self.status, self.message)

    def result(self) -> Result:
        """Everything about the present state; warnings name a time step that is too long for it."""
        known = [w for w in self.system.report.warnings if w not in self._noted]
        if self.status is Status.RUNNING and not any(w.startswith("/settings/time_step") for w in known):
            self._warn()
            self._note()
        found, moving = self._balance(), self.solver.physical
        rested = self.status is Status.CONVERGED
        if rested and self._watch.rest is None:  # another run came to this shape
            self._watch.rest = assess(self.system, self.state, found, self.solver)
        rest = self._watch.rest if rested else None
        return gather(self.system, self.state, found, rest, self.status, self.message, self.solver.name, moving=moving)

    def relax(self, *, progress: Progress | None = None, cancelled: Callable[[], bool] | None = None) -> Result:
        """Go to equilibrium from here with the scene's solver (auto: relaxation and Newton)."""
        result = relax_state(self.system, self.state, solver(self.scene.settings.solver), progress, cancelled)
        self.arrive(self.state, result.status, result.message)
        return result

    def arrive(self, state: State, status: Status = Status.RUNNING, message: str = "") -> None:
        """Go on from `state`, a shape of this system that a relaxation reached, and how that run ended."""
        self.state = state
        self._begin(start=True, warn=False)
        self.status, self._said = status, message

    def patch(self, edit: Patch | Mapping[str, Any], *, gesture: str = "") -> int:
        """Change anchors, loads, stiffness, rest lengths, settings or which forces act while it runs; returns the new
        revision.

        Edits of one `gesture`, such as the drag of an anchor, are taken back as one. InputError names what does not
        fit, and nothing has changed then.
        """
        edit = Patch.read(edit)
        if edit.remove and self._playing is not None:
            raise InputError("/remove", "a script refers to forces by number; forces can only be removed without one")
        # a moved anchor stiffens or quickens nothing by itself
        warn = bool(edit.forces or edit.settings or len(edit.release) or edit.rewires)
        same = edit.is_of_anchors
        before = self._changed(lambda: apply(self.system, self.state, edit), warn=warn, of_anchors=same)
        self.history.note(before.setup, gesture)
        return self.state.revision

    def rebuild(self, parameters: Mapping[str, Any], *, gesture: str = "") -> int:
        """Give the scene's family other parameters (see `families.rebuilding`); returns the new revision. InputError
        for one that is not allowed, and where edits have to be undone first."""
        from hookean.scene.families.rebuilding import rebuilt

        return self.replace(rebuilt(self.edited_scene(), parameters), gesture=gesture)

    def replace(self, scene: Scene, *, gesture: str = "") -> int:
        """Go on with another scene; returns the new revision. Particles that start where one of this scene starts are
        where that one is now. InputError for a scene that is not valid, and where a script is played."""
        return self._succeeded(lambda: self._follow(compile(scene)), gesture)

    def draw(self, edit: Draw | Mapping[str, Any], *, gesture: str = "") -> int:
        """Add, divide, extrude or delete (see `Draw`); returns the new revision. InputError for what does not fit."""
        read = Draw.read(edit)
        return self._succeeded(lambda: self._put_on(*drawn(self.system, self.state, read)), gesture)

    def _succeeded(self, change: Callable[[], None], gesture: str) -> int:
        if self._playing is not None:
            raise InputError("", "a script refers to particles and forces by number; replace the scene without one")
        before = self._changed(change)
        self.history.note(before.setup, gesture)
        return self.state.revision

    def undo(self) -> int:
        """Take the last edit back, the form follows; returns the new revision. InputError if no edit is left."""
        self._changed(lambda: self._put(self.history.undo(Setup.of(self.system))))
        return self.state.revision

    def redo(self) -> int:
        """Redo the last undone edit. Raises InputError if no edit was undone."""
        self._changed(lambda: self._put(self.history.redo(Setup.of(self.system))))
        return self.state.revision

    def _put(self, setup: Setup) -> None:
        """Make a setup the present one."""
        self._follow(setup.system)
        setup.put_back(self.state)

    def _follow(self, system: System) -> None:
        """Go on with another system, from where the particles are."""
        if system is not self.system:
            self._put_on(system, followed(self.system, self.state, system))

    def _put_on(self, system: System, state: State) -> None:
        self.system, self.state = system, state

    def revert(self) -> None:
        """Put everything back to before the last edit, undo, redo or reset, as if it had never been made."""
        if self._last is not None:
            (before, self.history, status), self._last = self._last, None
            self._restore(before)
            self.take_up(self.state, status)

    def _restore(self, before: Before) -> None:
        """All as it was before a change."""
        self.state = before.put_back(self.state)
        self.system = before.system

    def _changed(self, change: Callable[[], None], *, warn: bool = True, of_anchors: bool = False) -> Before:
        """Make a change that lands whole or not at all; what was before. `of_anchors`: no force changes."""
        before = self._before(of_anchors=of_anchors)
        solver, settings = self.solver, before.setup.scene.settings
        try:
            change()
            self.state.scratch.pop("energy", None)  # a change may add to it
            if warn:
                self.state.scratch.pop("parts", None)
            same = self.scene.settings.solver == settings.solver
            if not same or self.status is Status.DIVERGED:
                self.state.v[:] = 0.0  # what one solver calls velocity means nothing to another, or it flew apart
            goes_on = same and solver.physical and self.system is before.system
            self._begin(start=not goes_on, warn=warn)
        except InputError:
            self._restore(before)
            self.solver, self._last = solver, None
            raise
        return before

    def _before(self, *, of_anchors: bool = False) -> Before:
        """What is now, for `revert` too."""
        before = Before(self.system, self.state, of_anchors=of_anchors)
        self._last = before, self.history.copy(), self.status
        return before

    def succeed(self, scene: Scene) -> Simulation:
        """A simulation of another scene that goes on from here: particles that start where one of this scene starts
        (within the weld tolerance) are where that one is now, with its velocity. Anchors are those of the new scene,
        its forces remember nothing yet."""
        new = Simulation(scene)
        new.state = followed(self.system, self.state, new.system)
        new._begin(start=True)
        return new

    def take_up(self, state: State, status: Status) -> None:
        """Go on from a state that `State.of` read back; its anchors are those of the system. ValueError where it is
        the state of another system."""
        if not state.fits(self.state):
            raise ValueError("this state belongs to another system")
        goal, scale = state.scratch.get("goal"), state.force_scale
        self.state = state
        self._begin(start=False, warn=False)
        self.state.force_scale = scale  # of what was judged; this was only looked at
        if goal is not None and not self.solver.physical:
            self.state.scratch["goal"] = goal
        self.status = status

    def save(self, path: str | Path | IO[bytes]) -> None:
        """Everything about this simulation in one .npz file: the scene, the state and the anchors as they are now. Its
        history of patches is not in it."""
        playing = self._playing
        script = None if playing is None else playing.script.model_dump_json()
        finished = playing is not None and playing.finished
        saving.write(path, Saved(self.scene, script, finished, self.status, self.state.arrays()), self.system.held)

    @classmethod
    def load(cls, path: str | Path | IO[bytes], stream: Source | None = None) -> Simulation:
        """The simulation that `save` wrote; it goes on bit for bit, with its stream given again from the first row.
        InputError where the file is not one."""
        return saving.loaded(cls, path, stream)

    def reset(self) -> None:
        """Back to the start positions; anchors keep the particles they were given, and their present targets, or
        those of their script at its start. InputError for a stream that cannot be read again."""
        self._before()
        revision = self.state.revision
        if self._playing is not None:
            self._playing.rewind(self.system)
        self.state = self.system.start()
        self.state.revision = revision
        self._begin(start=True)
