"""What functions of Hops that solve have in common: relaxing within bounds, moving to a time, common outputs."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from hookean.scene.scene import Scene
from hookean_server.hops.model import Function, Inputs, Parameter, inputs_of, item
from hookean_server.problems import Problem
from hookean_server.workers.task import Cancelled

PARTICLES = Parameter("Particles", "Pt", "Point", "Particles in equilibrium [model unit]")
SPRINGS = Parameter("Springs", "L", "Line", "Springs in equilibrium, in the order of the input")
MESH = item("Mesh", "M", "Mesh", "The mesh in equilibrium")
FORCES = Parameter("Forces", "F", "Number", "Force of every spring [N], tension positive")
REACTIONS = Parameter("Reactions", "Re", "Vector", "Force of every anchor on its particle [N]")
SUPPORTS = Parameter("Supports", "Su", "Point", "Points of the reactions, in their order [model unit]")
LARGEST = item("Largest force", "Fm", "Number", "The largest force of a spring [N]")
LENGTH = item("Length", "Lt", "Number", "Length of all springs [model unit]")
STATUS = item("Status", "S", "Text", "converged, or another status of the run")


STIFFNESS = item("Stiffness", "k", "Number", "Stiffness of every spring [N/model unit]", minimum=0.0)
REST_FACTOR = item("Rest factor", "R", "Number", "Rest length / drawn length [-]; 0: as short as possible",
                   minimum=0.0, maximum=10.0)  # fmt: skip
LENGTH_FACTOR = replace(REST_FACTOR, name="Length factor")
LOAD = item("Load", "P", "Number", "Force down on every particle [N]; below 0: up")


Found = Callable[[Inputs, Scene, Any], dict[str, Any]]
"""What a function of a figure gives: its outputs by name, from its inputs, the scene and the result."""


def relaxing(make: Callable[..., Scene], found: Found, *about: Any, **settings: Any) -> Function:
    """The function that relaxes a figure's scene, made of its inputs; `about` is what stands in a Function, from its
    title to its outputs."""
    return _solving(make, found, about, lambda *given: relaxed(*given, **settings))


def moving(make: Callable[..., Scene], found: Found, *about: Any, **settings: Any) -> Function:
    """As `relaxing`, of a scene that moves until its input `Time`."""
    return _solving(make, found, about, lambda inputs, *of: moved(inputs, *of, until=inputs.one("Time"), **settings))


def _solving(make: Callable[..., Scene], found: Found, about: Any, solve: Callable[..., Any]) -> Function:
    title, nickname, description, inputs, outputs = about

    def run(inputs: Inputs, cancelled: Cancelled) -> dict[str, Any]:
        scene = inputs.make(make)
        return found(inputs, scene, solve(inputs, scene, cancelled))

    return Function(title, nickname, description, inputs_of(make, *inputs), outputs, run, "Figures")


def relaxed(inputs: Inputs, scene: Scene, cancelled: Cancelled, **settings: Any) -> Any:
    """The equilibrium of a scene with some other `settings`; what a person should know of it goes to the warnings."""
    from hookean.running.run import relax

    result = relax(_placed(inputs, scene, time_limit=inputs.seconds, **settings), cancelled=cancelled)
    if result.status in ("time_limit", "cancelled"):
        raise out_of_time(inputs)
    inputs.warnings += remarks(result)
    return result


def moved(inputs: Inputs, scene: Scene, cancelled: Cancelled, *, until: float, **settings: Any) -> Any:
    """A scene in motion at a time: the state of the step nearest to it, of those that end a frame."""
    from hookean.running.simulation import Simulation

    running = Simulation(_placed(inputs, scene, **settings))
    taken = running.scene.settings
    frames = round(until / (taken.time_step * taken.sub_iterations))
    stop = time.monotonic() + inputs.seconds
    for _ in range(frames):
        if running.step() != "running":
            break
        if time.monotonic() > stop or cancelled():
            raise out_of_time(inputs)
    result = running.result()
    if result.status == "diverged":
        inputs.warnings.append(result.message)
    inputs.warnings += _notes(result)
    return result


def _placed(inputs: Inputs, scene: Scene, **settings: Any) -> Scene:
    """A scene in the units of the model, with nothing that rides along; people drag points on a canvas, so one that
    meets no particle is a warning."""
    units = scene.units.model_copy(update={"length": inputs.units})
    settled = scene.settings.model_copy(update=settings)
    own = {"units": units, "weld_tolerance": inputs.tolerance, "strict": False, "settings": settled, "geometry": ()}
    return scene.model_copy(update=own)


def out_of_time(inputs: Inputs) -> Problem:
    """A result cut off by the clock is an error: it would be kept for ever, and a quicker machine has another."""
    said = f"Not finished within {inputs.seconds:g} s; give a coarser model, less time, or a higher tolerance."
    return Problem("out-of-time", said)


def remarks(result: Any) -> list[str]:
    """What a person should know of a result."""
    said = [] if result.converged else [result.message]
    return said + _notes(result)


def _notes(result: Any) -> list[str]:
    return [*result.report.left_out()[:5], *result.report.warnings[:5]]


def common(result: Any, *names: str) -> dict[str, Any]:
    """The outputs that most functions have, of the springs of these names."""
    columns = [result.force(name) for name in names]
    springs = [result.particles[found["particles"]] for found in columns]
    return {
        "Particles": result.particles,
        "Springs": np.concatenate(springs),
        "Forces": np.concatenate([found["force"] for found in columns]),
        "Reactions": result.reactions["force"],
        "Supports": result.particles[result.reactions["particles"]],
        "Status": str(result.status),
    }
