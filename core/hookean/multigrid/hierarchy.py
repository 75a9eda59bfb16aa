"""A hierarchy of ever coarser nets: which particles move together, and how smoothly, from the graph alone.

Particles are gathered into aggregates of neighbours with strong connections; each aggregate moves as one on the
coarser net. Its motion is spread smoothly by one step of Jacobi: P = (I - 2/3 D^-1 L) T, with L the Laplacian of the
weights. The same P serves all three axes and, since it does not depend on the shape, all steps of a solve.
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
STRONG = 0.1  # a connection is strong if it is at least this part of the strongest of its particle
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
    """One net of the hierarchy: its pattern, what its values are now, and the way to the next coarser one."""

    def __init__(self, starts: Ints, columns: Ints) -> None:
        self.starts, self.columns = starts, columns
        rows = np.repeat(np.arange(len(starts) - 1, dtype=np.int32), np.diff(starts))
        self.diagonal: Ints = np.flatnonzero(rows == columns).astype(np.int32)
        n = len(self.diagonal)
        self.values: Floats = np.zeros((0, 9))
        self.inverse: Floats = np.zeros((n, 9))
        self.b, self.x = np.zeros((n, 3)), np.zeros((n, 3))
        self.prolong: tuple[Any, ...] = ()
        self.restrict: tuple[Any, ...] = ()
        self.notes: tuple[Any, ...] = ()

    def mirror(self) -> Ints:
        """Where in the pattern the transposed place of each block is."""
        import scipy.sparse as sparse

        n = len(self.diagonal)
        numbers = sparse.csr_matrix((np.arange(len(self.columns), dtype=np.int32), self.columns, self.starts), (n, n))
        found: Ints = numbers.T.tocsr().data
        return found

    def to(self, p: Any, coarser: Level) -> None:
        """Know the way to the next coarser level."""
        r = p.T.tocsr()
        self.prolong = (p.indptr.astype(np.int32), p.indices.astype(np.int32), p.data)
        self.restrict = (r.indptr.astype(np.int32), r.indices.astype(np.int32), r.data)
        longest = int(np.diff(coarser.starts).max())
        self.notes = (coarser.mirror(), np.zeros(len(coarser.diagonal), np.int32), np.zeros((longest, 9)))
        coarser.values = np.zeros((len(coarser.columns), 9))


class Hierarchy:
    """All levels over a pattern of blocks; `alive` (n,) tells which of its particles may move."""

    def __init__(self, starts: Ints, columns: Ints, weights: Floats, alive: NDArray[np.bool_]) -> None:
        import scipy.sparse as sparse

        self.levels = [Level(starts, columns)]
        laplacian = _laplacian(starts, columns, weights)
        while len(self.levels[-1].diagonal) > SMALLEST and len(self.levels) < MOST:
            level = self.levels[-1]
            n = len(level.diagonal)
            held = laplacian.diagonal()
            alive = alive & (held > 1e-12 * held.max(initial=0.0))  # the others hang on nothing
            group = np.zeros(n, np.int32)
            pull = np.maximum(-laplacian.data, 0.0)
            count = kernels.compiled(aggregate)(laplacian.indptr, laplacian.indices, pull, STRONG, alive, group)
            if not 0 < count < 0.8 * n or self.fill_work > FULLEST:
                break
            some = np.flatnonzero(group >= 0)
            gathered = sparse.csr_matrix((np.ones(len(some)), (some, group[some])), shape=(n, count))
            diagonal = laplacian.diagonal()
            scale = np.where(alive, DAMPING / np.where(diagonal > 0.0, diagonal, 1.0), 0.0)
            p = (gathered - sparse.diags(scale) @ (laplacian @ gathered)).tocsr()
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
        return len(self.levels[-1].diagonal) <= SMALLEST

    def fill(self, values: Floats) -> bool:
        """Take the values (k, 9) of the finest level, work out the others; False if not positive definite."""
        self.levels[0].values = values
        for level, coarser in zip(self.levels, self.levels[1:], strict=False):
            pattern = (level.starts, level.columns, level.values)
            kernels.compiled(sums.coarsen)(
                *pattern, *level.prolong, *level.restrict, coarser.starts, coarser.columns, coarser.values, *level.notes
            )
        for level in self.levels:
            if not kernels.compiled(sums.invert_diagonal)(level.diagonal, level.values, level.inverse):
                return False
        return self._factor()

    def _factor(self) -> bool:
        """Factor the coarsest level; False if it is not positive definite."""
        last = self.levels[-1]
        n = len(last.diagonal)
        rows = np.repeat(np.arange(n), np.diff(last.starts))
        dense = np.zeros((n, 3, n, 3))
        dense[rows, :, last.columns, :] = last.values.reshape(-1, 3, 3)
        self.factor = dense.reshape(3 * n, 3 * n)
        empty = self.factor.diagonal() == 0.0
        self.factor[empty, empty] = 1.0
        return bool(kernels.compiled(sums.factor)(self.factor))

    def cycle(self, b: Floats) -> Floats:
        """About A^-1 b by one symmetric V cycle; the array is used again by the next one."""
        return self._cycle(0, b)

    def _cycle(self, number: int, b: Floats) -> Floats:
        level = self.levels[number]
        if number == len(self.levels) - 1:
            kernels.compiled(sums.solve_factored)(self.factor, b.reshape(-1), level.x.reshape(-1))
            return level.x
        coarser = self.levels[number + 1]
        matrix = (level.starts, level.columns, level.values, level.diagonal)
        kernels.compiled(sums.smooth_down)(*matrix, level.inverse, b, level.x)
        kernels.compiled(sums.restrict)(*matrix, level.x, *level.prolong, coarser.b)
        found = self._cycle(number + 1, coarser.b)
        kernels.compiled(sums.prolong)(*level.prolong, found, level.x)
        kernels.compiled(sums.smooth_up)(*matrix, level.inverse, b, level.x)
        return level.x


def _pattern(level: Level, p: Any) -> tuple[Ints, Ints]:
    """Where P^T A P has blocks, whatever cancels in the sums of the graph."""
    import scipy.sparse as sparse

    n = len(level.diagonal)
    near = sparse.csr_matrix((np.ones(len(level.columns)), level.columns, level.starts), shape=(n, n))
    gathers = sparse.csr_matrix((np.ones(len(p.indices)), p.indices, p.indptr), shape=p.shape)
    found = (gathers.T @ near @ gathers).tocsr()
    found.sort_indices()
    return found.indptr.astype(np.int32), found.indices.astype(np.int32)


def _laplacian(starts: Ints, columns: Ints, weights: Floats) -> Any:
    """The Laplacian of a weighted graph as a sparse matrix; `weights` (k,) in the pattern, 0 on its diagonal."""
    import scipy.sparse as sparse

    n = len(starts) - 1
    matrix = sparse.csr_matrix((-weights, columns, starts), shape=(n, n))
    sums_ = -np.asarray(matrix.sum(axis=1)).ravel()
    matrix.setdiag(sums_)
    return matrix
