"""Running: the one loop around every solver. `relax` to equilibrium, `simulate` for frames, `Simulation` live."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from hookean import stability
from hookean.balance import Balance, balance
from hookean.errors import InputError
from hookean.patch import Patch, apply
from hookean.result import Result, Status, carried, gather
from hookean.scene import Scene
from hookean.solvers import Solver, solver
from hookean.state import State
from hookean.system import Held, System, compile

Floats = NDArray[np.float64]

Progress = Callable[[int, float], None]
"""Called with the iteration and the residual now and then while a relaxation runs."""

FIRST_LOOK = 25  # iterations before the first look at the balance; later looks come at growing distances
PATIENCE = 20_000  # iterations without a better residual before a run counts as stalled, on top of those spent


@dataclass(frozen=True)
class Frame:
    """What a client sees of a running simulation: positions (n, 3) [length], time [time], energies [force length]."""

    particles: Floats
    geometry: list[dict[str, object]]
    time: float
    iteration: int
    revision: int
    residual: float
    status: Status
    message: str


def relax(scene: Scene, *, progress: Progress | None = None, cancelled: Callable[[], bool] | None = None) -> Result:
    """Bring a scene to equilibrium with its solver; always returns, failure is the result's status and message.

    `cancelled` is asked between bursts of iterations. Raises InputError where the scene does not fit together.
    """
    system = compile(scene)
    state = system.start()
    return relax_state(system, state, solver(scene.settings.solver), progress, cancelled)


def relax_state(
    system: System,
    state: State,
    method: Solver,
    progress: Progress | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> Result:
    """`relax` from a state; `state` is left at the last good shape."""
    refusal = method.refuse(system)
    if refusal:
        raise InputError("/settings/solver", refusal)
    if method.physical and (said := stability.warning(system, state)) and said not in system.report.warnings:
        system.report.warnings.append(said)
    method.start(system, state)
    watch = _Watch(system, state)
    status = watch.look(system, state, known=True)
    while status is Status.RUNNING:
        if cancelled is not None and cancelled():
            status = Status.CANCELLED
            break
        done = method.advance(system, state, watch.burst(system, state), watch.goal)
        status = watch.look(system, state, idle=done == 0)
        if progress is not None:
            progress(state.iteration, watch.found.residual)
    if status is not Status.DIVERGED:
        system.remember(state)
    _restore(state, watch.good)
    used = getattr(method, "used", None)
    name = f"auto: {', '.join(used) or 'nothing to do'}" if used is not None else method.name
    return gather(system, state, watch.found, status, _sentence(system, status, watch), name)


class _Watch:
    """Looks at a run between bursts of iterations and says when it is over."""

    def __init__(self, system: System, state: State) -> None:
        self.settings = system.scene.settings
        self.started = time.monotonic()
        self.first = self.last = state.iteration
        self.best, self.best_at = np.inf, state.iteration
        self.good = state.copy()
        self.found: Balance = balance(system, state)
        self.size = system.size
        self.moving = np.inf
        self.fault = ""
        self.collapse = ""

    @property
    def goal(self) -> float:
        """The out-of-balance force [force] that meets the tolerance."""
        return max(self.settings.tolerance, self.found.floor) * self.found.scale

    def burst(self, system: System, state: State) -> int:
        """Iterations until the next look: about 50 ms of springs, or a twenty-fifth of those done."""
        spent = state.iteration - self.first
        cheap = 8_000_000 // (sum(g.block.indices.size for g in system.groups) + 4_000)
        if any(g.cls.collapses for g in system.groups):
            cheap = 0  # looked at often, so that the last good shape is a late one
        return max(1, min(max(FIRST_LOOK, cheap, spent // 25), self.settings.max_iterations - spent))

    def look(self, system: System, state: State, *, idle: bool = False, known: bool = False) -> Status:
        """Judge the state as it is now; `known` says that its balance is the one already found."""
        self.last = state.iteration
        if not self._sane(system, state) or self._collapsed(system, state):
            return Status.DIVERGED
        if not known:
            self.found = balance(system, state)
        if self.found.residual < self.best:
            self.best, self.best_at = self.found.residual, state.iteration
        self.good = state.copy()
        if self.found.met(self.settings.tolerance) and self._resting(system, state):
            return Status.CONVERGED
        if idle or state.iteration > 2 * self.best_at - self.first + PATIENCE:
            return Status.STALLED
        if state.iteration - self.first >= self.settings.max_iterations:
            return Status.MAX_ITERATIONS
        limit = self.settings.time_limit
        if limit is not None and time.monotonic() - self.started > limit:
            return Status.TIME_LIMIT
        return Status.RUNNING

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
        if state.time == 0.0:
            return True
        moving = float((system.mass[:, None] * state.v**2 * state.free).sum())
        return moving <= (self.settings.tolerance + self.found.floor) * self.found.scale * self.size

    def _sane(self, system: System, state: State) -> bool:
        """Finite, and not a thousand times out of the model's size; else say which particle and force."""
        if np.isfinite(state.v).all() and np.abs(state.x - system.x).max(initial=0.0) <= 1e5 * self.size:
            return True
        bad = ~np.isfinite(state.x).all(axis=1) | ~np.isfinite(state.v).all(axis=1)
        if not bad.any():
            bad = np.abs(state.x - system.x).max(axis=1) > 1e5 * self.size
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


