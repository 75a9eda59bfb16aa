"""Natives about edges and control points, by what they are in geometry."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import rhino3dm

from canvas.native_values import made, near, plain
from hookean_canvas.run.natives import BY_NAME, Unfit, shapes


def run(name: str, *given: Any) -> Any:
    return BY_NAME[name].run(*given)


def line(*corners: tuple[float, float, float]) -> Any:
    """A line or polyline."""
    return shapes.polyline(corners)


def test_edges_of_a_cylinder_its_box_and_a_plane_are_told_apart_by_their_faces() -> None:
    """An open cylinder: two rims, and a seam between a face and itself. A box: no naked edge. A sheet: four."""
    cylinder = rhino3dm.Brep.CreateFromCylinder(rhino3dm.Cylinder(rhino3dm.Circle(1.0), 2.0), False, False)
    assert [len(edges) for edges in run("Brep Edges", cylinder)] == [2, 1, 0]
    box = rhino3dm.Brep.CreateFromBoundingBox(rhino3dm.BoundingBox(0, 0, 0, 1, 2, 3))
    assert [len(edges) for edges in run("Brep Edges", box)] == [0, 12, 0]
    sheet = run("Ruled Surface", line((0, 0, 0), (2, 0, 0)), line((0, 1, 0), (2, 1, 0)))[0]
    naked, *_ = run("Brep Edges", sheet)
    assert near(sorted(run("Length", edge)[0] for edge in naked), [1, 1, 2, 2])


def hypar(u: float, v: float) -> tuple[float, float, float]:
    return (u, v, u * v)


def parabolic(u: float, v: float) -> tuple[float, float, float]:
    """Coons' surface of four parabolas is z = f(u) + g(v): it has no term that couples them."""
    return (u, v, u * (1 - u) + 2 * v * (1 - v))


@pytest.mark.parametrize("surface", [hypar, parabolic])
def test_a_surface_between_edges_is_that_of_coons_in_any_order(surface: Callable[..., Any]) -> None:
    """Of straight edges the hypar, exactly; of curved ones to the chords of 32 pieces, below 2 / (8 x 32^2)."""
    steps = np.linspace(0, 1, 33 if surface is parabolic else 2)
    sides = [
        [surface(t, 0) for t in steps], [surface(t, 1) for t in steps[::-1]], [surface(1, t) for t in steps],
        [surface(0, t) for t in steps],
    ]  # fmt: skip
    (found,) = run("Edge Surface", *(line(*side) for side in sides))
    places = [found.PointAt(a, b) for a in (0.0, 0.25, 0.5, 1.0) for b in (0.0, 0.5, 0.75, 1.0)]
    for x, y, z in ((p.X, p.Y, p.Z) for p in places):
        assert z == pytest.approx(surface(x, y)[2], abs=1e-12 if surface is hypar else 2 / (8 * 32**2) * 3)
    with pytest.raises(Unfit, match="do not meet"):
        run("Edge Surface", *(line(*side) for side in (sides[0], sides[2], [(5, 5, 5), (6, 5, 5)])), None)


def test_a_sphere_has_the_control_points_of_its_half_circles() -> None:
    """Piegl and Tiller 1997, 7.3: a circle of nine points with weights 1 and sqrt(1/2), in rows of five."""
    sphere = rhino3dm.NurbsSurface.CreateFromSphere(rhino3dm.Sphere(rhino3dm.Point3d(0, 0, 0), 1.0))
    points, weights, greville, nu, nv = run("Surface Points", sphere)
    assert (nu, nv) == (9, 5) and len(points) == len(greville) == 45
    assert near(sorted(set(np.round(weights, 12))), [0.5, 0.5**0.5, 1.0])
    assert near(max(abs(p.Z) for p in points), 1.0) and near(max(abs(p.X) for p in points), 1.0)


def test_pieces_parts_and_copies() -> None:
    short, first, long, last = run("Segment Lengths", line((0, 0, 0), (3, 0, 0), (3, 1, 0), (3, 1, 5)))
    assert (short, long) == (1.0, 5.0) and (first.T0, last.T0) == (1.0, 2.0)
    assert run("Text Split", "a, b;c", ",; ")[0] == ["a", "b", "c"]
    cell = shapes.polyline([(0, 0, 0), (2, 0, 0), (2, 3, 0), (0, 3, 0)], closed=True)
    copies, changes = run("Rectangular Array", made(("point", 1, 1, 0)), cell, 2, 2)
    assert near(plain(copies), [(1, 1, 0), (3, 1, 0), (1, 4, 0), (3, 4, 0)]) and len(changes) == 4
