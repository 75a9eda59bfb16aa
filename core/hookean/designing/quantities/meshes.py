"""Areas and volumes of meshes."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar, Literal

import numpy as np

from hookean.designing.quantities.base import Floats, Ints, Quantity, Slopes, matrix, nothing
from hookean.errors import InputError
from hookean.values.fields import Field

if TYPE_CHECKING:
    from hookean.designing.equilibrium import Equilibrium
    from hookean.designing.unknowns import Unknowns


class Volume(Quantity):
    """The volume between a mesh of the scene and the origin, by the sides its faces show [length³]: of a closed mesh
    the volume inside."""

    kind: Literal["volume"] = "volume"
    mesh: str = Field(description="Name of a mesh")
    unit: ClassVar[str] = "length^3"

    def values(self, found: Equilibrium, pointer: str) -> Floats:
        """Sums of a . (b x c) / 6 over triangles."""
        a, b, c = found.x[triangles(found, self.mesh, pointer)].transpose(1, 0, 2)
        return np.array([np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0])

    def slopes(self, found: Equilibrium, unknowns: Unknowns, pointer: str) -> Slopes:
        """Cross products of the other corners by 6."""
        corners = triangles(found, self.mesh, pointer)
        a, b, c = found.x[corners].transpose(1, 0, 2)
        normals = np.stack([np.cross(b, c), np.cross(c, a), np.cross(a, b)], axis=1) / 6.0
        return _of_corners(found, unknowns, corners, normals)


class Area(Quantity):
    """The area of a mesh of the scene [length²]."""

    kind: Literal["area"] = "area"
    mesh: str = Field(description="Name of a mesh")
    unit: ClassVar[str] = "length^2"

    def values(self, found: Equilibrium, pointer: str) -> Floats:
        """The sum over its triangles."""
        a, b, c = found.x[triangles(found, self.mesh, pointer)].transpose(1, 0, 2)
        return np.array([0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum()])

    def slopes(self, found: Equilibrium, unknowns: Unknowns, pointer: str) -> Slopes:
        """Half of the opposite side, turned about the normal, at each corner."""
        corners = triangles(found, self.mesh, pointer)
        a, b, c = found.x[corners].transpose(1, 0, 2)
        normal = np.cross(b - a, c - a)
        size = np.linalg.norm(normal, axis=1)[:, None]
        normal = np.divide(normal, size, out=np.zeros_like(normal), where=size > 0.0)
        turned = np.stack([np.cross(normal, c - b), np.cross(normal, a - c), np.cross(normal, b - a)], axis=1) / 2.0
        return _of_corners(found, unknowns, corners, turned)


def triangles(found: Equilibrium, mesh: str, pointer: str) -> Ints:
    """The triangles (m, 3) of a mesh, in particles."""
    faces = mesh_faces(found, mesh, pointer)
    both = np.concatenate([faces[:, [0, 1, 2]], faces[:, [0, 2, 3]]])
    return np.asarray(both[(both[:, 0] != both[:, 1]) & (both[:, 1] != both[:, 2]) & (both[:, 2] != both[:, 0])])


def mesh_faces(found: Equilibrium, mesh: str, pointer: str) -> Ints:
    """The faces (m, 4) of a mesh, in particles; a triangle repeats its last corner."""
    system = found.system
    if mesh not in system.scene.meshes:
        known = ", ".join(repr(name) for name in system.scene.meshes) or "none"
        raise InputError(f"{pointer}/mesh", f"mesh {mesh!r} does not exist; the scene has {known}")
    faces = system.places.faces(mesh)
    if (faces < 0).any():
        raise InputError(f"{pointer}/mesh", f"vertices of mesh {mesh!r} meet no particle; let a force act on it")
    return np.asarray(faces)


def _of_corners(found: Equilibrium, unknowns: Unknowns, corners: Ints, vectors: Floats) -> Slopes:
    """One row of derivatives from vectors (m, 3, 3) at the corners of triangles."""
    columns = 3 * corners[:, :, None] + np.arange(3)
    row = np.zeros(columns.size, np.int64)
    return matrix(row, columns, vectors, (1, found.x.size)), nothing(1, unknowns.count)
