"""The tangent stiffness of a shape as one sparse matrix of its free axes, and its factors."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.compiled import dispatch
from hookean.forces import Block
from hookean.linear.film_tangent import CHUNK, turn_blocks
from hookean.linear.sparse_factors import Factor, Factors
from hookean.system.group import Group
from hookean.system.state import State
from hookean.system.system import System

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

TURNS = 1_500  # rotations
NOTHING = 1e-12  # of the largest stiffness of rotations
DENSE = 600  # unknowns up to which dense matrices are as quick


@dataclass(frozen=True)
class Unknowns:
    """Which motions of the particles are unknown: their free axes, or along films the axes that count (`axes` (n, 3, 3)
    by rows). After those of the particles come unknowns that elements have of their own."""

    count: int
    dofs: Ints
    axes: Floats | None
    sparse: bool

    @classmethod
    def of(cls, system: System, state: State, free: Floats) -> Unknowns:
        """The unknowns of a shape with these free axes (n, 3)."""
        axes = None
        if system.films is not None:
            axes, free = system.films.frames(state.x, free)
        dofs = np.flatnonzero(free.ravel() > 0.0)
        few = len(dofs) <= DENSE and not system.no_tangent(sparse=False)
        return cls(len(free), dofs, axes, not few)

    def gather(self, vectors: Floats) -> Floats:
        """Vectors (n, 3) as unknowns (u,)."""
        turned = vectors if self.axes is None else np.einsum("nij,nj->ni", self.axes, vectors)
        return np.asarray(turned.ravel()[self.dofs])

    def spread(self, unknowns: Floats) -> Floats:
        """Unknowns (u,) as vectors (n, 3)."""
        whole = np.zeros(3 * self.count)
        whole[self.dofs] = unknowns[: len(self.dofs)]
        parts = whole.reshape(-1, 3)
        return parts if self.axes is None else np.einsum("nij,ni->nj", self.axes, parts)

    def tangent(self, system: System, state: State) -> Any:
        """The tangent stiffness as a symmetric CSC matrix [force/length]."""
        import scipy.sparse as sparse

        places, values, size = [np.zeros((2, 0), np.int64)], [np.zeros(0)], len(self.dofs)
        number = np.full(3 * self.count, -1)
        number[self.dofs] = np.arange(size)
        for group, memory in system.elements(state.x, state.memory, sparse=self.sparse):
            if group.cls.constant or not len(group.block.indices):
                continue
            own = max(int(group.block.indices.max()) + 1 - self.count, 0)
            size = max(size, len(self.dofs) + own)
            for first in range(0, len(group.block.indices), CHUNK):
                index, blocks = self._blocks(system, state, group, memory, slice(first, first + CHUNK))
                mine = _numbers(index, number, self.count, len(self.dofs))
                row = np.broadcast_to(mine[:, :, None], blocks.shape)
                column = np.broadcast_to(mine[:, None, :], blocks.shape)
                kept = (row >= 0) & (column >= 0)
                places.append(np.stack([row[kept], column[kept]]))
                values.append(blocks[kept])
        whole = np.concatenate(values)
        matrix = sparse.coo_matrix((whole, np.concatenate(places, axis=1)), shape=(size, size)).tocsc()
        return ((matrix + matrix.T) * 0.5).tocsc()

    def _blocks(self, system: System, state: State, group: Group, memory: Floats, part: slice) -> tuple[Ints, Floats]:
        b = group.block
        some = Block(b.indices[part], b.parameters[part], memory[part], rooms=b.rooms)
        blocks = system.stiffness_blocks(Group(group.cls, some, []), state, memory[part])
        if self.axes is not None:
            more = max(int(some.indices.max()) + 1 - self.count, 0)
            axes = np.concatenate([self.axes, np.tile(np.eye(3), (more, 1, 1))]) if more else self.axes
            dispatch.compiled(turn_blocks)(axes, some.indices, blocks)
        return some.indices, blocks


def _numbers(index: Ints, number: Ints, count: int, after: int) -> Ints:
    """Unknowns (m, 3 arity) of elements; -1 for none. Nodes of their own have one axis."""
    axes = 3 * index[:, :, None] + np.arange(3)
    found = np.where(index[:, :, None] < count, number[np.minimum(axes, len(number) - 1)], -1)
    found[:, :, 0] = np.where(index < count, found[:, :, 0], after + index - count)
    return found.reshape(len(index), -1)


def factor(matrix: Any) -> Factor | None:
    """Factors of a symmetric CSC matrix, with the number of its negative eigenvalues; None where it is singular."""
    import scipy.sparse as sparse

    # every diagonal entry has a place, also one that is zero
    whole = (matrix + sparse.identity(matrix.shape[0], format="csc") * 0.0).tocsc()
    lower = sparse.tril(whole, format="csc")
    lower.sort_indices()
    return Factors(lower.indices.astype(np.int32), lower.indptr.astype(np.int32)).factor(lower.data)


def against_turns(matrix: Any, dofs: Ints, first: int, mass: Floats | None = None) -> tuple[Any, int]:
    """A tangent with its largest stiffness against turns of hinged joints that meet none and move nothing, and how many
    these are: the kernel of its part of rotations, of the unknowns from row `first` of the axes `dofs` on. Nothing else
    changes. Of more than `TURNS` rotations none are looked for.

    With the masses of the axes `dofs`, what is added to K is s M V (V' M V)^-1 V' M, V the turns: in K phi = omega^2 M
    phi they then have omega^2 = s, a bound of all others, and all other modes stay, for they are M-orthogonal to V."""
    import scipy.sparse as sparse

    turning = np.flatnonzero(dofs >= 3 * first)
    if not 0 < len(turning) <= TURNS:
        return matrix, 0
    sizes, vectors = np.linalg.eigh(matrix[turning][:, turning].toarray())
    loose = vectors[:, np.abs(sizes) <= NOTHING * max(float(np.abs(sizes).max()), 1e-300)]
    if not loose.shape[1]:
        return matrix, 0
    row, column = np.repeat(turning, len(turning)), np.tile(turning, len(turning))
    held = (_most(matrix, mass) * _across(loose, None if mass is None else mass[turning])).ravel()
    return (matrix + sparse.coo_matrix((held, (row, column)), shape=matrix.shape)).tocsc(), loose.shape[1]


def _most(matrix: Any, mass: Floats | None) -> float:
    """A bound of the eigenvalues of K, or of M^-1/2 K M^-1/2; unknowns after the masses have none."""
    if mass is None:
        return largest_row(matrix)
    import scipy.sparse as sparse

    root = sparse.diags(np.append(1.0 / np.sqrt(mass), np.ones(matrix.shape[0] - len(mass))))
    return largest_row(root @ matrix @ root)


def _across(loose: Floats, mass: Floats | None) -> Floats:
    """V V', or M V (V' M V)^-1 V' M, of orthonormal columns V."""
    if mass is None:
        return np.asarray(loose @ loose.T)
    heavy = mass[:, None] * loose
    return np.asarray(heavy @ np.linalg.solve(loose.T @ heavy, heavy.T))


def largest_row(matrix: Any) -> float:
    """The largest sum of sizes in a row of a matrix: a bound of its eigenvalues."""
    return float(abs(matrix).sum(axis=1).max()) if matrix.shape[0] else 0.0


def condensed(matrix: Any, count: int) -> Floats:
    """A matrix as a dense one (count, count): the Schur complement of the unknowns after `count`."""
    dense = matrix.toarray()
    if len(dense) == count:
        return np.asarray(dense)
    inner = dense[count:, count:]
    return np.asarray(dense[:count, :count] - dense[:count, count:] @ np.linalg.solve(inner, dense[count:, :count]))
