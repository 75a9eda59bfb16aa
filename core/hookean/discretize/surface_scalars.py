"""Numbers at the vertices of a mesh that describe its surface: slope, mean and Gaussian curvature."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.discretize.adjacency import vertex_normals
from hookean.discretize.meshes import as_mesh, boundary

Array = NDArray[np.float64]
Index = NDArray[np.int64]


def slope(mesh: Any) -> Array:
    """Slope `(n,)` of the surface at the vertices of a mesh [degrees]: 0 where it is level, 90 where it is upright.

    It is the angle of the vertex normal (the sum of the vector areas of the faces around) to the z axis, whichever side
    the normal is on; nan at vertices without faces and where the vector areas cancel. On a smooth surface the error
    falls at least in proportion to the size of the faces, exact where all faces around lie in one plane.
    """
    x, y, z = vertex_normals(as_mesh(mesh)).T
    found: Array = np.degrees(np.arctan2(np.hypot(x, y), np.abs(z)))
    found[(x == 0.0) & (y == 0.0) & (z == 0.0)] = np.nan
    return found


def curvature(mesh: Any) -> tuple[Array, Array]:
    """Mean and Gaussian curvature `(n,)` at the vertices of a mesh [1/length, 1/length^2].

    Mean curvature H = (1/r1 + 1/r2) / 2 is positive where the surface bulges to the side of its normals, such as 1/r on
    a sphere whose normals point outwards, and 0 on soap films without pressure. Gaussian curvature K = 1/(r1 r2) is
    negative where the surface is a saddle, 0 where it can be unrolled. With A the mixed area of a vertex,
    H = n . sum of (cot a + cot b) (p - q) / (4 A) over its edges, with the normal n along the sum of the vector areas
    around, K = (2 pi - sum of angles) / A; a quad is the mean of its two cuts into triangles. nan at vertices on the
    boundary or without faces. The error falls with the size of the faces where these are regular; where they are not,
    single values scatter.

    Source: Meyer, Desbrun, Schroeder and Barr, Discrete differential-geometry operators for triangulated 2-manifolds,
    2003.
    """
    m = as_mesh(mesh)
    t, weight = _cuts(m.faces)
    size = len(m.vertices)
    angles, cotangents, areas = (weight[:, None] * found for found in _corners(m.vertices, t))
    bent, around, area = np.zeros((size, 3)), np.zeros(size), np.zeros(size)
    for k in range(3):
        one, other = t[:, (k + 1) % 3], t[:, (k + 2) % 3]
        pull = cotangents[:, k, None] * (m.vertices[one] - m.vertices[other])  # of the edge across corner k
        np.add.at(bent, one, pull)
        np.add.at(bent, other, -pull)
        np.add.at(around, t[:, k], angles[:, k])
        np.add.at(area, t[:, k], areas[:, k])
    inner = np.zeros(size, bool)
    inner[boundary(m)[1]] = True
    inner &= area > 0.0
    mean, gaussian = np.full(size, np.nan), np.full(size, np.nan)
    mean[inner] = (bent * vertex_normals(m)).sum(axis=1)[inner] / (4.0 * area[inner])
    gaussian[inner] = (2.0 * np.pi - around[inner]) / area[inner]
    return mean, gaussian


def _cuts(faces: Index) -> tuple[Index, Array]:
    """The triangles (t, 3) of both cuts of all faces, and their weights: quads count half in each."""
    quads, alone = faces[faces[:, 2] != faces[:, 3]], faces[faces[:, 2] == faces[:, 3], :3]
    cut = [quads[:, corners] for corners in ([0, 1, 2], [0, 2, 3], [0, 1, 3], [1, 2, 3])]
    return np.concatenate([alone, *cut]), np.repeat([1.0, 0.5], [len(alone), 4 * len(quads)])


def _corners(x: Array, t: Index) -> tuple[Array, Array, Array]:
    """Angle, cotangent and mixed area (t, 3) at the corners of triangles; without area their cotangents are 0."""
    p = x[t]
    angles, cotangents = np.zeros((len(t), 3)), np.zeros((len(t), 3))
    squares = np.zeros((len(t), 3))  # of the sides across the corners
    twice = np.linalg.norm(np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]), axis=1)
    for k in range(3):
        u, v = p[:, (k + 1) % 3] - p[:, k], p[:, (k + 2) % 3] - p[:, k]
        dot = (u * v).sum(axis=1)
        angles[:, k] = np.arctan2(twice, dot)
        cotangents[:, k] = np.divide(dot, twice, out=np.zeros(len(t)), where=twice > 0.0)
        squares[:, k] = ((u - v) ** 2).sum(axis=1)
    areas = np.zeros((len(t), 3))
    weighted = squares * cotangents / 8.0
    obtuse = angles > 0.5 * np.pi
    any_obtuse = obtuse.any(axis=1)
    for k in range(3):
        voronoi = weighted[:, (k + 1) % 3] + weighted[:, (k + 2) % 3]
        areas[:, k] = np.where(any_obtuse, np.where(obtuse[:, k], twice / 4.0, twice / 8.0), voronoi)
    return angles, cotangents, areas
