"""Nets of the essay's studies without hookean: quads of a drawn surface, force densities, tangent stiffness.

Only numpy, scipy and rhino3dm. Read it beside `independent.py`.
"""

import numpy as np
import rhino3dm
import scipy.sparse as sparse
from scipy.sparse.linalg import splu


def grid(surface, u, v):
    """Points (u + 1, v + 1, 3) of a NURBS surface at even steps of its parameters."""
    (u0, u1), (v0, v1) = ((d.T0, d.T1) for d in (surface.Domain(0), surface.Domain(1)))
    points = [surface.PointAt(s, t) for s in np.linspace(u0, u1, u + 1) for t in np.linspace(v0, v1, v + 1)]
    return np.array([(p.X, p.Y, p.Z) for p in points]).reshape(u + 1, v + 1, 3)


def objects(path, layer):
    """Geometry on a layer of a .3dm file."""
    file = rhino3dm.File3dm.Read(str(path))
    index = next(item.Index for item in file.Layers if item.FullPath == layer)
    return [item.Geometry for item in file.Objects if item.Attributes.LayerIndex == index]


def points(path, layer):
    """Point objects on a layer, (k, 3)."""
    return np.array([(p.Location.X, p.Location.Y, p.Location.Z) for p in objects(path, layer)])


def pairs(u, v):
    """Edges of a grid of u by v quads, (m, 2), and which of them lie on its rim."""
    number = np.arange((u + 1) * (v + 1)).reshape(u + 1, v + 1)
    along = np.stack([number[:-1], number[1:]], axis=2)
    across = np.stack([number[:, :-1], number[:, 1:]], axis=2)
    rim = [np.zeros(along.shape[:2], bool), np.zeros(across.shape[:2], bool)]
    rim[0][:, [0, -1]] = rim[1][[0, -1], :] = True
    return np.concatenate([along.reshape(-1, 2), across.reshape(-1, 2)]), np.concatenate([r.ravel() for r in rim])


def nearest(x, wanted):
    """Numbers of the points of x nearest to the wanted ones."""
    return np.array([np.argmin(np.linalg.norm(x - p, axis=1)) for p in wanted])


def force_density(x, edges, density, held):
    """Positions (n, 3) of a net without loads: D x = 0 on the free points. Source: Schek, 1974."""
    n, m = len(x), len(edges)
    sign = sparse.csr_matrix((np.tile([1.0, -1.0], m), (np.repeat(np.arange(m), 2), edges.ravel())), shape=(m, n))
    whole = (sign.T @ sparse.diags(density) @ sign).tocsc()
    free = np.setdiff1d(np.arange(n), held)
    x = x.copy()
    x[free] = splu(whole[free][:, free]).solve(-(whole[free][:, held] @ x[held]))
    return x


def pull(x, edges, force):
    """What members of these forces (tension +) put on their ends, summed: (n, 3)."""
    d = x[edges[:, 1]] - x[edges[:, 0]]
    along = d / np.linalg.norm(d, axis=1)[:, None] * np.asarray(force)[:, None]
    total = np.zeros_like(x)
    np.add.at(total, edges[:, 0], along)
    np.add.at(total, edges[:, 1], -along)
    return total


def area(points):
    """Of a grid of quads, each the mean of its two cuts into triangles."""
    a, b, c, d = points[:-1, :-1], points[1:, :-1], points[1:, 1:], points[:-1, 1:]
    cuts = (np.cross(b - a, c - a), np.cross(c - a, d - a), np.cross(b - a, d - a), np.cross(c - b, d - b))
    return 0.25 * sum(np.linalg.norm(n, axis=2).sum() for n in cuts)
