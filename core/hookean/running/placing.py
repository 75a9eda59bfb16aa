"""A simulation that begins at a given shape instead of the start of its scene."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hookean.errors import InputError
from hookean.running.result import Result
from hookean.running.simulation import Simulation
from hookean.scene.scene import Scene

Floats = NDArray[np.float64]


def placed(scene: Scene, particles: ArrayLike, quaternions: Floats | None = None) -> Simulation:
    """The simulation of a scene with its particles at `particles` (n, 3) [length], at rest, and with orientations
    `quaternions` (r, 4) where it has them. What anchors hold is held there from now on. Raises InputError where the
    positions are not finite or are not one for each particle."""
    simulation = Simulation(scene)
    system, state = simulation.system, simulation.state
    given = _rows(particles, system.slots.count)
    if quaternions is not None:
        system.slots.put(state, given, quaternions)
    state.x[: len(given)] = given
    state.v[:] = 0.0
    for anchor in system.held:
        anchor.targets = given[anchor.particles]
    system.hold(state)
    system.brace()
    simulation.arrive(state)
    return simulation


def resumed(result: Result) -> Simulation:
    """The simulation of a result's scene that begins at its shape, with its status. Raises InputError for a result
    without its scene."""
    if result.scene is None:
        raise InputError("result", "has no scene; give a result of relax or simulate, or a scene")
    simulation = placed(result.scene, result.particles, np.asarray(result.rotations["quaternions"], float))
    simulation.arrive(simulation.state, result.status, result.message)
    return simulation


def _rows(particles: ArrayLike, count: int) -> Floats:
    try:
        given = np.asarray(particles, np.float64)
    except (TypeError, ValueError):
        raise InputError("positions", "give numbers, one row x, y, z for each particle") from None
    if given.shape != (count, 3):
        raise InputError("positions", f"have the shape {given.shape}; give ({count}, 3), a row for each particle")
    if not np.isfinite(given).all():
        raise InputError("positions", "have values that are not finite; give finite numbers [length]")
    return given
