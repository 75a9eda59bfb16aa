"""The graph of a net, with a weight for each connection, and the coarser one that it is gathered into.

Particles are gathered into aggregates of neighbours with strong connections; each aggregate moves as one on the
coarser net. Its motion is spread smoothly by one step of Jacobi: P = (I - 2/3 D^-1 L) T, with L the Laplacian of the
strong connections.
Source: Vanek, Mandel, Brezina, "Algebraic multigrid by smoothed aggregation", Computing 56 (1996) 179.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.compiled import dispatch
from hookean.compiled.marks import device

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]
Sparse = tuple[Ints, Ints, Any]
"""Starts (n + 1,), columns (k,) and values (k,) of the rows of a sparse matrix."""

STRONG = 0.35  # a connection is strong if it is at least this part of the strongest of its particle;
WEAKER = 0.5  # on coarser levels, times this for each
DAMPING = 2.0 / 3.0


def laplacian(starts: Ints, columns: Ints, low: Sparse, weights: Floats) -> Sparse:
    """The Laplacian of a graph, whole, of connections (k,) in the pattern of `Blocks`; its diagonal has weight 0. `low`
    is what of the pattern is below the diagonal, and of which connection each is the mirror image."""
    size = len(columns) + len(low[1])
    whole = np.empty(len(starts), np.int32), np.empty(size, np.int32), np.empty(size)
    dispatch.compiled(unfold)(starts, columns, *low, weights, *whole)
    return whole


def unfold(starts, columns, low_starts, low_columns, low, weights, all_starts, all_columns, values):  # type: ignore[no-untyped-def]
    """Write the rows of the Laplacian: what is before the diagonal; the diagonal, which is first in a row of the
    pattern; what is after it."""
    end = 0
    for i in range(starts.shape[0] - 1):
        all_starts[i] = end
        total = 0.0
        for s in range(low_starts[i], low_starts[i + 1]):
            all_columns[end], values[end] = low_columns[s], -weights[low[s]]
            total += weights[low[s]]
            end += 1
        own = end
        for s in range(starts[i], starts[i + 1]):
            all_columns[end], values[end] = columns[s], -weights[s]
            total += weights[s]
            end += 1
        values[own] = total
    all_starts[starts.shape[0] - 1] = end


def gathered(graph: Sparse, alive: NDArray[np.bool_], level: int) -> tuple[Sparse, Sparse] | None:
    """P, and P^T L P; None where the graph gathers badly. `alive` (n,) are the rows that move."""
    starts, columns, values = graph
    n = len(starts) - 1
    group = np.zeros(n, np.int32)
    least = STRONG * WEAKER**level
    count = dispatch.compiled(aggregate)(starts, columns, -values, least, alive, group)
    if not 0 < count < 0.8 * n:
        return None
    p = np.zeros(n + 1, np.int32), np.zeros(len(columns), np.int32), np.zeros(len(columns), np.float32)
    size = dispatch.compiled(spread)(*graph, group, least, DAMPING, *p)
    p = p[0], p[1][:size].copy(), p[2][:size].copy()
    r = turned(p, count)
    notes = np.zeros(count, np.int32), np.zeros(count)
    size = len(columns)  # a guess
    while True:
        c = np.zeros(count + 1, np.int32), np.zeros(size, np.int32), np.zeros(size)
        size = dispatch.compiled(couple)(*graph, *p, *r, *notes, *c)
        if size <= len(c[1]):
            return p, (c[0], c[1][:size].copy(), c[2][:size].copy())


def turned(matrix: Sparse, columns: int) -> Sparse:
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


def aggregate(starts, columns, weights, strong, alive, group):  # type: ignore[no-untyped-def]
    """Number of aggregates; `group` (n,) tells the aggregate of each row, -1 for those that are not alive.

    First whole neighbourhoods of rows that have no neighbour in an aggregate yet; what is left joins the aggregate
    it is connected to best, or makes one with what is left around it.
    """
    n = starts.shape[0] - 1
    largest = np.zeros(n)
    for i in range(n):
        group[i] = -1
        for s in range(starts[i], starts[i + 1]):
            if columns[s] != i and alive[columns[s]]:
                largest[i] = max(largest[i], weights[s])
    count = 0
    for i in range(n):
        if not alive[i] or group[i] >= 0:
            continue
        clear = True
        for s in range(starts[i], starts[i + 1]):
            j = columns[s]
            if j != i and alive[j] and group[j] >= 0 and weights[s] >= strong * max(largest[i], largest[j]):
                clear = False
                break
        if not clear:
            continue
        for s in range(starts[i], starts[i + 1]):
            j = columns[s]
            if j == i or (alive[j] and group[j] < 0 and weights[s] >= strong * max(largest[i], largest[j])):
                group[j] = count
        count += 1
    whole = count
    for i in range(n):
        if not alive[i] or group[i] >= 0:
            continue
        best = 0.0
        chosen = -1
        for s in range(starts[i], starts[i + 1]):
            j = columns[s]
            if j != i and 0 <= group[j] < whole and weights[s] > best:
                best = weights[s]
                chosen = group[j]
        if chosen >= 0:
            group[i] = -2 - chosen
    for i in range(n):
        if group[i] < -1:
            group[i] = -2 - group[i]
    for i in range(n):
        if not alive[i] or group[i] >= 0:
            continue
        for s in range(starts[i], starts[i + 1]):
            j = columns[s]
            if j == i or (alive[j] and group[j] < 0):
                group[j] = count
        count += 1
    return count


def spread(starts, columns, values, group, least, damping, p_starts, p_columns, p_values):  # type: ignore[no-untyped-def]
    """The rows of P, their columns sorted; how many entries there are."""
    n = starts.shape[0] - 1
    largest = np.zeros(n)
    for i in range(n):
        for s in range(starts[i], starts[i + 1]):
            if columns[s] != i:
                largest[i] = max(largest[i], -values[s])
    end = 0
    for i in range(n):
        p_starts[i] = end
        if group[i] < 0:
            continue
        total = 0.0
        first = end
        for s in range(starts[i], starts[i + 1]):
            j = columns[s]
            pull = -values[s]
            if j == i or not pull > 0.0 or pull < least * max(largest[i], largest[j]):
                continue
            total += pull
            if group[j] >= 0:
                end = insert(p_columns, p_values, first, end, group[j], pull)
        for t in range(first, end):
            p_values[t] *= damping / total
        end = insert(p_columns, p_values, first, end, group[i], 1.0 - damping if total > 0.0 else 1.0)
    p_starts[n] = end
    return end


@device
def insert(columns: Any, values: Any, first: Any, end: Any, column: Any, value: Any) -> Any:
    """Add a value to a sorted row, from `first` to `end`; the new end."""
    t = end
    while t > first and columns[t - 1] > column:
        t -= 1
    if t > first and columns[t - 1] == column:
        values[t - 1] += value
        return end
    for u in range(end, t, -1):
        columns[u], values[u] = columns[u - 1], values[u - 1]
    columns[t], values[t] = column, value
    return end + 1


def couple(  # type: ignore[no-untyped-def]
    starts, columns, values, p_starts, p_columns, p_values, r_starts, r_rows, r_values, place, total,
    c_starts, c_columns, c_values,
):  # fmt: skip
    """The rows of P^T L P, whatever cancels in the sums, their columns sorted; how many entries there are, for which
    there may be too little room. `place` and `total` (coarse rows,) are for notes."""
    end, room = 0, c_columns.shape[0]
    place[:] = -1
    for row in range(c_starts.shape[0] - 1):
        c_starts[row] = first = end
        for t in range(r_starts[row], r_starts[row + 1]):
            i = np.uint64(r_rows[t])
            for s in range(starts[i], starts[i + np.uint64(1)]):
                j = np.uint64(columns[np.uint64(s)])
                part = np.float64(r_values[t]) * values[np.uint64(s)]
                for u in range(p_starts[j], p_starts[j + np.uint64(1)]):
                    column = np.uint64(p_columns[np.uint64(u)])
                    if place[column] != row:
                        place[column] = row
                        total[column] = 0.0
                        if end < room:
                            c_columns[end] = column
                        end += 1
                    total[column] += part * p_values[np.uint64(u)]
        if end <= room:
            for s in range(first, end):
                column, t = c_columns[s], s
                while t > first and c_columns[t - 1] > column:
                    c_columns[t] = c_columns[t - 1]
                    t -= 1
                c_columns[t] = column
            for s in range(first, end):
                c_values[s] = total[c_columns[s]]
    c_starts[c_starts.shape[0] - 1] = end
    return end
