"""Lines and points given twice, found within a tolerance; the first of each kind wins.

Item i is kept unless an earlier kept item lies within the tolerance. So kept items are further apart
than the tolerance, every dropped one is within it of the kept item it counts for, and the answer
depends on the order of the input alone.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from itertools import chain
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hookean.errors import InputError

Array = NDArray[np.float64]
Index = NDArray[np.int64]
_MOST_NEIGHBOURS = 500_000  # looked at in one go, which bounds the memory
Same = Callable[[Index, Index], NDArray[np.bool_]]


def remove_duplicate_points(points: ArrayLike, tolerance: float = 1e-6) -> Array:
    """The points `(k, 3)` left of `points` `(n, 3)`, in their order; length units.

    Raises InputError for another shape, a number that is not finite or a negative tolerance.
    """
    xyz = _checked("points", points, (3,))
    return xyz[unique_points(xyz, tolerance)[0]]


def remove_duplicate_lines(lines: ArrayLike, tolerance: float = 1e-6) -> Array:
    """The lines `(k, 2, 3)` left of `lines` `(m, 2, 3)`, in their order and direction; length units.

    Two lines are the same if their ends are, either way round: |a - p| and |b - q|, or |a - q| and
    |b - p|, both at most the tolerance. Raises what `remove_duplicate_points` raises.
    """
    ends = _checked("lines", lines, (2, 3))
    return ends[unique_lines(ends, tolerance)[0]]


def unique_points(points: ArrayLike, tolerance: float = 1e-6) -> tuple[Index, Index]:
    """Indices `(k,)` of the kept points, ascending, and for every point `(n,)` its place among the kept.

    Raises what `remove_duplicate_points` raises.
    """
    xyz = _checked("points", points, (3,))
    tol = _tolerance(tolerance)
    exact, group = _exact(xyz)
    few = xyz[exact]

    def same(i: Index, j: Index) -> NDArray[np.bool_]:
        near: NDArray[np.bool_] = np.linalg.norm(few[j] - few[i], axis=1) <= tol
        return near

    return _first_wins(few, tol, same, exact, group)


def unique_lines(lines: ArrayLike, tolerance: float = 1e-6) -> tuple[Index, Index]:
    """Indices `(k,)` of the kept lines, ascending, and for every line `(m,)` its place among the kept.

    Raises what `remove_duplicate_points` raises.
    """
    ends = _checked("lines", lines, (2, 3))
    tol = _tolerance(tolerance)
    swap = _later(ends[:, 0], ends[:, 1])
    exact, group = _exact(np.where(swap[:, None, None], ends[:, ::-1], ends).reshape(-1, 6))
    few = ends[exact]

    def same(i: Index, j: Index) -> NDArray[np.bool_]:
        gap = np.linalg.norm(few[j][:, :, None] - few[i][:, None], axis=3)  # [pair, end of j, end of i]
        forward = np.maximum(gap[:, 0, 0], gap[:, 1, 1]) <= tol
        backward = np.maximum(gap[:, 0, 1], gap[:, 1, 0]) <= tol
        equal: NDArray[np.bool_] = forward | backward
        return equal

    # middle and half extent are alike either way round, and each moves by at most the tolerance
    middle, half = 0.5 * few[:, 0] + 0.5 * few[:, 1], np.abs(0.5 * few[:, 1] - 0.5 * few[:, 0])
    key = np.concatenate([middle, half], axis=1)
    return _first_wins(key, math.sqrt(2.0) * tol, same, exact, group)


def _first_wins(key: Array, radius: float, same: Same, exact: Index, group: Index) -> tuple[Index, Index]:
    """Keep in order; each kept item takes the undecided ones near it.

    Neighbours are looked up for a block of undecided items at a time, large where they are few and
    small inside dense clusters, so that the work stays near linear in both.
    """
    n = len(key)
    owner = np.arange(n)
    if radius > 0 and n > 1:
        from scipy.spatial import cKDTree

        tree: Any = cKDTree(key)
        reach = radius * (1 + 1e-9) + 4e-16 * float(np.abs(key).max())
        crowded = np.flatnonzero(tree.query(key, k=2)[0][:, 1] <= reach)
        owner[crowded] = -1
        at, size = 0, 1
        while at < len(crowded):
            open_ = at + np.flatnonzero(owner[crowded[at : at + size]] < 0)
            counts = tree.query_ball_point(key[crowded[open_]], reach, return_length=True)
            fit = max(1, int(np.searchsorted(np.cumsum(counts), _MOST_NEIGHBOURS)))
            block = crowded[open_[:fit]]
            _take(tree.query_ball_point(key[block], reach), block, same, owner)
            at = open_[fit] if fit < len(open_) else at + size
            size = min(2 * size, 2048) if fit >= len(open_) else fit
    kept = np.flatnonzero(owner == np.arange(n))
    return exact[kept], np.searchsorted(kept, owner[group])


def _take(near: Sequence[list[int]], block: Index, same: Same, owner: Index) -> None:
    """Decide a block in order, given the items near each."""
    if not len(block):
        return
    counts = np.array([len(js) for js in near])
    i, j = np.repeat(block, counts), np.fromiter(chain.from_iterable(near), np.int64, int(counts.sum()))
    equal = (owner[j] < 0) & (j > i)
    equal[equal] = same(i[equal], j[equal])
    stops = np.cumsum(np.bincount(np.repeat(np.arange(len(block)), counts)[equal], minlength=len(block)))
    j = j[equal]
    for place, k in enumerate(block.tolist()):
        if owner[k] < 0:
            owner[k] = k
            mine = j[stops[place - 1] if place else 0 : stops[place]]
            owner[mine[owner[mine] < 0]] = k


def _exact(rows: Array) -> tuple[Index, Index]:
    """First indices of the distinct rows, ascending, and for every row its place among them."""
    if not len(rows):
        return np.zeros(0, np.int64), np.zeros(0, np.int64)
    order = np.lexsort(rows.T[::-1])  # stable: the first of equal rows comes first
    new = np.ones(len(rows), bool)
    new[1:] = (rows[order][1:] != rows[order][:-1]).any(axis=1)
    first = order[new]
    rank = np.empty(len(first), np.int64)
    rank[np.argsort(first)] = np.arange(len(first))
    group = np.empty(len(rows), np.int64)
    group[order] = rank[np.cumsum(new) - 1]
    return np.sort(first), group


def _later(a: Array, b: Array) -> NDArray[np.bool_]:
    """Where a comes after b in lexicographic order."""
    x, y, z = (a > b).T
    ex, ey, _ = (a == b).T
    later: NDArray[np.bool_] = x | (ex & (y | (ey & z)))
    return later


def _checked(name: str, given: ArrayLike, shape: tuple[int, ...]) -> Array:
    try:
        array = np.asarray(given, dtype=np.float64)
    except (TypeError, ValueError):
        array = np.zeros(1)
    if array.size == 0 and array.ndim <= 1:
        array = array.reshape(0, *shape)
    if array.shape[1:] != shape:
        want = ", ".join(str(s) for s in ("n", *shape))
        raise InputError(name, f"they are not numbers of shape ({want}); give an array of that shape")
    bad = np.argwhere(~np.isfinite(array))
    if len(bad):
        raise InputError(f"{name}/{bad[0][0]}", "it is not finite; give finite coordinates")
    return array + 0.0  # makes -0.0 and 0.0 the same


def _tolerance(tolerance: float) -> float:
    if not (math.isfinite(tolerance) and tolerance >= 0):
        raise InputError("tolerance", f"it is {tolerance!r}; give a finite length of at least 0")
    return float(tolerance)
