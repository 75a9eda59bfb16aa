"""Front: a net solved by going over it from one end, exact, and quick where it is small or narrow.

Rows are eliminated in the order in which a front meets them: neighbours stay near each other, and a row's column of the
Cholesky factor reaches to the farthest row met when the front leaves it. Four columns at a time are taken off all those
that they reach.
Sources: Cuthill and McKee, "Reducing the bandwidth of sparse symmetric matrices", 1969; Jennings, "A compact storage
scheme for the solution of symmetric linear simultaneous equations", 1966.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hookean import kernels
from hookean.solvers._laplacian import Laplacian

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]

TOGETHER = 4  # columns


@dataclass(frozen=True)
class Front:
    """The `order` (n,) of the rows, each one's `place` (n,) in it, and `reach` (n,): the farthest place met when the
    front leaves one. `held`: whether every connected part hangs on something that does not move."""

    order: Ints
    place: Ints
    reach: Ints
    work: float  # multiplications of a factor
    held: bool


def front(net: Laplacian, most: float = np.inf) -> Front | None:
    """The way of a front over a net; None where a factor would take more than `most` multiplications."""
    n = len(net.diagonal)
    order, place, reach = np.empty(n, np.int32), np.full(n, -1, np.int32), np.empty(n, np.int32)
    work = kernels.compiled(sweep)(net.starts, net.columns, net.held, order, place, reach, float(most))
    return None if work > most else Front(order, place, reach, work, work >= 0.0)


class Factor:
    """The Cholesky factor of a net; not `sound` where something hangs on nothing, or rounding leaves it nothing."""

    def __init__(self, net: Laplacian, way: Front) -> None:
        self.way, self.starts = way, np.empty(len(way.order), np.int64)
        self.values = np.zeros(kernels.compiled(reserve)(way.reach, self.starts))
        rows = (net.starts, net.columns, net.values, way.order, way.place)
        self.sound = way.held and bool(kernels.compiled(eliminate)(*rows, way.reach, self.starts, self.values))
        self.room = np.empty((len(way.order), 4))

    def solve(self, b: Floats, x: Floats) -> None:
        """Write x (n, 4) of A x = b (n, 4)."""
        columns = (self.way.reach, self.starts, self.values)
        kernels.compiled(substitute)(self.way.order, *columns, self.room, b, x)


def sweep(starts, columns, held, order, place, reach, most):  # type: ignore[no-untyped-def]
    """Number the rows, each connected part from an end, which a first sweep finds; the multiplications, and more than
    `most` as soon as they are. Less than none where a part is not held."""
    work, count = 0.0, 0
    for seed in range(place.shape[0]):
        if place[seed] != -1:
            continue
        sure, wide, at, end = False, 0.0, count, count + 1
        order[at], place[seed] = seed, -2
        while at < end:
            i = order[at]
            sure |= held[i] > 0
            for s in range(starts[i], starts[i + 1]):
                j = columns[np.uint64(s)]
                if place[j] == -1:
                    place[j] = -2
                    order[end] = j
                    end += 1
            wide += float(end - at) ** 2
            if work + wide > 4.0 * most:  # from within, a front is wider
                return work + wide
            at += 1
        if not sure:
            return -1.0
        order[count] = order[end - 1]
        place[order[count]] = count
        end = count + 1
        while count < end:
            i = order[count]
            for s in range(starts[i], starts[i + 1]):
                j = columns[np.uint64(s)]
                if place[j] < 0:
                    place[j] = end
                    order[end] = j
                    end += 1
            reach[count] = end - 1
            work += 0.5 * float(end - count) ** 2
            if work > most:
                return work
            count += 1
    return work


def reserve(reach, where):  # type: ignore[no-untyped-def]
    """Make columns that are taken together reach equally far; `where` row 0 of each would be, and the room of all."""
    n, size = reach.shape[0], 0
    for g in range(0, n, TOGETHER):
        after = min(g + TOGETHER, n)
        for k in range(g, after):
            reach[k] = reach[after - 1]
            where[k] = size - k
            size += reach[k] - k + 1
    return size


def eliminate(starts, columns, values, order, place, reach, where, lower):  # type: ignore[no-untyped-def]
    """Write the columns of the factor, their diagonal inverted; False unless the matrix is positive definite."""
    n = reach.shape[0]
    for k in range(n):
        i = order[k]
        for s in range(starts[i], starts[i + 1]):
            j = place[columns[s]]
            if j >= k:
                lower[where[k] + j] += values[s]
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
                        p * lower[np.uint64(a + i)]
                        + q * lower[np.uint64(b + i)]
                        + r * lower[np.uint64(c + i)]
                        + s * lower[np.uint64(d + i)]
                    )
    return True


def substitute(order, reach, where, lower, y, b, x):  # type: ignore[no-untyped-def]
    """Solve with the factor; `y` is for notes."""
    n = reach.shape[0]
    for k in range(n):
        i = order[k]
        for c in range(4):
            y[k, c] = b[i, c]
    for k in range(n):
        own, root = where[k], lower[where[k] + k]
        y0, y1, y2, y3 = y[k, 0] * root, y[k, 1] * root, y[k, 2] * root, y[k, 3] * root
        y[k, 0], y[k, 1], y[k, 2], y[k, 3] = y0, y1, y2, y3
        for i in range(k + 1, reach[k] + 1):
            part, j = lower[np.uint64(own + i)], np.uint64(i)
            y[j, 0] -= part * y0
            y[j, 1] -= part * y1
            y[j, 2] -= part * y2
            y[j, 3] -= part * y3
    for k in range(n - 1, -1, -1):
        own, root = where[k], lower[where[k] + k]
        y0, y1, y2, y3 = y[k, 0], y[k, 1], y[k, 2], y[k, 3]
        for i in range(k + 1, reach[k] + 1):
            part, j = lower[np.uint64(own + i)], np.uint64(i)
            y0 -= part * y[j, 0]
            y1 -= part * y[j, 1]
            y2 -= part * y[j, 2]
            y3 -= part * y[j, 3]
        y0, y1, y2, y3 = y0 * root, y1 * root, y2 * root, y3 * root
        y[k, 0], y[k, 1], y[k, 2], y[k, 3] = y0, y1, y2, y3
        i = order[k]
        x[i, 0], x[i, 1], x[i, 2], x[i, 3] = y0, y1, y2, y3
