"""Tangents of chains of corners, corner by corner: the spins of sections are unknowns beside the positions.

The section of each corner has its spin alpha, a node of its own with one axis. It is carried to the next corner without
twist: alpha' - alpha - d psi . dx = 0, held by a penalty that leaves a part LOOSE of the twist. So a rod of any length
has a sparse tangent, with as many negative eigenvalues as that of `rod_tangent`, and steps that are right to LOOSE.
Where the angle that the frame misses is shared, its change is one more unknown of each corner, the same all along.
"""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np

from hookean.compiled import dispatch
from hookean.forces.base import Block, Floats, Force, Ints, lengths
from hookean.forces.rod_chain import CLOSED, END, HELD, PLACE, SHARE, START, STIFFNESS
from hookean.forces.rod_frames import turn_angles
from hookean.forces.rod_tangent import FIRST, HEAD, KNOWN, LAST, REST, RIGID, WIDTH, differ, string_out

LOOSE = 1e-5
SPIN, NEXT_SPIN, MISSED, NEXT_MISSED, SIZE = 9, 12, 15, 18, 21  # in a block: after the particles, axes of one number
# after what `differ` reads: penalty; length that makes spins lengths; share of the angle missed at a held start, and
# from here to the next corner; whether there is one; whether the spin is tied to its spin, or that of a held end;
# whether the angle missed is the same there; stiffness of spins that nothing needs
PENALTY, UNIT, OPENED, STEP, ONWARD, TIED, EVEN, LONE, COLUMNS = range(HEAD + WIDTH, HEAD + WIDTH + 9)


class Spins(Force):
    """Corners of rods with the spins of their sections: for their tangents alone, see `Bend.gathered`."""

    blur: ClassVar[float] = 5e-13
    tangent: ClassVar[Any] = staticmethod(lambda block, x: tangent(block.indices, block.parameters, x))


def gather(block: Block, found: Floats, x: Floats, node: int) -> Block:
    """The corners of all chains of a block as elements of seven nodes: a, b, c; the spin here and at the next corner;
    the change of the angle missed here and there. Nodes from `node` on are spins and angles.

    `found` (m, 5) is what `rod_chain.record` finds at `x`.
    """
    p = block.parameters
    rows, lasts = np.empty(len(found), np.int64), np.zeros(len(found), np.bool_)
    count = dispatch.compiled(string_out)(p, rows, lasts)
    rows, lasts = rows[:count], lasts[:count]
    begins = np.flatnonzero(np.concatenate([[True], lasts[:-1]]))
    chain: Ints = np.cumsum(lasts) - lasts  # of each corner
    corners = np.where(p[rows, PLACE, None] < 0.0, block.indices[rows, ::-1], block.indices[rows])
    heads, first, last = rows[begins], begins[chain], np.flatnonzero(lasts)
    closed, start, end = np.abs(p[heads, PLACE]) == CLOSED, p[heads, HELD] > 0.0, p[heads, HELD + 1] > 0.0
    onward, shared = ~lasts | closed[chain], (closed | (start & end))[chain]
    # nodes that a corner does not need are its own spin once more
    own = node + np.arange(count)
    later = np.where(lasts, np.where(onward, own[first], own), own + 1)
    missed = np.where(shared, node + count - 1 + np.cumsum(shared), own)
    evened = shared & ~lasts
    nodes = [corners, own, later, missed, np.where(evened, np.append(missed[1:], -1), missed)]

    table = np.zeros((count, COLUMNS))
    table[:, HEAD + RIGID], table[:, HEAD + REST : HEAD + KNOWN + 1] = p[rows, STIFFNESS], found[rows]
    for column, held, at, given in ((FIRST, start, begins, START), (LAST, end, last, END)):
        table[at, column : column + 3] = np.where(held[:, None], p[heads, given : given + 3], 0.0)
    share = np.where(shared, p[rows, SHARE], 0.0)
    there = np.append(share[1:], 0.0)
    there[last] = shared[last] + np.where(closed, share[begins], 0.0)
    table[:, OPENED], table[:, STEP], table[:, ONWARD] = share, there - share, onward
    table[:, TIED], table[:, EVEN] = onward | end[chain], evened
    _weigh(table, corners, x, chain)
    return Block(np.column_stack(nodes), table, np.zeros((count, 0)))


def _weigh(table: Floats, corners: Ints, x: Floats, chain: Ints) -> None:
    """Write the penalty that holds the spins of each chain, and the length that makes them lengths."""
    k, rest = table[:, HEAD + RIGID], lengths(table[:, HEAD + REST : HEAD + REST + 3])
    size = np.bincount(chain)
    stiff = np.bincount(chain, k * rest * (rest + turn_angles(x, corners)))  # what resists a spin
    length = np.bincount(chain, lengths(x[corners[:, 1]] - x[corners[:, 0]])) / size
    table[:, PENALTY] = (size * stiff / LOOSE)[chain]
    table[:, UNIT] = np.where(length > 0.0, length, 1.0)[chain]
    # a rod that bends to no side does not care for its spin
    table[:, LONE] = np.where(stiff > 0.0, 0.0, np.bincount(chain, k) + 1e-300)[chain]


def tangent(indices: Ints, parameters: Floats, x: Floats) -> Floats:
    """Stiffness of corners (k, 21, 21), of their unknowns the first axis alone."""
    count, node = len(indices), np.arange(3).reshape(1, 3)
    own, spins, crossed = np.zeros((count, 1, 9, 9)), *np.zeros((2, count, 1, 9))
    sizes, opening, closing = np.zeros((count, 1)), np.zeros((count, 9)), np.zeros((count, 9))
    dispatch.compiled(differ)(x, indices, node, parameters, own, spins, crossed, sizes, opening, closing)
    unit = 1.0 / parameters[:, UNIT]
    whole, carried, held, even = np.zeros((count, SIZE, SIZE)), *np.zeros((3, count, SIZE))
    whole[:, :9, :9] = own[:, 0]
    whole[:, :9, SPIN] = whole[:, SPIN, :9] = crossed[:, 0] * unit[:, None]
    whole[:, SPIN, SPIN] = (sizes[:, 0] + parameters[:, LONE]) * unit**2
    carried[:, :9] = -(spins[:, 0] + closing)
    carried[:, SPIN], carried[:, NEXT_SPIN] = -unit, unit * parameters[:, ONWARD]
    carried[:, MISSED] = -unit * parameters[:, STEP]
    held[:, :9], held[:, SPIN], held[:, MISSED] = -opening, unit, -unit * parameters[:, OPENED]
    tied, start = parameters[:, TIED], (parameters[:, FIRST : FIRST + 3] != 0.0).any(axis=1)
    even[:, MISSED], even[:, NEXT_MISSED] = -unit, unit
    for row, there in ((carried, tied), (held, start), (even, parameters[:, EVEN])):
        whole += (parameters[:, PENALTY] * there)[:, None, None] * row[:, :, None] * row[:, None]
    return whole
