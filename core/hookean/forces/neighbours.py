"""Neighbours: which of many elements are near enough to touch.

An element is a sphere about a particle or a capsule about two. The list is kept in a room beside the kernel
(`make_room`) and holds all pairs whose places are within a range beyond their reach. It serves as long as nothing is
farther from its place than half of what the range has beyond what is asked for, but for a motion that all spheres have
in common, or has another size. Two that are within a margin of their reach then have places within the range, by the
triangle inequality, wherever the places are: the places of spheres that keep moving are ahead of them, where they are
expected at half of the time of the list, which so serves up to twice as long (`course`). Pairs are listed by their
first row, then by their second, and those that are too far away count nothing, so that sums do not depend on when the
list was made, or how far it ranges. The range follows the motion (`list_range`): a list that lasts long has fewer
pairs, one that lasts briefly more.

Rows are elements in the order in which they are given, if neighbours are then near in memory; else layer by layer from
where they are at the start (`in_layers`). Source: Verlet, "Computer experiments on classical fluids", 1967 (the list).
"""

from __future__ import annotations

from typing import Any

import numpy as np

from hookean.compiled.dispatch import rows
from hookean.compiled.marks import device
from hookean.forces.cells import GROUP, RADIUS, SEEN, SEEN_CAPSULE, find_pairs, grid_words
from hookean.forces.list_range import FIRST, LEAST, MOST, ROOM, changed, for_two, much
from hookean.forces.runs import ends

# the head of a room: elements and pairs it has place for; range beyond the reach, elements listed, particles of an
# element; pairs listed, how often the list was used, whether rows are elements as given; uses that places are ahead;
# width of the cells in which all elements are, or 0; how many elements have joined the list again (`strays`)
SIZE, PAIRS, RANGE, COUNT, ENDS, FOUND, USED, AS_GIVEN, AHEAD, WIDTH, STRAYS = range(11)
HEAD = 11
HERE = 4  # of each element now: x y z and a zero
HERE_CAPSULE = 16  # the sphere, half axis, radius, force at the start, at the end, nothing, stiffness
SUMS = 4  # of each sphere what a kernel sums: its force and a zero; then, apart, how often it counts for the stiffness
BEGAN = 3  # of each sphere: where it was as the list was made
PER_ELEMENT = 24  # pairs of an element that there is place for, on average
ALONE = 32  # as many elements as this to one that may join a list again
LOCAL = 2.0  # how much longer than layer by layer the way through elements as given may be
MOST_OF = 4.0  # times the mean square of speeds: more than those of all but a few, in the spread of a gas
ONE = np.uint64(1)
BARELY = 2.2  # range by the way from a place: a tenth more than is needed, else too many leave a list
# of the way that a list allows: how far spheres are from their places as it is made, at most and at least
MOST_AHEAD, LEAST_AHEAD = 0.9, 1e-3


def make_room(corners: Any) -> np.ndarray:
    """A room (1, k) for the list of elements with corners (n, 1 or 2, 3) at the start; its address goes into the column
    `room` of parameters."""
    count, size = corners.shape[:2]
    middles = corners.mean(axis=1)
    order = in_layers(middles)
    as_given = way(middles) <= LOCAL * way(middles[order])
    words = HERE + SUMS + 1 + SEEN if size == 1 else HERE_CAPSULE + SEEN_CAPSULE
    more = grid_words(count) + most_strays(count)
    room = np.zeros((1, HEAD + (words + 1 + 2 * PER_ELEMENT + BEGAN + 1) * count + more))
    room[0, :HEAD] = count, PER_ELEMENT * count, 0.0, -1.0, size, 0.0, 0.0, as_given, 0.0, 0.0, 0.0
    start = HEAD + words * count
    room[0, start : start + count] = np.arange(count) if as_given else order
    return room


def in_layers(points: Any) -> Any:
    """Numbers of points (n, 3) layer by layer along the longest axis, line by line, cell by cell: on the way through
    them neighbours come in a few even streams."""
    low, high = points.min(axis=0, initial=np.inf), points.max(axis=0, initial=-np.inf)
    width = (high - low).max(initial=0.0) / max(len(points), 1) ** (1.0 / 3.0)
    cells = np.floor((points - low) / (width or 1.0))
    return np.lexsort(cells[:, np.argsort(high - low, kind="stable")].T)


