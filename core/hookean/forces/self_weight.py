"""Self-weight: a total shared by particles, a weight per length of lines, or that of a material."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np
from pydantic import PrivateAttr, model_validator

from hookean.errors import InputError
from hookean.forces.base import Block, Floats, Force, Ints, OnFilm, Places
from hookean.forces.elastic import area
from hookean.forces.soapfilm import halves
from hookean.forces.unary import unary_kernel
from hookean.values.columns import LARGEST, IndexRows, Lines, Points, Reals, Vector, fault
from hookean.values.fields import Field, Maybe
from hookean.values.materials import gravity


class SelfWeight(Force):
    """Weight as loads: `total` / number of particles on each, half of `per_length` x start length on line ends, or that
    of a material.

    With a total, give particles, points or a mesh (nothing: every particle of the scene): 10 N on 51 particles is
    0.196 N each, also where some of the given points met no particle (the scene is not `strict`) and their part of the
    total is left out. With a weight per length, give lines, pairs of particles or a mesh (its edges). A material with a
    section weighs density x area x gravity per start length of the same; a cloth, or a solid with a thickness, weighs
    that on the faces of a mesh, a third of each triangle's on each of its corners. The load does not change as lines
    and faces stretch: weight is conserved. A form that is found may be far longer or larger than it was drawn; there
    `line_weight` and `area_weight` weigh what it is. Energy -W d . x. Source: the chapter, 9.5.
    """

    kind: Literal["self_weight"] = "self_weight"
    particles: Maybe[IndexRows] = Field(default=None, description="Particles, or pairs with a weight per length")
    points: Maybe[Points] = Field(default=None, description="Coordinates of particles")
    lines: Maybe[Lines] = Field(default=None, description="Straight lines, for a weight per length")
    mesh: str | None = Field(default=None, description="Name of a mesh: its vertices, or its edges")
    total: float | None = Field(
        default=None, ge=-LARGEST, le=LARGEST, description="Total weight [force], shared equally"
    )
    per_length: Maybe[Reals] = Field(default=None, description="Weight per length [force/length]")
    material: str | None = Field(default=None, description="Name of a material that has the weight")
    section: str | None = Field(default=None, description="Name of a section, of a material along lines")
    thickness: float | None = Field(default=None, gt=0, le=1e12, description="Of a solid on a mesh [length]")
    gravity: float | None = Field(
        default=None, ge=0, le=1e12, description="Of a material [length/time^2]; default: 9.80665 m/s^2"
    )
    factor: float = Field(default=1.0, ge=-1e12, le=1e12, description="Factor on the weight of a material [-]")
    direction: Vector = Field(
        default=np.array([0.0, 0.0, -1.0]), description="Direction of gravity; its length is ignored"
    )

    formula: ClassVar[str] = "E = -W d·x"
    role: ClassVar[Literal["internal", "load", "support"]] = "load"
    creates: ClassVar[bool] = False
    constant: ClassVar[bool] = True
    everywhere: ClassVar[bool] = True
    on_film: ClassVar[OnFilm] = "spread"
    outputs: ClassVar[dict[str, str]] = {"force": "force"}
    kernel: ClassVar[Any] = staticmethod(unary_kernel)

    _acting: float = PrivateAttr(default=1.0)

    @property
    def acting(self) -> float:
        """The factor of a load case that is in its weight, and not in its mass [-]."""
        return self._acting

    def in_case(self, factor: float) -> SelfWeight:
        """A copy whose weight, which has been multiplied by a factor, has it in `acting`."""
        other = self.replaced()
        other._acting = factor * self._acting  # type: ignore[misc]  # private, so not frozen
        return other

    @model_validator(mode="after")
    def _one_way(self) -> SelfWeight:
        if sum(given is not None for given in (self.total, self.per_length, self.material)) != 1:
            raise fault("give exactly one of total, per_length, material")
        if not np.linalg.norm(self.direction) > 0:
            raise fault("the direction of gravity must not be zero", "/direction")
        made = [name for name in ("section", "thickness", "gravity") if getattr(self, name) is not None]
        if self.material is None and made:
            raise fault(f"{made[0]} belongs to a material; give material, or leave {made[0]} out", f"/{made[0]}")
        if self.section is not None and self.thickness is not None:
            raise fault("section and thickness given; a material has a section along lines, a thickness on faces")
        if self.material is not None and self.section is None and self.mesh is None:
            raise fault("a material needs a section along lines, or a mesh whose faces it covers")
        if self._along and self.particles is None and self.lines is None and self.mesh is None:
            name = "section" if self.per_length is None else "per_length"
            raise fault(f"{name} needs lines, pairs of particles or a mesh")
        if self.total is not None and self.lines is not None:
            raise fault("lines need per_length; give particles or points for a total", "/lines")
        if self.total is None and self.points is not None:
            raise fault("points need a total; give lines for a weight per length", "/points")
        return self

    @property
    def _along(self) -> bool:
        """Whether lines have the weight."""
        return self.per_length is not None or self.section is not None

    @property
    def element_arity(self) -> int:
        """Particles share a total; lines have a weight per length, faces one per area."""
        return 2 if self._along else 1 if self.total is not None else 3

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: one load for each particle that carries weight."""
        down = np.asarray(self.direction) / np.linalg.norm(self.direction)
        if self.total is not None:
            index = places.elements(self)
            share = self.total / max(len(index), 1)  # of all points, also of those that met no particle
            return Block.of(index, vector=np.broadcast_to(share * down, (len(index), 3)))
        index, each = self.shares(places, places.x)
        weight = np.bincount(index.ravel(), np.repeat(each, index.shape[1]), len(places.x))
        particles = np.unique(index)
        return Block.of(particles[:, None], vector=weight[particles, None] * down)

    def weight_at(self, places: Places, x: Floats) -> float | None:
        """Weight [force] of a material, or per length, if its lines or faces had started at `x`; None of a total."""
        if self.total is not None:
            return None
        index, each = self.shares(places, x)
        return float(index.shape[1] * each.sum())

    def shares(self, places: Places, x: Floats) -> tuple[Ints, Floats]:
        """Particles (m, 2) of lines or (m, 3) of triangles, and the weight (m,) on each of these, as long or large as
        they are at `x`."""
        if self._along:
            lines = places.elements(self)
            met = (lines >= 0).all(axis=1)
            index = lines[met]
            length = np.linalg.norm(x[index[:, 1]] - x[index[:, 0]], axis=1)
            return index, 0.5 * np.broadcast_to(self._per_length(places), met.shape)[met] * length
        faces = places.faces(str(self.mesh))
        index, part, _ = halves(faces[(faces >= 0).all(axis=1)])
        a, b, c = (x[index[:, i]] for i in range(3))
        return index, self._per_area(places) * part * np.linalg.norm(np.cross(b - a, c - a), axis=1) / 6.0

    def _gravity(self, places: Places) -> float:
        """Gravity [length/time^2] times the factor on the weight."""
        return self.factor * (gravity(places.units) if self.gravity is None else self.gravity)

    def _per_length(self, places: Places) -> Any:
        """Weight per length of lines [force/length]."""
        if self.per_length is not None:
            return self.per_length
        name = str(self.material)
        return places.material(name).mass_density(name) * area(self, places) * self._gravity(places)

    def _per_area(self, places: Places) -> float:
        """Weight per area of faces [force/length^2]; InputError where it is not known."""
        name = str(self.material)
        material = places.material(name)
        if material.warp_stiffness is not None:
            if self.thickness is not None:
                raise InputError("", f"{name} is a cloth, whose mass is per area; remove thickness")
            if material.area_density is None:
                raise InputError("", f"{name} has no area_density; give it")
            return material.area_density * self._gravity(places)
        if self.thickness is None:
            raise InputError("", f"{name} is a solid; give its thickness on the mesh, or a section along its edges")
        return material.mass_density(name) * self.thickness * self._gravity(places)

    @classmethod
    def example(cls) -> tuple[SelfWeight, Floats]:
        """10 N shared by three particles."""
        return cls(particles=[0, 1, 2], total=10.0), np.eye(3)
