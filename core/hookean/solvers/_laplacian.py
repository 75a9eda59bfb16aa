"""The stiffness of a net of springs of rest length 0: the Laplacian of its graph, one number for each pair of particles.

It holds the particles that are free on some axis, numbered as a front meets them that goes over the net from one end:
neighbours stay near each other, and what the front holds at a time is what a factor fills in.
Source: Cuthill and McKee, "Reducing the bandwidth of sparse symmetric matrices", 1969.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from hookean import kernels
from hookean.forces.anchor_spring import AnchorSpring
from hookean.forces.springs import Springs

if TYPE_CHECKING:
    from hookean.system import System

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]


@dataclass(frozen=True)
class Laplacian:
    """Rows of particles (n,): the neighbours of one are `columns` from `starts` on, joined by `values`; `stiffness` is
    the diagonal. `order` (count,) are the particles with a row, `place` (n,) where they stand in that order, `last`
    (count,) the farthest place that the front has met when it leaves a particle; `fill` what a factor would hold."""

    starts: Ints
    columns: Ints
    values: Floats
    stiffness: Floats
    order: Ints
    place: Ints
    last: Ints
    fill: int
    work: float  # multiplications of a factor


def laplacian(system: System, free: Floats) -> Laplacian | None:
    """The Laplacian of the particles with `free` (n,) above 0; None where some hang on nothing that is held."""
    n = len(free)
    starts, held, stiffness = np.zeros(n + 1, np.int32), np.zeros(n, np.int8), np.zeros(n)
    columns, values = np.zeros(0, np.int32), np.zeros(0)
    for group in system.groups:
        index, parameters = group.block.indices, group.block.parameters
        if group.cls is AnchorSpring:
            strength = parameters[:, 0] * free[index[:, 0]]
            stiffness += np.bincount(index[:, 0], strength, n)
            held[index[strength > 0.0, 0]] = 1
        elif group.cls is Springs:
            columns, values = np.empty(2 * len(index), np.int32), np.empty(2 * len(index))
            kernels.compiled(join)(index, parameters, free, starts, columns, values, stiffness, held)
    order, place, last = np.empty(n, np.int32), np.empty(n, np.int32), np.empty(n, np.int32)
    count, fill, work = kernels.compiled(sweep)(starts, columns, stiffness, held, order, place, last)
    if count < 0:
        return None
    return Laplacian(starts, columns, values, stiffness, order[:count], place, last[:count], fill, work)


def join(indices, parameters, free, starts, columns, values, stiffness, held):  # type: ignore[no-untyped-def]
    """Rows of the particles that are free; `held` tells which of them are joined to one that is not."""
    for e in range(indices.shape[0]):
        a, b, k = np.uint64(indices[e, 0]), np.uint64(indices[e, 1]), parameters[e, 0]
        if not k > 0.0 or a == b:
            continue
        if free[a] > 0.0:
            stiffness[a] += k
            if free[b] > 0.0:
                stiffness[b] += k
                starts[a] += 1
                starts[b] += 1
            else:
                held[a] = 1
        elif free[b] > 0.0:
            stiffness[b] += k
            held[b] = 1
    total = 0
    for i in range(starts.shape[0]):
        total += starts[i]
        starts[i] = total
    for e in range(indices.shape[0]):
        a, b, k = np.uint64(indices[e, 0]), np.uint64(indices[e, 1]), parameters[e, 0]
        if k > 0.0 and a != b and free[a] > 0.0 and free[b] > 0.0:
            starts[a] -= 1
            starts[b] -= 1
            s, t = np.uint64(starts[a]), np.uint64(starts[b])
            columns[s], values[s] = b, k
            columns[t], values[t] = a, k


def sweep(starts, columns, stiffness, held, order, place, last):  # type: ignore[no-untyped-def]
    """Number the particles that have stiffness, each connected part from its end; how many, what a factor holds, and
    its multiplications. Less than none where a part hangs on nothing."""
    n = stiffness.shape[0]
    place[:] = -1
    count, fill, work = 0, 0, 0.0
    for seed in range(n):
        if place[seed] != -1 or not stiffness[seed] > 0.0:
            continue
        begun, sure = count, False
        order[count] = seed
        place[seed] = -2
        end, at = count + 1, count
        while at < end:  # a first sweep finds an end
            i = np.uint64(order[at])
            sure |= held[i] > 0
            for s in range(starts[i], starts[i + np.uint64(1)]):
                j = np.uint64(columns[np.uint64(s)])
                if place[j] == -1:
                    place[j] = -2
                    order[end] = j
                    end += 1
            at += 1
        if not sure:
            return -1, 0, 0.0
        order[count] = order[end - 1]
        place[order[count]] = count
        end = count + 1
        while count < end:
            i = np.uint64(order[count])
            for s in range(starts[i], starts[i + np.uint64(1)]):
                j = np.uint64(columns[np.uint64(s)])
                if place[j] < 0:
                    place[j] = end
                    order[end] = j
                    end += 1
            last[count] = end - 1
            count += 1
        for k in range(begun, count):
            fill += last[k] - k + 1
            work += float(last[k] - k) ** 2
    return count, fill, work
