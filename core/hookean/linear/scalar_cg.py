"""Conjugate gradients on a net of springs of rest length 0, preconditioned by a multigrid cycle.

The axes are three right-hand sides, each with its own step lengths. The loop is separate from that of `block_cg` for
speed: one pass over memory updates the direction, multiplies by the matrix and sums the dot products. It needs no test
for negative curvature.
Source: Hestenes and Stiefel, "Methods of conjugate gradients for solving linear systems", 1952.
"""

from __future__ import annotations

import numpy as np

from hookean.compiled import dispatch
from hookean.linear.laplacian import Floats
from hookean.linear.scalar_hierarchy import Hierarchy, row_times

MOST = 300  # steps


def solve(hierarchy: Hierarchy, b: Floats, goal: float) -> Floats | None:
    """x (n, 4) with |b - A x| <= `goal` in each column; None if a part is unsupported, or so many steps do not
    do. `b` (n, 4) is what is left of it afterwards."""
    if not hierarchy.held:
        return None
    onward, go_on = dispatch.compiled(turn), dispatch.compiled(go_along)
    finest = hierarchy.levels[0]
    x, p, q = np.zeros_like(b), np.zeros_like(b), np.empty_like(b)
    falls, dots = np.zeros(4), np.zeros(4)
    for _ in range(MOST):
        z, now = hierarchy.cycle(b)
        onward(*finest.rows, finest.farthest, z, _parts(now, falls), p, q, dots)
        falls = now
        go_on(x, b, p, q, _parts(falls, dots), dots)
        if not np.sqrt(dots.max()) > goal:
            return x if np.isfinite(x).all() else None
    return None


def _parts(some: Floats, whole: Floats) -> Floats:
    """Quotients; 0 where there is nothing left to share."""
    found: Floats = np.divide(some, whole, out=np.zeros(4), where=whole > 0.0)
    return found


def turn(starts, columns, values, diagonal, farthest, z, part, p, q, dots):  # type: ignore[no-untyped-def]
    """p = z + part p, q = A p, dots = p . q."""
    a0, a1, a2, a3 = part[0], part[1], part[2], part[3]
    t0 = t1 = t2 = t3 = 0.0
    ahead = -1
    for i in range(diagonal.shape[0]):
        while ahead < farthest[i]:
            ahead += 1
            p[ahead, 0] = z[ahead, 0] + a0 * p[ahead, 0]
            p[ahead, 1] = z[ahead, 1] + a1 * p[ahead, 1]
            p[ahead, 2] = z[ahead, 2] + a2 * p[ahead, 2]
            p[ahead, 3] = z[ahead, 3] + a3 * p[ahead, 3]
        s0, s1, s2, s3 = row_times(columns, values, starts[i], starts[i + 1], p)
        q[i, 0], q[i, 1], q[i, 2], q[i, 3] = s0, s1, s2, s3
        t0 += p[i, 0] * s0
        t1 += p[i, 1] * s1
        t2 += p[i, 2] * s2
        t3 += p[i, 3] * s3
    dots[0], dots[1], dots[2], dots[3] = t0, t1, t2, t3


def go_along(x, r, p, q, length, dots):  # type: ignore[no-untyped-def]
    """x += length p, r -= length q; dots = r . r."""
    a0, a1, a2, a3 = length[0], length[1], length[2], length[3]
    t0 = t1 = t2 = t3 = 0.0
    for i in range(x.shape[0]):
        x[i, 0] += a0 * p[i, 0]
        x[i, 1] += a1 * p[i, 1]
        x[i, 2] += a2 * p[i, 2]
        x[i, 3] += a3 * p[i, 3]
        r0 = r[i, 0] - a0 * q[i, 0]
        r1 = r[i, 1] - a1 * q[i, 1]
        r2 = r[i, 2] - a2 * q[i, 2]
        r3 = r[i, 3] - a3 * q[i, 3]
        r[i, 0], r[i, 1], r[i, 2], r[i, 3] = r0, r1, r2, r3
        t0 += r0 * r0
        t1 += r1 * r1
        t2 += r2 * r2
        t3 += r3 * r3
    dots[0], dots[1], dots[2], dots[3] = t0, t1, t2, t3
