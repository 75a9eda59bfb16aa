"""Which corners of a rod continue each other, and how it was drawn, in a frame without twist.

Two corners continue each other where they share a segment, each about its own end of it: a, b, c and b, c, d, given in
any order and direction. Where more than two corners share a segment, chains end.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.compiled import dispatch
from hookean.compiled.marks import device
from hookean.forces.base import Floats, Ints
from hookean.forces.rod_chain import (
    ALONE,
    CLOSED,
    END,
    FACTOR,
    HELD,
    LATER,
    NEXT,
    OPEN,
    PLACE,
    REST,
    SHARE,
    SIDE,
    START,
    TURN,
    ends,
    folded,
    follower,
)  # fmt: skip
from hookean.forces.rod_frames import FOLD, angle_from, carried, corner, cross, dot, square_to

BENT = 1e-6  # turn [rad] from which on a corner is drawn to a side, and a rest angle asks for one


def link(x: Floats, corners: Ints, table: Floats) -> None:
    """Write into the parameters of `corners` (m, 3) which of them make chains, and how these are drawn at `x`."""
    partner = _partners(corners, _bends(x, corners))
    x, corners = x.copy(), corners.copy()  # a scene's own arrays are not for writing, and machine code asks for that
    dispatch.compiled(string)(partner, corners[:, ::2].copy(), corners[:, 1].copy(), table)
    dispatch.compiled(draw)(x, corners, table)


def hold(corners, table, held):  # type: ignore[no-untyped-def]
    """Write which ends of chains that were drawn to a side are at particles that are held (n,)."""
    for first in range(table.shape[0]):
        sided = table[first, START] != 0.0 or table[first, START + 1] != 0.0 or table[first, START + 2] != 0.0
        if abs(table[first, PLACE]) != OPEN or not sided:
            continue
        start, _, end = ends(corners, table, first)
        e = follower(table, first)
        while e >= 0:
            _, _, end = ends(corners, table, e)
            e = follower(table, e)
        table[first, HELD], table[first, HELD + 1] = 1.0 if held[start] else 0.0, 1.0 if held[end] else 0.0


def whole_chains(table: Floats, rows: Ints) -> Ints:
    """The rows given, and all others of their chains, sorted."""
    chosen = np.zeros(len(table), np.bool_)
    chosen[rows] = True
    dispatch.compiled(complete)(table, chosen)
    return np.flatnonzero(chosen)


def complete(table, chosen):  # type: ignore[no-untyped-def]
    """Choose the whole of each chain of which something is chosen."""
    for first in range(table.shape[0]):
        if abs(table[first, PLACE]) != OPEN and abs(table[first, PLACE]) != CLOSED:
            continue
        some, e = False, first
        while e >= 0:
            some = some or chosen[e]
            e = follower(table, e)
        e = first
        while e >= 0 and some:
            chosen[e] = True
            e = follower(table, e)


def _bends(x: Floats, corners: Ints) -> NDArray[np.bool_]:
    """Corners whose segments have lengths, and that are not folded back onto themselves: frames can be carried on."""
    u, v = x[corners[:, 1]] - x[corners[:, 0]], x[corners[:, 2]] - x[corners[:, 1]]
    uu, vv, uv = (u * u).sum(axis=1), (v * v).sum(axis=1), (u * v).sum(axis=1)
    apart = (uu > 1e-16 * vv) & (vv > 1e-16 * uu) & (uu * vv > 1e-280)
    size = np.sqrt(uu * vv)
    return np.asarray(apart & (size + uv > FOLD * size))


def _partners(corners: Ints, bends: NDArray[np.bool_]) -> Ints:
    """For each corner's first and last segment, as 2 row and 2 row + 1, the same segment in the corner that continues
    it; -1 where there is none."""
    if not len(corners):
        return np.zeros(0, np.int64)
    count = int(corners.max()) + 1
    outer, centre = corners[:, ::2].ravel(), np.repeat(corners[:, 1], 2)
    way, back = centre * count + outer, outer * count + centre
    ways, first, times = np.unique(way, return_index=True, return_counts=True)
    place = np.minimum(np.searchsorted(ways, back), len(ways) - 1)
    alone = (times == 1) & np.repeat(bends, 2)[first]
    met = (ways[place] == back) & alone[place] & alone[np.searchsorted(ways, way)]
    return np.where(met, first[place], -1)


@device
def beyond(partner: Any, row: Any, out: Any) -> Any:
    """The corner met on the way out of a corner by a side, and the side by which the way goes on."""
    met = partner[2 * row + out]
    return met // 2, 1 - met % 2


@device
def end_of(partner: Any, row: Any, out: Any) -> Any:
    """The last corner on the way out of a corner, its outer side, and whether the way comes round to where it began."""
    here, side = row, out
    while partner[2 * here + side] >= 0:
        here, side = beyond(partner, here, side)
        if here == row:
            return here, side, True
    return here, side, False


@device
def lowest(partner: Any, centre: Any, row: Any) -> Any:
    """The lowest corner of a closed chain, and the side towards its lower neighbour."""
    low = row
    here, side = beyond(partner, row, 0)
    while here != row:
        if centre[here] < centre[low] or (centre[here] == centre[low] and here < low):
            low = here
        here, side = beyond(partner, here, side)
    one, other = partner[2 * low] // 2, partner[2 * low + 1] // 2
    return low, 0 if centre[one] < centre[other] else 1


def string(partner, outer, centre, table):  # type: ignore[no-untyped-def]
    """Order of the corners of each chain, whatever that of the rows: from the end with the lower particle; of a closed
    one from its lowest corner towards the lower neighbour."""
    for row in range(centre.shape[0]):
        if table[row, PLACE] != ALONE:
            continue
        first, out, closed = end_of(partner, row, 0)
        if closed:
            first, out = lowest(partner, centre, row)
        else:
            other, side, _ = end_of(partner, row, 1)
            one, far = outer[first, out], outer[other, side]
            if far < one or (far == one and centre[other] < centre[first]):
                first, out = other, side
            out = 1 - out
        here, place = first, CLOSED if closed else OPEN
        while True:
            table[here, PLACE] = place if out == 1 else -place
            if partner[2 * here + out] < 0:
                break
            later, side = beyond(partner, here, out)
            if later == first:
                break
            table[here, NEXT] = later - here
            here, out, place = later, side, LATER


@device
def wants(table: Any, first: Any) -> Any:
    """Whether any corner of a chain wants to bend; if not, the chain is taken apart."""
    wanted, e = 0.0, first
    while e >= 0:
        wanted = max(wanted, table[e, REST] * table[e, FACTOR])
        e = follower(table, e)
    e = first
    while e >= 0 and not wanted > BENT:
        later = follower(table, e)
        table[e, PLACE], table[e, NEXT], table[e, SHARE] = ALONE, 0.0, 0.0
        e = later
    return wanted > BENT


@device
def share_out(table: Any, first: Any) -> None:
    """Where along a chain its corners are, by the lengths in their place: 0 at its start, 1 at its end."""
    length, done, e = 0.0, 0.0, first
    while e >= 0:
        length += table[e, SHARE]
        e = follower(table, e)
    e = first
    while e >= 0:
        own = table[e, SHARE]
        table[e, SHARE] = (done + 0.5 * own) / length if length > 0.0 else 0.0
        done += own
        e = follower(table, e)


@device
def side_before(table: Any, first: Any, e: Any, along: Any, across: Any) -> None:
    """Give the corners before one its side."""
    while first != e:
        table[first, SIDE], table[first, SIDE + 1] = along, across
        first = follower(table, first)


def draw(x, corners, table):  # type: ignore[no-untyped-def]
    """The sides to which chains are drawn, in their frames; corners drawn straight take that of the one before them, or
    else after. Chains that nowhere want to bend are taken apart."""
    for first in range(table.shape[0]):
        place = abs(table[first, PLACE])
        if (place != OPEN and place != CLOSED) or not wants(table, first):
            continue
        share_out(table, first)
        sided, along, across = False, 1.0, 0.0
        a, b, c = ends(corners, table, first)
        first_s, t, _, _, _, _, _, _ = corner(x, a, b, c)
        first_u = square_to(first_s)
        u, e = first_u, first
        while e >= 0:
            a, b, c = ends(corners, table, e)
            s, t, before, _, n, sine, cosine, angle = corner(x, a, b, c)
            if angle > BENT and not folded(before, cosine):
                along, across = dot(n, u) / sine, dot(n, cross(s, u)) / sine
                if not sided:
                    side_before(table, first, e, along, across)
                sided = True
            table[e, SIDE], table[e, SIDE + 1] = along, across
            u = carried(u, s, t)
            e = follower(table, e)
        if sided:
            target = carried(first_u, first_s, t) if place == CLOSED else square_to(t)
            table[first, TURN] = angle_from(u, target, t)
            for i in range(3):
                table[first, START + i], table[first, END + i] = first_s[i], t[i]
