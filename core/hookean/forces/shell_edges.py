"""Edges of shells: packed, a shell takes every normal and every fold once, though nine elements bend with a fold.

The curvature of a triangle comes from three parts, one of the fold theta of each edge (see `shell`): psi on the side of
the edge's first triangle, theta - psi on that of the second. psi comes from the edge's own fold and those of the four
others of its two triangles. So a pass goes from triangles (normals) to edges (folds, then their parts), to triangles
(moments on the parts), to edges (moments on the folds), and to triangles again: all forces are along their normals.

Packed, a shell is one row of whole numbers, most of them two to a word: how many edges and triangles, whether lumped
stiffness is asked for; of each edge an end and the tip of its first triangle, where in the room its triangles are,
where the two products that its length comes from, and the four others; of each triangle its corners and the sides of
its edges, 2 e that of the first and 2 e + 1 that of the second triangle of edge e; of each edge the other end and tip.
One row of numbers: EDGE of each edge, FACE of each triangle, a bound of each edge's stiffness. And one row of room that
the passes write. What a naked edge would refer to is one edge more, which never turns.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from hookean.compiled.marks import device
from hookean.forces.base import Floats, Ints
from hookean.forces.dihedral import SLIVER, slopes

HEAD, EDGE_WORDS, FACE_WORDS = 3, 5, 3
# of an edge: cosine and sine of the rest angle; -1 if its second triangle is turned over; what its own fold and those
# of the others add to psi; what their psi take from its fold
REST, SIGN, OWN, OTHERS, BACK, EDGE = 0, 2, 3, 4, 8, 12
FACE = 6  # different numbers of a symmetric matrix
SQUARE, CORNERS, NORMAL = 3, 4, 7  # of a triangle's room: normal, 1 / its square, the products of sides at its corners
BATCH = 64
ONE, TWO, THREE = np.uint64(1), np.uint64(2), np.uint64(SQUARE)


@device
def bend(x: Any, index: Any, table: Any, room: Any, f: Any, w: Any) -> Any:
    """Forces of a packed shell, and its lumped stiffness if `index` asks for it; returns its energy."""
    edges, faces = index[0], index[1]
    end = HEAD + EDGE_WORDS * edges
    links, corners = index[HEAD:end].reshape(edges, EDGE_WORDS), index[end : end + FACE_WORDS * faces]
    corners = corners.reshape(faces, FACE_WORDS)
    numbers, end = table[: EDGE * edges].reshape(edges, EDGE), EDGE * edges
    products = table[end : end + FACE * faces].reshape(faces, FACE)
    known, end = room[: NORMAL * faces], NORMAL * faces
    normals = known.reshape(faces, NORMAL)
    turns, inverse = room[end : end + edges + 1], room[end + edges + 1 : end + 2 * edges + 1]
    across, end = room[end + 2 * edges + 1 : end + 3 * edges + 2], end + 3 * edges + 2
    sides, work = room[end : end + 2 * edges + 1], room[end + 2 * edges + 1 :]
    span(x, corners, normals)
    turn(x, links, numbers, known, turns, inverse, work)
    halve(links, numbers, turns, sides)
    energy = resist(corners, products, sides)
    for e in range(edges):
        across[e] = sides[2 * e] - sides[2 * e + 1]
    collect(links, numbers, across, inverse, sides)
    push(corners, normals, sides, f)
    if index[2] != 0:
        weigh(x, links, index[index.size - edges :], table[table.size - edges :], inverse, sides, w)
    return energy


@device
def low(word: Any) -> Any:
    """The first of two whole numbers in a word; unsigned: no index counts from the end."""
    return np.uint64(word) & np.uint64(0xFFFFFFFF)


@device
def high(word: Any) -> Any:
    """The second."""
    return np.uint64(word) >> np.uint64(32)


@device
def span(x: Any, corners: Any, normals: Any) -> None:
    """Normals of triangles, 1 / their square (0 for a sliver), and the products of sides at their corners."""
    for t in range(corners.shape[0]):
        a, b, c = low(corners[t, 0]), high(corners[t, 0]), low(corners[t, 1])
        px, py, pz = x[b, 0] - x[a, 0], x[b, 1] - x[a, 1], x[b, 2] - x[a, 2]
        qx, qy, qz = x[c, 0] - x[a, 0], x[c, 1] - x[a, 1], x[c, 2] - x[a, 2]
        rx, ry, rz = x[c, 0] - x[b, 0], x[c, 1] - x[b, 1], x[c, 2] - x[b, 2]
        nx, ny, nz = py * qz - pz * qy, pz * qx - px * qz, px * qy - py * qx
        at_a, at_b = px * qx + py * qy + pz * qz, -(px * rx + py * ry + pz * rz)
        at_c = qx * rx + qy * ry + qz * rz
        nn = nx * nx + ny * ny + nz * nz
        size = SLIVER * (2.0 * at_a + at_b + at_c)
        normals[t, 0], normals[t, 1], normals[t, 2] = nx, ny, nz
        normals[t, SQUARE] = 1.0 / nn if nn > size * size and nn > 1e-280 else 0.0
        normals[t, CORNERS], normals[t, CORNERS + 1], normals[t, CORNERS + 2] = at_a, at_b, at_c


@device
def turn(x: Any, links: Any, numbers: Any, known: Any, turns: Any, inverse: Any, work: Any) -> None:
    """Turns of edges from their rest angles (see `dihedral`), and 1 / their lengths; 0 beside a sliver.

    By batches: what is fetched from all over goes to `work`, so that the rest takes several edges in one operation.
    """
    for first in range(0, links.shape[0], BATCH):
        last = min(first + BATCH, links.shape[0])
        odd = False  # whether there is a sliver or a large turn
        for e in range(first, last):
            k = e - first
            a, c, s, t = low(links[e, 0]), high(links[e, 0]), low(links[e, 1]), high(links[e, 1])
            nx, ny, nz = known[t], known[t + ONE], known[t + TWO]
            px, py, pz = x[c, 0] - x[a, 0], x[c, 1] - x[a, 1], x[c, 2] - x[a, 2]
            work[k] = known[low(links[e, 2])] + known[high(links[e, 2])]
            work[k + BATCH] = known[s] * nx + known[s + ONE] * ny + known[s + TWO] * nz
            work[k + 2 * BATCH] = px * nx + py * ny + pz * nz
            work[k + 3 * BATCH], work[k + 4 * BATCH] = numbers[e, REST], numbers[e, REST + 1]
            odd |= known[s + THREE] == 0.0 or known[t + THREE] == 0.0
        for k in range(BATCH):
            length = np.sqrt(work[k])
            cosine, sine = work[k + BATCH], length * work[k + 2 * BATCH]
            rest_cosine, rest_sine = work[k + 3 * BATCH], work[k + 4 * BATCH]
            along, aside = cosine * rest_cosine + sine * rest_sine, sine * rest_cosine - cosine * rest_sine
            work[k], work[k + BATCH], work[k + 2 * BATCH] = 1.0 / length, along, aside
            work[k + 3 * BATCH] = small(along, aside)
        for e in range(first, last):
            k = e - first
            turns[e], inverse[e] = work[k + 3 * BATCH], work[k]
            odd |= not 8.0 * np.abs(work[k + 2 * BATCH]) < work[k + BATCH]
        if odd:
            for e in range(first, last):
                turns[e] = angle_of(work[e - first + BATCH], work[e - first + 2 * BATCH])
                if known[low(links[e, 1]) + THREE] == 0.0 or known[high(links[e, 1]) + THREE] == 0.0:
                    turns[e], inverse[e] = 0.0, 0.0


@device
def angle_of(along: Any, aside: Any) -> Any:
    """The angle (-pi, pi] of a direction; for the small ones of most edges in a fraction of arctan2's time."""
    return small(along, aside) if 8.0 * np.abs(aside) < along else np.arctan2(aside, along)


