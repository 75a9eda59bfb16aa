"""Near misses: particles of one force that lie on a line, edge or face of another without being joined to it.

Forces are joined where they share particles. Cables divided in 15 along the edge of a membrane that is divided in 20
share few: their other particles lie on the edge and slide along it, which no drawing shows. A particle p lies on an
element where its distance from it is

* less than a tenth of the element's length (of a face: of its shortest side),
* less than half of the shortest element at p, so that what only crosses the element is seldom counted, and
* less than a tenth of the distance from p to each corner of the element that a force joins to p, so that what leaves a
  shared particle at more than 6 degrees is not counted.

An element whose corners are all joined to p, and that is much longer than those at p, is a tie: it does not count.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import chain, product

import numpy as np
from numpy.typing import NDArray

from hookean.forces.base import lengths
from hookean.system import Part, System

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Mask = NDArray[np.bool_]

NEAR = 0.1  # of the length of an element, and of the distance to a corner that is joined
APART = 0.5  # of the shortest element at the particle
TIE = 3.0  # times the shortest element at the particle: what is as long or longer, between joined corners, is a tie
MOST = 2_000  # particles compared with elements of one size of a force; of more, so many at even steps
MOST_LISTED = 10
ROUNDING = 1e-12  # of the size of the scene: so far away is on it
ALL_PAIRS = 200_000  # up to so many, comparing all is quicker than a tree, whose module takes long to import
CELLS = 1 << 20  # entries of the table of occupied cells
WORDS = ("lines", "edges", "faces")


def near_misses(system: System) -> list[str]:
    """A sentence for each pair of forces with near misses in the start shape: the first few, and how many more.

    Of the two directions of a pair the one with the larger part of a force's particles is reported.
    """
    forces = [
        _Force(system, part, group.block.indices[part.rows])
        for group in system.groups
        for part in (group.parts if group.cls.role == "internal" else ())
        if part.rows.stop > part.rows.start
    ]
    forces.sort(key=lambda force: force.part.number)
    owners = _owners(forces, len(system.x))
    used = owners.any(axis=1)
    best: dict[tuple[int, int], tuple[float, str]] = {}
    for g, force in enumerate(forces):
        foreign = np.flatnonzero(used & ~_owned(owners, g))
        near = _compared(system.x, force, foreign) if len(foreign) else None
        if near is None or not len(near.rows):
            continue
        near = near.take(near.distance < _reach(system.x, forces, owners, force.take(near.rows), near.particles))
        for f, share, sentence in _sentences(forces, owners, g, near):
            pair = (min(f, g), max(f, g))
            if share > best.get(pair, (0.0, ""))[0]:
                best[pair] = (share, sentence)
    said = [best[pair][1] for pair in sorted(best)]
    more = len(said) - MOST_LISTED
    return [*said[:MOST_LISTED], f"particles of {more} more pairs of forces nearly meet"] if more > 0 else said


@dataclass(frozen=True)
class _Elements:
    """Four corners each (k, 4), of a line the last one repeated; length [length] and index in `WORDS`."""

    corners: Ints
    length: Floats
    kind: Ints


@dataclass(frozen=True)
class _Near:
    """Pairs of an element (its row) and a particle, with their distance; whether `all` particles were compared."""

    rows: Ints
    particles: Ints
    distance: Floats
    all: bool

    def take(self, chosen: Ints | Mask) -> _Near:
        return _Near(self.rows[chosen], self.particles[chosen], self.distance[chosen], self.all)


class _Force:
    """A force of a system: the particles of its elements, and the lines and faces that others may lie on.

    Rows of elements count the lines first, then the faces.
    """

    def __init__(self, system: System, part: Part, index: Ints) -> None:
        self.system, self.part, self.index = system, part, index
        self.mesh = getattr(part.force, "mesh", None)

    @cached_property
    def faces(self) -> Ints:
        """Faces (k, 4) of the mesh that the force covers; none of one along some edges only."""
        if self.mesh is None or getattr(self.part.force, "edges", "all") != "all":
            return np.zeros((0, 4), np.int64)
        return self.system.places.faces(self.mesh)

    @cached_property
    def lines(self) -> Ints:
        """Lines (k, 2): its elements between two particles, or the sides of its faces."""
        if self.index.shape[1] == 2:
            return self.index
        return np.concatenate([self.faces[:, [i, (i + 1) % 4]] for i in range(4)])

    @cached_property
    def along(self) -> Floats:
        """Lengths of the lines."""
        return self._between(*self.lines.T)

    @cached_property
    def shortest(self) -> Floats:
        """The shortest side of each face, of those that have a length."""
        sides = [self._between(self.faces[:, i], self.faces[:, (i + 1) % 4]) for i in range(4)]
        return np.asarray(np.min([np.where(side > 0.0, side, np.inf) for side in sides], axis=0))

    def _between(self, a: Ints, b: Ints) -> Floats:
        return lengths(self.system.x.take(b, axis=0) - self.system.x.take(a, axis=0))

    def take(self, rows: Ints) -> _Elements:
        """Some elements."""
        count = len(self.lines)
        face = rows >= count
        corners = np.empty((len(rows), 4), np.int64)
        corners[~face] = self.lines[rows[~face]][:, [0, 1, 1, 1]]
        corners[face] = self.faces[rows[face] - count]
        length = np.empty(len(rows))
        length[~face], length[face] = self.along[rows[~face]], self.shortest[rows[face] - count]
        return _Elements(corners, length, np.where(face, 2, 0 if self.mesh is None else 1))

    def spheres(self) -> tuple[Floats, Floats]:
        """For each element the middle (k, 3), and how far from it a particle that lies on the element can be (k,)."""
        x = self.system.x
        ends = [x.take(corner, axis=0) for corner in self.lines.T]
        corners = [x.take(corner, axis=0) for corner in self.faces.T]
        middles = 0.5 * (ends[0] + ends[1]), 0.25 * (corners[0] + corners[1] + corners[2] + corners[3])
        farthest = np.max([lengths(corner - middles[1]) for corner in corners], axis=0)
        reach = np.concatenate([(0.5 + NEAR) * self.along, farthest + NEAR * self.shortest])
        return np.concatenate(middles), np.where(np.isfinite(reach), reach, 0.0)

    @property
    def name(self) -> str:
        """What a person calls it: its name where no other force has that, else its place in the scene."""
        name = self.part.force.name
        names = [force.name for force in self.system.scene.forces]
        return name if name and names.count(name) == 1 else f"/forces/{self.part.number}"


def _owners(forces: list[_Force], count: int) -> NDArray[np.uint64]:
    """For each particle the forces it belongs to, as bits (count, words)."""
    owners = np.zeros((count, (len(forces) + 63) // 64), np.uint64)
    for g, force in enumerate(forces):
        mine = np.zeros(count, bool)
        mine[force.index.ravel()] = True
        owners[mine, g // 64] |= np.uint64(1 << g % 64)
    return owners


def _owned(owners: NDArray[np.uint64], g: int) -> Mask:
    """Which particles belong to force g."""
    return np.asarray(owners[:, g // 64] & np.uint64(1 << g % 64), dtype=bool)


def _compared(x: Floats, force: _Force, foreign: Ints) -> _Near:
    """Elements and foreign particles with less than a tenth of the element's length between them.

    Elements are compared by their size, within a factor of two, in cells as large as they are.
    """
    middle, reach = force.spheres()
    size = np.frexp(reach)[1].clip(-1000)  # of those without a length 0
    found = [_Near(np.zeros(0, np.int64), np.zeros(0, np.int64), np.zeros(0), True)]
    for octave in np.flatnonzero(np.bincount(size + 1000)) - 1000:
        rows, radius = np.flatnonzero((size == octave) & (reach > 0.0)), float(np.ldexp(1.0, int(octave)))
        near = foreign
        if len(near) > MOST:
            near = near[_beside(x.take(near, axis=0), middle[rows], radius)]
        some = near[:: max(1, -(-len(near) // MOST))]
        rows = rows[_beside(middle[rows], x.take(some, axis=0), radius)]
        first, second = _pairs(middle[rows], x.take(some, axis=0), radius)
        pairs = _Near(rows[first], some[second], np.zeros(len(first)), len(some) == len(near))
        elements = force.take(pairs.rows)
        apart = distances(x.take(pairs.particles, axis=0), x.take(elements.corners, axis=0))
        found.append(_Near(pairs.rows, pairs.particles, apart, pairs.all).take(apart < NEAR * elements.length))
    return _Near(
        np.concatenate([near.rows for near in found]),
        np.concatenate([near.particles for near in found]),
        np.concatenate([near.distance for near in found]),
        all(near.all for near in found),
    )


def _beside(points: Floats, others: Floats, radius: float) -> Ints:
    """Which points (k, 3) have one of the others within a radius, and a few more: those in cells near others."""
    if not len(points) or not len(others):
        return np.zeros(0, np.int64)
    low, high = others.min(axis=0) - radius, others.max(axis=0) + radius
    x, y, z = ((column >= a) & (column <= b) for column, a, b in zip(points.T, low, high, strict=True))
    near = np.flatnonzero(x & y & z)
    points = points.take(near, axis=0)
    cell = max(2.0 * radius, float((high - low).max()) / 2**20)

    def place(rows: Floats) -> Ints:
        """The entry of the cell of each row; those of different cells may be the same one."""
        i, j, k = ((column / cell).astype(np.int64) for column in (rows - low).T)
        return np.asarray((i * 73856093 ^ j * 19349663 ^ k * 83492791) & (CELLS - 1))

    # a cube of the radius about a point is in eight cells at most; the fewer of both get such cubes
    shifts = np.array(list(product((-radius, radius), repeat=3)))
    table = np.zeros(CELLS, bool)
    if len(others) < len(points):
        for shift in shifts:
            table[place(others + shift)] = True
        return near[table[place(points)]]
    table[place(others)] = True
    return near[np.any([table[place(points + shift)] for shift in shifts], axis=0)]


def _pairs(middle: Floats, points: Floats, radius: float) -> tuple[Ints, Ints]:
    """Rows of middles and points within a radius."""
    if len(middle) * len(points) <= ALL_PAIRS:
        first, second = np.divmod(np.arange(len(middle) * len(points)), max(len(points), 1))
    else:
        from scipy.spatial import cKDTree

        lists = cKDTree(middle).query_ball_point(points, radius, return_sorted=True)
        second = np.repeat(np.arange(len(points)), [len(row) for row in lists])
        first = np.fromiter(chain.from_iterable(lists), np.int64, len(second))
    near = lengths(points.take(second, axis=0) - middle.take(first, axis=0)) <= radius
    return first[near], second[near]


def distances(points: Floats, corners: Floats) -> Floats:
    """Distance of each point (k, 3) from its face (k, 4, 3) of two triangles; a line repeats its last corner."""
    halves = [_from_triangles(points, corners[:, half]) for half in ([0, 1, 2], [0, 2, 3])]
    return np.minimum(*halves)


def _from_triangles(points: Floats, corners: Floats) -> Floats:
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    square = np.einsum("ij,ij->i", normal, normal)
    inside, nearest = square > 0.0, np.full(len(points), np.inf)
    for i in range(3):
        apart, side = points - corners[:, i], corners[:, (i + 1) % 3] - corners[:, i]
        long = np.einsum("ij,ij->i", side, side)
        at = np.clip(np.einsum("ij,ij->i", apart, side) / np.where(long > 0.0, long, 1.0), 0.0, 1.0)
        nearest = np.minimum(nearest, lengths(apart - at[:, None] * side))
        inside &= np.einsum("ij,ij->i", np.cross(side, apart), normal) >= 0.0
    height = np.abs(np.einsum("ij,ij->i", points - corners[:, 0], normal)) / np.sqrt(np.where(inside, square, 1.0))
    return np.where(inside, height, nearest)


def _reach(x: Floats, forces: list[_Force], owners: NDArray[np.uint64], elements: _Elements, particles: Ints) -> Floats:
    """How near each particle must be to lie on its element."""
    spacing = _spacing(forces, particles, len(x))
    reach = np.minimum(NEAR * elements.length, APART * spacing)
    tie = elements.length >= TIE * spacing
    for corner in elements.corners.T:
        joined = (owners[corner] & owners[particles]).any(axis=1)
        away = NEAR * lengths(x.take(corner, axis=0) - x.take(particles, axis=0))
        reach = np.where(joined, np.minimum(reach, away), reach)
        tie &= joined
    return np.where(tie, 0.0, reach)


def _spacing(forces: list[_Force], particles: Ints, count: int) -> Floats:
    """The shortest line at each particle, infinite where there is none."""
    wanted = np.zeros(count, bool)
    wanted[particles] = True
    shortest = np.full(count, np.inf)
    for force in forces:
        there = wanted[force.lines].any(axis=1) & (force.along > 0.0)
        for end in force.lines[there].T:
            np.minimum.at(shortest, end, force.along[there])
    return shortest[particles]


def _sentences(
    forces: list[_Force], owners: NDArray[np.uint64], g: int, near: _Near
) -> Iterator[tuple[int, float, str]]:
    """For each force with particles on force g: its number here, the part of its particles, and a sentence."""
    kind, system = forces[g].take(near.rows).kind, forces[g].system
    order = np.lexsort((near.distance, kind, near.particles))
    near, kind = near.take(order), kind[order]
    for f in np.flatnonzero([_owned(owners[near.particles], f).any() for f in range(len(forces))]).tolist():
        mine = np.flatnonzero(_owned(owners[near.particles], f))
        first, away = near.particles[mine[0]], float(near.distance[mine[0]])
        away *= away > ROUNDING * system.size
        count, total = len(np.unique(near.particles[mine])), int(np.count_nonzero(_owned(owners, f)))
        spot = ", ".join(f"{c:.6g}" for c in system.x[first])
        least, what = "" if near.all else "at least ", WORDS[kind[mine[0]]]
        sentence = (
            f"{forces[f].name}: {least}{count} of {total} particles lie on {what} of {forces[g].name}, within a tenth "
            f"of their length, but are not joined to it; the first is particle {first} at ({spot}), {away:.3g} "
            f"{system.scene.units.length} away. Divide both the same way or raise weld_tolerance"
        )
        yield f, count / total, sentence
