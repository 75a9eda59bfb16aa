"""Draws the .3dm models of the membranes, figures 9.27 to 9.31: what a person would draw in Rhino before starting.

Run it from the project's root: `.venv/bin/python gh_examples/models_membranes.py`. The same version of rhino3dm writes
the same bytes.
"""

from __future__ import annotations

from pathlib import Path

import rhino3dm
from build_models import square

from hookean.files.rhino.threedm import Additions, NewLayer, NewObject, write_new

HERE = Path(__file__).parent
SIDE = 10.0  # m
MEMBRANE = NewLayer("membrane", colour=(40, 90, 160, 255))


def frame() -> rhino3dm.NurbsSurface:
    """A surface in the frame of a hypar, z = x y on the rim of the square from -1 to 1 m, with a bulge inside."""
    surface = rhino3dm.NurbsSurface.Create(3, False, 3, 3, 3, 3)
    for i, x in enumerate((-1.0, 0.0, 1.0)):
        for j, y in enumerate((-1.0, 0.0, 1.0)):
            surface.Points[i, j] = rhino3dm.Point4d(x, y, x * y + (2.0 if i == j == 1 else 0.0), 1.0)
    for k, value in enumerate([0.0, 0.0, 1.0, 1.0]):
        surface.KnotsU[k] = value
        surface.KnotsV[k] = value
    return surface


def strips(other: bool) -> list[rhino3dm.PolylineCurve]:
    """Diagonals of 10 x 10 squares, one of each, joined to polylines: rising with x, or falling."""
    n = 10
    drawn = []
    for shift in range(1 - n, n):
        first, last = max(0, shift), min(n, n + shift)
        path = [(i, (n - (i - shift)) if other else i - shift) for i in range(first, last + 1)]
        line = rhino3dm.Polyline()
        for i, j in path:
            line.Add(SIDE * i / n, SIDE * j / n, 0.0)
        drawn.append(line.ToPolylineCurve())
    return drawn


def write(folder: str, layers: list[NewLayer], objects: list[NewObject]) -> None:
    target = HERE / folder / "model.3dm"
    target.parent.mkdir(exist_ok=True)
    write_new(target, Additions(layers=tuple(layers), objects=tuple(objects)), own=False)


def naked_vertices() -> None:
    """Figure 9.27: the square, its corners and four points inside it."""
    places = [(0, 0), (10, 0), (10, 10), (0, 10), (3, 3), (7, 3), (7, 7), (3, 7)]
    points = [NewObject(rhino3dm.Point(rhino3dm.Point3d(x, y, 0)), layer="anchors") for x, y in places]
    anchors = NewLayer("anchors", colour=(34, 48, 60, 255))
    write("9.27-naked-vertices", [MEMBRANE, anchors], [NewObject(square(), layer="membrane"), *points])


def rest_factor_zero() -> None:
    """Figure 9.28: a surface whose rim is the frame."""
    write("9.28-rest-factor-zero", [MEMBRANE], [NewObject(frame(), layer="membrane", name="bulge")])


def diagonals() -> None:
    """Figures 9.29 and 9.31: the square with one diagonal of each face drawn, one way and the other."""
    one, other = NewLayer("one way", colour=(194, 53, 43, 255)), NewLayer("other way", colour=(42, 157, 92, 255))
    lines = [NewObject(c, layer=y.name) for y, way in ((one, False), (other, True)) for c in strips(way)]
    for folder in ("9.29-diagonals", "9.31-diagonal-patterns"):
        write(folder, [MEMBRANE, one, other], [NewObject(square(), layer="membrane"), *lines])


def creases() -> None:
    """Figure 9.30: the square alone; its diagonals come from its division."""
    write("9.30-creases", [MEMBRANE], [NewObject(square(), layer="membrane", name="sheet")])


if __name__ == "__main__":
    naked_vertices()
    rest_factor_zero()
    diagonals()
    creases()