@device
def small(along: Any, aside: Any) -> Any:
    """The same below 1/8: the series of the arctangent; what follows is below 2e-16 of it."""
    t = aside / along
    s = t * t
    return t * (
        1.0 - s * (1 / 3 - s * (1 / 5 - s * (1 / 7 - s * (1 / 9 - s * (1 / 11 - s * (1 / 13 - s * (1 / 15)))))))
    )


@device
def halve(links: Any, numbers: Any, turns: Any, sides: Any) -> None:
    """The parts of folds on the two sides of their edges."""
    for e in range(links.shape[0]):
        g, h, i, j = low(links[e, 3]), high(links[e, 3]), low(links[e, 4]), high(links[e, 4])
        one = numbers[e, OTHERS] * turns[g] + numbers[e, OTHERS + 1] * turns[h]
        two = numbers[e, OTHERS + 2] * turns[i] + numbers[e, OTHERS + 3] * turns[j]
        psi = numbers[e, OWN] * turns[e] + (one + two)
        sides[2 * e] = psi
        sides[2 * e + 1] = turns[e] - psi
    sides[2 * links.shape[0]] = 0.0


@device
def resist(corners: Any, products: Any, sides: Any) -> Any:
    """Moments on the parts of folds, in their place; returns the energy."""
    energy = 0.0
    for t in range(corners.shape[0]):
        i, j, k = high(corners[t, 1]), low(corners[t, 2]), high(corners[t, 2])
        p, q, r = sides[i], sides[j], sides[k]
        on_p = products[t, 0] * p + products[t, 1] * q + products[t, 2] * r
        on_q = products[t, 1] * p + products[t, 3] * q + products[t, 4] * r
        on_r = products[t, 2] * p + products[t, 4] * q + products[t, 5] * r
        energy += on_p * p + on_q * q + on_r * r
        sides[i], sides[j], sides[k] = on_p, on_q, on_r
    return 0.5 * energy


