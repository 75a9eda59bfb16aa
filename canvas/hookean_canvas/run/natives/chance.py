"""Natives that draw by chance: the same seed gives the same values, other ones than in Grasshopper."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from hookean.discretize import curves as arc_lengths
from hookean_canvas.run.natives import shapes
from hookean_canvas.run.natives.declare import Unfit, native
from hookean_canvas.run.natives.measures import surface_mesh
from hookean_canvas.run.natives.shapes import Array
from hookean_canvas.run.rhino import rhino3dm

MOST = 20_000  # points that are spread in one run: the time grows with the square of it
CANDIDATES = 10  # places that are tried for each point
FINE = 1000  # pieces of a curve that points are spread along
_OTHER = "other values than in Grasshopper, the same in every run"
_SPREAD = "Count (N): integer = 100; Seed (S): integer = 0; Points (P): point list optional"


def _generator(seed: int) -> np.random.Generator:
    return np.random.default_rng(seed % 2**64)


@native("2ab17f9a-d852-4405-80e1-938c5e57e78d", "Random", "Random",
        "Range (R): domain = (0.0, 1.0); Number (N): integer = 10; Seed (S): integer = 1", "Random (nums): list",
        remark=_OTHER)  # fmt: skip
def random(of: Any, count: int, seed: int) -> list[float]:
    """Numbers of a domain, each as likely as another."""
    _counted(count)
    low, high = of.T0, of.T1
    return [float(low + (high - low) * t) for t in _generator(seed).random(count)]


@native("455925fd-23ff-4e57-a0e7-913a4165e659", "Random Reduce", "Reduce",
        "List (L): any list; Reduction (R): integer = 0; Seed (S): integer = 0", "List (L): list",
        remark=_OTHER)  # fmt: skip
def random_reduce(values: list[Any], fewer: int, seed: int) -> list[Any]:
    """A list without a number of its items, chosen by chance."""
    if fewer < 0:
        raise Unfit("Reduction must not be negative")
    kept = _generator(seed).permutation(len(values))[min(fewer, len(values)) :]
    return [values[i] for i in sorted(kept.tolist())]


@native("f02a20f6-bb49-4e3d-b155-8ed5d3c6b000", "Jitter", "Jitter",
        "List (L): any list; Jitter (J): number = 1.0; Seed (S): integer = 1", "Values (V): list; Indices (I): list",
        remark=_OTHER)  # fmt: skip
def jitter(values: list[Any], strength: float, seed: int) -> tuple[list[Any], list[int]]:
    """A list in another order, by chance: 0 leaves it, at 1 any order is as likely; and where each item was."""
    if not 0.0 <= strength <= 1.0:
        raise Unfit("Jitter must be between 0 and 1")
    places = np.arange(len(values)) / max(len(values), 1)
    found = np.argsort((1.0 - strength) * places + strength * _generator(seed).random(len(values)), kind="stable")
    return [values[i] for i in found.tolist()], found.tolist()


@native("e2d958e8-9f08-44f7-bf47-a684882d0b2a", "Populate 2D", "Pop2D", f"Region (R): rectangle; {_SPREAD}",
        "Population (P): list", remark=_OTHER)  # fmt: skip
def populate_rectangle(region: Any, count: int, seed: int, given: list[Any] | None) -> list[Any]:
    """Points in a rectangle, far from each other."""
    frame, width, height = region
    return _spread(lambda draw: shapes.in_plane(frame, draw[:, :2] * (width, height)), count, seed, given)


@native("e202025b-dc8e-4c51-ae19-4415b172886f", "Populate 3D", "Pop3D", f"Region (R): box; {_SPREAD}",
        "Population (P): list", remark=_OTHER)  # fmt: skip
def populate_box(region: Any, count: int, seed: int, given: list[Any] | None) -> list[Any]:
    """Points in a box along the world's axes, far from each other."""
    low, high = shapes.xyz(region.Min), shapes.xyz(region.Max)
    return _spread(lambda draw: low + (high - low) * draw, count, seed, given)


@native("c8cb6a5c-2ffd-4095-ba2a-5c35015e09e4", "Populate Geometry", "PopGeo", f"Geometry (G): geometry; {_SPREAD}",
        "Population (P): list", remark=_OTHER)  # fmt: skip
def populate_geometry(geometry: Any, count: int, seed: int, given: list[Any] | None) -> list[Any]:
    """Points on a mesh, a surface, a Brep or a curve, far from each other."""
    if isinstance(geometry, rhino3dm.Line):
        geometry = rhino3dm.LineCurve(geometry.From, geometry.To)
    on = _along(geometry) if isinstance(geometry, rhino3dm.Curve) else _across(geometry)
    return _spread(on, count, seed, given)


def _along(curve: Any) -> Callable[[Array], Array]:
    """Points of a curve for numbers from 0 to 1, by its length."""
    places = np.asarray(arc_lengths.divide(curve, FINE))
    steps = np.linspace(0.0, 1.0, len(places))
    return lambda draw: np.column_stack([np.interp(draw[:, 0], steps, column) for column in places.T])


def _across(geometry: Any) -> Callable[[Array], Array]:
    """Points of the triangles of a mesh for numbers from 0 to 1, by their areas."""
    a, b, c = surface_mesh(geometry)
    sums = np.cumsum(np.linalg.norm(np.cross(b - a, c - a), axis=1))
    if not sums[-1] > 0.0:
        raise Unfit("the area is zero")

    def on(draw: Array) -> Array:
        which = np.minimum(np.searchsorted(sums, draw[:, 0] * sums[-1], side="right"), len(sums) - 1)
        u, v = draw[:, 1:2], draw[:, 2:3]
        u, v = np.where(u + v > 1.0, 1.0 - u, u), np.where(u + v > 1.0, 1.0 - v, v)
        found: Array = a[which] + u * (b - a)[which] + v * (c - a)[which]
        return found

    return on


def _counted(count: int) -> None:
    if not 0 <= count <= MOST:
        raise Unfit(f"the number must be from 0 to {MOST}")


def _spread(on: Callable[[Array], Array], count: int, seed: int, given: list[Any] | None) -> list[Any]:
    """Points one by one, each the candidate that is farthest from those before (Mitchell, SIGGRAPH 1991)."""
    _counted(count)
    generator, before = _generator(seed), shapes.rows(place for place in given or [] if place is not None)
    found = np.concatenate([before.reshape(-1, 3), np.empty((count, 3))])
    for i in range(len(found) - count, len(found)):
        places = on(generator.random((CANDIDATES, 3)))
        if i:
            apart = ((places[:, None] - found[None, :i]) ** 2).sum(axis=2).min(axis=1)
            found[i] = places[int(apart.argmax())]
        else:
            found[i] = places[0]
    return shapes.points(found[len(found) - count :])
