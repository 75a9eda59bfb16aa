"""Draws the .3dm models of the examples: what a person would draw in Rhino before starting.

Run it from the project's root: `.venv/bin/python gh_examples/build_models.py`. The same version of rhino3dm writes the
same bytes.
"""

from __future__ import annotations

from pathlib import Path

import rhino3dm

from hookean.files.rhino.threedm import Additions, NewLayer, NewObject, write_new

HERE = Path(__file__).parent


def square() -> rhino3dm.NurbsSurface:
    """A flat square of degree 3, 10 m wide, with even parameters: divided, its faces are squares."""
    surface = rhino3dm.NurbsSurface.Create(3, False, 4, 4, 4, 4)
    for i in range(4):
        for j in range(4):
            surface.Points[i, j] = rhino3dm.Point4d(10.0 * i / 3.0, 10.0 * j / 3.0, 0.0, 1.0)
    for k, value in enumerate([0.0, 0.0, 0.0, 1.0, 1.0, 1.0]):
        surface.KnotsU[k] = value
        surface.KnotsV[k] = value
    return surface


def membrane() -> None:
    """Figure 9.24: the square alone."""
    write_new(
        HERE / "9.24-membrane" / "model.3dm",
        Additions(
            layers=(NewLayer("membrane", colour=(40, 90, 160, 255)),),
            objects=(NewObject(square(), layer="membrane", name="roof"),),
        ),
        own=False,
    )


if __name__ == "__main__":
    membrane()
