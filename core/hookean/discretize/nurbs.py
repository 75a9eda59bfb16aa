"""NURBS curves and surfaces as plain numbers: what a program without rhino3dm or COMPAS can send.

Knots are those of the textbook, points + degree + 1 of them, or Rhino's, which leave out the first and the last: they
shape nothing. Source: Piegl and Tiller, The NURBS Book, 1997, chapters 2 to 4.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hookean.errors import InputError

Array = NDArray[np.float64]
HIGHEST = 25  # degree


@dataclass(frozen=True, eq=False)
class NurbsCurve:
    """A curve of a degree: points `(n, 3)` [length], weights `(n,)` [-], knots `(n + degree + 1,)`.

    Every function of `hookean.discretize` that takes a curve takes it.
    """

    degree: int
    points: Array
    weights: Array
    knots: Array

    @property
    def knotvector(self) -> Array:
        """The knots, none left out."""
        return self.knots


@dataclass(frozen=True, eq=False)
class NurbsSurface:
    """A surface: points `(m, n, 3)` [length], weights `(m, n)` [-], a degree and knots for each direction.

    Every function of `hookean.discretize` that takes a surface takes it.
    """

    degree_u: int
    degree_v: int
    points: Array
    weights: Array
    knots_u: Array
    knots_v: Array

    @property
    def domain_u(self) -> tuple[float, float]:
        """First and last parameter in the first direction."""
        return _domain(self.knots_u, self.degree_u)

    @property
    def domain_v(self) -> tuple[float, float]:
        """First and last parameter in the second direction."""
        return _domain(self.knots_v, self.degree_v)

    def points_at(self, u: ArrayLike, v: ArrayLike) -> Array:
        """Points `(a, b, 3)` [length] at parameters `(a,)` and `(b,)` within the domains."""
        four = np.concatenate([self.points * self.weights[..., None], self.weights[..., None]], axis=2)
        along_u = _basis(self.knots_u, self.degree_u, u)
        along_v = _basis(self.knots_v, self.degree_v, v)
        found = np.einsum("am,mnk,bn->abk", along_u, four, along_v, optimize=True)
        return np.asarray(found[..., :3] / found[..., 3:])

    def point_at(self, u: float, v: float) -> Array:
        """The point `(3,)` [length] at one pair of parameters."""
        found: Array = self.points_at([u], [v])[0, 0]
        return found


def nurbs_curve(degree: Any, points: Any, knots: Any, weights: Any = None) -> NurbsCurve:
    """A curve of these numbers, checked; without weights they are all 1. Raises InputError naming what does not fit."""
    xyz = _array(points, "points", 2)
    p = _degree(degree, "degree", len(xyz))
    return NurbsCurve(p, xyz, _weights(weights, xyz.shape[:1]), _knots(knots, "knots", len(xyz), p))


def nurbs_surface(
    degree_u: Any, degree_v: Any, points: Any, knots_u: Any, knots_v: Any, weights: Any = None
) -> NurbsSurface:
    """A surface of these numbers, checked; without weights they are all 1. Raises InputError naming what does not fit.

    `points` have a row for each step in the first direction, u.
    """
    xyz = _array(points, "points", 3)
    rows, columns = xyz.shape[:2]
    p, q = _degree(degree_u, "degree_u", rows), _degree(degree_v, "degree_v", columns)
    of_u, of_v = _knots(knots_u, "knots_u", rows, p), _knots(knots_v, "knots_v", columns, q)
    return NurbsSurface(p, q, xyz, _weights(weights, (rows, columns)), of_u, of_v)


def as_nurbs_surface(surface: Any) -> NurbsSurface:
    """A `NurbsSurface`, the NURBS form of a rhino3dm surface or untrimmed face, or of a mapping with the arguments of
    `nurbs_surface`, checked. Raises InputError naming what does not fit."""
    if isinstance(surface, NurbsSurface):
        return surface
    if isinstance(surface, Mapping):
        return _of_mapping(surface)
    nurbs = getattr(surface, "UnderlyingSurface", lambda: surface)()
    nurbs = nurbs.ToNurbsSurface() if hasattr(nurbs, "ToNurbsSurface") else None
    if nurbs is None:
        said = "is not a surface; give degree_u, degree_v, points, knots_u, knots_v and weights, or a rhino3dm surface"
        raise InputError("", f"{type(surface).__name__} {said}")
    count_u, count_v = nurbs.Points.CountU, nurbs.Points.CountV
    found = [nurbs.Points.GetControlPoint(i, j) for i in range(count_u) for j in range(count_v)]
    four = np.array([[p.X, p.Y, p.Z, p.W] for p in found]).reshape(count_u, count_v, 4)
    points, weights = four[..., :3] / four[..., 3:], four[..., 3]  # rhino3dm has points times weights
    knots = list(nurbs.KnotsU), list(nurbs.KnotsV)
    return nurbs_surface(int(nurbs.Degree(0)), int(nurbs.Degree(1)), points, *knots, weights)


def _of_mapping(given: Mapping[str, Any]) -> NurbsSurface:
    names = ("degree_u", "degree_v", "points", "knots_u", "knots_v")
    lost, odd = [n for n in names if n not in given], [n for n in given if n not in (*names, "weights")]
    if lost or odd:
        said = f"{lost[0]} is missing" if lost else f"a surface has no {odd[0]!r}"
        raise InputError("", f"{said}; a surface has {', '.join(names)} and weights")
    return nurbs_surface(**given)


def _array(value: Any, name: str, dimensions: int) -> Array:
    try:
        found = np.array(value, dtype=np.float64)
    except (TypeError, ValueError):
        raise InputError(name, "is not a table of numbers; give numbers in rows of one length") from None
    if found.ndim != dimensions or (dimensions > 1 and found.shape[-1] != 3):
        wanted = {1: "a row of numbers", 2: "rows of x, y, z", 3: "rows of rows of x, y, z"}[dimensions]
        raise InputError(name, f"has the shape {list(found.shape)}; {wanted} expected")
    if not np.isfinite(found).all():
        raise InputError(name, "has a number that is not finite; give finite numbers")
    return found


def _degree(value: Any, name: str, count: int) -> int:
    if isinstance(value, bool) or not isinstance(value, int | np.integer) or not 1 <= value <= HIGHEST:
        raise InputError(name, f"{value!r} given; a whole number from 1 to {HIGHEST} expected")
    if count <= value:
        raise InputError("points", f"{count} points for degree {value} in one direction; at least {value + 1} expected")
    return int(value)


def _weights(value: Any, shape: tuple[int, ...]) -> Array:
    if value is None:
        return np.ones(shape)
    found = np.asarray(value, dtype=np.float64)
    if found.shape != shape:
        said = f"have the shape {list(found.shape)}; one for each point, {list(shape)}, expected"
        raise InputError("weights", said)
    if (odd := found[~(np.isfinite(found) & (found > 0.0))]).size:
        raise InputError("weights", f"contain {odd[0]:g}; positive numbers expected")
    return found


def _knots(value: Any, name: str, count: int, degree: int) -> Array:
    found = _array(value, name, 1)
    if len(found) == count + degree - 1:
        found = np.concatenate([found[:1], found, found[-1:]])
    if len(found) != count + degree + 1:
        least = count + degree - 1
        said = f"{len(found)} knots for {count} points of degree {degree}; {least + 2} expected, or Rhino's {least}"
        raise InputError(name, said)
    if (np.diff(found) < 0.0).any() or not found[degree] < found[-degree - 1]:
        raise InputError(name, "do not ascend; give knots in ascending order over a domain with a length")
    return found


def _domain(knots: Array, degree: int) -> tuple[float, float]:
    return float(knots[degree]), float(knots[-degree - 1])


def _basis(knots: Array, degree: int, at: ArrayLike) -> Array:
    """Values `(a, n)` of the n basis functions at parameters `(a,)`."""
    from scipy.interpolate import BSpline

    low, high = _domain(knots, degree)
    matrix = BSpline.design_matrix(np.clip(np.asarray(at, dtype=np.float64), low, high), knots, degree)
    return np.asarray(matrix.toarray())
