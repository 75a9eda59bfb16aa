"""From selected objects to points, lines and meshes in the scene's units."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from hookean.discretize.breps import mesh_faces
from hookean.discretize.curves import divide, end_points, explode, shatter
from hookean.discretize.duplicates import unique_points
from hookean.discretize.meshes import as_mesh, corners, naked_vertices, tidy_faces
from hookean.errors import InputError
from hookean.files.recipe.drawing import Item
from hookean.files.recipe.select import count
from hookean.files.rhino.model import points_in, rhino
from hookean.values.mesh import Mesh

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Split = tuple[int, int] | tuple[int, int, Literal["whole"]]
"""Pieces of a curve (the first number), or faces of a surface along u and v; whole: also where it is trimmed."""


TRIMMED = (
    "trimmed faces without a render mesh; choose whole for trimmed faces, which leaves out the cuts, or save the file "
    "shaded in Rhino"
)


@dataclass(frozen=True, eq=False)
class Shape:
    """Points `(n, 3)`, lines `(m, 2, 3)` or a mesh, and for each point or line (of a mesh: each vertex) the
    item it comes from, as a number into `items`."""

    items: tuple[Item, ...]
    array: Floats
    owner: Ints
    faces: Ints | None = None


def is_point(item: Item) -> bool:
    """Whether it is a point or a point cloud."""
    return isinstance(item.geometry, rhino.Point | rhino.PointCloud)


def is_curve(item: Item) -> bool:
    """Whether it is a curve of any kind."""
    return isinstance(item.geometry, rhino.Curve)


def is_surface(item: Item) -> bool:
    """Whether it must be meshed: a surface, Brep or extrusion."""
    return isinstance(item.geometry, rhino.Surface | rhino.Brep)


def is_mesh(item: Item) -> bool:
    """Whether it is a mesh or can be meshed; a SubD gives its control net."""
    return isinstance(item.geometry, rhino.Mesh | rhino.SubD) or is_surface(item)


def points_from(feature: str, *, divided: bool) -> tuple[Callable[[Item], bool], str]:
    """Which objects give points of a feature ("": themselves, curves only where they are divided), and in words."""
    if not feature:
        hint = "points; put ends: or vertices: in front for those of curves, naked:, corners: or vertices: for meshes"
        return (lambda item: is_point(item) or (divided and is_curve(item))), hint
    if feature in ("start", "ends", "loose"):
        return is_curve, "curves; for points of meshes and surfaces write corners:, naked: or vertices:"
    if feature == "vertices":
        return (lambda item: is_point(item) or is_curve(item) or is_mesh(item)), "points, curves, meshes or surfaces"
    if feature == "inner":
        return (lambda item: is_curve(item) or is_mesh(item)), "curves, meshes or surfaces"
    return is_mesh, "meshes or surfaces; for points of curves write ends:, vertices: or inner:"


def split_of(value: Any, pointer: str) -> Split | None:
    """A `divide` value (20, [10, 20], "10, 20", [10, 20, "whole"] or none) as a division; InputError for others."""
    if value is None:
        return None
    if isinstance(value, str):
        value = [float(p) if re.fullmatch(r"\d+(\.0*)?", p) else p for p in re.split(r"[\s,;x×]+", value.strip())]
    pair = list(value) if isinstance(value, list | tuple) else [value]
    whole = pair[-1:] == ["whole"]
    pair = pair[: len(pair) - whole]
    pair = pair * 2 if len(pair) == 1 else pair
    good = len(pair) == 2 and all(
        isinstance(n, int | float) and not isinstance(n, bool) and float(n).is_integer() and 1 <= n <= 100_000
        for n in pair
    )
    if not good:
        raise InputError(pointer, f"{value!r} given; give a whole number of pieces, or [u, v] for a surface")
    return (int(pair[0]), int(pair[1]), "whole") if whole else (int(pair[0]), int(pair[1]))


def straight(item: Item) -> bool:
    """Whether a curve is a line or a polyline, whatever its class."""
    return _segments(item) is not None


def _segments(item: Item) -> Floats | None:
    """The segments of a line or polyline in file units; None for a curve that is bent or cannot be read."""
    if "segments" not in item.made:
        if isinstance(item.geometry, rhino.LineCurve):  # most curves are, and files have many
            line = np.array([[(p.X, p.Y, p.Z) for p in (item.geometry.PointAtStart, item.geometry.PointAtEnd)]])
            if np.isfinite(line).all() and np.abs(line[0, 1] - line[0, 0]).max() > 1e-12 * np.abs(line).max():
                item.made["segments"] = line
                return line
        try:
            item.made["segments"] = explode(item.geometry)
        except InputError:
            item.made["segments"] = None
    found: Floats | None = item.made["segments"]
    return found


def lines_of(item: Item, split: Split | None, pointer: str) -> Floats:
    """Lines `(m, 2, 3)` of a curve in file units: `split` equal arcs, or the segments of a polyline."""
    try:
        if split is not None:
            return shatter(item.geometry, split[0])
        pieces = _segments(item)
        if pieces is not None:
            return pieces
        shatter(item.geometry, 1)  # says what else is wrong with it
    except InputError as error:
        raise InputError(pointer, f"{item.label}: {error.sentence}") from None
    raise InputError(pointer, f"{item.label} is curved; give divide = N to cut it into N lines")


def mesh_of(item: Item, split: Split | None, pointer: str) -> Mesh:
    """The mesh of a mesh, surface, Brep or extrusion in file units, without unused vertices."""
    if split not in item.made:
        item.made[split] = _mesh_of(item, split, pointer)
    mesh: Mesh = item.made[split]
    return mesh


def _mesh_of(item: Item, split: Split | None, pointer: str) -> Mesh:
    try:
        if isinstance(item.geometry, rhino.SubD):
            mesh = as_mesh(rhino.Mesh.CreateFromSubDControlNet(item.geometry, False))
        elif not is_surface(item):
            mesh = as_mesh(item.geometry)
        elif split is None:
            raise InputError(pointer, "is a surface; give divide = [u, v] to mesh it with u by v faces")
        else:
            mesh = mesh_faces(item.geometry, *split[:2], name=item.label, whole=len(split) > 2)
    except InputError as error:
        raise InputError(pointer, f"{item.label}: {error.sentence}") from None
    used = np.unique(mesh.faces)
    if not len(used):
        raise InputError(pointer, f"{item.label} has no faces")
    number = np.zeros(len(mesh.vertices), np.int64)
    number[used] = np.arange(len(used))
    return Mesh(mesh.vertices[used], number[mesh.faces])


def points_of(item: Item, feature: str, split: Split | None, pointer: str) -> Floats:
    """Points `(n, 3)` in file units of a point or curve; `feature` is "", start, ends, vertices or inner."""
    if is_point(item):
        cloud = item.geometry
        every = [cloud.Location] if isinstance(cloud, rhino.Point) else points_in(cloud)
        return np.array([(p.X, p.Y, p.Z) for p in every], dtype=np.float64).reshape(-1, 3)
    try:
        if feature in ("start", "ends"):
            return end_points(item.geometry)[: 1 if feature == "start" else 2]
        pieces = _segments(item)
        if split is not None:
            points = divide(item.geometry, split[0])
        elif pieces is not None:
            points = np.concatenate([pieces[:, 0], pieces[-1:, 1]])
        else:
            raise InputError(pointer, "is curved; give divide = N for the points that cut it into N pieces")
    except InputError as error:
        raise InputError(pointer, f"{item.label}: {error.sentence}") from None
    return points[1:-1] if feature == "inner" else points


def direction(item: Item) -> Floats:
    """The direction from the start of a curve to its end; zero where they meet."""
    start, end = end_points(item.geometry)
    along: Floats = (end - start) / max(float(np.linalg.norm(end - start)), 1e-300)
    return along


def short(why: str) -> str:
    """A reason why an object is left out, the same for all trimmed faces."""
    return TRIMMED if "trimmed and without a cached" in why else why


def controls_of(item: Item) -> tuple[Floats, dict[str, Any]]:
    """Control points `(n, 3)` of a curve in file units, and its degree, knots and weights."""
    curve = item.geometry.ToNurbsCurve()
    raw = np.array([(p.X, p.Y, p.Z, p.W) for p in (curve.Points[i] for i in range(len(curve.Points)))])
    knots = tuple(float(curve.Knots[i]) for i in range(len(curve.Knots)))
    return raw[:, :3] / raw[:, 3:], {"degree": int(curve.Degree), "knots": knots, "weights": raw[:, 3]}


def counted(items: Sequence[Item]) -> str:
    """How many objects of each kind."""
    kinds: dict[str, int] = {}
    for item in items:
        kinds[item.kind] = kinds.get(item.kind, 0) + 1
    return ", ".join(count(n, kind) for kind, n in kinds.items()) or "nothing"


def joined(items: Sequence[Item], meshes: Sequence[Mesh], factor: float) -> Shape:
    """Meshes side by side in the scene's units, not welded."""
    starts = np.cumsum([0, *(len(m.vertices) for m in meshes)])
    return Shape(
        tuple(items),
        np.concatenate([m.vertices for m in meshes]) * factor,
        np.repeat(np.arange(len(meshes)), [len(m.vertices) for m in meshes]),
        np.concatenate([m.faces + start for m, start in zip(meshes, starts, strict=False)]),
    )


