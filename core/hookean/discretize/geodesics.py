"""Geodesics on meshes: shortest paths from vertex to vertex across triangles, straight where they are unfolded.

A sequence of triangles from start to end is unfolded into the plane, where the shortest path in it is pulled taut (the
funnel algorithm). Where it bends about a vertex, the triangles on the other side of that vertex are tried instead, as
long as that makes it shorter.
Sources: Lee and Preparata, Euclidean shortest paths in the presence of rectilinear barriers, 1984 (funnel); Xin and
Wang, Efficiently determining a locally exact shortest path on polyhedral surfaces, 2007.
"""

from __future__ import annotations

import heapq
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.discretize.flatten import oriented
from hookean.discretize.meshes import as_mesh
from hookean.discretize.meshes import triangles as split
from hookean.errors import InputError
from hookean.values.mesh import Mesh

Array = NDArray[np.float64]
Index = NDArray[np.int64]
Edge = tuple[int, int]

SHORTER = 1e-12  # part of the length that a change has to save
NEAR = 1e-6  # of an edge: a crossing so near its end is at the end
ROUNDS = 10_000


@dataclass(frozen=True)
class Crossing:
    """A point of a path: on the edge between two vertices (a, b), at the part t of the way; on vertex a if a == b."""

    a: int
    b: int
    t: float


@dataclass(frozen=True, eq=False)
class Path:
    """A geodesic: its `crossings` from vertex to vertex, `points` (k, 3) and `length` [length]."""

    crossings: tuple[Crossing, ...]
    points: Array
    length: float


def geodesic(mesh: Any, start: int, end: int) -> Path:
    """The locally shortest path on a mesh between two of its vertices; quads count as two triangles.

    Raises InputError for vertices that do not exist, are the same, or are not connected, and where the path crosses a
    triangle with two corners at one place.
    """
    m = as_mesh(mesh)
    faces = oriented(np.column_stack([split(m), split(m)[:, 2]]))[:, :3]
    return _Surface(m.vertices, faces).path(start, end)


def cut_along(mesh: Any, pairs: Any) -> tuple[Mesh, Index]:
    """A mesh of triangles that has the geodesics between pairs of vertices (k, 2) as edges, and the piece (m,) of each
    face that they cut it into. The vertices of the mesh keep their numbers; those of crossings come after them.

    Raises InputError as `geodesic`.
    """
    m = as_mesh(mesh)
    vertices = np.array(m.vertices)
    faces = oriented(np.column_stack([split(m), split(m)[:, 2]]))[:, :3]
    seams: set[Edge] = set()
    for start, end in np.asarray(pairs, dtype=np.int64).reshape(-1, 2).tolist():
        path = _Surface(vertices, faces).path(start, end)
        vertices, faces, seams = _inserted(vertices, faces, path, seams)
    return Mesh(vertices, np.column_stack([faces, faces[:, 2]])), _pieces(faces, seams)


