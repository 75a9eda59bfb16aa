"""The sums of a multigrid cycle and of conjugate gradients on blocks of 3 x 3, each in one pass over memory.

Blocks are rows of nine numbers, (k, 9), and vectors (n, 3), in double precision; in a cycle, which need not be exact,
(k, 12) and (n, 4) in single precision. Everything is summed in one fixed order.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from hookean.compiled.marks import device


def lighten(starts, columns, values, mirror, scale, high, low, inverse):  # type: ignore[no-untyped-def]
    """What a cycle works on, in single precision: the blocks above and below the diagonal and the inverses of those on
    it, columns after one another and four numbers each, so that one is a vector of the processor.

    False where a diagonal block is not positive definite. An axis without stiffness, which is held or on which nothing
    pulls, stays where it is: zero in the inverse. `mirror` tells the block above that each one below is, turned over.
    """
    k = 0
    for i in range(starts.shape[0] - 1):
        m = values[starts[i]]
        b, c, e = m[3], m[6], m[7]
        a = m[0] if m[0] != 0.0 else 1.0
        d = m[4] if m[4] != 0.0 else 1.0
        f = m[8] if m[8] != 0.0 else 1.0
        p, q, r = d * f - e * e, c * e - b * f, b * e - c * d
        determinant = a * p + b * q + c * r
        if not (a > 0.0 and a * d - b * b > 0.0 and determinant > 0.0):
            return False
        unit = 1.0 / determinant / scale
        inverse[i, 0] = p * unit if m[0] != 0.0 else 0.0
        inverse[i, 1] = inverse[i, 4] = q * unit
        inverse[i, 2] = inverse[i, 8] = r * unit
        inverse[i, 5] = (a * f - c * c) * unit if m[4] != 0.0 else 0.0
        inverse[i, 6] = inverse[i, 9] = (b * c - a * e) * unit
        inverse[i, 10] = (a * d - b * b) * unit if m[8] != 0.0 else 0.0
        for s in range(starts[i] + 1, starts[i + 1]):
            a, b, c, d, e, f, p, q, r = scaled(values, s, scale)
            high[k, 0], high[k, 1], high[k, 2] = a, d, p
            high[k, 4], high[k, 5], high[k, 6] = b, e, q
            high[k, 8], high[k, 9], high[k, 10] = c, f, r
            k += 1
    for t in range(mirror.shape[0]):
        a, b, c, d, e, f, p, q, r = scaled(values, mirror[t], scale)
        low[t, 0], low[t, 1], low[t, 2] = a, b, c
        low[t, 4], low[t, 5], low[t, 6] = d, e, f
        low[t, 8], low[t, 9], low[t, 10] = p, q, r
    return True


@device
def scaled(values: Any, block: Any, scale: Any) -> Any:
    """The nine numbers of a block, read before any is written: so they can be vectors of the processor."""
    k = np.uint64(block)
    a, b, c = scale * values[k, 0], scale * values[k, 1], scale * values[k, 2]
    d, e, f = scale * values[k, 3], scale * values[k, 4], scale * values[k, 5]
    return a, b, c, d, e, f, scale * values[k, 6], scale * values[k, 7], scale * values[k, 8]


@device
def row_times(starts: Any, columns: Any, values: Any, i: Any, x: Any) -> Any:
    """A row of blocks times x."""
    s0 = s1 = s2 = s3 = np.float32(0.0)
    for s in range(starts[i], starts[i + np.uint64(1)]):
        k = np.uint64(s)  # unsigned: no index counts from the end
        j = np.uint64(columns[k])
        x0, x1, x2 = x[j, 0], x[j, 1], x[j, 2]
        s0 += values[k, 0] * x0 + values[k, 4] * x1 + values[k, 8] * x2
        s1 += values[k, 1] * x0 + values[k, 5] * x1 + values[k, 9] * x2
        s2 += values[k, 2] * x0 + values[k, 6] * x1 + values[k, 10] * x2
        s3 += values[k, 3] * x0 + values[k, 7] * x1 + values[k, 11] * x2
    return s0, s1, s2, s3


@device
def put(inverse: Any, i: Any, r0: Any, r1: Any, r2: Any, x: Any) -> None:
    """x of a row = its inverse block times r."""
    x[i, 0] = inverse[i, 0] * r0 + inverse[i, 4] * r1 + inverse[i, 8] * r2
    x[i, 1] = inverse[i, 1] * r0 + inverse[i, 5] * r1 + inverse[i, 9] * r2
    x[i, 2] = inverse[i, 2] * r0 + inverse[i, 6] * r1 + inverse[i, 10] * r2
    x[i, 3] = inverse[i, 3] * r0 + inverse[i, 7] * r1 + inverse[i, 11] * r2


def descend(  # type: ignore[no-untyped-def]
    starts, columns, high, low_starts, low_columns, low, inverse, b, x, p_starts, p_columns, p_values, coarse
):
    """One Gauss-Seidel sweep from x = 0, rows in order, for which only what is before the diagonal counts; then
    coarse = P^T (b - A x), where what is before and on the diagonal has cancelled already."""
    for row in range(starts.shape[0] - 1):
        i = np.uint64(row)
        s0, s1, s2, _ = row_times(low_starts, low_columns, low, i, x)
        put(inverse, i, np.float32(b[i, 0]) - s0, np.float32(b[i, 1]) - s1, np.float32(b[i, 2]) - s2, x)
    coarse[:] = 0.0
    for row in range(starts.shape[0] - 1):
        i = np.uint64(row)
        s0, s1, s2, s3 = row_times(starts, columns, high, i, x)
        for s in range(p_starts[i], p_starts[i + np.uint64(1)]):
            j, p = np.uint64(p_columns[np.uint64(s)]), p_values[np.uint64(s)]
            coarse[j, 0] -= p * s0
            coarse[j, 1] -= p * s1
            coarse[j, 2] -= p * s2
            coarse[j, 3] -= p * s3


def ascend(  # type: ignore[no-untyped-def]
    starts, columns, high, low_starts, low_columns, low, inverse, b, x, p_starts, p_columns, p_values, coarse
):
    """x += P coarse; then one Gauss-Seidel sweep, rows from the last to the first."""
    for row in range(p_starts.shape[0] - 1):
        i = np.uint64(row)
        x0, x1, x2, x3 = x[i, 0], x[i, 1], x[i, 2], x[i, 3]
        for s in range(p_starts[i], p_starts[i + np.uint64(1)]):
            j, p = np.uint64(p_columns[np.uint64(s)]), p_values[np.uint64(s)]
            x0 += p * coarse[j, 0]
            x1 += p * coarse[j, 1]
            x2 += p * coarse[j, 2]
            x3 += p * coarse[j, 3]
        x[i, 0], x[i, 1], x[i, 2], x[i, 3] = x0, x1, x2, x3
    for row in range(starts.shape[0] - 2, -1, -1):
        i = np.uint64(row)
        s0, s1, s2, _ = row_times(low_starts, low_columns, low, i, x)
        t0, t1, t2, _ = row_times(starts, columns, high, i, x)
        r0, r1, r2 = np.float32(b[i, 0]), np.float32(b[i, 1]), np.float32(b[i, 2])
        put(inverse, i, r0 - s0 - t0, r1 - s1 - t1, r2 - s2 - t2, x)


def find_products(  # type: ignore[no-untyped-def]
    starts, columns, low_starts, low_columns, mirror, p_starts, p_columns, p_values, r_starts, r_rows, r_values,
    c_starts, c_columns, place, ends, blocks, weights,
):  # fmt: skip
    """What `coarsen` sums: for each block of the coarse pattern the fine ones and their weights, first those as they
    are, then those turned over. `ends` (2 k,) comes as where each sum begins and goes as where it ends; without room
    for blocks, the lengths are added to it. `place` (coarse rows,) is for notes."""
    counted = blocks.shape[0] == 0
    for row in range(c_starts.shape[0] - 1):
        for s in range(c_starts[row], c_starts[row + 1]):
            place[c_columns[s]] = 2 * s
        for t in range(r_starts[row], r_starts[row + 1]):
            i = np.uint64(r_rows[t])
            below = low_starts[i + np.uint64(1)] - low_starts[i]
            for s in range(below + starts[i + np.uint64(1)] - starts[i]):
                turned = s < below
                block = np.uint64(mirror[low_starts[i] + s] if turned else starts[i] + s - below)
                j = np.uint64(low_columns[low_starts[i] + s] if turned else columns[block])
                for u in range(p_starts[j + np.uint64(1)] - 1, p_starts[j] - 1, -1):
                    column = p_columns[np.uint64(u)]
                    if column < row:
                        break  # they are sorted
                    q = np.uint64(place[np.uint64(column)] + turned)
                    if not counted:
                        k = np.uint64(ends[q])
                        blocks[k] = block
                        weights[k] = np.float64(r_values[t]) * p_values[np.uint64(u)]
                    ends[q] += 1


def coarsen(values, ends, blocks, weights, coarse):  # type: ignore[no-untyped-def]
    """The coarse blocks P^T A P, of what `find_products` has found."""
    t = np.uint64(0)
    for row in range(coarse.shape[0]):
        q = np.uint64(row)
        a = b = c = d = e = f = g = h = i = 0.0
        for turned in range(2):
            end = np.uint64(ends[np.uint64(2 * row + turned)])
            while t < end:
                k, weight = np.uint64(blocks[t]), weights[t]
                a += weight * values[k, 0]
                b += weight * values[k, 1]
                c += weight * values[k, 2]
                d += weight * values[k, 3]
                e += weight * values[k, 4]
                f += weight * values[k, 5]
                g += weight * values[k, 6]
                h += weight * values[k, 7]
                i += weight * values[k, 8]
                t += np.uint64(1)
            b, c, d, f, g, h = d, g, b, h, c, f
        coarse[q, 0], coarse[q, 1], coarse[q, 2] = a, b, c
        coarse[q, 3], coarse[q, 4], coarse[q, 5] = d, e, f
        coarse[q, 6], coarse[q, 7], coarse[q, 8] = g, h, i


def multiply(starts, columns, values, x, y):  # type: ignore[no-untyped-def]
    """y = A x; returns x . y."""
    y[:] = 0.0
    total = 0.0
    for row in range(starts.shape[0] - 1):
        i, k = np.uint64(row), np.uint64(starts[row])
        x0, x1, x2 = x[i, 0], x[i, 1], x[i, 2]
        d0 = values[k, 0] * x0 + values[k, 1] * x1 + values[k, 2] * x2
        d1 = values[k, 3] * x0 + values[k, 4] * x1 + values[k, 5] * x2
        d2 = values[k, 6] * x0 + values[k, 7] * x1 + values[k, 8] * x2
        s0 = s1 = s2 = 0.0
        for s in range(starts[row] + 1, starts[row + 1]):
            k = np.uint64(s)
            j = np.uint64(columns[k])
            s0 += values[k, 0] * x[j, 0] + values[k, 1] * x[j, 1] + values[k, 2] * x[j, 2]
            s1 += values[k, 3] * x[j, 0] + values[k, 4] * x[j, 1] + values[k, 5] * x[j, 2]
            s2 += values[k, 6] * x[j, 0] + values[k, 7] * x[j, 1] + values[k, 8] * x[j, 2]
            y[j, 0] += values[k, 0] * x0 + values[k, 3] * x1 + values[k, 6] * x2
            y[j, 1] += values[k, 1] * x0 + values[k, 4] * x1 + values[k, 7] * x2
            y[j, 2] += values[k, 2] * x0 + values[k, 5] * x1 + values[k, 8] * x2
        y[i, 0] += d0 + s0
        y[i, 1] += d1 + s1
        y[i, 2] += d2 + s2
        total += x0 * (d0 + 2.0 * s0) + x1 * (d1 + 2.0 * s1) + x2 * (d2 + 2.0 * s2)
    return total


def dot(x, y):  # type: ignore[no-untyped-def]
    """x . y over flat vectors."""
    total = 0.0
    for i in range(x.shape[0]):
        for c in range(3):
            total += x[i, c] * np.float64(y[i, c])
    return total


def go_along(x, r, p, q, length):  # type: ignore[no-untyped-def]
    """x += length p, r -= length q; returns r . r."""
    total = 0.0
    for i in range(x.shape[0]):
        for c in range(3):
            x[i, c] += length * p[i, c]
            r[i, c] -= length * q[i, c]
            total += r[i, c] * r[i, c]
    return total


def turn(p, z, part):  # type: ignore[no-untyped-def]
    """p = z + part p."""
    for i in range(p.shape[0]):
        for c in range(3):
            p[i, c] = np.float64(z[i, c]) + part * p[i, c]


def factor(matrix):  # type: ignore[no-untyped-def]
    """The Cholesky factor of a dense matrix, written into its lower triangle; False if it is not positive definite.

    An unsupported part has no stiffness but for rounding, by which single precision must not be divided: it is held.
    (`profile_cholesky` rejects such a matrix.)
    """
    least = 0.0
    for i in range(matrix.shape[0]):
        least = max(least, 1e-10 * matrix[i, i])
    for i in range(matrix.shape[0]):
        for j in range(i + 1):
            total = matrix[i, j]
            for k in range(j):
                total -= matrix[i, k] * matrix[j, k]
            if i > j:
                matrix[i, j] = total / matrix[j, j]
            elif total > least:
                matrix[i, i] = np.sqrt(total)
            elif total >= -least:
                matrix[i, i] = np.inf
            else:
                return False
    return True


def solve_factored(lower, b, y, x):  # type: ignore[no-untyped-def]
    """x (n, 4) of L L^T x = b (n, 3 or 4); `y` (3 n,) is for notes."""
    n = y.shape[0]
    for i in range(n):
        total = np.float64(b[i // 3, i % 3])
        for k in range(i):
            total -= lower[i, k] * y[k]
        y[i] = total / lower[i, i]
    for i in range(n - 1, -1, -1):
        y[i] /= lower[i, i]
        for k in range(i):
            y[k] -= lower[i, k] * y[i]
        x[i // 3, i % 3] = y[i]
