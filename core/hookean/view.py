"""View: what of a result is to be seen, and from where. The geometry behind `picture`, without any drawing."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.errors import InputError
from hookean.forces.floor import Floor
from hookean.result import Result
from hookean.scene import Scene

Floats = NDArray[np.float64]

VIEWS = {"front": (-90.0, 0.0), "right": (0.0, 0.0), "top": (-90.0, 90.0), "isometric": (-60.0, 28.0)}
"""Named views as azimuth and elevation of the eye [degrees]."""


@dataclass
class Things:
    """What is to be drawn, in space. Arrows are rows of a foot and a vector."""

    points: Floats
    springs: NDArray[np.int64]
    forces: Floats
    faces: Floats  # (m, 4, 3)
    strokes: list[Floats]
    held: Floats
    loads: Floats  # (k, 2, 3)
    reactions: Floats  # (k, 2, 3)
    floors: list[tuple[Floats, Floats]] = field(default_factory=list)

    @property
    def body(self) -> Floats:
        """All points of the model, (k, 3)."""
        return np.concatenate([self.points, self.faces.reshape(-1, 3), *self.strokes])


def springs(result: Result) -> tuple[NDArray[np.int64], Floats]:
    """Particles (m, 2) and force (m,) of everything that pulls or pushes along a line."""
    pairs, forces = [np.zeros((0, 2), np.int64)], [np.zeros(0)]
    for columns in result.forces:
        force, index = columns.get("force"), columns.get("particles")
        if force is not None and index is not None and np.ndim(force) == 1 and np.shape(index)[1:] == (2,):
            pairs.append(np.asarray(index))
            forces.append(np.asarray(force))
    return np.concatenate(pairs), np.concatenate(forces)


def collect(result: Result, scene: Scene | None) -> Things:
    x = result.particles
    pairs, forces = springs(result)
    faces, strokes = [np.zeros((0, 4, 3))], []
    for item in result.geometry:
        if item["kind"] == "mesh":
            faces.append(np.asarray(item["vertices"])[np.asarray(item["faces"])])
        elif item["kind"] == "lines":
            strokes += list(np.asarray(item["lines"]))
        elif item["kind"] == "polyline" or item.get("degree") == 1:
            strokes.append(np.asarray(item["points"]))
    things = Things(x, pairs, forces, np.zeros((0, 4, 3)), strokes, x[:0], _loads(result), np.zeros((0, 2, 3)))
    held = np.asarray(result.reactions["particles"], dtype=np.int64)
    things.held = x[held]
    pushes = [np.stack([x[held], np.asarray(result.reactions["force"]).reshape(-1, 3)], axis=1)]
    touching = np.asarray(result.contacts["particles"], dtype=np.int64)
    pushes.append(np.stack([x[touching], np.asarray(result.contacts["force"]).reshape(-1, 3)], axis=1))
    things.reactions = np.concatenate(pushes)
    if scene is not None:
        if len(faces) == 1:
            faces += _meshes_of_forces(scene, x)
        floors = [f for f in (scene.settings.floor, *scene.forces) if isinstance(f, Floor)]
        things.floors = [(np.asarray(f.point), np.asarray(f.normal) / np.linalg.norm(f.normal)) for f in floors]
    things.faces = np.concatenate(faces)
    return things


def _loads(result: Result) -> Floats:
    """Sum of all loads on each loaded particle."""
    total = np.zeros_like(result.particles)
    for columns in result.forces:
        force, index = columns.get("force"), columns.get("particles")
        if force is not None and index is not None and np.ndim(force) == 2 and np.shape(index)[1:] == (1,):
            np.add.at(total, np.asarray(index)[:, 0], np.asarray(force))
    loaded = np.flatnonzero(total.any(axis=1))
    return np.stack([result.particles[loaded], total[loaded]], axis=1)


def _meshes_of_forces(scene: Scene, x: Floats) -> list[Floats]:
    """Faces of the meshes that forces on areas act on, where the particles are now."""
    from hookean.weld import Welded

    given = [getattr(f, "mesh", None) for f in scene.forces if f.element_arity > 2]
    names = list(dict.fromkeys(name for name in given if name is not None))
    welded = Welded(scene) if names else None
    return [x[welded.faces(name)] for name in names if welded is not None]


def eye_of(view: Any, things: Things) -> Floats:
    """Rows: to the right, up and towards the eye; unit vectors."""
    if view is None:
        flat = _plane_of(things)
        if flat is not None:
            return flat
        view = "isometric"
    if isinstance(view, str):
        if view not in VIEWS:
            raise InputError("view", f"{view!r} given; {', '.join(VIEWS)} or (azimuth, elevation) are allowed")
        view = VIEWS[view]
    try:
        azimuth, elevation = (np.radians(float(angle)) for angle in view)
    except (TypeError, ValueError):
        raise InputError("view", f"{view!r} given; a name or two angles in degrees are allowed") from None
    if not np.isfinite(azimuth + elevation):
        raise InputError("view", "an angle is not finite; give degrees")
    ca, sa, ce, se = np.cos(azimuth), np.sin(azimuth), np.cos(elevation), np.sin(elevation)
    return np.round([[-sa, ca, 0.0], [-se * ca, -se * sa, ce], [ce * ca, ce * sa, se]], 15)


def _plane_of(things: Things) -> Floats | None:
    """The view on to a plane shape whose loads lie in its plane; None for a shape in space."""
    body = things.body - things.body.mean(axis=0)
    scale = float(np.abs(body).max())
    if scale == 0.0:
        return _facing(np.array([0.0, -1.0, 0.0]))
    spread, axes = np.linalg.eigh(body.T @ body / scale**2)
    if spread[0] > 1e-10 * spread[2]:
        return None
    normal = axes[:, 0]
    if spread[1] <= 1e-10 * spread[2]:
        # a straight line: seen from the front, unless it points there
        along = axes[:, 2]
        front = np.array([0.0, -1.0, 0.0]) if abs(along[1]) < 0.99 else np.array([1.0, 0.0, 0.0])
        normal = front - along * (front @ along)
        normal /= np.linalg.norm(normal)
    vectors = np.concatenate([things.loads[:, 1], *(n[None] for _, n in things.floors)])
    if len(vectors) and np.abs(vectors @ normal).max() > 1e-3 * np.abs(vectors).max():
        return None
    return _facing(np.where(np.abs(normal) < 1e-9, 0.0, normal))


def _facing(normal: Floats) -> Floats:
    """The view against a normal, z up; seen from the front, the right or above, not from behind."""
    if abs(normal[2]) > 0.999:
        return np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    side = normal[1] if abs(normal[1]) > 1e-9 else -normal[0]
    towards = -normal if side > 0 else normal
    up = np.array([0.0, 0.0, 1.0]) - towards * towards[2]
    up /= np.linalg.norm(up)
    return np.stack([np.cross(up, towards), up, towards])
