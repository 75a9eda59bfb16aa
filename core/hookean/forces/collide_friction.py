"""Spheres of `collide` that lose speed in a contact and rub: what they do in time, in the place of its quick kernel."""

from __future__ import annotations

from typing import Any

import numpy as np

from hookean.compiled.marks import device
from hookean.forces.base import Block, Floats
from hookean.forces.cells import RADIUS
from hookean.forces.crowd_rows import NEAREST, ROOM, SKIN, STIFFNESS, end_of_crowd
from hookean.forces.neighbours import order_in, pairs_listed, tables
from hookean.forces.runs import ends
from hookean.forces.strays import listed, some_pairs

RATIO, FRICTION, DASHPOT = 5, 6, 7  # columns of the parameters, after those of `collide`
PARTNER, PLACE, SLOT = 0, 1, 4  # of the memory of a contact: number of the other sphere and 1, where it holds on
# contacts that a sphere remembers: those with spheres of its size and larger, of which 12 can touch; some more overlap
SLOTS = 14
CONTACTS = 6.0  # of a sphere in a dense packing, for the bound of its damping
SMALLEST = 1e-300  # restitution below which it is this
UNMOVED = 1e150  # mass of a sphere that is held: its square is a number still


@device
def slot(memory: Any, e: Any, partner: Any) -> Any:
    """Where a sphere remembers a contact, or with 0 where it could; -1 if nowhere."""
    for s in range(0, SLOTS * SLOT, SLOT):
        if memory[e, s + PARTNER] == partner:
            return s
    return -1


@device
def meet(x: Any, indices: Any, parameters: Any, a: Any, b: Any, n: Any) -> Any:
    """From one sphere to another that it overlaps: the direction into the first row of `n`, the whole into the second;
    the overlap, 0 where they do not."""
    square = 0.0
    for c in range(3):
        n[1, c] = x[indices[b, 0], c] - x[indices[a, 0], c]
        square += n[1, c] * n[1, c]
    length = np.sqrt(square)
    if length <= NEAREST:
        return 0.0
    for c in range(3):
        n[0, c] = n[1, c] / length
    return max(parameters[a, RADIUS] + parameters[b, RADIUS] - length, 0.0)


@device
def slipped(memory: Any, a: Any, s: Any, n: Any) -> Any:
    """How far the other sphere has slipped along the contact from where it holds on, into the third row of `n`, and
    that as a distance; 0 where it came to it in this step."""
    along, square = 0.0, 0.0
    for c in range(3):
        n[2, c] = n[1, c] - memory[a, s + PLACE + c] if s >= 0 else 0.0
        along += n[2, c] * n[0, c]
    for c in range(3):
        n[2, c] -= along * n[0, c]
        square += n[2, c] * n[2, c]
    return np.sqrt(square)


@device
def rub(x, v, indices, parameters, memory, start, a, b, n, sums) -> Any:  # type: ignore[no-untyped-def]
    """Add the forces of two spheres that overlap; returns their energy."""
    overlap = meet(x, indices, parameters, a, b, n)
    if overlap == 0.0:
        return 0.0
    k, one, other = parameters[a, STIFFNESS], parameters[a, DASHPOT], parameters[b, DASHPOT]
    least, most = min(one, other), max(one, other)
    part = least / most if most > 0.0 else 0.0
    c = least / np.sqrt(1.0 + part * part) if least < UNMOVED else 0.0  # 2 zeta sqrt(k m), m their reduced mass
    closing = 0.0
    for i in range(3):
        n[3, i] = v[indices[b, 0], i] - v[indices[a, 0], i]
        closing -= n[3, i] * n[0, i]
    push = k * overlap + c * closing
    s = slot(memory, a, b - start + 1.0)
    far, limit = slipped(memory, a, s, n), parameters[a, FRICTION] * max(push, 0.0)
    kept = k * min(1.0, parameters[a, FRICTION] * overlap / far) if far > 0.0 else k
    square = 0.0
    for i in range(3):
        n[2, i] = kept * n[2, i] + c * (n[3, i] + closing * n[0, i])
        square += n[2, i] * n[2, i]
    held = min(1.0, limit / np.sqrt(square)) if square > 0.0 else 0.0
    for i in range(3):
        force = push * n[0, i] - held * n[2, i]
        sums[a - start, i] -= force
        sums[b - start, i] += force
    return 0.5 * k * overlap * overlap


