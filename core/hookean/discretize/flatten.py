"""Flattening: a piece of a mesh laid into the plane with the least distortion.

First triangle after triangle is turned into the plane, which is exact where the piece is developable. Then local and
global steps take the sum of squared differences from rigid motions of all triangles, weighted by cotangents, to its
minimum (as rigid as possible). Quads count by both of their diagonals, each with half of the weight.
Source: Liu, Zhang, Xu, Gotsman and Gortler, A local/global approach to mesh parameterization, 2008.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from math import dist, hypot
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hookean.discretize.meshes import as_mesh
from hookean.errors import InputError

Array = NDArray[np.float64]
Index = NDArray[np.int64]
Row = list[float]
Spot = tuple[float, float]

SYMMETRIC = {"permc_spec": "MMD_AT_PLUS_A", "diag_pivot_thresh": 0.001, "options": {"SymmetricMode": True}}
STEPS = 20  # local and global
ROUNDS = 50  # of Newton's method
STILL = 1e-12  # of the size of the piece: a step that moves less is the last one
SMALL = 1e-7  # likewise: a step so small is right, whatever rounding makes of the energy


@dataclass(frozen=True, eq=False)
class Flat:
    """A piece in the plane: `points` (n, 2) [length] of its vertices; `stretches` (t, 2) [-], of each triangle the
    largest and the smallest ratio of lengths in the plane to those in space; `areas` (t,) [length^2] of the triangles,
    those of quads with half of their area."""

    points: Array
    stretches: Array
    areas: Array

    @property
    def distortion(self) -> float:
        """The largest difference of a stretch from 1 [-]."""
        return float(np.abs(self.stretches - 1.0).max(initial=0.0))

    @property
    def mean_distortion(self) -> float:
        """The mean difference of the stretches from 1, weighted by area [-]."""
        total = float(self.areas.sum())
        return float((np.abs(self.stretches - 1.0).mean(axis=1) * self.areas).sum() / total) if total else 0.0


def flatten(mesh: Any) -> Flat:
    """Lay a piece of a mesh into the plane with the least distortion; developable pieces exactly.

    The piece must be a disc: connected, with one boundary. Raises InputError where it is not, or a face has no area.
    """
    m = as_mesh(mesh)
    faces = oriented(m.faces)
    _check_disc(m.vertices, faces)
    quad = faces[:, 2] != faces[:, 3]
    first = np.concatenate([faces[:, [0, 1, 2]], faces[quad][:, [0, 2, 3]]])
    other = np.concatenate([faces[quad][:, [0, 1, 3]], faces[quad][:, [1, 2, 3]]])
    every = np.concatenate([first, other])
    weights = np.concatenate([np.where(quad, 0.5, 1.0), np.full(len(every) - len(faces), 0.5)])
    local = _local(m.vertices, every)
    points = _unfolded(m.vertices, first)
    points = _rigid(points, every, local, weights)
    stretches, areas = _stretches(points, every, local)
    return Flat(points, stretches, areas * weights)


def oriented(faces: Index) -> Index:
    """Faces (m, 4) that all run the same way round as the first one of their part; InputError where they cannot."""
    faces = faces.copy()
    if len(np.unique(keys := _keys(directed(faces)))) == len(keys):
        return faces  # no two run along a side in the same direction
    sides: dict[tuple[int, int], list[int]] = {}
    for number, face in enumerate(faces.tolist()):
        for a, b in _sides(face):
            sides.setdefault((min(a, b), max(a, b)), []).append(number)
    seen = np.zeros(len(faces), bool)
    for seed in range(len(faces)):
        if seen[seed]:
            continue
        seen[seed] = True
        queue = deque([seed])
        while queue:
            number = queue.popleft()
            for a, b in _sides(faces[number].tolist()):
                for near in sides[min(a, b), max(a, b)]:
                    same = near != number and (a, b) in _sides(faces[near].tolist())
                    if same and seen[near]:
                        raise InputError(f"mesh/faces/{near}", "the piece is one-sided; cut it")
                    if near != number and not seen[near]:
                        seen[near] = True
                        faces[near] = faces[near][[2, 1, 0, 0]] if same and _three(faces[near]) else faces[near]
                        faces[near] = faces[near][::-1] if same and not _three(faces[near]) else faces[near]
                        queue.append(near)
    return faces


def outline(faces: Index) -> Index:
    """The vertices (k,) around a piece of faces (m, 4) that run one way round; InputError unless it has one
    boundary."""
    sides = directed(faces)
    _, first = np.unique(keys := _keys(sides), return_index=True)
    sides = sides[first]  # by their vertices
    rim = sides[~np.isin(_keys(sides[:, ::-1], sides), keys)]
    if (twice := rim[1:, 0] == rim[:-1, 0]).any():
        touched = int(rim[1:, 0][twice][0])
        raise InputError("mesh/faces", f"the boundary touches itself at vertex {touched}; cut the piece there")
    after = dict(rim.tolist())
    if not after:
        raise InputError("mesh/faces", "the piece is closed; cut it open")
    loop = [min(after)]
    while (following := after[loop[-1]]) != loop[0]:
        loop.append(following)
    if len(loop) != len(after):
        raise InputError("mesh/faces", "the piece has several boundaries; cut it from one to the other")
    return np.array(loop)


def directed(faces: Index) -> Index:
    """The sides (k, 2) of faces (m, 4), each in the direction in which its face runs."""
    sides = np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2)
    return np.asarray(sides[sides[:, 0] != sides[:, 1]])


def _keys(sides: Index, of: Index | None = None) -> Index:
    """A number for each pair of vertices, in their order; of the same vertices as the sides `of`."""
    size = int((sides if of is None else of).max(initial=0)) + 1
    return np.asarray(sides[:, 0] * size + sides[:, 1])


def _three(face: Any) -> bool:
    return bool(face[2] == face[3])


def _sides(face: list[int]) -> list[tuple[int, int]]:
    corners = face[:3] if face[2] == face[3] else face
    return list(zip(corners, [*corners[1:], corners[0]], strict=True))


def _check_disc(vertices: Array, faces: Index) -> None:
    """One part, one boundary, and no hole through it: V - E + F = 1."""
    if not len(faces):
        raise InputError("mesh/faces", "the piece has no faces")
    outline(faces)
    edges = np.unique(_keys(np.sort(directed(faces), axis=1)))
    used = len(np.unique(faces))
    if used != len(vertices):
        raise InputError("mesh/vertices", f"{len(vertices) - used} vertices belong to no face; remove them")
    if used - len(edges) + len(faces) != 1:
        raise InputError("mesh/faces", "the piece is not a disc; cut it so that it is connected and without handles")


def _local(vertices: Array, triangles: Index) -> Array:
    """Corners (t, 3, 2) of triangles in planes of their own."""
    a, b, c = (vertices[triangles[:, i]] for i in range(3))
    along = np.linalg.norm(b - a, axis=1)
    height = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    if (height <= 1e-14 * np.maximum(along, 1e-300) * np.linalg.norm(c - a, axis=1)).any():
        spot = triangles[int(np.argmin(height))]
        raise InputError("mesh/faces", f"the face at vertices {', '.join(map(str, spot))} has no area; remove it")
    x = ((b - a) * (c - a)).sum(axis=1) / along
    local = np.zeros((len(triangles), 3, 2))
    local[:, 1, 0] = along
    local[:, 2] = np.stack([x, height / along], axis=1)
    return local


def _unfolded(vertices: Array, triangles: Index) -> Array:
    """Each triangle turned into the plane of the one before it, breadth first; a vertex lies where it comes first."""
    across = _across(triangles).tolist()
    corners, rows = vertices.tolist(), triangles.tolist()  # single numbers are many times quicker in lists
    a, b, _ = rows[0]
    points = {a: (0.0, 0.0), b: (dist(corners[a], corners[b]), 0.0)}
    queue, seen = deque([0]), [True] + [False] * (len(rows) - 1)
    while queue:
        number = queue.popleft()
        i, j, k = rows[number]
        for a, b, c in ((i, j, k), (j, k, i), (k, i, j)):
            if c not in points and a in points and b in points:
                points[c] = _third(corners[a], corners[b], corners[c], points[a], points[b])
        for near in across[number]:
            if near >= 0 and not seen[near]:
                seen[near] = True
                queue.append(near)
    return np.array([points[i] for i in range(len(corners))])


def _across(triangles: Index) -> Index:
    """The triangle (m, 3) across each side of triangles that run one way round; -1 for none."""
    sides = np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=2).reshape(-1, 2)
    own, back = _keys(sides), _keys(sides[:, ::-1])
    order = np.argsort(own)
    place = np.minimum(np.searchsorted(own, back, sorter=order), len(own) - 1)
    found = order[place]
    return np.where(own[found] == back, found // 3, -1).reshape(-1, 3)


def _third(a: Row, b: Row, c: Row, start: Spot, end: Spot) -> Spot:
    """Where the corner c of a triangle lies, left of a-b, which lies from `start` to `end` in the plane."""
    ux, uy, uz = b[0] - a[0], b[1] - a[1], b[2] - a[2]
    vx, vy, vz = c[0] - a[0], c[1] - a[1], c[2] - a[2]
    size = hypot(ux, uy, uz)
    x = (ux * vx + uy * vy + uz * vz) / size
    y = hypot(uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx) / size
    far = dist(start, end)
    along, across = (end[0] - start[0]) / far, (end[1] - start[1]) / far
    return start[0] + x * along - y * across, start[1] + x * across + y * along


def _rigid(points: Array, triangles: Index, local: Array, weights: Array) -> Array:
    """The least sum of squared differences from rigid motions, from a start in the plane: a few local and global steps,
    then Newton's method with the exact second derivatives, which is quadratic."""
    energy = _Energy(triangles, local, weights, len(points))
    size = float(np.ptp(points, axis=0).max())
    for _ in range(STEPS):
        moved = energy.step(points)
        far = float(np.abs(moved - points).max())
        points = moved
        if far <= STILL * size:
            return points
    for _ in range(ROUNDS):
        step = energy.newton(points)
        far = float(np.abs(step).max(initial=0.0)) / size
        if not np.isfinite(far):
            return points
        length, before = 1.0, energy.value(points)
        while far > SMALL and energy.value(points + length * step) > before and length > 1e-6:
            length *= 0.5
        points = energy.step(points) if length <= 1e-6 else points + length * step
        if far <= STILL:
            return points
    return points


