"""Profile: Cholesky factors of nets that are little more than chains, where nearly nothing fills in.

Every row is kept from its first entry to the diagonal; eliminating a chain in its own order costs the same for each
particle, wherever chains meet or close. Separate from `front_cholesky` for speed: rows of a few entries cannot fill
its panels. Compiled loops call these functions at every step.
Source: Jennings, "A compact storage scheme for the solution of symmetric linear simultaneous equations", 1966.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.compiled import dispatch
from hookean.compiled.marks import device

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
    """The products that a factor takes, or some number above `most`."""
    work = 0
    for i in range(first.shape[0]):
        for j in range(first[i], i):
            work += 1 + j - max(first[i], first[j])
        if work > most:
            break
    return work


def order(count: int, low: Ints, high: Ints, most: int) -> Ints | None:
    """An order of `count` particles joined in pairs in which a factor takes at most `most` products a particle.

    One chain after the other and where they meet last, or reverse Cuthill-McKee; none if neither does.
    """
    meets = np.bincount(low, minlength=count) + np.bincount(high, minlength=count) > 2
    alone = ~(meets[low] | meets[high])
    by_chains = _cuthill_mckee(count, low[alone], high[alone])
    by_chains = np.concatenate([by_chains[~meets[by_chains]], np.flatnonzero(meets)])
    for found in (by_chains, _cuthill_mckee(count, low, high)):
        place = np.empty(count, np.int64)
        place[found] = np.arange(count)
        one, other = place[low], place[high]
        first = np.arange(count)
        np.minimum.at(first, np.maximum(one, other), np.minimum(one, other))
        if fits(first, most):
            return found
    return None


def fits(first: Ints, most: int) -> bool:
    """Whether a factor of rows that begin there takes at most so many products a particle."""
    limit = most * len(first)
    return bool(dispatch.compiled(profile_work)(first, limit) <= limit)


def _cuthill_mckee(count: int, low: Ints, high: Ints) -> Ints:
    import scipy.sparse as sparse
    from scipy.sparse.csgraph import reverse_cuthill_mckee

    net = sparse.csr_matrix((np.ones(len(low)), (low, high)), shape=(count, count))
    found: Ints = reverse_cuthill_mckee(net + net.T, symmetric_mode=True).astype(np.int64)
    return found