@device
def hold_on(x: Any, indices: Any, parameters: Any, memory: Any, start: Any, a: Any, b: Any, n: Any) -> None:
    """Remember where one sphere would be from another without friction, up to what that can hold."""
    overlap = meet(x, indices, parameters, a, b, n)
    if overlap == 0.0 or parameters[a, FRICTION] == 0.0:
        return
    s = slot(memory, a, start - b - 1.0)
    far, most = slipped(memory, a, s, n), parameters[a, FRICTION] * overlap
    s = slot(memory, a, 0.0) if s < 0 else s
    if s < 0:
        return
    kept = most / far if far > most else 1.0
    memory[a, s + PARTNER] = b - start + 1.0
    for c in range(3):
        memory[a, s + PLACE + c] = n[1, c] - kept * n[2, c]


@device
def sweep(x, v, indices, parameters, memory, f, w, noting) -> Any:  # type: ignore[no-untyped-def]
    """All contacts, in the order of the list of neighbours: forces, or if `noting` what is remembered."""
    energy, stop, n = 0.0, 0, np.zeros((4, 3))
    while stop < indices.shape[0]:
        start = stop
        room, skin, stop = parameters[start, ROOM], parameters[start, SKIN], end_of_crowd(parameters, start)
        count, several = stop - start, 1
        here, sums, _ = tables(room, count)
        order, often, total = order_in(room, count), np.zeros(count), np.zeros((count, 3))
        short = listed(x, indices, parameters, start, here, sums, np.zeros(count), order, room, skin)
        pairs, reach, number = pairs_listed(room)
        if not short:
            pairs, reach, several = np.empty(count, np.int64), np.empty(count), count
        for row in range(several):
            if not short:
                number = some_pairs(parameters, start, order, row, pairs, reach)
            for m in range(number):
                i, j = ends(pairs[m])
                a, b = start + int(order[int(i)]), start + int(order[int(j)])
                if (parameters[b, RADIUS], b) < (parameters[a, RADIUS], a):  # the smaller one remembers
                    a, b = b, a
                if noting:
                    hold_on(x, indices, parameters, memory, start, a, b, n)
                    continue
                square = 0.0
                for c in range(3):
                    square += (x[indices[a, 0], c] - x[indices[b, 0], c]) ** 2
                if square < (reach[m] + skin) * (reach[m] + skin):  # they may touch before this is asked for again
                    often[a - start] += 1.0
                    often[b - start] += 1.0
                energy += rub(x, v, indices, parameters, memory, start, a, b, n, total)
        if not noting:
            for e in range(start, stop):
                w[indices[e, 0]] += 2.0 * parameters[e, STIFFNESS] * (1.0 + often[e - start])
                for c in range(3):
                    f[indices[e, 0], c] += total[e - start, c]
    return energy


def rough_collide_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    return sweep(x, v, indices, parameters, memory, f, w, False)


def rough_collide_note(x, indices, parameters, memory):  # type: ignore[no-untyped-def]
    for e in range(indices.shape[0]):  # contacts that are not met again are forgotten
        for s in range(0, SLOTS * SLOT, SLOT):
            memory[e, s + PARTNER] = -memory[e, s + PARTNER]
    sweep(x, x, indices, parameters, memory, x, np.zeros(1), True)
    for e in range(indices.shape[0]):
        for s in range(0, SLOTS * SLOT, SLOT):
            memory[e, s + PARTNER] = max(memory[e, s + PARTNER], 0.0)


def damping_ratio(restitution: float) -> float:
    """The part zeta of critical damping that leaves two spheres a part of their speed: -ln e / sqrt(pi^2 + ln^2 e)."""
    log = np.log(max(restitution, SMALLEST))
    return 1.0 if restitution == 0.0 else float(-log / np.hypot(np.pi, log))


def dashpots(block: Block, mass: Floats) -> None:
    """Write the dashpot of each sphere by its mass, 2 zeta sqrt(k m) [force time/length], and a bound of all
    damping."""
    p, own = block.parameters, mass[block.indices[:, 0]]
    moves = np.isfinite(own)
    p[:, DASHPOT] = 2.0 * p[:, RATIO] * np.sqrt(p[:, STIFFNESS] * np.where(moves, own, 1.0))
    p[:, DASHPOT + 1] = CONTACTS * p[:, DASHPOT]
    p[~moves & (p[:, DASHPOT] > 0.0), DASHPOT] = UNMOVED
