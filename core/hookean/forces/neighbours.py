"""Neighbours: which of many elements are near enough to touch, found in a time that grows with their number.

An element is a sphere about a particle or a capsule about two. They lie in a grid of cells, by the spheres about them,
and each looks in the 27 cells about it. The list is kept in a room beside the kernel
(`make_room`) and holds pairs up to a skin beyond their reach: it is rebuilt once an element has moved by half of the
skin, or has another size. Pairs are listed by their first element, then by their second, and those that are too far
away count nothing, so that sums do not depend on when the list was made. Elements much larger than most look at all
others. In the room they are in the order of a curve that fills space (`along_curve`) from where they are at the start,
so that neighbours are near in memory. Sources: Verlet, "Computer experiments on classical fluids", 1967 (the list and
its skin); Teschner et al., "Optimized spatial hashing for collision detection of deformable objects", 2003 (the cells).
"""

from __future__ import annotations

from typing import Any

import numpy as np

from hookean.compiled.dispatch import rows
from hookean.compiled.marks import device

RADIUS, GROUP, START, END = 0, 1, 5, 6  # columns of parameters that are read here; the last two of capsules alone
SIZE, PAIRS, SKIN, COUNT, ENDS = range(5)  # the head of a room: elements and pairs it has place for; skin, elements
# listed, particles of an element
HEAD = 5
SEEN = 5  # of each element when the list was made: the sphere about it, x y z and radius, and its group; of a capsule
SEEN_CAPSULE = 9  # also half of its axis x y z, and its own radius
NUMBER, ROW = 0, 1  # columns of the order: which element is in a row, in which row an element is
HERE = 8  # of each element now: the sphere; and what a kernel sums: force, stiffness
HERE_CAPSULE = 16  # the sphere, half axis, radius, force at the start, at the end, nothing, stiffness
PER_ELEMENT = 24  # pairs of an element that there is place for, on average
CROWD = 512  # neighbours of an element beyond which none are listed
LARGE = 4.0  # times the mean radius: what is larger looks at all others
FARTHEST = 1e15  # cells from the origin
PARALLEL = 1e-12  # square of the angle of two segments below which they are parallel


def make_room(corners: Any) -> np.ndarray:
    """A room (1, k) for the list of elements with corners (n, 1 or 2, 3) at the start; its address goes into the column
    `room` of parameters."""
    count, ends = corners.shape[:2]
    pairs, columns = PER_ELEMENT * count, HERE + SEEN if ends == 1 else HERE_CAPSULE + SEEN_CAPSULE
    order = along_curve(corners.mean(axis=1))
    both = np.column_stack([order, np.argsort(order)]).ravel()
    head = [count, pairs, 0.0, -1.0, ends]
    return np.concatenate([head, np.zeros(columns * count), both, np.zeros(count + 1 + pairs)])[None]


def along_curve(points: Any) -> Any:
    """Numbers of points (n, 3) along a curve through a grid of 2^16 cells on each axis (Morton, "A computer oriented
    geodetic data base", 1966)."""
    size = np.ptp(points, axis=0).max(initial=0.0) if len(points) else 0.0
    cells = ((points - points.min(axis=0, initial=np.inf)) * (65535.0 / (size or 1.0))).astype(np.uint64)
    code = np.zeros(len(points), np.uint64)
    for bit in range(16):
        for axis in range(3):
            code |= (cells[:, axis] >> np.uint64(bit) & np.uint64(1)) << np.uint64(3 * bit + axis)
    return np.argsort(code, kind="stable")


@device
def capacity(room: Any) -> Any:
    """How many elements a room was made for."""
    return int(rows(room, 1.0, HEAD)[0, SIZE])


