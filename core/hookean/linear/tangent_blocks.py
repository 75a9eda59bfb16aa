"""The tangent stiffness of a net as a sparse matrix of 3 x 3 blocks: its pattern once, its values at every step."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from hookean.compiled import dispatch
from hookean.compiled.marks import device
from hookean.forces import Block
from hookean.system.group import Group

if TYPE_CHECKING:
    from hookean.system.state import State
    from hookean.system.system import System

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]

SLACK = 1e-3  # part of a block's size that it is taken to pull at least
CHUNK = 2048  # elements worked out before they are added: their blocks stay in the nearest cache


def find_slots(indices, starts, columns, slots):  # type: ignore[no-untyped-def]
    """Where in the pattern the block of each pair of an element's particles is; -1 for those below the diagonal."""
    for e in range(indices.shape[0]):
        for i in range(indices.shape[1]):
            for j in range(indices.shape[1]):
                row, column = indices[e, i], indices[e, j]
                slots[e, i, j] = place_of(starts, columns, row, column) if row <= column else -1


@device
def place_of(starts: Any, columns: Any, row: Any, column: Any) -> Any:
    """Where in a pattern a column of a row is."""
    low, high = np.uint64(starts[row]), np.uint64(starts[row + 1] - 1)  # unsigned: no index counts from the end
    while low < high:
        middle = (low + high) >> np.uint64(1)
        if columns[middle] < column:
            low = middle + np.uint64(1)
        else:
            high = middle
    return low


def add_blocks(blocks, slots, values):  # type: ignore[no-untyped-def]
    for e in range(slots.shape[0]):
        for i in range(slots.shape[1]):
            for j in range(slots.shape[1]):
                s = slots[e, i, j]
                if s >= 0:
                    for a in range(3):
                        for b in range(3):
                            values[s, 3 * a + b] += blocks[e, 3 * i + a, 3 * j + b]


def add_central(stiffness, slots, pulling, values):  # type: ignore[no-untyped-def]
    """`add_blocks` for forces along lines."""
    for e in range(slots.shape[0]):
        along, across = stiffness[e, 0], stiffness[e, 1]
        if pulling:
            across = max(across, 0.0)
        x, y, z = stiffness[e, 2], stiffness[e, 3], stiffness[e, 4]
        more = along - across
        xx, yy, zz = more * x * x + across, more * y * y + across, more * z * z + across
        xy, xz, yz = more * x * y, more * x * z, more * y * z
        block = (xx, xy, xz, xy, yy, yz, xz, yz, zz)
        i, j, k = slots[e, 0, 0], slots[e, 1, 1], max(slots[e, 0, 1], slots[e, 1, 0])
        for c in range(9):
            values[i, c] += block[c]
            values[j, c] += block[c]
            values[k, c] -= block[c]


def measure(starts, columns, values, sizes, pulls):  # type: ignore[no-untyped-def]
    """Of each block off the diagonal its Frobenius norm, and how much it pulls across: the least eigenvalue of -block
    where two are equal and the third is larger, as a spring's are; else a bound above it."""
    for i in range(starts.shape[0] - 1):
        sizes[starts[i]] = pulls[starts[i]] = 0.0
        for s in range(starts[i] + 1, starts[i + 1]):
            square = 0.0
            for c in range(9):
                square += values[s, c] * values[s, c]
            mean = -(values[s, 0] + values[s, 4] + values[s, 8]) / 3.0
            sizes[s] = np.sqrt(square)
            pulls[s] = mean - np.sqrt(max(square - 3.0 * mean * mean, 0.0) / 6.0)


def shift_blocks(starts, columns, weights, shift, values):  # type: ignore[no-untyped-def]
    """Add `shift` times the Laplacian of the weighted graph, the same on all three axes."""
    for i in range(starts.shape[0] - 1):
        for s in range(starts[i] + 1, starts[i + 1]):
            amount = shift * weights[s]
            for c in range(0, 9, 4):
                values[starts[i], c] += amount
                values[starts[columns[s]], c] += amount
                values[s, c] -= amount


def strain(starts, columns, weights, x):  # type: ignore[no-untyped-def]
    """x L x, L the Laplacian of the weighted graph."""
    total = 0.0
    for i in range(starts.shape[0] - 1):
        for s in range(starts[i] + 1, starts[i + 1]):
            for c in range(3):
                total += weights[s] * (x[i, c] - x[columns[s], c]) ** 2
    return total


def hold_axes(starts, columns, free, values):  # type: ignore[no-untyped-def]
    """Take held axes out: their rows and columns are zero, on the diagonal too."""
    for i in range(starts.shape[0] - 1):
        for s in range(starts[i], starts[i + 1]):
            j = columns[s]
            if free[i, 0] + free[i, 1] + free[i, 2] + free[j, 0] + free[j, 1] + free[j, 2] < 6.0:
                for a in range(3):
                    for b in range(3):
                        values[s, 3 * a + b] *= free[i, a] * free[j, b]


