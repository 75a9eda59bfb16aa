"""Conjugate gradients on a tangent of blocks, preconditioned by a multigrid cycle.

The loop is separate from that of `scalar_cg`: it handles negative curvature, and can end at the accuracy that `Steps`
estimates.
Source: Hestenes and Stiefel 1952; truncated at negative curvature as in Steihaug, SIAM J. Numer. Anal. 20 (1983) 626.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from hookean.compiled import dispatch
from hookean.linear import block_kernels as sums
from hookean.linear.block_hierarchy import Hierarchy

Floats = NDArray[np.float64]


LEAST = 4  # steps before which nothing is concluded of a tangent that may be soft anywhere
SETTLED = 0.2  # the last third of the steps may add this part of the energy at most


@dataclass
class Steps:
    """What steps of conjugate gradients say: whether x has `settled`, so that its largest part is right within a factor
    of 3; and by their lengths and turns the Ritz values of the preconditioned matrix.

    Source: Strakos and Tichy, "On error estimation in the conjugate gradient method", 2002; Golub and Van Loan, Matrix
    Computations, 2013, 11.3.
    """

    least: int = LEAST  # steps before which nothing is concluded
    energies: list[float] = field(default_factory=list)
    lengths: list[float] = field(default_factory=list)
    turns: list[float] = field(default_factory=list)

    def note(self, length: float, turn: float, falls: float) -> None:
        """Note a step."""
        self.lengths.append(length)
        self.turns.append(turn)
        self.energies.append(length * falls + (self.energies[-1] if self.energies else 0.0))

    @property
    def settled(self) -> bool:
        """Whether the last third of the steps added little to the energy of x."""
        k = len(self.energies)
        return k >= self.least and self.energies[-1] - self.energies[2 * k // 3 - 1] <= SETTLED * self.energies[-1]

    def softness(self) -> float:
        """The lowest Ritz value by the highest: 1 where the preconditioner is as good as the inverse."""
        a, b = 1.0 / np.array(self.lengths), np.array(self.turns)
        values = np.linalg.eigvalsh(np.diag(a + np.append(0.0, b[1:] * a[:-1])) + _off(np.sqrt(b[1:]) * a[:-1]))
        return float(values[0] / values[-1])


def _off(values: Floats) -> Floats:
    return np.asarray(np.diag(values, 1) + np.diag(values, -1))


def solve(
    hierarchy: Hierarchy, b: Floats, part: float, most: int, steps: Steps | None = None
) -> tuple[Floats | None, int, bool]:
    """x (n, 3) with |b - A x| <= part |b|, or after `most` steps; the steps taken; and whether A was positive in all of
    their directions. The first in which it is not is the last: x goes along it as far as if it bent the other way.
    x is None where the cycle is not positive. With `steps`, which notes them, it ends where x has settled."""
    finest = hierarchy.levels[0]
    matrix = (finest.starts, finest.columns, finest.values)
    multiply, dot, turn, go_along = (dispatch.compiled(f) for f in (sums.multiply, sums.dot, sums.turn, sums.go_along))
    size = float(np.abs(b).max(initial=0.0))
    if size == 0.0:
        return np.zeros_like(b), 0, True
    r = b / size  # cycles are in single precision: a small b would vanish
    x, p, q = np.zeros_like(b), np.zeros_like(b), np.empty_like(b)
    goal, before, step = part * part * dot(r, r), np.inf, 0
    for step in range(1, most + 1):
        z = hierarchy.cycle(r)
        falls = dot(r, z)
        turned = falls / before
        turn(p, z, turned)
        before, bends = falls, multiply(*matrix, p, q)
        if not (0.0 < falls < np.inf and 0.0 < abs(bends) < np.inf):
            return None, step, False
        left = go_along(x, r, p, q, falls / abs(bends))
        if bends < 0.0:
            return size * x, step, False
        if steps is not None:
            steps.note(falls / bends, turned, falls)
            if steps.settled:
                break
        if left <= goal:
            break
    return size * x, step, True
