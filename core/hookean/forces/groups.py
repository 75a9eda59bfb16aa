"""Groups: elements of one force that feel one another, any number of them.

A force with a column `group` is a `Grouped`. Elements with the same number form a group, wherever they are among the
others. Two columns of their parameters lead from each member to the next, in the order of the rows:

    def kernel(x, v, indices, parameters, memory, f, w):
        for first in range(indices.shape[0]):
            if not begins(parameters, first):
                continue
            e = first
            while e >= 0:                     # once or more, for the sums of the group and then for its forces
                ...
                e = following(parameters, e)

The offsets are relative, so blocks can be joined, and they hold for any part of a block that keeps groups whole.

Where the energy of a group is the least of a sum over its members, E = min over q of sum E_i(x_i, q), the tangent
follows from the second derivatives of each E_i, whatever the size of the group (see `Grouped.second`).
"""

from __future__ import annotations

import math
from typing import Any, ClassVar

import numpy as np

from hookean.compiled.marks import device
from hookean.forces.base import Block, Floats, Force, Ints

FIRST, NEXT, COLUMNS = 0, 1, 2  # of the parameters: rows back to the first member, and on to the next; 0: none
LARGEST = 300  # members of a group up to which it may be one element with all of its particles
LEAST = 1e-12  # part of the stiffness of unknowns that they have at least


def links(index: Ints, group: Ints | None) -> Floats:
    """The first two columns (m, 2) of the parameters of elements `index` (m, arity), by the number of their group (m,);
    None: all are one. Elements that met no particle (-1) are in none: they are left out of the block."""
    met = np.flatnonzero((index >= 0).all(axis=1))
    found = np.zeros((len(index), COLUMNS))
    found[met] = _linked(np.zeros(len(met), np.int64) if group is None else group[met])
    return found


def _linked(label: Ints) -> Floats:
    order = np.argsort(label, kind="stable")
    ordered = label[order]
    new = np.concatenate([[True], ordered[1:] != ordered[:-1]])[: len(order)]
    found = np.zeros((len(order), COLUMNS))
    found[order, FIRST] = order - order[np.flatnonzero(new)][np.cumsum(new) - 1] if len(order) else 0.0
    onward = np.flatnonzero(~new)  # places of members that follow another
    found[order[onward - 1], NEXT] = order[onward] - order[onward - 1]
    return found


def heads(block: Block) -> Ints:
    """The first row (m,) of the group of each row."""
    return np.arange(len(block.indices)) - block.parameters[:, FIRST].astype(np.int64)


@device
def begins(parameters: Any, row: Any) -> Any:
    """Whether a row is the first of its group."""
    return parameters[row, FIRST] == 0.0


@device
def following(parameters: Any, row: Any) -> Any:
    """The next row of its group; -1 after the last."""
    step = int(parameters[row, NEXT])
    return row + step if step > 0 else -1


def extents(block: Block, x: Floats) -> Floats:
    """The largest extent along an axis (m,) [length] of the group of each row."""
    head, at = heads(block), x[block.indices]
    low, high = np.full((len(head), 3), np.inf), np.full((len(head), 3), -np.inf)
    np.minimum.at(low, head, at.min(axis=1))
    np.maximum.at(high, head, at.max(axis=1))
    return np.asarray((high - low)[head].max(axis=1))


def by_size(block: Block) -> list[Ints]:
    """The rows (k, members) of all groups of as many members, from small groups to large ones."""
    head = heads(block)
    order = np.argsort(head, kind="stable")
    _, start, count = np.unique(head[order], return_index=True, return_counts=True)
    sizes = np.unique(count)
    return [order[start[count == size][:, None] + np.arange(size)] for size in sizes]


class Grouped(Force):
    """Base of forces with groups. The first columns of its parameters are `links`."""

    unknowns: ClassVar[int] = 0  # of a group, over which its energy is the least
    blur: ClassVar[float] = 1e-12

    @classmethod
    def second(cls, block: Block, memory: Floats, x: Floats) -> Floats:
        """Second derivatives (m, s, s) of E_i(x_i, q) by the coordinates of a member's particles and the unknowns q of
        its group, s = 3 arity + unknowns, at the q of least energy. All q are lengths."""
        raise TypeError(f"{cls.__name__} does not define second()")

    @classmethod
    def gathered(
        cls, block: Block, memory: Floats, x: Floats, node: int | None
    ) -> list[tuple[type[Force], Block]] | None:
        """Members with the unknowns of their group as nodes, or whole groups without them. Those with more than
        `LARGEST` members then have the tangent that they would have with fixed unknowns: a bound from above."""
        if not len(block.indices):
            return []
        second = cls.second(block, memory, x)
        if node is not None:
            return [(Member, _members(block, second, cls.unknowns, node))]
        return [(Whole, _whole(block, second, cls.unknowns, rows)) for rows in by_size(block)]

    @classmethod
    def no_tangent(cls, block: Block, *, sparse: bool) -> str:
        """Multigrid has no unknowns beside the positions, so that large groups have no tangent there."""
        most = 0 if sparse else int(np.unique(heads(block), return_counts=True)[1].max(initial=0))
        return f"a group of {most} elements is too large for multigrid" if most > LARGEST else ""

    @classmethod
    def connected(cls, block: Block) -> Ints:
        """Each member with the next."""
        onward = np.arange(len(block.indices)) + block.parameters[:, NEXT].astype(np.int64)
        return np.hstack([block.indices, block.indices[onward]])

    @classmethod
    def taken(cls, block: Block, rows: Ints) -> tuple[Ints, Block]:
        """Whole groups."""
        head = heads(block)
        rows = np.flatnonzero(np.isin(head, head[rows]))
        rows, part = super().taken(block, rows)
        part.parameters[:, :COLUMNS] = _linked(head[rows])
        return rows, part