class _Surface:
    """Triangles that all run the same way round, and their neighbours."""

    def __init__(self, vertices: Array, faces: Index) -> None:
        self.x, self.faces = vertices, faces.tolist()
        self.owner: dict[Edge, int] = {}
        self.at: dict[int, list[int]] = {}
        for number, (a, b, c) in enumerate(self.faces):
            self.owner[a, b] = self.owner[b, c] = self.owner[c, a] = number
            for v in (a, b, c):
                self.at.setdefault(v, []).append(number)

    def path(self, start: int, end: int) -> Path:
        """The locally shortest path between two vertices."""
        for vertex in (start, end):
            if vertex not in self.at:
                raise InputError("seams", f"vertex {vertex} is on no face; there are {len(self.x)}, counted from 0")
        if start == end:
            raise InputError("seams", f"a seam from vertex {start} to itself has no length; give two vertices")
        if (start, end) in self.owner or (end, start) in self.owner:
            return self._made([Crossing(start, start, 0.0), Crossing(end, end, 0.0)])
        sleeve = self._trimmed(self._first(start, end), start, end)
        best, bends = self._pulled(sleeve, start, end)
        for _ in range(ROUNDS):
            for first, last, vertex in bends:
                other = self._around(sleeve, first, last, vertex)
                if other is None:
                    continue
                tried = self._trimmed(other, start, end)
                found, turned = self._pulled(tried, start, end)
                if found.length < best.length * (1.0 - SHORTER):
                    sleeve, best, bends = tried, found, turned
                    break
            else:
                return best
        return best

    def _first(self, start: int, end: int) -> list[int]:
        """Triangles from start to end, the shortest way over their middles."""
        middle = self.x[np.asarray(self.faces)].mean(axis=1)
        done: dict[int, int] = {}
        queue = [(float(np.linalg.norm(middle[f] - self.x[start])), f, -1) for f in self.at[start]]
        heapq.heapify(queue)
        while queue:
            far, face, before = heapq.heappop(queue)
            if face in done:
                continue
            done[face] = before
            if end in self.faces[face]:
                sleeve = [face]
                while done[sleeve[-1]] >= 0:
                    sleeve.append(done[sleeve[-1]])
                return sleeve[::-1]
            for near in self._beside(face):
                if near not in done:
                    heapq.heappush(queue, (far + float(np.linalg.norm(middle[near] - middle[face])), near, face))
        raise InputError("seams", f"vertices {start} and {end} are on parts of the mesh that are not connected")

    def _beside(self, face: int) -> list[int]:
        a, b, c = self.faces[face]
        return [self.owner[s] for s in ((b, a), (c, b), (a, c)) if s in self.owner]

    def _trimmed(self, sleeve: list[int], start: int, end: int) -> list[int]:
        """Without ways back, from the last triangle at the start to the first one at the end."""
        short: list[int] = []
        for face in sleeve:
            if face in short:
                short = short[: short.index(face)]
            short.append(face)
        first = max(i for i, face in enumerate(short) if start in self.faces[face])
        short = short[first:]
        last = min(i for i, face in enumerate(short) if end in self.faces[face])
        return short[: last + 1]

    def _around(self, sleeve: list[int], first: int, last: int, vertex: int) -> list[int] | None:
        """The sleeve on the other side of a vertex that its triangles `first` to `last` are at; None at a boundary."""
        face, goal = sleeve[first], sleeve[last]
        inner = set(sleeve[first + 1 : last])
        for forward in (True, False):
            fan, now = [face], face
            while now != goal:
                following = self._turn(now, vertex, forward)
                if following is None or following == face:
                    break
                fan.append(following)
                now = following
            if now == goal and (len(fan) == 2 or not inner & set(fan)) and fan != sleeve[first : last + 1]:
                return [*sleeve[:first], *fan, *sleeve[last + 1 :]]
        return None

    def _turn(self, face: int, vertex: int, forward: bool) -> int | None:
        """The next triangle about a vertex."""
        corners = self.faces[face]
        i = corners.index(vertex)
        before, after = corners[i - 1], corners[(i + 1) % 3]
        return self.owner.get((vertex, before) if forward else (after, vertex))

    def _pulled(self, sleeve: list[int], start: int, end: int) -> tuple[Path, list[tuple[int, int, int]]]:
        """The shortest path in a sleeve, and where it bends: the first and last triangle at the vertex, and that."""
        doors = [self._door(a, b) for a, b in pairwise(sleeve)]
        flat = self._unfolded(sleeve, doors, start, end)
        corners = _funnel(flat)
        crossings, bends = [Crossing(start, start, 0.0)], list[tuple[int, int, int]]()
        for (at, here), (then, there) in pairwise(corners):
            for door in range(at + 1, then):
                left, right = flat[door]
                crossings.append(_crossing(doors[door - 1], left, right, here, there))
            if then <= len(doors):
                vertex = doors[then - 1][0 if (flat[then][0] == there).all() else 1]
                crossings.append(Crossing(vertex, vertex, 0.0))
                mine = [i for i, face in enumerate(sleeve) if vertex in self.faces[face]]
                bends.append((mine[0], mine[-1], vertex))
        crossings.append(Crossing(end, end, 0.0))
        return self._made(_each_once(crossings)), bends

    def _door(self, a: int, b: int) -> Edge:
        """The side between two triangles, as (left, right) on the way from a to b."""
        for i in range(3):
            u, v = self.faces[a][i], self.faces[a][(i + 1) % 3]
            if self.owner.get((v, u)) == b:
                return v, u
        raise InputError("seams", f"faces {a} and {b} do not share a side")

    def _unfolded(self, sleeve: list[int], doors: list[Edge], start: int, end: int) -> list[tuple[Array, Array]]:
        """Start, doors and end of a sleeve in the plane, each as (left, right)."""
        here = np.zeros(2)
        first = doors[0] if doors else None
        if first is None:
            far = np.array([self._far(start, end), 0.0])
            return [(here, here), (far, far)]
        left, right = self._placed(start, first)
        places = [(here, here), (left, right)]
        for door, following in zip(doors, [*doors[1:], None], strict=True):
            new = end if following is None else next(v for v in following if v not in door)
            point = self._third(door, left, right, new)
            if following is None:
                places.append((point, point))
                break
            left = point if following[0] == new else left
            right = point if following[1] == new else right
            places.append((left, right))
        return places

    def _far(self, a: int, b: int) -> float:
        size = float(np.linalg.norm(self.x[b] - self.x[a]))
        if size == 0.0:
            said = f"vertices {a} and {b} of a triangle that a seam crosses are at one place"
            raise InputError("mesh", f"{said}; weld the mesh first")
        return size

    def _placed(self, start: int, door: Edge) -> tuple[Array, Array]:
        """The first door seen from a start at 0, its right end along x."""
        along = self._far(start, door[1])
        to_left = self._far(start, door[0])
        cosine = (along**2 + to_left**2 - self._far(*door) ** 2) / (2.0 * along * to_left)
        angle = np.arccos(np.clip(cosine, -1.0, 1.0))
        return to_left * np.array([np.cos(angle), np.sin(angle)]), np.array([along, 0.0])

    def _third(self, door: Edge, left: Array, right: Array, new: int) -> Array:
        """Where a vertex lies beyond a door."""
        a, b, c = self.x[door[0]], self.x[door[1]], self.x[new]
        size = self._far(*door)
        along, across = float((c - a) @ (b - a) / size), float(np.linalg.norm(np.cross(b - a, c - a)) / size)
        way = (right - left) / np.linalg.norm(right - left)
        return np.asarray(left + along * way + across * np.array([-way[1], way[0]]))

    def _made(self, crossings: list[Crossing]) -> Path:
        points = np.array([self.x[c.a] + c.t * (self.x[c.b] - self.x[c.a]) for c in crossings])
        return Path(tuple(crossings), points, float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum()))