def way(points: Any) -> float:
    """Length of the way from each of points (n, 3) to the next."""
    return float(np.sqrt((np.diff(points, axis=0) ** 2).sum(axis=1)).sum())


def forget(room: Any, radius: Any, group: Any) -> None:
    """Have the list of a room of spheres made again if these are not the radii and groups (n,) that it was made for."""
    count = len(radius)
    if room[0, COUNT] == count:
        start = HEAD + (HERE + SUMS + 1) * count
        seen, order = room[0, start : start + SEEN * count].reshape(count, SEEN), room[0, start + SEEN * count :]
        order = order[:count].astype(np.int64)
        if not (np.array_equal(seen[:, 3], radius[order]) and np.array_equal(seen[:, 4], group[order])):
            room[0, COUNT] = -1.0


@device
def most_strays(count: Any) -> Any:
    """How many of some elements may join a list again."""
    return count // ALONE + 1


@device
def capacity(room: Any) -> Any:
    """How many elements a room was made for."""
    return int(rows(room, 1.0, HEAD)[0, SIZE])


@device
def parts(room: Any) -> Any:
    """Where in the room at an address are: elements seen, the order, the pairs and their reach; and its columns."""
    head = rows(room, 1.0, HEAD)
    size, spheres = head[0, SIZE], head[0, ENDS] == 1.0
    seen = room + 8.0 * (HEAD + (HERE + SUMS + 1 if spheres else HERE_CAPSULE) * size)
    order = seen + 8.0 * (SEEN if spheres else SEEN_CAPSULE) * size
    pairs = order + 8.0 * size
    return seen, order, pairs, pairs + 8.0 * head[0, PAIRS], SEEN if spheres else SEEN_CAPSULE


@device
def pairs_in(room: Any) -> Any:
    """The pairs of rows (`cells.both`) in the room at an address, and the sum of the radii of each."""
    _, _, pairs, reach, _ = parts(room)
    place = rows(room, 1.0, HEAD)[0, PAIRS]
    return rows(pairs, 1.0, int(place))[0].view(np.int64), rows(reach, 1.0, int(place))[0]


@device
def pairs_listed(room: Any) -> Any:
    """`pairs_in` a room, and how many are listed."""
    pairs, reach = pairs_in(room)
    return pairs, reach, int(rows(room, 1.0, HEAD)[0, FOUND])


@device
def seen_in(room: Any) -> Any:
    """The elements in the room at an address as they were when the list was made, at their places."""
    seen, _, _, _, columns = parts(room)
    return rows(seen, rows(room, 1.0, HEAD)[0, SIZE], columns)


@device
def began_in(room: Any) -> Any:
    """Where the spheres in the room at an address were when the list was made."""
    head = rows(room, 1.0, HEAD)
    _, _, _, reach, _ = parts(room)
    return rows(reach + 8.0 * head[0, PAIRS], head[0, SIZE], BEGAN)


@device
def grid_in(room: Any) -> Any:
    """The grid of cells (`cells`) in the room at an address; which elements have joined the list again, 1; and their
    rows."""
    size = capacity(room)
    _, _, _, reach, _ = parts(room)
    grid = reach + 8.0 * (rows(room, 1.0, HEAD)[0, PAIRS] + BEGAN * size)
    words, most = grid_words(size), most_strays(size)
    anew = rows(grid + 8.0 * words, 1.0, size + most)[0].view(np.int64)
    return rows(grid, 1.0, words)[0].view(np.int64), anew[:size], anew[size:]


@device
def order_in(room: Any, count: Any) -> Any:
    """The element of each row in the room at an address; where some of them are left out, their own order."""
    head = rows(room, 1.0, HEAD)
    _, order, _, _, _ = parts(room)
    if head[0, SIZE] == count:
        return rows(order, 1.0, count)[0]
    own = np.empty(count)
    for i in range(count):
        own[i] = i
    return own