class _Energy:
    """E = sum of c |q - R p|^2 over the sides p of all triangles in space and q in the plane, c half the cotangent of
    the corner across, R the rotation of each triangle that makes it least: sum of c (|p|^2 + |q|^2) - 2 |(A, B)| with
    A = sum of c p.q and B = sum of c p x q, which are linear in the points."""

    def __init__(self, triangles: Index, local: Array, weights: Array, count: int) -> None:
        import scipy.sparse as sparse
        from scipy.sparse.linalg import splu

        self.triangles, self.after, self.count = triangles, triangles[:, [1, 2, 0]], count
        self.sides = local[:, [1, 2, 0]] - local
        out, back = local - local[:, [2, 0, 1]], local[:, [1, 2, 0]] - local[:, [2, 0, 1]]
        turn = np.abs(out[..., 0] * back[..., 1] - out[..., 1] * back[..., 0])
        self.cotangent = (out * back).sum(axis=2) / turn * weights[:, None]
        row, column, value = triangles.ravel(), self.after.ravel(), self.cotangent.ravel()
        places = np.concatenate([row, column, row, column]), np.concatenate([column, row, row, column])
        values = np.concatenate([-value, -value, value, value])
        self.laplacian = sparse.csc_matrix((values, places), shape=(count, count))
        self.factor = splu(self.laplacian[1:, 1:].tocsc(), **SYMMETRIC)
        self.twice = 2.0 * sparse.kron(self.laplacian, sparse.identity(2), format="csc")
        index = (2 * triangles[:, :, None] + np.arange(2)).reshape(len(triangles), 6)
        self.places = np.repeat(index, 6, axis=1).ravel(), np.tile(index, (1, 6)).ravel()
        self.pull = self.cotangent[..., None] * self.sides  # of each side, in the axes of its triangle

    def _turns(self, points: Array) -> tuple[Array, Array, Array]:
        """A and B of each triangle, and the sides in the plane."""
        now = points[self.after] - points[self.triangles]
        along = (self.pull * now).sum(axis=(1, 2))
        across = (self.pull[..., 0] * now[..., 1] - self.pull[..., 1] * now[..., 0]).sum(axis=1)
        return along, across, now

    def value(self, points: Array) -> float:
        """The part of the energy that changes."""
        along, across, now = self._turns(points)
        return float((self.cotangent * (now**2).sum(axis=2)).sum() - 2.0 * np.hypot(along, across).sum())

    def _wanted(self, along: Array, across: Array) -> Array:
        """What the turned sides pull each point by (n, 2)."""
        size = np.hypot(along, across)
        cosine, sine = (along / size)[:, None], (across / size)[:, None]
        x = (cosine * self.pull[..., 0] - sine * self.pull[..., 1]).ravel()
        y = (sine * self.pull[..., 0] + cosine * self.pull[..., 1]).ravel()
        row, column, n = self.triangles.ravel(), self.after.ravel(), self.count
        return np.stack([np.bincount(column, v, n) - np.bincount(row, v, n) for v in (x, y)], axis=1)

    def step(self, points: Array) -> Array:
        """One local and one global step."""
        along, across, _ = self._turns(points)
        left = self._wanted(along, across) - self.laplacian[:, [0]].toarray() * points[0]
        found = points.copy()
        found[1:] = self.factor.solve(left[1:])
        return found

    def newton(self, points: Array) -> Array:
        """A Newton step (n, 2); the first point stays, and the turn about it is left out."""
        import scipy.sparse as sparse
        from scipy.sparse.linalg import splu

        along, across, _ = self._turns(points)
        slope = 2.0 * (self.laplacian @ points - self._wanted(along, across))
        size = np.hypot(along, across)
        # by each side of a triangle, and both axes: how A and B change with it, and what is across (A, B)
        first, second = self.pull, np.stack([-self.pull[..., 1], self.pull[..., 0]], axis=2)
        normal = (along[:, None, None] * second - across[:, None, None] * first) / size[:, None, None]
        corner = np.zeros((len(normal), 3, 2))
        corner[:, [1, 2, 0]] += normal
        corner -= normal
        flat = corner.reshape(len(corner), 6)
        blocks = -2.0 * flat[:, :, None] * flat[:, None, :] / size[:, None, None]
        total = 2 * self.count
        matrix = sparse.coo_matrix((blocks.ravel(), self.places), shape=(total, total)).tocsc() + self.twice
        off = np.abs(points - points[0])
        far, axis = np.unravel_index(int(np.argmax(off)), off.shape)
        free = np.setdiff1d(np.arange(total), [0, 1, 2 * far + 1 - axis])
        step = np.zeros(total)
        try:
            step[free] = splu(matrix[free][:, free].tocsc(), **SYMMETRIC).solve(-slope.ravel()[free])
        except RuntimeError:  # singular
            return np.full((self.count, 2), np.nan)
        return step.reshape(-1, 2)


def _stretches(points: Array, triangles: Index, local: Array) -> tuple[Array, Array]:
    """Singular values (t, 2) of the maps from space to plane, the larger first, and areas (t,) in space."""
    before = np.stack([local[:, 1] - local[:, 0], local[:, 2] - local[:, 0]], axis=2)
    now = points[triangles]
    after = np.stack([now[:, 1] - now[:, 0], now[:, 2] - now[:, 0]], axis=2)
    maps = after @ np.linalg.inv(before)
    return np.asarray(np.linalg.svd(maps, compute_uv=False)), np.asarray(0.5 * np.linalg.det(before))


def turned_along(points: ArrayLike, direction: ArrayLike) -> Array:
    """Points (n, 2) turned so that a direction (2,) lies along x, the lowest of each axis at 0."""
    way = np.asarray(direction, dtype=float)
    way = way / np.linalg.norm(way)
    turned = np.asarray(points, dtype=float) @ np.array([[way[0], -way[1]], [way[1], way[0]]])
    return np.asarray(turned - turned.min(axis=0))
