"""The stiffness that forces have which a small movement brings, where the shape is: G of linear buckling.

An element with the energy W(s) of strains s(x) has the tangent s' W'' s' + W' s''. Its forces W' change along a
movement u by W'' s' u; times s'' that is its part of G. Of a line s is its length l, and s'' = (1 - d d) / l across its
direction d. As T / l, with the tension T, changes by (T' - T / l) l' / l, a force density that stays is no change.
Source: Bathe, Finite Element Procedures, 1996, sections 6.3.3 and 6.8.2.
"""

from __future__ import annotations

from itertools import chain
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.analysis.matrices import Unknowns
from hookean.compiled import dispatch
from hookean.system.group import Group
from hookean.system.state import State
from hookean.system.system import System

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


def known(group: Group) -> bool:
    """Whether the strains of a group's elements are known, so that the forces of a movement are, too."""
    return any(found is not None for found in (group.cls.stressed, group.cls.bent, group.cls.central))


def stress_stiffness(unknowns: Unknowns, system: System, state: State, moved: Floats) -> Any:
    """The stiffness that the forces of a movement (n, 3) have where the shape is, as a symmetric CSC matrix."""
    import scipy.sparse as sparse

    number = np.full(state.x.size, -1)
    number[unknowns.dofs] = np.arange(size := len(unknowns.dofs))
    found = sparse.csc_matrix((size, size))
    pairs = (_blocks(group, own, state.x, moved) for group, own in zip(system.groups, state.memory, strict=True))
    for index, blocks in chain.from_iterable(pairs):
        mine = number[(3 * index[:, :, None] + np.arange(3)).reshape(len(index), -1)]
        row, column = (np.broadcast_to(m, blocks.shape) for m in (mine[:, :, None], mine[:, None, :]))
        kept = (row >= 0) & (column >= 0)
        found = found + sparse.coo_matrix((blocks[kept], (row[kept], column[kept])), shape=(size, size)).tocsc()
    return (found + found.T) * 0.5


def _blocks(group: Group, memory: Floats, x: Floats, moved: Floats) -> list[tuple[Ints, Floats]]:
    """The particles of elements and their blocks; none where strains are not known."""
    block = group.block
    count, arity = block.indices.shape
    if not known(group) or not count:
        return []
    if group.cls.bent is not None:
        return group.cls.bent(block, x, moved)
    if group.cls.stressed is None:
        return [(block.indices, _of_lines(group, memory, x, moved))]
    blocks = np.zeros((count, 3 * arity, 3 * arity))
    along = np.column_stack([memory, moved[block.indices].reshape(count, -1)])
    dispatch.compiled(group.cls.stressed, "hessian")(x, block.indices, block.parameters, along, blocks)
    return [(block.indices, blocks)]


def _of_lines(group: Group, memory: Floats, x: Floats, moved: Floats) -> Floats:
    """Blocks (m, 6, 6) of forces along lines; zeros for lines of zero length, which have no direction."""
    block, rows = group.block, np.zeros((len(group.block.indices), 5))
    dispatch.compiled(group.cls.central, "central")(x, block.indices, block.parameters, memory, rows)
    stiff, density, d = rows[:, 0], rows[:, 1], rows[:, 2:]
    first, second = block.indices.T
    length = ((x[second] - x[first]) * d).sum(axis=1)
    longer = ((moved[second] - moved[first]) * d).sum(axis=1)
    strain = np.divide(longer, length, out=np.zeros_like(length), where=length > 0.0)
    across = ((stiff - density) * strain)[:, None, None] * (np.eye(3) - d[:, :, None] * d[:, None])
    return np.asarray(np.block([[across, -across], [-across, across]]))
