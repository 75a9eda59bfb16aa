"""The tangent stiffness of a net as a sparse matrix of 3 x 3 blocks: its pattern once, its values at every step."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from hookean import kernels
from hookean.forces import Block
from hookean.system import Group

if TYPE_CHECKING:
    from hookean.state import State
    from hookean.system import System

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]

CHUNK = 2048  # elements worked out before they are added: their blocks stay in the nearest cache


def find_slots(indices, starts, columns, slots):  # type: ignore[no-untyped-def]
    """Where in the pattern the block of each pair of an element's particles is."""
    for e in range(indices.shape[0]):
        for i in range(indices.shape[1]):
            for j in range(indices.shape[1]):
                low, high = starts[indices[e, i]], starts[indices[e, i] + 1] - 1
                while low < high:
                    middle = (low + high) // 2
                    if columns[middle] < indices[e, j]:
                        low = middle + 1
                    else:
                        high = middle
                slots[e, i, j] = low


def add_blocks(blocks, slots, values):  # type: ignore[no-untyped-def]
    for e in range(slots.shape[0]):
        for i in range(slots.shape[1]):
            for j in range(slots.shape[1]):
                s = slots[e, i, j]
                for a in range(3):
                    for b in range(3):
                        values[s, 3 * a + b] += blocks[e, 3 * i + a, 3 * j + b]


def sizes_of(values, sizes):  # type: ignore[no-untyped-def]
    """The Frobenius norm of each block."""
    for s in range(values.shape[0]):
        total = 0.0
        for c in range(9):
            total += values[s, c] * values[s, c]
        sizes[s] = np.sqrt(total)


def shift_blocks(starts, columns, diagonal, weights, shift, values):  # type: ignore[no-untyped-def]
    """Add `shift` times the Laplacian of the weighted graph, the same on all three axes."""
    for i in range(starts.shape[0] - 1):
        own = diagonal[i]
        for s in range(starts[i], starts[i + 1]):
            if s != own:
                amount = shift * weights[s]
                for c in range(0, 9, 4):
                    values[own, c] += amount
                    values[s, c] -= amount


def hold_axes(starts, columns, free, values):  # type: ignore[no-untyped-def]
    """Take held axes out: their rows and columns are zero, on the diagonal too."""
    for i in range(starts.shape[0] - 1):
        for s in range(starts[i], starts[i + 1]):
            j = columns[s]
            for a in range(3):
                for b in range(3):
                    values[s, 3 * a + b] *= free[i, a] * free[j, b]


class Blocks:
    """The pattern of a system's tangent, one row of blocks for each particle, and its values.

    `starts` (n + 1,), `columns` (k,), `diagonal` (n,) as in a compressed sparse row matrix; `values` (k, 9), the rows
    of each block after one another.
    """

    def __init__(self, system: System) -> None:
        import scipy.sparse as sparse

        n = len(system.x)
        self.groups = [i for i, group in enumerate(system.groups) if group.cls.role != "load"]
        rows, columns = [np.arange(n, dtype=np.int32)], [np.arange(n, dtype=np.int32)]
        for i in self.groups:
            index = system.groups[i].block.indices
            for a in range(index.shape[1]):
                for b in range(index.shape[1]):
                    if a != b:
                        rows.append(index[:, a].astype(np.int32))
                        columns.append(index[:, b].astype(np.int32))
        row, column = np.concatenate(rows), np.concatenate(columns)
        pattern = sparse.csr_matrix((np.ones(len(row), np.int8), (row, column)), shape=(n, n))
        pattern.sort_indices()
        self.starts: Ints = pattern.indptr.astype(np.int32)
        self.columns: Ints = pattern.indices.astype(np.int32)
        self.rows: Ints = np.repeat(np.arange(n, dtype=np.int32), np.diff(self.starts))
        self.diagonal: Ints = np.flatnonzero(self.rows == self.columns).astype(np.int32)
        self.slots = [self._slots(system.groups[i]) for i in self.groups]
        self.values: Floats = np.zeros((len(self.columns), 9))
        self.weights: Floats = np.zeros(len(self.columns))

    def _slots(self, group: Group) -> Ints:
        index = group.block.indices
        slots = np.zeros((len(index), index.shape[1], index.shape[1]), np.int32)
        kernels.compiled(find_slots)(index, self.starts, self.columns, slots)
        return slots

    def fill(self, system: System, state: State) -> None:
        """The values of the tangent of a shape, held axes not yet taken out."""
        self.values[:] = 0.0
        for i, slots in zip(self.groups, self.slots, strict=True):
            group, memory = system.groups[i], state.memory[i]
            for first in range(0, len(slots), CHUNK):
                part = slice(first, first + CHUNK)
                b = group.block
                some = Group(group.cls, Block(b.indices[part], b.parameters[part], b.memory[part]), [])
                blocks = system.stiffness_blocks(some, state, memory[part])
                kernels.compiled(add_blocks)(blocks, slots[part], self.values)

    def weigh(self) -> None:
        """Take the sizes of the blocks as the weights of the graph."""
        kernels.compiled(sizes_of)(self.values, self.weights)
        self.weights[self.diagonal] = 0.0

    def settle(self, state: State, shift: float) -> None:
        """Add `shift` times the Laplacian of the weights, and take held axes out."""
        if shift > 0.0:
            pattern = self.starts, self.columns, self.diagonal
            kernels.compiled(shift_blocks)(*pattern, self.weights, shift, self.values)
        kernels.compiled(hold_axes)(self.starts, self.columns, state.free, self.values)
