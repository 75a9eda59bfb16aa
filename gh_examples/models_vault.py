"""Draws the model of the hanging vault: a flat net with its columns, and a chain beside it.

Run it from the project's root: `.venv/bin/python gh_examples/models_vault.py`. The same version of rhino3dm writes the
same bytes.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import rhino3dm
from scipy.optimize import brentq

from hookean.files.rhino.threedm import Additions, NewLayer, NewObject, write_new

HERE = Path(__file__).parent
LENGTH, WIDTH, SPAN, CHAIN = 20.0, 14.0, 16.0, 19.2  # m


def net() -> rhino3dm.NurbsSurface:
    """A flat NURBS surface of 20 x 14 m, degree 1."""
    surface = rhino3dm.NurbsSurface.Create(3, False, 2, 2, 2, 2)
    for i in range(2):
        for j in range(2):
            surface.Points[i, j] = rhino3dm.Point4d(LENGTH * i, WIDTH * j, 0.0, 1.0)
    for k in range(2):
        surface.KnotsU[k] = surface.KnotsV[k] = float(k)
    return surface


def arc() -> rhino3dm.NurbsCurve:
    """An arc of 19.2 m between ends 16 m apart that hangs down, 5 m in front of the net."""
    half = brentq(lambda angle: np.sin(angle) / angle - SPAN / CHAIN, 0.1, 3.0)
    sag = 0.5 * SPAN * np.tan(0.5 * half)
    left = 0.5 * (LENGTH - SPAN)
    places = [(left, 0.0), (left + 0.5 * SPAN, -sag), (left + SPAN, 0.0)]
    return rhino3dm.Arc(*(rhino3dm.Point3d(x, -5.0, z) for x, z in places)).ToNurbsCurve()


def hanging_vault() -> None:
    """The net, nine columns at its corners, on its sides and in its middle, and a chain of 19.2 m over 16 m."""
    columns = [(x, y) for x in LENGTH * np.array([0.0, 0.5, 1.0]) for y in WIDTH * np.array([0.0, 0.5, 1.0])]
    points = [NewObject(rhino3dm.Point(rhino3dm.Point3d(x, y, 0.0)), "columns", name="column") for x, y in columns]
    chain = NewObject(arc(), layer="chain", name="chain")
    write_new(
        HERE / "hanging-vault" / "model.3dm",
        Additions(
            layers=(
                NewLayer("net", colour=(40, 90, 160, 255)),
                NewLayer("columns", colour=(190, 60, 40, 255)),
                NewLayer("chain", colour=(60, 60, 60, 255)),
            ),
            objects=(NewObject(net(), layer="net", name="roof"), *points, chain),
        ),
        own=False,
    )


if __name__ == "__main__":
    hanging_vault()
