"""Cells: all pairs of many elements that are near one another, found in a time that grows with their number.

Elements lie in a grid of cells, by the spheres about them, and each looks in its own cell and in 13 of the 26 about it.
A grid of more cells than there is place for is folded: cells far apart share a place. Elements much larger than most
look at all others. Source: Hockney and Eastwood, "Computer simulation using particles", 1981, 8.4 (cells and lists).
"""

from __future__ import annotations

from typing import Any

import numpy as np

from hookean.compiled.marks import device
from hookean.forces.runs import ABREAST, BITS, FEW, TOGETHER, beside, both, ends, meet, meet_few

RADIUS, GROUP, START, END = 0, 1, 5, 6  # columns of parameters that are read here; the last two of capsules alone
SEEN = 5  # of each element: the sphere about it, x y z and radius, and its group; of a capsule
SEEN_CAPSULE = 9  # also half of its axis x y z, and its own radius
LARGE = 4.0  # times the mean radius: what is larger looks at all others
PARALLEL = 1e-12  # square of the angle of two segments below which they are parallel
FARTHEST = 1e15  # cells from the origin
FEWEST = 3  # cells along an axis, so that the two beside one are different
PER_CELL = 2  # cells of an element that there is place for, at most
SORTED = 4  # columns of elements in the order of cells: x, y, z and radius
LOW, SIDE, CELLS = 0, 3, 6  # of a grid: its lowest cell, cells along each axis; where each cell starts, then rows
LONG = 9  # elements in a run of three cells on average, from which on they are compared at once


@device
def grid_words(count: Any) -> Any:
    """How many numbers a grid of some elements has."""
    return CELLS + 2 * max(PER_CELL * count, FEWEST**3) + 2 + 2 * count + ABREAST + SORTED * (count + ABREAST)


@device
def cells_of(grid: Any, count: Any) -> Any:
    """Of the grid of some elements the sides, where each cell starts and where the last ends, and the rows of elements
    in the order of cells."""
    side = grid[SIDE:CELLS]
    cells = side[0] * side[1] * side[2]
    return side, grid[CELLS + 1 : CELLS + 2 + cells], grid[CELLS + 2 + cells : CELLS + 2 + cells + count + ABREAST]


@device
def chains_of(grid: Any, count: Any) -> Any:
    """Of the grid of some elements chains of those that have moved to another cell: the first of each cell, and of each
    element the next, both by numbers from 1."""
    after = CELLS + 2 + count + ABREAST + max(PER_CELL * count, FEWEST**3)
    return grid[after + count :], grid[after : after + count]


@device
def sorted_in(grid: Any, count: Any) -> Any:
    """Of the grid of some elements their coordinates and radii in the order of cells, each in an array of its own."""
    start, size = grid.shape[0] - SORTED * (count + ABREAST), count + ABREAST
    table = grid[start:].view(np.float64)
    return table[:size], table[size : 2 * size], table[2 * size : 3 * size], table[3 * size :]


@device
def cell_at(x: Any, y: Any, z: Any, scale: Any, grid: Any) -> Any:
    """The cell of a point along each axis, folded into the grid."""
    a = cell_of(x, scale) - grid[LOW]
    b = cell_of(y, scale) - grid[LOW + 1]
    c = cell_of(z, scale) - grid[LOW + 2]
    return a % grid[SIDE], b % grid[SIDE + 1], c % grid[SIDE + 2]


@device
def cell_of(coordinate: Any, scale: Any) -> Any:
    """The number of the cell of a coordinate along its axis; `scale`: cells by length."""
    along = coordinate * scale
    if abs(along) < FARTHEST:
        return int(np.floor(along))
    if not abs(coordinate) < np.inf:
        return 0
    return int(FARTHEST if along > 0.0 else -FARTHEST)


