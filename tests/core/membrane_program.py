"""Another program for membranes, on numpy and scipy alone: strains from the metric of each triangle, Newton steps."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import spsolve

Floats = np.ndarray
Ints = np.ndarray


def cloth(warp: float, weft: float, shear: float, nu: float) -> Floats:
    """Stiffness (3, 3) per width, from its inverse [[1/Ew, -nu/Ew, 0], [-nu/Ew, 1/Ef, 0], [0, 0, 1/G]]."""
    return np.linalg.inv([[1 / warp, -nu / warp, 0], [-nu / warp, 1 / weft, 0], [0, 0, 1 / shear]])


def cuts(faces: Ints) -> tuple[Ints, Ints]:
    """Both ways to cut quads (m, 4): triangles (4 m, 3) that count half, and the face of each."""
    ways = [faces[:, list(way)] for way in ((0, 1, 2), (0, 2, 3), (0, 1, 3), (1, 2, 3))]
    return np.concatenate(ways), np.tile(np.arange(len(faces)), 4)


@dataclass
class Program:
    """Triangles of orthotropic cloth that is stressed by `stress` in the shape `x`, with the warp along `along` (m, 3)
    as near as the triangle allows, each times `weight`; `held` particles, dead `load` (n, 3)."""

    x: Floats
    triangles: Ints
    along: Floats
    stiff: Floats
    stress: Floats
    held: Ints
    load: Floats
    weight: float = 0.5

    def __post_init__(self) -> None:
        one, two = (self.x[self.triangles[:, i]] - self.x[self.triangles[:, 0]] for i in (1, 2))
        normal = np.cross(one, two)
        double = np.linalg.norm(normal, axis=1)
        normal /= double[:, None]
        warp = self.along - (self.along * normal).sum(axis=1)[:, None] * normal
        warp /= np.linalg.norm(warp, axis=1)[:, None]
        plane = np.stack([warp, np.cross(normal, warp)], axis=1)  # (m, 2, 3)
        self.area = 0.5 * self.weight * double
        self.inverse = np.linalg.inv(plane @ np.stack([one, two], axis=-1))
        self.slopes = np.stack([-self.inverse.sum(axis=1), self.inverse[:, 0], self.inverse[:, 1]], axis=1)

    def strained(self, x: Floats) -> tuple[Floats, Floats]:
        """The images of warp and weft (m, 3, 2), and the second Piola-Kirchhoff stress (m, 3) of the Green strain."""
        corners = x[self.triangles]
        deformed = np.stack([corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]], axis=-1) @ self.inverse
        metric = np.einsum("mca,mcb->mab", deformed, deformed)
        strain = np.stack([(metric[:, 0, 0] - 1) / 2, (metric[:, 1, 1] - 1) / 2, metric[:, 0, 1]], axis=-1)
        return deformed, strain @ self.stiff + self.stress

    def solved(self) -> tuple[Floats, Floats]:
        """The shape at rest and the stress in it, along the warp as it is per present width (m,)."""
        x, count = self.x.copy(), len(self.triangles)
        axes = (3 * self.triangles[:, :, None] + np.arange(3)).reshape(count, 9)
        moving = np.setdiff1d(np.arange(x.size), (3 * np.asarray(self.held)[:, None] + np.arange(3)).ravel())
        for _ in range(40):
            deformed, stress = self.strained(x)
            rates = self._rates(deformed)
            left = self.load.ravel().copy()
            np.add.at(left, axes.ravel(), -np.einsum("mai,ma,m->mi", rates, stress, self.area).ravel())
            if np.abs(left[moving]).max() < 1e-11 * np.abs(self.load).max():
                break
            stiffness = np.einsum("mai,ab,mbj,m->mij", rates, self.stiff, rates, self.area)
            both = np.stack([stress[:, [0, 2]], stress[:, [2, 1]]], axis=1)
            tight = np.einsum("mia,mab,mjb,m->mij", self.slopes, both, self.slopes, self.area)
            for axis in range(3):
                stiffness[:, axis::3, axis::3] += tight
            places = np.repeat(axes, 9, axis=1).ravel(), np.tile(axes, 9).ravel()
            whole = sparse.coo_matrix((stiffness.ravel(), places)).tocsc()[moving][:, moving]
            x.ravel()[moving] += spsolve(whole, left[moving])
        deformed, stress = self.strained(x)
        images = np.einsum("mca,mab,mdb->mcd", deformed, np.stack([stress[:, [0, 2]], stress[:, [2, 1]]], 1), deformed)
        grown = np.linalg.norm(np.cross(deformed[:, :, 0], deformed[:, :, 1]), axis=1)
        way = deformed[:, :, 0] / np.linalg.norm(deformed[:, :, 0], axis=1)[:, None]
        return x, np.einsum("mc,mcd,md->m", way, images, way) / grown

    def _rates(self, deformed: Floats) -> Any:
        """Derivatives (m, 3, 9) of the strain by the corners."""
        rates = np.empty((len(deformed), 3, 3, 3))
        for corner in range(3):
            along, across = self.slopes[:, corner, :1], self.slopes[:, corner, 1:]
            rates[:, 0, corner] = along * deformed[:, :, 0]
            rates[:, 1, corner] = across * deformed[:, :, 1]
            rates[:, 2, corner] = along * deformed[:, :, 1] + across * deformed[:, :, 0]
        return rates.reshape(-1, 3, 9)
