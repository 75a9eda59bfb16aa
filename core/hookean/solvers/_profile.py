"""Profile: Cholesky factors of nets that are little more than chains, where nearly nothing fills in.

Every row is kept from its first entry to the diagonal; eliminating a chain in its own order costs the same for each
particle, wherever chains meet or close. Source: Jennings, "A compact storage scheme for the solution of symmetric
linear simultaneous equations", 1966.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean import kernels
from hookean.kernels import device

Ints = NDArray[np.int64]

SINGULAR = 1e-14  # a pivot below this part of its diagonal is rounding


@device
def factor(values: Any, starts: Any, first: Any) -> Any:
    """Replace the rows of a symmetric matrix by its Cholesky factor, diagonal inverted; False unless positive."""
    for i in range(first.shape[0]):
        row = starts[i] - first[i]
        whole = values[row + i]
        pivot = whole
        for j in range(first[i], i):
            other = starts[j] - first[j]
            entry = values[row + j]
            for c in range(max(first[i], first[j]), j):
                entry -= values[row + c] * values[other + c]
            entry *= values[other + j]
            values[row + j] = entry
            pivot -= entry * entry
        if not pivot > SINGULAR * whole:
            return False
        values[row + i] = 1.0 / np.sqrt(pivot)
    return True


@device
def solve(values: Any, starts: Any, first: Any, b: Any) -> None:
    """Replace `b` by the solution, with the factor of `factor`."""
    for i in range(first.shape[0]):
        row = starts[i] - first[i]
        now = b[i]
        for j in range(first[i], i):
            now -= values[row + j] * b[j]
        b[i] = now * values[row + i]
    for i in range(first.shape[0] - 1, -1, -1):
        row = starts[i] - first[i]
        now = b[i] * values[row + i]
        b[i] = now
        for j in range(first[i], i):
            b[j] -= values[row + j] * now


def profile_work(first, most):  # type: ignore[no-untyped-def]
    work = 0
    for i in range(first.shape[0]):
        for j in range(first[i], i):
            work += 1 + j - max(first[i], first[j])
        if work > most:
            break
    return work


def first_entries(count: int, low: Ints, high: Ints) -> Ints:
    """First column of each row of a symmetric matrix (count,) with entries at rows `high` and columns `low` (m,), and
    on the diagonal."""
    first = np.arange(count)
    np.minimum.at(first, high, low)
    return first


def order(count: int, low: Ints, high: Ints, most: int) -> Ints | None:
    """An order of `count` particles joined in pairs in which a factor takes at most `most` products a particle.

    Their own order where that will do, else one chain after the other and where they meet last, or reverse
    Cuthill-McKee; none if none of them does.
    """
    own = np.arange(count)
    if _fits(first_entries(count, low, high), most):
        return own
    meets = np.bincount(low, minlength=count) + np.bincount(high, minlength=count) > 2
    alone = ~(meets[low] | meets[high])
    by_chains = _cuthill_mckee(count, low[alone], high[alone])
    by_chains = np.concatenate([by_chains[~meets[by_chains]], np.flatnonzero(meets)])
    for found in (by_chains, _cuthill_mckee(count, low, high)):
        place = np.empty(count, np.int64)
        place[found] = own
        one, other = place[low], place[high]
        if _fits(first_entries(count, np.minimum(one, other), np.maximum(one, other)), most):
            return found
    return None


def _cuthill_mckee(count: int, low: Ints, high: Ints) -> Ints:
    import scipy.sparse as sparse
    from scipy.sparse.csgraph import reverse_cuthill_mckee

    net = sparse.csr_matrix((np.ones(len(low)), (low, high)), shape=(count, count))
    found: Ints = reverse_cuthill_mckee(net + net.T, symmetric_mode=True).astype(np.int64)
    return found


def _fits(first: Ints, most: int) -> bool:
    limit, lengths = most * len(first), np.arange(1, len(first) + 1) - first
    if (lengths * lengths).sum() <= limit:  # at most as many as that
        return True
    return bool(kernels.compiled(profile_work)(first, limit) <= limit)
