"""Front: a net solved by going over it from one end, exact, and quick where it is small or narrow.

Rows are eliminated in the order in which a front meets them: neighbours stay near each other, and a row's column of the
Cholesky factor reaches to the farthest row met when the front leaves it. Four columns at a time are taken off all those
that they reach. Separate from `profile_cholesky` for speed: panels of four columns pay where the front is wide, and
chains have one to three entries in a row.
Sources: Cuthill and McKee, "Reducing the bandwidth of sparse symmetric matrices", 1969; Jennings, "A compact storage
scheme for the solution of symmetric linear simultaneous equations", 1966.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.compiled import dispatch
from hookean.compiled.marks import device
from hookean.linear.laplacian import Laplacian

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]


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
    work = dispatch.compiled(sweep)(net.starts, net.columns, net.held, order, place, reach, float(most))
    return None if work > most else Front(order, place, reach, work, work >= 0.0)


class Factor:
    """The Cholesky factor of a net; not `sound` if a part is unsupported, or rounding leaves it nothing.

    A panel of four columns is kept as rows of four, from its own first row to the farthest that one of them reaches:
    a row is one vector of the processor.
    """

    def __init__(self, net: Laplacian, way: Front) -> None:
        n = len(way.order)
        self.way = way
        self.far, self.where = np.empty((n + 3) // 4, np.int64), np.empty((n + 3) // 4, np.int64)
        self.values = np.zeros((dispatch.compiled(reserve)(way.reach, self.far, self.where), 4))
        rows = (net.starts, net.columns, net.values, way.order, way.place)
        self.sound = way.held and bool(dispatch.compiled(eliminate)(*rows, self.far, self.where, self.values))
        self.room = np.zeros((4 * len(self.far), 4))

    def solve(self, b: Floats, x: Floats) -> None:
        """Write x (n, 4) of A x = b (n, 4)."""
        dispatch.compiled(substitute)(self.way.order, self.far, self.where, self.values, self.room, b, x)


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


def reserve(reach, far, where):  # type: ignore[no-untyped-def]
    """The last row `far` of each panel, `where` its row 0 would be, and the rows of all."""
    size = 0
    for q in range(far.shape[0]):
        far[q] = reach[min(4 * q + 3, reach.shape[0] - 1)] | 3
        where[q] = size - 4 * q
        size += far[q] + 1 - 4 * q
    return size


def eliminate(starts, columns, values, order, place, far, where, lower):  # type: ignore[no-untyped-def]
    """Write the panels of the factor, its diagonal inverted; False unless the matrix is positive definite."""
    for k in range(order.shape[0]):
        i, own = order[k], where[k // 4]
        for s in range(starts[i], starts[i + 1]):
            j = place[columns[s]]
            if j >= k:
                lower[own + j, k % 4] += values[s]
    for k in range(order.shape[0], 4 * far.shape[0]):
        lower[where[k // 4] + k, k % 4] = 1.0
    for q in range(far.shape[0]):
        own = where[q]
        if not close_panel(lower, own + 4 * q, own + far[q] + 1):
            return False
        for h in range(q + 1, far[q] // 4 + 1):
            take_off(lower, own, where[h], 4 * h, far[q] + 1)
    return True


@device
def close_panel(lower: Any, first: Any, after: Any) -> Any:
    """The factor of a panel's rows `first` to `after`, of which the first four are triangular."""
    for c in range(4):
        for d in range(c):
            part = lower[first + c, d]
            for e in range(d):
                part -= lower[first + c, e] * lower[first + d, e]
            lower[first + c, d] = part * lower[first + d, d]
        pivot = lower[first + c, c]
        for e in range(c):
            pivot -= lower[first + c, e] * lower[first + c, e]
        if not pivot > 0.0:
            return False
        lower[first + c, c] = 1.0 / np.sqrt(pivot)
    m00, m10, m11 = lower[first, 0], lower[first + 1, 0], lower[first + 1, 1]
    m20, m21, m22 = lower[first + 2, 0], lower[first + 2, 1], lower[first + 2, 2]
    m30, m31, m32, m33 = lower[first + 3, 0], lower[first + 3, 1], lower[first + 3, 2], lower[first + 3, 3]
    for s in range(first + 4, after):
        i = np.uint64(s)  # unsigned: no index counts from the end
        l0 = lower[i, 0] * m00
        l1 = (lower[i, 1] - l0 * m10) * m11
        l2 = (lower[i, 2] - l0 * m20 - l1 * m21) * m22
        l3 = (lower[i, 3] - l0 * m30 - l1 * m31 - l2 * m32) * m33
        lower[i, 0], lower[i, 1], lower[i, 2], lower[i, 3] = l0, l1, l2, l3
    return True


@device
def take_off(lower: Any, own: Any, other: Any, first: Any, after: Any) -> None:
    """Take a panel off a later one, whose own rows begin at `first`: its rows `first` to `after`."""
    a, b, c, d = own + first, own + first + 1, own + first + 2, own + first + 3
    a0, a1, a2, a3 = lower[a, 0], lower[a, 1], lower[a, 2], lower[a, 3]
    b0, b1, b2, b3 = lower[b, 0], lower[b, 1], lower[b, 2], lower[b, 3]
    c0, c1, c2, c3 = lower[c, 0], lower[c, 1], lower[c, 2], lower[c, 3]
    d0, d1, d2, d3 = lower[d, 0], lower[d, 1], lower[d, 2], lower[d, 3]
    for s in range(first, after):
        i, j = np.uint64(own + s), np.uint64(other + s)
        l0, l1, l2, l3 = lower[i, 0], lower[i, 1], lower[i, 2], lower[i, 3]
        t0 = lower[j, 0] - l0 * a0 - l1 * a1 - l2 * a2 - l3 * a3
        t1 = lower[j, 1] - l0 * b0 - l1 * b1 - l2 * b2 - l3 * b3
        t2 = lower[j, 2] - l0 * c0 - l1 * c1 - l2 * c2 - l3 * c3
        t3 = lower[j, 3] - l0 * d0 - l1 * d1 - l2 * d2 - l3 * d3
        lower[j, 0], lower[j, 1], lower[j, 2], lower[j, 3] = t0, t1, t2, t3


