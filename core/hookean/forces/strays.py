"""Strays: the few spheres that leave their place in a list of neighbours join it again, and it continues to serve.

Where speeds differ, a few spheres are far from their places long before most. Such a stray gets a new place, where it
is, its old pairs go, and those about the new place come, from the grid of cells in which the list was found; strays are
in a chain of their new cell. All pairs in reach are listed again, in their order.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from hookean.compiled.dispatch import rows
from hookean.compiled.marks import device
from hookean.forces.cells import (
    RADIUS,
    SIDE,
    cell_at,
    cells_of,
    chains_of,
    ignore,
    runs_at,
    sorted_in,
)
from hookean.forces.neighbours import (
    COUNT,
    FOUND,
    HEAD,
    HERE,
    RANGE,
    STRAYS,
    WIDTH,
    as_seen,
    drift,
    gather,
    grid_in,
    near_seen,
    pairs_in,
    renew,
    seen_in,
    served,
    sort_pairs,
)
from hookean.forces.runs import BITS, FEW, both, ends, meet

ABOUT = 64  # pairs of a stray that there is place for, on average
NOW = 2  # mark of a stray whose pairs are being looked for; of earlier ones, 1


@device
def serves(at: Any, room: Any, most: Any) -> Any:
    """Whether the list in a room holds all pairs of spheres that have to be within the root of `most` of their places,
    once the few that are not have joined it again."""
    seen = seen_in(room)
    if near_seen(at, seen, most, 0.0, 0.0, 0.0):
        return True
    x, y, z = drift(at, seen)
    return near_seen(at, seen, most, x, y, z) or join_again(at, seen, room, most, x, y, z)


@device
def away(at: Any, seen: Any, most: Any, x: Any, y: Any, z: Any, strays: Any) -> Any:
    """Write down the spheres that are farther from their places than the root of `most`, but for a motion of all; how
    many, or one more than there is place for."""
    count, place = 0, strays.shape[0] - 1
    for n in range(at.shape[0]):
        i = np.uint64(n)
        d0, d1, d2 = at[i, 0] - seen[i, 0] - x, at[i, 1] - seen[i, 1] - y, at[i, 2] - seen[i, 2] - z
        strays[np.uint64(count)] = n  # overwritten by the next unless it counts: no branch
        count += 0 if d0 * d0 + d1 * d1 + d2 * d2 <= most else 1
        if count >= place:
            break
    return count


@device
def join_again(at: Any, seen: Any, room: Any, most: Any, x: Any, y: Any, z: Any) -> Any:
    """Give spheres that have strayed from a motion of all new places and pairs; False if there are too many of them, or
    of their pairs: the list is to be made."""
    head, size, (grid, anew, known) = rows(room, 1.0, HEAD), at.shape[0], grid_in(room)
    if head[0, COUNT] != size or anew.shape[0] != size or head[0, WIDTH] == 0.0:
        return False
    before = int(head[0, STRAYS])
    strays = np.empty(known.shape[0] + 2, np.int64)
    several, total = away(at, seen, most, x, y, z, strays), before
    if several > known.shape[0]:
        return False
    for n in range(several):
        total += 1 - anew[strays[n]]
    if total > known.shape[0]:
        return False
    for n in range(several):
        i = strays[n]
        if anew[i] == 0:
            known[before] = i
            before += 1
        anew[i] = NOW
        seen[i, 0], seen[i, 1], seen[i, 2] = at[i, 0] - x, at[i, 1] - y, at[i, 2] - z
    head[0, STRAYS] = before
    found, count, scale = np.empty((2, ABOUT * several), np.int64), 0, 1.0 / head[0, WIDTH]
    runs, begins = np.empty((18, 2), np.int64), np.empty(BITS, np.int64)
    link(seen, known, before, scale, grid)
    for n in range(several):
        count = about(seen, strays[n], head[0, RANGE], scale, grid, anew, runs, begins, found[0], count)
    unlink(seen, known, before, scale, grid)
    if count < 0:
        return False
    sort_pairs(found[0], count, size, found[1])
    kept = keep(room, anew, seen)
    for n in range(several):
        anew[strays[n]] = 1
    return insert(room, seen, kept, found[0], count)


@device
def apart(seen: Any, i: Any, j: Any) -> Any:
    """Whether two spheres are not of one group, and do not ignore each other."""
    return seen[i, 4] != seen[j, 4] or seen[i, 4] == 0.0


@device
def within(seen: Any, i: Any, j: Any, beyond: Any) -> Any:
    """Whether two spheres do not ignore each other, and have places within a range beyond their reach."""
    d0, d1, d2 = seen[i, 0] - seen[j, 0], seen[i, 1] - seen[j, 1], seen[i, 2] - seen[j, 2]
    reach = seen[i, 3] + seen[j, 3] + beyond
    return d0 * d0 + d1 * d1 + d2 * d2 < reach * reach and apart(seen, i, j)


@device
def link(seen: Any, known: Any, several: Any, scale: Any, grid: Any) -> None:
    """Put strays into the chains of the cells of their places."""
    chains, following = chains_of(grid, seen.shape[0])
    for n in range(several):
        i = known[n]
        a, b, c = cell_at(seen[i, 0], seen[i, 1], seen[i, 2], scale, grid)
        k = (a * grid[SIDE + 1] + b) * grid[SIDE + 2] + c
        following[i], chains[k] = chains[k], i + 1


@device
def unlink(seen: Any, known: Any, several: Any, scale: Any, grid: Any) -> None:
    """Empty these chains."""
    chains, _ = chains_of(grid, seen.shape[0])
    for n in range(several):
        i = known[n]
        a, b, c = cell_at(seen[i, 0], seen[i, 1], seen[i, 2], scale, grid)
        chains[(a * grid[SIDE + 1] + b) * grid[SIDE + 2] + c] = 0


@device
def about(seen, i, beyond, scale, grid, anew, runs, begins, found, count) -> Any:  # type: ignore[no-untyped-def]
    """List a stray with all in the cell of its place and the 26 about it, with one that joins as well once; how many
    pairs are listed then, -1 if there is no place."""
    (side, first, number), before = cells_of(grid, seen.shape[0]), count
    xs, ys, zs, radii = sorted_in(grid, seen.shape[0])
    a, b, c = cell_at(seen[i, 0], seen[i, 1], seen[i, 2], scale, grid)
    several, reach = runs_at(a, b, c, side, first, runs), seen[i, 3] + beyond
    count = meet(
        xs,
        ys,
        zs,
        radii,
        number,
        seen[i, 0],
        seen[i, 1],
        seen[i, 2],
        reach,
        i,
        runs,
        several,
        FEW,
        found,
        count,
        begins,
    )
    for n in range(before, count):
        one, other = ends(found[n])
        found[before] = found[n]
        before += 1 if anew[one] + anew[other] == NOW and apart(seen, one, other) else 0
    chains, following = chains_of(grid, seen.shape[0])
    for n in range(27):
        p, q = wrapped(a + n // 9 - 1, side[0]), wrapped(b + n // 3 % 3 - 1, side[1])
        j = chains[(p * side[1] + q) * side[2] + wrapped(c + n % 3 - 1, side[2])] - 1
        while j >= 0:
            if (anew[j] == 1 or j > i) and within(seen, i, j, beyond):
                before = add(i, j, found, before)
            j = following[j] - 1
    return before if count >= 0 else -1


@device
def wrapped(cell: Any, length: Any) -> Any:
    """A cell along an axis that may be one before the first or behind the last."""
    return cell + length if cell < 0 else cell - length if cell >= length else cell


@device
def add(i: Any, j: Any, found: Any, count: Any) -> Any:
    """List a pair; how many are listed then, -1 if there is no place."""
    if count < 0 or count >= found.shape[0]:
        return -1
    found[count] = both(i, j)
    return count + 1


@device
def keep(room: Any, anew: Any, seen: Any) -> Any:
    """Take the pairs of strays that join again out of the list; how many are left."""
    (pairs, reach), kept = pairs_in(room), 0
    for n in range(int(rows(room, 1.0, HEAD)[0, FOUND])):
        pair, apart = pairs[np.uint64(n)], reach[np.uint64(n)]
        i, j = ends(pair)
        k = np.uint64(kept)
        pairs[k], reach[k] = pair, apart
        kept += 1 if (anew[i] | anew[j]) < NOW else 0
    return kept


@device
def insert(room: Any, seen: Any, kept: Any, found: Any, count: Any) -> Any:
    """Put sorted pairs into the list, which has so many, from its end; whether there is place."""
    head, (pairs, reach) = rows(room, 1.0, HEAD), pairs_in(room)
    to = kept + count
    if to > pairs.shape[0]:
        return False
    head[0, FOUND] = to
    for n in range(count):
        i, j = ends(found[count - 1 - n])
        key = i << np.uint64(32) | j
        to -= 1
        while kept > 0:
            k = np.uint64(kept - 1)
            one, other = ends(pairs[k])
            if one << np.uint64(32) | other < key:
                break
            pairs[np.uint64(to)], reach[np.uint64(to)] = pairs[k], reach[k]
            kept, to = kept - 1, to - 1
        pairs[np.uint64(to)] = found[count - 1 - n]
        reach[np.uint64(to)] = seen[i, 3] + seen[j, 3]
    return True


@device
def listed(x, indices, parameters, start, here, sums, counts, order, room, skin) -> Any:  # type: ignore[no-untyped-def]
    """Gather elements, and see that the list in the room at an address holds all pairs within a skin [length] of their
    reach: it is made again if needed. If there is no place for it, False: every pair has to be checked."""
    gather(x, indices, start, here, sums, counts, order, False)
    count = here.shape[0]
    most = served(room, count, skin, skin)
    same = as_seen(here, parameters, start, order, seen_in(room), most)
    if same and (here.shape[1] != HERE or serves(here, room, most)):
        return True
    return renew(here, parameters, start, order, room, skin)


@device
def some_pairs(parameters: Any, start: Any, order: Any, i: Any, pairs: Any, reach: Any) -> Any:
    """Without a list: the pairs of a row with all later ones that it does not ignore; how many."""
    count = 0
    for j in range(i + 1, order.shape[0]):
        e, o = start + int(order[i]), start + int(order[j])
        if not ignore(parameters, e, o):
            pairs[count], reach[count] = both(i, j), parameters[e, RADIUS] + parameters[o, RADIUS]
            count += 1
    return count