@device
def tables(room: Any, count: Any) -> Any:
    """What a kernel gathers of each element, and of spheres what it sums; new ones if the room is too small."""
    head = rows(room, 1.0, HEAD)
    size, columns = head[0, SIZE], HERE if head[0, ENDS] == 1.0 else HERE_CAPSULE
    if count > size:
        return np.empty((count, columns)), np.empty((count, SUMS)), np.empty(count)
    here = rows(room + 8.0 * HEAD, count, columns)
    if columns != HERE:
        return here, np.empty((0, SUMS)), np.empty(0)
    sums = room + 8.0 * (HEAD + HERE * size)
    return here, rows(sums, count, SUMS), rows(sums + 8.0 * SUMS * size, 1.0, count)[0]


@device
def near_seen(at: Any, seen: Any, most: Any, x: Any, y: Any, z: Any) -> Any:
    """Whether no sphere is farther from its place than the root of `most`, but for a motion (x, y, z) of all."""
    away = 0
    for n in range(at.shape[0]):
        i = np.uint64(n)
        d0 = at[i, 0] - seen[i, 0] - x
        d1 = at[i, 1] - seen[i, 1] - y
        d2 = at[i, 2] - seen[i, 2] - z
        away |= 0 if d0 * d0 + d1 * d1 + d2 * d2 <= most else 1
    return away == 0


@device
def drift(at: Any, seen: Any) -> Any:
    """How far spheres have moved on average; zero if that is not a number."""
    x = y = z = 0.0
    count = at.shape[0]
    for n in range(count):
        i = np.uint64(n)
        x += at[i, 0] - seen[i, 0]
        y += at[i, 1] - seen[i, 1]
        z += at[i, 2] - seen[i, 2]
    if not abs(x + y + z) < np.inf:
        return 0.0, 0.0, 0.0
    return x / count, y / count, z / count


@device
def gather(x, indices, start, here, sums, counts, order, by_rows) -> None:  # type: ignore[no-untyped-def]
    """Where the elements are, by rows, and no forces yet; `by_rows`: so are the indices."""
    for n in range(here.shape[0]):
        i, e = np.uint64(n), start + (n if by_rows else int(order[n]))
        if here.shape[1] != HERE:
            capsule(x, indices, e, here, i)
            continue
        a = np.uint64(indices[e, 0])
        here[i, 0] = x[a, 0]
        here[i, 1] = x[a, 1]
        here[i, 2] = x[a, 2]
        here[i, 3] = 0.0
        counts[i] = 0.0
        for c in range(SUMS):
            sums[i, c] = 0.0


@device
def capsule(x: Any, indices: Any, e: Any, here: Any, i: Any) -> None:
    """The middle of a capsule, and half of its axis with its length."""
    a, b, square = indices[e, 0], indices[e, 1], 0.0
    for c in range(3):
        here[i, c] = 0.5 * (x[a, c] + x[b, c])
        here[i, 4 + c] = 0.5 * (x[b, c] - x[a, c])
        square += here[i, 4 + c] * here[i, 4 + c]
        here[i, 8 + c], here[i, 11 + c] = 0.0, 0.0
    here[i, 3] = np.sqrt(square)
    here[i, 14], here[i, 15] = 0.0, 0.0


@device
def farther(here: Any, seen: Any, i: Any, moved: Any) -> Any:
    """Square of the way of the end of a capsule that has moved more, from that of its middle."""
    turned, both = 0.0, 0.0
    for c in range(3):
        t = here[i, 4 + c] - seen[i, SEEN + c]
        turned += t * t
        both += t * (here[i, c] - seen[i, c])
    return moved + turned + 2.0 * abs(both)


@device
def as_seen(here: Any, parameters: Any, start: Any, order: Any, seen: Any, most: Any) -> Any:
    """Give capsules their radii; whether all elements have those, and the groups, that they had when the list was made,
    and no capsule has moved by more than the root of `most`."""
    same = most >= 0.0
    if here.shape[1] == HERE:
        return same and known(parameters, start, order, seen)
    for i in range(here.shape[0]):
        e = start + int(order[i])
        here[i, 7] = parameters[e, RADIUS]
        here[i, 3] += here[i, 7]
        if same:
            moved = 0.0
            for c in range(3):
                moved += (here[i, c] - seen[i, c]) ** 2
            same = farther(here, seen, i, moved) <= most
            same = same and parameters[e, RADIUS] == seen[i, SEEN + 3] and parameters[e, GROUP] == seen[i, 4]
    return same