def _restore(state: State, good: State) -> None:
    """Put the last good shape back, keeping what the elements remember of it."""
    state.x, state.v, state.free, state.time, state.iteration = good.x, good.v, good.free, good.time, good.iteration


def _sentence(system: System, status: Status, watch: _Watch) -> str:
    found, unit = watch.found, system.scene.units.force
    left = f"residual {found.residual:.3g}, {found.out_of_balance:.3g} {unit} out of balance"
    spent = watch.last - watch.first
    if status is Status.CONVERGED:
        rounding = " (the rounding floor)" if found.residual > watch.settings.tolerance else ""
        return f"In equilibrium after {spent} iterations: {left}{rounding}."
    if status is Status.DIVERGED and watch.collapse:
        return f"Collapsed after {spent} iterations; the last good shape is returned. {watch.collapse}."
    if status is Status.DIVERGED:
        advice = stability.warning(system, watch.good) or "Look for loads that nothing holds, or use solver auto"
        return f"Diverged after {spent} iterations at {watch.fault}; the last good shape is returned. {advice}."
    if status is Status.STALLED:
        return (
            f"Stalled after {spent} iterations at particle {found.worst}: {left}. Springs on their cutoff, loads that "
            "nothing holds, or a shape about to snap do this; look there, or raise the tolerance."
        )
    if status is Status.CANCELLED:
        return f"Cancelled after {spent} iterations: {left}."
    if status is Status.TIME_LIMIT:
        return f"Out of time ({watch.settings.time_limit:g} s) after {spent} iterations: {left}. Raise time_limit."
    return f"Not in equilibrium after {spent} iterations: {left}. Raise max_iterations."


def simulate(scene: Scene, frames: int | None = None) -> Iterator[Frame]:
    """Frames of a scene in motion, `sub_iterations` steps apart, bouncing included; ends at rest or after `frames`.

    The first frame is the start. The scene's solver, or `verlet` where that is `auto`.
    """
    running = Simulation(scene)
    yield running.frame()
    shown = 0
    while running.status is Status.RUNNING and (frames is None or shown < frames):
        running.step()
        shown += 1
        yield running.frame()


