"""Front: the Cholesky factor of a net's Laplacian, its particles in the order in which a front meets them.

While the front is at a particle, its column reaches to the farthest particle met so far. Four columns at a time are
taken off all columns that they reach. Source: Jennings, "A compact storage scheme for the solution of symmetric linear
simultaneous equations", 1966.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hookean import kernels
from hookean.kernels import device
from hookean.solvers._laplacian import Laplacian

Floats = NDArray[np.float64]

TOGETHER = 4  # columns


def solve(net: Laplacian, b: Floats) -> bool:
    """Replace `b` (count, 4), in the net's order, by the solution; False where rounding leaves no positive pivot."""
    reach = net.last.copy()
    starts = np.empty(len(reach), np.int64)
    size = kernels.compiled(reserve)(reach, starts)
    values = np.zeros(size)
    pattern = (net.starts, net.columns, net.values, net.stiffness, net.order, net.place)
    return bool(kernels.compiled(eliminate)(*pattern, reach, starts, values, b))


def reserve(reach, starts):  # type: ignore[no-untyped-def]
    """Make the columns that are taken together reach equally far; `starts` where each would have its row 0."""
    n = reach.shape[0]
    size = 0
    for g in range(0, n, TOGETHER):
        after = min(g + TOGETHER, n)
        for k in range(g, after):
            reach[k] = reach[after - 1]
            starts[k] = size - k
            size += reach[k] - k + 1
    return size


def eliminate(starts, columns, values, stiffness, order, place, reach, where, lower, b):  # type: ignore[no-untyped-def]
    """Factor and solve."""
    for k in range(order.shape[0]):
        i = order[k]
        lower[where[k] + k] = stiffness[i]
        for s in range(starts[i], starts[i + 1]):
            j = place[columns[s]]
            if j > k:
                lower[where[k] + j] -= values[s]
    return factor(reach, where, lower) and substitute(reach, where, lower, b)


@device
def factor(reach, where, lower):  # type: ignore[no-untyped-def]
    """Replace the columns of a matrix by those of its factor, the diagonal inverted; False unless positive."""
    n = reach.shape[0]
    for g in range(0, n, TOGETHER):
        after, far = min(g + TOGETHER, n), reach[g]
        for k in range(g, after):
            own = where[k]
            pivot = lower[own + k]
            if not pivot > 0.0:
                return False
            root = 1.0 / np.sqrt(pivot)
            lower[own + k] = root
            for i in range(k + 1, far + 1):
                lower[np.uint64(own + i)] *= root
            for j in range(k + 1, after):
                other, part = where[j], lower[own + j]
                for i in range(j, far + 1):
                    lower[np.uint64(other + i)] -= part * lower[np.uint64(own + i)]
        if after < n:
            a, b, c, d = where[g], where[g + 1], where[g + 2], where[g + 3]
            for j in range(after, far + 1):
                p, q, r, s = lower[a + j], lower[b + j], lower[c + j], lower[d + j]
                other = where[j]
                for i in range(j, far + 1):
                    lower[np.uint64(other + i)] -= (
                        p * lower[np.uint64(a + i)] + q * lower[np.uint64(b + i)]
                        + r * lower[np.uint64(c + i)] + s * lower[np.uint64(d + i)]
                    )
    return True


@device
def substitute(reach, where, lower, b):  # type: ignore[no-untyped-def]
    """Replace b (n, 4) by the solution."""
    n = reach.shape[0]
    for k in range(n):
        own, root = where[k], lower[where[k] + k]
        b0, b1, b2, b3 = b[k, 0] * root, b[k, 1] * root, b[k, 2] * root, b[k, 3] * root
        b[k, 0], b[k, 1], b[k, 2], b[k, 3] = b0, b1, b2, b3
        for i in range(k + 1, reach[k] + 1):
            part = lower[np.uint64(own + i)]
            j = np.uint64(i)
            b[j, 0] -= part * b0
            b[j, 1] -= part * b1
            b[j, 2] -= part * b2
            b[j, 3] -= part * b3
    for k in range(n - 1, -1, -1):
        own, root = where[k], lower[where[k] + k]
        b0, b1, b2, b3 = b[k, 0], b[k, 1], b[k, 2], b[k, 3]
        for i in range(k + 1, reach[k] + 1):
            part = lower[np.uint64(own + i)]
            j = np.uint64(i)
            b0 -= part * b[j, 0]
            b1 -= part * b[j, 1]
            b2 -= part * b[j, 2]
            b3 -= part * b[j, 3]
        b[k, 0], b[k, 1], b[k, 2], b[k, 3] = b0 * root, b1 * root, b2 * root, b3 * root
    return True