@device
def tables(room: Any) -> Any:
    """What is in the room at an address: elements seen, where the neighbours of each start (k, 1), and these (m, 1)."""
    head = rows(room, 1.0, HEAD)
    size, ends = head[0, SIZE], head[0, ENDS]
    here, width = (HERE, SEEN) if ends == 1.0 else (HERE_CAPSULE, SEEN_CAPSULE)
    starts = room + 8.0 * (HEAD + (here + width + 2) * size)
    found = rows(starts + 8.0 * (size + 1.0), head[0, PAIRS], 1)
    return rows(room + 8.0 * (HEAD + here * size), size, width), rows(starts, size + 1.0, 1), found


@device
def order_in(room: Any, count: Any) -> Any:
    """The order (count, 2) of the elements in the room at an address; where some of them are left out, their own."""
    head = rows(room, 1.0, HEAD)
    size, ends = head[0, SIZE], head[0, ENDS]
    columns = HERE + SEEN if ends == 1.0 else HERE_CAPSULE + SEEN_CAPSULE
    if size == count:
        return rows(room + 8.0 * (HEAD + columns * size), size, 2)
    own = np.empty((count, 2))
    for i in range(count):
        own[i, NUMBER], own[i, ROW] = i, i
    return own


@device
def ignore(parameters: Any, e: Any, o: Any) -> Any:
    """Whether two elements ignore each other: those of one group, 0 being none, and capsules that share a particle."""
    if parameters[e, GROUP] == parameters[o, GROUP] and parameters[e, GROUP] != 0.0:
        return True
    if parameters.shape[1] <= END:
        return False
    a, b, c, d = parameters[e, START], parameters[e, END], parameters[o, START], parameters[o, END]
    return a in (c, d) or b in (c, d)


@device
def nearest(at: Any, i: Any, j: Any, axis: Any) -> Any:
    """Closest points of two segments, rows of a table with their centres and from a column on their half axes: how far
    along, from -1 to 1. Of parallel ones, the middle of where they are beside each other. Source: Ericson, Real-Time
    Collision Detection, 2005, 5.1.9."""
    uu, vv, uv, ur, vr, turn, part = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for c in range(3):
        d, k = (c + 1) % 3, (c + 2) % 3
        u, v, r = at[i, axis + c], at[j, axis + c], at[i, c] - at[j, c]
        uu, vv, uv, ur, vr = uu + u * u, vv + v * v, uv + u * v, ur + u * r, vr + v * r
        cross = at[i, axis + d] * at[j, axis + k] - at[i, axis + k] * at[j, axis + d]
        turn += cross * cross
        part += cross * (at[j, axis + d] * (at[i, k] - at[j, k]) - at[j, axis + k] * (at[i, d] - at[j, d]))
    if turn > PARALLEL * uu * vv:
        s = min(max(part / turn, -1.0), 1.0)
    elif uu > 0.0:
        reach = abs(uv) / uu
        low, high = max((-ur / uu) - reach, -1.0), min((-ur / uu) + reach, 1.0)
        s = min(max(0.5 * (low + high), -1.0), 1.0)
    else:
        s = 0.0
    t = min(max((uv * s + vr) / vv, -1.0), 1.0) if vv > 0.0 else 0.0
    if uu > 0.0 and (t == 1.0 or t == -1.0):
        s = min(max((uv * t - ur) / uu, -1.0), 1.0)
    return s, t


@device
def gather(x: Any, indices: Any, parameters: Any, start: Any, here: Any, order: Any, room: Any, skin: Any) -> Any:
    """Where the elements are, by rows, and no forces yet; whether the list in the room at an address holds all pairs of
    them."""
    head, count, spheres = rows(room, 1.0, HEAD), here.shape[0], here.shape[1] == HERE
    same = head[0, COUNT] == count and head[0, SKIN] == skin
    seen, _, _ = tables(room)
    most = 0.25 * skin * skin
    for n in range(count):
        e, i = start + n, np.uint64(int(order[n, ROW]))
        a, moved, radius = indices[e, 0], 0.0, parameters[e, RADIUS]
        for c in range(3):
            here[i, c] = x[a, c]
        here[i, 3] = radius
        for c in range(4, 8):
            here[i, c] = 0.0
        if not spheres:
            capsule(x, indices, e, here, i)
        if not same:
            continue
        for c in range(3):
            d = here[i, c] - seen[i, c]
            moved += d * d
        known = seen[i, 3] if spheres else seen[i, SEEN + 3]
        if not spheres:
            moved = farther(here, seen, i, moved)
        same = moved <= most and radius == known and parameters[e, GROUP] == seen[i, 4]
    return same


