"""Conjugate gradients on the tangent of a net of springs at rest: some dozen steps are enough to say how far it is from
where it will rest exactly.

Each particle's own block of the tangent, inverted, takes out what is stiff along and soft across a net. The loop is
separate from that of `block_cg` for speed: it is compiled as a whole, because calls from Python would take longer than
the sums of a small net, and one pass over the particles updates, preconditions and sums.
Source: Hestenes and Stiefel, "Methods of conjugate gradients for solving linear systems", 1952; Strakos and Tichy, "On
error estimation in the conjugate gradient method", 2002, for the error after each step.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from hookean.compiled import dispatch
from hookean.compiled.marks import device
from hookean.forces.anchor_spring import AnchorSpring, slides
from hookean.system.balance import Balance

if TYPE_CHECKING:
    from hookean.system.state import State
    from hookean.system.system import System

Floats = NDArray[np.float64]

LEAST = 12  # steps before which nothing is concluded
SETTLED = 0.1  # the last third of the steps may add this part of the energy at most
MOST = 300  # steps
SOFTEST = 1e-12  # determinant of a block of size 1 below which it counts as singular


def movement(system: System, state: State, free: Floats, found: Balance) -> Floats | None:
    """About K^-1 r (n, 3) [length], r what is out of balance and K the tangent of a shape, on the axes with `free`
    (n, 3) above 0; right within a factor of 3 where it is largest. None where that takes too many steps, K is not
    positive, or some force is neither central nor constant."""
    n = len(state.x)
    fixed = np.zeros(n)
    indices: list[NDArray[np.int64]] = []
    stiffness: list[Floats] = []
    for group, memory in zip(system.groups, state.memory, strict=True):
        b = group.block
        if group.cls is AnchorSpring and not slides(b):
            fixed += np.bincount(b.indices[:, 0], b.parameters[:, 0], n)
        elif group.cls.central is not None:
            own = np.empty((len(b.indices), 5))
            dispatch.compiled(group.cls.central, "central")(state.x, b.indices, b.parameters, memory, own)
            indices.append(b.indices)
            stiffness.append(own)
        elif not group.cls.constant:
            return None
    if not indices:
        return None
    net = np.concatenate(indices), np.concatenate(stiffness)
    moved, r = np.zeros((n, 3)), found.forces * free
    room = np.zeros((n, 6)), np.empty((n, 3)), np.zeros((n, 3)), np.zeros((n, 3))
    done = dispatch.compiled(conjugate_loop)(*net, fixed, free, r, moved, *room, np.zeros(MOST))
    return moved if done > 0 else None


def conjugate_loop(  # type: ignore[no-untyped-def]
    indices, stiffness, fixed, free, r, moved, blocks, z, p, y, energies
):
    """Steps until the solution has settled: how many; 0 where a direction bends down, or they are too many. What is
    held has no block, and so no z and no p; what r becomes there counts for nothing."""
    own_blocks(indices, stiffness, fixed, free, blocks)
    falls, turn, energy = onward(0.0, blocks, p, y, moved, r, z), 0.0, 0.0
    for k in range(energies.shape[0]):
        if falls == 0.0:
            return k + 1
        for j in range(p.shape[0]):
            i = np.uint64(j)
            for c in range(3):
                p[i, c] = z[i, c] + turn * p[i, c]
                y[i, c] = fixed[i] * p[i, c]
        resist(indices, stiffness, p, y)
        bends = 0.0
        for j in range(p.shape[0]):
            i = np.uint64(j)
            bends += p[i, 0] * y[i, 0] + p[i, 1] * y[i, 1] + p[i, 2] * y[i, 2]
        if not bends > 0.0:
            return 0
        along, before = falls / bends, falls
        energy += along * falls
        energies[k] = energy
        falls = onward(along, blocks, p, y, moved, r, z)
        turn = falls / before
        if k + 1 >= LEAST and energy - energies[2 * (k + 1) // 3 - 1] <= SETTLED * energy:
            return k + 1
    return 0


@device
def onward(along: Any, blocks: Any, p: Any, y: Any, moved: Any, r: Any, z: Any) -> Any:
    """Go along p, which y resists, and solve all blocks z = r; returns the sum of z r."""
    total = 0.0
    for j in range(r.shape[0]):
        i = np.uint64(j)
        xy, xz, yz = blocks[i, 3], blocks[i, 4], blocks[i, 5]
        r0, r1, r2 = r[i, 0] - along * y[i, 0], r[i, 1] - along * y[i, 1], r[i, 2] - along * y[i, 2]
        z0 = blocks[i, 0] * r0 + xy * r1 + xz * r2
        z1 = xy * r0 + blocks[i, 1] * r1 + yz * r2
        z2 = xz * r0 + yz * r1 + blocks[i, 2] * r2
        m0, m1, m2 = moved[i, 0] + along * p[i, 0], moved[i, 1] + along * p[i, 1], moved[i, 2] + along * p[i, 2]
        moved[i, 0], moved[i, 1], moved[i, 2] = m0, m1, m2
        r[i, 0], r[i, 1], r[i, 2] = r0, r1, r2
        z[i, 0], z[i, 1], z[i, 2] = z0, z1, z2
        total += z0 * r0 + z1 * r1 + z2 * r2
    return total


@device
def resist(indices: Any, stiffness: Any, p: Any, y: Any) -> None:
    """Add what springs put against a motion p of their ends."""
    for j in range(indices.shape[0]):
        e = np.uint64(j)
        a, b = np.uint64(indices[e, 0]), np.uint64(indices[e, 1])
        across, n0, n1, n2 = stiffness[e, 1], stiffness[e, 2], stiffness[e, 3], stiffness[e, 4]
        d0, d1, d2 = p[b, 0] - p[a, 0], p[b, 1] - p[a, 1], p[b, 2] - p[a, 2]
        more = (stiffness[e, 0] - across) * (d0 * n0 + d1 * n1 + d2 * n2)
        f0, f1, f2 = across * d0 + more * n0, across * d1 + more * n1, across * d2 + more * n2
        y[a, 0] -= f0
        y[a, 1] -= f1
        y[a, 2] -= f2
        y[b, 0] += f0
        y[b, 1] += f1
        y[b, 2] += f2


@device
def own_blocks(indices: Any, stiffness: Any, fixed: Any, free: Any, blocks: Any) -> None:
    """The inverse of each particle's own block on its free axes, as xx, yy, zz, xy, xz, yz; zero where it has none."""
    for e in range(indices.shape[0]):
        across, n0, n1, n2 = stiffness[e, 1], stiffness[e, 2], stiffness[e, 3], stiffness[e, 4]
        more = stiffness[e, 0] - across
        for j in range(2):
            at = blocks[np.uint64(indices[e, j])]
            at[0] += across + more * n0 * n0
            at[1] += across + more * n1 * n1
            at[2] += across + more * n2 * n2
            at[3] += more * n0 * n1
            at[4] += more * n0 * n2
            at[5] += more * n1 * n2
    for i in range(blocks.shape[0]):
        size = (blocks[i, 0] + blocks[i, 1] + blocks[i, 2]) / 3.0 + fixed[i]
        u, v, w = free[i, 0] > 0.0, free[i, 1] > 0.0, free[i, 2] > 0.0
        if not (u or v or w) or not size > 0.0:
            blocks[i, :] = 0.0
            continue
        xx = (blocks[i, 0] + fixed[i]) / size if u else 1.0
        yy = (blocks[i, 1] + fixed[i]) / size if v else 1.0
        zz = (blocks[i, 2] + fixed[i]) / size if w else 1.0
        xy = blocks[i, 3] / size if u and v else 0.0
        xz = blocks[i, 4] / size if u and w else 0.0
        yz = blocks[i, 5] / size if v and w else 0.0
        first, second, third = yy * zz - yz * yz, xz * yz - xy * zz, xy * yz - xz * yy
        whole = xx * first + xy * second + xz * third
        if whole > SOFTEST:
            part = 1.0 / (whole * size)
            blocks[i, 0], blocks[i, 3], blocks[i, 4] = first * part, second * part, third * part
            blocks[i, 1], blocks[i, 2] = (xx * zz - xz * xz) * part, (xx * yy - xy * xy) * part
            blocks[i, 5] = (xy * xz - xx * yz) * part
        else:  # what its neighbours stiffen
            blocks[i, :3], blocks[i, 3:] = 1.0 / size, 0.0
        blocks[i, 0] *= free[i, 0]
        blocks[i, 1] *= free[i, 1]
        blocks[i, 2] *= free[i, 2]
