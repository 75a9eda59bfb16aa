"""The stiffness of a net of springs of rest length 0: the Laplacian of its graph, a number for each pair of particles.
Held particles and those without a spring have no row."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from hookean.compiled import dispatch
from hookean.forces.anchor_spring import AnchorSpring
from hookean.forces.springs import Springs

if TYPE_CHECKING:
    from hookean.system.system import System

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]


@dataclass(frozen=True)
class Laplacian:
    """Rows as in a compressed sparse matrix: `columns` and `values` from `starts` (n + 1,) on, first those before the
    diagonal, which is at `diagonal` (n,), then those after it. An entry may be there in parts. `held` (n,): whether the
    row is joined to something that does not move."""

    starts: Ints
    columns: Ints
    values: Floats
    diagonal: Ints
    held: NDArray[np.int8]


def laplacian(system: System, free: Floats) -> tuple[Laplacian, Ints]:
    """The Laplacian of the particles with `free` (n,) above 0, and whose rows they are."""
    n = len(free)
    stiffness = np.zeros(n)
    index, parameters = np.zeros((0, 2), np.int64), np.zeros((0, 1))
    for group in system.groups:
        if group.cls is AnchorSpring:
            spot, strength = group.block.indices[:, 0], group.block.parameters[:, 0]
            stiffness += np.bincount(spot, strength * (free[spot] > 0.0), n)
        elif group.cls is Springs:
            index, parameters = group.block.indices, group.block.parameters
    return form(index, parameters, free, stiffness)


def form(pairs: NDArray[np.int64], densities: Floats, free: Floats, fixed: Floats) -> tuple[Laplacian, Ints]:
    """The Laplacian of `pairs` (m, 2), a number for each in the first column of `densities`, on the particles with
    `free` (n,) above 0, which resist by `fixed` (n,) themselves; and whose rows they are. Where
    a diagonal is not above 0 its row is missing: then the form is not positive, and the net of no use."""
    n = len(free)
    room = 2 * len(pairs) + n
    held, stiffness = (fixed > 0.0).astype(np.int8), fixed.copy()
    starts, diagonal, particles = np.empty(n + 1, np.int32), np.empty(n, np.int32), np.empty(n, np.int32)
    columns, values = np.empty(room, np.int32), np.empty(room)
    notes = np.zeros(n, np.int32), np.zeros(n, np.int32), np.full(n, -1, np.int32)
    found = (starts, columns, values, diagonal, held, particles)
    count, size = dispatch.compiled(join)(pairs, densities, free, stiffness, *found, *notes)
    net = Laplacian(starts[: count + 1], columns[:size], values[:size], diagonal[:count], held[:count])
    return net, particles[:count]


def join(  # type: ignore[no-untyped-def]
    indices, parameters, free, stiffness, starts, columns, values, diagonal, held, particles, before, after, place
):  # fmt: skip
    """Write the rows; how many there are, and how many entries."""
    for e in range(indices.shape[0]):
        a, b, k = np.uint64(indices[e, 0]), np.uint64(indices[e, 1]), parameters[e, 0]
        if k == 0.0 or np.isnan(k) or a == b:
            continue
        if free[a] > 0.0:
            stiffness[a] += k
            if free[b] > 0.0:
                stiffness[b] += k
                before[max(a, b)] += 1
                after[min(a, b)] += 1
            else:
                held[a] = 1
        elif free[b] > 0.0:
            stiffness[b] += k
            held[b] = 1
    count = 0
    size = 0
    for i in range(free.shape[0]):
        if stiffness[i] > 0.0:
            place[i] = count
            starts[count], diagonal[count], particles[count], held[count] = size, size + before[i], i, held[i]
            size = diagonal[count] + after[i] + 1
            columns[diagonal[count]], values[diagonal[count]] = count, stiffness[i]
            before[i], after[i] = starts[count], diagonal[count] + 1
            count += 1
    starts[count] = size
    for e in range(indices.shape[0]):
        a, b, k = np.uint64(indices[e, 0]), np.uint64(indices[e, 1]), parameters[e, 0]
        if k != 0.0 and not np.isnan(k) and place[a] >= 0 and place[b] >= 0 and a != b:
            first, second = min(a, b), max(a, b)
            s, t = np.uint64(after[first]), np.uint64(before[second])
            columns[s], values[s] = place[second], -k
            columns[t], values[t] = place[first], -k
            after[first] += 1
            before[second] += 1
    return count, size


def take(particles, axes, f, b):  # type: ignore[no-untyped-def]
    """b (rows, 4) = f of the particles (n, 3) on some axes, and zero on the others."""
    b[:] = 0.0
    for k in range(particles.shape[0]):
        for axis in axes:
            b[k, axis] = f[particles[k], axis]


def put(particles, axes, b, x):  # type: ignore[no-untyped-def]
    """x (n, 3) += b (rows, 4) on some axes."""
    for k in range(particles.shape[0]):
        for axis in axes:
            x[particles[k], axis] += b[k, axis]
