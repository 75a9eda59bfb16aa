"""Collide curve: circles that do not enter a closed curve in their plane, or do not leave it."""

from __future__ import annotations

from typing import Any, ClassVar, Literal, Self

import numpy as np
from pydantic import model_validator

from hookean.forces.base import Block, Floats, Force, OnFilm, Places, lengths, units
from hookean.forces.collide_solid import PARTS, contacts, depths, solid_hessian, solid_kernel, unit
from hookean.values.columns import Direction, IndexRows, NonNegatives, Points, fault
from hookean.values.fields import Field, Maybe


class CollideCurve(Force):
    """Circles that a closed curve in their plane pushes out where they overlap it: E = k d^2 / 2, d the depth.

    The curve is a polyline that itself stays where it is; its last corner is joined to the first. d = r - s, where s is
    the distance of a particle to the closest point of the curve, negative inside; with `inside` the free side is the
    inside, and d = r + s. Only what is square to `normal` counts: particles move freely along it, and the curve is a
    prism without ends. Give a NURBS curve as points that divide it finely (`discretize.divide`). It may not cross
    itself. Source: Baerentzen and Aanaes, "Signed distance computation using the angle weighted pseudonormal", 2005.
    """

    kind: Literal["collide_curve"] = "collide_curve"
    particles: Maybe[IndexRows] = Field(default=None, description="Particles on which it acts")
    points: Maybe[Points] = Field(default=None, description="Coordinates of these particles")
    mesh: str | None = Field(default=None, description="Name of a mesh on whose vertices it acts")
    curve: Points = Field(description="Corners of the closed polyline [length], at least three")
    normal: Direction = Field(
        default=np.array([0.0, 0.0, 1.0]), description="Normal of the curve's plane; its length is ignored"
    )
    radius: NonNegatives = Field(default=0.0, description="r, radius of each circle [length]")
    inside: bool = Field(default=False, description="Whether particles are kept inside, not outside")
    strength: NonNegatives = Field(default=1000.0, description="k, stiffness of a contact [force/length]")

    formula: ClassVar[str] = "E = k d²/2"
    role: ClassVar[Literal["internal", "load", "support"]] = "support"
    creates: ClassVar[bool] = False
    shared: ClassVar[tuple[str, ...]] = ("curve", "normal")
    on_film: ClassVar[OnFilm] = "spread"
    touches: ClassVar[bool] = True
    outputs: ClassVar[dict[str, str]] = {"depth": "length", "force": "force"}
    kernel: ClassVar[Any] = staticmethod(solid_kernel)
    hessian: ClassVar[Any] = staticmethod(solid_hessian)

    @model_validator(mode="after")
    def _has_an_inside(self) -> Self:
        if not len(outline(self.curve, units(self.normal)[0])[1]):
            raise fault("the curve encloses no area square to its normal; give at least three corners", "/curve")
        return self

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: stiffness, radius, side, normal, and the tables of the curve."""
        normal = units(self.normal)[0]
        index = places.elements(self)
        return contacts(index, *outline(self.curve, normal), self.inside, self.strength, self.radius, normal)

    def measure(self, block: Block, x: Floats, element_forces: Floats) -> dict[str, Floats]:
        """Depth of each circle in the curve [length] and the force on it [force]."""
        return depths(block, element_forces)

    @classmethod
    def example(cls) -> tuple[CollideCurve, Floats]:
        """Circles about a triangle in a tilted plane: on a side, at a corner, inside, and one that is free."""
        curve = [[-2.0, 0.0, 0.0], [2.0, 0.0, 1.0], [0.0, 3.0, 0.5]]
        x = np.array([[0.2, -0.3, 0.5], [2.3, -0.2, 1.0], [0.1, 0.7, 0.4], [5.0, 5.0, 0.0]])
        force = cls(
            particles=range(4), curve=curve, normal=[-0.25, 0.0, 1.0], radius=0.8, strength=[100.0, 20.0, 3.0, 10.0]
        )
        return force, x


def outline(curve: Floats, normal: Floats) -> tuple[Floats, Floats]:
    """Pieces (m, 3, 3) of a closed polyline, moved along a unit normal into the plane through the origin, each with its
    last corner twice, and outward normals (m, 21) of their parts, as `pseudonormals`; none where it has no area."""
    flat = curve - (curve @ normal)[:, None] * normal
    size = float(np.ptp(flat, axis=0).max()) if len(flat) else 0.0
    flat = flat[lengths(flat - np.roll(flat, 1, axis=0)) > 1e-12 * size]
    after = np.roll(flat, -1, axis=0)
    pieces = np.stack([flat, after, after], axis=1)
    area = 0.5 * float((np.cross(flat - flat[:1], after - flat[:1]) @ normal).sum())
    if not abs(area) > 1e-12 * size * size:
        return pieces, np.zeros((0, PARTS))
    out = np.sign(area) * unit(np.cross(after - flat, normal) / size)
    start = unit(out + np.roll(out, 1, axis=0))
    end = np.roll(start, -1, axis=0)
    return pieces, np.column_stack([start, end, end, out, end, out, out])
