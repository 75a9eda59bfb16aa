"""Lumped stiffness of chains of corners: a bound of what each particle feels of its tangent.

Alone, with its frame held, a corner adds k |d tau|^2 + m . d^2 tau + T d^2 psi, with m = k (tau - r), tau and the spin
psi of transport in the frame between its segments: at most k + |m| max(1, tan(phi/2) / 2) + 0.6 |T| / cos^2(phi/2)
times (|ds| + |dt|)^2 (found by trying; see the tests).

In the chain its section also spins, by the sum of all d psi before it: by parts, a sum of c_p . dx_p over the particles
before, where twice c_p is the difference between the mean bends 2 tan(phi/2) / l of the segments at p, and of terms of
its own particles. A spin alpha adds k r . tau alpha^2 + 2 k |r| |d tau| |alpha|. Both are split among the particles by
Cauchy's inequality; a free rod may count its spins from the mean of both ends.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from hookean.compiled.marks import device
from hookean.forces.rod_chain import (
    CLOSED,
    END,
    FACTOR,
    PLACE,
    REST,
    START,
    STIFFNESS,
    direction,
    ends,
    folded,
    follower,
    spin_slope,
    ways,
)  # fmt: skip
from hookean.forces.rod_frames import corner, dot, mix

SUM, MOST, CURVED, RESTED, STIFFEST, LOOP, WEIGHED, ROOM = 0, 1, 2, 3, 4, 5, 8, 9  # what `weigh` finds


@device
def size(a: Any) -> Any:
    """|a|"""
    return np.sqrt(dot(a, a))


@device
def take(room: Any, w: Any, adding: Any, p: Any, change: Any) -> None:
    """Sum up how spins change with particle p, or add what follows from the sum."""
    if adding:
        w[p] += change * room[WEIGHED]
    else:
        room[SUM] += change
        room[MOST] = max(room[MOST], change)


@device
def weigh(x: Any, indices: Any, parameters: Any, first: Any, room: Any, w: Any, adding: Any) -> None:
    """Sum up a chain, and in a second round add to the lumped stiffness."""
    start, end, _ = ways(parameters, first)
    closed = abs(parameters[first, PLACE]) == CLOSED
    none = (0.0, 0.0, 0.0)
    bent, here, second, first_bent, first_length, after = none, none, none, none, 1.0, 1.0
    t, last_b, last_c, count, e = (1.0, 0.0, 0.0), 0, 0, 0, first
    while e >= 0:
        a, b, c = ends(indices, parameters, e)
        kept, length = t, after
        s, t, before, after, n, _, cosine, angle = corner(x, a, b, c)
        if folded(before, cosine):
            t, after = kept, length
            e = follower(parameters, e)
            continue
        past, last, bent = here, bent, mix(1.0 / (1.0 + cosine), n, 0.0, n)
        if count == 0 and start:
            last = spin_slope(direction(parameters, first, START), s)
        here = mix(1.0 / before, last, 1.0 / before, bent)
        if count == 0:
            first_bent, first_length = bent, before
            if closed and adding:
                here = (room[LOOP], room[LOOP + 1], room[LOOP + 2])
            elif start or end:
                take(room, w, adding, a, size(here))
        elif count == 1 and closed and not adding:
            second = here
        else:
            take(room, w, adding, a, size(mix(1.0, here, -1.0, past)))
        if adding:
            spin_alone(parameters, e, room, w, (a, b, c), (before, after), (size(last), size(bent)), angle)
        else:
            sum_up(parameters, e, room, before, after, angle)
        last_b, last_c, count = b, c, count + 1
        e = follower(parameters, e)
    if closed:
        loop = mix(1.0 / first_length, bent, 1.0 / first_length, first_bent)
        if not adding:
            room[LOOP], room[LOOP + 1], room[LOOP + 2] = loop[0], loop[1], loop[2]
            take(room, w, adding, last_b, size(mix(1.0, second, -1.0, loop)))
        take(room, w, adding, last_b, size(mix(1.0, loop, -1.0, here)))
    elif count > 0:
        after_all = spin_slope(t, direction(parameters, first, END)) if end else none
        behind = mix(1.0 / after, bent, 1.0 / after, after_all)
        take(room, w, adding, last_b, size(mix(1.0, behind, -1.0, here)))
        if end:
            take(room, w, adding, last_c, size(behind))


@device
def sum_up(parameters: Any, e: Any, room: Any, before: Any, after: Any, angle: Any) -> None:
    """Add a corner to the sums over the chain."""
    k, rest = parameters[e, STIFFNESS], parameters[e, REST] * parameters[e, FACTOR]
    room[CURVED] += k * rest * angle
    room[RESTED] += k * rest * rest
    both = 1.0 / before + 1.0 / after
    room[STIFFEST] = max(room[STIFFEST], 2.0 * k * both * both)


@device
def spin_alone(parameters: Any, e: Any, room: Any, w: Any, corners: Any, lengths: Any, bends: Any, angle: Any) -> None:
    """Add what the spin of a corner's section makes of its own bending, and by its own particles."""
    k, rest = parameters[e, STIFFNESS], parameters[e, REST] * parameters[e, FACTOR]
    one, other = 1.0 / lengths[0], 1.0 / lengths[1]
    bound = 2.0 * k * (rest * rest / (1.0 + 2.0 * rest) + room[RESTED])
    at_a, at_c = 0.5 * bends[1] * one, 0.5 * bends[1] * other
    at_b = bends[0] * one + 0.5 * bends[1] * abs(other - one)
    own = k * (1.0 + 2.0 * rest + 2.0 * rest * angle) * (at_a + at_b + at_c)
    w[corners[0]] += bound * one * (one + other) + own * at_a
    w[corners[1]] += bound * (one + other) * (one + other) + own * at_b
    w[corners[2]] += bound * other * (one + other) + own * at_c


@device
def bound_chain(x: Any, indices: Any, parameters: Any, first: Any, room: Any, w: Any) -> None:
    """Add to the lumped stiffness what the spins of the sections of a chain may add to its tangent."""
    room[:] = 0.0
    weigh(x, indices, parameters, first, room, w, False)
    if not room[STIFFEST] > 0.0:
        return
    start, end, shared = ways(parameters, first)
    # a free rod may count its spins from the mean of both ends
    sum_of_all = room[SUM] * (1.0 if start or end or shared > 0 else 0.25)
    part = np.sqrt(sum_of_all * room[MOST] * room[RESTED] / room[STIFFEST])
    room[WEIGHED] = sum_of_all * (2.0 * room[CURVED] + (room[RESTED] / part if part > 0.0 else 0.0))
    room[RESTED] = part
    weigh(x, indices, parameters, first, room, w, True)