@device
def capsule(x: Any, indices: Any, e: Any, here: Any, i: Any) -> None:
    """The middle of a capsule, half of its axis, its radius and that of the sphere about it."""
    a, b, square = indices[e, 0], indices[e, 1], 0.0
    for c in range(3):
        here[i, c] = 0.5 * (x[a, c] + x[b, c])
        here[i, 4 + c] = 0.5 * (x[b, c] - x[a, c])
        square += here[i, 4 + c] * here[i, 4 + c]
        here[i, 8 + c], here[i, 11 + c] = 0.0, 0.0
    here[i, 7] = here[i, 3]
    here[i, 3] += np.sqrt(square)
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
def near(seen: Any, parameters: Any, start: Any, order: Any, i: Any, j: Any, skin: Any) -> Any:
    """Whether two elements are to be listed: they may come within the skin before the list is rebuilt."""
    apart = 0.0
    for c in range(3):
        apart += (seen[i, c] - seen[j, c]) ** 2
    reach = seen[i, 3] + seen[j, 3] + 2.0 * skin
    if not apart < reach * reach:
        return False
    if ignore(parameters, start + int(order[i, NUMBER]), start + int(order[j, NUMBER])):
        return False
    if seen.shape[1] == SEEN:
        return True
    s, t = nearest(seen, i, j, SEEN)
    apart = 0.0
    for c in range(3):
        apart += (seen[i, c] + s * seen[i, SEEN + c] - seen[j, c] - t * seen[j, SEEN + c]) ** 2
    reach = seen[i, SEEN + 3] + seen[j, SEEN + 3] + 2.0 * skin
    return apart < reach * reach


@device
def bucket(cell: Any, i: Any, a: Any, b: Any, c: Any, mask: Any) -> Any:
    """The place of a cell beside that of element i in the table of cells: along z they follow one another."""
    return (((cell[i, 0] + a) * 73856093) ^ ((cell[i, 1] + b) * 19349663)) + cell[i, 2] + c & mask


@device
def note(here: Any, parameters: Any, start: Any, order: Any, seen: Any) -> Any:
    """Write down where the elements are; the radius above which one is large, and the largest that is not."""
    mean, widest = 0.0, 0.0
    for i in range(here.shape[0]):
        for c in range(4):
            seen[i, c] = here[i, c]
        seen[i, 4] = parameters[start + int(order[i, NUMBER]), GROUP]
        for c in range(SEEN, seen.shape[1]):
            seen[i, c] = here[i, c - SEEN + 4]
        mean += here[i, 3] / here.shape[0]
    for i in range(here.shape[0]):
        if seen[i, 3] <= LARGE * mean:
            widest = max(widest, seen[i, 3])
    return LARGE * mean, widest


@device
def sort_cells(seen: Any, count: Any, width: Any, mask: Any, cell: Any, first: Any, by_cell: Any) -> None:
    """The cell of each element, and all elements in the by_cell of their cells and then of their numbers."""
    for i in range(count):
        for c in range(3):
            cell[i, c] = int(np.floor(min(max(seen[i, c] / width, -FARTHEST), FARTHEST)))
        first[bucket(cell, i, 0, 0, 0, mask) + 1] += 1
    for k in range(mask + 1):
        first[k + 1] += first[k]
    first[mask + 2] = count
    for back in range(count):
        i = count - 1 - back
        k = bucket(cell, i, 0, 0, 0, mask) + 1
        first[k] -= 1
        by_cell[first[k]] = i


