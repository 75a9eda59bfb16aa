"""Meshes of quads over points in rows."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from hookean.discretize.surfaces import grid_faces
from hookean.values.mesh import Mesh


def grid(x: ArrayLike, y: ArrayLike, z: ArrayLike = 0.0) -> Mesh:
    """The mesh of `quads` over the plan of the places x (m,) and y (n,) at heights z (m, n) [length]."""
    along, across = np.meshgrid(np.asarray(x, float), np.asarray(y, float), indexing="ij")
    return quads(np.stack([along, across, np.broadcast_to(z, along.shape)], axis=-1))


def quads(points: ArrayLike) -> Mesh:
    """A mesh over points in rows (m, n, 3) [length].

    Vertex (i, j) is numbered with j fastest; face (i, j) runs i j, i+1 j, i+1 j+1, i j+1: its first side along the
    first count.
    """
    rows = np.asarray(points, float)
    return Mesh(rows.reshape(-1, 3), grid_faces(np.arange(rows[..., 0].size).reshape(rows.shape[:2])))
