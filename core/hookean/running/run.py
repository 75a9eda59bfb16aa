"""Running: the one loop around every solver, to equilibrium or to whatever ends it."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from hookean.errors import InputError
from hookean.running.result import Result, Status, gather
from hookean.running.watch import Watch
from hookean.scene.scene import Scene
from hookean.solvers import Solver, solver
from hookean.stability import time_steps
from hookean.stability.equilibrium import assess
from hookean.stability.exact_reactions import exact_reactions
from hookean.system.impulses import ignored
from hookean.system.state import State
from hookean.system.system import System, compile
from hookean.system.untaken import untaken_moment

Progress = Callable[[int, float], None]
"""Called with the iteration and the residual now and then while a relaxation runs."""


def relax(scene: Scene, *, progress: Progress | None = None, cancelled: Callable[[], bool] | None = None) -> Result:
    """Bring a scene to equilibrium with its solver; always returns, failure is the result's status and message.

    `cancelled` is asked between bursts of iterations. Raises InputError where the scene does not fit together.
    """
    began = time.monotonic()
    system = compile(scene)
    state = system.start()
    return relax_state(system, state, solver(scene.settings.solver), progress, cancelled, began)


def relax_state(
    system: System,
    state: State,
    method: Solver,
    progress: Progress | None = None,
    cancelled: Callable[[], bool] | None = None,
    began: float | None = None,
    *,
    near: bool = False,
) -> Result:
    """`relax` from a state; `state` is left at the last good shape. `time_limit` counts from `began`, a time of
    `time.monotonic` [s], or from now. `near`: an equilibrium is near, such as the form that a load case starts from;
    exact steps then go on until loads and reactions balance."""
    began = time.monotonic() if began is None else began
    refusal = method.refuse(system)
    if refusal:
        raise InputError("/settings/solver", refusal)
    if method.physical and (said := time_steps.warning(system, state, method)) and said not in system.report.warnings:
        system.report.warnings.append(said)
    if not method.physical:
        system.report.warnings += [said for said in ignored(system) if said not in system.report.warnings]
    method.start(system, state)
    if near:
        method.sharpen(state)
    state.force_scale = np.zeros(0)  # of this run alone
    watch = Watch(system, state, method)
    watch.started = began
    status = watch.look(system, state, known=True)
    if status is Status.RUNNING and not method.physical and untaken_moment(system, state):
        status = Status.STALLED  # it turns without end
    while True:
        if status is Status.CONVERGED:
            if near and not method.physical:
                watch.finish(system, state)
            status = watch.onward(system, state)
        if status is not Status.RUNNING:
            break
        if cancelled is not None and cancelled():
            status = Status.CANCELLED
            break
        done = method.advance(system, state, watch.burst(system, state), watch.goal)
        status = watch.look(system, state, idle=done == 0)
        if progress is not None:
            progress(state.iteration, watch.found.residual)
    if status is Status.CONVERGED:
        watch.remember(system, state)  # other ends are on no physical path, and leave no mark
    if status is Status.STALLED and not method.physical and watch.rest is None:
        watch.good, watch.found = replace(watch.top, iteration=watch.last), watch.top_found
        if watch.found.still(system.scene.settings.tolerance):  # in balance, and yet not good enough
            watch.rest = assess(system, watch.good, watch.found)
    _restore(state, watch.good, memory=status is Status.DIVERGED)
    if not method.physical:
        state.v[:] = 0.0  # fictitious: nothing moved
    system.report.warnings += [note for note in watch.notes if note not in system.report.warnings]
    if status is Status.CONVERGED and not method.physical:
        reactions = exact_reactions(system, state, watch.found, method)
        if reactions is not watch.found.reactions:
            watch.found = replace(watch.found, reactions=reactions)
    used = getattr(method, "used", None)
    name = f"auto: {', '.join(used) or 'nothing to do'}" if used is not None else method.name
    message = watch.sentence(system, status)
    if status is Status.CONVERGED and method.remark:
        message = f"{message} {method.remark}"
    result = gather(system, state, watch.found, watch.rest, status, message, name, moving=method.physical)
    if status is Status.CONVERGED and system.films is not None:
        from hookean.running.uncarried import uncarried  # other scenes need not load films

        result.report.warnings[:] = dict.fromkeys([*result.report.warnings, *uncarried(system, state)])
    beams = any(force.kind_name == "beam" for force in system.scene.forces)
    if status is Status.CONVERGED and not method.physical and beams:
        from hookean.running.between import bent_between  # other scenes need not load beams

        result.report.warnings[:] = dict.fromkeys([*result.report.warnings, *bent_between(system, result)])
    return result


def _restore(state: State, good: State, *, memory: bool) -> None:
    """Put the last good shape back, and with `memory` what its elements remembered."""
    state.x, state.v, state.free, state.time, state.iteration = good.x, good.v, good.free, good.time, good.iteration
    if memory:
        state.memory = good.memory


def bounded(scene: Scene, seconds: float) -> Scene:
    """The scene with a time limit of at most `seconds`."""
    given = scene.settings.time_limit
    if given is not None and given <= seconds:
        return scene
    return scene.replaced(settings=scene.settings.replaced(time_limit=seconds))