@device
def put_in(found: Any, begin: Any, end: Any, j: Any) -> Any:
    """Insert a number into the sorted part of the list from begin to end; its new end, -1 if there is no place."""
    if end >= found.shape[0]:
        return -1
    at = end
    while at > begin and found[at - 1, 0] > j:
        found[at, 0] = found[at - 1, 0]
        at -= 1
    found[at, 0] = j
    return end + 1


@device
def beside(seen, parameters, start, order, cell, first, by_cell, i, most, reach, found, begin) -> Any:  # type: ignore[no-untyped-def]
    """List the later neighbours of an element with radii up to `most` from the cells about it; the end of the list, -1
    if there is no place."""
    end, mask = begin, first.shape[0] - 3
    for n in range(9):
        a, b = n // 3 - 1, n % 3 - 1
        k = bucket(cell, i, a, b, -1, mask)
        parts = 1 if k + 2 <= mask else 3  # three cells along z in one go, unless the table ends between them
        for part in range(parts):
            place = (k + part & mask) + 1
            for s in range(first[place], first[place + 3 if parts == 1 else place + 1]):
                j = by_cell[s]
                beyond = cell[j, 2] - cell[i, 2]
                here = j > i and cell[j, 0] == cell[i, 0] + a and cell[j, 1] == cell[i, 1] + b
                here = here and -1 <= beyond <= 1 and (parts == 1 or beyond == part - 1)
                if here and seen[j, 3] <= most and near(seen, parameters, start, order, i, j, reach):
                    end = put_in(found, begin, end, j) if end - begin < CROWD else -1
                    if end < 0:
                        return end
    return end


@device
def list_pairs(here: Any, parameters: Any, start: Any, order: Any, room: Any, skin: Any) -> Any:
    """Make the list of all pairs of the elements gathered; whether there is place for it."""
    head = rows(room, 1.0, HEAD)
    count = here.shape[0]
    head[0, SKIN], head[0, COUNT] = skin, -1.0
    if count > head[0, SIZE]:
        return False
    seen, starts, found = tables(room)
    most, widest = note(here, parameters, start, order, seen)
    mask = 1
    while mask < count:
        mask *= 2
    cell, by_cell, first = np.empty((count, 3), np.int64), np.empty(count, np.int64), np.zeros(mask + 2, np.int64)
    sort_cells(seen, count, 2.0 * (widest + skin), mask - 1, cell, first, by_cell)
    large = np.empty(count, np.int64)
    larger = 0
    for i in range(count):
        if seen[i, 3] > most:
            large[larger] = i
            larger += 1
    end = 0
    for i in range(count):
        begin = end
        starts[i, 0] = begin
        if seen[i, 3] <= most:
            end = beside(seen, parameters, start, order, cell, first, by_cell, i, most, skin, found, begin)
        for s in range(larger if seen[i, 3] <= most else count):
            j = large[s] if seen[i, 3] <= most else s
            if j > i and end >= 0 and near(seen, parameters, start, order, i, j, skin):
                end = put_in(found, begin, end, j)
        if end < 0:
            return False
    starts[count, 0] = end
    head[0, COUNT] = count
    return True


@device
def listed(x: Any, indices: Any, parameters: Any, start: Any, here: Any, order: Any, room: Any, skin: Any) -> Any:
    """Gather elements, and see that the list in the room at an address is right for a skin [length]: it is rebuilt if
    needed. If there is no place for it, False: every pair has to be checked."""
    if gather(x, indices, parameters, start, here, order, room, skin):
        return True
    return list_pairs(here, parameters, start, order, room, skin)


@device
def sums(room: Any, count: Any) -> Any:
    """Rows (count, 8 or 16) of each element for what a kernel gathers and sums; new ones if the room is too small."""
    head = rows(room, 1.0, HEAD)
    columns = HERE if head[0, ENDS] == 1.0 else HERE_CAPSULE
    if count > head[0, SIZE]:
        return np.empty((count, columns))
    return rows(room + 8.0 * HEAD, count, columns)