def mesh_points(shape: Shape, feature: str, tolerance: float) -> Shape:
    """Vertices of meshes that meet: all, the naked ones, the inner ones or the corners."""
    assert shape.faces is not None
    kept, place = unique_points(shape.array, tolerance)
    mesh = Mesh(shape.array[kept], tidy_faces(place[shape.faces]))
    if feature == "naked":
        chosen = naked_vertices(mesh)
    elif feature == "corners":
        chosen = corners(mesh)
    elif feature == "inner":
        chosen = np.setdiff1d(np.arange(len(kept)), naked_vertices(mesh))
    else:
        chosen = np.arange(len(kept))
    return Shape(shape.items, mesh.vertices[chosen], shape.owner[kept][chosen])


def rim(own: Shape, others: Shape, tolerance: float) -> Shape:
    """Vertices of meshes on edges that stay naked beside all the others: those of seams between meshes do not count."""
    assert own.faces is not None and others.faces is not None
    kept, place = unique_points(np.concatenate([own.array, others.array]), tolerance)
    faces = tidy_faces(place[np.concatenate([own.faces, others.faces + len(own.array)])])
    _, first = np.unique(np.sort(faces, axis=1), axis=0, return_index=True)  # two skins on the same faces have an edge
    naked = naked_vertices(Mesh(np.concatenate([own.array, others.array])[kept], faces[first]))
    mine = np.flatnonzero(np.isin(place[: len(own.array)], naked))
    return unique(Shape(own.items, own.array[mine], own.owner[mine]), tolerance)


