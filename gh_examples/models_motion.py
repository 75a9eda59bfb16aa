"""Draws the .3dm models of cables and of what moves while it runs, figures 9.4, 9.6, 9.7 and 9.26 and the sail, and
makes the wind for it.

Run it from the project's root: `.venv/bin/python gh_examples/models_motion.py`. The same version of rhino3dm writes the
same bytes.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import rhino3dm

from hookean.files.rhino.threedm import Additions, NewLayer, NewObject, write_new

HERE = Path(__file__).parent


def cables() -> None:
    """Figures 9.4, 9.6 and 9.7: a straight line of 10 m; for 9.7 a point at each end as well."""
    line = rhino3dm.LineCurve(rhino3dm.Point3d(0, 0, 0), rhino3dm.Point3d(10, 0, 0)).ToNurbsCurve()
    _write("9.4-cable", cable=[line])
    _write("9.6-bouncing", cable=[line])
    _write("9.7-anchors-moved", cable=[line], left=[_point(0, 0, 0)], right=[_point(10, 0, 0)])


def membrane() -> None:
    """Figure 9.26: a flat square NURBS surface of 10 m, and points at its corners: two that rise, two that sink."""
    _write(
        "9.26-membrane-anchors-moved",
        membrane=[_surface(10.0, 0.0, 0.0)],
        rising=[_point(0, 0, 0), _point(10, 10, 0)],
        sinking=[_point(10, 0, 0), _point(0, 10, 0)],
    )


def sail() -> None:
    """The sail: a ruled NURBS surface over a square of 6 m, two corners at 2.5 m and two at 4.5 m."""
    _write("wind", sail=[_surface(6.0, 2.5, 4.5)])


def wind() -> None:
    """wind.csv, made by formula and not measured: two waves about 8 m/s, a gust at 20 s that adds 1 - cos of 4 s, and
    from 28 s on a steady 12 m/s."""
    t = np.arange(0.0, 44.01, 0.5)
    waves = 8.0 + 2.0 * np.sin(2 * np.pi * t / 14.0) + 1.2 * np.sin(2 * np.pi * t / 4.7 + 1.0)
    gust = np.where(np.abs(t - 20.0) < 2.0, 4.0 * (1.0 + np.cos(np.pi * (t - 20.0) / 2.0)), 0.0)
    speed = np.where(t < 28.0, waves + gust, 12.0)
    rows = [f"{a:.1f},{b:.1f}" for a, b in zip(t, speed, strict=True)]
    text = "\n".join(["time [s],speed [m/s]", *rows, ""])
    (HERE / "wind" / "wind.csv").write_text(text, encoding="utf-8", newline="\n")


def _surface(side: float, low: float, high: float) -> Any:
    """A bicubic NURBS surface over a square, ruled both ways between corners `low` and `high`."""
    surface = rhino3dm.NurbsSurface.Create(3, False, 4, 4, 4, 4)
    for i in range(4):
        for j in range(4):
            u, v = i / 3.0, j / 3.0
            z = low + (high - low) * (u + v - 2.0 * u * v)
            surface.Points[i, j] = rhino3dm.Point4d(side * u, side * v, z, 1.0)
    for k, value in enumerate([0.0, 0.0, 0.0, 1.0, 1.0, 1.0]):
        surface.KnotsU[k] = value
        surface.KnotsV[k] = value
    return surface


def _point(x: float, y: float, z: float) -> Any:
    return rhino3dm.Point(rhino3dm.Point3d(x, y, z))


def _write(folder: str, **drawn: list[Any]) -> None:
    colours = [(40, 90, 160, 255), (180, 60, 40, 255), (60, 130, 70, 255)]
    layers = tuple(NewLayer(name, colour=colours[i]) for i, name in enumerate(drawn))
    objects = tuple(NewObject(item, layer=name, name=name) for name, items in drawn.items() for item in items)
    write_new(HERE / folder / "model.3dm", Additions(layers=layers, objects=objects), own=False)


if __name__ == "__main__":
    cables()
    membrane()
    sail()
    wind()
