"""Meshes of flat regions: triangles within outlines, for planar faces of Breps that are trimmed, and for patches."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.spatial import Delaunay, KDTree

from hookean_canvas.run.natives import shapes
from hookean_canvas.run.natives.declare import Unfit
from hookean_canvas.run.natives.shapes import Array, Faces

CURVED = 64
"""Pieces of a curved edge before it is divided again."""


def filled(outline: Array, holes: list[Array], pieces: int) -> tuple[Array, Faces]:
    """Points (n, 2) and triangles within an outline (m, 2) and without holes, each a ring without its first row again.

    Edges are cut into pieces as long as the wider side of the box over `pieces`; inside, points lie on a grid of
    triangles. Every piece of an edge is a side of a triangle, unless parts of the outline are nearer than that.
    """
    size = float(np.ptp(outline, axis=0).max()) / pieces
    if size <= 0.0:
        raise Unfit("the outline has no size")
    rings = [divided(ring, size) for ring in (outline, *holes)]
    edge = np.concatenate(rings)
    inside = _grid(outline, size)
    if len(inside):
        inside = inside[_within(inside, rings)]
        inside = inside[KDTree(edge).query(inside)[0] > 0.6 * size]
    rows = np.concatenate([edge, inside])
    cut = Delaunay(rows).simplices
    middle = rows[cut].mean(axis=1)
    a, b, c = rows[cut].transpose(1, 0, 2)
    area = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
    kept = _within(middle, rings) & (np.abs(area) > 1e-9 * size**2)
    turned = np.where((area > 0.0)[:, None], cut, cut[:, ::-1])[kept]
    return rows, [tuple(row) for row in turned.tolist()]


def divided(ring: Array, size: float) -> Array:
    """A ring with its sides cut into pieces no longer than a size."""
    ways = np.roll(ring, -1, axis=0) - ring
    counts = np.maximum(np.ceil(np.linalg.norm(ways, axis=1) / size - 1e-9).astype(int), 1)
    return np.concatenate([
        start + way * (np.arange(count) / count)[:, None]
        for start, way, count in zip(ring, ways, counts.tolist(), strict=True)
    ])  # fmt: skip


def _grid(outline: Array, size: float) -> Array:
    """A grid of equilateral triangles over the box of an outline."""
    low, high = outline.min(axis=0), outline.max(axis=0)
    rise = size * np.sqrt(0.75)
    rows = np.arange(low[1] + 0.5 * rise, high[1], rise)
    return np.concatenate([
        np.column_stack([np.arange(low[0] + (0.25 + 0.5 * (k % 2)) * size, high[0], size), np.full(n, y)])
        for k, y in enumerate(rows)
        if (n := len(np.arange(low[0] + (0.25 + 0.5 * (k % 2)) * size, high[0], size)))
    ]) if len(rows) else np.zeros((0, 2))  # fmt: skip


def _within(places: Array, rings: list[Array]) -> np.ndarray[Any, np.dtype[np.bool_]]:
    """Which places are within the first ring and in none of the others."""
    from matplotlib.path import Path

    outer, *holes = (Path(np.concatenate([ring, ring[:1]])) for ring in rings)
    found = outer.contains_points(places)
    for hole in holes:
        found &= ~hole.contains_points(places)
    return np.asarray(found)


def flat_mesh(brep: Any, pieces: int) -> Any:
    """The faces of a Brep as one mesh, all of which are flat; Unfit for curved ones that are trimmed."""
    vertices: list[Array] = []
    faces: Faces = []
    for k in range(len(brep.Faces)):
        face = brep.Faces[k]
        rings = [_ring(brep, face.Loops[i]) for i in range(len(face.Loops))]
        if not rings:
            raise Unfit("a face has no edges")
        frame = shapes.fitted_plane(np.concatenate(rings))
        if float(np.abs(shapes.coordinates(frame, np.concatenate(rings))[:, 2]).max()) > 1e-3 or not face.IsPlanar():
            raise Unfit("a curved face is trimmed; internalise its mesh in Grasshopper")
        if _turned(face, frame):
            frame = shapes.plane(shapes.xyz(frame.Origin), shapes.xyz(frame.XAxis), -shapes.xyz(frame.YAxis))
        local = [shapes.coordinates(frame, ring)[:, :2] for ring in rings]
        local.sort(key=lambda ring: -float(np.ptp(ring, axis=0).prod()))
        rows, triangles = filled(local[0], local[1:], pieces)
        first = len(vertices)
        vertices += list(shapes.in_plane(frame, rows))
        faces += [tuple(first + i for i in triangle) for triangle in triangles]
    return shapes.mesh(np.array(vertices), faces)


def _turned(face: Any, frame: Any) -> bool:
    middle = [0.5 * (face.Domain(k).T0 + face.Domain(k).T1) for k in (0, 1)]
    normal = shapes.xyz(face.NormalAt(*middle)) * (-1.0 if face.OrientationIsReversed else 1.0)
    return float(normal @ shapes.xyz(frame.ZAxis)) < 0.0


def _ring(brep: Any, loop: Any) -> Array:
    """The corners of a loop of edges in their order, without the first again."""
    chains = []
    for i in range(loop.TrimCount):
        edge = brep.Edges[loop.Trims[i].EdgeIndex].ToNurbsCurve()
        rows = shapes.corners(edge)
        if rows is None:
            first, last = edge.Domain.T0, edge.Domain.T1
            rows = shapes.rows(edge.PointAt(t) for t in np.linspace(first, last, CURVED + 1).tolist())
        chains.append(rows)
    found = chains.pop(0)
    if chains and min(np.linalg.norm(found[0] - one[k]) for one in chains for k in (0, -1)) < min(
        np.linalg.norm(found[-1] - one[k]) for one in chains for k in (0, -1)
    ):
        found = found[::-1]
    while chains:
        gaps = [(float(np.linalg.norm(found[-1] - one[k])), i, k) for i, one in enumerate(chains) for k in (0, -1)]
        _, i, k = min(gaps)
        found = np.concatenate([found, chains.pop(i)[:: 1 if k == 0 else -1][1:]])
    closed = np.linalg.norm(found[0] - found[-1]) <= 1e-6 * float(np.ptp(found, axis=0).max())
    return found[:-1] if closed else found
