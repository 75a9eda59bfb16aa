"""Conjugate gradients on the tangent of a shape, without a matrix: forces a little further along a direction tell how
they change. Works for all forces; a dozen steps are enough to say how far a shape is from where it will rest.

Source: Hestenes and Stiefel, "Methods of conjugate gradients for solving linear systems", 1952; Strakos and Tichy, "On
error estimation in the conjugate gradient method", 2002, for what the steps tell of the error.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from hookean import kernels
from hookean.balance import Balance, extents
from hookean.kernels import device, forces
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
    x, free, r, weights, *rest = Desk().lay(
        n, state.x, free, found.forces * free, np.broadcast_to(weights[:, None], (n, 3)), *[None] * 7
    )
    reach = FURTHER * float(extents(system, state).mean()) * n**0.5
    done = kernels.compiled(conjugate_loop)(own.packed, x, free, r, weights, *rest, np.zeros(n), np.zeros(MOST), reach)
    moved = rest[2]
    return np.ascontiguousarray(moved[:, :3]) if done > 0 else None


@device
def product(p: Any, q: Any) -> Any:
    """The sum of products of two arrays (n, 4), column by column."""
    s0, s1, s2, s3 = 0.0, 0.0, 0.0, 0.0
    for i in range(p.shape[0]):
        s0 += p[i, 0] * q[i, 0]
        s1 += p[i, 1] * q[i, 1]
        s2 += p[i, 2] * q[i, 2]
        s3 += p[i, 3] * q[i, 3]
    return (s0 + s1) + (s2 + s3)


def conjugate_loop(  # type: ignore[no-untyped-def]
    packed, x, free, r, weights, still, z, moved, p, y, f, base, w, energies, reach
):
    """Steps until the solution has settled: how many; 0 where a direction bends down, or they are too many."""
    size = x.size
    flat_x, flat_free, flat_r, flat_z = x.reshape(size), free.reshape(size), r.reshape(size), z.reshape(size)
    flat_moved, flat_p, flat_y = moved.reshape(size), p.reshape(size), y.reshape(size)
    flat_f, flat_base, flat_weights = f.reshape(size), base.reshape(size), weights.reshape(size)
    forces(packed, x, still, base, w)
    for i in range(size):
        flat_z[i] = flat_r[i] * flat_weights[i]
    falls = product(r, z)
    turn, energy = 0.0, 0.0
    for k in range(energies.shape[0]):
        for i in range(size):
            flat_p[i] = flat_z[i] + turn * flat_p[i]
        along = product(p, p)
        if along == 0.0:
            return k + 1
        scale = reach / np.sqrt(along)
        for i in range(size):
            flat_y[i] = flat_x[i] + scale * flat_p[i]
            flat_f[i] = -flat_base[i]
        forces(packed, y, still, f, w)
        scale = -1.0 / scale
        for i in range(size):
            flat_f[i] *= flat_free[i] * scale
        bends = product(p, f)
        if not bends > 0.0:
            return 0
        along, before = falls / bends, falls
        energy += along * falls
        energies[k] = energy
        for i in range(size):
            flat_moved[i] += along * flat_p[i]
            flat_r[i] -= along * flat_f[i]
            flat_z[i] = flat_r[i] * flat_weights[i]
        falls = product(r, z)
        turn = falls / before
        if k + 1 >= LEAST and energy - energies[2 * (k + 1) // 3 - 1] <= SETTLED * energy:
            return k + 1
    return 0