class Member(Force):
    """Members of groups with the unknowns of the group as nodes: for their tangents alone, see `Grouped.gathered`."""

    role: ClassVar[Any] = "support"  # a motion that all of its particles share changes its energy
    blur: ClassVar[float] = 1e-12
    tangent: ClassVar[Any] = staticmethod(lambda block, x: _spread(block))


class Whole(Force):
    """Whole groups as elements of any number of particles: for their tangents alone, see `Grouped.gathered`."""

    blur: ClassVar[float] = 1e-12
    tangent: ClassVar[Any] = staticmethod(lambda block, x: _condensed(block))


def stiff(index: Ints, stiffness: Floats) -> Block:
    """A block for `Whole`: elements of particles (m, n) that have these stiffness matrices (m, 3 n, 3 n)."""
    table = np.column_stack([np.tile([1.0, 0.0], (len(index), 1)), stiffness.reshape(len(index), -1)])
    return Block(np.ascontiguousarray(index), table, np.zeros((len(index), 0)))


def bounded(index: Ints, w: Floats) -> Block:
    """A block for `Whole`: elements of one particle each, (m, 1), that have the stiffness w (m,) in all directions."""
    return stiff(index, w[:, None, None] * np.eye(3))


def _members(block: Block, second: Floats, unknowns: int, node: int) -> Block:
    """Elements of the particles of a member and the nodes of its group; the unknowns have a little stiffness, which
    matters where nothing else determines them."""
    head, own = heads(block), second.shape[1] - unknowns
    _, number, count = np.unique(head, return_inverse=True, return_counts=True)
    stiff = np.bincount(number, np.einsum("eii->e", second[:, own:, own:]))
    least = np.where(stiff > 0.0, LEAST * stiff / max(unknowns, 1), 1.0) / count
    second[:, range(own, own + unknowns), range(own, own + unknowns)] += least[number, None]
    nodes = node + unknowns * number[:, None] + np.arange(unknowns)
    return Block(np.hstack([block.indices, nodes]), second.reshape(len(second), -1), np.zeros((len(second), 0)))


def _spread(block: Block) -> Floats:
    """Stiffness (m, 3 n, 3 n) of members, of their unknowns the first axis alone."""
    (count, nodes), size = block.indices.shape, math.isqrt(block.parameters.shape[1])
    own = 3 * (size - nodes) // 2  # a particles and q nodes have 3 a + q unknowns
    places = np.concatenate([np.arange(own), np.arange(own, 3 * nodes, 3)])
    whole = np.zeros((count, 3 * nodes, 3 * nodes))
    whole[:, places[:, None], places] = block.parameters.reshape(count, size, size)
    return whole


def _whole(block: Block, second: Floats, unknowns: int, rows: Ints) -> Block:
    """Groups of `rows` (k, members) as one element each; the members of large ones by themselves, without unknowns."""
    if rows.shape[1] > LARGEST:
        rows, own = rows.reshape(-1, 1), second.shape[1] - unknowns
        second = second.copy()
        second[:, own:] = second[:, :, own:] = 0.0
    count, members = rows.shape
    table = np.column_stack([np.tile([members, unknowns], (count, 1)), second[rows].reshape(count, -1)])
    return Block(np.ascontiguousarray(block.indices[rows].reshape(count, -1)), table, np.zeros((count, 0)))


def _condensed(block: Block) -> Floats:
    """Stiffness (k, 3 n, 3 n) of whole groups: K_xx - K_xq K_qq^-1 K_qx."""
    count, size = len(block.indices), 3 * block.indices.shape[1]
    members, unknowns = block.parameters[0, :2].astype(np.int64)
    own = size // members
    each = block.parameters[:, 2:].reshape(count, members, own + unknowns, own + unknowns)
    whole = np.zeros((count, members, own, members, own))
    whole[:, range(members), :, range(members)] = each[:, :, :own, :own].transpose(1, 0, 2, 3)
    whole = whole.reshape(count, size, size)
    if unknowns:
        cross = each[:, :, :own, own:].reshape(count, size, unknowns)
        inverse = np.linalg.pinv(each[:, :, own:, own:].sum(axis=1), rcond=LEAST, hermitian=True)
        whole -= cross @ inverse @ cross.transpose(0, 2, 1)
    return whole