class Simulation:
    """A running system: stepped frame by frame, patched while it runs, saved and resumed bit for bit."""

    def __init__(self, scene: Scene) -> None:
        self.scene = scene
        self.system = compile(scene)
        self.state = self.system.start()
        self._begin()

    def _begin(self, *, fresh: bool = False) -> None:
        name = self.scene.settings.solver
        self.solver = solver("verlet" if name == "auto" else name)
        refusal = self.solver.refuse(self.system)
        if refusal:
            raise InputError("/settings/solver", refusal)
        self._warn()
        if fresh and not self.solver.physical or not self.state.scratch:
            self.solver.start(self.system, self.state)
        self._watch = _Watch(self.system, self.state)
        self.status = Status.RUNNING

    def _warn(self) -> None:
        if self.solver.physical and (said := stability.warning(self.system, self.state)):
            warnings = self.system.report.warnings
            warnings[:] = [w for w in warnings if not w.startswith("/settings/time_step")] + [said]

    def step(self, frames: int = 1) -> Status:
        """Advance by whole frames of `sub_iterations` steps; a diverged step restores the last good state."""
        for _ in range(frames):
            self.iterate(self.scene.settings.sub_iterations)
            if self.status is not Status.RUNNING:
                break
        return self.status

    def iterate(self, count: int) -> Status:
        """Advance by at most `count` iterations of the solver."""
        if self.status is Status.DIVERGED:
            return self.status
        self.solver.advance(self.system, self.state, count, 0.0 if self.solver.physical else self._watch.goal)
        self.status = self._watch.look(self.system, self.state)
        if self.status is Status.DIVERGED:
            self.state = self._watch.good.copy()
        elif self.status is Status.CONVERGED and not self.solver.physical:
            self.system.remember(self.state)
        elif self.status in (Status.STALLED, Status.MAX_ITERATIONS, Status.TIME_LIMIT):
            self.status = Status.RUNNING  # somebody is watching; they decide when to stop
        return self.status

    def frame(self) -> Frame:
        """The state as a client sees it."""
        message = _sentence(self.system, self.status, self._watch)
        if self.status is Status.RUNNING:
            message = f"Running: residual {self._watch.found.residual:.3g}."
        return Frame(
            self.state.x.copy(),
            carried(self.system, self.state),
            self.state.time,
            self.state.iteration,
            self.state.revision,
            self._watch.found.residual,
            self.status,
            message,
        )

    def result(self) -> Result:
        """Everything about the present state."""
        found = balance(self.system, self.state)
        message = _sentence(self.system, self.status, self._watch)
        if self.status is Status.RUNNING:
            message = f"Running: residual {found.residual:.3g}, {found.out_of_balance:.3g} {self.scene.units.force}."
        return gather(self.system, self.state, found, self.status, message, self.solver.name)

    def relax(self, *, progress: Progress | None = None, cancelled: Callable[[], bool] | None = None) -> Result:
        """Go to equilibrium from here with the scene's solver (auto: relaxation and Newton)."""
        result = relax_state(self.system, self.state, solver(self.scene.settings.solver), progress, cancelled)
        self.state.scratch.clear()
        self.solver.start(self.system, self.state)
        self._watch = _Watch(self.system, self.state)
        self.status = result.status
        return result

    def patch(self, edit: Patch | dict[str, object]) -> int:
        """Change anchors, loads, stiffness, rest lengths or settings while it runs; returns the new revision.

        InputError says what does not fit, and nothing has changed then.
        """
        apply(self.system, self.state, Patch.read(edit))
        self.scene = self.system.scene
        self._begin(fresh=True)
        return self.state.revision

    def save(self, path: str | Path) -> None:
        """Everything about this simulation in one .npz file: the scene, the state and the anchors as they are now."""
        arrays = self.state.arrays()
        for i, anchor in enumerate(self.system.held):
            arrays[f"held_{i}"] = np.column_stack([anchor.particles, anchor.targets])
            arrays[f"axes_{i}"] = np.array([float(anchor.number), *anchor.free])
        with open(path, "wb") as file:
            np.savez(
                file,
                allow_pickle=False,
                scene=np.array(self.scene.canonical),
                status=np.array(str(self.status)),
                **arrays,
            )

    @classmethod
    def load(cls, path: str | Path) -> Simulation:
        """The simulation that `save` wrote; it goes on bit for bit. InputError where the file is not one."""
        try:
            with np.load(path, allow_pickle=False) as file:
                arrays = {name: file[name] for name in file.files}
            loaded = cls(Scene.read(str(arrays.pop("scene"))))
            status = Status(str(arrays.pop("status")))
            count = sum(name.startswith("held_") for name in arrays)
            held = [(arrays.pop(f"held_{i}"), arrays.pop(f"axes_{i}")) for i in range(count)]
            loaded.state = State.of(arrays)
        except (OSError, KeyError, ValueError) as error:
            if isinstance(error, InputError):
                raise
            raise InputError(str(path), "not a saved simulation; give a file that Simulation.save wrote") from None
        loaded.system.held = [
            Held(int(a[0]), h[:, 0].astype(np.int64), np.ascontiguousarray(h[:, 1:]), a[1:].copy()) for h, a in held
        ]
        loaded._begin()
        loaded.status = status
        return loaded

    def reset(self) -> None:
        """Back to the start positions; anchors keep the particles they were given, and their present targets."""
        revision = self.state.revision
        self.state = self.system.start()
        self.state.revision = revision
        self._begin()
