"""Tangents of chains of corners: pieces of rods, each one element with all of its particles.

Sections do not spin against each other, so that a corner feels every one before it: its section spins by alpha_i, the
sum of the spins psi of transport before it. The second variation is the sum of each corner's own with its frame held,
of 2 alpha_i dq_i, and of k r . tau alpha_i^2, with the rest turns and twisting moments of the whole rod. What all
sections of a free rod share is the spin of least energy: -g g^T / G, g and G the first and second derivatives by it.
Exact for rods in one piece; from piece to piece of a longer one the tangent leaves the spin free, so it is softer.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from hookean.compiled import dispatch
from hookean.compiled.marks import device
from hookean.forces.base import Block, Floats, Force, Ints
from hookean.forces.rod_chain import (
    CLOSED,
    END,
    HELD,
    PLACE,
    SHARE,
    START,
    STIFFNESS,
    begins,
    follower,
    slope_of,
    spin_slope,
)  # fmt: skip
from hookean.forces.rod_frames import aside, corner, cross, dot, mix, slopes

SHORTEST, ENTRIES = 32, 9_000_000  # corners of a piece if need be; all pieces together have about so many entries
STEP = 1e-6  # of differences, by the size of a corner
# of a piece: the directions of sections that are held at its start and end, how the angle missed is shared
FIRST, LAST, SHARED, HEAD = 0, 3, 6, 7
# of each of its corners: stiffness, rest turn, twisting moment after it, whether these are known, its share
RIGID, REST, TWIST, KNOWN, PART, WIDTH = 0, 1, 4, 5, 6, 7


class Rods(Force):
    """Pieces of rods as elements of any number of particles: for their tangents alone, see `Bend.gathered`."""

    blur: ClassVar[float] = 5e-13
    tangent: ClassVar[Any] = staticmethod(lambda block, x: tangent(block.indices, block.parameters, x))


def gather(block: Block, found: Floats) -> list[tuple[type[Force], Block]]:
    """The chains of a block in pieces, by their size; `found` (m, 5) is what `rod_chain.record` finds.

    A closed chain in one piece has as many particles as corners.
    """
    rows, lasts = np.empty(len(found), np.int64), np.zeros(len(found), np.bool_)
    count = dispatch.compiled(string_out)(block.parameters, rows, lasts)
    rows, cut = rows[:count], np.flatnonzero(lasts[:count]) + 1
    longest = max(SHORTEST, ENTRIES // (9 * max(count, 1)))
    by_size: dict[tuple[int, bool], list[tuple[Ints, bool, bool]]] = {}
    for start, stop in pairwise([0, *cut.tolist()]):
        length = stop - start
        parts = -(-length // longest)
        edges = [start + length * i // parts for i in range(parts + 1)]
        closed = parts == 1 and abs(block.parameters[rows[start], PLACE]) == CLOSED
        for one, other in pairwise(edges):
            by_size.setdefault((other - one, closed), []).append((rows[one:other], one == start, other == stop))
    return [
        (Rods, _pieces(block, found, np.array([p[0] for p in some]), np.array([p[1:] for p in some]), closed))
        for (_, closed), some in sorted(by_size.items(), key=lambda item: item[0])
    ]


def string_out(parameters, rows, lasts):  # type: ignore[no-untyped-def]
    """The rows of all chains, one chain after the other, and which of them are the last of theirs."""
    count = 0
    for first in range(parameters.shape[0]):
        e = first if begins(parameters, first) else -1
        while e >= 0:
            rows[count], later = e, follower(parameters, e)
            lasts[count] = later < 0
            e = later
            count += 1
    return count


def _pieces(block: Block, found: Floats, rows: Ints, whole: NDArray[np.bool_], closed: bool) -> Block:
    """Pieces of as many corners, `rows` (k, n) of the block; `whole` (k, 2): whether they are the first and the last of
    their chain."""
    p, (count, size) = block.parameters, rows.shape
    corners = np.where(p[rows, PLACE, None] < 0.0, block.indices[rows, ::-1], block.indices[rows])
    particles = corners[:, :, 1] if closed else np.hstack([corners[:, :1, 0], corners[:, :, 1], corners[:, -1:, 2]])
    table = np.zeros((count, HEAD + WIDTH * size))
    each = table[:, HEAD:].reshape(count, size, WIDTH)
    each[:, :, RIGID], each[:, :, PART] = p[rows, STIFFNESS], p[rows, SHARE]
    each[:, :, REST : KNOWN + 1] = found[rows]
    if closed:
        table[:, SHARED] = 1.0
        return Block(np.ascontiguousarray(particles), table, np.zeros((count, 0)))
    heads = rows[:, 0]  # of a whole rod; else it has no columns of one
    start, end = (p[heads, HELD] > 0.0) & whole[:, 0], (p[heads, HELD + 1] > 0.0) & whole.all(axis=1)
    table[:, FIRST : FIRST + 3] = np.where(start[:, None], p[heads, START : START + 3], 0.0)
    table[:, LAST : LAST + 3] = np.where(end[:, None], p[heads, END : END + 3], 0.0)
    table[:, SHARED] = np.where(start & end, 1.0, np.where(end, 2.0, 0.0))
    return Block(np.ascontiguousarray(particles), table, np.zeros((count, 0)))


@dataclass(frozen=True)
class Parts:
    """Of pieces of as many corners: of each corner its own stiffness (k, n, 9, 9), how the spin of its section and what
    it adds to the twisting moment change with the particles of its piece (k, n, 3 a), and k r . tau (k, n); `nodes`
    (n, 3) are its places among these particles."""

    own: Floats
    phase: Floats
    cross: Floats
    sizes: Floats
    nodes: Ints

    @classmethod
    def of(cls, indices: Ints, parameters: Floats, x: Floats) -> Parts:
        """The parts of pieces (k, a), from their particles and parameters."""
        count, particles = indices.shape
        size = (parameters.shape[1] - HEAD) // WIDTH
        nodes = (np.arange(size)[:, None] + np.arange(3) - (particles == size)) % particles
        own, spins, crossed = (np.zeros((count, size, 9, 9)), *np.zeros((2, count, size, 9)))
        sizes, opening, closing = np.zeros((count, size)), np.zeros((count, 9)), np.zeros((count, 9))
        dispatch.compiled(differ)(x, indices, nodes, parameters, own, spins, crossed, sizes, opening, closing)
        at = _axes(nodes)
        phase, cross = np.zeros((2, count, size, 3 * particles))
        spin = np.zeros((count, 3 * particles))
        spin[:, at[0]] = opening
        for i in range(size):
            phase[:, i] = spin
            cross[:, i, at[i]] = crossed[:, i]
            spin[:, at[i]] += spins[:, i]
        spin[:, at[-1]] += closing
        phase -= shares(parameters)[:, :, None] * spin[:, None]
        return cls(own, phase, cross, sizes, nodes)

    def stiffness(self) -> Floats:
        """Stiffness (k, 3 a, 3 a) without the spin that all sections share."""
        at, whole = _axes(self.nodes), np.zeros((len(self.own), *(2 * self.phase.shape[2:])))
        for i in range(len(at)):
            whole[:, at[i][:, None], at[i]] += self.own[:, i]
        both = self.phase.transpose(0, 2, 1) @ (self.cross + 0.5 * self.sizes[:, :, None] * self.phase)
        return np.asarray(whole + both + both.transpose(0, 2, 1))

    def slope(self) -> Floats:
        """How the moment about the spin that all sections share changes with the particles (k, 3 a)."""
        return np.asarray((self.cross + self.sizes[:, :, None] * self.phase).sum(axis=1))


def shares(parameters: Floats) -> Floats:
    """The part (k, n) that each corner of pieces has of the angle that the frame misses."""
    shared = parameters[:, SHARED, None]
    return np.asarray(np.where(shared == 1.0, parameters[:, HEAD + PART :: WIDTH], 0.5 * shared))


def spinning(parameters: Floats, sizes: Floats) -> NDArray[np.bool_]:
    """Whether the sections of pieces (k,) share a spin that is free and has a least energy."""
    return np.asarray((parameters[:, FIRST : LAST + 3] == 0.0).all(axis=1) & (sizes.sum(axis=1) > 0.0))


def _axes(nodes: Ints) -> Ints:
    """The places (n, 9) of the coordinates of corners in those of their piece."""
    return np.asarray((3 * nodes[:, :, None] + np.arange(3)).reshape(len(nodes), 9))


def tangent(indices: Ints, parameters: Floats, x: Floats) -> Floats:
    """Stiffness of pieces (k, 3 a, 3 a), from their particles and parameters."""
    parts = Parts.of(indices, parameters, x)
    whole, free = parts.stiffness(), spinning(parameters, parts.sizes)
    slope = parts.slope()[free]
    whole[free] -= slope[:, :, None] * slope[:, None] / parts.sizes[free].sum(axis=1)[:, None, None]
    return whole


def differ(x, indices, nodes, parameters, own, spins, crossed, sizes, opening, closing):  # type: ignore[no-untyped-def]
    """Of each corner: its own stiffness, how the spin of transport across it and what it adds to the twisting moment
    change with its particles, and k r . tau; the same spins of sections that are held."""
    here, low, high = np.zeros((3, 3)), np.zeros(10), np.zeros(10)
    none = (0.0, 0.0, 0.0)
    for p in range(indices.shape[0]):
        for i in range(nodes.shape[0]):
            column = HEAD + WIDTH * i
            if parameters[p, column + KNOWN] == 0.0:
                continue
            reach = 0.0
            for j in range(3):
                for c in range(3):
                    here[j, c] = x[indices[p, nodes[i, j]], c]
                    reach = max(reach, abs(here[j, c] - here[0, c]), abs(here[j, c] - here[1, c]))
            s, t, before, after, n, sine, cosine, angle = corner(here, 0, 1, 2)
            k, twist = parameters[p, column + RIGID], parameters[p, column + TWIST]
            r = three(parameters, p, column + REST)
            g0 = three(parameters, p, FIRST) if i == 0 else none
            g1 = three(parameters, p, LAST) if i == nodes.shape[0] - 1 else none
            turned(here, s, k, r, (twist, twist), (none, none), low)
            twists = (twist + low[9], twist)
            for at in range(9):
                j, c, place = at // 3, at % 3, here[at // 3, at % 3]
                here[j, c] = place - STEP * reach
                turned(here, s, k, r, twists, (g0, g1), low)
                here[j, c] = place + STEP * reach
                turned(here, s, k, r, twists, (g0, g1), high)
                here[j, c] = place
                for d in range(9):
                    slope = 0.25 * (high[d] - low[d]) / (STEP * reach)
                    own[p, i, d, at] += slope
                    own[p, i, at, d] += slope
                crossed[p, i, at] = 0.5 * (low[9] - high[9]) / (STEP * reach)
            h, _ = slopes(sine, cosine, angle)
            sizes[p, i] = k * h * dot(r, n)
            spin = spin_slope(s, t)
            spread(mix(-1.0 / before, spin, 0.0, n), mix(-1.0 / after, spin, 0.0, n), spins[p, i])
            if i == 0:
                spread(mix(-1.0 / before, spin_slope(g0, s), 0.0, n), none, opening[p])
            if i == nodes.shape[0] - 1:
                spread(none, mix(-1.0 / after, spin_slope(t, g1), 0.0, n), closing[p])


@device
def three(parameters: Any, p: Any, column: Any) -> Any:
    """A vector from three columns."""
    return parameters[p, column], parameters[p, column + 1], parameters[p, column + 2]


@device
def spread(on_s: Any, on_t: Any, out: Any) -> None:
    """A gradient by both segments of a corner as one by its three particles."""
    for c in range(3):
        out[c] = -on_s[c]
        out[3 + c] = on_s[c] - on_t[c]
        out[6 + c] = on_t[c]


@device
def turned(x: Any, s0: Any, k: Any, rest: Any, twists: Any, held: Any, out: Any) -> None:
    """Gradient of a corner whose rest turn was square to s0 and turns with its first segment, and after that what it
    adds to the twisting moment; `twists` are this moment before the corner as it was, and after it."""
    s, t, before, after, n, sine, cosine, angle = corner(x, 0, 1, 2)
    part = dot(rest, s) / (1.0 + dot(s0, s))
    r = (rest[0] - part * (s0[0] + s[0]), rest[1] - part * (s0[1] + s[1]), rest[2] - part * (s0[2] + s[2]))
    h, slope = slopes(sine, cosine, angle)
    turn = mix(h, n, 0.0, n)
    q = k * dot(cross(r, turn), s)
    on_s, on_t = slope_of(s, t, (before, after), turn, h, slope, r, k, (twists[1] + q, twists[1]))
    if dot(held[0], held[0]) > 0.0:
        on_s = mix(1.0, on_s, 1.0, aside(mix(twists[0], spin_slope(held[0], s), 0.0, n), s, before))
    if dot(held[1], held[1]) > 0.0:
        on_t = mix(1.0, on_t, 1.0, aside(mix(twists[1], spin_slope(t, held[1]), 0.0, n), t, after))
    spread(on_s, on_t, out)
    out[9] = q
