"""Pulls particles onto a NURBS surface, each to the point of it that is closest."""

from __future__ import annotations

from typing import Any, ClassVar, Literal, Self

import numpy as np
from pydantic import model_validator

from hookean.compiled.dispatch import keep, rows
from hookean.discretize.nurbs import NurbsSurface, as_nurbs_surface, nurbs_surface
from hookean.errors import InputError
from hookean.forces.base import Block, Floats, Places
from hookean.forces.pull_to_mesh import DEEPEST, Pull, tree
from hookean.forces.surface_search import AT, BASIS, PLACE, TABLE, R, U, V, curvature, held_back, nearest_place, tables
from hookean.values.columns import NonNegatives, PointRows, Table, fault
from hookean.values.fields import Field, Maybe

STRENGTH = 0  # column of the parameters


def surface_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    energy = 0.0
    b, g, h, room = np.zeros((PLACE, BASIS)), np.zeros((PLACE, 4)), np.zeros((2, 2)), np.zeros((AT + 4, 3))
    stack = np.zeros(2 * DEEPEST, np.int64)
    for e in range(indices.shape[0]):
        a, strength = indices[e, 0], parameters[e, STRENGTH]
        if strength == 0.0:
            continue
        energy += strength * nearest_place(parameters, e, x[a], b, g, h, room, stack)
        w[a] += strength
        for c in range(3):
            f[a, c] += strength * g[R, c]
    return energy


def surface_hessian(x, indices, parameters, memory, blocks):  # type: ignore[no-untyped-def]
    # the point slides: 1 - J h J', J the derivatives by the free parameters and h the inverse of second derivatives
    b, g, h, room = np.zeros((PLACE, BASIS)), np.zeros((PLACE, 4)), np.zeros((2, 2)), np.zeros((AT + 4, 3))
    stack = np.zeros(2 * DEEPEST, np.int64)
    for e in range(indices.shape[0]):
        nearest_place(parameters, e, x[indices[e, 0]], b, g, h, room, stack)
        t, piece, held = room[AT], room[AT + 1], room[AT + 2]
        s = rows(parameters[e, TABLE], parameters[e, TABLE + 1], 1)
        held_back(s, t, piece, x[indices[e, 0]], b, g, held)
        slides = curvature(g, held, h)
        for i in range(3):
            for j in range(3):
                entry = 1.0 if i == j else 0.0
                if slides:
                    entry -= g[U, i] * h[0, 0] * g[U, j] + g[V, i] * h[1, 1] * g[V, j]
                    entry -= h[0, 1] * (g[U, i] * g[V, j] + g[V, i] * g[U, j])
                blocks[e, i, j] = parameters[e, STRENGTH] * entry


class PullToSurface(Pull):
    """Particles pulled to the closest point C of a NURBS surface that itself stays where it is: E = S |C - x|^2 / 2.

    The surface is exact: spheres, cylinders and tori are what they are, not a mesh, and nothing holds a particle back
    along it. It is given by its degrees, rows of control points, knots and weights; in Python `on` makes the force from
    a rhino3dm surface, an untrimmed face or a `discretize.NurbsSurface`. Knots are those of the textbook or Rhino's,
    without the first and the last. Trims do not count. The search starts at the nearest cell of a mesh of the surface
    and goes downhill by Newton's method, over creases and closed seams, to an edge at most; where two points are nearly
    as close, it may find the other one. A particle rests at a distance load / S from the surface; a strength of 0 has
    no effect (it is not a hard constraint). Source: Piegl and Tiller, The NURBS Book, 1997, chapters 2, 4 and 6.1
    (evaluation, point projection).
    """

    kind: Literal["pull_to_surface"] = "pull_to_surface"
    mesh: str | None = Field(default=None, description="Name of a mesh whose vertices are pulled")
    control_points: PointRows = Field(description="Control points of the surface [length], a row for each step along u")
    knots_u: Table = Field(description="Knots along u [-], in ascending order")
    knots_v: Table = Field(description="Knots along v [-], in ascending order")
    degree_u: int = Field(default=3, ge=1, le=25, description="Degree along u [-]")
    degree_v: int = Field(default=3, ge=1, le=25, description="Degree along v [-]")
    weights: Maybe[Table] = Field(default=None, description="Weights of the control points [-]; default: all are 1")
    strength: NonNegatives = Field(default=1000.0, description="S [force/length]")

    formula: ClassVar[str] = "E = S |C - x|²/2"
    shared: ClassVar[tuple[str, ...]] = ("control_points", "knots_u", "knots_v", "weights")
    kernel: ClassVar[Any] = staticmethod(surface_kernel)
    hessian: ClassVar[Any] = staticmethod(surface_hessian)

    @model_validator(mode="after")
    def _is_a_surface(self) -> Self:
        try:
            self.surface()
        except InputError as error:
            at = error.pointer.replace("points", "control_points")
            raise fault(error.sentence, f"/{at}") from None
        return self

    @classmethod
    def on(cls, surface: Any, **fields: Any) -> Self:
        """The force for a rhino3dm surface or untrimmed face, a `NurbsSurface` or a mapping of one's numbers."""
        given = as_nurbs_surface(surface)
        numbers = {name: getattr(given, name) for name in ("degree_u", "degree_v", "knots_u", "knots_v", "weights")}
        return cls(control_points=given.points, **numbers, **fields)

    def surface(self) -> NurbsSurface:
        """The surface; InputError for numbers that do not fit each other."""
        return nurbs_surface(
            self.degree_u, self.degree_v, self.control_points, self.knots_u, self.knots_v, self.weights
        )

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: strength, and addresses and rows of the tables of cells and of the surface."""
        index = places.elements(self)
        each, (triangles, table) = np.ones((len(index), 1)), tables(self.surface())
        kept = [keep(table), float(len(table))]
        return Block.of(index, strength=self.strength, tree=each * tree(triangles), table=each * kept)

    @classmethod
    def example(cls) -> tuple[PullToSurface, Floats]:
        """Four particles about a rational surface with a bump: over it, beyond an edge, off a corner, below it."""
        i, j = np.meshgrid(np.arange(4.0), np.arange(3.0), indexing="ij")
        surface = {
            "degree_u": 2,
            "degree_v": 2,
            "control_points": np.stack([2.0 * i - 3.0, 2.0 * j - 2.0, 0.4 * i * j * (3.0 - i)], axis=2),
            "knots_u": np.arange(7.0),
            "knots_v": np.arange(6.0),
            "weights": 1.0 + 0.3 * (i == j),
        }
        x = np.array([[0.3, -0.2, 2.5], [0.4, 4.0, 0.9], [-5.0, -4.0, 1.0], [0.9, 0.4, -1.0]])
        return cls(particles=range(4), strength=[100.0, 20.0, 3.0, 50.0], **surface), x
