"""Particle numbers of a running system as a scene has them: by number, or by where the particles start.

A scene numbers the particles that it gives; those welded from coordinates have no number in it, but a place. Clients of
a running system has numbers of all of them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from hookean.scene.scene import Anchor, Scene
    from hookean.system.system import Held, System

Ints = NDArray[np.int64]


def addressed(system: System, scene: Scene, particles: Ints, *, points: bool = True) -> tuple[Scene, dict[str, Any]]:
    """The fields `particles` or `points` by which `scene`, of the same particles as `system`, refers to `particles`
    (any shape), and the scene that does.

    `points`: whether coordinates may stand for them. Where they may not, or where two particles of the scene start
    at one place, the scene returned gives all particles of the system, in their order.
    """
    if not particles.size or int(particles.max()) < len(scene.particles):
        return scene, {"particles": particles}
    start = system.x[particles.ravel()]
    if points and np.array_equal(system.places.meet(start), particles.ravel()):
        return scene, {"points": start}
    return numbered(system, scene), {"particles": particles}


def numbered(system: System, scene: Scene) -> Scene:
    """The same scene with all particles of the system given: its coordinates weld onto those they welded to before."""
    n = system.slots.count
    changed: dict[str, Any] = {"particles": system.points}
    if isinstance(scene.masses, np.ndarray):
        changed["masses"] = system.mass[:n]
    if scene.velocities is not None:
        changed["velocities"] = system.v[:n]
    return scene.replaced(**changed)


def edited_scene(system: System) -> Scene:
    """The scene of a running system with its anchors as they are now: moved, thinned, and with those pinned while it
    ran. Where nothing was done to an anchor it is as it was given."""
    scene, anchors = system.scene, []
    for held in system.held:
        if held.number >= 0 and _same(system, held, scene.anchors[held.number]):
            anchors.append(scene.anchors[held.number])
        elif len(held.particles):
            scene, place = addressed(system, scene, held.particles)
            anchors.append(_anchor(system, held, place))
    return scene.replaced(anchors=tuple(anchors))


def axes_held(free: NDArray[np.float64]) -> Any:
    """The axes that are held, such as "xz", by their freedom (3,), 0 where held."""
    return "".join(axis for axis, movable in zip("xyz", free, strict=True) if not movable)


def _same(system: System, held: Held, given: Anchor) -> bool:
    """Whether an anchor holds what it was given to hold, where it was given to hold it."""
    if given.particles is not None:
        particles = np.asarray(given.particles)
    else:
        particles = system.places.meet(np.asarray(given.points))
    met = particles >= 0
    targets = system.x[particles] if given.targets is None else np.asarray(given.targets)
    return np.array_equal(held.particles, particles[met]) and np.array_equal(held.targets, targets[met])


def _anchor(system: System, held: Held, place: dict[str, Any]) -> Anchor:
    from hookean.scene.scene import Anchor

    axes, rotations = (axes_held(free) for free in (held.free, held.turning))
    targets = None if np.array_equal(held.targets, system.x[held.particles]) else held.targets
    return Anchor(name=held.name, targets=targets, axes=axes, rotations=rotations, **place)
