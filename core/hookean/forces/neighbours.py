"""Neighbours: which of many elements are near enough to touch, found in a time that grows with their number.

Elements lie in a grid of cells, and each looks in the 27 cells about it. The list is kept in a room beside the kernel
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

SIZE, PAIRS, SKIN, COUNT = range(4)  # the head of a room: elements and pairs it has place for; skin, elements listed
HEAD = 4
SEEN = 5  # of each element when the list was made: x y z, radius, group
HERE = 8  # of each element now: x y z, radius; and what a kernel sums: force, stiffness
PER_ELEMENT = 24  # pairs of an element that there is place for, on average
CROWD = 512  # neighbours of an element beyond which none are listed
LARGE = 4.0  # times the mean radius: what is larger looks at all others
FARTHEST = 1e15  # cells from the origin


def make_room(count: int) -> np.ndarray:
    """A room (1, k) for the list of `count` elements; its address goes into the column `room` of parameters."""
    pairs = PER_ELEMENT * count
    room = np.zeros((1, HEAD + (HERE + SEEN + 1) * count + 1 + pairs))
    room[0, :HEAD] = count, pairs, 0.0, -1.0
    return room


@device
def same_group(first: Any, second: Any) -> Any:
    """Whether two elements ignore each other: those of one group, 0 being none."""
    return first == second and first != 0.0


@device
def still_listed(x: Any, indices: Any, parameters: Any, start: Any, stop: Any, room: Any, skin: Any) -> Any:
    """Whether the list in the room at an address holds all pairs of the elements start to stop."""
    head = rows(room, 1.0, HEAD)
    if head[0, COUNT] != stop - start or head[0, SKIN] != skin:
        return False
    seen = rows(room + 8.0 * (HEAD + HERE * head[0, SIZE]), head[0, SIZE], SEEN)
    most = 0.25 * skin * skin
    same = True
    for i in range(stop - start):
        e = start + i
        moved = 0.0
        for c in range(3):
            d = x[indices[e, 0], c] - seen[i, c]
            moved += d * d
        same = same and moved <= most and parameters[e, 0] == seen[i, 3] and parameters[e, 1] == seen[i, 4]
    return same


@device
def near(seen: Any, i: Any, j: Any, skin: Any) -> Any:
    """Whether two elements are to be listed: they may come within the skin before the list is rebuilt."""
    apart = 0.0
    for c in range(3):
        apart += (seen[i, c] - seen[j, c]) ** 2
    reach = seen[i, 3] + seen[j, 3] + 2.0 * skin
    return apart < reach * reach and not same_group(seen[i, 4], seen[j, 4])


@device
def bucket(cell: Any, i: Any, a: Any, b: Any, c: Any, mask: Any) -> Any:
    """The place of a cell beside that of element i in the table of cells."""
    key = ((cell[i, 0] + a) * 73856093) ^ ((cell[i, 1] + b) * 19349663) ^ ((cell[i, 2] + c) * 83492791)
    return key & mask


@device
def note(x: Any, indices: Any, parameters: Any, start: Any, stop: Any, seen: Any) -> Any:
    """Write down where the elements are; the radius above which one is large, and the largest that is not."""
    mean, widest = 0.0, 0.0
    for e in range(start, stop):
        for c in range(3):
            seen[e - start, c] = x[indices[e, 0], c]
        seen[e - start, 3] = parameters[e, 0]
        seen[e - start, 4] = parameters[e, 1]
        mean += parameters[e, 0] / (stop - start)
    for i in range(stop - start):
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
def beside(seen: Any, cell: Any, first: Any, order: Any, i: Any, most: Any, reach: Any, found: Any, begin: Any) -> Any:
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
                    if here and j > i and seen[j, 3] <= most and near(seen, i, j, reach):
                        end = put_in(found, begin, end, j) if end - begin < CROWD else -1
                        if end < 0:
                            return end
    return end


@device
def list_pairs(x: Any, indices: Any, parameters: Any, start: Any, stop: Any, room: Any, skin: Any) -> Any:
    """Make the list of all pairs of the elements start to stop; whether there is place for it."""
    head = rows(room, 1.0, HEAD)
    count, size = stop - start, head[0, SIZE]
    head[0, SKIN], head[0, COUNT] = skin, -1.0
    if count > size:
        return False
    seen = rows(room + 8.0 * (HEAD + HERE * size), size, SEEN)
    starts = rows(room + 8.0 * (HEAD + (HERE + SEEN) * size), size + 1.0, 1)
    found = rows(room + 8.0 * (HEAD + (HERE + SEEN + 1) * size + 1), head[0, PAIRS], 1)
    most, widest = note(x, indices, parameters, start, stop, seen)
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
            end = beside(seen, cell, first, order, i, most, skin, found, begin)
        for s in range(larger if seen[i, 3] <= most else count):
            j = large[s] if seen[i, 3] <= most else s
            if j > i and end >= 0 and near(seen, i, j, skin):
                end = put_in(found, begin, end, j)
        if end < 0:
            return False
    starts[count, 0] = end
    head[0, COUNT] = count
    return True


@device
def listed(x: Any, indices: Any, parameters: Any, start: Any, stop: Any, room: Any, skin: Any) -> Any:
    """Whether the list of the elements start to stop in the room at an address is right for a skin [length], which is
    rebuilt if needed; if there is no place for it, every pair has to be checked."""
    if still_listed(x, indices, parameters, start, stop, room, skin):
        return True
    return list_pairs(x, indices, parameters, start, stop, room, skin)


@device
def pairs(room: Any) -> Any:
    """The list in the room at an address: where the neighbours of each element start (k, 1), and these (m, 1)."""
    head = rows(room, 1.0, HEAD)
    size = head[0, SIZE]
    starts = rows(room + 8.0 * (HEAD + (HERE + SEEN) * size), size + 1.0, 1)
    return starts, rows(room + 8.0 * (HEAD + (HERE + SEEN + 1) * size + 1), head[0, PAIRS], 1)


@device
def sums(room: Any, count: Any) -> Any:
    """Rows (count, 8) for what a kernel gathers and sums of each element; new ones where the room is too small."""
    if count > rows(room, 1.0, HEAD)[0, SIZE]:
        return np.empty((count, HERE))
    return rows(room + 8.0 * HEAD, count, HERE)
