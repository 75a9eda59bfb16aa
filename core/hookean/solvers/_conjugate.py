"""Conjugate gradients on the tangent of a shape, without a matrix: forces a little further along a direction tell how
they change. Works for all forces; a dozen steps are enough to say how far a shape is from where it will rest.

Source: Hestenes and Stiefel, "Methods of conjugate gradients for solving linear systems", 1952; Strakos and Tichy, "On
error estimation in the conjugate gradient method", 2002, for what the steps tell of the error.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from hookean import kernels
from hookean.balance import Balance
from hookean.kernels import forces
from hookean.lean import Desk, lean

if TYPE_CHECKING:
    from hookean.state import State
    from hookean.system import System

Floats = NDArray[np.float64]

LEAST = 12  # steps before which nothing is concluded
SETTLED = 0.2  # the last third of the steps may add this part of the energy at most
MOST = 300  # steps
FURTHER = 1e-5  # of the elements' extent, to see how forces change


def movement(system: System, state: State, free: Floats, found: Balance) -> Floats | None:
    """About K^-1 r (n, 3) [length], r what is out of balance and K the tangent of a shape, on the axes with `free`
    (n, 3) above 0; right within a factor of 3 where it is largest. None where that takes too many steps, or K is not
    positive."""
    n = len(state.x)
    own = lean(system, state, damped=False)
    weights = np.divide(1.0, found.stiffness, out=np.zeros(n), where=found.stiffness > 0.0)
    x, free, r, still, moved, p, y, f, base = Desk().lay(n, state.x, free, found.forces * free, *[None] * 6)
    reach = FURTHER * float(found.extent.mean())
    done = kernels.compiled(conjugate_loop)(
        own.packed, x, free, r, still, moved, p, y, f, base, np.zeros(n), weights, np.zeros(MOST), reach
    )
    return np.ascontiguousarray(moved[:, :3]) if done > 0 else None


def conjugate_loop(  # type: ignore[no-untyped-def]
    packed, x, free, r, still, moved, p, y, f, base, w, weights, energies, reach
):
    """Steps until the solution has settled: how many; 0 where a direction bends down, or they are too many."""
    n = x.shape[0]
    forces(packed, x, still, base, w)
    falls = 0.0
    for i in range(n):
        for c in range(4):
            falls += r[i, c] * r[i, c] * weights[i]
    turn, energy = 0.0, 0.0
    for k in range(energies.shape[0]):
        largest = 0.0
        for i in range(n):
            for c in range(4):
                p[i, c] = r[i, c] * weights[i] + turn * p[i, c]
                largest = max(largest, abs(p[i, c]))
        if largest == 0.0:
            return k + 1
        scale = reach / largest
        for i in range(n):
            for c in range(4):
                y[i, c] = x[i, c] + scale * p[i, c]
                f[i, c] = -base[i, c]
        forces(packed, y, still, f, w)
        bends = 0.0
        for i in range(n):
            for c in range(4):
                f[i, c] *= -free[i, c] / scale
                bends += p[i, c] * f[i, c]
        if not bends > 0.0:
            return 0
        along, before = falls / bends, falls
        energy += along * falls
        energies[k] = energy
        falls = 0.0
        for i in range(n):
            for c in range(4):
                moved[i, c] += along * p[i, c]
                r[i, c] -= along * f[i, c]
                falls += r[i, c] * r[i, c] * weights[i]
        turn = falls / before
        if k + 1 >= LEAST and energy - energies[2 * (k + 1) // 3 - 1] <= SETTLED * energy:
            return k + 1
    return 0
