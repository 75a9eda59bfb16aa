"""Reciprocal diagrams: the forces of a flat net in equilibrium, or of a net in plan, drawn as a figure."""

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
LEFT = 1e-6  # part of the largest force that may be out of balance


def reciprocal_diagram(
    mesh: Any, pairs: Any = None, densities: Any = None, direction: Any = None
) -> tuple[Array, Array]:
    """Lines `(k, 2, 3)` of the reciprocal figure of a flat mesh, one for each inner edge, and force densities `(k,)`.

    The edges of the mesh carry forces that balance at each inner vertex. Of all such states of stress the one is taken
    whose force densities q (force by length, of the boundary's edges too) are nearest to 1, by least squares; or those
    of a net that has been found, `densities` [force/length] of its springs between the vertices `pairs`, and none in
    other edges. Each face becomes a point of the figure, and each inner edge a line from the face on its right to that
    on its left, seen from where faces run round to the left: q times as long as the edge, and at a right angle to it.
    So the lines of an inner vertex close to a polygon, that of its forces. The figure lies in the plane of the mesh
    about the mean of its vertices. Lines follow the order of `edges`, without the boundary.
    With a `direction`, that of all loads, the mesh need not be flat: the figure is that of its plan, seen along the
    direction, and the length of each line is the thrust of its edge across the loads, such as the horizontal thrust
    [force].
    Raises InputError for a mesh that is not flat or in several pieces, an edge with more than two faces, a net that no
    forces keep in equilibrium, and densities that leave vertices out of balance. Source: Maxwell, "On reciprocal
    figures and diagrams of forces", 1864; in plan: Block, Ochsendorf, "Thrust network analysis", 2007.
    """
    m = as_mesh(mesh)
    every = edges(m)
    left, right = sides_of_edges(m)
    x, frame, middle = _in_plane(m, direction)
    inner = right[:, 0] >= 0
    along = x[every[:, 1]] - x[every[:, 0]]
    balance = _balance(every, along, np.setdiff1d(np.unique(m.faces), np.unique(every[~inner])))
    density = _nearest(balance, along) if pairs is None else _given(balance, along, every, pairs, densities)
    # to the left of the side of its first face
    start = m.faces[left[:, 0], left[:, 1]]
    sign = np.where(start == every[:, 0], 1.0, -1.0)
    step = (sign * density)[:, None] * np.column_stack([-along[:, 1], along[:, 0]])
    points = _integrated(len(m.faces), left[inner, 0], right[inner, 0], step[inner])
    points -= points.mean(axis=0)
    whole = middle + points @ frame
    along_it = sign[inner] > 0.0
    to, start_at = (np.where(along_it, one[inner, 0], two[inner, 0]) for one, two in ((left, right), (right, left)))
    return np.stack([whole[start_at], whole[to]], axis=1), density[inner]


def _in_plane(m: Mesh, direction: Any) -> tuple[Array, Array, Array]:
    """Vertices (n, 2) in the plane of the mesh, or across a direction, its two directions (2, 3), so that faces run
    round to the left, and the mean."""
    used = np.unique(m.faces)
    if not len(used):
        raise InputError("mesh", "it has no faces; give a mesh with faces")
    middle, shape = m.vertices[used].mean(axis=0), m.vertices[used]
    if direction is not None:
        along = np.asarray(direction, dtype=np.float64)
        if along.shape != (3,) or not np.isfinite(along).all() or not along.any():
            raise InputError("direction", f"it is {direction}; give three numbers that are not all 0")
        shape = shape - np.outer((shape - middle) @ along, along) / (along @ along)
    _, sizes, frame = np.linalg.svd(shape - middle, full_matrices=False)
    if len(sizes) < 3 or sizes[2] > FLAT * sizes[0] or sizes[1] <= FLAT * sizes[0]:
        raise InputError("mesh", "it is not flat, or a line; give a mesh in a plane")
    a, b, c, d = ((m.vertices[m.faces[:, i]] - middle) @ frame[:2].T for i in range(4))
    ca, db = c - a, d - b
    if (ca[:, 0] * db[:, 1] - ca[:, 1] * db[:, 0]).sum() < 0.0:
        frame = frame * [[1.0], [-1.0], [1.0]]
    return (m.vertices - middle) @ frame[:2].T, frame[:2], middle


def _balance(pairs: Index, along: Array, inner: Index) -> Any:
    """The sums (2 v, m) of forces at inner vertices by force densities."""
    import scipy.sparse as sparse

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
    return sparse.csr_matrix((np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))), shape)


def _nearest(balance: Any, along: Array) -> Array:
    """Force densities (m,) nearest to 1 that balance at inner vertices."""
    from scipy.sparse.linalg import lsqr

    ones = np.ones(len(along))
    if not balance.shape[0]:
        return ones
    size = float(np.abs(along).max())
    change = lsqr(balance, -(balance @ ones), atol=1e-15, btol=1e-15, iter_lim=100 * len(along) + 1000)[0]
    density = ones + change
    if np.abs(balance @ density).max() > LEFT * size * np.abs(density).max() or np.abs(density).max() < NOTHING:
        raise InputError("mesh", "no forces along its edges balance at its inner vertices; add edges, or move vertices")
    return np.asarray(density)


def _given(balance: Any, along: Array, every: Index, pairs: Any, densities: Any) -> Array:
    """Force densities (m,) of all edges from those of springs along some of them."""
    own, given = np.sort(np.asarray(pairs, dtype=np.int64).reshape(-1, 2), axis=1), np.ravel(densities)
    if densities is None or len(given) not in (1, len(own)) or not np.isfinite(np.asarray(given, float)).all():
        raise InputError("densities", f"give {len(own)} numbers, one for each pair, or one for all")
    size = int(every.max()) + 1
    numbers = np.sort(every, axis=1) @ [size, 1]
    order = np.argsort(numbers)
    wanted = np.where((own >= 0).all(axis=1) & (own < size).all(axis=1), own @ [size, 1], -1)
    at = order[np.minimum(np.searchsorted(numbers, wanted, sorter=order), len(order) - 1)]
    if (stray := np.flatnonzero(numbers[at] != wanted)).size:
        raise InputError(f"pairs/{stray[0]}", f"{own[stray[0]].tolist()} is no edge of the mesh; give vertices of one")
    density = np.bincount(at, np.broadcast_to(given, len(own)), len(every))
    out = np.abs(balance @ density)
    if out.max(initial=0.0) > LEFT * float(np.abs(along).max()) * np.abs(density).max():
        said = f"the forces at a vertex leave {out.max():.3g} across the loads; give those of a shape in equilibrium"
        raise InputError("densities", said)
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
    if gap > LEFT * max(float(np.abs(step).max(initial=0.0)), 1e-300):
        raise InputError("mesh", "its forces do not close round a hole; close the hole by a face")
    return points
