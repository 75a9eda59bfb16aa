"""Stress stiffness of chains of corners: what the moments that a small movement brings add to their tangent.

A corner is strained by its turn less its turn at rest, tau - r, in the frame of its section, which follows the rod
without twist and spins with it. Its moment changes along a movement u by k times the change of this strain, and G is
these changes times the second derivatives of the strains. As a turn at rest is a constant of its frame, the tangent is
linear in it, with factors -k times these derivatives: G is the tangent of turns at rest that are less by the change of
the strain, without that of none. The spin that a free rod has of its own is an unknown like any other: it goes along
with u, and with the motions of the tangent, by its least energy. A rod that is straight at rest has no such spin.
"""

from __future__ import annotations

import numpy as np

from hookean.forces.base import Block, Floats, Ints
from hookean.forces.rod_frames import slopes, turn_vectors
from hookean.forces.rod_tangent import HEAD, KNOWN, PART, REST, RIGID, TWIST, WIDTH, Parts, shares, spinning

STRAIGHT = 0.01  # turn [rad] of a whole rod at rest below which it has no side


def single(block: Block, rows: Ints, x: Floats) -> Block:
    """Corners that spin alone as pieces of one corner: their turn at rest lies along their turn."""
    p, index = block.parameters[rows], block.indices[rows]
    turn = turn_vectors(x, index)
    size = np.linalg.norm(turn, axis=1)
    table = np.zeros((len(rows), HEAD + WIDTH))
    each = table[:, HEAD:]
    each[:, RIGID], each[:, PART], each[:, KNOWN] = p[:, 0], 1.0, size < np.pi
    each[:, REST : REST + 3] = turn * (p[:, 1] * p[:, 2] / np.where(size > 0.0, size, 1.0))[:, None]
    return Block(np.ascontiguousarray(index), table, np.zeros((len(rows), 0)))


def stress_stiffness(pieces: Block, x: Floats, moved: Floats) -> Floats:
    """G (k, 3 a, 3 a) of pieces of rods of `rod_tangent` for a movement (n, 3)."""
    index, table = pieces.indices, pieces.parameters
    along = moved[index].reshape(len(index), -1)
    parts = Parts.of(index, table, x)
    own = _spin(parts, table)
    change, s, turn = _strains(parts, index, x, along, own)
    most = np.linalg.norm(change, axis=2).max(axis=1, initial=0.0)  # differences have the digits of turns near 1
    change /= np.where(most > 0.0, most, 1.0)[:, None, None]
    brought, none = table.copy(), table.copy()
    for given in (brought, none):
        given[:, HEAD + TWIST :: WIDTH] = 0.0
        for c in range(3):
            given[:, HEAD + REST + c :: WIDTH] = 0.0
    for c in range(3):
        brought[:, HEAD + REST + c :: WIDTH] = -change[:, :, c]
    twist = table[:, HEAD + RIGID :: WIDTH] * (np.cross(-change, turn) * s).sum(axis=2)
    later = np.cumsum(twist[:, ::-1], axis=1)[:, ::-1] - twist
    brought[:, HEAD + TWIST :: WIDTH] = later - (shares(table) * twist).sum(axis=1)[:, None]
    after, before = Parts.of(index, brought, x), Parts.of(index, none, x)
    found = after.stiffness() - before.stiffness()
    slope = after.slope()[:, :, None] * own[:, None]
    found += slope + slope.transpose(0, 2, 1) + after.sizes.sum(axis=1)[:, None, None] * own[:, :, None] * own[:, None]
    return np.asarray(found * most[:, None, None])


def _spin(parts: Parts, table: Floats) -> Floats:
    """How the spin that all sections of a piece share goes with its particles (k, 3 a): by its least energy, and of
    rods that are straight at rest half of what the frame spins from their start to their end."""
    rigid, rests = table[:, HEAD + RIGID :: WIDTH], np.zeros_like(parts.sizes)
    for c in range(3):
        rests += table[:, HEAD + REST + c :: WIDTH] ** 2
    total = parts.phase.shape[1] * (rigid * rests).sum(axis=1)
    sided = spinning(table, parts.sizes) & (total >= STRAIGHT**2 * rigid.sum(axis=1))
    found = np.zeros((len(table), parts.phase.shape[2]))
    found[sided] = -parts.slope()[sided] / parts.sizes[sided].sum(axis=1)[:, None]
    free = ~sided & (table[:, :HEAD] == 0.0).all(axis=1)
    found[free] = -0.5 * (parts.phase[free, 0] + parts.phase[free, -1])
    return found


def _strains(parts: Parts, index: Ints, x: Floats, along: Floats, own: Floats) -> tuple[Floats, Floats, Floats]:
    """The change of the strain of each corner (k, n, 3) along a movement (k, 3 a) as a vector across its first segment,
    the direction of that, and the turn of the corner."""
    spin = np.einsum("kip,kp->ki", parts.phase, along) + (own * along).sum(axis=1)[:, None]
    places = x[index][:, parts.nodes]
    motion = along.reshape(*index.shape, 3)[:, parts.nodes]
    s, t = (_unit(places[:, :, i + 1] - places[:, :, i]) for i in (0, 1))
    ds, dt = (_turning(places[:, :, i + 1] - places[:, :, i], motion[:, :, i + 1] - motion[:, :, i]) for i in (0, 1))
    n, cosine = np.cross(s, t), (s * t).sum(axis=2)
    sine = np.linalg.norm(n, axis=2)
    h, rate = np.vectorize(slopes, otypes=[float, float])(sine, cosine, np.arctan2(sine, cosine))
    turn = h[:, :, None] * n
    more = (ds * t + s * dt).sum(axis=2)
    change = (rate * more)[:, :, None] * n + h[:, :, None] * (np.cross(ds, t) + np.cross(s, dt))
    change -= (change * s).sum(axis=2)[:, :, None] * s + spin[:, :, None] * np.cross(s, turn)
    return change, s, turn


def _unit(vectors: Floats) -> Floats:
    size = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.asarray(vectors / np.where(size > 0.0, size, 1.0))


def _turning(segment: Floats, motion: Floats) -> Floats:
    """How directions of segments change with a motion of their ends."""
    size = np.linalg.norm(segment, axis=-1, keepdims=True)
    way = segment / np.where(size > 0.0, size, np.inf)
    return np.asarray((motion - (motion * way).sum(axis=-1, keepdims=True) * way) / np.where(size > 0.0, size, np.inf))