def substitute(order, far, where, lower, y, b, x):  # type: ignore[no-untyped-def]
    """Solve with the factor; `y` (rows of all panels, 4) is for notes."""
    n = order.shape[0]
    for k in range(n):
        for c in range(4):
            y[k, c] = b[order[k], c]
    for k in range(n, y.shape[0]):
        for c in range(4):
            y[k, c] = 0.0
    for q in range(far.shape[0]):
        go_down(lower, where[q], 4 * q, far[q] + 1, y)
    for q in range(far.shape[0] - 1, -1, -1):
        go_up(lower, where[q], 4 * q, far[q] + 1, y)
    for k in range(n):
        for c in range(4):
            x[order[k], c] = y[k, c]


@device
def go_down(lower: Any, own: Any, first: Any, after: Any, y: Any) -> None:
    """Solve a panel's four rows, and take them off the rows that it reaches."""
    for k in range(4):
        for d in range(k):
            for c in range(4):
                y[first + k, c] -= lower[own + first + k, d] * y[first + d, c]
        for c in range(4):
            y[first + k, c] *= lower[own + first + k, k]
    a0, a1, a2, a3 = y[first, 0], y[first, 1], y[first, 2], y[first, 3]
    b0, b1, b2, b3 = y[first + 1, 0], y[first + 1, 1], y[first + 1, 2], y[first + 1, 3]
    c0, c1, c2, c3 = y[first + 2, 0], y[first + 2, 1], y[first + 2, 2], y[first + 2, 3]
    d0, d1, d2, d3 = y[first + 3, 0], y[first + 3, 1], y[first + 3, 2], y[first + 3, 3]
    for s in range(first + 4, after):
        i, j = np.uint64(own + s), np.uint64(s)
        l0, l1, l2, l3 = lower[i, 0], lower[i, 1], lower[i, 2], lower[i, 3]
        t0 = y[j, 0] - l0 * a0 - l1 * b0 - l2 * c0 - l3 * d0
        t1 = y[j, 1] - l0 * a1 - l1 * b1 - l2 * c1 - l3 * d1
        t2 = y[j, 2] - l0 * a2 - l1 * b2 - l2 * c2 - l3 * d2
        t3 = y[j, 3] - l0 * a3 - l1 * b3 - l2 * c3 - l3 * d3
        y[j, 0], y[j, 1], y[j, 2], y[j, 3] = t0, t1, t2, t3


@device
def go_up(lower: Any, own: Any, first: Any, after: Any, y: Any) -> None:
    """Take the rows that a panel reaches off its own four, and solve those."""
    a0, a1, a2, a3 = y[first, 0], y[first, 1], y[first, 2], y[first, 3]
    b0, b1, b2, b3 = y[first + 1, 0], y[first + 1, 1], y[first + 1, 2], y[first + 1, 3]
    c0, c1, c2, c3 = y[first + 2, 0], y[first + 2, 1], y[first + 2, 2], y[first + 2, 3]
    d0, d1, d2, d3 = y[first + 3, 0], y[first + 3, 1], y[first + 3, 2], y[first + 3, 3]
    for s in range(first + 4, after):
        i, j = np.uint64(own + s), np.uint64(s)
        y0, y1, y2, y3 = y[j, 0], y[j, 1], y[j, 2], y[j, 3]
        l0, l1, l2, l3 = lower[i, 0], lower[i, 1], lower[i, 2], lower[i, 3]
        a0, a1, a2, a3 = a0 - l0 * y0, a1 - l0 * y1, a2 - l0 * y2, a3 - l0 * y3
        b0, b1, b2, b3 = b0 - l1 * y0, b1 - l1 * y1, b2 - l1 * y2, b3 - l1 * y3
        c0, c1, c2, c3 = c0 - l2 * y0, c1 - l2 * y1, c2 - l2 * y2, c3 - l2 * y3
        d0, d1, d2, d3 = d0 - l3 * y0, d1 - l3 * y1, d2 - l3 * y2, d3 - l3 * y3
    y[first, 0], y[first, 1], y[first, 2], y[first, 3] = a0, a1, a2, a3
    y[first + 1, 0], y[first + 1, 1], y[first + 1, 2], y[first + 1, 3] = b0, b1, b2, b3
    y[first + 2, 0], y[first + 2, 1], y[first + 2, 2], y[first + 2, 3] = c0, c1, c2, c3
    y[first + 3, 0], y[first + 3, 1], y[first + 3, 2], y[first + 3, 3] = d0, d1, d2, d3
    for k in range(3, -1, -1):
        for d in range(k + 1, 4):
            for c in range(4):
                y[first + k, c] -= lower[own + first + d, k] * y[first + d, c]
        for c in range(4):
            y[first + k, c] *= lower[own + first + k, k]
