"""Draws the .3dm model of the concert hall ribbon, figure 9.32: two beams, eleven arcs and a surface through them.

Run it from the project's root: `.venv/bin/python gh_examples/models_ribbon.py`. The same version of rhino3dm writes the
same bytes.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import rhino3dm
from numpy.typing import NDArray
from scipy.interpolate import make_interp_spline

from hookean.files.rhino.threedm import Additions, NewLayer, NewObject, write_new

HERE = Path(__file__).parent
ARCS = 11
Floats = NDArray[np.float64]


def profiles() -> Floats:
    """Control points (arc, 5, 3) [m] of the arcs, each in a vertical plane across the way of the ribbon."""
    t = np.linspace(0.0, 1.0, ARCS)
    turn = 2.0 * np.pi * t
    sway = 0.95 * turn + 0.4
    foot = np.stack([26.0 * (t - 0.5), 4.0 * np.sin(sway), np.zeros(ARCS)], axis=1)
    way = np.stack([np.full(ARCS, 26.0), 4.0 * 1.9 * np.pi * np.cos(sway)], axis=1)
    way /= np.linalg.norm(way, axis=1)[:, None]
    across = np.stack([-way[:, 1], way[:, 0], np.zeros(ARCS)], axis=1)
    low = 0.7 - 0.6 * np.cos(1.2 * turn + 0.3)
    high = 6.2 + 1.7 * np.cos(1.1 * turn - 1.9)
    lean = -2.6 * np.sin(sway)
    bulge = 3.2 * np.sin(sway)
    # along the arc: height from low to high, and how much of the lean and of the bulge
    shares = np.array([[0.0, 0.0, 0.0], [0.15, 0.0, 0.6], [0.6, 0.1, 1.05], [1.0, 0.4, 0.75], [1.0, 1.0, 0.0]])
    points = np.repeat(foot[:, None, :], 5, axis=1)
    points += (lean[:, None] * shares[:, 1] + bulge[:, None] * shares[:, 2])[..., None] * across[:, None, :]
    points[..., 2] += low[:, None] + (high - low)[:, None] * shares[:, 0]
    return points


def through(points: Floats) -> tuple[Floats, Floats]:
    """Control points and knots, as Rhino counts them, of the cubic spline through points at parameters 0, 1, 2 ..."""
    spline = make_interp_spline(np.arange(len(points)), points, k=3, axis=0)
    return spline.c, spline.t[1:-1]


def nurbs_curve(points: Floats, knots: Floats) -> Any:
    made = rhino3dm.NurbsCurve(3, len(points))
    for i, (x, y, z) in enumerate(points.tolist()):
        made.Points[i] = rhino3dm.Point4d(x, y, z, 1.0)
    for i, value in enumerate(knots.tolist()):
        made.Knots[i] = value
    return made


def nurbs_surface(points: Floats, along: Floats, up: Floats) -> Any:
    nu, nv = points.shape[:2]
    made = rhino3dm.NurbsSurface.Create(3, False, 4, 4, nu, nv)
    for i in range(nu):
        for j in range(nv):
            made.Points[i, j] = rhino3dm.Point4d(*points[i, j].tolist(), 1.0)
    for knots, values in ((made.KnotsU, along), (made.KnotsV, up)):
        for i, value in enumerate(values.tolist()):
            knots[i] = value
    return made


def ribbon() -> None:
    """Figure 9.32. The arcs are curves v of the surface at u = 0, 1 .. 10, the beams its two long edges."""
    arcs = profiles()
    up = np.array([0.0, 0.0, 0.0, 0.5, 1.0, 1.0, 1.0])
    points, along = through(arcs)
    beams = {"lower beam": points[:, 0], "upper beam": points[:, -1]}
    write_new(
        HERE / "9.32-ribbon" / "model.3dm",
        Additions(
            layers=(
                NewLayer("beams", colour=(20, 20, 20, 255)),
                NewLayer("arcs", colour=(150, 60, 40, 255)),
                NewLayer("inner", "arcs", (150, 60, 40, 255)),
                NewLayer("ends", "arcs", (200, 120, 40, 255)),
                NewLayer("membrane", colour=(40, 90, 160, 255)),
            ),
            objects=(
                *(NewObject(nurbs_curve(p, along), layer="beams", name=name) for name, p in beams.items()),
                *(
                    NewObject(
                        nurbs_curve(p, up),
                        layer="arcs::ends" if i in (0, ARCS - 1) else "arcs::inner",
                        name=f"arc {i + 1}",
                    )
                    for i, p in enumerate(arcs)
                ),
                NewObject(nurbs_surface(points, along, up), layer="membrane", name="ribbon"),
            ),
        ),
        own=False,
    )


if __name__ == "__main__":
    ribbon()
