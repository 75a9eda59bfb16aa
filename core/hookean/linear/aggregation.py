"""Smoothed aggregation: a coarser net from the strength of the connections of a net.

Rows with strong connections form aggregates, and each aggregate is one row of the coarser net. The prolongation is
P = (I - 2/3 D^-1 A) T: T maps aggregates to rows, and one Jacobi step smooths it, with A without its weak connections.
The coarser net is the Galerkin product P^T A P. Both hierarchies use it, the one of blocks for the Laplacian of a
weighted graph.
Source: Vanek, Mandel, Brezina, "Algebraic multigrid by smoothed aggregation", Computing 56 (1996) 179.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.compiled import dispatch
from hookean.linear.laplacian import Laplacian

Ints = NDArray[np.int32]
Sparse = tuple[Ints, Ints, NDArray[Any]]
"""Starts (n + 1,), columns (k,) and values (k,) of the rows of a sparse matrix."""

DAMPING = 2.0 / 3.0
SLOWEST = 0.8  # a coarser net has at most this part of the rows
DENSEST = 100  # products for each entry of the finer net; a flat net takes 6, one in space some 30
FREE, OUT = -1, -2  # in place of an aggregate: none yet; none ever
JOINS = -3  # JOINS - g stands for g until all rows have chosen


def coarsened(
    net: Laplacian,
    threshold: float,
    moving: NDArray[np.bool_] | None = None,
    *,
    connections_only: bool = False,
    dtype: Any = float,
) -> tuple[Sparse, Laplacian] | None:
    """The prolongation P and the coarser net P^T A P; None where aggregation does not reduce the net enough.

    A connection is strong if it is at least `threshold` times the strongest one of both its rows. Rows that are not
    `moving` (n,) belong to no aggregate. With `connections_only`, D leaves out the stiffness that rows have besides
    their connections (their supports).
    """
    n, size = len(net.diagonal), len(net.columns)
    rows = (net.starts, net.columns, net.values)
    group = np.full(n, FREE, np.int32) if moving is None else np.where(moving, FREE, OUT).astype(np.int32)
    count = dispatch.compiled(aggregate)(*rows, threshold, group)
    if not 0 < count <= SLOWEST * n:
        return None
    p: Sparse = np.zeros(n + 1, np.int32), np.empty(size, np.int32), np.empty(size, dtype)
    entries = dispatch.compiled(spread)(*rows, threshold, connections_only, group, *p, np.full(count, -1, np.int32))
    p = p[0], p[1][:entries], p[2][:entries]
    product = galerkin(rows, p, transposed(p, count))
    if product is None:
        return None
    held = np.zeros(count, np.int8)
    held[group[net.held > 0]] = 1
    return p, Laplacian(*product, held)


def galerkin(rows: Sparse, p: Sparse, r: Sparse) -> tuple[Ints, Ints, NDArray[np.float64], Ints] | None:
    """The product P^T A P, with r = P^T: starts, columns, values and the places of the diagonal; None where that takes
    more than DENSEST products for each entry of A."""
    size, room, count = 0, len(rows[1]), len(r[0]) - 1
    while True:
        found = np.zeros(count + 1, np.int32), np.empty(room, np.int32), np.empty(room), np.empty(count, np.int32)
        notes = np.full(count, -1, np.int32), np.empty(count)
        size = dispatch.compiled(project)(*rows, *p, *r, *found, *notes, DENSEST * len(rows[1]))
        if size < 0:
            return None
        if size <= room:
            return found[0], found[1][:size], found[2][:size], found[3]
        room = size


def transposed(matrix: Sparse, columns: int) -> Sparse:
    """The transposed matrix of one that has so many columns; their rows are sorted."""
    _, indices, values = matrix
    found = np.zeros(columns + 1, np.int32), np.empty_like(indices), np.empty_like(values)
    dispatch.compiled(transpose)(*matrix, *found)
    return found


def transpose(starts, columns, values, t_starts, t_columns, t_values):  # type: ignore[no-untyped-def]
    """The transposed matrix; `t_starts` must be zero."""
    n, count = starts.shape[0] - 1, t_starts.shape[0] - 1
    for s in range(starts[n]):
        t_starts[columns[s]] += 1
    for j in range(count):
        t_starts[j + 1] += t_starts[j]
    for i in range(n - 1, -1, -1):
        for s in range(starts[i], starts[i + 1]):
            j = columns[s]
            t_starts[j] -= 1
            t_columns[t_starts[j]], t_values[t_starts[j]] = i, values[s]


def aggregate(starts, columns, values, threshold, group):  # type: ignore[no-untyped-def]
    """Number of aggregates; `group` (n,) of FREE and OUT becomes the aggregate of each row that was free.

    First whole neighbourhoods of rows that have no neighbour in an aggregate yet; what is left joins the aggregate
    it is connected to best, or is one by itself.
    """
    n = group.shape[0]
    strongest = np.zeros(n)
    for i in range(n):
        for s in range(starts[i], starts[i + 1]):
            if group[columns[s]] == FREE:
                strongest[i] = max(strongest[i], -values[s])
    count = 0
    for i in range(n):
        clear = group[i] == FREE
        for s in range(starts[i], starts[i + 1]):
            j = columns[s]
            if clear and group[j] >= 0 and -values[s] >= threshold * max(strongest[i], strongest[j]):
                clear = False
        if clear:
            for s in range(starts[i], starts[i + 1]):
                j = columns[s]
                if group[j] == FREE and -values[s] >= threshold * max(strongest[i], strongest[j]):
                    group[j] = count
            group[i] = count
            count += 1
    for i in range(n):
        if group[i] == FREE:
            best = 0.0
            for s in range(starts[i], starts[i + 1]):
                g = group[columns[s]]
                if -values[s] > best and g >= 0:
                    best = -values[s]
                    group[i] = JOINS - g
    for i in range(n):
        if group[i] == FREE:
            group[i] = count
            count += 1
        elif group[i] <= JOINS:
            group[i] = JOINS - group[i]
    return count


def spread(  # type: ignore[no-untyped-def]
    starts, columns, values, threshold, connections_only, group, p_starts, p_columns, p_values, slot
):  # fmt: skip
    """Write P, and count its entries; `slot` (aggregates,) of -1 is for notes.

    D is the diagonal of A plus its weak connections, which keeps the row sums: a translation causes no forces. With
    `connections_only`, D is minus the sum of the strong connections.
    """
    n, size = group.shape[0], 0
    strongest = np.zeros(n)
    for i in range(n):
        for s in range(starts[i], starts[i + 1]):
            strongest[i] = max(strongest[i], -values[s])
    for i in range(n):
        p_starts[i] = first = size
        if group[i] < 0:
            continue
        alone, whole = True, 0.0
        for s in range(starts[i], starts[i + 1]):
            j, pull = columns[s], -values[s]
            near = j != i and pull > 0.0 and pull >= threshold * max(strongest[i], strongest[j])
            if near:
                alone = False
            if near and connections_only:
                whole += pull
            elif not (near or connections_only):
                whole -= pull
            g = group[j]
            if (near or j == i) and g >= 0:
                if slot[g] < first:
                    slot[g] = size
                    p_columns[size], p_values[size] = g, 0.0
                    size += 1
                if near:
                    p_values[slot[g]] += pull
        for s in range(first, size):
            p_values[s] *= DAMPING / whole if not alone else 0.0
        p_values[slot[group[i]]] += 1.0 - DAMPING if not alone else 1.0
    p_starts[n] = size
    return size


def project(  # type: ignore[no-untyped-def]
    starts, columns, values, p_starts, p_columns, p_values, r_starts, r_rows, r_values,
    c_starts, c_columns, c_values, c_diagonal, place, total, most,
):  # fmt: skip
    """Write P^T A P row by row, columns sorted, entries that cancel included. Returns their number, even if the
    arrays are too short for them, or -1 after more than `most` products.

    `place` (aggregates,) of -1 and `total` (aggregates,) are for notes.
    """
    size, work, room = 0, 0, c_columns.shape[0]
    for row in range(c_starts.shape[0] - 1):
        first = size
        for t in range(r_starts[row], r_starts[row + 1]):
            i, part = np.uint64(r_rows[t]), np.float64(r_values[t])
            for s in range(starts[i], starts[i + np.uint64(1)]):
                j, weight = np.uint64(columns[np.uint64(s)]), part * values[np.uint64(s)]
                work += p_starts[j + np.uint64(1)] - p_starts[j]
                for u in range(p_starts[j], p_starts[j + np.uint64(1)]):
                    column = p_columns[np.uint64(u)]
                    c = np.uint64(column)  # unsigned: no index counts from the end
                    if place[c] != row:
                        place[c], total[c] = row, 0.0
                        if size < room:
                            at = size
                            while at > first and c_columns[at - 1] > column:
                                c_columns[at] = c_columns[at - 1]
                                at -= 1
                            c_columns[at] = column
                        size += 1
                    total[c] += weight * p_values[np.uint64(u)]
            if work > most:
                return -1
        for s in range(first, min(size, room)):
            c_values[s] = total[c_columns[s]]
            if c_columns[s] == row:
                c_diagonal[row] = s
        c_starts[row + 1] = size
    return size