def loose(lines: Shape, others: Shape, tolerance: float) -> Shape:
    """The ends of lines that no other of these lines and none of the others meets."""
    ends = np.concatenate([lines.array, others.array]).reshape(-1, 3)
    kept, place = unique_points(ends, tolerance)
    alone = np.bincount(place, minlength=len(kept))[place[: 2 * len(lines.array)]] == 1
    return Shape(lines.items, ends[: len(alone)][alone], np.repeat(lines.owner, 2)[alone])


def concatenated(shapes: Sequence[Shape], rank: int) -> Shape:
    """Points (rank 2) or lines (rank 3) of several shapes in order."""
    items: list[Item] = []
    owners: list[Ints] = []
    for shape in shapes:
        owners.append(shape.owner + len(items))
        items.extend(shape.items)
    empty = np.zeros((0, 3) if rank == 2 else (0, 2, 3))
    return Shape(
        tuple(items),
        np.concatenate([empty, *(s.array for s in shapes)]),
        np.concatenate([np.zeros(0, np.int64), *owners]),
    )


def unique(shape: Shape, tolerance: float) -> Shape:
    """Points within the tolerance of an earlier one left out."""
    if not len(shape.array):
        return shape
    kept, _ = unique_points(shape.array, tolerance)
    return Shape(shape.items, shape.array[kept], shape.owner[kept])