def _funnel(doors: list[tuple[Array, Array]]) -> list[tuple[int, Array]]:
    """Corners of the shortest path through doors (left, right): the number of the door of each, and where it is."""
    corners = [(0, doors[0][0])]
    apex, left, right = doors[0][0], doors[0][0], doors[0][1]
    at_left = at_right = 0
    i = 1
    while i < len(doors):
        new_left, new_right = doors[i]
        if _turn(apex, right, new_right) >= 0.0:
            if (apex == right).all() or _turn(apex, left, new_right) < 0.0:
                right, at_right = new_right, i
            else:
                corners.append((at_left, left))
                apex, right, at_right, i = left, left, at_left, at_left + 1
                continue
        if _turn(apex, left, new_left) <= 0.0:
            if (apex == left).all() or _turn(apex, right, new_left) > 0.0:
                left, at_left = new_left, i
            else:
                corners.append((at_right, right))
                apex, left, at_left, i = right, right, at_right, at_right + 1
                continue
        i += 1
    corners.append((len(doors) - 1, doors[-1][0]))
    return corners


def _turn(a: Array, b: Array, c: Array) -> float:
    """Twice the area of a triangle in the plane: above 0 where c lies left of a-b."""
    return float((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))


def _crossing(door: Edge, left: Array, right: Array, here: Array, there: Array) -> Crossing:
    """Where a straight line goes through a door; at an end of it if it comes near."""
    from_left, from_right = _turn(here, there, left), _turn(here, there, right)
    t = from_left / (from_left - from_right) if from_left != from_right else 0.5
    if t < NEAR:
        return Crossing(door[0], door[0], 0.0)
    if t > 1.0 - NEAR:
        return Crossing(door[1], door[1], 0.0)
    return Crossing(door[0], door[1], t)