@device
def known(parameters: Any, start: Any, order: Any, seen: Any) -> Any:
    """Whether all spheres have the radii and groups that they had when the list was made."""
    other = 0
    for n in range(order.shape[0]):
        i = np.uint64(n)
        e = np.uint64(start + int(order[i]))
        other |= 0 if parameters[e, RADIUS] == seen[i, 3] and parameters[e, GROUP] == seen[i, 4] else 1
    return other == 0


@device
def note(here: Any, parameters: Any, start: Any, order: Any, seen: Any) -> Any:
    """Write down where the elements are; whether some may ignore others."""
    picky = here.shape[1] != HERE
    for i in range(here.shape[0]):
        e = start + int(order[i])
        for c in range(3):
            seen[i, c] = here[i, c]
        seen[i, 3] = parameters[e, RADIUS] if here.shape[1] == HERE else here[i, 3]
        seen[i, 4] = parameters[e, GROUP]
        picky = picky or seen[i, 4] != 0.0
        for c in range(SEEN, seen.shape[1]):
            seen[i, c] = here[i, c - SEEN + 4]
    return picky


@device
def sort_pairs(pairs: Any, count: Any, size: Any, aside: Any) -> None:
    """Sort pairs of some rows by their first row, then by their second: by counting, with a copy in `aside`."""
    starts, of_first, of_second = np.zeros((2, size + 1), np.int64), 0, 0
    first, second = starts[0], starts[1]
    for n in range(count):
        i, j = ends(pairs[n])
        first[i + ONE] += 1
        second[j + ONE] += 1
    for n in range(size):
        i = np.uint64(n) + ONE
        of_first, of_second = of_first + first[i], of_second + second[i]
        first[i], second[i] = of_first, of_second
    for n in range(count):
        pair = pairs[n]
        _, j = ends(pair)
        k = second[j]
        second[j] = k + 1
        aside[np.uint64(k)] = pair
    for n in range(count):
        pair = aside[n]
        i, _ = ends(pair)
        k = first[i]
        first[i] = k + 1
        pairs[np.uint64(k)] = pair


@device
def course(here: Any, room: Any) -> Any:
    """How many uses ahead the places of a new list are to be, the greatest speed [length/use], and that of most; the
    speeds, beside the mean one, replace where spheres were.

    A sphere of speed u and a place t ahead is within s of it from t before until s / u after: for T uses, half of them
    is best. T is what the last list had. What swings does not keep its speed: t is less by the cosine of the speeds of
    the last list, as the places show them, and of the one before."""
    head, count = rows(room, 1.0, HEAD), here.shape[0]
    if here.shape[1] != HERE or head[0, COUNT] != count or head[0, USED] < 1.0:
        return 0.0, 0.0, 0.0
    seen, began, used, before = seen_in(room), began_in(room), head[0, USED], head[0, AHEAD]
    m0 = m1 = m2 = along = now = then = fastest = 0.0
    for n in range(count):
        i = np.uint64(n)
        m0 += here[i, 0] - began[i, 0]
        m1 += here[i, 1] - began[i, 1]
        m2 += here[i, 2] - began[i, 2]
    m0, m1, m2 = m0 / count, m1 / count, m2 / count
    for n in range(count):
        i = np.uint64(n)
        u0, u1, u2 = here[i, 0] - began[i, 0] - m0, here[i, 1] - began[i, 1] - m1, here[i, 2] - began[i, 2] - m2
        w0, w1, w2 = seen[i, 0] - began[i, 0], seen[i, 1] - began[i, 1], seen[i, 2] - began[i, 2]
        square = u0 * u0 + u1 * u1 + u2 * u2
        along, now, then = along + u0 * w0 + u1 * w1 + u2 * w2, now + square, then + w0 * w0 + w1 * w1 + w2 * w2
        fastest = max(fastest, square)
        began[i, 0], began[i, 1], began[i, 2] = u0 / used, u1 / used, u2 / used
    if not 0.0 < now < np.inf:
        return 0.0, 0.0, 0.0
    alike = max(along / np.sqrt(now * then), 0.0) if before > 0.0 and 0.0 < then < np.inf else 0.0
    return 0.5 * used * alike, np.sqrt(fastest) / used, np.sqrt(min(fastest, MOST_OF * now / count)) / used


