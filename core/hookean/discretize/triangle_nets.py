"""Triangles that change: long edges split, short ones collapsed, edges flipped. Each step changes many places at once.

Of the places that would touch each other the one of lowest rank is changed, the others wait for the next pass: so
the result depends on the mesh alone, and a pass takes time in proportion to its size.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Index = NDArray[np.int64]
Flags = NDArray[np.bool_]

FREE, ON_LINE, FIXED = 0, 1, 2
_TURN = 0.2  # cosine of the most that the normal of a triangle may turn by a step
_PASSES = 100


@dataclass
class Net:
    """Vertices `(n, 3)`, triangles `(m, 3)`, of each vertex its kind and how many neighbours it is to have, and the
    lines `(k, 2)` that stay: boundaries and folds."""

    vertices: Array
    faces: Index
    kinds: Index
    valences: Index
    lines: Index

    def long(self, edges: Index) -> Array:
        """The lengths of edges."""
        out: Array = np.linalg.norm(self.vertices[edges[:, 1]] - self.vertices[edges[:, 0]], axis=1)
        return out

    def on_lines(self, edges: Index) -> Flags:
        """Which edges are of lines."""
        size = len(self.vertices)
        return np.isin(np.sort(edges, axis=1) @ [size, 1], np.sort(self.lines, axis=1) @ [size, 1])


class Table:
    """Edges `(e, 2)` of triangles, lower index first and ascending, and their sides 3 t + k, from corner k on.

    `left` is the first side of each edge, `right` the second or -1, `of` the edge of each side `(m, 3)`, `keys` what
    edges are found by, and `most` the largest number of triangles at an edge.
    """

    def __init__(self, faces: Index, size: int) -> None:
        ends = np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2)
        self.size = size
        self.keys, first, inverse, count = np.unique(
            ends.min(axis=1) * size + ends.max(axis=1), return_index=True, return_inverse=True, return_counts=True
        )
        self.edges: Index = np.stack([self.keys // size, self.keys % size], axis=1)
        self.of: Index = inverse.reshape(-1, 3)
        self.most = int(count.max(initial=0))
        self.left: Index = first
        self.right: Index = np.full(len(first), -1)
        again = np.ones(len(ends), bool)
        again[first] = False
        self.right[inverse.ravel()[again]] = np.flatnonzero(again)

    def known(self, a: Index, b: Index) -> Flags:
        """Whether vertices are joined by an edge."""
        key = np.minimum(a, b) * self.size + np.maximum(a, b)
        at = np.minimum(np.searchsorted(self.keys, key), len(self.keys) - 1)
        found: Flags = self.keys[at] == key
        return found


class Rows:
    """Lists of numbers, one for each vertex: those of pairs (vertex, number)."""

    def __init__(self, vertices: Index, numbers: Index, size: int) -> None:
        order = np.lexsort((numbers, vertices))
        self.numbers = numbers[order]
        self.counts = np.bincount(vertices, minlength=size)
        self.starts = np.cumsum(self.counts) - self.counts

    def of(self, vertices: Index) -> tuple[Index, Index]:
        """Pairs of a place in `vertices` and a number in the list of that vertex."""
        counts = self.counts[vertices]
        owner = np.repeat(np.arange(len(vertices)), counts)
        within = np.arange(len(owner)) - np.repeat(np.cumsum(counts) - counts, counts)
        return owner, self.numbers[np.repeat(self.starts[vertices], counts) + within]


def split(net: Net, longest: float) -> None:
    """Edges longer than `longest` get a vertex in the middle, until there are none."""
    for _ in range(_PASSES):
        table = Table(net.faces, len(net.vertices))
        chosen = net.long(table.edges) > longest
        if not chosen.any():
            return
        _halve(net, table, chosen)


def _halve(net: Net, table: Table, chosen: Flags) -> None:
    size, ends = len(net.vertices), table.edges[chosen]
    number = np.where(chosen, size + np.cumsum(chosen) - 1, -1)
    line = net.on_lines(ends)
    net.vertices = np.concatenate([net.vertices, net.vertices[ends].mean(axis=1)])
    net.kinds = np.concatenate([net.kinds, np.where(line, ON_LINE, FREE)])
    wanted = np.where(table.right[chosen] < 0, 4, 6)
    net.valences = np.concatenate([net.valences, wanted])
    cut = np.isin(np.sort(net.lines, axis=1) @ [size, 1], ends @ [size, 1])
    new = number[chosen][line]
    halves = [np.stack([ends[line, k], new], axis=1) for k in (0, 1)]
    net.lines = np.concatenate([net.lines[~cut], *halves])
    middle = number[table.of]
    many = (middle >= 0).sum(axis=1)
    lone = np.where(many == 1, (middle >= 0).argmax(axis=1), np.where(many == 2, (middle < 0).argmax(axis=1), 0))
    order = (lone[:, None] + np.arange(3)) % 3
    a, b, c = np.take_along_axis(net.faces, order, axis=1).T
    ab, bc, ca = np.take_along_axis(middle, order, axis=1).T
    v = net.vertices
    slant = np.linalg.norm(v[a] - v[bc], axis=1) <= np.linalg.norm(v[b] - v[ca], axis=1)
    cases = (
        (many == 0, [(a, b, c)]),
        (many == 1, [(a, ab, c), (ab, b, c)]),
        ((many == 2) & slant, [(ca, bc, c), (a, b, bc), (a, bc, ca)]),
        ((many == 2) & ~slant, [(ca, bc, c), (a, b, ca), (b, bc, ca)]),
        (many == 3, [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]),
    )
    net.faces = np.concatenate([np.stack(corners, axis=1)[rows] for rows, each in cases for corners in each])


def collapse(net: Net, shortest: float, longest: float) -> None:
    """Edges shorter than `shortest` become a vertex, where no edge becomes longer than `longest` and nothing folds."""
    for _ in range(_PASSES):
        table = Table(net.faces, len(net.vertices))
        size = net.long(table.edges)
        chosen = np.flatnonzero(size < shortest)
        gone, stays, place, fits = _pairs(net, table, chosen)
        chosen, gone, stays, place = chosen[fits], gone[fits], stays[fits], place[fits]
        if not len(chosen):
            return
        order = np.lexsort((_mixed(chosen), np.floor(4.0 * np.log2(np.maximum(size[chosen] / shortest, 1e-9)))))
        chosen, gone, stays, place = chosen[order], gone[order], stays[order], place[order]
        fits, near, core = _checked(net, table, chosen, gone, stays, place, longest)
        wins = fits & _first(near, core, fits, len(net.vertices))
        if not wins.any():
            return
        _merge(net, gone[wins], stays[wins], place[wins])


def _pairs(net: Net, table: Table, chosen: Index) -> tuple[Index, Index, Array, Flags]:
    """Of edges: the vertex that goes, the one that stays, where, and whether kinds and lines permit it."""
    edges = table.edges[chosen]
    kinds, line = net.kinds[edges], net.on_lines(edges)
    turned = kinds[:, 0] < kinds[:, 1]  # the vertex that is bound less goes
    stays, gone = np.where(turned, edges[:, 1], edges[:, 0]), np.where(turned, edges[:, 0], edges[:, 1])
    alike = kinds[:, 0] == kinds[:, 1]
    middle = net.vertices[edges].mean(axis=1)
    place = np.where(alike[:, None], middle, net.vertices[stays])
    fits = (net.kinds[gone] == FREE) | ((net.kinds[gone] == ON_LINE) & line)
    return gone, stays, place, fits


def _checked(
    net: Net, table: Table, chosen: Index, gone: Index, stays: Index, place: Array, longest: float
) -> tuple[Flags, tuple[Index, Index], tuple[Index, Index]]:
    """Whether the mesh stays a surface without folds; pairs of a candidate and each vertex round it, and of each one
    whose neighbours change in number."""
    size = len(net.vertices)
    beside = Rows(table.edges.ravel(), table.edges[:, ::-1].ravel(), size)
    round_ = Rows(net.faces.ravel(), np.repeat(np.arange(len(net.faces)), 3), size)
    fits = np.ones(len(chosen), bool)
    pairs = [beside.of(gone), beside.of(stays)]
    owner, other = (np.concatenate(each) for each in zip(*pairs, strict=True))
    fits[owner[np.linalg.norm(net.vertices[other] - place[owner], axis=1) > longest]] = False
    one, near = pairs[0]
    common = (near != stays[one]) & table.known(near, stays[one])
    sides = np.stack([table.left[chosen], table.right[chosen]], axis=1)
    fits &= np.bincount(one[common], minlength=len(chosen)) == (sides >= 0).sum(axis=1)
    rim = np.zeros(size, bool)
    rim[table.edges[table.right < 0]] = True
    for side in sides.T:
        tip = net.faces[side // 3, (side + 2) % 3]
        few = (beside.counts[tip] < np.where(rim[tip], 3, 4)) | (
            net.on_lines(np.stack([tip, gone], axis=1)) & net.on_lines(np.stack([tip, stays], axis=1))
        )
        fits &= (side < 0) | ~few
    for moved, fixed in ((gone, stays), (stays, gone)):
        owner, face = round_.of(moved)
        corners = net.faces[face]
        keep = ~(corners == fixed[owner, None]).any(axis=1)
        owner, corners = owner[keep], corners[keep]
        before = net.vertices[corners]
        after = np.where((corners == moved[owner, None])[..., None], place[owner, None], before)
        fits[owner[_turns(before, after)]] = False
    tips = np.where(sides >= 0, net.faces[sides // 3, (sides + 2) % 3], gone[:, None])
    core = np.tile(np.arange(len(chosen)), 4), np.concatenate([gone, stays, *tips.T])
    near_owner, near_vertex = (np.concatenate([*(pair[k] for pair in pairs), core[k]]) for k in (0, 1))
    return fits, (near_owner, near_vertex), core


def _turns(before: Array, after: Array) -> Flags:
    """Which triangles `(k, 3, 3)` turn too far; those without area before may turn as they like."""
    old, new = (np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]) for p in (before, after))
    sizes = np.linalg.norm(old, axis=1) * np.linalg.norm(new, axis=1)
    flat = np.linalg.norm(old, axis=1) < 1e-10 * ((before[:, 1] - before[:, 0]) ** 2).sum(axis=1)
    turned: Flags = ((old * new).sum(axis=1) <= _TURN * sizes) & ~flat
    return turned


def _mixed(numbers: Index) -> Index:
    """Numbers in an order without pattern, so that many are the first among those near them (Knuth's hash)."""
    mixed: Index = (numbers * 2654435761) % 2**32
    return mixed


def _first(near: tuple[Index, Index], core: tuple[Index, Index], fits: Flags, size: int) -> Flags:
    """Which candidates are the first of all that change what is near them, or are near what they change."""
    lost = np.zeros(len(fits), bool)
    for (owner, vertex), (other, place) in ((near, core), (core, near)):
        least = np.full(size, len(fits))
        np.minimum.at(least, place[fits[other]], other[fits[other]])
        lost[owner[least[vertex] < owner]] = True
    return ~lost


def _merge(net: Net, gone: Index, stays: Index, place: Array) -> None:
    to = np.arange(len(net.vertices))
    to[gone] = stays
    net.vertices[stays] = place
    faces, lines = to[net.faces], to[net.lines]
    a, b, c = faces.T
    faces = faces[(a != b) & (b != c) & (c != a)]
    lines = np.unique(np.sort(lines[lines[:, 0] != lines[:, 1]], axis=1), axis=0)
    kept = np.unique(faces)
    number = np.full(len(to), -1)
    number[kept] = np.arange(len(kept))
    net.vertices, net.kinds, net.valences = net.vertices[kept], net.kinds[kept], net.valences[kept]
    net.faces, net.lines = number[faces], number[lines].reshape(-1, 2)


def flip(net: Net) -> None:
    """Edges between two triangles are flipped where that brings the numbers of neighbours nearer to those wanted."""
    for _ in range(_PASSES):
        table = Table(net.faces, len(net.vertices))
        inner = np.flatnonzero((table.right >= 0) & ~net.on_lines(table.edges))
        left, right = table.left[inner], table.right[inner]
        a, c = net.faces[left // 3, left % 3], net.faces[left // 3, (left + 2) % 3]
        b, d = net.faces[left // 3, (left + 1) % 3], net.faces[right // 3, (right + 2) % 3]
        count = np.bincount(table.edges.ravel(), minlength=len(net.vertices))
        off = count - net.valences
        gain = sum(off[x] ** 2 - (off[x] + step) ** 2 for x, step in ((a, -1), (b, -1), (c, 1), (d, 1)))
        rows = np.flatnonzero((np.asarray(gain) > 0) & ~table.known(c, d) & (c != d))
        rows = rows[np.lexsort((_mixed(rows), -np.asarray(gain)[rows]))]
        a, b, c, d = a[rows], b[rows], c[rows], d[rows]
        v = net.vertices
        normal = np.cross(v[b] - v[a], v[c] - v[a]) + np.cross(v[a] - v[b], v[d] - v[b])
        fits = np.ones(len(rows), bool)
        for p, q, r in ((a, d, c), (d, b, c)):
            new = np.cross(v[q] - v[p], v[r] - v[p])
            fits &= (new * normal).sum(axis=1) > 0.5 * np.linalg.norm(new, axis=1) * np.linalg.norm(normal, axis=1)
        every = np.tile(np.arange(len(rows)), 4)
        corners = every, np.concatenate([a, b, c, d])
        wins = fits & _first(corners, corners, fits, len(v))
        if not wins.any():
            return
        side, other = left[rows][wins], right[rows][wins]
        net.faces[side // 3] = np.stack([a, d, c], axis=1)[wins]
        net.faces[other // 3] = np.stack([d, b, c], axis=1)[wins]