@device
def collect(links: Any, numbers: Any, across: Any, inverse: Any, sides: Any) -> None:
    """Moments on folds over the lengths of their edges, as both triangles see them."""
    for e in range(links.shape[0]):
        g, h, i, j = low(links[e, 3]), high(links[e, 3]), low(links[e, 4]), high(links[e, 4])
        one = numbers[e, BACK] * across[g] + numbers[e, BACK + 1] * across[h]
        two = numbers[e, BACK + 2] * across[i] + numbers[e, BACK + 3] * across[j]
        moment = (sides[2 * e + 1] + numbers[e, OWN] * across[e] + (one + two)) * inverse[e]
        sides[2 * e] = moment
        sides[2 * e + 1] = numbers[e, SIGN] * moment


@device
def push(corners: Any, normals: Any, moments: Any, f: Any) -> None:
    """Forces of triangles: an edge's moment pushes its tip, and its ends the other way, by where the tip's foot is."""
    for t in range(corners.shape[0]):
        a, b, c = low(corners[t, 0]), high(corners[t, 0]), low(corners[t, 1])
        ab, bc, ca = moments[high(corners[t, 1])], moments[low(corners[t, 2])], moments[high(corners[t, 2])]
        at_a, at_b, at_c = normals[t, CORNERS], normals[t, CORNERS + 1], normals[t, CORNERS + 2]
        on_a = normals[t, SQUARE] * ((ab - bc) * at_b + (ca - bc) * at_c)
        on_b = normals[t, SQUARE] * ((bc - ca) * at_c + (ab - ca) * at_a)
        for i in range(3):
            force_a, force_b = on_a * normals[t, i], on_b * normals[t, i]
            f[a, i] += force_a
            f[b, i] += force_b
            f[c, i] -= force_a + force_b


@device
def weigh(x: Any, links: Any, others: Any, bounds: Any, inverse: Any, moments: Any, w: Any) -> None:
    """What the stiffness of elements and the moments on folds add to the lumped stiffness."""
    g = np.zeros((4, 5))
    for e in range(links.shape[0]):
        a, b, c, d = low(links[e, 0]), low(others[e]), high(links[e, 0]), high(others[e])
        sine, _ = slopes(x, a, b, c, d, g)
        if inverse[e] == 0.0 or np.isnan(sine):
            continue
        moment = np.abs(moments[2 * e] / inverse[e])
        w[a] += bounds[e] * g[0, 3] + moment * g[0, 4]
        w[b] += bounds[e] * g[1, 3] + moment * g[1, 4]
        w[c] += bounds[e] * g[2, 3] + moment * g[2, 4]
        w[d] += bounds[e] * g[3, 3] + moment * g[3, 4]