@device
def list_pairs(here, parameters, start, order, room, beyond, ahead, fastest) -> Any:  # type: ignore[no-untyped-def]
    """Make the list of all pairs of the elements gathered whose places are within a range of their reach, places being
    some uses ahead, with the greatest speed of a sphere (`course`); whether there is place."""
    head, count = rows(room, 1.0, HEAD), here.shape[0]
    head[0, COUNT], head[0, USED], head[0, RANGE], head[0, AHEAD] = -1.0, 0.0, beyond, ahead
    if count > head[0, SIZE]:
        return False
    seen = seen_in(room)[:count]
    picky = note(here, parameters, start, order, seen)
    if fastest > 0.0:
        began = began_in(room)
        for n in range(count):
            i = np.uint64(n)
            seen[i, 0] += ahead * began[i, 0]
            seen[i, 1] += ahead * began[i, 1]
            seen[i, 2] += ahead * began[i, 2]
    pairs, reach = pairs_in(room)
    grid, anew, _ = grid_in(room)
    met, head[0, WIDTH] = find_pairs(seen, parameters, start, order, beyond, picky, grid, pairs)
    if met < 0:
        return False
    for n in range(count):
        anew[n] = 0
    head[0, STRAYS] = 0.0
    sort_pairs(pairs, met, count, reach.view(np.int64))  # the reach is written after that
    radius = 3 if seen.shape[1] == SEEN else SEEN + 3
    for n in range(met):
        i, j = ends(pairs[n])
        reach[n] = seen[i, radius] + seen[j, radius]
    head[0, COUNT], head[0, FOUND] = count, met
    return True


@device
def served(room: Any, count: Any, skin: Any, margin: Any) -> Any:
    """Square of the way [length^2] that elements may have moved for the list to hold all pairs within a margin of their
    reach, -1 if it never does or has a longer range than its long use needs."""
    head = rows(room, 1.0, HEAD)
    head[0, USED] += 1.0
    beyond, left = head[0, RANGE], 0.5 * (head[0, RANGE] - margin)
    wide = beyond > LEAST * skin and much(beyond, skin, head[0, USED], head[0, FOUND] / max(count, 1)) > ROOM
    return -1.0 if head[0, COUNT] != count or left < 0.0 or wide else left * left


@device
def renew(here: Any, parameters: Any, start: Any, order: Any, room: Any, skin: Any) -> Any:
    """Make the list again with the range that suits how long it was of use; whether there is place for it."""
    head = rows(room, 1.0, HEAD)
    beyond, uses, each = head[0, RANGE], head[0, USED], head[0, FOUND] / max(here.shape[0], 1)
    if head[0, COUNT] < 0.0:
        beyond = FIRST * skin
    else:
        beyond = changed(beyond, skin, uses, each)
    ahead, fastest, usual = course(here, room)
    twice = BARELY * (usual - min(ahead * usual, 0.5 * MOST_AHEAD * (MOST - 1.0) * skin))
    if twice > beyond:
        beyond = for_two(twice, beyond, skin, each)
    beyond, least = min(max(beyond, LEAST * skin), MOST * skin), LEAST * skin
    if list_pairs(here, parameters, start, order, room, beyond, limited(ahead, fastest, beyond - skin), fastest):
        made = True
    else:
        ahead = limited(ahead, fastest, least - skin)
        made = beyond > least and list_pairs(here, parameters, start, order, room, least, ahead, fastest)
    if made and here.shape[1] == HERE:
        began = began_in(room)
        for i in range(here.shape[0]):
            for c in range(3):
                began[i, c] = here[i, c]
    return made


@device
def limited(ahead: Any, fastest: Any, left: Any) -> Any:
    """How many uses ahead places are to be, with a greatest speed [length/use], in a list that ranges `left` [length]
    beyond the skin: near enough for the list to serve at once, far enough for the next one to know this motion."""
    if fastest == 0.0:
        return 0.0
    return 0.5 * min(max(2.0 * ahead * fastest, LEAST_AHEAD * left), MOST_AHEAD * left) / fastest
