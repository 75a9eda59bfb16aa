"""A relaxed scene as layers and objects for a .3dm file: lines and meshes coloured by force, reactions."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from hookean.errors import InputError
from hookean.files.recipe.build import Built
from hookean.files.recipe.drawing import Item
from hookean.files.rhino.build import Additions, NewLayer, NewObject
from hookean.files.rhino.geometry import Points, build
from hookean.files.rhino.model import SEPARATOR, rhino
from hookean.files.tables import Section
from hookean.pictures.picture import ramp
from hookean.running.result import Result
from hookean.system.system import System
from hookean.values.mesh import Mesh

Floats = NDArray[np.float64]
Colours = NDArray[np.int64]

SLACK = (150, 150, 150)
REACTION_SIZE = 0.1  # the largest reaction is drawn this long, as a part of the model's size


class Palette:
    """Colours of forces as in the picture of the same result; what carries nothing is grey."""

    def __init__(self, parts: Sequence[Section]) -> None:
        every = np.concatenate([np.zeros(0), *(p.columns["force"] for p in parts if p.internal)])
        self.slack = 1e-9 * float(np.abs(every).max(initial=0.0))
        self.colours, self.low, self.high = ramp(float(every.min(initial=np.inf)), float(every.max(initial=-np.inf)))

    def __call__(self, forces: Floats) -> Colours:
        """RGB `(n, 3)` 0-255 of forces `(n,)`."""
        t = np.clip((forces - self.low) / (self.high - self.low), 0.0, 1.0)
        stops = np.array([[int(c[i : i + 2], 16) for i in (1, 3, 5)] for c in self.colours], dtype=np.float64)
        steps = np.linspace(0.0, 1.0, len(stops))
        mixed = np.stack([np.interp(t, steps, stops[:, c]) for c in range(3)], axis=1)
        mixed[np.abs(forces) <= self.slack] = SLACK
        rounded: Colours = np.rint(mixed).astype(np.int64)
        return rounded


def additions(
    system: System, result: Result, parts: Sequence[Section], built: Built | None, unit: str, factor: float
) -> tuple[Additions, list[str]]:
    """What to add below the layer `hookean`, and sentences on what Rhino could not take, such as a mesh that shrank to
    a point; `factor` is a file length in scene units, `unit` the file's in words."""
    scale = 1.0 / factor
    palette = Palette(parts)
    objects: list[NewObject] = []
    for part in parts:
        if part.internal and part.particles.shape[1] == 2 and not _of_mesh(system, part):
            objects += _lines(part, result, palette, unit, scale)
    meshes = _meshes(system, result, parts, built, palette, scale)
    objects += meshes
    objects += [item for item in _carried(result, built, scale) if not _is_drawn(item, meshes)]
    objects += _reactions(system, result, parts[-1], scale)
    objects, refused = _drawable(objects)
    used = list(dict.fromkeys(item.layer for item in objects))
    colours = {"reactions": (200, 40, 40, 255)}
    return Additions([NewLayer(name, colour=colours.get(name, (0, 0, 0, 255))) for name in used], objects), refused


def _drawable(objects: Sequence[NewObject]) -> tuple[list[NewObject], list[str]]:
    """Objects that Rhino accepts, and a sentence for each other one; lines always pass."""
    kept, refused = [], []
    for item in objects:
        if isinstance(item.geometry, np.ndarray) and len(item.geometry) == 2:
            kept.append(item)
            continue
        try:
            build(item.geometry, item.colours, f"{item.layer} {item.name}".strip())
        except InputError as error:
            refused.append(f"result on layer {error.pointer} is not written: {error.sentence}")
        else:
            kept.append(item)
    return kept, refused


def layer_name(name: str) -> str:
    """A force's name as the name of a layer: no separators, no blanks at its ends."""
    return name.replace(SEPARATOR, " ").replace("\0", "").strip() or "unnamed"


def _of_mesh(system: System, part: Section) -> bool:
    return part.number >= 0 and getattr(system.scene.forces[part.number], "mesh", None) is not None


def _source(item: Item | None) -> dict[str, str]:
    return {} if item is None else {"source": str(item.id)}


def _lines(part: Section, result: Result, palette: Palette, unit: str, scale: float) -> list[NewObject]:
    ends = result.particles[part.particles] * scale
    force = part.columns["force"]
    colours = palette(force)
    found = []
    for i in range(len(ends)):
        item = part.item(i)
        text = {"force": f"{force[i]:.6g} {result.units.force}"}
        if "strain" in part.columns:
            text["strain"] = f"{part.columns['strain'][i]:.6g}"
        text["length"] = f"{np.linalg.norm(ends[i, 1] - ends[i, 0]):.6g} {unit}"
        red, green, blue = colours[i].tolist()
        name = item.name if item is not None else ""
        found.append(
            NewObject(ends[i], layer_name(part.name), name, (red, green, blue, 255), {**text, **_source(item)})
        )
    return found


