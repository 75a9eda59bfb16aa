"""Closest points of meshes, and points carried from one mesh to another of the same faces."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hookean.discretize.duplicates import _checked
from hookean.discretize.meshes import as_mesh, triangles
from hookean.errors import InputError

Array = NDArray[np.float64]
Index = NDArray[np.int64]

_FARTHEST = 1e150  # squares of larger lengths overflow
_BLOCK = 2048  # points compared in one go, which bounds the memory


def mesh_map(points: ArrayLike, source: Any, target: Any, distance: float = 1.0) -> Array:
    """Points `(n, 3)` near a mesh `source`, carried to the mesh `target` with the same faces; length units.

    A point belongs to the closest triangle of the source. Its image has the same barycentric coordinates in the plane
    of that triangle of the target, and the same height over it times `distance`; heights are positive on the side
    where the corners run counter-clockwise. A rigid motion of the mesh moves points exactly as it moves the mesh.
    Quads are cut as the shorter diagonals of the source are. Raises InputError where the meshes have
    different faces, a triangle that is needed has no area, or a number is not finite.
    """
    p = _checked("points", points, (3,))
    if not np.isfinite(distance):
        raise InputError("distance", f"it is {distance!r}; give a finite number")
    a, b = as_mesh(source), as_mesh(target)
    if len(a.vertices) != len(b.vertices) or not np.array_equal(a.faces, b.faces):
        raise InputError(
            "target", "its faces are not those of the source; give a mesh with the same vertices and faces, moved"
        )
    t = triangles(a)
    if not len(t):
        raise InputError("source", "it has no faces; give a mesh with faces")
    if np.abs(p).max(initial=0.0) > _FARTHEST or np.abs(a.vertices).max() > _FARTHEST:
        raise InputError("points", f"coordinates are beyond {_FARTHEST:g}; use larger units")
    near = t[Closest(a.vertices, t)(p)[0]]
    origin, u, v, n = _frames(a.vertices, near, "source")
    apart = p - origin
    area = np.linalg.norm(np.cross(u, v), axis=1)
    one, two = ((np.cross(*pair) * n).sum(axis=1) / area for pair in ((apart, v), (u, apart)))
    one, two = one[:, None], two[:, None]
    height = (apart * n).sum(axis=1)[:, None]
    there, u, v, n = _frames(b.vertices, near, "target")
    out: Array = there + one * u + two * v + distance * height * n
    return out


def _frames(vertices: Array, near: Index, name: str) -> tuple[Array, Array, Array, Array]:
    a, b, c = vertices[near].transpose(1, 0, 2)
    u, v = b - a, c - a
    n = np.cross(u, v)
    size = np.linalg.norm(n, axis=1)
    flat = np.flatnonzero(~(size > 1e-14 * ((u * u).sum(axis=1) + (v * v).sum(axis=1))))
    if len(flat):
        raise InputError(name, f"its triangle {near[flat[0]].tolist()} has no area; weld the mesh first")
    return a, u, v, n / size[:, None]


class Closest:
    """Closest points of triangles, exactly: those by whose centroids a point may be are all compared.

    Triangles are sorted by their size into classes of a factor of two, each with a tree of centroids c; a triangle
    of radius r about c is at least |p - c| - r away, which ends the search of its class. Segments are triangles
    `(a, b, b)`.
    """

    def __init__(self, vertices: Array, faces: Index) -> None:
        from scipy.spatial import cKDTree

        self.corners = vertices[faces]
        centres = self.corners.mean(axis=1)
        radius = np.linalg.norm(self.corners - centres[:, None], axis=2).max(axis=1)
        size = np.frexp(radius)[1]
        self.classes: list[tuple[Any, Index, float]] = []
        for one in np.unique(size)[::-1].tolist():
            members = np.flatnonzero(size == one)
            self.classes.append((cKDTree(centres[members]), members, float(radius[members].max())))

    def __call__(self, points: Array) -> tuple[Index, Array]:
        """Of each point the closest triangle, the first of equals, and the closest point on it."""
        parts = [self._search(points[i : i + _BLOCK]) for i in range(0, len(points), _BLOCK)]
        parts = parts or [(np.zeros(0, np.int64), np.zeros((0, 3)))]
        return np.concatenate([one for one, _ in parts]), np.concatenate([at for _, at in parts])

    def _search(self, points: Array) -> tuple[Index, Array]:
        best, found = np.full(len(points), np.inf), np.zeros(len(points), np.int64)
        where = points.copy()
        for tree, members, radius in self.classes:
            open_, k = np.arange(len(points)), 4
            while len(open_):
                k = min(k, len(members))
                far, near = tree.query(points[open_], k=np.arange(1, k + 1))
                faces = members[near]
                at = closest_on_triangles(points[open_, None], self.corners[faces])
                apart = np.linalg.norm(at - points[open_, None], axis=2)
                least = apart.min(axis=1, keepdims=True)
                pick = np.where(apart == least, faces, np.iinfo(np.int64).max).argmin(axis=1)
                row = np.arange(len(open_))
                better = (least[:, 0] < best[open_]) | (
                    (least[:, 0] == best[open_]) & (faces[row, pick] < found[open_])
                )
                best[open_[better]], found[open_[better]] = least[better, 0], faces[row, pick][better]
                where[open_[better]] = at[row, pick][better]
                open_ = open_[(far[:, -1] - radius <= best[open_]) & (k < len(members))]
                k *= 4
        return found, where


def closest_on_triangles(p: Array, corners: Array) -> Array:
    """Closest points `(..., 3)` of triangles `(..., 3, 3)` to points `(..., 3)`; those without area are segments."""
    a, b, c = corners[..., 0, :], corners[..., 1, :], corners[..., 2, :]
    best = on_segments(p, a, b)
    least = ((best - p) ** 2).sum(axis=-1)
    for start, end in ((b, c), (c, a)):
        other = on_segments(p, start, end)
        apart = ((other - p) ** 2).sum(axis=-1)
        best = np.where((apart < least)[..., None], other, best)
        least = np.minimum(apart, least)
    n = np.cross(b - a, c - a)
    nn = (n * n).sum(axis=-1)
    inside = nn > 0.0
    for start, end in ((a, b), (b, c), (c, a)):
        inside &= (np.cross(end - start, p - start) * n).sum(axis=-1) >= 0.0
    height = ((p - a) * n).sum(axis=-1) / np.where(nn > 0.0, nn, 1.0)
    return np.where(inside[..., None], p - height[..., None] * n, best)


def on_segments(p: Array, a: Array, b: Array) -> Array:
    """Closest points of segments a-b to points p."""
    e = b - a
    ee = (e * e).sum(axis=-1)
    t = np.clip(((p - a) * e).sum(axis=-1) / np.where(ee > 0.0, ee, 1.0), 0.0, 1.0)
    out: Array = a + t[..., None] * e
    return out