@device
def sides(spheres: Any, scale: Any, low: Any, side: Any) -> Any:
    """Write the lowest cell of the grid, and how many cells it has along each axis; returns their number."""
    count, least, most = spheres.shape[0], np.empty(3), np.empty(3)
    x0 = y0 = z0 = np.inf
    x1 = y1 = z1 = -np.inf
    for n in range(count):
        i = np.uint64(n)
        x, y, z = spheres[i, 0], spheres[i, 1], spheres[i, 2]
        x = x if abs(x) < np.inf else 0.0
        y = y if abs(y) < np.inf else 0.0
        z = z if abs(z) < np.inf else 0.0
        x0, y0, z0 = x if x < x0 else x0, y if y < y0 else y0, z if z < z0 else z0
        x1, y1, z1 = x if x > x1 else x1, y if y > y1 else y1, z if z > z1 else z1
    least[0], least[1], least[2], most[0], most[1], most[2] = x0, y0, z0, x1, y1, z1
    for c in range(3):
        low[c] = cell_of(least[c], scale)
        side[c] = min(max(cell_of(most[c], scale) - low[c] + 1, FEWEST), max(count, FEWEST))
    room = float(max(PER_CELL * count, FEWEST**3))
    while float(side[0]) * float(side[1]) * float(side[2]) > room:
        longest = 0
        for c in range(3):
            longest = c if side[c] > side[longest] else longest
        side[longest] = max((side[longest] + 1) // 2, FEWEST)
    return side[0] * side[1] * side[2]


@device
def sort_cells(spheres, scale, low, side, most, first, number, xs, ys, zs, radii) -> None:  # type: ignore[no-untyped-def]
    """All elements but the large ones in the order of their cells: their coordinates and radii, each in an array of
    their own, and their rows in `number`; `first`: where each cell starts."""
    count = spheres.shape[0]
    cell = np.empty(count, np.int64)
    (a, b, c), (right, up, on) = low, side
    for n in range(count):
        i = np.uint64(n)
        x, y, z = (
            cell_of(spheres[i, 0], scale) - a,
            cell_of(spheres[i, 1], scale) - b,
            cell_of(spheres[i, 2], scale) - c,
        )
        x, y, z = x if x < right else x % right, y if y < up else y % up, z if z < on else z % on
        k = (x * up + y) * on + z
        cell[i] = k if spheres[i, 3] <= most else -1
        first[np.uint64(k + 1)] += 1 if spheres[i, 3] <= most else 0
    before = 0
    for n in range(first.shape[0]):
        k = np.uint64(n)
        before += first[k]
        first[k] = before
    for back in range(count):
        i = np.uint64(count - 1 - back)
        k = np.uint64(cell[i] + 1)
        if k > 0:  # from the end, so that `first` ends as the start of the cell, one place too far
            first[k] -= 1
            s = np.uint64(first[k])
            number[s] = i
            xs[s], ys[s], zs[s], radii[s] = spheres[i, 0], spheres[i, 1], spheres[i, 2], spheres[i, 3]


@device
def runs_at(a: Any, b: Any, c: Any, side: Any, first: Any, runs: Any) -> Any:
    """The elements of a cell and the 26 about it as runs in the order of cells; how many runs."""
    count, length = 0, side[2]
    for n in range(9):
        p, q = (a + n // 3 + side[0] - 1) % side[0], (b + n % 3 + side[1] - 1) % side[1]
        k = (p * side[1] + q) * length
        runs[count, 0], runs[count, 1] = first[k + max(c - 1, 0)], first[k + min(c + 2, length)]
        count += 1
        if c == 0 or c == length - 1:
            other = length - 1 if c == 0 else 0
            runs[count, 0], runs[count, 1] = first[k + other], first[k + other + 1]
            count += 1
    return count


@device
def columns_about(a: Any, b: Any, side: Any, columns: Any) -> None:
    """Where the column of cells (a, b) along z starts, and the four of the eight beside it that its elements look in;
    behind the last column comes the first."""
    after, up, down = (a + 1) % side[0], (b + 1) % side[1], (b + side[1] - 1) % side[1]
    columns[0], columns[1] = (a * side[1] + b) * side[2], (a * side[1] + up) * side[2]
    columns[2] = (after * side[1] + down) * side[2]
    columns[3] = (after * side[1] + b) * side[2]
    columns[4] = (after * side[1] + up) * side[2]


@device
def runs_about(c: Any, length: Any, columns: Any, first: Any, runs: Any) -> Any:
    """The elements of cell c of the first column and the next one, and of three cells of each other column, as runs in
    the order of cells; how many runs. Behind the last cell of a column comes its first."""
    for n in range(5):
        k = columns[n]
        runs[n, 0], runs[n, 1] = first[k + (c if n == 0 else max(c - 1, 0))], first[k + min(c + 2, length)]
    if 0 < c < length - 1:
        return 5
    count, other = 5, (length - 1 if c == 0 else 0)
    for n in range(1 if c == 0 else 0, 5):
        runs[count, 0], runs[count, 1] = first[columns[n] + other], first[columns[n] + other + 1]
        count += 1
    return count


@device
def ignore(parameters: Any, e: Any, o: Any) -> Any:
    """Whether two elements ignore each other: those of one group, 0 being none, and capsules that share a particle."""
    if parameters[e, GROUP] == parameters[o, GROUP] and parameters[e, GROUP] != 0.0:
        return True
    if parameters.shape[1] != END + 1:
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
def near(seen: Any, parameters: Any, start: Any, order: Any, i: Any, j: Any, beyond: Any) -> Any:
    """Whether two elements whose spheres are near are to be listed."""
    if ignore(parameters, start + int(order[i]), start + int(order[j])):
        return False
    if seen.shape[1] == SEEN:
        return True
    s, t = nearest(seen, i, j, SEEN)
    apart = 0.0
    for c in range(3):
        apart += (seen[i, c] + s * seen[i, SEEN + c] - seen[j, c] - t * seen[j, SEEN + c]) ** 2
    reach = seen[i, SEEN + 3] + seen[j, SEEN + 3] + beyond
    return apart < reach * reach


@device
def thin(spheres, parameters, start, order, beyond, found, first, count) -> Any:  # type: ignore[no-untyped-def]
    """Keep of the pairs listed from `first` on those that are `near`; how many pairs are listed then."""
    kept = max(first, 0)
    for n in range(kept, count):
        i, j = ends(found[n])
        found[kept] = found[n]
        kept += 1 if near(spheres, parameters, start, order, int(i), int(j), beyond) else 0
    return kept if count >= 0 else count


@device
def find_pairs(spheres, parameters, start, order, beyond, picky, grid, found) -> Any:  # type: ignore[no-untyped-def]
    """List all pairs of elements (n, SEEN or more) that are within `beyond` of their reach, once each; how many, -1 if
    there is no place for them, and the width of the cells of `grid`, in which all are, else 0. `picky`: some may ignore
    others, or are capsules."""
    size, mean, widest = spheres.shape[0], 0.0, 0.0
    for i in range(size):
        mean += spheres[i, 3] / size
    for i in range(size):
        widest = max(widest, spheres[i, 3]) if spheres[i, 3] <= LARGE * mean else widest
    width, low = 2.0 * widest + beyond, grid[LOW:SIDE]
    cells = sides(spheres, 1.0 / width, low, grid[SIDE:CELLS])
    side, _, number = cells_of(grid, size)
    first = grid[CELLS : CELLS + 2 + cells]
    chains, _ = chains_of(grid, size)
    for n in range(cells + 2):
        first[n] = 0
    for n in range(cells):
        chains[n] = 0
    xs, ys, zs, radii = sorted_in(grid, size)
    sort_cells(spheres, 1.0 / width, low, side, LARGE * mean, first, number, xs, ys, zs, radii)
    columns, runs, begins = np.empty(5, np.int64), np.empty((10, 2), np.int64), np.empty(BITS, np.int64)
    few = np.empty((5, TOGETHER + 2 * FEW))
    at_once = ABREAST if 3 * size > LONG * cells else FEW
    first = first[1:]
    count, k = 0, -1
    for a in range(side[0]):
        for b in range(side[1]):
            columns_about(a, b, side, columns)
            for c in range(side[2]):
                k += 1
                if first[k] == first[k + 1]:
                    continue
                several, own = runs_about(c, side[2], columns, first, runs), first[k + 1] - first[k]
                if 0 <= count <= found.shape[0] - TOGETHER * own and not picky:
                    total = beside(runs, several, xs, ys, zs, radii, number, few)
                    if total <= TOGETHER:
                        for s in range(own):
                            count = meet_few(few, s, total, beyond, found, count)
                        continue
                for s in range(first[k], first[k + 1]):
                    t, before, runs[0, 0] = np.uint64(s), count, s + 1  # in its own cell with the later ones
                    x, y, z, reach = xs[t], ys[t], zs[t], radii[t] + beyond
                    count = meet(
                        xs,
                        ys,
                        zs,
                        radii,
                        number,
                        x,
                        y,
                        z,
                        reach,
                        number[t],
                        runs,
                        several,
                        at_once,
                        found,
                        count,
                        begins,
                    )
                    if picky:
                        count = thin(spheres, parameters, start, order, beyond, found, before, count)
    if first[cells] < size:
        width, most = 0.0, LARGE * mean
        count = meet_large(spheres, parameters, start, order, most, beyond, picky, found, count)
    return count, width


@device
def meet_large(spheres, parameters, start, order, most, beyond, picky, found, count) -> Any:  # type: ignore[no-untyped-def]
    """List the spheres with radii above `most` with all others; how many pairs are listed then, -1 if there is no
    place."""
    for i in range(spheres.shape[0]):
        if spheres[i, 3] <= most:
            continue
        for j in range(spheres.shape[0]):
            apart = 0.0
            for c in range(3):
                apart += (spheres[i, c] - spheres[j, c]) ** 2
            reach = spheres[i, 3] + spheres[j, 3] + beyond
            if apart < reach * reach and (j > i or (j < i and spheres[j, 3] <= most)):
                if count < 0 or count >= found.shape[0]:
                    return -1
                found[count] = both(i, j)
                count += 1 if not picky or near(spheres, parameters, start, order, int(i), int(j), beyond) else 0
    return count
