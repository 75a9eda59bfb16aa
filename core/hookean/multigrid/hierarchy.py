"""A hierarchy of ever coarser nets: which particles move together, and how smoothly, from a weighted graph alone.

Particles are gathered into aggregates of neighbours with strong connections; each aggregate moves as one on the
coarser net. Its motion is spread smoothly by one step of Jacobi: P = (I - 2/3 D^-1 L) T, with L the Laplacian of the
strong connections. The same P serves all three axes, and whatever values the pattern has.
Source: Vanek, Mandel, Brezina, "Algebraic multigrid by smoothed aggregation", Computing 56 (1996) 179.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean import kernels
from hookean.multigrid import kernels as sums

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]

SMALLEST = 60  # rows of blocks that are solved directly
MOST = 20  # levels
FULLEST = 3.0  # blocks of all levels for each of the finest
STRONG = 0.35  # a connection is strong if it is at least this part of the strongest of its particle;
WEAKER = 0.5  # on coarser levels, times this for each
DAMPING = 2.0 / 3.0


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


class Level:
    """One net of the hierarchy: its pattern (see `Blocks`), its values now, and the way to the next coarser one."""

    def __init__(self, starts: Ints, columns: Ints) -> None:
        n = len(starts) - 1
        self.starts, self.columns = starts, columns
        self.values: Floats = np.zeros((0, 9))
        above = np.ones(len(columns), dtype=bool)
        above[starts[:-1]] = False
        places = np.flatnonzero(above).astype(np.int32)
        self.high = (starts - np.arange(n + 1, dtype=np.int32), columns[above], np.zeros((len(places), 12), np.float32))
        low = _sparse(places, self.high[1], self.high[0], n).T.tocsr()
        self.low = (low.indptr.astype(np.int32), low.indices.astype(np.int32), np.zeros((len(places), 12), np.float32))
        self.mirror: Ints = low.data
        self.inverse = np.zeros((n, 12), np.float32)
        self.b, self.x = np.zeros((n, 4), np.float32), np.zeros((n, 4), np.float32)
        self.prolong: tuple[Any, ...] = ()
        self.places: Ints = np.zeros(0, np.int32)

    def to(self, p: Any, coarser: Level) -> None:
        """Know the way to the next coarser level."""
        self.prolong = (p.indptr.astype(np.int32), p.indices.astype(np.int32), p.data.astype(np.float32))
        count = np.diff(p.indptr)
        rows = np.repeat(np.arange(len(count)), np.diff(self.starts))
        products = count[rows] * count[self.columns]
        products[self.starts[:-1]] = count * (count + 1) // 2
        self.places = np.zeros(products.sum(), np.int32)
        pattern = (self.starts, self.columns, *self.prolong[:2], coarser.starts, coarser.columns)
        kernels.compiled(sums.find_places)(*pattern, self.places)
        coarser.values = np.zeros((len(coarser.columns), 9))

    def lighten(self, scale: float) -> bool:
        """Make what a cycle works on of the values; False if a diagonal block is not positive definite."""
        lighten = kernels.compiled(sums.lighten)
        whole = (self.starts, self.columns, self.values, self.mirror, scale)
        return bool(lighten(*whole, self.high[2], self.low[2], self.inverse))


class Hierarchy:
    """All levels over a pattern of blocks; `alive` (n,) tells which of its particles may move."""

    def __init__(self, starts: Ints, columns: Ints, weights: Floats, alive: NDArray[np.bool_]) -> None:
        import scipy.sparse as sparse

        self.levels = [Level(starts, columns)]
        laplacian = _laplacian(starts, columns, weights)
        while len(self.levels[-1].starts) - 1 > SMALLEST and len(self.levels) < MOST:
            level = self.levels[-1]
            n = len(level.starts) - 1
            held = laplacian.diagonal()
            alive = alive & (held > 1e-12 * held.max(initial=0.0))  # the others hang on nothing
            group = np.zeros(n, np.int32)
            pull = np.maximum(-laplacian.data, 0.0)
            least = STRONG * WEAKER ** (len(self.levels) - 1)
            count = kernels.compiled(aggregate)(laplacian.indptr, laplacian.indices, pull, least, alive, group)
            if not 0 < count < 0.8 * n or self.fill_work > FULLEST:
                break
            some = np.flatnonzero(group >= 0)
            gathered = sparse.csr_matrix((np.ones(len(some)), (some, group[some])), shape=(n, count))
            strong = _strong(laplacian, least)
            diagonal = strong.diagonal()
            scale = np.where(alive, DAMPING / np.where(diagonal > 0.0, diagonal, 1.0), 0.0)
            p = (gathered - sparse.diags(scale) @ (strong @ gathered)).tocsr()
            p.sort_indices()
            laplacian = (p.T @ laplacian @ p).tocsr()
            laplacian.sort_indices()
            coarser = Level(*_pattern(level, p))
            level.to(p, coarser)
            self.levels.append(coarser)
            alive = np.ones(count, dtype=bool)
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
            pattern = (level.starts, level.columns, level.values)
            kernels.compiled(sums.coarsen)(*pattern, *level.prolong, level.places, coarser.values)
        largest = float(values[self.levels[0].starts[:-1], ::4].max(initial=0.0))
        scale = 1.0 / largest if largest > 0.0 else 1.0  # so that single precision has room
        return all(level.lighten(scale) for level in self.levels) and self._factor(scale)

    def _factor(self, scale: float) -> bool:
        """Factor the coarsest level; False if it is not positive definite."""
        last = self.levels[-1]
        n = len(last.starts) - 1
        rows = np.repeat(np.arange(n), np.diff(last.starts))
        dense = np.zeros((n, 3, n, 3))
        blocks = scale * last.values.reshape(-1, 3, 3)
        dense[last.columns, :, rows, :] = blocks.transpose(0, 2, 1)
        dense[rows, :, last.columns, :] = blocks
        self.factor = dense.reshape(3 * n, 3 * n)
        empty = self.factor.diagonal() == 0.0
        self.factor[empty, empty] = 1.0
        return bool(kernels.compiled(sums.factor)(self.factor))

    def cycle(self, b: Floats) -> NDArray[np.float32]:
        """About A^-1 b (n, 4) by one symmetric V cycle, to a factor; the array is used again by the next one."""
        return self._cycle(0, b)

    def _cycle(self, number: int, b: Any) -> NDArray[np.float32]:
        level = self.levels[number]
        if number == len(self.levels) - 1:
            kernels.compiled(sums.solve_factored)(self.factor, b, np.zeros(3 * len(b)), level.x)
            return level.x
        coarser = self.levels[number + 1]
        kernels.compiled(sums.smooth_down)(*level.low, level.inverse, b, level.x)
        kernels.compiled(sums.restrict)(*level.high, level.x, *level.prolong, coarser.b)
        found = self._cycle(number + 1, coarser.b)
        kernels.compiled(sums.prolong)(*level.prolong, found, level.x)
        kernels.compiled(sums.smooth_up)(*level.high, *level.low, level.inverse, b, level.x)
        return level.x


def _sparse(data: Any, columns: Any, starts: Any, n: int) -> Any:
    import scipy.sparse as sparse

    return sparse.csr_matrix((data, columns, starts), shape=(n, n))


def _pattern(level: Level, p: Any) -> tuple[Ints, Ints]:
    """Where P^T A P has blocks on and above the diagonal, whatever cancels in the sums of the graph."""
    import scipy.sparse as sparse

    near = _sparse(np.ones(len(level.columns), np.float32), level.columns, level.starts, len(level.starts) - 1)
    gathers = sparse.csr_matrix((np.ones(len(p.indices), np.float32), p.indices, p.indptr), shape=p.shape)
    half = gathers.T @ near @ gathers
    found = sparse.triu(half + half.T, format="csr")
    found.sort_indices()
    return found.indptr.astype(np.int32), found.indices.astype(np.int32)


def _laplacian(starts: Ints, columns: Ints, weights: Floats) -> Any:
    """The Laplacian of a weighted graph as a sparse matrix; `weights` (k,) in a pattern, 0 on its diagonal."""
    half = _sparse(-weights, columns, starts, len(starts) - 1)
    return _balanced((half + half.T).tocsr())


def _strong(laplacian: Any, least: float) -> Any:
    """The Laplacian of the strong connections of a graph alone."""
    starts, columns = laplacian.indptr, laplacian.indices
    rows = np.repeat(np.arange(len(starts) - 1, dtype=np.int32), np.diff(starts))
    pull = np.where(rows == columns, 0.0, -laplacian.data)
    largest = np.maximum.reduceat(np.append(pull, 0.0), starts[:-1])
    weak = pull < least * np.maximum(largest[rows], largest[columns])
    found = _sparse(np.where(weak | (rows == columns), 0.0, -pull), columns, starts, len(starts) - 1).copy()
    found.eliminate_zeros()
    return _balanced(found)


def _balanced(matrix: Any) -> Any:
    """A matrix with a diagonal that makes the sums of its rows zero."""
    matrix.setdiag(0.0)
    matrix.setdiag(-np.asarray(matrix.sum(axis=1)).ravel())
    matrix.sort_indices()
    return matrix
