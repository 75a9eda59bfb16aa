"""Natives of flat regions: their union, difference and intersection, and cells of points in space."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import ConvexHull, KDTree, QhullError

from hookean_canvas.run.natives import shapes
from hookean_canvas.run.natives.declare import Unfit, bounded, native
from hookean_canvas.run.natives.places import _pieces
from hookean_canvas.run.natives.shapes import Array

Flags = NDArray[np.bool_]
NEAR = 1e-9  # of the size: places nearer than this are one
SIDE = 1e-4  # of an edge: how far beside its middle it is asked whether a place is within the result
_CURVED = "curved outlines become polylines, and a hole is an outline of its own"
_TWO = "Curves A (A): curve list; Curves B (B): curve list; Plane (P): plane optional"


@native("", "Region Union", "RUnion", "Curves (C): curve list; Plane (P): plane optional", "Result (R): list",
        remark=_CURVED)  # fmt: skip
def region_union(curves: list[Any], frame: Any) -> list[Any]:
    """The outlines of what is within any of some closed flat curves."""
    return _combined([curves], frame, lambda inside: inside[0])


@native("f72c480b-7ee6-42ef-9821-c371e9203b44", "Region Difference", "RDiff", _TWO, "Result (R): list", remark=_CURVED)
def region_difference(first: list[Any], second: list[Any], frame: Any) -> list[Any]:
    """The outlines of what is within curves A and in none of curves B."""
    return _combined([first, second], frame, lambda inside: inside[0] & ~inside[1])


@native("477c2e7b-c5e5-421e-b8b2-ba60cdf5398b", "Region Intersection", "RInt", _TWO, "Result (R): list", remark=_CURVED)
def region_intersection(first: list[Any], second: list[Any], frame: Any) -> list[Any]:
    """The outlines of what is within curves A and within curves B."""
    return _combined([first, second], frame, lambda inside: inside[0] & inside[1])


def _combined(groups: list[list[Any]], frame: Any, rule: Callable[[list[Flags]], Flags]) -> list[Any]:
    """The outlines of the places that a rule accepts by whether they are within each group of closed curves."""
    given = [[_pieces(curve) for curve in group if curve is not None] for group in groups]
    sides = [[rows for rows in group if np.ptp(rows, axis=0).any()] for group in given]  # a point encloses nothing
    every = [rows for group in sides for rows in group]
    if not every:
        return []
    if any(np.linalg.norm(rows[0] - rows[-1]) > 1e-6 * float(np.ptp(rows, axis=0).max()) for rows in every):
        raise Unfit("a curve is open; regions need closed ones")
    plane = frame if frame is not None else shapes.fitted_plane(np.concatenate(every))
    flat = [[shapes.coordinates(plane, rows)[:, :2] for rows in group] for group in sides]
    places, edges = _arranged([ring for group in flat for ring in group])
    starts, ways = places[edges[:, 0]], places[edges[:, 1]] - places[edges[:, 0]]
    across = SIDE * np.column_stack([-ways[:, 1], ways[:, 0]])
    left, right = (
        rule([_within(starts + 0.5 * ways + turn * across, group) for group in flat]) for turn in (1.0, -1.0)
    )
    outlines = _walked(places, np.concatenate([edges[left & ~right], edges[right & ~left][:, ::-1]]))
    return [shapes.polyline(shapes.in_plane(plane, ring), closed=True) for ring in outlines]


def _within(places: Array, rings: list[Array]) -> Flags:
    """Which places are within any of some rings."""
    from matplotlib.path import Path

    found = np.zeros(len(places), bool)
    for ring in rings:
        found |= Path(ring).contains_points(places)
    return found


def _arranged(rings: list[Array]) -> tuple[Array, NDArray[np.intp]]:
    """Places (n, 2) and edges (m, 2) of rings that are cut where they meet; edges in one place are one."""
    p, q = (np.concatenate([ring[k : len(ring) - 1 + k] for ring in rings]) for k in (0, 1))
    bounded(len(p) ** 2)
    near = NEAR * float(np.ptp(np.concatenate([p, q]), axis=0).max())
    rows: list[Array] = []
    for a, b in zip(p, q, strict=True):
        way = b - a
        length = float(np.linalg.norm(way))
        if length <= near:
            continue
        cuts = np.clip(np.concatenate([[0.0, 1.0], _meetings(a, way, p, q, near)]), 0.0, 1.0)
        rows += [a + np.array(pair)[:, None] * way for pair in pairwise(np.unique(cuts).tolist())]
    ends = np.concatenate(rows)
    pairs = KDTree(ends).query_pairs(2.0 * near, output_type="ndarray")
    links = coo_array((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(len(ends), len(ends)))
    count, which = connected_components(links, directed=False)
    first = np.full(count, len(ends))
    np.minimum.at(first, which, np.arange(len(ends)))
    edges = np.unique(np.sort(which.reshape(-1, 2), axis=1), axis=0)
    return ends[first], edges[edges[:, 0] != edges[:, 1]]


def _meetings(a: Array, way: Array, p: Array, q: Array, near: float) -> Array:
    """Parts of a way from a at which it meets pieces from p to q, or passes their ends."""
    square = float(way @ way)
    slack = near / math.sqrt(square)
    other = q - p
    cross = way[0] * other[:, 1] - way[1] * other[:, 0]
    crossing = np.abs(cross) > 1e-12 * math.sqrt(square) * np.linalg.norm(other, axis=1)
    over = np.where(crossing, cross, 1.0)
    to = p - a
    t = (to[:, 0] * other[:, 1] - to[:, 1] * other[:, 0]) / over
    s = (to[:, 0] * way[1] - to[:, 1] * way[0]) / over
    meets = crossing & (t >= -slack) & (t <= 1.0 + slack) & (s >= -1e-9) & (s <= 1.0 + 1e-9)
    ends = np.concatenate([p, q]) - a
    along = ends @ way / square
    beside = np.abs(ends[:, 0] * way[1] - ends[:, 1] * way[0]) / math.sqrt(square) <= near
    return np.concatenate([t[meets], along[beside & (along > 0.0) & (along < 1.0)]])


def _walked(places: Array, edges: NDArray[np.intp]) -> list[Array]:
    """Rings along directed edges, at each place by the sharpest turn to the left, without places on straight sides."""
    after: dict[int, list[int]] = {}
    for a, b in edges.tolist():
        after.setdefault(a, []).append(b)
    found = []
    for start in list(after):
        while after[start]:
            ring = [start, after[start].pop()]
            while ring[-1] != start:
                way = places[ring[-1]] - places[ring[-2]]
                choices = after[ring[-1]]
                turns = [_turn(way, places[b] - places[ring[-1]]) for b in choices]
                ring.append(choices.pop(int(np.argmax(turns))))
            rows = places[ring[:-1]]
            ways = rows - np.roll(rows, 1, axis=0), np.roll(rows, -1, axis=0) - rows
            bends = np.abs(ways[0][:, 0] * ways[1][:, 1] - ways[0][:, 1] * ways[1][:, 0])
            sharp = bends > 1e-9 * np.linalg.norm(ways[0], axis=1) * np.linalg.norm(ways[1], axis=1)
            found.append(rows[sharp])
    return [ring for ring in found if len(ring) > 2]


def _turn(way: Array, following: Array) -> float:
    """The angle to the left from a direction to the following one, more than -pi."""
    return math.atan2(way[0] * following[1] - way[1] * following[0], float(way @ following))


@native("ba9bb57a-61cf-4207-a1c4-994e371ba4f9", "Voronoi 3D", "Voronoi³",
        "Points (P): point list; Box (B): box optional", "Cells (C): list; Boundary (B): list",
        remark="cells are meshes; without a box they end at that of the points, widened by a tenth of its diagonal",
        )  # fmt: skip
def voronoi_in_space(places: list[Any], box: Any) -> tuple[list[Any], list[bool]]:
    """For each point the part of a box that is nearer to it than to others, and whether it reaches the box."""
    rows = shapes.rows(places)
    if not len(rows):
        return [], []
    bounded(len(rows) ** 2)
    if box is not None:
        low, high = shapes.xyz(box.Min), shapes.xyz(box.Max)
    else:
        low, high = rows.min(axis=0), rows.max(axis=0)
        low, high = low - 0.1 * math.dist(low, high), high + 0.1 * math.dist(low, high)
    if not (high > low).all():
        raise Unfit("the box has no volume")
    walls = np.concatenate([np.eye(3), -np.eye(3)]), np.concatenate([high, -low])
    cells = [_cell(rows, i, walls) for i in range(len(rows))]
    size = float((high - low).max())
    touches = [
        cell is not None and bool((np.abs(cell - low) < 1e-6 * size).any() or (np.abs(cell - high) < 1e-6 * size).any())
        for cell in cells
    ]
    return [None if cell is None else _hull(cell) for cell in cells], touches


def _cell(rows: Array, i: int, walls: tuple[Array, Array]) -> Array | None:
    """The corners of the cell of a point; None where it has none.

    The cell is the dual of a hull: a plane n . x <= d, seen from a place within, is the point n / d.
    """
    others = np.delete(rows, i, axis=0)
    ways = others - rows[i]
    ways = ways[np.any(ways != 0.0, axis=1)]
    normals = np.concatenate([walls[0], ways])
    far = np.concatenate([walls[1] - walls[0] @ rows[i], 0.5 * np.einsum("ij,ij->i", ways, ways)])
    if (far <= 0.0).any():
        return None  # outside the box, or on its side
    try:
        equations = ConvexHull(normals / far[:, None]).equations
    except QhullError:
        return None
    corners: Array = rows[i] - equations[:, :3] / equations[:, 3:]
    return corners


def _hull(corners: Array) -> Any:
    """The convex mesh of corners, its triangles turned outwards."""
    hull = ConvexHull(corners)
    cut = hull.points[hull.simplices]
    outward = np.einsum("ij,ij->i", np.cross(cut[:, 1] - cut[:, 0], cut[:, 2] - cut[:, 0]), hull.equations[:, :3])
    faces = np.where((outward > 0.0)[:, None], hull.simplices, hull.simplices[:, ::-1])
    number = np.full(len(corners), -1)
    number[hull.vertices] = np.arange(len(hull.vertices))
    return shapes.mesh(corners[hull.vertices], number[faces].tolist())
