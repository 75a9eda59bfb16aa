"""Factors of a sparse symmetric matrix that changes its values and keeps its pattern.

Made by rslab where it is installed (`pip install hookean[fast]`): supernodal, its order worked out once, three times
as quick as SciPy's splu on a net of 10,000 particles. Else by splu. Both count the negative eigenvalues (Sylvester's
law of inertia), and both give the same bits on any number of threads.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from importlib import import_module
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.linear import unsymmetric

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]


class Factor:
    """A matrix of `size` rows in factors, and how many of its eigenvalues are negative."""

    def __init__(self, solve: Callable[[Floats], Floats], size: int, negatives: int) -> None:
        self._solve, self._size, self.negatives = solve, size, negatives

    def solve(self, b: Floats) -> Floats:
        """x of A x = b. A shorter b stands for zeros at its end, and x is as long as b."""
        return self._solve(np.append(b, np.zeros(self._size - len(b))))[: len(b)]


class Factors:
    """Factors of symmetric matrices of one pattern: the lower triangle by columns, rows (nnz,) sorted within each of
    the columns that begin at `starts` (n + 1,). `last` are those that `solve` made last."""

    def __init__(self, rows: Ints, starts: Ints) -> None:
        self.rows, self.starts = rows, starts
        self.last: Factor | None = None
        self._order: Any = None

    def factor(self, values: Floats) -> Factor | None:
        """The matrix with these values (nnz,) of its lower triangle in factors; None where it is singular."""
        import scipy.sparse as sparse

        size = len(self.starts) - 1
        lower = sparse.csc_matrix((values, self.rows, self.starts), shape=(size, size))
        try:
            return self._supernodal(lower) if supernodal() is not None else _splu(lower)
        except RuntimeError:  # singular
            return None

    def solve(self, values: Floats, b: Floats, skew: Any = None) -> Floats | None:
        """x of A x = b (n, or fewer: see `Factor.solve`), or of (A + S) x = b with `skew` S, sparse; None unless A is
        positive definite."""
        self.last = factor = self.factor(values)
        if factor is None or factor.negatives:
            return None
        x = factor.solve(b) if skew is None else unsymmetric.solve(factor.solve, skew, b)
        return x if np.isfinite(x).all() else None

    def _supernodal(self, lower: Any) -> Factor | None:
        if self._order is None:
            self._order = supernodal().analyze(lower, path="ldlt", threads=1)
        factor = self._order.factor(lower.data)
        _, negatives, zeros = factor.inertia
        return None if zeros else Factor(lambda b: np.asarray(factor.solve(b)), lower.shape[0], negatives)


@cache
def supernodal() -> Any:
    """The module rslab, or None where it is not installed."""
    try:
        return import_module("rslab")
    except ImportError:
        return None


def _splu(lower: Any) -> Factor | None:
    from scipy.sparse import tril
    from scipy.sparse.linalg import splu

    whole = (lower + tril(lower, -1).T).tocsc()
    factor = splu(whole, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    # pivots have the signs of the eigenvalues as long as all are taken from the diagonal
    same = np.array_equal(factor.perm_r, factor.perm_c)
    pivots = factor.U.diagonal()
    if not (same and pivots.all()):
        return None
    return Factor(lambda b: np.asarray(factor.solve(b)), len(pivots), int((pivots < 0).sum()))