@dataclass(frozen=True)
class Plan:
    """What packing keeps of the triangles of a mesh: the whole numbers of `bend` without and with lumped stiffness.

    A place 3 t + i is the edge from corner i of triangle t. Of each edge the places of its two sides, its four others
    (their number is the count of edges for a naked one), and the signs of their folds as its first triangle sees them;
    of each place its edge and the sign of that one's fold as the triangle sees it.
    """

    quick: Ints
    whole: Ints
    first: Ints
    second: Ints
    others: Ints
    signs: Floats
    edge: Ints
    view: Floats

    @classmethod
    def of(cls, corners: Ints, across: Ints) -> Plan:
        """Of triangles (m, 3), and the places (m, 3) across their edges, -1 for none."""
        start, across, place = corners.ravel(), across.ravel(), np.arange(corners.size)
        first = np.flatnonzero(across > place)
        second, count = across[first], len(first)
        edge, side = np.full(corners.size, count), np.full(corners.size, 2 * count)
        edge[first] = edge[second] = np.arange(count)
        side[first], side[second] = 2 * edge[first], 2 * edge[first] + 1
        turned = (
            start[first] == start[second]
        )  # neighbours run along their edge in opposite ways, or one is turned over
        sign = np.where(turned, -1.0, 1.0)
        view = np.ones(corners.size)
        view[second] = sign
        near = [_beside(first, 1), _beside(first, 2)]
        far = [_beside(second, 1 + turned), _beside(second, 2 - turned)]
        others = np.stack([edge[q] for q in near + far], axis=1)
        signs = np.stack([view[q] for q in near] + [sign * view[q] for q in far], axis=1)
        room = NORMAL * (first // 3) + CORNERS
        links = [_pair(start[first], start[_beside(first, 2)]), NORMAL * _pair(first // 3, second // 3)]
        links += [_pair(room + first % 3, room + (first + 1) % 3)]
        links += [_pair(others[:, 0], others[:, 1]), _pair(others[:, 2], others[:, 3])]
        faces = [_pair(corners[:, 0], corners[:, 1]), _pair(corners[:, 2], side[0::3]), _pair(side[1::3], side[2::3])]
        rest = _pair(start[_beside(first, 1)], start[_beside(second, 2)])
        parts = [np.column_stack(links).ravel(), np.column_stack(faces).ravel(), rest]
        quick, whole = (np.concatenate([[count, len(corners), weighs], *parts])[None] for weighs in (0, 1))
        return cls(quick, whole, first, second, others, signs, edge, view)

    def room(self) -> Floats:
        """Room for the passes; zeros, as what belongs to the edge that never turns stays."""
        count, faces = len(self.first), len(self.edge) // 3
        return np.zeros((1, NORMAL * faces + 5 * count + 3 + 5 * BATCH))

    def summed(self, hinges: Floats) -> Floats:
        """Sums over edges of what belongs to the nine hinges of elements (m, 9)."""
        beyond = np.full((len(self.edge), 2), len(self.first))
        beyond[self.first], beyond[self.second] = self.others[:, 2:], self.others[:, :2]
        edge = np.concatenate([self.edge.reshape(-1, 3), beyond.reshape(-1, 6)], axis=1)
        sums: Floats = np.bincount(edge.ravel(), hinges.ravel(), len(self.first) + 1)[:-1].astype(np.float64)
        return sums

    def numbers(self, strength: Floats, rest: Floats, bounds: Floats, axes: Floats, parts: Floats) -> Floats:
        """The numbers of `bend` from those of triangles as in `shell`: D, rest angles and bounds of their own edges
        (m, 3), axes (m, 3, 3), parts (m, 3, 5)."""
        count = len(self.first)
        there = self.others < count
        adds = parts.reshape(-1, 5)[self.first]
        table, sign, angle = np.zeros((count, EDGE)), self.view[self.second], rest.ravel()[self.first]
        table[:, REST], table[:, REST + 1], table[:, SIGN] = sign * np.cos(angle), sign * np.sin(angle), sign
        table[:, OWN] = adds[:, 0]
        table[:, OTHERS:BACK] = np.where(there, self.signs * adds[:, 1:], 0.0)
        # edge e is among the others of g as often as g among those of e
        mine, theirs = np.nonzero(there)[0], self.others[there]
        back = np.zeros(len(mine))
        back[np.lexsort((theirs, mine))] = table[:, OTHERS:BACK][there][np.lexsort((mine, theirs))]
        table[:, BACK:][there] = back
        signed = axes * np.where(self.edge < count, self.view, 0.0).reshape(-1, 1, 3)
        product = strength[:, None, None] * np.einsum("tki,tkj->tij", signed, signed)
        upper = product[:, [0, 0, 0, 1, 1, 2], [0, 1, 2, 1, 2, 2]]
        return np.concatenate([table.ravel(), upper.ravel(), bounds])[None]


def places(index: Ints, offset: Ints, factor: Floats) -> Ints | None:
    """Places across the edges of elements (m, 12), so many further on (m, 3), -1 for none; None where some of them are
    not among the elements, or of another shell, with another factor (m,) on its start angles."""
    other = np.arange(offset.size).reshape(-1, 3) + offset
    if not len(index) or not ((other >= 0) & (other < offset.size)).all():
        return None
    t, i = other // 3, other % 3
    start, end, mine, after = index[t, i], index[t, (i + 1) % 3], index[:, :3], index[:, [1, 2, 0]]
    fits = ((start == mine) & (end == after)) | ((start == after) & (end == mine))
    fits &= (index[t, (i + 2) % 3] == index[:, 3:6]) & (offset[t, i] == -offset) & (factor[t] == factor[:, None])
    return np.where(offset != 0, other, -1) if (fits | (offset == 0)).all() else None


def _beside(places: Ints, by: int | Ints) -> Ints:
    """The places that many edges on in their triangles."""
    return places - places % 3 + (places + by) % 3


def _pair(a: Ints, b: Ints) -> Ints:
    return a | b << 32
