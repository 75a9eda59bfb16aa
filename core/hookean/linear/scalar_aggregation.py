"""Ever coarser nets of a net of springs of rest length 0: which particles move together, and how smoothly.

Particles are gathered into aggregates of neighbours with strong connections; each aggregate moves as one on the coarser
net. Its motion is spread smoothly by one step of Jacobi: P = (I - 2/3 D^-1 A) T, A without its weak connections.
Source: Vanek, Mandel, Brezina, "Algebraic multigrid by smoothed aggregation", Computing 56 (1996) 179.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hookean.compiled import dispatch
from hookean.linear.aggregation import turned
from hookean.linear.laplacian import Laplacian

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]

STRONG = 0.1  # a connection is strong if it is at least this part of the strongest of both its rows
DAMPING = 2.0 / 3.0
SLOWEST = 0.8  # a coarser net has at most this part of the rows
DENSEST = 100  # products for each entry of the finer matrix; a net takes 6, one in space some 30


@dataclass(frozen=True)
class Spreading:
    """How the motions of the aggregates move the rows, P: as in a compressed sparse matrix."""

    starts: Ints
    columns: Ints
    values: Floats


def coarser(net: Laplacian) -> tuple[Spreading, Laplacian] | None:
    """The next net, and the way from it; None where the graph does not gather well."""
    rows = (net.starts, net.columns, net.values, net.diagonal)
    n, size = len(net.diagonal), len(net.columns)
    strongest, group = np.empty(n), np.empty(n, np.int32)
    count = dispatch.compiled(gather)(*rows, strongest, group)
    if count > SLOWEST * n:
        return None
    slot = np.full(count, -1, np.int32)
    p = np.zeros(n + 1, np.int32), np.empty(size, np.int32), np.empty(size)
    entries = dispatch.compiled(spread)(*rows, strongest, group, *p, slot)
    back = turned((p[0], p[1][:entries], p[2][:entries]), count)
    slot[:] = -1
    found = np.zeros(count + 1, np.int32), np.empty(size, np.int32), np.empty(size), np.empty(count, np.int32)
    size = dispatch.compiled(project)(*rows, *p, *back, *found, slot, np.empty(count))
    if size < 0:
        return None
    held = np.zeros(count, np.int8)
    held[group[net.held > 0]] = 1
    starts, columns, values, diagonal = found
    coarse = Laplacian(starts, columns[:size], values[:size], diagonal, held)
    return Spreading(p[0], p[1][:entries], p[2][:entries]), coarse


def gather(starts, columns, values, diagonal, strongest, group):  # type: ignore[no-untyped-def]
    """Number of aggregates; `group` (n,) is that of each row, `strongest` (n,) its strongest connection.

    First whole neighbourhoods of rows that have no neighbour in an aggregate yet; what is left joins the aggregate
    it is connected to best, or is one by itself.
    """
    n = group.shape[0]
    for i in range(n):
        group[i] = -1
        strongest[i] = 0.0
        for s in range(starts[i], starts[i + 1]):
            strongest[i] = max(strongest[i], -values[s])
    count = 0
    for i in range(n):
        clear = group[i] < 0
        for s in range(starts[i], starts[i + 1]):
            j = columns[s]
            if clear and group[j] >= 0 and -values[s] >= STRONG * max(strongest[i], strongest[j]):
                clear = False
        if clear:
            for s in range(starts[i], starts[i + 1]):
                j = columns[s]
                if group[j] < 0 and -values[s] >= STRONG * max(strongest[i], strongest[j]):
                    group[j] = count
            group[i] = count
            count += 1
    whole = count
    for i in range(n):
        if group[i] < 0:
            best = 0.0
            for s in range(starts[i], starts[i + 1]):
                g = group[columns[s]]
                if -values[s] > best and 0 <= g < whole:
                    best = -values[s]
                    group[i] = -2 - g
    for i in range(n):
        if group[i] == -1:
            group[i] = count
            count += 1
        elif group[i] < -1:
            group[i] = -2 - group[i]
    return count


def spread(  # type: ignore[no-untyped-def]
    starts, columns, values, diagonal, strongest, group, p_starts, p_columns, p_values, slot
):  # fmt: skip
    """Write P, and count its entries; `slot` (aggregates,) of -1 is for notes.

    The diagonal of A without its weak connections is less by as much, so that what moves as one still has no forces.
    """
    size = 0
    for i in range(group.shape[0]):
        first, alone, whole = size, True, 0.0
        for s in range(starts[i], starts[i + 1]):
            j, value = columns[s], values[s]
            weak = -value < STRONG * max(strongest[i], strongest[j])
            if j == i or weak:
                whole += value
            if not weak:
                alone = False
            if j == i or not weak:
                g = group[j]
                if slot[g] < first:
                    slot[g] = size
                    p_columns[size], p_values[size] = g, 0.0
                    size += 1
                if j != i:
                    p_values[slot[g]] += value
        for s in range(first, size):
            p_values[s] *= -DAMPING / whole if not alone else 0.0
        p_values[slot[group[i]]] += 1.0 - DAMPING if not alone else 1.0
        p_starts[i + 1] = size
    return size


def project(  # type: ignore[no-untyped-def]
    starts, columns, values, diagonal, p_starts, p_columns, p_values, r_starts, r_rows, r_values,
    c_starts, c_columns, c_values, c_diagonal, slot, total,
):  # fmt: skip
    """Write P^T A P row by row, columns sorted, and count its entries; -1 where they are too many or take too long.

    `slot` (aggregates,) of -1 and `total` (aggregates,) are for notes.
    """
    size, work = 0, 0
    for row in range(c_starts.shape[0] - 1):
        first = size
        for t in range(r_starts[row], r_starts[row + 1]):
            i, part = r_rows[t], r_values[t]
            for s in range(starts[i], starts[i + 1]):
                j, weight = columns[s], part * values[s]
                work += p_starts[j + 1] - p_starts[j]
                for u in range(p_starts[j], p_starts[j + 1]):
                    column = p_columns[u]
                    if slot[column] != row:
                        if size == c_columns.shape[0] or work > DENSEST * c_columns.shape[0]:
                            return -1
                        slot[column], total[column] = row, 0.0
                        at = size
                        while at > first and c_columns[at - 1] > column:
                            c_columns[at] = c_columns[at - 1]
                            at -= 1
                        c_columns[at] = column
                        size += 1
                    total[column] += weight * p_values[u]
        for s in range(first, size):
            c_values[s] = total[c_columns[s]]
            if c_columns[s] == row:
                c_diagonal[row] = s
        c_starts[row + 1] = size
    return size
