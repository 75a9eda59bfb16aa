"""Comparisons: which elements in runs of cells are near one, a few at once and without branches."""

from __future__ import annotations

from typing import Any

import numpy as np

from hookean.compiled.marks import device

ABREAST, FEW, BITS = 16, 4, 64  # elements that are compared at once, or one by one if runs are short; bits of a number
TOGETHER = 48  # elements in and near a cell, up to which they are copied and compared in turn
ONE, BRUIJN = np.uint64(1), np.uint64(0x03F79D71B4CB0A89)  # the upper six bits of this times a power of 2 are unique
LOWEST = np.zeros(BITS, np.uint64)  # which bit is set, by these six
LOWEST[[(int(BRUIJN) << bit & 0xFFFFFFFFFFFFFFFF) >> 58 for bit in range(BITS)]] = np.arange(BITS)


@device
def both(i: Any, j: Any) -> Any:
    """A pair of rows as one number, the lower one first."""
    return np.int64(min(i, j)) | np.int64(max(i, j)) << 32


@device
def ends(pair: Any) -> Any:
    """The two rows of a pair; unsigned: no index counts from the end."""
    return np.uint64(pair) & np.uint64(0xFFFFFFFF), np.uint64(pair) >> np.uint64(32)


@device
def near_ones(xs, ys, zs, radii, begin, end, x, y, z, reach) -> Any:  # type: ignore[no-untyped-def]
    """Which of the `ABREAST` elements from `begin` on, but none from `end` on, are within their radius and `reach` of a
    point: a bit for each. All are compared at once, without a branch: as many as LLVM needs to make a vector loop."""
    bits = 0
    for k in range(ABREAST):
        t = np.uint64(begin) + np.uint64(k)
        dx, dy, dz, apart = xs[t] - x, ys[t] - y, zs[t] - z, radii[t] + reach
        bits |= 1 << k if dx * dx + dy * dy + dz * dz < apart * apart else 0
    return bits & ((1 << min(end - begin, ABREAST)) - 1)


@device
def near_few(xs, ys, zs, radii, begin, end, x, y, z, reach) -> Any:  # type: ignore[no-untyped-def]
    """The same of `FEW` elements."""
    bits = 0
    for k in range(FEW):
        t = np.uint64(begin) + np.uint64(k)
        dx, dy, dz, apart = xs[t] - x, ys[t] - y, zs[t] - z, radii[t] + reach
        bits |= 1 << k if dx * dx + dy * dy + dz * dz < apart * apart else 0
    return bits & ((1 << min(end - begin, FEW)) - 1)


@device
def meet(xs, ys, zs, radii, number, x, y, z, reach, own, runs, several, at_once, found, count, begins) -> Any:  # type: ignore[no-untyped-def]
    """List a row with all elements in some runs that are within their radius and `reach` of a point; how many pairs are
    listed then, -1 if there is no place. Bits of several comparisons are read together, since the end of each reading
    is a branch that no processor foresees."""
    bits, full = np.uint64(0), 0
    for n in range(several):
        begin, end = runs[n, 0], runs[n, 1]
        while begin < end:
            if full == BITS:
                count = write_bits(bits, begins, own, number, at_once, found, count)
                bits, full = np.uint64(0), 0
            if at_once == ABREAST:
                near = near_ones(xs, ys, zs, radii, begin, end, x, y, z, reach)
            else:
                near = near_few(xs, ys, zs, radii, begin, end, x, y, z, reach)
            bits |= np.uint64(near) << np.uint64(full)
            begins[np.uint64(full)] = begin
            full, begin = full + at_once, begin + at_once
    return write_bits(bits, begins, own, number, at_once, found, count)


@device
def beside(runs, several, xs, ys, zs, radii, number, few) -> Any:  # type: ignore[no-untyped-def]
    """Copy the elements in some runs one behind the other: x, y, z, radius and row in `few`; how many, or a number
    above `TOGETHER` if there are more."""
    total, (x, y, z, radius, row) = 0, few
    for n in range(several):
        begin, end = runs[n, 0], runs[n, 1]
        while begin < end and total <= TOGETHER:
            for k in range(FEW):  # without a branch: what is beyond the end is overwritten, or not read
                t, to = np.uint64(begin) + np.uint64(k), np.uint64(total) + np.uint64(k)
                x[to], y[to], z[to], radius[to], row[to] = xs[t], ys[t], zs[t], radii[t], number[t]
            total += min(end - begin, FEW)
            begin += FEW
    return total


@device
def meet_few(few: Any, own: Any, total: Any, beyond: Any, found: Any, count: Any) -> Any:
    """List one of some elements (`beside`) with all later ones that are within `beyond` of their reach; how many pairs
    are listed then. There has to be place for all: each is written down, and the next one over it unless it counts, for
    branches that no processor foresees take longer than a few comparisons."""
    x, y, z, radius, row = few
    i = np.uint64(own)
    x0, y0, z0, reach, one = x[i], y[i], z[i], radius[i] + beyond, int(row[i])
    for n in range(own + 1, total):
        t = np.uint64(n)
        dx, dy, dz, apart = x[t] - x0, y[t] - y0, z[t] - z0, radius[t] + reach
        found[np.uint64(count)] = both(one, int(row[t]))
        count += 1 if dx * dx + dy * dy + dz * dz < apart * apart else 0
    return count


@device
def write_bits(bits, begins, own, number, at_once, found, count) -> Any:  # type: ignore[no-untyped-def]
    """List an element with those of set bits, in groups of as many as were compared at once, each from one of `begins`;
    how many pairs are listed then, -1 if there is no place."""
    within = np.uint64(at_once - 1)
    while bits:
        lowest = LOWEST[(bits & (~bits + ONE)) * BRUIJN >> np.uint64(58)]
        bits &= bits - ONE
        if count < 0 or count >= found.shape[0]:
            return -1
        other = begins[lowest & ~within] + np.int64(lowest & within)
        found[np.uint64(count)] = both(own, number[np.uint64(other)])
        count += 1
    return count
