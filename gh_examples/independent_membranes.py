"""Nets of drawn surfaces, and the two areas of figure 9.28, without hookean: for the scripts beside the examples."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import rhino3dm


@dataclass
class Net:
    """A surface divided into u by v quads at even parameters: points (n, 3), faces (m, 4), edges along u and along v,
    the diagonals of the faces both ways, and the points of the rim and of the four corners."""

    points: np.ndarray
    faces: np.ndarray
    along_u: np.ndarray
    along_v: np.ndarray
    one: np.ndarray
    other: np.ndarray
    rim: np.ndarray
    corners: np.ndarray

    @property
    def edges(self):
        return np.concatenate([self.along_u, self.along_v])

    def lengths(self, pairs):
        return np.linalg.norm(self.points[pairs[:, 1]] - self.points[pairs[:, 0]], axis=1)

    def at(self, x, y):
        """The point drawn at x, y."""
        return int(np.hypot(self.points[:, 0] - x, self.points[:, 1] - y).argmin())


def drawn(model: Path, u: int, v: int) -> Net:
    """The one surface of a .3dm file, by its own evaluation."""
    file = rhino3dm.File3dm.Read(str(model))
    surfaces = [o.Geometry for o in file.Objects if isinstance(o.Geometry, rhino3dm.Surface)]
    (surface,) = surfaces
    s, t = surface.Domain(0), surface.Domain(1)
    at = [
        surface.PointAt(s.T0 + (s.T1 - s.T0) * i / u, t.T0 + (t.T1 - t.T0) * j / v)
        for i in range(u + 1)
        for j in range(v + 1)
    ]
    n = np.arange((u + 1) * (v + 1)).reshape(u + 1, v + 1)
    faces = np.stack([n[:-1, :-1], n[1:, :-1], n[1:, 1:], n[:-1, 1:]], axis=2).reshape(-1, 4)
    return Net(
        points=np.array([(p.X, p.Y, p.Z) for p in at]),
        faces=faces,
        along_u=np.stack([n[:-1], n[1:]], axis=2).reshape(-1, 2),
        along_v=np.stack([n[:, :-1], n[:, 1:]], axis=2).reshape(-1, 2),
        one=faces[:, [0, 2]],
        other=faces[:, [1, 3]],
        rim=np.unique(np.concatenate([n[0], n[-1], n[:, 0], n[:, -1]])),
        corners=n[[0, 0, -1, -1], [0, -1, 0, -1]],
    )


def forces(x, pairs, stiffness, rest):
    """Tensions of springs."""
    return stiffness * (np.linalg.norm(x[pairs[:, 1]] - x[pairs[:, 0]], axis=1) - rest)


def skewness(x, faces):
    """By how many degrees the corner of a face that is farthest from a right angle is off."""
    worst = np.zeros(len(faces))
    for corner in range(4):
        a, b, c = (x[faces[:, (corner + k) % 4]] for k in (0, 1, 3))
        across = np.linalg.norm(np.cross(b - a, c - a), axis=1)
        worst = np.maximum(worst, np.abs(90.0 - np.degrees(np.arctan2(across, ((b - a) * (c - a)).sum(axis=1)))))
    return worst


def folds(x, faces):
    """Angles in degrees by which faces are folded along the diagonal from their second to their fourth corner."""
    a, b, c, d = (x[faces[:, k]] for k in range(4))
    one, other = np.cross(b - a, d - a), np.cross(d - c, b - c)
    return np.degrees(np.arctan2(np.linalg.norm(np.cross(one, other), axis=1), (one * other).sum(axis=1)))
