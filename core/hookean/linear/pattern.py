"""The pattern of a sparse tangent stiffness: worked out once, filled at every shape."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from hookean.linear.sparse_factors import Factors

if TYPE_CHECKING:
    from hookean.linear.directions import Directions
    from hookean.system.group import Group
    from hookean.system.state import State
    from hookean.system.system import System

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


class Pattern:
    """Where element blocks go in the lower triangle of the sparse tangent: worked out once, filled at every step.

    After the free axes `dofs` of the particles come the unknowns that elements have of their own (`System.elements`).
    `diagonal` has the places of the former alone.
    """

    def __init__(self, system: System, free: Floats) -> None:
        self.free = free
        self.dofs = np.flatnonzero(free.ravel() > 0)
        self._lay_out([g for g, _ in system.elements(system.x, [g.block.memory for g in system.groups], sparse=True)])

    def _lay_out(self, groups: list[Group]) -> None:
        """Work out the pattern of these elements."""
        free, self.wiring = self.free, [g.block.indices for g in groups]
        nodes = max((int(g.block.indices.max(initial=-1)) + 1 for g in groups), default=0)
        own_nodes = np.tile([1.0, 0.0, 0.0], (max(nodes - len(free), 0), 1))
        free = np.concatenate([free, own_nodes])
        n = len(free)
        lower = [_lower(g.block.indices) if not g.cls.constant else np.zeros((0, 3), np.int64) for g in groups]
        own = np.arange(n, dtype=np.int64) * (n + 1)
        pairs, which = np.unique(
            np.concatenate([*(low[:, 1] * n + low[:, 0] for low in lower), own]), return_inverse=True
        )
        place = self._arrange(pairs % n, pairs // n, free > 0)
        ends = np.cumsum([len(low) for low in lower], dtype=np.int64)
        self.takes, places = [], [np.zeros(0, np.int64)]
        for group, low, end in zip(groups, lower, ends, strict=True):
            wide = 3 * group.block.indices.shape[1]
            corner = low[:, 2, None, None] + wide * np.arange(3)[:, None] + np.arange(3)
            mine = place[which[end - len(low) : end]]
            self.takes.append(corner[mine >= 0])
            places.append(mine[mine >= 0])
        self.places = np.concatenate(places)

    def elements(self, system: System, state: State) -> list[tuple[Group, Floats]]:
        """All elements of a shape. Where others feel one another than before, the pattern is worked out again."""
        found = system.elements(state.x, state.memory, sparse=True)
        if not same_wiring(self.wiring, [group.block.indices for group, _ in found]):
            self._lay_out([group for group, _ in found])
        return found

    def gather(self, vectors: Floats) -> Floats:
        """Vectors (n, 3) as unknowns, those of held axes left out."""
        return np.asarray(vectors.ravel()[self.dofs])

    def spread(self, unknowns: Floats) -> Floats:
        """Unknowns as vectors (n, 3), 0 on held axes."""
        whole = np.zeros(self.free.size)
        whole[self.dofs] = unknowns
        return whole.reshape(self.free.shape)

    def _arrange(self, row: Ints, column: Ints, free: NDArray[np.bool_]) -> Ints:
        """Lay out the matrix for pairs of particles sorted by column and row, (i, i) first in each column.

        Returns the place (pairs, 3, 3) of each entry by the axes of its row and its column; -1 where it has none.
        """
        n = len(free)
        rank = np.cumsum(free, axis=1) - 1  # of each free axis among its particle's
        axes = free.sum(axis=1)[row]
        first = np.searchsorted(column, np.arange(n))
        above = np.cumsum(axes) - axes
        above -= above[first][column]  # entries of the column over those of the pair
        height = np.add.reduceat(axes, first)[:, None] - rank
        starts = np.concatenate([[0], np.cumsum(height[free])])
        begin = np.zeros(free.shape, np.int64)
        begin[free] = starts[:-1]
        place: Ints = (begin - rank)[column][:, None, :] + (above[:, None] + rank[row])[:, :, None]
        kept = free[row][:, :, None] & free[column][:, None, :]
        kept &= (row > column)[:, None, None] | np.tri(3, dtype=bool)
        place[~kept] = -1
        number = np.zeros(free.shape, np.int32)
        number[free] = np.arange(free.sum())
        rows = np.zeros(starts[-1], np.int32)
        rows[place[kept]] = np.broadcast_to(number[row][:, :, None], place.shape)[kept]
        self.diagonal, self.count = starts[: len(self.dofs)], len(rows)
        self.factors = Factors(rows, starts.astype(np.int32))
        return place

    def tangent(self, system: System, state: State, directions: Directions | None = None) -> Floats:
        """Values of the lower triangle of the sparse tangent stiffness; with `directions`, of what these make of it."""
        elements, end = self.elements(system, state), 0
        values = np.empty(len(self.places))
        for (group, memory), take in zip(elements, self.takes, strict=True):
            if len(take):
                blocks = system.stiffness_blocks(group, state, memory)
                if directions is not None:
                    directions.put(group, blocks)
                # all are within: with clip they go straight to their place
                np.take(blocks.ravel(), take, out=values[end : end + len(take)], mode="clip")
                end += len(take)
        summed: Floats = np.bincount(self.places, values, self.count).astype(np.float64)
        return summed


def same_wiring(known: list[Ints], found: list[Ints]) -> bool:
    """Whether groups of elements have the same particles."""
    return len(known) == len(found) and all(a is b or np.array_equal(a, b) for a, b in zip(known, found, strict=True))


def _lower(index: Ints) -> Ints:
    """Row and column particle of what is not above the diagonal, and its corner in the flat blocks of all elements."""
    m, arity = index.shape
    row, column = np.repeat(index, arity, axis=1).ravel(), np.tile(index, (1, arity)).ravel()
    i, j = np.divmod(np.arange(arity * arity), arity)
    corner = (9 * arity * arity * np.arange(m)[:, None] + 9 * arity * i + 3 * j).ravel()
    below = row >= column
    return np.column_stack([row[below], column[below], corner[below]])
