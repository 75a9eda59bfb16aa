"""Neighbours: which of many elements are near enough to touch, found in a time that grows with their number.

An element is a sphere about a particle or a capsule about two. They lie in a grid of cells, by the spheres about them,
and each looks in the 27 cells about it. The list is kept in a room beside the kernel
(`make_room`) and holds pairs up to a skin beyond their reach: it is rebuilt once an element has moved by half of the
skin, or has another size. Pairs are listed by their first element, then by their second, and those that are too far
away count nothing, so that sums do not depend on when the list was made. Elements much larger than most look at all
others. Sources: Verlet, "Computer experiments on classical fluids", 1967 (the list and its skin); Teschner et al.,
"Optimized spatial hashing for collision detection of deformable objects", 2003 (the cells).
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
HERE = 8  # of each element now: the sphere; and what a kernel sums: force, stiffness
HERE_CAPSULE = 16  # the sphere, half axis, radius, force at the start, at the end, nothing, stiffness
PER_ELEMENT = 24  # pairs of an element that there is place for, on average
CROWD = 512  # neighbours of an element beyond which none are listed
LARGE = 4.0  # times the mean radius: what is larger looks at all others
FARTHEST = 1e15  # cells from the origin
PARALLEL = 1e-12  # square of the angle of two segments below which they are parallel


def make_room(count: int, ends: int = 1) -> np.ndarray:
    """A room (1, k) for the list of `count` elements of one or two particles; its address goes into the column `room`
    of parameters."""
    pairs, columns = PER_ELEMENT * count, HERE + SEEN if ends == 1 else HERE_CAPSULE + SEEN_CAPSULE
    room = np.zeros((1, HEAD + (columns + 1) * count + 1 + pairs))
    room[0, :HEAD] = count, pairs, 0.0, -1.0, ends
    return room


@device
def tables(room: Any) -> Any:
    """What is in the room at an address: elements seen, where the neighbours of each start (k, 1), and these (m, 1)."""
    head = rows(room, 1.0, HEAD)
    size, ends = head[0, SIZE], head[0, ENDS]
    here, width = (HERE, SEEN) if ends == 1.0 else (HERE_CAPSULE, SEEN_CAPSULE)
    starts = room + 8.0 * (HEAD + (here + width) * size)
    found = rows(starts + 8.0 * (size + 1.0), head[0, PAIRS], 1)
    return rows(room + 8.0 * (HEAD + here * size), size, width), rows(starts, size + 1.0, 1), found


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
def gather(x: Any, indices: Any, parameters: Any, start: Any, here: Any) -> None:
    """Where the elements are, side by side, and no forces yet."""
    for i in range(here.shape[0]):
        a = indices[start + i, 0]
        for c in range(3):
            here[i, c] = x[a, c]
        here[i, 3] = parameters[start + i, RADIUS]
        for c in range(4, here.shape[1]):
            here[i, c] = 0.0
        if here.shape[1] == HERE:
            continue
        b, square = indices[start + i, 1], 0.0
        for c in range(3):
            here[i, c] = 0.5 * (x[a, c] + x[b, c])
            here[i, 4 + c] = 0.5 * (x[b, c] - x[a, c])
            square += here[i, 4 + c] * here[i, 4 + c]
        here[i, 7] = here[i, 3]
        here[i, 3] += np.sqrt(square)


@device
def still_listed(here: Any, parameters: Any, start: Any, room: Any, skin: Any) -> Any:
    """Whether the list in the room at an address holds all pairs of the elements gathered."""
    head = rows(room, 1.0, HEAD)
    if head[0, COUNT] != here.shape[0] or head[0, SKIN] != skin:
        return False
    seen, _, _ = tables(room)
    most = 0.25 * skin * skin
    same = True
    for i in range(here.shape[0]):
        moved, turned, both = 0.0, 0.0, 0.0
        for c in range(3):
            d = here[i, c] - seen[i, c]
            moved += d * d
            if here.shape[1] != HERE:
                t = here[i, 4 + c] - seen[i, SEEN + c]
                turned += t * t
                both += d * t
        size = here[i, 3] == seen[i, 3] if here.shape[1] == HERE else here[i, 7] == seen[i, SEEN + 3]
        # of a capsule, the end that has moved more
        same = same and moved + turned + 2.0 * abs(both) <= most and size and parameters[start + i, GROUP] == seen[i, 4]
    return same


@device
def near(seen: Any, parameters: Any, start: Any, i: Any, j: Any, skin: Any) -> Any:
    """Whether two elements are to be listed: they may come within the skin before the list is rebuilt."""
    apart = 0.0
    for c in range(3):
        apart += (seen[i, c] - seen[j, c]) ** 2
    reach = seen[i, 3] + seen[j, 3] + 2.0 * skin
    if not apart < reach * reach or ignore(parameters, start + i, start + j):
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
    """The place of a cell beside that of element i in the table of cells."""
    key = ((cell[i, 0] + a) * 73856093) ^ ((cell[i, 1] + b) * 19349663) ^ ((cell[i, 2] + c) * 83492791)
    return key & mask


@device
def note(here: Any, parameters: Any, start: Any, seen: Any) -> Any:
    """Write down where the elements are; the radius above which one is large, and the largest that is not."""
    mean, widest = 0.0, 0.0
    for i in range(here.shape[0]):
        for c in range(4):
            seen[i, c] = here[i, c]
        seen[i, 4] = parameters[start + i, GROUP]
        for c in range(SEEN, seen.shape[1]):
            seen[i, c] = here[i, c - 1]
        mean += here[i, 3] / here.shape[0]
    for i in range(here.shape[0]):
        if seen[i, 3] <= LARGE * mean:
            widest = max(widest, seen[i, 3])
    return LARGE * mean, widest


@device
def sort_cells(seen: Any, count: Any, width: Any, mask: Any, cell: Any, first: Any, order: Any) -> None:
    """The cell of each element, and all elements in the order of their cells and then of their numbers."""
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
        order[first[k]] = i


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
def beside(seen, parameters, start, cell, first, order, i, most, reach, found, begin) -> Any:  # type: ignore[no-untyped-def]
    """List the later neighbours of an element with radii up to `most` from the cells about it; the end of the list, -1
    if there is no place."""
    end = begin
    for a in range(-1, 2):
        for b in range(-1, 2):
            for c in range(-1, 2):
                k = bucket(cell, i, a, b, c, first.shape[0] - 3) + 1
                for s in range(first[k], first[k + 1]):
                    j = order[s]
                    here = cell[j, 0] == cell[i, 0] + a and cell[j, 1] == cell[i, 1] + b
                    here = here and cell[j, 2] == cell[i, 2] + c
                    if here and j > i and seen[j, 3] <= most and near(seen, parameters, start, i, j, reach):
                        end = put_in(found, begin, end, j) if end - begin < CROWD else -1
                        if end < 0:
                            return end
    return end


@device
def list_pairs(here: Any, parameters: Any, start: Any, room: Any, skin: Any) -> Any:
    """Make the list of all pairs of the elements gathered; whether there is place for it."""
    head = rows(room, 1.0, HEAD)
    count = here.shape[0]
    head[0, SKIN], head[0, COUNT] = skin, -1.0
    if count > head[0, SIZE]:
        return False
    seen, starts, found = tables(room)
    most, widest = note(here, parameters, start, seen)
    mask = 1
    while mask < count:
        mask *= 2
    cell, order, first = np.empty((count, 3), np.int64), np.empty(count, np.int64), np.zeros(mask + 2, np.int64)
    sort_cells(seen, count, 2.0 * (widest + skin), mask - 1, cell, first, order)
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
            end = beside(seen, parameters, start, cell, first, order, i, most, skin, found, begin)
        for s in range(larger if seen[i, 3] <= most else count):
            j = large[s] if seen[i, 3] <= most else s
            if j > i and end >= 0 and near(seen, parameters, start, i, j, skin):
                end = put_in(found, begin, end, j)
        if end < 0:
            return False
    starts[count, 0] = end
    head[0, COUNT] = count
    return True


@device
def listed(here: Any, parameters: Any, start: Any, room: Any, skin: Any) -> Any:
    """Whether the list of the elements gathered in the room at an address is right for a skin [length], which is
    rebuilt if needed; if there is no place for it, every pair has to be checked."""
    if still_listed(here, parameters, start, room, skin):
        return True
    return list_pairs(here, parameters, start, room, skin)


@device
def sums(room: Any, count: Any) -> Any:
    """Rows (count, 8 or 16) of each element for what a kernel gathers and sums; new ones if the room is too small."""
    head = rows(room, 1.0, HEAD)
    columns = HERE if head[0, ENDS] == 1.0 else HERE_CAPSULE
    if count > head[0, SIZE]:
        return np.empty((count, columns))
    return rows(room + 8.0 * HEAD, count, columns)
