"""Components: the parts of a model that do not touch one another, each judged by its own loads and forces.

Particles that may move are connected where an element joins them; a particle that is held on all axes separates what
hangs on it, as nothing passes through it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from hookean.compiled import dispatch
from hookean.compiled.marks import device

if TYPE_CHECKING:
    from hookean.system.group import Group

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


@dataclass(frozen=True)
class Components:
    """Connected components: the `label` (n,) of each particle, -1 where it is held on all axes; and of each component
    its lowest particle `first` (k,), whether something supports it (`supported`), whether it has elements (`joined`):
    one without is a single particle; and the projection `loose` (k, 3, 3) on the directions in which nothing can hold
    it, 0 where it is held in all."""

    free: Floats  # (n, 3), of the state they were found for
    label: Ints
    first: Ints
    supported: NDArray[np.bool_]
    joined: NDArray[np.bool_]
    loose: Floats


def components(groups: list[Group], free: Floats) -> Components:
    """The components of particles with `free` (n, 3) 0 on held axes.

    One is supported along an axis by a particle that is held on it; in all directions by an element to one that is held
    on all axes; and by a force that acts from outside (an anchor spring, a pull, water) in the directions in which that
    `holds`. What contacts with a floor hold depends on the loads (see `balance`).
    """
    n = len(free)
    parent, notes, label = np.arange(n), np.zeros(n, np.int64), np.empty(n, np.int64)
    partly: list[tuple[Ints, Floats]] = []
    for group in groups:
        index = group.cls.connected(group.block)
        if len(index) and (group.cls.role != "load" or index.shape[1] > 1):
            supports = group.cls.role == "support" or group.cls.bears
            directions = group.cls.holds(group.block) if supports else None
            if directions is not None and directions.any():
                partly.append((group.block.indices[:, 0], directions))
            dispatch.compiled(unite)(index, free, supports and directions is None, parent, notes)
    first, flags = np.empty(n, np.int64), np.empty(n, np.int64)
    count = dispatch.compiled(number)(parent, free, notes, label, first, flags)
    flags, first = flags[:count], first[:count]
    loose, held = _loose(flags, label, partly)
    return Components(free.copy(), label, first, held, (flags & JOINED) > 0, loose)


def _loose(flags: Ints, label: Ints, partly: list[tuple[Ints, Floats]]) -> tuple[Floats, NDArray[np.bool_]]:
    """The directions (k, 3, 3) in which nothing holds a component, and which have any support (k,)."""
    loose = np.zeros((len(flags), 3, 3))
    supported = (flags & HELD) > 0
    if supported.all():
        return loose, supported
    some = np.flatnonzero(~supported)
    axes = (flags[some, None] & AXES) > 0
    supported[some] = axes.any(axis=1)
    loose[some] = np.eye(3) * ~axes[:, :, None]
    if partly:
        held = np.eye(3) - loose
        for particles, directions in partly:
            mine = label[particles] >= 0
            np.add.at(held, label[particles][mine], directions[mine])
        values, vectors = np.linalg.eigh(held[some])
        vectors = vectors * (values < 1e-9 * np.maximum(values[:, -1:], 1e-300))[:, None, :]
        supported[some] |= values[:, -1] > 0.0
        loose[some] = vectors @ vectors.transpose(0, 2, 1)
    return loose, supported


def linked(links: Ints, count: int) -> Ints:
    """The label (count,) of the connected part of each of so many points that links (k, 2) connect."""
    free, parent, notes, label = np.ones((count, 3)), np.arange(count), np.zeros(count, np.int64), np.empty(count, int)
    dispatch.compiled(unite)(np.ascontiguousarray(links, np.int64), free, False, parent, notes)
    dispatch.compiled(number)(parent, free, notes, label, np.empty_like(label), np.empty_like(label))
    return label


JOINED, HELD = 1, 2  # notes on particles: an element acts on it; something supports it in all directions
AXES = np.array([4, 8, 16])  # or along x, y, z


@device
def root(parent: Any, i: Any) -> Any:
    """The lowest particle known to be connected with one."""
    while parent[i] != i:
        parent[i] = parent[parent[i]]
        i = parent[i]
    return i


def unite(indices, free, supports, parent, notes):  # type: ignore[no-untyped-def]
    """Connect the moving particles of each element; note which are joined, and which hang on a held one."""
    for e in range(indices.shape[0]):
        low, held = -1, supports
        for c in range(indices.shape[1]):
            i = indices[e, c]
            if free[i, 0] + free[i, 1] + free[i, 2] == 0.0:
                held = True
                continue
            i = root(parent, i)
            if low < 0 or low == i:
                low = i
            elif i < low:
                parent[low] = i
                low = i
            else:
                parent[i] = low
        if low >= 0:
            notes[low] |= 3 if held else 1


def number(parent, free, notes, label, first, flags):  # type: ignore[no-untyped-def]
    """Number the components by their lowest particles; how many there are."""
    count = 0
    for i in range(parent.shape[0]):
        axes = free[i, 0] + free[i, 1] + free[i, 2]
        if axes == 0.0:
            label[i] = -1
            continue
        own = root(parent, i)
        if own == i:
            label[i], first[count], flags[count] = count, i, 0
            count += 1
        else:
            label[i] = label[own]
        flags[label[i]] |= notes[i]
        if axes < 3.0:
            for c in range(3):
                if free[i, c] == 0.0:
                    flags[label[i]] |= 4 << c
    return count


def sizes(parts: Components, groups: list[Group], x: Floats) -> Floats:
    """The diagonal (k,) [length] of the box around each component and what its elements hold on to; for a particle
    without any, its distance from the origin."""
    low = x.take(parts.first, axis=0)
    high = low.copy()
    for group in groups:
        if group.cls.role != "load" and len(group.block.indices):
            dispatch.compiled(span)(np.ascontiguousarray(group.particles), x, parts.label, low, high)
    found = np.empty(len(low))
    dispatch.compiled(diagonals)(low, high, x, parts.first, found)
    return found


def span(indices, x, label, low, high):  # type: ignore[no-untyped-def]
    """The least and largest coordinates of the elements of each component."""
    for e in range(indices.shape[0]):
        part = -1
        for j in range(indices.shape[1]):
            part = max(part, label[indices[e, j]])
        if part >= 0:
            for j in range(indices.shape[1]):
                i = np.uint64(indices[e, j])
                for c in range(3):
                    if x[i, c] < low[part, c]:
                        low[part, c] = x[i, c]
                    elif x[i, c] > high[part, c]:
                        high[part, c] = x[i, c]


def diagonals(low, high, x, first, found):  # type: ignore[no-untyped-def]
    """The diagonals of boxes; of those without extent, how far from the origin their particles are."""
    for k in range(found.shape[0]):
        square, far = 0.0, 0.0
        for c in range(3):
            square += (high[k, c] - low[k, c]) ** 2
            far = max(far, abs(x[first[k], c]))
        size = np.sqrt(square)
        found[k] = size if size > 0.0 and np.isfinite(size) else far