def _each_once(crossings: list[Crossing]) -> list[Crossing]:
    """Without a vertex that comes twice in a row."""
    return [c for i, c in enumerate(crossings) if not (i and c.a == c.b and c == crossings[i - 1])]


def _inserted(vertices: Array, faces: Index, path: Path, seams: set[Edge]) -> tuple[Array, Index, set[Edge]]:
    """Triangles split along a path, and the seams with its sides and with those it splits, as sorted pairs."""
    new: dict[Edge, int] = {}
    line, points = list[int](), vertices.tolist()
    for crossing, point in zip(path.crossings, path.points.tolist(), strict=True):
        if crossing.a == crossing.b:
            line.append(crossing.a)
            continue
        new[_sorted(crossing.a, crossing.b)] = len(points)
        line.append(len(points))
        points.append(point)
    steps = {_sorted(a, b) for a, b in pairwise(line)}
    made = [piece for face in faces.tolist() for piece in _split(face, new)]
    kept: set[Edge] = set()
    for a, b in seams:
        if (a, b) in new:
            kept |= {_sorted(a, new[a, b]), _sorted(new[a, b], b)}
        else:
            kept.add((a, b))
    return np.array(points), np.array(made, dtype=np.int64), kept | steps


def _split(face: list[int], new: dict[Edge, int]) -> list[list[int]]:
    """A triangle split by the path through it."""
    for i in range(3):
        a, b, c = face[i], face[(i + 1) % 3], face[(i + 2) % 3]
        p, q, r = (new.get(_sorted(*side)) for side in ((a, b), (b, c), (c, a)))
        if p is not None and q is not None and r is None:
            return [[p, b, q], [a, p, q], [a, q, c]]
        if q is not None and p is None and r is None:
            return [[a, b, q], [a, q, c]]
        if p is not None and q is not None and r is not None:
            return [[p, b, q], [q, c, r], [r, a, p], [p, q, r]]
    return [face]


def _sorted(a: int, b: int) -> Edge:
    return (a, b) if a < b else (b, a)


def _pieces(faces: Index, seams: set[Edge]) -> Index:
    """The piece (m,) of each triangle, between seams, numbered in order of appearance."""
    sides: dict[Edge, list[int]] = {}
    for number, (a, b, c) in enumerate(faces.tolist()):
        for side in ((a, b), (b, c), (c, a)):
            sides.setdefault(_sorted(*side), []).append(number)
    beside: list[list[int]] = [[] for _ in range(len(faces))]
    for side, near in sides.items():
        if side not in seams and len(near) == 2:
            beside[near[0]].append(near[1])
            beside[near[1]].append(near[0])
    piece: Index = np.full(len(faces), -1, dtype=np.int64)
    count = 0
    for seed in range(len(faces)):
        if piece[seed] >= 0:
            continue
        waiting = [seed]
        piece[seed] = count
        while waiting:
            for other in beside[waiting.pop()]:
                if piece[other] < 0:
                    piece[other] = count
                    waiting.append(other)
        count += 1
    return piece
