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

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import chain, product
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from hookean.forces.base import lengths

if TYPE_CHECKING:
    from hookean.system.group import Part
    from hookean.system.system import System

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Mask = NDArray[np.bool_]

NEAR = 0.1  # of the length of an element, and of the distance to a corner that is joined
APART = 0.5  # of the shortest element at the particle
TIE = 3.0  # times the shortest element at the particle: what is as long or longer, between joined corners, is a tie
MOST = 2_000  # particles compared with elements of one size of a force; of more, so many at even steps
LEAST, ALTOGETHER = 20, 100_000  # of many forces fewer for each, so that the time grows with the scene alone
MOST_LISTED = 10
ROUNDING = 1e-12  # of the size of the scene: so far away is on it
PAIRS = 500_000  # of a particle and an element that are compared, of elements of one size: of more, fewer particles
ALL_PAIRS = 200_000  # up to so many, comparing all is quicker than a tree, whose module takes long to import
CELLS = 1 << 20  # entries of the table of occupied cells
WORDS = ("lines", "edges", "faces")


def near_misses(system: System) -> list[str]:
    """A sentence for each pair of forces with near misses in the start shape: the first few, and how many more.

    Of the two directions of a pair the one with the larger part of a force's particles is reported.
    """
    forces = [
        Force(system, part, group.particles[part.rows])
        for group in system.groups
        for part in (group.parts if group.cls.role == "internal" and group.cls.solid else ())
        if part.rows.stop > part.rows.start
    ]
    if len(forces) < 2:
        return []
    forces.sort(key=lambda force: force.part.number)
    x = system.points
    owners, spacing = _Owners(forces, len(x)), _spacing(forces, len(x))
    most = min(MOST, max(LEAST, ALTOGETHER // max(1, len(forces))))
    best: dict[tuple[int, int], _Met] = {}
    for g, force in enumerate(forces):
        near = compared(x, force, owners.beside(x, g, force), most)
        if not len(near.rows):
            continue
        elements = force.take(near.rows)
        near = near.take(near.distance < _reach(x, owners, spacing, elements, near.particles))
        for met in _met(owners, force, g, near):
            pair = (min(met.f, g), max(met.f, g))
            if pair not in best or met.share > best[pair].share:
                best[pair] = met
    names = Counter(force.name for force in system.scene.forces)
    said = [best[pair].sentence(forces, names) for pair in sorted(best)[:MOST_LISTED]]
    more = len(best) - MOST_LISTED
    return [*said, f"particles of {more} more pairs of forces nearly meet"] if more > 0 else said


@dataclass(frozen=True)
class _Elements:
    """Four corners each (k, 4), of a line the last one repeated; length [length] and index in `WORDS`."""

    corners: Ints
    length: Floats
    kind: Ints


@dataclass(frozen=True)
class Near:
    """Pairs of an element (its row) and a particle, with their distance; whether `all` particles were compared."""

    rows: Ints
    particles: Ints
    distance: Floats
    all: bool

    def take(self, chosen: Ints | Mask) -> Near:
        return Near(self.rows[chosen], self.particles[chosen], self.distance[chosen], self.all)


class Force:
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
        x = self.system.points
        ends = [x.take(corner, axis=0) for corner in self.lines.T]
        corners = [x.take(corner, axis=0) for corner in self.faces.T]
        middles = 0.5 * (ends[0] + ends[1]), 0.25 * (corners[0] + corners[1] + corners[2] + corners[3])
        farthest = np.max([lengths(corner - middles[1]) for corner in corners], axis=0)
        reach = np.concatenate([(0.5 + NEAR) * self.along, farthest + NEAR * self.shortest])
        return np.concatenate(middles), np.where(np.isfinite(reach), reach, 0.0)


class _Owners:
    """The forces that each particle belongs to, by their places among those compared, in ascending order."""

    def __init__(self, forces: list[Force], count: int) -> None:
        mine = [np.unique(force.index) for force in forces]
        self.totals = np.array([len(particles) for particles in mine], np.int64)
        particles, owner = np.concatenate(mine), np.repeat(np.arange(len(mine)), self.totals)
        order = np.lexsort((owner, particles))
        self.forces = owner[order]
        self.start = np.searchsorted(particles[order], np.arange(count + 1))
        self.pairs = np.unique(owner * count + particles)
        self.count = count
        self.mine = mine
        self.used = np.flatnonzero(np.diff(self.start))
        self._own = np.zeros(count, bool)
        self._along: tuple[int, Ints, Floats] | None = None

    def of(self, particles: Ints) -> tuple[Ints, Ints]:
        """Rows of `particles` and a force of each; as many as they have forces."""
        many = self.start[particles + 1] - self.start[particles]
        rows = np.repeat(np.arange(len(particles)), many)
        within = np.arange(len(rows)) - np.repeat(np.cumsum(many) - many, many)
        return rows, self.forces[self.start[particles][rows] + within]

    def has(self, particles: Ints, forces: Ints) -> Mask:
        """Whether each of some particles belongs to the force beside it."""
        wanted = forces * self.count + particles
        return np.asarray(self.pairs[np.minimum(np.searchsorted(self.pairs, wanted), len(self.pairs) - 1)] == wanted)

    def beside(self, x: Floats, g: int, force: Force) -> Ints:
        """Particles of other forces that are not beyond all elements of force g along the longest side of the scene."""
        if self._along is None:
            axis = int(np.argmax(np.ptp(x.take(self.used, axis=0), axis=0)))
            order = self.used[np.argsort(x[self.used, axis], kind="stable")]
            self._along = axis, order, x[order, axis]
        axis, order, sorted_ = self._along
        middle, reach = force.spheres()
        least = (middle[:, axis] - reach).min(initial=np.inf)
        most = (middle[:, axis] + reach).max(initial=-np.inf)
        rounding = ROUNDING * np.abs(sorted_).max(initial=0.0)
        low, high = np.searchsorted(sorted_, (least - rounding, most + rounding), "left")
        found = np.sort(order[low:high])
        self._own[self.mine[g]] = True
        found = found[~self._own[found]]
        self._own[self.mine[g]] = False
        return np.asarray(found)


def compared(x: Floats, force: Force, foreign: Ints, most: int = MOST) -> Near:
    """Elements and foreign particles with less than a tenth of the element's length between them.

    Elements are compared by their size, within a factor of two, in cells as large as they are.
    """
    middle, reach = force.spheres()
    size = np.frexp(reach)[1].clip(-1000)  # of those without a length 0
    found = [Near(np.zeros(0, np.int64), np.zeros(0, np.int64), np.zeros(0), True)]
    for octave in np.flatnonzero(np.bincount(size + 1000)) - 1000:
        rows, radius = np.flatnonzero((size == octave) & (reach > 0.0)), float(np.ldexp(1.0, int(octave)))
        near = foreign
        if len(near) > most:
            near = near[_beside(x.take(near, axis=0), middle[rows], radius)]
        some = near[:: max(1, -(-len(near) // most))]
        rows = rows[_beside(middle[rows], x.take(some, axis=0), radius)]
        first, second, whole = _pairs(middle[rows], x.take(some, axis=0), radius)
        pairs = Near(rows[first], some[second], np.zeros(len(first)), whole and len(some) == len(near))
        elements = force.take(pairs.rows)
        apart = distances(x.take(pairs.particles, axis=0), x.take(elements.corners, axis=0))
        found.append(Near(pairs.rows, pairs.particles, apart, pairs.all).take(apart < NEAR * elements.length))
    return Near(
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


def _pairs(middle: Floats, points: Floats, radius: float) -> tuple[Ints, Ints, bool]:
    """Rows of middles and points within a radius, and whether these are of all points: where there are more than
    `PAIRS`, of points at even steps."""
    step = 1
    if len(middle) * len(points) <= ALL_PAIRS:
        first, second = np.divmod(np.arange(len(middle) * len(points)), max(len(points), 1))
    else:
        from scipy.spatial import cKDTree

        tree = cKDTree(middle)
        if len(middle) * len(points) > PAIRS:
            step = max(1, -(-int(tree.count_neighbors(cKDTree(points), radius)) // PAIRS))
        lists = tree.query_ball_point(points[::step], radius, return_sorted=True)
        second = step * np.repeat(np.arange(len(lists)), [len(row) for row in lists])
        first = np.fromiter(chain.from_iterable(lists), np.int64, len(second))
    near = lengths(points.take(second, axis=0) - middle.take(first, axis=0)) <= radius
    return first[near], second[near], step == 1


def distances(points: Floats, corners: Floats) -> Floats:
    """Distance of each point (k, 3) from its face (k, 4, 3) of two triangles; a line repeats its last corner."""
    line = (corners[:, 1:2] == corners[:, 2:]).all(axis=(1, 2))
    if line.all():
        return _from_lines(points, corners[:, 0], corners[:, 1])
    apart = np.empty(len(points))
    apart[line] = _from_lines(points[line], corners[line, 0], corners[line, 1])
    points, corners = points[~line], corners[~line]
    halves = [_from_triangles(points, corners[:, half]) for half in ([0, 1, 2], [0, 2, 3])]
    apart[~line] = np.minimum(*halves)
    return apart


def _from_lines(points: Floats, starts: Floats, ends: Floats) -> Floats:
    apart, side = points - starts, ends - starts
    long = np.einsum("ij,ij->i", side, side)
    at = np.clip(np.einsum("ij,ij->i", apart, side) / np.where(long > 0.0, long, 1.0), 0.0, 1.0)
    return np.asarray(lengths(apart - at[:, None] * side))


def _from_triangles(points: Floats, corners: Floats) -> Floats:
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    square = np.einsum("ij,ij->i", normal, normal)
    inside, nearest = square > 0.0, np.full(len(points), np.inf)
    for i in range(3):
        start, end = corners[:, i], corners[:, (i + 1) % 3]
        nearest = np.minimum(nearest, _from_lines(points, start, end))
        inside &= np.einsum("ij,ij->i", np.cross(end - start, points - start), normal) >= 0.0
    height = np.abs(np.einsum("ij,ij->i", points - corners[:, 0], normal)) / np.sqrt(np.where(inside, square, 1.0))
    return np.where(inside, height, nearest)


def _reach(x: Floats, owners: _Owners, spacing: Floats, elements: _Elements, particles: Ints) -> Floats:
    """How near each particle must be to lie on its element."""
    shortest = spacing[particles]
    reach = np.minimum(NEAR * elements.length, APART * shortest)
    tie = elements.length >= TIE * shortest
    rows, forces = owners.of(particles)
    for corner in elements.corners.T:
        joined = np.zeros(len(particles), bool)
        joined[rows[owners.has(corner[rows], forces)]] = True
        away = NEAR * lengths(x.take(corner, axis=0) - x.take(particles, axis=0))
        reach = np.where(joined, np.minimum(reach, away), reach)
        tie &= joined
    return np.where(tie, 0.0, reach)


def _spacing(forces: list[Force], count: int) -> Floats:
    """The shortest line at each particle, infinite where there is none."""
    shortest = np.full(count, np.inf)
    for force in forces:
        long = force.along > 0.0
        for end in force.lines[long].T:
            np.minimum.at(shortest, end, force.along[long])
    return shortest


@dataclass(frozen=True)
class _Met:
    """Particles of force f that lie on elements of force g: how many of all, whether all were compared, the first one
    with its distance, and the kind of its element."""

    f: int
    g: int
    count: int
    total: int
    all: bool
    first: int
    away: float
    kind: int

    @property
    def share(self) -> float:
        return self.count / self.total

    def sentence(self, forces: list[Force], names: Counter[str]) -> str:
        """What a person reads of it."""
        one, other = (
            force.name if force.name and names[force.name] == 1 else f"/forces/{number}"
            for force, number in ((forces[i].part.force, forces[i].part.number) for i in (self.f, self.g))
        )
        return (
            f"{one}: {'' if self.all else 'at least '}{self.count} of {self.total} particles lie on {WORDS[self.kind]} "
            f"of {other}, within a tenth of their length, but are not joined to it; the first is "
            f"{spot(forces[self.g], self.first, self.away)}. Divide both the same way or raise weld_tolerance"
        )


def spot(force: Force, particle: int, away: float) -> str:
    """A particle, where it is, and how far [length] it is away from an element of a force."""
    system = force.system
    place = ", ".join(f"{c:.6g}" for c in system.x[particle])
    away *= away > ROUNDING * system.size
    return f"particle {particle} at ({place}), {away:.3g} {system.scene.units.length} away"


def _met(owners: _Owners, force: Force, g: int, near: Near) -> Iterator[_Met]:
    """What of each other force lies on force g."""
    kind = force.take(near.rows).kind
    order = np.lexsort((near.distance, kind, near.particles))
    near, kind = near.take(order), kind[order]
    first = np.flatnonzero(np.diff(near.particles, prepend=-1))  # of each particle the nearest
    rows, forces = owners.of(near.particles[first])
    found, at, counts = np.unique(forces, return_index=True, return_counts=True)
    for f, i, count in zip(found.tolist(), first[rows[at]].tolist(), counts.tolist(), strict=True):
        yield _Met(
            f, g, count, int(owners.totals[f]), near.all, int(near.particles[i]), float(near.distance[i]), int(kind[i])
        )
