"""The scene of a problem as a system, and particles of variables, goals and constraints that are named by the points
where they are drawn."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from hookean.errors import InputError, several
from hookean.scene.scene import Scene
from hookean.system.system import System, compile


def system_of(scene: Any) -> System:
    """A problem's scene (a Scene, or a dict or text of one) as a system; faults have their places in the problem."""
    try:
        return compile(Scene.read(scene))
    except InputError as error:
        raise several(
            [InputError(f"/scene{fault.pointer}".rstrip("/"), fault.sentence) for fault in error.faults]
        ) from None


def located(problem: Any) -> Any:
    """A problem with `particles` in the place of `points`: of each point the particle within the scene's tolerance.
    Raises InputError where none is."""
    if not isinstance(problem, Mapping) or "scene" not in problem:
        return problem
    named = [name for name in ("variables", "goals", "constraints") if _any(problem.get(name))]
    if not named:
        return problem
    system = system_of(problem["scene"])
    found = {**problem, "scene": system.scene}
    for name in named:
        found[name] = [_put(system, entry, f"/{name}/{i}") for i, entry in enumerate(problem[name])]
    return found


def _any(entries: Any) -> bool:
    return isinstance(entries, list | tuple) and any(isinstance(e, Mapping) and "points" in e for e in entries)


def _put(system: System, entry: Any, pointer: str) -> Any:
    if not isinstance(entry, Mapping) or "points" not in entry:
        return entry
    if "particles" in entry:
        raise InputError(f"{pointer}/points", "give either points or particles")
    try:
        points = np.asarray(entry["points"], dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        points = np.zeros(0)
    if points.ndim != 2 or points.shape[1] != 3 or not np.isfinite(points).all():
        raise InputError(f"{pointer}/points", "a list of points is expected, each x, y, z")
    particles = system.places.meet(points)
    for i in np.flatnonzero(particles < 0)[:1]:
        distances = np.linalg.norm(system.points - points[i], axis=1)
        where = ", ".join(f"{x:g}" for x in points[i])
        nearest = f"; the nearest is {distances.min():.4g} {system.scene.units.length} away" if len(distances) else ""
        raise InputError(f"{pointer}/points/{i}", f"no particle is drawn at ({where}){nearest}")
    return {**{k: v for k, v in entry.items() if k != "points"}, "particles": particles.tolist()}