def turn_sides(starts, columns, x, step, largest):  # type: ignore[no-untyped-def]
    """`Blocks.turned`, into `largest` (n,) of zeros."""
    for i in range(starts.shape[0] - 1):
        for s in range(starts[i] + 1, starts[i + 1]):
            j = columns[s]
            a, b, c = x[j, 0] - x[i, 0], x[j, 1] - x[i, 1], x[j, 2] - x[i, 2]
            d, e, f = step[j, 0] - step[i, 0], step[j, 1] - step[i, 1], step[j, 2] - step[i, 2]
            square = a * a + b * b + c * c
            if square > 0.0:
                p, q, r = b * f - c * e, c * d - a * f, a * e - b * d
                angle = np.sqrt(p * p + q * q + r * r) / square
                largest[i] = max(largest[i], angle)
                largest[j] = max(largest[j], angle)


def resisting(system: System, x: Floats, memory: list[Floats]) -> list[tuple[Group, Floats]]:
    """Elements that have a tangent, with what they remember."""
    return [(group, own) for group, own in system.elements(x, memory) if group.cls.role != "load"]


class Blocks:
    """The pattern of a system's tangent, which is symmetric: of each particle's row of blocks the one on the diagonal,
    which comes first, and those after it; and its values.

    `starts` (n + 1,), `columns` (k,) as in a compressed sparse row matrix; `values` (k, 9), the rows of each block
    after one another.
    """

    def __init__(self, system: System) -> None:
        import scipy.sparse as sparse

        n = len(system.x)
        groups = [group for group, _ in resisting(system, system.x, [g.block.memory for g in system.groups])]
        rows, columns = [np.arange(n, dtype=np.int32)], [np.arange(n, dtype=np.int32)]
        for group in groups:
            index = group.block.indices.astype(np.int32)
            for a in range(index.shape[1]):
                for b in range(a):
                    rows.append(np.minimum(index[:, a], index[:, b]))
                    columns.append(np.maximum(index[:, a], index[:, b]))
        row, column = np.concatenate(rows), np.concatenate(columns)
        pattern = sparse.csr_matrix((np.ones(len(row), np.int8), (row, column)), shape=(n, n))
        pattern.sort_indices()
        self.starts: Ints = pattern.indptr.astype(np.int32)
        self.columns: Ints = pattern.indices.astype(np.int32)
        self.slots = [self._slots(group) for group in groups]
        self.values: Floats = np.zeros((len(self.columns), 9))
        self.sizes: Floats = np.zeros(len(self.columns))

    def _slots(self, group: Group) -> Ints:
        index = group.block.indices
        slots = np.zeros((len(index), index.shape[1], index.shape[1]), np.int32)
        dispatch.compiled(find_slots)(index, self.starts, self.columns, slots)
        return slots

    def fill(self, system: System, state: State, *, pulling: bool = False) -> None:
        """The values of the tangent of a shape, held axes not yet taken out. `pulling`: without what forces along lines
        that push take off across them, by which alone a tangent of such forces is not positive."""
        self.values[:] = 0.0
        for (group, memory), slots in zip(resisting(system, state.x, state.memory), self.slots, strict=True):
            b = group.block
            for first in range(0, len(slots), CHUNK):
                part = slice(first, first + CHUNK)
                if group.cls.central is not None:
                    stiffness = np.empty((len(slots[part]), 5))
                    some_of = (b.indices[part], b.parameters[part], memory[part])
                    dispatch.compiled(group.cls.central, "central")(state.x, *some_of, stiffness)
                    dispatch.compiled(add_central)(stiffness, slots[part], pulling, self.values)
                else:
                    some = Group(group.cls, Block(b.indices[part], b.parameters[part], b.memory[part]), [])
                    blocks = system.stiffness_blocks(some, state, memory[part])
                    dispatch.compiled(add_blocks)(blocks, slots[part], self.values)

    def weights(self) -> Floats:
        """How strongly particles hold one another across the line between them, as the weights of the graph: there a
        net is weakest, and differs most with the direction. What pushes or has no tension counts as a little."""
        sizes, pulls = np.empty(len(self.columns)), np.empty(len(self.columns))
        dispatch.compiled(measure)(self.starts, self.columns, self.values, sizes, pulls)
        return np.maximum(pulls, SLACK * sizes)

    def pushing(self) -> float:
        """The part of the connections that push."""
        pulls = np.empty(len(self.columns))
        dispatch.compiled(measure)(self.starts, self.columns, self.values, np.empty(len(self.columns)), pulls)
        return float((pulls < 0.0).mean())

    def weigh(self) -> None:
        """Take the sizes of the blocks as what `settle` adds."""
        dispatch.compiled(measure)(self.starts, self.columns, self.values, self.sizes, np.empty(len(self.columns)))

    def settle(self, state: State, shift: float) -> None:
        """Add `shift` times the Laplacian of the sizes, and take held axes out."""
        if shift > 0.0:
            dispatch.compiled(shift_blocks)(self.starts, self.columns, self.sizes, shift, self.values)
        dispatch.compiled(hold_axes)(self.starts, self.columns, state.free, self.values)

    def shifted(self, shift: float, x: Floats) -> float:
        """The energy [force length] that `settle` adds to a movement x (n, 3), times two."""
        return (
            shift * float(dispatch.compiled(strain)(self.starts, self.columns, self.sizes, x)) if shift > 0.0 else 0.0
        )

    def turned(self, x: Floats, step: Floats) -> Floats:
        """The largest angle (n,) [rad] by which a step (n, 3) would turn, to first order, an element's side between
        each particle of a shape (n, 3) and a neighbour."""
        largest = np.zeros(len(x))
        dispatch.compiled(turn_sides)(self.starts, self.columns, x, step, largest)
        return largest
