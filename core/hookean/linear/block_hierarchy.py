"""A hierarchy of ever coarser nets, gathered by a weighted graph alone: the same P serves all three axes, and whatever
values the pattern has.

`find_products` lists the products of P^T A P once, so that `coarsen` only sums them for each new tangent; the Galerkin
product of `aggregation` serves the graph, once. `scalar_hierarchy` states why the sweeps are separate.
Source: Vanek, Mandel, Brezina, "Algebraic multigrid by smoothed aggregation", Computing 56 (1996) 179.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.compiled import dispatch
from hookean.linear import block_kernels as sums
from hookean.linear.aggregation import Sparse, coarsened, transposed
from hookean.linear.laplacian import Floats, Ints, Laplacian

SMALLEST = 60  # rows of blocks that are solved directly
MOST = 20  # levels
STRONG = 0.35  # a connection is strong if it is at least this part of the strongest of both its rows;
WEAKER = 0.5  # on coarser levels, times this for each
FULLEST = 3.0  # blocks of all levels for each of the finest


class Level:
    """One net of the hierarchy: its pattern (see `Blocks`), its values now, and the way to the next coarser one."""

    def __init__(self, starts: Ints, columns: Ints) -> None:
        n = len(starts) - 1
        self.starts, self.columns = starts, columns
        self.values: Floats = np.zeros((0, 9))
        above = np.ones(len(columns), dtype=bool)
        above[starts[:-1]] = False
        places = np.flatnonzero(above).astype(np.int32)
        rest: Ints = columns[above]
        before: Ints = (starts - np.arange(n + 1)).astype(np.int32)
        low = transposed((before, rest, places), n)
        self.high: tuple[Any, ...] = (before, rest, np.zeros((len(places), 12), np.float32))
        self.low: tuple[Any, ...] = (*low[:2], np.zeros((len(places), 12), np.float32))
        self.mirror: Ints = low[2]
        self.inverse = np.zeros((n, 12), np.float32)
        self.b, self.x = np.zeros((n, 4), np.float32), np.zeros((n, 4), np.float32)
        self.prolong: tuple[Any, ...] = ()
        self.products: tuple[Any, ...] = ()

    def to(self, p: Sparse, coarser: Level) -> None:
        """Know the way to the next coarser level."""
        count = len(coarser.starts) - 1
        back = transposed(p, count)
        self.prolong = transposed(back, len(self.starts) - 1)  # sorts the columns of its rows
        pattern = (self.starts, self.columns, *self.low[:2], self.mirror, *self.prolong, *back)
        pattern += (coarser.starts, coarser.columns, np.zeros(count, np.int32))
        find = dispatch.compiled(sums.find_products)
        ends = np.zeros(2 * len(coarser.columns) + 1, np.int32)
        find(*pattern, ends[1:], np.zeros(0, np.int32), np.zeros(0))
        size = int(np.cumsum(ends, out=ends)[-1])
        self.products = ends[:-1], np.zeros(size, np.int32), np.zeros(size)
        find(*pattern, *self.products)
        coarser.values = np.zeros((len(coarser.columns), 9))

    def coarsen(self, coarser: Level) -> None:
        """Work out the values of the next coarser level."""
        dispatch.compiled(sums.coarsen)(self.values, *self.products, coarser.values)

    def lighten(self, scale: float) -> bool:
        """Make what a cycle works on of the values; False if a diagonal block is not positive definite."""
        lighten = dispatch.compiled(sums.lighten)
        whole = (self.starts, self.columns, self.values, self.mirror, scale)
        return bool(lighten(*whole, self.high[2], self.low[2], self.inverse))


class Hierarchy:
    """All levels over a pattern of blocks; `alive` (n,): which of its particles may move."""

    def __init__(self, starts: Ints, columns: Ints, weights: Floats, alive: NDArray[np.bool_]) -> None:
        self.levels = [Level(starts, columns)]
        net = _laplacian(self.levels[0], weights)
        while len(net.diagonal) > SMALLEST and len(self.levels) < MOST and self.fill_work <= FULLEST:
            stiffness = net.values[net.diagonal]
            alive = alive & (stiffness > 1e-12 * stiffness.max(initial=0.0))  # the others hang on nothing
            threshold = STRONG * WEAKER ** (len(self.levels) - 1)
            found = coarsened(net, threshold, alive, connections_only=True, dtype=np.float32)
            if found is None:
                break
            p, net = found
            self.levels.append(Level(*_above(net)))
            self.levels[-2].to(p, self.levels[-1])
            alive = np.ones(len(net.diagonal), dtype=bool)
        self.factor: Floats = np.zeros((0, 0))

    @property
    def fill_work(self) -> float:
        """Blocks of all levels for each of the finest."""
        return sum(len(level.columns) for level in self.levels) / len(self.levels[0].columns)

    @property
    def cycle_work(self) -> float:
        """Passes over the finest blocks that one cycle is worth."""
        return 2.0 * self.fill_work

    @property
    def coarse(self) -> bool:
        """Whether the coarsest level is small enough to be solved; not where the graph does not gather well."""
        return len(self.levels[-1].starts) - 1 <= SMALLEST

    def fill(self, values: Floats) -> bool:
        """Take the values (k, 9) of the finest level, work out the others; False if not positive definite."""
        self.levels[0].values = values
        for level, coarser in zip(self.levels, self.levels[1:], strict=False):
            level.coarsen(coarser)
        largest = float(values.max(initial=0.0))
        scale = 1.0 / largest if largest > 0.0 else 1.0  # so that single precision has room
        return all(level.lighten(scale) for level in self.levels) and self._factor(scale)

    def _factor(self, scale: float) -> bool:
        """Factor the coarsest level; False if it is not positive definite."""
        last = self.levels[-1]
        n = len(last.starts) - 1
        blocks = np.zeros((n, 3, n, 3))  # on and below the diagonal
        rows = np.repeat(np.arange(n), np.diff(last.starts))
        blocks[last.columns, :, rows, :] = scale * last.values.reshape(-1, 3, 3).transpose(0, 2, 1)
        self.factor = blocks.reshape(3 * n, 3 * n)
        diagonal = self.factor.diagonal()
        np.fill_diagonal(self.factor, np.where(diagonal == 0.0, 1.0, diagonal))
        return bool(dispatch.compiled(sums.factor)(self.factor))

    def cycle(self, b: Floats) -> NDArray[np.float32]:
        """About A^-1 b (n, 4) by one symmetric V cycle, to a factor; the array is used again by the next one."""
        return self._cycle(0, b)

    def _cycle(self, number: int, b: Any) -> NDArray[np.float32]:
        level = self.levels[number]
        if number == len(self.levels) - 1:
            dispatch.compiled(sums.solve_factored)(self.factor, b, np.zeros(3 * len(b)), level.x)
            return level.x
        coarser = self.levels[number + 1]
        whole = (*level.high, *level.low, level.inverse, b, level.x, *level.prolong)
        dispatch.compiled(sums.descend)(*whole, coarser.b)
        dispatch.compiled(sums.ascend)(*whole, self._cycle(number + 1, coarser.b))
        return level.x


def _laplacian(level: Level, weights: Floats) -> Laplacian:
    """The Laplacian of a graph, whole, of connections (k,) in the pattern of a level; its diagonal has weight 0."""
    low_starts, low_columns, _ = level.low
    n, starts = len(low_starts) - 1, low_starts + level.starts
    own = np.arange(n, dtype=np.int32)
    rows = np.append(np.repeat(own, np.diff(low_starts)), np.repeat(own, np.diff(level.starts)))
    order = np.argsort(rows, kind="stable")  # what is before the diagonal comes first in its row
    columns: Ints = np.append(low_columns, level.columns)[order]
    values: Floats = np.append(-weights[level.mirror], -weights)[order]
    diagonal = starts[:-1] + np.diff(low_starts)
    values[diagonal] = -np.bincount(rows[order], values, n)
    return Laplacian(starts, columns, values, diagonal, np.zeros(n, np.int8))


def _above(net: Laplacian) -> tuple[Ints, Ints]:
    """The pattern of a net on and above its diagonal."""
    n = len(net.diagonal)
    rows = np.repeat(np.arange(n, dtype=np.int32), np.diff(net.starts))
    found = np.zeros(n + 1, np.int32)
    np.cumsum(net.starts[1:] - net.diagonal, out=found[1:])
    return found, net.columns[net.columns >= rows]
