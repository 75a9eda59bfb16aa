"""Reciprocal diagrams: the forces of a flat net in equilibrium, drawn as a figure."""

from __future__ import annotations

from collections import deque
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.discretize.adjacency import sides_of_edges
from hookean.discretize.meshes import as_mesh, edges
from hookean.errors import InputError
from hookean.values.mesh import Mesh

Array = NDArray[np.float64]
Index = NDArray[np.int64]

FLAT = 1e-6  # part of its size that a mesh may be out of its plane
NOTHING = 1e-9  # part of the force densities that is rounding


def reciprocal_diagram(mesh: Any) -> tuple[Array, Array]:
    """Lines `(k, 2, 3)` of the reciprocal figure of a flat mesh, one for each inner edge, and force densities `(k,)`.

    The edges of the mesh carry forces that balance at each inner vertex. Of all such states of stress the one is taken
    whose force densities q (force by length, of the boundary's edges too) are nearest to 1, by least squares. Each face
    becomes a point of the figure, and each inner edge a line from the face on its right to that on its left, seen from
    where faces run round to the left: q times as long as the edge, and at a right angle to it. So the lines of an inner
    vertex close to a polygon, that of its forces. The figure lies in the plane of the mesh about the mean of its
    vertices. Lines follow the order of `edges`, without the boundary.
    Raises InputError for a mesh that is not flat or in several pieces, an edge with more than two faces, and a net that
    no forces keep in equilibrium. Source: Maxwell, "On reciprocal figures and diagrams of forces", 1864.
    """
    m = as_mesh(mesh)
    pairs = edges(m)
    left, right = sides_of_edges(m)
    x, frame, middle = _in_plane(m)
    inner = right[:, 0] >= 0
    boundary = np.unique(pairs[~inner])
    along = x[pairs[:, 1]] - x[pairs[:, 0]]
    density = _densities(pairs, along, np.setdiff1d(np.unique(m.faces), boundary))
    # to the left of the side of its first face
    start = m.faces[left[:, 0], left[:, 1]]
    sign = np.where(start == pairs[:, 0], 1.0, -1.0)
    step = (sign * density)[:, None] * np.column_stack([-along[:, 1], along[:, 0]])
    points = _integrated(len(m.faces), left[inner, 0], right[inner, 0], step[inner])
    points -= points.mean(axis=0)
    whole = middle + points @ frame
    along_it = sign[inner] > 0.0
    to, start_at = (np.where(along_it, one[inner, 0], two[inner, 0]) for one, two in ((left, right), (right, left)))
    return np.stack([whole[start_at], whole[to]], axis=1), density[inner]


def _in_plane(m: Mesh) -> tuple[Array, Array, Array]:
    """Vertices (n, 2) in the plane of the mesh, its two directions (2, 3), so that faces run round to the left, and the
    mean."""
    used = np.unique(m.faces)
    if not len(used):
        raise InputError("mesh", "it has no faces; give a mesh with faces")
    middle = m.vertices[used].mean(axis=0)
    _, sizes, frame = np.linalg.svd(m.vertices[used] - middle, full_matrices=False)
    if len(sizes) < 3 or sizes[2] > FLAT * sizes[0] or sizes[1] <= FLAT * sizes[0]:
        raise InputError("mesh", "it is not flat, or a line; give a mesh in a plane")
    a, b, c, d = ((m.vertices[m.faces[:, i]] - middle) @ frame[:2].T for i in range(4))
    ca, db = c - a, d - b
    if (ca[:, 0] * db[:, 1] - ca[:, 1] * db[:, 0]).sum() < 0.0:
        frame = frame * [[1.0], [-1.0], [1.0]]
    return (m.vertices - middle) @ frame[:2].T, frame[:2], middle


def _densities(pairs: Index, along: Array, inner: Index) -> Array:
    """Force densities (m,) nearest to 1 that balance at inner vertices."""
    import scipy.sparse as sparse
    from scipy.sparse.linalg import lsqr

    ones = np.ones(len(pairs))
    if not len(inner):
        return ones
    place = np.full(int(pairs.max()) + 1, -1)
    place[inner] = np.arange(len(inner))
    rows, columns, values = [], [], []
    for end, sign in ((0, 1.0), (1, -1.0)):
        at = place[pairs[:, end]]
        for axis in (0, 1):
            rows.append(2 * at[at >= 0] + axis)
            columns.append(np.flatnonzero(at >= 0))
            values.append(sign * along[at >= 0, axis])
    shape = (2 * len(inner), len(pairs))
    balance: Any = sparse.csr_matrix((np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))), shape)
    size = float(np.abs(along).max())
    change = lsqr(balance, -(balance @ ones), atol=1e-15, btol=1e-15, iter_lim=100 * len(pairs) + 1000)[0]
    density = ones + change
    if np.abs(balance @ density).max() > 1e-6 * size * np.abs(density).max() or np.abs(density).max() < NOTHING:
        raise InputError("mesh", "no forces along its edges balance at its inner vertices; add edges, or move vertices")
    return np.asarray(density)


def _integrated(count: int, first: Index, second: Index, step: Array) -> Array:
    """Points (count, 2) of faces, each `step` from that of its second face to that of its first."""
    beside: list[list[tuple[int, Array]]] = [[] for _ in range(count)]
    for a, b, by in zip(first.tolist(), second.tolist(), step, strict=True):
        beside[b].append((a, by))
        beside[a].append((b, -by))
    points, seen, queue = np.zeros((count, 2)), {0}, deque([0])
    while queue:
        face = queue.popleft()
        for other, by in beside[face]:
            if other not in seen:
                seen.add(other)
                points[other] = points[face] + by
                queue.append(other)
    if len(seen) < count:
        raise InputError("mesh", "it is in several pieces; give one at a time")
    gap = np.abs(points[second] + step - points[first]).max(initial=0.0)
    if gap > 1e-6 * max(float(np.abs(step).max(initial=0.0)), 1e-300):
        raise InputError("mesh", "its forces do not close round a hole; close the hole by a face")
    return points
