"""Pipes about lines that meet in nodes, as one closed mesh."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hookean.discretize.duplicates import _checked, unique_lines, unique_points
from hookean.errors import InputError
from hookean.values.mesh import Mesh

Array = NDArray[np.float64]
Index = NDArray[np.int64]

MARGIN = 1.05  # how much farther from its node a ring is than where it would touch the next one
FINEST, FARTHEST = 2e-14, 1e70  # radius as a part of coordinates, of which rounding is a hundredth; coordinate
SHORTEST = 0.25  # of the radius: distance of a ring from a node with lines that go straight on


def pipes(lines: ArrayLike, radius: float, sides: int = 6, tolerance: float = 1e-6) -> Mesh:
    """One closed mesh of pipes about lines `(m, 2, 3)`: prisms with `sides` sides, joined by a hull at each node.

    `radius` [length] is that of the circle about the corners of a prism. Ends that are nearer than `tolerance` [length]
    are one node. Where lines meet, the prisms end in rings on a sphere about the node, at the distance
    r / tan(a / 2), a the smallest angle between two of its lines; triangles of the convex hull of the rings close it.
    A free end is closed by a flat cap. Faces are oriented outwards. Smooth it by `refine(mesh, smooth=True)`.
    Raises InputError for a line that is too short between its nodes, two lines in the same place, fewer than 3 sides,
    and coordinates that are too large for float64 beside the radius.
    Source: Srinivasan, Mandal and Akleman, "Solidifying wireframes", 2005.
    """
    if not (np.isfinite(radius) and radius > 0.0):
        raise InputError("radius", f"it is {radius!r}; give a length above 0")
    if not 3 <= sides <= 1000:
        raise InputError("sides", f"it is {sides!r}; give a whole number from 3 to 1000")
    ends = _checked("lines", lines, (2, 3))
    if (far := float(np.abs(ends).max(initial=0.0))) > radius / FINEST or far > FARTHEST:
        said = f"coordinates up to {far:.4g} are too large for float64 beside a radius of {radius:g}"
        raise InputError("lines", f"{said}; move them to the origin, or use other units")
    if len(unique_lines(ends, tolerance)[0]) < len(ends):
        kept = set(unique_lines(ends, tolerance)[0].tolist())
        twice = next(i for i in range(len(ends)) if i not in kept)
        raise InputError(f"lines/{twice}", "it is the same as one before; give each line once")
    kept_points, place = unique_points(ends.reshape(-1, 3), tolerance)
    nodes, pairs = ends.reshape(-1, 3)[kept_points], place.reshape(-1, 2)
    along = nodes[pairs[:, 1]] - nodes[pairs[:, 0]]
    length = np.linalg.norm(along, axis=1)
    if (short := np.flatnonzero(~(length > 0.0))).size:
        raise InputError(f"lines/{short[0]}", "it starts and ends at one node; give a line with a length")
    along /= length[:, None]
    off = _offsets(pairs, along, radius, len(nodes))
    left = length - off[pairs].sum(axis=1)
    if (bad := np.flatnonzero(~(left > 0.0))).size:
        need = float(off[pairs[bad[0]]].sum())
        said = f"its length is {length[bad[0]]:.4g}, and its nodes take {need:.4g} of it"
        raise InputError(f"lines/{bad[0]}", f"{said}: use a smaller radius, or lines with larger angles")
    return _meshed(nodes, pairs, along, off, radius, sides)


def expected_faces(lines: ArrayLike, radius: float, sides: int = 6, tolerance: float = 1e-6) -> int:
    """At most how many faces `pipes` makes."""
    return 5 * max(int(sides), 0) * len(_checked("lines", lines, (2, 3)))


def _offsets(pairs: Index, along: Array, radius: float, count: int) -> Array:
    """Distance (count,) [length] from each node of the rings about it; 0 at free ends."""
    off = np.zeros(count)
    for node, (out, _) in _arms(pairs, along).items():
        if len(out) == 1:
            continue
        cosine = out @ out.T
        np.fill_diagonal(cosine, -1.0)
        worst = float(cosine.max())
        if worst >= 1.0 - 1e-12:
            line = int(np.flatnonzero((pairs == node).any(axis=1))[0])
            raise InputError(f"lines/{line}", "another line leaves its end in the same direction; join or turn one")
        # tan(a / 2) = sqrt((1 - cos a) / (1 + cos a))
        off[node] = radius * max(MARGIN * np.sqrt((1.0 + worst) / (1.0 - worst)), SHORTEST)
    return off


def _arms(pairs: Index, along: Array) -> dict[int, tuple[Array, list[tuple[int, int]]]]:
    """Of each node the directions (k, 3) of its lines away from it, and their numbers with which end it is."""
    found: dict[int, list[tuple[int, int]]] = {}
    for line, pair in enumerate(pairs.tolist()):
        for end in (0, 1):
            found.setdefault(pair[end], []).append((line, end))
    signs = (1.0, -1.0)
    return {
        node: (np.array([signs[end] * along[line] for line, end in arms]), arms) for node, arms in sorted(found.items())
    }


def _meshed(nodes: Array, pairs: Index, along: Array, off: Array, radius: float, sides: int) -> Mesh:
    """The prisms, the hulls about nodes, and the caps of free ends."""
    ring = _rings(nodes, pairs, along, off, radius, sides)  # (lines, 2, sides, 3)
    number = np.arange(ring[..., 0].size).reshape(ring.shape[:3])
    onward = np.roll(number, -1, axis=2)
    prisms = np.stack([number[:, 0], onward[:, 0], onward[:, 1], number[:, 1]], axis=-1).reshape(-1, 4)
    faces = [prisms]
    for _, (out, arms) in _arms(pairs, along).items():
        own = np.array([number[line, end] for line, end in arms])
        if len(out) == 1:
            (line, end) = arms[0]
            loop = number[line, end] if end else number[line, end][::-1]
            fan = np.column_stack([np.full(sides - 2, loop[0]), loop[1:-1], loop[2:]])
            faces.append(np.column_stack([fan, fan[:, 2]]))
        else:
            hull = _hull(ring.reshape(-1, 3)[own.ravel()], len(own), sides)
            faces.append(np.column_stack([own.ravel()[hull], own.ravel()[hull[:, 2]]]))
    return Mesh(ring.reshape(-1, 3), np.concatenate(faces))


def _rings(nodes: Array, pairs: Index, along: Array, off: Array, radius: float, sides: int) -> Array:
    """Corners (lines, 2, sides, 3) of the rings at both ends, counter-clockwise about the direction of the line."""
    least = np.eye(3)[np.argmin(np.abs(along), axis=1)]
    first = np.cross(along, least)
    first /= np.linalg.norm(first, axis=1)[:, None]
    second = np.cross(along, first)
    turn = 2.0 * np.pi * np.arange(sides) / sides
    round_it = radius * (np.cos(turn)[:, None] * first[:, None] + np.sin(turn)[:, None] * second[:, None])
    sign = np.array([1.0, -1.0])
    centre = nodes[pairs] + (sign * off[pairs])[..., None] * along[:, None]
    out: Array = centre[:, :, None] + round_it[:, None]
    return out


def _hull(points: Array, rings: int, sides: int) -> Index:
    """Triangles (k, 3) of the convex hull of rings of points, oriented outwards, without those in a ring."""
    from scipy.spatial import ConvexHull

    hull: Any = ConvexHull(points - points.mean(axis=0), qhull_options="Qt")
    found = hull.simplices.astype(np.int64)
    middle = hull.points[hull.vertices].mean(axis=0)
    a, b, c = (hull.points[found[:, i]] for i in range(3))
    inward = (np.cross(b - a, c - a) * (a - middle)).sum(axis=1) < 0.0
    found[inward] = found[inward][:, ::-1]
    which = found // sides
    between = (which != which[:, :1]).any(axis=1)
    out: Index = found[between]
    order = np.lexsort(np.sort(out, axis=1).T[::-1])
    return np.asarray(out[order])
