"""How far particles are from a line, curve, plane or mesh that stays where it is."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar, Literal, Self

import numpy as np
from pydantic import model_validator

from hookean.designing.quantities.base import Floats, Ints, Quantity, Slopes, across, matrix, nothing, particle_places
from hookean.errors import InputError
from hookean.values.columns import Direction, Indices, Points, Vector, fault
from hookean.values.fields import Field, Maybe

if TYPE_CHECKING:
    from hookean.designing.equilibrium import Equilibrium
    from hookean.designing.unknowns import Unknowns

TOUCHING = 1e-12  # part of a mesh's size: nearer than this its own normal is the direction


class Offset(Quantity):
    """Distances of particles from a line, curve, plane or mesh that stays where it is [length]; a target of 0 puts
    them on it.

    Of a plane and a mesh one signed distance for each particle, positive on the side its normals show; of a line two,
    along two directions across it; of a curve the vector from the nearest point, three.
    """

    kind: Literal["offset"] = "offset"
    particles: Indices = Field(description="Particles")
    origin: Vector = Field(default=np.zeros(3), description="A point of the line or plane [length]")
    direction: Maybe[Direction] = Field(default=None, description="Direction of a line [-]")
    normal: Maybe[Direction] = Field(default=None, description="Normal of a plane [-]")
    curve: Maybe[Points] = Field(default=None, description="Points (n, 3) of a polyline, at least 2 [length]")
    mesh: str = Field(default="", description="Name of a mesh of the scene, as it is drawn")
    unit: ClassVar[str] = "length"

    @model_validator(mode="after")
    def _one_thing(self) -> Self:
        given = [self.direction is not None, self.normal is not None, self.curve is not None, bool(self.mesh)]
        if sum(given) != 1:
            raise fault("give exactly one of direction (of a line), normal (of a plane), curve, mesh")
        if self.curve is not None and len(self.curve) < 2:
            raise fault("a curve needs at least 2 points", "/curve")
        return self

    def values(self, found: Equilibrium, pointer: str) -> Floats:
        """The distances."""
        return np.asarray(self._measured(found, pointer)[0].ravel())

    def slopes(self, found: Equilibrium, unknowns: Unknowns, pointer: str) -> Slopes:
        """Of a distance its direction; of the vector from a curve what is across its nearest segment."""
        values, by = self._measured(found, pointer)
        k, wide = values.shape
        columns = np.broadcast_to(particle_places(found, self.particles, pointer)[:, None, :], (k, wide, 3))
        rows = np.repeat(np.arange(k * wide), 3)
        return matrix(rows, columns, by, (k * wide, found.x.size)), nothing(k * wide, unknowns.count)

    def _measured(self, found: Equilibrium, pointer: str) -> tuple[Floats, Floats]:
        """Values (k, w), and their derivatives (k, w, 3) by the particle's place."""
        particle_places(found, self.particles, pointer)
        x = found.x[self.particles]
        if self.normal is not None:
            return _along(x - self.origin, _unit(self.normal)[None])
        if self.direction is not None:
            return _along(x - self.origin, across(self.direction))
        if self.curve is not None:
            return _from_curve(x, self.curve)
        return _from_mesh(x, *self._faces(found, pointer))

    def _faces(self, found: Equilibrium, pointer: str) -> tuple[Floats, Ints]:
        """Vertices and triangles of the mesh."""
        meshes = found.system.scene.meshes
        if self.mesh not in meshes:
            known = ", ".join(repr(name) for name in meshes) or "none"
            raise InputError(f"{pointer}/mesh", f"mesh {self.mesh!r} does not exist; the scene has {known}")
        faces = np.asarray(meshes[self.mesh].faces)
        both = np.concatenate([faces[:, [0, 1, 2]], faces[:, [0, 2, 3]]])
        kept = (both[:, 0] != both[:, 1]) & (both[:, 1] != both[:, 2]) & (both[:, 2] != both[:, 0])
        return np.asarray(meshes[self.mesh].vertices), both[kept]


def _unit(vector: Any) -> Floats:
    return np.asarray(vector / np.linalg.norm(vector))


def _along(offsets: Floats, directions: Floats) -> tuple[Floats, Floats]:
    by = np.broadcast_to(directions, (len(offsets), *directions.shape))
    return offsets @ directions.T, by


def _from_curve(x: Floats, curve: Floats) -> tuple[Floats, Floats]:
    """Vectors from the nearest points of a polyline; at its corners and ends these do not move."""
    a, e = curve[:-1], np.diff(curve, axis=0)
    size = np.maximum((e * e).sum(axis=1), np.finfo(float).tiny)
    t = np.clip(np.einsum("kmi,mi->km", x[:, None] - a, e) / size, 0.0, 1.0)
    at = a + t[:, :, None] * e
    row = np.arange(len(x))
    near = np.linalg.norm(x[:, None] - at, axis=2).argmin(axis=1)
    own, inner = t[row, near], e[near] / np.sqrt(size[near])[:, None]
    inner = np.where(((own > 0.0) & (own < 1.0))[:, None], inner, 0.0)
    return x - at[row, near], np.eye(3) - inner[:, :, None] * inner[:, None, :]


def _from_mesh(x: Floats, vertices: Floats, faces: Ints) -> tuple[Floats, Floats]:
    """Signed distances from triangles."""
    from hookean.discretize.mapping import Closest

    number, at = Closest(vertices, faces)(x)
    a, b, c = vertices[faces[number]].transpose(1, 0, 2)
    normal = np.cross(b - a, c - a)
    normal /= np.maximum(np.linalg.norm(normal, axis=1), np.finfo(float).tiny)[:, None]
    away = x - at
    far = np.linalg.norm(away, axis=1)
    side = np.where((away * normal).sum(axis=1) < 0.0, -1.0, 1.0)
    close = far <= TOUCHING * float(np.ptp(vertices, axis=0).max())
    along = np.where(close[:, None], normal, side[:, None] * away / np.where(far > 0.0, far, 1.0)[:, None])
    return (side * far)[:, None], along[:, None, :]
