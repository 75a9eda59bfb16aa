"""How much a mesh curves at its inner vertices."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar, Literal

import numpy as np

from hookean.designing.quantities.base import Floats, Ints, Quantity, Slopes, matrix, nothing
from hookean.designing.quantities.meshes import triangles
from hookean.errors import InputError
from hookean.values.fields import Field

if TYPE_CHECKING:
    from hookean.designing.equilibrium import Equilibrium
    from hookean.designing.unknowns import Unknowns


class Curvature(Quantity):
    """The Gaussian curvature of a mesh at each inner vertex [1/length²], in the order of particles.

    1 / R² on a sphere, 0 where the mesh can be unrolled, negative on a saddle.

    It is what the angles about the vertex leave of 2 pi, by a third of the area of its triangles; quads count as two
    triangles. Source: Meyer and others, "Discrete differential-geometry operators for triangulated 2-manifolds", 2003.
    """

    kind: Literal["curvature"] = "curvature"
    mesh: str = Field(description="Name of a mesh")
    unit: ClassVar[str] = "1/length^2"

    def values(self, found: Equilibrium, pointer: str) -> Floats:
        """(2 pi - sum of angles) / (area / 3)."""
        corners = triangles(found, self.mesh, pointer)
        inner = self._inner(corners, len(found.x), pointer)
        left, area, _, _ = _measured(found.x, corners)
        return np.asarray((left / area)[inner])

    def slopes(self, found: Equilibrium, unknowns: Unknowns, pointer: str) -> Slopes:
        """(d left - curvature d area) / area."""
        from scipy.sparse import diags

        corners = triangles(found, self.mesh, pointer)
        inner = self._inner(corners, len(found.x), pointer)
        left, area, by_left, by_area = _measured(found.x, corners)
        by_place = (by_left[inner] - diags((left / area)[inner]) @ by_area[inner]).tocsr()
        return (diags(1.0 / area[inner]) @ by_place).tocsr(), nothing(len(inner), unknowns.count)

    def _inner(self, corners: Ints, count: int, pointer: str) -> Ints:
        """Particles all of whose edges have a triangle on both sides."""
        edges = np.sort(np.concatenate([corners[:, [i, (i + 1) % 3]] for i in range(3)]), axis=1)
        each, sides = np.unique(edges, axis=0, return_counts=True)
        inner = np.setdiff1d(corners, each[sides != 2])
        if not len(inner):
            raise InputError(f"{pointer}/mesh", f"mesh {self.mesh!r} has no inner vertices, and no curvature")
        return np.asarray(inner)


def _measured(x: Floats, corners: Ints) -> tuple[Floats, Floats, Any, Any]:
    """Of each particle (n,) what angles leave of 2 pi and a third of the area about it, and derivatives (n, 3n)."""
    n, places = len(x), 3 * corners[:, :, None] + np.arange(3)
    left, area = np.full(n, 2.0 * np.pi), np.zeros(n)
    by_left: list[Any] = []
    by_area: list[Any] = []
    for i in range(3):
        at, b, c = corners[:, i], corners[:, (i + 1) % 3], corners[:, (i + 2) % 3]
        p, q = x[b] - x[at], x[c] - x[at]
        normal = np.cross(p, q)
        size = np.maximum(np.linalg.norm(normal, axis=1), np.finfo(float).tiny)
        np.subtract.at(left, at, np.arctan2(size, (p * q).sum(axis=1)))
        np.add.at(area, at, size / 6.0)
        unit = normal / size[:, None]
        by_p, by_q = np.cross(p, unit) / (p * p).sum(axis=1)[:, None], np.cross(unit, q) / (q * q).sum(axis=1)[:, None]
        turned = np.cross(q, unit) / 6.0, np.cross(unit, p) / 6.0  # of the area, by p and by q
        order = np.argsort([i, (i + 1) % 3, (i + 2) % 3])
        for total, (one, two) in ((by_left, (-by_p, -by_q)), (by_area, turned)):
            by = np.stack([-one - two, one, two], axis=1)[:, order]
            total.append(matrix(np.repeat(at, 9), places, by, (n, 3 * n)))
    return left, np.maximum(area, np.finfo(float).tiny), sum(by_left), sum(by_area)
