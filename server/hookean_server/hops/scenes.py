"""What functions of Hops that solve have in common: relaxing within bounds, moving to a time, common outputs."""

from __future__ import annotations

import time
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.values.mesh import Mesh
from hookean_server.hops.model import Inputs, Parameter, item
from hookean_server.problems import Problem
from hookean_server.workers.task import Cancelled

Floats = NDArray[np.float64]

PARTICLES = Parameter("Particles", "Pt", "Point", "Particles in equilibrium [model unit]")
SPRINGS = Parameter("Springs", "L", "Line", "Springs in equilibrium, in the order of the input")
MESH = item("Mesh", "M", "Mesh", "The mesh in equilibrium")
FORCES = Parameter("Forces", "F", "Number", "Force of every spring [N], tension positive")
REACTIONS = Parameter("Reactions", "Re", "Vector", "Force of every anchor on its particle [N]")
SUPPORTS = Parameter("Supports", "Su", "Point", "Points of the reactions, in their order [model unit]")
STATUS = item("Status", "S", "Text", "converged, or another status of the run")


def stiffness(default: float, unit: str = "N/model unit") -> Parameter:
    """The input of a stiffness."""
    return item("Stiffness", "k", "Number", f"Stiffness of every spring [{unit}]", default, minimum=0.0)


def rest_factor(default: float, name: str = "Rest factor", nickname: str = "R") -> Parameter:
    """The input of a rest factor."""
    said = "Rest length / drawn length [-]; 0: as short as possible"
    return item(name, nickname, "Number", said, default, minimum=0.0, maximum=10.0)


def load(default: float) -> Parameter:
    """The input of a load straight down on each particle."""
    return item("Load", "P", "Number", "Force down on every particle [N]; below 0: up", default)


def particles_of(points: Floats, force: float) -> dict[str, Any]:
    """The load of `load` on particles."""
    return {"kind": "unary", "name": "load", "particles": np.arange(len(points)), "vector": [0.0, 0.0, -force]}


def relaxed(inputs: Inputs, scene: dict[str, Any], cancelled: Cancelled) -> Any:
    """The equilibrium of a scene; what a person should know of it goes to the warnings."""
    from hookean.running.run import relax
    from hookean.scene.scene import Scene

    settings = {"tolerance": 1e-9, **scene.get("settings", {}), "time_limit": inputs.seconds}
    result = relax(Scene.model_validate({**_common(inputs), **scene, "settings": settings}), cancelled=cancelled)
    if result.status in ("time_limit", "cancelled"):
        raise out_of_time(inputs)
    inputs.warnings += remarks(result)
    return result


def moved(inputs: Inputs, scene: dict[str, Any], until: float, cancelled: Cancelled) -> Any:
    """A scene in motion at a time: the state of the step nearest to it, of those that end a frame."""
    from hookean.running.simulation import Simulation
    from hookean.scene.scene import Scene

    running = Simulation(Scene.model_validate({**_common(inputs), **scene}))
    settings = running.scene.settings
    frames = round(until / (settings.time_step * settings.sub_iterations))
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


def out_of_time(inputs: Inputs) -> Problem:
    """A result cut off by the clock is an error: it would be kept for ever, and a quicker machine has another."""
    said = f"Not finished within {inputs.seconds:g} s; give a coarser model, less time, or a higher tolerance."
    return Problem("out-of-time", said)


def remarks(result: Any) -> list[str]:
    """What a person should know of a result."""
    said = [] if result.converged else [result.message]
    return said + _notes(result)


def _common(inputs: Inputs) -> dict[str, Any]:
    """What all scenes have; people drag points on a canvas, so one that meets no particle is a warning."""
    return {"units": {"length": inputs.units}, "weld_tolerance": inputs.tolerance, "strict": False}


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


def chain(count: int) -> NDArray[np.int64]:
    """The pairs of neighbours (count, 2) in a row of count + 1 particles."""
    return np.stack([np.arange(count), np.arange(1, count + 1)], axis=1)


def row(start: Any, end: Any, count: int) -> Floats:
    """Points (count + 1, 3) at equal distances."""
    return np.asarray(np.linspace(start, end, count + 1), dtype=np.float64)


def grid(x: Floats, y: Floats, z: Floats | None = None) -> Mesh:
    """A mesh over the plan of the steps x (m,) and y (n,), at heights z (m, n): y fastest, sides along x first."""
    steps = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1)
    heights = np.zeros(steps.shape[:2]) if z is None else z
    number = np.arange(len(x) * len(y)).reshape(len(x), len(y))
    faces = np.stack([number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]], axis=-1)
    return Mesh(np.dstack([steps, heights]).reshape(-1, 3), faces.reshape(-1, 4))


def area(mesh: Mesh) -> float:
    """Area of a mesh of quads [length^2], each the mean of its two cuts into triangles."""
    a, b, c, d = mesh.vertices[mesh.faces].transpose(1, 0, 2)
    cuts = (np.cross(b - a, c - a), np.cross(c - a, d - a), np.cross(b - a, d - a), np.cross(c - b, d - b))
    return float(0.25 * sum(np.linalg.norm(n, axis=1).sum() for n in cuts))
