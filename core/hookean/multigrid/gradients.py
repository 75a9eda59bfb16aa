"""Conjugate gradients with a multigrid cycle before each step.

Source: Hestenes and Stiefel 1952; truncated at negative curvature as in Steihaug, SIAM J. Numer. Anal. 20 (1983) 626.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hookean import kernels
from hookean.multigrid import kernels as sums
from hookean.multigrid.hierarchy import Hierarchy

Floats = NDArray[np.float64]


def solve(hierarchy: Hierarchy, b: Floats, part: float, most: int) -> tuple[Floats | None, int, bool]:
    """x (n, 3) with |b - A x| <= part |b|, or after `most` steps; the steps taken; and whether A was positive in all of
    their directions. The first in which it is not is the last: x goes along it as far as if it bent the other way.
    x is None where the cycle is not positive."""
    finest = hierarchy.levels[0]
    matrix = (finest.starts, finest.columns, finest.values)
    multiply, dot, turn, go_along = (kernels.compiled(f) for f in (sums.multiply, sums.dot, sums.turn, sums.go_along))
    size = float(np.abs(b).max(initial=0.0))
    if size == 0.0:
        return np.zeros_like(b), 0, True
    r = b / size  # cycles are in single precision: a small b would vanish
    x, p, q = np.zeros_like(b), np.zeros_like(b), np.empty_like(b)
    goal, before, step = part * part * dot(r, r), np.inf, 0
    for step in range(1, most + 1):
        z = hierarchy.cycle(r)
        falls = dot(r, z)
        turn(p, z, falls / before)
        before, bends = falls, multiply(*matrix, p, q)
        if not (0.0 < falls < np.inf and 0.0 < abs(bends) < np.inf):
            return None, step, False
        left = go_along(x, r, p, q, falls / abs(bends))
        if bends < 0.0:
            return size * x, step, False
        if left <= goal:
            break
    return size * x, step, True
