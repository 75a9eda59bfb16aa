"""How flat the faces of a mesh are, and how fair a net is."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar, Literal

import numpy as np
from pydantic import StrictInt, StrictStr

from hookean.designing.quantities.base import Floats, Ints, Quantity, Slopes, matrix, nothing
from hookean.designing.quantities.measured import Measured
from hookean.designing.quantities.meshes import mesh_faces
from hookean.errors import InputError
from hookean.values.fields import Field

if TYPE_CHECKING:
    from hookean.designing.equilibrium import Equilibrium
    from hookean.designing.unknowns import Unknowns


class Planarity(Quantity):
    """How far the diagonals of each quadrilateral of a mesh pass one another [length], by sign: 0 if it is flat.

    d = (c - a) . n with n the unit vector along (c - a) x (d - b) and (b - a) . n measured: corners a b c d.
    """

    kind: Literal["planarity"] = "planarity"
    mesh: str = Field(description="Name of a mesh")
    unit: ClassVar[str] = "length"

    def values(self, found: Equilibrium, pointer: str) -> Floats:
        """(b - a) . n."""
        a, b, c, d = found.x[self._quads(found, pointer)].transpose(1, 0, 2)
        normal, size = _normals(c - a, d - b)
        return np.asarray(((b - a) * normal).sum(axis=1) / size)

    def slopes(self, found: Equilibrium, unknowns: Unknowns, pointer: str) -> Slopes:
        """Of the triple product s by the size of the normal m: (ds - d dm) / m."""
        quads = self._quads(found, pointer)
        a, b, c, d = found.x[quads].transpose(1, 0, 2)
        p, q, r = c - a, d - b, b - a
        normal, size = _normals(p, q)
        unit = normal / size[:, None]
        value = (r * unit).sum(axis=1)[:, None]
        by_p, by_q = np.cross(q, r - value * unit), np.cross(r - value * unit, p)
        by = np.stack([-by_p - normal, normal - by_q, by_p, by_q], axis=1) / size[:, None, None]
        columns = 3 * quads[:, :, None] + np.arange(3)
        shape = (len(quads), found.x.size)
        return matrix(np.repeat(np.arange(len(quads)), 12), columns, by, shape), nothing(len(quads), unknowns.count)

    def _quads(self, found: Equilibrium, pointer: str) -> Ints:
        faces = mesh_faces(found, self.mesh, pointer)
        quads = faces[faces[:, 2] != faces[:, 3]]
        if not len(quads):
            raise InputError(f"{pointer}/mesh", f"mesh {self.mesh!r} has triangles alone, which are flat")
        return np.asarray(quads)


def _normals(p: Floats, q: Floats) -> tuple[Floats, Floats]:
    normal = np.cross(p, q)
    return normal, np.maximum(np.linalg.norm(normal, axis=1), np.finfo(float).tiny)


class Fairness(Quantity):
    """How far each inner particle of a force's net is from the mean of its neighbours [length], three values each: the
    less, the fairer the net. Inner are particles with at least 3 neighbours, or 2 on a line.

    Source: Taubin, "A signal processing approach to fair surface design", 1995, for the difference.
    """

    kind: Literal["fairness"] = "fairness"
    force: StrictStr | StrictInt = Field(description="Name or number of a force of elements between two particles")
    unit: ClassVar[str] = "length"

    def values(self, found: Equilibrium, pointer: str) -> Floats:
        """Places less means."""
        return np.asarray((self._umbrella(found, pointer) @ found.x).ravel())

    def slopes(self, found: Equilibrium, unknowns: Unknowns, pointer: str) -> Slopes:
        """The same weights for each axis."""
        from scipy.sparse import identity, kron

        by_place = kron(self._umbrella(found, pointer), identity(3)).tocsr()
        return by_place, nothing(by_place.shape[0], unknowns.count)

    def _umbrella(self, found: Equilibrium, pointer: str) -> Any:
        """Weights (k, n): 1 for a particle, -1 / count for its neighbours."""
        ends = Measured(found, self.force, pointer).index
        if ends.shape[1] != 2:
            raise InputError(f"{pointer}/force", f"its elements have {ends.shape[1]} particles, not 2")
        n = len(found.x)
        both = np.unique(np.concatenate([ends, ends[:, ::-1]]), axis=0)
        count = np.bincount(both[:, 0], minlength=n)
        inner = np.flatnonzero(count >= (3 if count.max(initial=0) > 2 else 2))
        near = matrix(both[:, 0], both[:, 1], -1.0 / count[both[:, 0]], (n, n))
        return (near + matrix(inner, inner, np.ones(len(inner)), (n, n)))[inner]
