"""Edges of shells: packed for the loops of solvers, a shell folds every edge once, though nine elements bend with it.

A packed shell is one row of whole numbers (number of edges, the four particles of each, the nine edges of each element)
and one of numbers: the edges, then sqrt(D A) K of each element by the turns of its edges (3, 9). The loops write the
gradients, turns and moments of the edges into the latter as they go.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.forces.base import Floats, Ints
from hookean.forces.dihedral import SLIVER
from hookean.kernels import device

# an edge: gradients at both tips (four columns each), their feet, cosine and sine of the rest angle, turn, moment
TIP_C, TIP_D, FEET, REST, TURN, MOMENT, EDGE = 0, 4, 8, 10, 12, 13, 14


@device
def bend(x: Any, index: Any, table: Any, f: Any) -> None:
    """Forces of a packed shell: the turns of edges, the moments of elements on them, the forces of edges."""
    edges = index[0]
    for e in range(edges):
        table[e * EDGE + MOMENT] = 0.0
        turn_edge(x, index, table, e)
    first, row = 1 + 4 * edges, edges * EDGE
    for _ in range((index.size - first) // 9):
        bent_x, bent_y, twist = 0.0, 0.0, 0.0
        for h in range(9):
            turn = table[index[first + h] * EDGE + TURN]
            bent_x += table[row + h] * turn
            bent_y += table[row + 9 + h] * turn
            twist += table[row + 18 + h] * turn
        for h in range(9):
            moment = table[row + h] * bent_x + table[row + 9 + h] * bent_y + table[row + 18 + h] * twist
            table[index[first + h] * EDGE + MOMENT] += moment
        first += 9
        row += 27
    for e in range(edges):
        at = e * EDGE
        moment = table[at + MOMENT]
        foot_c, foot_d = table[at + FEET], table[at + FEET + 1]
        a, b = np.uint64(index[4 * e + 1]), np.uint64(index[4 * e + 2])
        c, d = np.uint64(index[4 * e + 3]), np.uint64(index[4 * e + 4])
        for i in range(4):
            at_c, at_d = moment * table[at + TIP_C + i], moment * table[at + TIP_D + i]
            f[a, i] += (1.0 - foot_c) * at_c + (1.0 - foot_d) * at_d
            f[b, i] += foot_c * at_c + foot_d * at_d
            f[c, i] -= at_c
            f[d, i] -= at_d


@device
def angle_of(along: Any, across: Any) -> Any:
    """The angle (-pi, pi] of a direction; for the small ones of most edges in a fraction of arctan2's time."""
    if not 8.0 * np.abs(across) < along:
        return np.arctan2(across, along)
    t = across / along
    s = t * t
    # the series of the arctangent; what follows is below 2e-16 of it
    return t * (
        1.0 - s * (1 / 3 - s * (1 / 5 - s * (1 / 7 - s * (1 / 9 - s * (1 / 11 - s * (1 / 13 - s * (1 / 15)))))))
    )


@device
def turn_edge(x: Any, index: Any, table: Any, e: Any) -> None:
    """Turn of a packed edge from its rest angle, and its gradient; none of both for a sliver. See `dihedral.fold`."""
    a, b = np.uint64(index[4 * e + 1]), np.uint64(index[4 * e + 2])
    c, d = np.uint64(index[4 * e + 3]), np.uint64(index[4 * e + 4])
    at = e * EDGE
    ex, ey, ez = x[b, 0] - x[a, 0], x[b, 1] - x[a, 1], x[b, 2] - x[a, 2]
    px, py, pz = x[c, 0] - x[a, 0], x[c, 1] - x[a, 1], x[c, 2] - x[a, 2]
    qx, qy, qz = x[d, 0] - x[a, 0], x[d, 1] - x[a, 1], x[d, 2] - x[a, 2]
    mx, my, mz = ey * pz - ez * py, ez * px - ex * pz, ex * py - ey * px
    nx, ny, nz = qy * ez - qz * ey, qz * ex - qx * ez, qx * ey - qy * ex
    ee = ex * ex + ey * ey + ez * ez
    mm = mx * mx + my * my + mz * mz
    nn = nx * nx + ny * ny + nz * nz
    size_c = SLIVER * (ee + px * px + py * py + pz * pz)
    size_d = SLIVER * (ee + qx * qx + qy * qy + qz * qz)
    if not mm > size_c * size_c or not nn > size_d * size_d or not ee * ee > 1e-280:
        for i in range(FEET):
            table[at + i] = 0.0
        table[at + TURN] = 0.0
        return
    length = np.sqrt(ee)
    at_c, at_d = length / mm, length / nn
    table[at + TIP_C], table[at + TIP_C + 1], table[at + TIP_C + 2] = mx * at_c, my * at_c, mz * at_c
    table[at + TIP_D], table[at + TIP_D + 1], table[at + TIP_D + 2] = nx * at_d, ny * at_d, nz * at_d
    table[at + FEET] = (px * ex + py * ey + pz * ez) / ee
    table[at + FEET + 1] = (qx * ex + qy * ey + qz * ez) / ee
    sine, cosine = length * (nx * px + ny * py + nz * pz), mx * nx + my * ny + mz * nz
    rest_cosine, rest_sine = table[at + REST], table[at + REST + 1]
    table[at + TURN] = angle_of(cosine * rest_cosine + sine * rest_sine, sine * rest_cosine - cosine * rest_sine)


def plan(corners: Ints, bends: NDArray[np.bool_]) -> tuple[Ints, Ints, Ints]:
    """What packing keeps of the hinges of elements, `corners` (m, 9, 4) and whether they bend (m, 9).

    The whole numbers of `bend`; for each edge the place (element, hinge) that it is first seen at; for each place
    (m, 9) 1, -1 where it has the tips the other way round, or 0 where nothing bends.
    """
    hinges = corners.reshape(-1, 4)
    turned = hinges[:, 0] > hinges[:, 1]  # the fold is the same with both pairs exchanged, and opposite with one
    hinges = np.where(turned[:, None], hinges[:, [1, 0, 3, 2]], hinges)
    other = hinges[:, 2] > hinges[:, 3]
    keys = np.where(other[:, None], hinges[:, [0, 1, 3, 2]], hinges)
    keys[~bends.ravel()] = -1
    order = np.lexsort(keys.T[::-1])
    new = np.ones(len(keys), dtype=bool)
    new[1:] = (keys[order[1:]] != keys[order[:-1]]).any(axis=1)
    new &= keys[order, 0] >= 0
    seen = order[new]  # lexsort is stable: the first of each
    edge = np.empty(len(keys), np.int64)
    edge[order] = np.maximum(np.cumsum(new) - 1, 0)
    sign = np.where(bends.ravel(), np.where(other == other[seen][edge], 1, -1), 0)
    whole = np.concatenate([[len(seen)], hinges[seen].ravel(), edge])
    return whole[None], seen, sign.reshape(-1, 9)


def packed(seen: Ints, sign: Ints, rest: Floats, rows: Floats) -> Floats:
    """The numbers of `bend`: `rest` angles (m, 9) and curvatures by fold angles `rows` (m, 3, 9) of elements."""
    table = np.zeros((len(seen), EDGE))
    angles = rest.ravel()[seen]
    table[:, REST], table[:, REST + 1] = np.cos(angles), np.sin(angles)
    return np.concatenate([table.ravel(), (rows * sign[:, None, :]).ravel()])[None]
