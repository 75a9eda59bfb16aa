"""A multigrid hierarchy for nets of springs of rest length 0, and its V cycle.

The axes are solved together, so that each entry of a matrix is read once for all of them, and every sum has one fixed
order. Rows of vectors have four columns, x y z and a zero: one row is one vector of the processor. The sweeps are
separate from those of `block_hierarchy` for speed: they use numbers in double precision, not blocks in single
precision, and compute the residual within the sweep, which saves a pass over memory.
Source: Brandt, "Multi-level adaptive solutions to boundary-value problems", 1977, for the cycle.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from hookean.compiled import dispatch
from hookean.compiled.marks import device
from hookean.linear.aggregation import Sparse, coarsened
from hookean.linear.front_cholesky import Factor, front
from hookean.linear.laplacian import Floats, Laplacian

STRONG = 0.1  # a connection is strong if it is at least this part of the strongest of both its rows
SMALLEST = 2_000  # rows from which on a net is not made coarser
FULLEST = 3.0  # entries of all nets for each of the finest
LARGEST_FACTOR = 5e7  # multiplications


class Level:
    """A net with room for a right-hand side and a solution (n, 4), and the way to the next coarser one."""

    def __init__(self, net: Laplacian) -> None:
        self.net = net
        self.rows = (net.starts, net.columns, net.values, net.diagonal)
        n = len(net.diagonal)
        self.nearest, self.farthest = np.empty(n, np.int32), np.empty(n, np.int32)
        dispatch.compiled(span)(net.starts, net.columns, net.diagonal, self.nearest, self.farthest)
        with np.errstate(over="ignore"):  # of a stiffness near the smallest number there is
            self.inverse: Floats = 1.0 / net.values[net.diagonal]
        self.b, self.x = np.zeros((n, 4)), np.empty((n, 4))
        self.way: Sparse = np.zeros(n + 1, np.int32), np.zeros(0, np.int32), np.zeros(0)  # to the next coarser one: P


class Hierarchy:
    """All nets over one. The coarsest is solved, or smoothed where it is too large for that: nets that do not gather
    are so closely knit that little more is needed."""

    def __init__(self, net: Laplacian) -> None:
        self.levels = [Level(net)]
        entries = len(net.columns)
        while len(self.levels[-1].inverse) > SMALLEST and entries <= FULLEST * len(net.columns):
            finer = self.levels[-1]
            found = coarsened(finer.net, STRONG)
            if found is None or len(found[1].columns) > len(finer.net.columns):
                break
            self.held = bool((found[1].values[found[1].diagonal] > 0.0).all())  # else one moves without any force
            if not self.held:
                return
            finer.way = found[0]
            self.levels.append(Level(found[1]))
            entries += len(found[1].columns)
        last = self.levels[-1].net
        way = front(last)
        self.held = way is not None and way.held  # parts of the net stay apart, however coarse
        self.factor = Factor(last, way) if way is not None and self.held and way.work <= LARGEST_FACTOR else None
        self.held = self.held and (self.factor is None or self.factor.sound)
        self._dots = np.zeros(4)

    def cycle(self, b: Floats) -> tuple[Floats, Floats]:
        """About A^-1 b by one symmetric cycle, and b . A^-1 b; the first array is used again by the next cycle."""
        x = self._cycle(0, b)
        return x, self._dots.copy()

    def _cycle(self, number: int, b: Floats) -> Floats:
        level = self.levels[number]
        if number == len(self.levels) - 1:
            if self.factor is not None:
                self.factor.solve(b, level.x)
                if number == 0:
                    self._dots[:] = (b * level.x).sum(axis=0)
                return level.x
            coarse = np.zeros((1, 4))
        else:
            coarse = self.levels[number + 1].b
        matrix = (*level.rows, level.inverse)
        dispatch.compiled(descend)(*matrix, level.farthest, b, level.x, *level.way, coarse)
        if number < len(self.levels) - 1:
            coarse = self._cycle(number + 1, coarse)
        dispatch.compiled(ascend)(*matrix, level.nearest, b, level.x, *level.way, coarse, self._dots)
        return level.x


@device
def row_times(columns: Any, values: Any, first: Any, last: Any, x: Any) -> Any:
    """The sum of the entries `first` to `last` of a row times x."""
    s0 = s1 = s2 = s3 = 0.0
    for s in range(first, last):
        k = np.uint64(s)  # unsigned: no index counts from the end
        j, a = np.uint64(columns[k]), values[k]
        s0 += a * x[j, 0]
        s1 += a * x[j, 1]
        s2 += a * x[j, 2]
        s3 += a * x[j, 3]
    return s0, s1, s2, s3


def span(starts, columns, diagonal, nearest, farthest):  # type: ignore[no-untyped-def]
    """The first and the last column of each row."""
    for i in range(diagonal.shape[0]):
        nearest[i] = farthest[i] = i
        for s in range(starts[i], starts[i + 1]):
            nearest[i], farthest[i] = min(nearest[i], columns[s]), max(farthest[i], columns[s])


def descend(  # type: ignore[no-untyped-def]
    starts, columns, values, diagonal, inverse, farthest, b, x, p_starts, p_columns, p_values, coarse
):  # fmt: skip
    """One Gauss-Seidel sweep from x = 0, rows in order, and coarse = P^T (b - A x), of which what is before and on the
    diagonal has cancelled. A row is passed on as soon as the sweep has met its neighbours, while it is at hand."""
    coarse[:] = 0.0
    behind = 0
    for i in range(diagonal.shape[0]):
        s0, s1, s2, s3 = row_times(columns, values, starts[i], diagonal[i], x)
        d = inverse[i]
        x[i, 0] = (b[i, 0] - s0) * d
        x[i, 1] = (b[i, 1] - s1) * d
        x[i, 2] = (b[i, 2] - s2) * d
        x[i, 3] = (b[i, 3] - s3) * d
        while behind <= i and farthest[behind] <= i:
            s0, s1, s2, s3 = row_times(columns, values, diagonal[behind] + 1, starts[behind + 1], x)
            for s in range(p_starts[behind], p_starts[behind + 1]):
                j, p = np.uint64(p_columns[np.uint64(s)]), p_values[np.uint64(s)]
                coarse[j, 0] -= p * s0
                coarse[j, 1] -= p * s1
                coarse[j, 2] -= p * s2
                coarse[j, 3] -= p * s3
            behind += 1


def ascend(  # type: ignore[no-untyped-def]
    starts, columns, values, diagonal, inverse, nearest, b, x, p_starts, p_columns, p_values, coarse, dots
):  # fmt: skip
    """x += P coarse, and one Gauss-Seidel sweep, rows from the last to the first; dots = b . x."""
    t0 = t1 = t2 = t3 = 0.0
    ahead = diagonal.shape[0]
    for i in range(diagonal.shape[0] - 1, -1, -1):
        while ahead > nearest[i]:
            ahead -= 1
            s0, s1, s2, s3 = row_times(p_columns, p_values, p_starts[ahead], p_starts[ahead + 1], coarse)
            x[ahead, 0] += s0
            x[ahead, 1] += s1
            x[ahead, 2] += s2
            x[ahead, 3] += s3
        s0, s1, s2, s3 = row_times(columns, values, starts[i], diagonal[i], x)
        u0, u1, u2, u3 = row_times(columns, values, diagonal[i] + 1, starts[i + 1], x)
        d = inverse[i]
        s0 = (b[i, 0] - s0 - u0) * d
        s1 = (b[i, 1] - s1 - u1) * d
        s2 = (b[i, 2] - s2 - u2) * d
        s3 = (b[i, 3] - s3 - u3) * d
        x[i, 0], x[i, 1], x[i, 2], x[i, 3] = s0, s1, s2, s3
        t0 += b[i, 0] * s0
        t1 += b[i, 1] * s1
        t2 += b[i, 2] * s2
        t3 += b[i, 3] * s3
    dots[0], dots[1], dots[2], dots[3] = t0, t1, t2, t3
