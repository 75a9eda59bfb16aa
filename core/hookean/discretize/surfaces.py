"""Surfaces to quad meshes, u by v faces at even parameters, as Rhino's Mesh Surface makes them."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.discretize.meshes import tidy_faces
from hookean.errors import InputError
from hookean.values.mesh import Mesh

Array = NDArray[np.float64]
Index = NDArray[np.int64]

_SAME = 1e-6  # points nearer than this, relative to the surface's size, are one


def mesh_grid(surface: Any, u: int, v: int) -> Mesh:
    """A surface as a mesh of u by v quads (see `mesh_surface`, which takes Breps, too)."""
    grid = sample(surface, *counts(u, v))
    ids = merged_ids(grid)
    mesh = compact(grid.reshape(-1, 3), ids.ravel(), grid_faces(ids))
    if not len(mesh.faces):
        raise InputError("u, v", f"{u} x {v} pieces of a closed surface give no face; give at least 3 around it")
    return mesh


def counts(u: Any, v: Any) -> tuple[int, int]:
    """Both counts as ints; InputError where one is not a whole number of at least 1."""
    for name, n in (("u", u), ("v", v)):
        whole = isinstance(n, (int, np.integer)) or (isinstance(n, float) and n.is_integer())
        if isinstance(n, bool) or not whole or n < 1:
            raise InputError(name, f"{n!r} faces were asked for; give a whole number of at least 1")
    return int(u), int(v)


def sample(surface: Any, u: int, v: int) -> Array:
    """Points `(u + 1, v + 1, 3)` of a surface at even parameters, its own evaluation."""
    if hasattr(surface, "IsoCurve"):
        (u0, u1), (v0, v1) = ((d.T0, d.T1) for d in (surface.Domain(0), surface.Domain(1)))
    elif hasattr(surface, "domain_u") and hasattr(surface, "point_at"):
        (u0, u1), (v0, v1) = surface.domain_u, surface.domain_v
    else:
        kind = type(surface).__name__
        raise InputError("surface", f"{kind} is not a surface; give a rhino3dm or COMPAS surface or a Brep")
    # the ends themselves, not a rounded neighbour outside the domain
    us = np.minimum(np.linspace(u0, u1, u + 1), u1)
    vs = np.minimum(np.linspace(v0, v1, v + 1), v1)
    grid = _evaluated(surface, us, vs).reshape(-1, 3)
    if not np.isfinite(grid).all():
        raise InputError("surface", "a point of it is not finite; rebuild it")
    if not np.ptp(grid, axis=0).any():
        raise InputError("surface", "it has no area: all its points coincide; give a surface with area")
    return grid.reshape(u + 1, v + 1, 3)


def _evaluated(surface: Any, us: Array, vs: Array) -> Array:
    if hasattr(surface, "points_at"):
        return np.asarray(surface.points_at(us, vs), dtype=np.float64)
    rhino = hasattr(surface, "PointAt")
    at = surface.PointAt if rhino else surface.point_at
    points = [at(s, t) for s in us.tolist() for t in vs.tolist()]
    return np.array([(p.X, p.Y, p.Z) if rhino else (p[0], p[1], p[2]) for p in points], dtype=np.float64)


def merged_ids(grid: Array) -> Index:
    """For each grid point the number `(u + 1, v + 1)` of the first one it is the same as.

    Only collapsed sides and closed seams make points the same: a surface that touches itself elsewhere
    stays as it is.
    """
    nu, nv = grid.shape[0] - 1, grid.shape[1] - 1
    ids = np.arange((nu + 1) * (nv + 1)).reshape(nu + 1, nv + 1)
    near = _SAME * float(np.ptp(grid.reshape(-1, 3), axis=0).max())
    for axis, n in ((0, nu), (1, nv)):
        g, i = (grid, ids) if axis == 0 else (grid.swapaxes(0, 1), ids.T)
        if np.abs(g[-1] - g[0]).max() <= near and not np.abs(g - g[:1]).max() <= near:
            if n < 3:
                raise InputError("uv"[axis], f"{n} faces around a closed surface given; give at least 3")
            i[-1] = i[0]
    for g, i in ((grid, ids), (grid.swapaxes(0, 1), ids.T)):
        for row in (0, -1):
            if np.abs(g[row] - g[row, 0]).max() <= near:
                i[row] = i[row].min()
    return ids


def grid_faces(ids: Index) -> Index:
    """Faces `(u v, 4)` of a grid of vertex numbers; collapsed ones are still in."""
    return np.stack([ids[:-1, :-1], ids[1:, :-1], ids[1:, 1:], ids[:-1, 1:]], axis=2).reshape(-1, 4)


def compact(points: Array, same_as: Index, faces: Index) -> Mesh:
    """A mesh of the points that stand for themselves, renumbered in order; faces without area go."""
    kept = np.flatnonzero(same_as == np.arange(len(points)))
    number = np.full(len(points), -1)
    number[kept] = np.arange(len(kept))
    return Mesh(points[kept], tidy_faces(number[same_as][faces]))
