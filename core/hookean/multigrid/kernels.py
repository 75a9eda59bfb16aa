"""The sums of a multigrid cycle and of conjugate gradients on blocks of 3 x 3, each in one pass over memory.

Blocks are rows of nine numbers: (k, 9). Vectors are (n, 3). Everything is summed in one fixed order.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from hookean.kernels import device


def invert_diagonal(diagonal, values, inverse):  # type: ignore[no-untyped-def]
    """Inverses of the diagonal blocks; False where one is not positive definite. An axis without stiffness, which is
    held or on which nothing pulls, stays where it is: zero in the inverse."""
    for i in range(diagonal.shape[0]):
        m = values[diagonal[i]]
        b, c, e = m[3], m[6], m[7]
        a = m[0] if m[0] != 0.0 else 1.0
        d = m[4] if m[4] != 0.0 else 1.0
        f = m[8] if m[8] != 0.0 else 1.0
        p, q, r = d * f - e * e, c * e - b * f, b * e - c * d
        determinant = a * p + b * q + c * r
        if not (a > 0.0 and a * d - b * b > 0.0 and determinant > 0.0):
            return False
        scale = 1.0 / determinant
        inverse[i, 0] = p * scale if m[0] != 0.0 else 0.0
        inverse[i, 1] = inverse[i, 3] = q * scale
        inverse[i, 2] = inverse[i, 6] = r * scale
        inverse[i, 4] = (a * f - c * c) * scale if m[4] != 0.0 else 0.0
        inverse[i, 5] = inverse[i, 7] = (b * c - a * e) * scale
        inverse[i, 8] = (a * d - b * b) * scale if m[8] != 0.0 else 0.0
    return True


@device
def row_times(columns: Any, values: Any, first: Any, last: Any, x: Any) -> Any:
    """The sum of the blocks `first` to `last` of a row times x."""
    s0 = s1 = s2 = 0.0
    for s in range(first, last):
        k = np.uint64(s)  # unsigned: no index counts from the end
        j = np.uint64(columns[k])
        x0, x1, x2 = x[j, 0], x[j, 1], x[j, 2]
        s0 += values[k, 0] * x0 + values[k, 1] * x1 + values[k, 2] * x2
        s1 += values[k, 3] * x0 + values[k, 4] * x1 + values[k, 5] * x2
        s2 += values[k, 6] * x0 + values[k, 7] * x1 + values[k, 8] * x2
    return s0, s1, s2


@device
def put(inverse: Any, i: Any, r0: Any, r1: Any, r2: Any, x: Any) -> None:
    """x of a row = its inverse block times r."""
    x[i, 0] = inverse[i, 0] * r0 + inverse[i, 1] * r1 + inverse[i, 2] * r2
    x[i, 1] = inverse[i, 3] * r0 + inverse[i, 4] * r1 + inverse[i, 5] * r2
    x[i, 2] = inverse[i, 6] * r0 + inverse[i, 7] * r1 + inverse[i, 8] * r2


def multiply(starts, columns, values, x, y):  # type: ignore[no-untyped-def]
    """y = A x; returns x . y."""
    total = 0.0
    for i in range(starts.shape[0] - 1):
        s0, s1, s2 = row_times(columns, values, starts[i], starts[i + 1], x)
        y[i, 0], y[i, 1], y[i, 2] = s0, s1, s2
        total += x[i, 0] * s0 + x[i, 1] * s1 + x[i, 2] * s2
    return total


def smooth_down(starts, columns, values, diagonal, inverse, b, x):  # type: ignore[no-untyped-def]
    """One Gauss-Seidel sweep from x = 0, rows in order: only what is before the diagonal counts."""
    for i in range(starts.shape[0] - 1):
        s0, s1, s2 = row_times(columns, values, starts[i], diagonal[i], x)
        put(inverse, i, b[i, 0] - s0, b[i, 1] - s1, b[i, 2] - s2, x)


def smooth_up(starts, columns, values, diagonal, inverse, b, x):  # type: ignore[no-untyped-def]
    """One Gauss-Seidel sweep, rows from the last to the first."""
    for i in range(starts.shape[0] - 2, -1, -1):
        s0, s1, s2 = row_times(columns, values, starts[i], diagonal[i], x)
        t0, t1, t2 = row_times(columns, values, diagonal[i] + 1, starts[i + 1], x)
        put(inverse, i, b[i, 0] - s0 - t0, b[i, 1] - s1 - t1, b[i, 2] - s2 - t2, x)


def restrict(starts, columns, values, diagonal, x, p_starts, p_columns, p_values, coarse):  # type: ignore[no-untyped-def]
    """coarse = P^T (b - A x) after `smooth_down`: what is before and on the diagonal has cancelled already."""
    coarse[:] = 0.0
    for i in range(starts.shape[0] - 1):
        s0, s1, s2 = row_times(columns, values, diagonal[i] + 1, starts[i + 1], x)
        for s in range(p_starts[i], p_starts[i + 1]):
            j, p = p_columns[s], p_values[s]
            coarse[j, 0] -= p * s0
            coarse[j, 1] -= p * s1
            coarse[j, 2] -= p * s2


def prolong(p_starts, p_columns, p_values, coarse, x):  # type: ignore[no-untyped-def]
    """x += P coarse."""
    for i in range(p_starts.shape[0] - 1):
        for s in range(p_starts[i], p_starts[i + 1]):
            j, p = p_columns[s], p_values[s]
            x[i, 0] += p * coarse[j, 0]
            x[i, 1] += p * coarse[j, 1]
            x[i, 2] += p * coarse[j, 2]


def coarsen(  # type: ignore[no-untyped-def]
    starts, columns, values, p_starts, p_columns, p_values, r_starts, r_rows, r_values, c_starts, c_columns, c_values,
    mirror, place, total,
):  # fmt: skip
    """The coarse blocks P^T A P, row by row: those from the diagonal on are summed, the others are their mirrors.

    `place` (coarse rows,) and `total` (longest row, 9) are for notes; `mirror` (blocks,) tells where a block's is.
    """
    for row in range(c_starts.shape[0] - 1):
        first, last = c_starts[row], c_starts[row + 1]
        for s in range(first, last):
            place[c_columns[s]] = s - first
            for c in range(9):
                total[s - first, c] = 0.0
        for t in range(r_starts[row], r_starts[row + 1]):
            i, r = r_rows[t], r_values[t]
            for s in range(starts[i], starts[i + 1]):
                j = columns[s]
                for u in range(p_starts[j], p_starts[j + 1]):
                    column = p_columns[u]
                    if column >= row:
                        q, k = np.uint64(place[column]), np.uint64(s)
                        weight = r * p_values[u]
                        for c in range(9):
                            total[q, c] += weight * values[k, c]
        for s in range(first, last):
            if c_columns[s] >= row:
                other = mirror[s]
                for a in range(3):
                    for b in range(3):
                        c_values[s, 3 * a + b] = total[s - first, 3 * a + b]
                        if other != s:
                            c_values[other, 3 * b + a] = total[s - first, 3 * a + b]


def dot(x, y):  # type: ignore[no-untyped-def]
    """x . y over flat vectors."""
    total = 0.0
    for i in range(x.shape[0]):
        for c in range(3):
            total += x[i, c] * y[i, c]
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
            p[i, c] = z[i, c] + part * p[i, c]


def factor(matrix):  # type: ignore[no-untyped-def]
    """The Cholesky factor of a dense matrix, written into its lower triangle; False if it is not positive definite."""
    for i in range(matrix.shape[0]):
        for j in range(i + 1):
            total = matrix[i, j]
            for k in range(j):
                total -= matrix[i, k] * matrix[j, k]
            if i > j:
                matrix[i, j] = total / matrix[j, j]
            elif total > 0.0:
                matrix[i, i] = np.sqrt(total)
            else:
                return False
    return True


def solve_factored(lower, b, x):  # type: ignore[no-untyped-def]
    """x of L L^T x = b."""
    n = b.shape[0]
    for i in range(n):
        total = b[i]
        for k in range(i):
            total -= lower[i, k] * x[k]
        x[i] = total / lower[i, i]
    for i in range(n - 1, -1, -1):
        x[i] /= lower[i, i]
        for k in range(i):
            x[k] -= lower[i, k] * x[i]
