"""Chains of corners whose sections do not spin against each other: energy and forces.

A corner turns by the vector tau = phi n / |n| (see `rod_frames`); its rest turn is a vector r that travels with the
rod, carried along the chain from its first segment without twist. E = sum of k |tau - r|^2 / 2. What is left is the
spin that all sections share: that of least energy where the rod is free (a best rotation in the plane of the sections;
at its minimum it adds nothing to the forces). Where an anchor holds an end of the rod, the section there follows its
segment by parallel transport from the start direction. Where both ends are held, or the rod is closed, the angle by
which the carried frame misses its end is spread evenly along the length.

A corner adds q = k (r x tau) . s to the twisting moment T of the rod, which acts on the shape because the spin of what
is carried changes with it. The columns of `parameters` are those of `Bend.compile`; lumped stiffness is in `rod_bound`.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from hookean.compiled.marks import device
from hookean.forces.rod_frames import FOLD, angle_from, aside, carried, corner, cross, dot, mix, slopes, square_to

# columns of parameters; from TURN on they are those of a whole chain, in its first row
STIFFNESS, REST, FACTOR, SIDE, NEXT, PLACE, SHARE, TURN, START, END, HELD = 0, 1, 2, 3, 5, 6, 7, 8, 9, 12, 15
ALONE, OPEN, CLOSED, LATER = 0.0, 1.0, 2.0, 3.0  # what PLACE can be; negative: the corner runs against its chain
RE, IM, SHARED_RE, SHARED_IM, RESTS, WIND, FOUND = range(7)  # what `survey` finds
SIDELESS = 1e-9  # mean turn [rad] below which a free rod bends to no side


@device
def ends(indices: Any, parameters: Any, e: Any) -> Any:
    """Particles of a corner in the direction of its chain."""
    if parameters[e, PLACE] < 0.0:
        return indices[e, 2], indices[e, 1], indices[e, 0]
    return indices[e, 0], indices[e, 1], indices[e, 2]


@device
def follower(parameters: Any, e: Any) -> Any:
    """The row of the next corner; -1 after the last one."""
    later = e + int(parameters[e, NEXT])
    return later if later != e and 0 <= later < parameters.shape[0] else -1


@device
def single(parameters: Any, e: Any) -> Any:
    """Whether a row is an open chain of one corner whose ends are free to spin."""
    free = parameters[e, HELD] == 0.0 and parameters[e, HELD + 1] == 0.0
    return abs(parameters[e, PLACE]) == OPEN and parameters[e, NEXT] == 0.0 and free


@device
def begins(parameters: Any, e: Any) -> Any:
    """Whether a chain of more than that begins at a row."""
    return parameters[e, PLACE] != ALONE and abs(parameters[e, PLACE]) != LATER and not single(parameters, e)


@device
def ways(parameters: Any, first: Any) -> Any:
    """Whether the section at the start of a chain is held, and at its end; how the angle that the frame misses is
    shared: 0 not at all, 1 by length, 2 by all corners in full."""
    closed = abs(parameters[first, PLACE]) == CLOSED
    start, end = parameters[first, HELD] != 0.0 and not closed, parameters[first, HELD + 1] != 0.0 and not closed
    return start, end, 1 if closed or (start and end) else 2 if end else 0


@device
def direction(parameters: Any, first: Any, column: Any) -> Any:
    """The start direction of the first or last segment."""
    return parameters[first, column], parameters[first, column + 1], parameters[first, column + 2]


@device
def opening(parameters: Any, first: Any, start: Any, s: Any) -> Any:
    """The frame of the first segment, of direction s."""
    if not start:
        return square_to(s)
    g = direction(parameters, first, START)
    return carried(square_to(g), g, s)


@device
def folded(before: Any, cosine: Any) -> Any:
    """Whether nothing can be carried across a corner; frames skip it."""
    return before == 0.0 or 1.0 + cosine < FOLD


@device
def onward(u: Any, before: Any, s: Any) -> Any:
    """The frame carried to s where corners in between were skipped."""
    if before[0] == s[0] and before[1] == s[1] and before[2] == s[2]:
        return u
    return carried(u, before, s)


@device
def spin_slope(s: Any, t: Any) -> Any:
    """How the spin of what is carried from s to t falls with either."""
    return mix(1.0 / max(1.0 + dot(s, t), FOLD), cross(s, t), 0.0, s)


@device
def rest_turn(parameters: Any, e: Any, shared: Any, wind: Any, real: Any, imaginary: Any) -> Any:
    """The rest turn of a corner in its frame, spun by (real, imaginary) and its share of the angle `wind`."""
    size = parameters[e, REST] * parameters[e, FACTOR]
    if wind != 0.0:
        angle = wind * (parameters[e, SHARE] if shared == 1 else 1.0)
        c, s = np.cos(angle), np.sin(angle)
        real, imaginary = real * c - imaginary * s, real * s + imaginary * c
    along, across = parameters[e, SIDE], parameters[e, SIDE + 1]
    return size * (along * real - across * imaginary), size * (along * imaginary + across * real)


@device
def survey(x: Any, indices: Any, parameters: Any, first: Any, wind: Any, room: Any) -> None:
    """What the forces of a chain need to know of all of it, into `room`: the sum of k conj(r) tau as complex numbers of
    the frame, the same by shares, the sum of k |r|, the angle missed. `wind` is that angle, or 0 while unknown."""
    room[:FOUND] = 0.0
    start, end, shared = ways(parameters, first)
    s, t, u = (1.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)
    first_s, first_u, begun, e = s, u, False, first
    while e >= 0:
        a, b, c = ends(indices, parameters, e)
        kept = t
        s, t, before, _, n, sine, cosine, angle = corner(x, a, b, c)
        if folded(before, cosine):
            t = kept
            e = follower(parameters, e)
            continue
        if not begun:
            u, kept, begun = opening(parameters, first, start, s), s, True
            first_s, first_u = s, u
        u = onward(u, kept, s)
        h, _ = slopes(sine, cosine, angle)
        k, share = parameters[e, STIFFNESS], parameters[e, SHARE] if shared == 1 else 0.5 * shared
        along, across = rest_turn(parameters, e, shared, wind, 1.0, 0.0)
        on_u, on_v = h * dot(n, u), h * dot(n, cross(s, u))
        real, imaginary = k * (along * on_u + across * on_v), k * (along * on_v - across * on_u)
        room[RE] += real
        room[IM] += imaginary
        room[SHARED_RE] += share * real
        room[SHARED_IM] += share * imaginary
        room[RESTS] += k * np.sqrt(along * along + across * across)
        u = carried(u, s, t)
        e = follower(parameters, e)
    if begun and shared > 0:
        g = direction(parameters, first, END)
        target = carried(square_to(g), g, t) if end else carried(first_u, first_s, t)
        missed = angle_from(u, target, t) - parameters[first, TURN]
        room[WIND] = missed - 2.0 * np.pi * np.ceil((missed - np.pi) / (2.0 * np.pi))


@device
def spin_of(room: Any, held: Any) -> Any:
    """The spin of all sections as a complex number; 0 where a free rod has no side to bend to."""
    if held:
        return 1.0, 0.0
    size = np.sqrt(room[RE] * room[RE] + room[IM] * room[IM])
    if not size > SIDELESS * room[RESTS]:
        return 0.0, 0.0
    return room[RE] / size, room[IM] / size


@device
def slope_of(s: Any, t: Any, lengths: Any, turn: Any, h: Any, slope: Any, r: Any, k: Any, twist: Any) -> Any:
    """Gradient of a corner's energy by its first and by its second segment.

    `turn` is tau = h s x t, `slope` that of h (see `slopes`), r the rest turn square to s, `twist` the twisting moment
    before and after the corner.
    """
    spin = spin_slope(s, t)
    lean = cross(r, s)
    part = dot(r, t) / (1.0 + dot(s, t))
    back = cross(t, (r[0] - part * (s[0] + t[0]), r[1] - part * (s[1] + t[1]), r[2] - part * (s[2] + t[2])))
    on_s = mix(-k * (slope * dot(back, s) + h), t, -k * h, back)
    on_t = mix(-k * (slope * dot(lean, t) + h), s, -k * h, lean)
    return (
        aside(mix(1.0, on_s, twist[0], spin), s, lengths[0]),
        aside(mix(1.0, on_t, twist[1], spin), t, lengths[1]),
    )


@device
def pull(f: Any, a: Any, b: Any, g: Any) -> None:
    """Add the force of a gradient by the segment a-b."""
    for i in range(3):
        f[a, i] += g[i]
        f[b, i] -= g[i]


@device
def hold_section(f: Any, w: Any, a: Any, b: Any, s: Any, length: Any, twist: Any, spin: Any) -> None:
    """Add the force and the lumped stiffness of the section of a-b, of direction s, that is held against a twisting
    moment; `spin` is the slope of its spin."""
    pull(f, a, b, aside(mix(twist, spin, 0.0, spin), s, length))
    bound = 1.2 * abs(twist) * (1.0 + dot(spin, spin)) / (length * length)
    w[a] += bound
    w[b] += bound


@device
def weigh_corner(w: Any, at: Any, lengths: Any, k: Any, square: Any, tangent: Any, twist: Any) -> None:
    """Add the lumped stiffness of a corner alone, with its frame held; see `rod_bound`.

    `square` is |tau - r|^2, `tangent` that of half its angle, `twist` the sum of the twisting moments at both sides.
    """
    bound = k + k * np.sqrt(square) * max(1.0, 0.5 * tangent) + 0.3 * twist * (1.0 + tangent * tangent)
    one, other = 1.0 / lengths[0], 1.0 / lengths[1]
    w[at[0]] += 2.0 * bound * one * (one + other)
    w[at[1]] += 2.0 * bound * (one + other) * (one + other)
    w[at[2]] += 2.0 * bound * other * (one + other)


@device
def push_chain(x: Any, indices: Any, parameters: Any, first: Any, room: Any, f: Any, w: Any, found: Any) -> Any:
    """Add the forces of the chain that begins at row `first`, and its lumped stiffness but for `rod_bound`; returns its
    energy. `found` (m, 5) gets the rest turn of each corner, the twisting moment after it, and 1, or -1
    where the rod bends to no side.
    """
    survey(x, indices, parameters, first, 0.0, room)
    start, end, shared = ways(parameters, first)
    wind = room[WIND]
    if wind != 0.0:
        survey(x, indices, parameters, first, wind, room)
    real, imaginary = spin_of(room, start or end)
    sided = real != 0.0 or imaginary != 0.0
    twist = (room[IM] if start or end else 0.0) - (real * room[SHARED_IM] - imaginary * room[SHARED_RE])
    s, t, u, after, last = (1.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), 1.0, first
    energy, begun, e = 0.0, False, first
    while e >= 0:
        a, b, c = ends(indices, parameters, e)
        k, rest, kept, length = parameters[e, STIFFNESS], parameters[e, REST] * parameters[e, FACTOR], t, after
        s, t, before, after, n, sine, cosine, angle = corner(x, a, b, c)
        if folded(before, cosine):
            energy += 0.5 * k * (angle * angle + rest * rest) if before > 0.0 else 0.0
            t, after = kept, length
            e = follower(parameters, e)
            continue
        if not begun:
            u, kept, begun = opening(parameters, first, start, s), s, True
            if start:
                hold_section(f, w, a, b, s, before, twist, spin_slope(direction(parameters, first, START), s))
        u = onward(u, kept, s)
        h, slope = slopes(sine, cosine, angle)
        turn = mix(h, n, 0.0, n)
        along, across = rest_turn(parameters, e, shared, wind, real, imaginary)
        r = mix(along, u, across, cross(s, u))
        off = mix(1.0, turn, -1.0, r)
        energy += 0.5 * k * (dot(off, off) if sided else dot(off, off) + rest * rest)
        gone = twist - k * dot(cross(r, turn), s)
        on_s, on_t = slope_of(s, t, (before, after), turn, h, slope, r, k, (twist, gone))
        pull(f, a, b, on_s)
        pull(f, b, c, on_t)
        weigh_corner(w, (a, b, c), (before, after), k, dot(off, off), sine / (1.0 + cosine), abs(twist) + abs(gone))
        if e < found.shape[0]:
            found[e, 0], found[e, 1], found[e, 2], found[e, 3] = r[0], r[1], r[2], gone
            found[e, 4] = 1.0 if sided else -1.0
        u, twist, last = carried(u, s, t), gone, e
        e = follower(parameters, e)
    if begun and end:
        _, b, c = ends(indices, parameters, last)
        hold_section(f, w, b, c, t, after, twist, spin_slope(t, direction(parameters, first, END)))
    return energy


def record(x, indices, parameters, room, f, w, found):  # type: ignore[no-untyped-def]
    """`push_chain` of all chains; corners of no chain leave their rows of `found`."""
    for e in range(indices.shape[0]):
        if begins(parameters, e):
            push_chain(x, indices, parameters, e, room, f, w, found)
