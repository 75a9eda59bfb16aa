"""The tangent at an equilibrium in factors, each axis by itself where axes do not act on one another."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from hookean.linear.film_tangent import patterned
from hookean.linear.pattern import Pattern
from hookean.linear.sparse_factors import Factor, Factors

if TYPE_CHECKING:
    from hookean.designing.even_films import Even
    from hookean.system.state import State
    from hookean.system.system import System

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

ALIKE = 1e-14  # part of each entry by which equal matrices differ


class Orders:
    """Orders of elimination that earlier factors had, for matrices of the same pattern. `way`: which kind of factors
    the last system of a step had; `even`: what spreads the vertices of films."""

    def __init__(self) -> None:
        self._kept: list[Factors] = []
        self.way = 0
        self.even: Even | None = None

    def factor(self, matrix: Any) -> Factor | None:
        """A symmetric matrix in factors; None where it is singular."""
        from scipy.sparse import tril

        lower = tril(matrix, format="csc")
        lower.sort_indices()
        rows, starts = lower.indices.astype(np.int32), lower.indptr.astype(np.int32)
        for order in self._kept:
            if np.array_equal(order.starts, starts) and np.array_equal(order.rows, rows):
                return order.factor(lower.data)
        order = Factors(rows, starts)
        self._kept = [*self._kept[-3:], order]
        return order.factor(lower.data)


class Factored:
    """A matrix that can be solved with. `sound`: it is not singular; `negatives`: how many of its eigenvalues are
    below 0, of a symmetric matrix."""

    def __init__(self, matrix: Any, axes: Ints | None, symmetric: bool, orders: Orders) -> None:
        self.matrix, self.negatives, self.sound = matrix, 0, True
        self._general: Any = None
        self._parts: list[tuple[Ints, Factor]] = []
        if not symmetric:
            from scipy.sparse.linalg import splu

            try:
                self._general = splu(matrix)
            except RuntimeError:  # singular
                self.sound = False
            return
        for rows, block, alike in _blocks(matrix, axes):
            factor = self._parts[alike][1] if alike >= 0 else orders.factor(block)
            if factor is None:
                self.sound = False
                return
            self._parts.append((rows, factor))
            self.negatives += factor.negatives

    def solve(self, b: Floats, *, transposed: bool = False) -> Floats:
        """A^-1 b or A^-T b; NaN where A is singular."""
        if not self.sound:
            return np.full(len(b), np.nan)
        if self._general is not None:
            return np.asarray(self._general.solve(b, trans="T" if transposed else "N"))
        found = np.empty(len(b))
        for rows, factor in self._parts:
            found[rows] = factor.solve(b[rows])
        return found


class Patterned:
    """The tangent of a shape in factors, by a pattern that the solver which found it worked out; `factor` is None where
    it is singular."""

    def __init__(self, system: System, state: State, known: Pattern) -> None:
        self.pattern = patterned(system, state, state.free, known)
        self.factor = self.pattern.factors.factor(self.pattern.tangent(system, state))

    def solve(self, b: Floats) -> Floats:
        """A^-1 b (3n,) on the axes of the pattern."""
        assert self.factor is not None
        return self.pattern.spread(self.factor.solve(self.pattern.gather(b.reshape(-1, 3)))).ravel()


def _blocks(matrix: Any, axes: Ints | None) -> list[tuple[Ints, Any, int]]:
    """Parts that do not act on one another: their rows, their entries, and the number of an earlier part of the same
    entries, or -1; those of springs without rest length are the same on all axes."""
    whole = [(np.arange(matrix.shape[0]), matrix, -1)]
    if axes is None:
        return whole
    entries = matrix.tocoo()
    if (entries.data[axes[entries.row] != axes[entries.col]] != 0.0).any():
        return whole
    found: list[tuple[Ints, Any, int]] = []
    for axis in range(3):
        rows = np.flatnonzero(axes == axis)
        if not len(rows):
            continue
        block = matrix[rows][:, rows].tocsc()
        block.eliminate_zeros()
        found.append((rows, block, next((i for i, (_, other, _) in enumerate(found) if same(block, other)), -1)))
    return found


def same(one: Any, other: Any) -> bool:
    """Whether two matrices differ by the rounding of sums alone, entry by entry: small entries may be all that holds
    a soft part."""
    alike = one.shape == other.shape and one.nnz == other.nnz
    alike = alike and np.array_equal(one.indptr, other.indptr) and np.array_equal(one.indices, other.indices)
    return bool(alike and (np.abs(one.data - other.data) <= ALIKE * np.abs(one.data)).all())
