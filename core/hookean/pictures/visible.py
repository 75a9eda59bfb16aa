"""View: what of a result is to be seen, and from where. The geometry behind pictures, without any drawing."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.errors import InputError
from hookean.forces import KINDS
from hookean.forces.floor import Floor
from hookean.running.result import Result
from hookean.scene.scene import Scene

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

VIEWS = {"front": (-90.0, 0.0), "right": (0.0, 0.0), "top": (-90.0, 90.0), "isometric": (-60.0, 28.0)}
"""Named views as azimuth and elevation of the eye [degrees]."""
NOISE = 10.0  # times what is out of balance: reactions no larger than that are rounding


@dataclass
class Shape:
    """Springs, faces and strokes through one set of positions."""

    points: Floats
    springs: Ints = field(default_factory=lambda: np.zeros((0, 2), np.int64))
    faces: Floats = field(default_factory=lambda: np.zeros((0, 4, 3)))
    edged: NDArray[np.bool_] = field(default_factory=lambda: np.zeros(0, bool))  # faces whose edges are not all springs
    strokes: list[Floats] = field(default_factory=list)

    @property
    def body(self) -> Floats:
        """All points of the shape, (k, 3)."""
        return np.concatenate([self.points, self.faces.reshape(-1, 3), *self.strokes])


@dataclass
class Things:
    """What is to be drawn, in space. Arrows are rows of a foot and a vector."""

    shape: Shape
    forces: Floats  # of the springs
    held: Floats
    loads: Floats  # (k, 2, 3)
    reactions: Floats  # (k, 2, 3)
    floors: list[tuple[Floats, Floats]] = field(default_factory=list)
    frames: dict[str, Shape] = field(default_factory=dict)
    curves: dict[str, Floats] = field(default_factory=dict)

    @property
    def body(self) -> Floats:
        """All points of the model, its frames and curves, (k, 3)."""
        return np.concatenate([self.shape.body, *(f.body for f in self.frames.values()), *self.curves.values()])


def springs(result: Result) -> tuple[NDArray[np.int64], Floats]:
    """Particles (m, 2) and force (m,) of everything that pulls or pushes along a line."""
    pairs, forces = [np.zeros((0, 2), np.int64)], [np.zeros(0)]
    for columns in result.forces:
        force, index = columns.get("force"), columns.get("particles")
        if force is not None and index is not None and np.ndim(force) == 1 and np.shape(index)[1:] == (2,):
            pairs.append(np.asarray(index))
            forces.append(np.asarray(force))
    return np.concatenate(pairs), np.concatenate(forces)


def collect(
    result: Result | None,
    scene: Scene | None,
    frames: Mapping[str, Floats] | None = None,
    curves: Mapping[str, Floats] | None = None,
) -> Things:
    """What is to be seen of a result, of the same particles elsewhere (`frames`) and of further `curves`.

    InputError where frames or curves have the wrong shape, or nothing is to be seen.
    """
    lines = {str(label): _points(f"curve {label!r}", given, None) for label, given in (curves or {}).items()}
    if result is None:
        if frames:
            raise InputError(
                "panel", "has frames but no result; give the result, whose springs are drawn in each frame"
            )
        none = np.zeros((0, 2, 3))
        things = Things(Shape(np.zeros((0, 3))), np.zeros(0), np.zeros((0, 3)), none, none, curves=lines)
    else:
        things = _of_result(result, scene)
        count, mesh = len(result.particles), _Meshes(result, scene)
        for label, given in (frames or {}).items():
            things.frames[str(label)] = mesh.shape(_points(f"frame {label!r}", given, count), things.shape.springs)
        things.curves = lines
    if not len(things.body):
        raise InputError("panel", "has nothing to draw; give it a result with particles, or a curve")
    return things


def _points(pointer: str, given: Any, count: int | None) -> Floats:
    """Points (k, 3) of a frame or curve, `count` of them if that is given."""
    try:
        points = np.asarray(given, dtype=np.float64)
    except (TypeError, ValueError):
        raise InputError(pointer, "is not an array of numbers; give points (k, 3)") from None
    if points.ndim != 2 or points.shape[1] != 3 or not len(points) or len(points) != (count or len(points)):
        wanted = f"({count}, 3), one point for each particle" if count else "(k, 3), k at least 1"
        raise InputError(pointer, f"has the shape {points.shape}; give {wanted}")
    if not np.isfinite(points).all():
        raise InputError(pointer, "has a coordinate that is not finite; give finite points")
    return points


def _of_result(result: Result, scene: Scene | None) -> Things:
    x = result.particles
    pairs, forces = springs(result)
    carried = np.asarray(result.reactions["particles"], dtype=np.int64)
    held = carried[np.asarray(result.reactions["exact"], dtype=bool)]
    pushes = [np.stack([x[carried], np.asarray(result.reactions["force"]).reshape(-1, 3)], axis=1)]
    touching = np.asarray(result.contacts["particles"], dtype=np.int64)
    pushes.append(np.stack([x[touching], np.asarray(result.contacts["force"]).reshape(-1, 3)], axis=1))
    pushes.append(_at_particles(result, "support"))
    loads, reactions = (
        _sizeable(result, vectors) for vectors in (_at_particles(result, "load"), np.concatenate(pushes))
    )
    shape = _Meshes(result, scene).shape(x, pairs)
    things = Things(shape, forces, x[held], loads, reactions)
    if scene is not None:
        floors = [f for f in (scene.settings.floor, *scene.forces) if isinstance(f, Floor)]
        things.floors = [(np.asarray(f.point), np.asarray(f.normal) / np.linalg.norm(f.normal)) for f in floors]
    return things


def _at_particles(result: Result, role: str) -> Floats:
    """Sum of all forces of a role on each particle that one acts on by itself (k, 2, 3)."""
    total = np.zeros_like(result.particles)
    for columns in result.forces:
        cls, force = KINDS[columns["kind"]], columns.get("force")
        if cls.bearing:  # among the reactions
            continue
        if cls.role == role and cls.arity == 1 and force is not None and np.ndim(force) == 2:
            np.add.at(total, np.asarray(columns["particles"])[:, 0], np.asarray(force))
    loaded = np.flatnonzero(total.any(axis=1))
    return np.stack([result.particles[loaded], total[loaded]], axis=1)


def _sizeable(result: Result, vectors: Floats) -> Floats:
    """Forces (k, 2, 3), none where all of them are no larger than what is out of balance."""
    largest = float(np.linalg.norm(vectors[:, 1], axis=1).max(initial=0.0))
    return vectors[: len(vectors) if largest > NOISE * result.out_of_balance else 0]


class _Meshes:
    """Carried geometry and the meshes of forces, to be put through any positions of the particles."""

    def __init__(self, result: Result, scene: Scene | None) -> None:
        self.items = result.geometry
        self.at = {point.tobytes(): i for i, point in reversed(list(enumerate(result.particles + 0.0)))}
        carries = any(item["kind"] == "mesh" for item in self.items)
        self.of_forces = [] if carries or scene is None else _meshes_of_forces(scene)

    def shape(self, x: Floats, pairs: Ints) -> Shape:
        """Everything with the particles at `x`; what rides on none stays."""
        faces, edged, strokes = [np.zeros((0, 4, 3))], [np.zeros(0, bool)], []
        joined = np.unique(np.sort(pairs, axis=1) @ np.array([len(x), 1]))
        for item in self.items:
            if item["kind"] == "mesh":
                rows, corners = self._riders(item["vertices"]), np.asarray(item["faces"])
                faces.append(self._moved(item["vertices"], rows, x)[corners])
                edged.append(_open(rows[corners], joined, len(x)))
            elif item["kind"] == "lines":
                ends = np.asarray(item["lines"]).reshape(-1, 3)
                strokes += list(self._moved(ends, self._riders(ends), x).reshape(-1, 2, 3))
            elif item["kind"] in ("polyline", "curve"):
                points = self._moved(item["points"], self._riders(item["points"]), x)
                strokes.append(smooth(points, item) if item["kind"] == "curve" else points)
        for corners in self.of_forces:
            faces.append(x[corners])
            edged.append(_open(corners, joined, len(x)))
        return Shape(x, pairs, np.concatenate(faces), np.concatenate(edged), strokes)

    def _riders(self, points: Any) -> Ints:
        """The particle each point rides on, which is exactly where it is; -1 for none."""
        return np.array([self.at.get(p.tobytes(), -1) for p in np.asarray(points, np.float64) + 0.0], dtype=np.int64)

    def _moved(self, points: Any, rows: Ints, x: Floats) -> Floats:
        return np.where((rows >= 0)[:, None], x[np.maximum(rows, 0)], np.asarray(points, np.float64))


def _open(corners: Ints, joined: Ints, count: int) -> NDArray[np.bool_]:
    """Which faces have an edge without a spring along it, or a corner that is no particle; `joined` are the springs as
    numbers, the first of their particles times `count` and the second one."""
    edges = np.sort(np.stack([corners, np.roll(corners, -1, axis=1)], axis=-1), axis=-1)
    a, b = edges[..., 0], edges[..., 1]
    return np.asarray(((a < 0) | ((a != b) & ~np.isin(a * count + b, joined))).any(axis=1))


def _meshes_of_forces(scene: Scene) -> list[Ints]:
    """Faces (m, 4), by particles, of the meshes that forces on areas act on."""
    from hookean.system.weld import Welded

    given = [getattr(f, "mesh", None) for f in scene.forces if f.element_arity > 2]
    names = list(dict.fromkeys(name for name in given if name is not None))
    welded = Welded(scene) if names else None
    return [welded.faces(name) for name in names if welded is not None]


def smooth(points: Floats, curve: Mapping[str, Any]) -> Floats:
    """A NURBS curve as a fine polyline: control points, `degree`, `knots` as Rhino counts them (points + degree - 1),
    clamped and uniform where there are none that fit, and `weights`."""
    from scipy.interpolate import BSpline

    count = len(points)
    degree = min(int(curve.get("degree") or 3), count - 1)
    if degree < 2:
        return points
    given = np.asarray(curve.get("knots") or (), dtype=np.float64)
    if len(given) != count + degree - 1 or (np.diff(given) < 0).any() or not given[degree - 1] < given[count - 1]:
        given = np.clip(np.arange(count + degree - 1.0) - degree + 1, 0, count - degree)
    knots = np.concatenate([given[:1], given, given[-1:]])
    weights = np.broadcast_to(1.0 if curve.get("weights") is None else np.asarray(curve["weights"]), count)
    if not (weights > 0).all():
        weights = np.ones(count)
    spline = BSpline(knots, np.column_stack([points * weights[:, None], weights]), degree)
    inner = np.unique(knots[degree : count + 1])
    at = np.unique(np.concatenate([np.linspace(a, b, 17) for a, b in pairwise(inner)]))
    raised = spline(at)
    line: Floats = raised[:, :3] / raised[:, 3:]
    return line


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