def _meshes(
    system: System, result: Result, parts: Sequence[Section], built: Built | None, palette: Palette, scale: float
) -> list[NewObject]:
    """Every mesh that a force acts on, one for each object it came from; vertices have the mean force there."""
    names: dict[str, str] = {}
    for force in system.scene.forces:
        mesh = getattr(force, "mesh", None)
        if mesh is not None and type(force).role != "load":
            names.setdefault(mesh, force.name or force.kind_name)
    total, count = np.zeros(len(system.x)), np.zeros(len(system.x))
    for part in parts:
        if part.internal:
            for column in part.particles.T:
                np.add.at(total, column, part.columns["force"])
                np.add.at(count, column, 1.0)
    mean = total / np.maximum(count, 1.0)
    colours = palette(mean)
    found = []
    for mesh, name in names.items():
        at, faces = system.places.vertices(mesh), np.asarray(system.scene.meshes[mesh].faces)
        shape = built.meshes.get(mesh) if built is not None else None
        items: tuple[Item | None, ...] = (None,) if shape is None else shape.items
        owner = np.zeros(len(at), np.int64) if shape is None else shape.owner
        for number, item in enumerate(items):
            mine = np.flatnonzero(owner == number)
            own = faces[owner[faces[:, 0]] == number] - mine[0]
            points = result.particles[at[mine]] * scale
            text = {**_ranges(system, parts, mesh, item, str(result.units.force)), **_source(item)}
            label = item.name if item is not None else mesh
            found.append(NewObject(Mesh(points, own), layer_name(name), label, None, text, colours=colours[at[mine]]))
    return found


def _ranges(system: System, parts: Sequence[Section], mesh: str, item: Item | None, unit: str) -> dict[str, str]:
    """The least and largest force and strain of the elements that a mesh has from an object, as user text."""
    found: dict[str, list[Floats]] = {"force": [], "strain": []}
    for part in parts:
        if part.internal and getattr(system.scene.forces[part.number], "mesh", None) == mesh:
            numbers = [i for i, other in enumerate(part.items) if other is item]
            mine = np.isin(part.owner, numbers) if item is not None else np.ones(len(part.owner), bool)
            for name in found:
                if name in part.columns and mine.any():
                    found[name].append(part.columns[name][mine])
    units = {"force": f" {unit}", "strain": ""}
    ends = {name: np.concatenate(values) for name, values in found.items() if values}
    return {name: f"{v.min():.6g} to {v.max():.6g}{units[name]}" for name, v in ends.items()}


def _carried(result: Result, built: Built | None, scale: float) -> list[NewObject]:
    found = []
    for i, entry in enumerate(result.geometry):
        item = built.geometry[i] if built is not None and i < len(built.geometry) else None
        text = _source(item)
        name = str(entry["name"])
        if entry["kind"] == "mesh":
            shapes: list[object] = [Mesh(entry["vertices"] * scale, np.asarray(entry["faces"]))]
        elif entry["kind"] == "lines":
            shapes = list(entry["lines"] * scale)
        elif entry["kind"] == "polyline" and len(entry["points"]) > 1:
            shapes = [entry["points"] * scale]
        elif entry["kind"] == "curve" and len(entry["points"]) > 1:
            shapes = [_curve(entry["points"] * scale, entry)]
        else:
            shapes = [Points(entry["points"] * scale)]
        found += [NewObject(shape, "geometry", name, None, text) for shape in shapes]
    return found


def _is_drawn(item: NewObject, meshes: Sequence[NewObject]) -> bool:
    """Whether a carried mesh is one that a force acts on, with the same faces at the same places."""
    mesh = item.geometry
    return isinstance(mesh, Mesh) and any(
        np.array_equal(mesh.faces, other.geometry.faces) and np.array_equal(mesh.vertices, other.geometry.vertices)
        for other in meshes
        if isinstance(other.geometry, Mesh)
    )


def _curve(points: Floats, entry: dict[str, object]) -> object:
    """A NURBS curve through control points; uniform knots clamped at the ends where none are given."""
    degree, weights, knots = int(str(entry["degree"])), entry.get("weights"), entry.get("knots")
    count = len(points)
    degree = min(degree, count - 1)
    curve = rhino.NurbsCurve(3, weights is not None, degree + 1, count)
    w = np.ones(count) if weights is None else np.broadcast_to(np.asarray(weights, dtype=np.float64), (count,))
    for i, (x, y, z) in enumerate(points.tolist()):
        curve.Points[i] = rhino.Point4d(x * w[i], y * w[i], z * w[i], w[i])
    inner = count + degree - 1
    given = [float(str(k)) for k in knots] if isinstance(knots, list | tuple) else []
    if len(given) != inner:
        given = [float(min(max(i - degree + 1, 0), count - degree)) for i in range(inner)]
    for i, knot in enumerate(given):
        curve.Knots[i] = knot
    return curve


def _reactions(system: System, result: Result, part: Section, scale: float) -> list[NewObject]:
    force = part.columns["force"]
    size = np.linalg.norm(force, axis=1)
    largest = float(size.max(initial=0.0))
    if largest <= 0.0:
        return []
    reach = REACTION_SIZE * system.size * scale / largest
    unit = result.units.force
    found = []
    for i in np.flatnonzero(size > 1e-9 * largest):
        at = result.particles[part.particles[i, 0]] * scale
        vector = ", ".join(f"{c:.6g}" for c in force[i])
        text = {"reaction": f"{size[i]:.6g} {unit}", "vector": f"{vector} {unit}", **_source(part.item(int(i)))}
        found.append(NewObject(np.stack([at, at + reach * force[i]]), "reactions", part.names[i], None, text))
    return found
