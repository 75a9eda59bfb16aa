"""Draws the .3dm models of the catenaries, figures 9.17 to 9.22, and writes the chains of figures 9.14 and 9.16.

Run it from the project's root: `.venv/bin/python gh_examples/models_catenary.py`. The same version of rhino3dm writes
the same bytes.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import rhino3dm
from numpy.typing import NDArray
from scipy.interpolate import make_interp_spline
from scipy.optimize import brentq

from hookean.discretize.curves import divide
from hookean.files.rhino.threedm import Additions, NewLayer, NewObject, write_new

HERE = Path(__file__).parent
Floats = NDArray[np.float64]

CHAINS = 48  # between the two frames of figure 9.22


def arc(chord: float, y: float) -> Any:
    """A NURBS arc 20 m long that stands over its chord: through A, B and C of figure 9.18."""
    half = brentq(lambda t: 20.0 * np.sin(t) / t - chord, 1e-6, np.pi)  # half its angle
    top = 10.0 / half * (1.0 - np.cos(half))
    points = [rhino3dm.Point3d(x, y, z) for x, z in ((0.0, 0.0), (0.5 * chord, top), (chord, 0.0))]
    return rhino3dm.NurbsCurve.CreateFromArc(rhino3dm.Arc(*points))


def arcs() -> None:
    """Figures 9.17 to 9.20: a straight line of 10 m, and arcs of 20 m over chords of 10 m and 14 m."""
    line = rhino3dm.NurbsCurve.CreateFromLine(rhino3dm.Line(rhino3dm.Point3d(0, 0, 0), rhino3dm.Point3d(10, 0, 0)))
    drawn = {"line": line, "arc": arc(10.0, 4.0), "wide arc": arc(14.0, 8.0)}
    _write("9.17-arc-to-catenary", {layer: [curve] for layer, curve in drawn.items()})
    _write("9.21-arc-frames", {"arc": [arc(10.0, 0.0)]})


def frames() -> None:
    """Figure 9.22: two closed free-form frames, and a straight line for each chain between them."""
    t = np.linspace(0.0, 2.0 * np.pi, 9)[:-1]
    near = _closed(np.stack([1.5 * np.sin(2 * t), 5.2 * np.cos(t) + 0.6 * np.cos(3 * t), 6.5 + 3.6 * np.sin(t)], 1))
    far = _closed(
        np.stack([13.0 - 1.8 * np.cos(t), 4.0 * np.cos(t) - 1.0, 8.0 + 4.2 * np.sin(t) + 0.9 * np.cos(2 * t)], 1)
    )
    ends = [divide(frame, CHAINS)[:-1] for frame in (near, far)]
    lines = [
        rhino3dm.LineCurve(rhino3dm.Point3d(*a), rhino3dm.Point3d(*b))
        for a, b in zip(*(e.tolist() for e in ends), strict=True)
    ]
    _write("9.22-freeform-frames", {"frames": [near, far], "chains": lines})


def _closed(points: Floats) -> Any:
    """The periodic cubic NURBS curve through points (n, 3)."""
    spline = make_interp_spline(np.arange(len(points) + 1), np.vstack([points, points[:1]]), k=3, bc_type="periodic")
    curve = rhino3dm.NurbsCurve(3, len(spline.c))
    for i, (x, y, z) in enumerate(spline.c.tolist()):
        curve.Points[i] = rhino3dm.Point4d(x, y, z, 1.0)
    for i, value in enumerate(spline.t[1:-1].tolist()):
        curve.Knots[i] = value
    return curve


def _write(folder: str, drawn: dict[str, list[Any]]) -> None:
    colours = [(40, 90, 160, 255), (200, 90, 40, 255), (60, 140, 90, 255)]
    write_new(
        HERE / folder / "model.3dm",
        Additions(
            layers=tuple(NewLayer(layer, colour=colour) for layer, colour in zip(drawn, colours, strict=False)),
            objects=tuple(NewObject(curve, layer=layer) for layer, curves in drawn.items() for curve in curves),
        ),
        own=False,
    )


def graph() -> None:
    """Figure 9.14: a chain of 120 links of 0.1 m, lifted to two straight legs, over the axes of the graph."""
    a = brentq(lambda a: 2.0 * a * np.sinh(5.0 / a) - 12.0, 1.0, 100.0)
    top = a * np.cosh(5.0 / a)
    _write_chain("9.14-catenary-graph/scene.json", (-5, 0, top), (5, 0, top), 12.0, (0, 0, -1), 120)


# start A, end B, length L [m] and gravity direction G of the cables of figure 9.16
CABLES = {
    "scene": ((0, 0, 0), (8, 0, 4), 12.0, (0, 0, -1)),
    "scene-level": ((0, 0, 0), (10, 0, 0), 12.0, (0, 0, -1)),
    "scene-taut": ((0, 0, 0), (10, 0, 0), 10.1, (0, 0, -1)),
    "scene-slack": ((0, 0, 0), (3, 0, 1), 18.0, (0, 0, -1)),
    "scene-aslant": ((0, 0, 0), (9, 0, 0), 12.0, (0.6, 0, -0.8)),
    "scene-sideways": ((0, 0, 0), (0, 0, -8), 12.0, (1, 0, 0)),
}


def component() -> None:
    """Figure 9.16: chains of 60 links from A to B, each of its length and under its own gravity."""
    for name, (a, b, length, gravity) in CABLES.items():
        _write_chain(f"9.16-catenary-component/{name}.json", a, b, length, gravity, 60)


def _legs(a: Floats, b: Floats, length: float, down: Floats, links: int) -> Floats:
    """Particles (links + 1, 3) on two straight legs from a over the lowest point the chain reaches to b."""
    chord = b - a
    across = down - (down @ chord) / (chord @ chord) * chord
    across /= np.linalg.norm(across)
    low = a + 0.5 * chord + 0.5 * np.sqrt(length**2 - chord @ chord) * across
    part = np.linspace(0.0, 1.0, links + 1)[:, None]
    return np.where(part < 0.5, a + 2.0 * part * (low - a), low + (2.0 * part - 1.0) * (b - low))


def _write_chain(path: str, a: Any, b: Any, length: float, gravity: Any, links: int) -> None:
    """A chain of 1 N/m that hardly stretches: half of each link's weight at each of its ends."""
    points = _legs(*(np.array(v, float) for v in (a, b)), length, np.array(gravity, float), links)
    rest = round(length / links, 12)
    pairs = [[i, i + 1] for i in range(links)]
    weights = {"chain weight": (range(1, links), rest), "weight at the ends": ((0, links), 0.5 * rest)}
    forces: list[Any] = [
        {"kind": "springs", "name": "chain", "stiffness": 1e7, "rest_length": rest, "particles": pairs}
    ]
    for name, (where, weight) in weights.items():
        vector = [round(weight * g, 12) + 0.0 for g in gravity]
        forces.append({"kind": "unary", "name": name, "vector": vector, "particles": list(where)})
    parts = {
        "units": {"length": "m", "force": "N", "time": "s"},
        "particles": (points.round(8) + 0.0).tolist(),
        "forces": forces,
        "anchors": [{"name": "A and B", "particles": [0, links]}],
        "settings": {"tolerance": 1e-9},
    }
    text = ",\n".join(f'  "{key}": {_rows(value)}' for key, value in parts.items())
    (HERE / path).write_text(f"{{\n{text}\n}}\n", encoding="utf-8")


def _rows(value: Any) -> str:
    """JSON with an entry a line, particles five a line."""
    if not isinstance(value, list):
        return json.dumps(value)
    rows = [json.dumps(v) for v in value]
    many = 5 if isinstance(value[0], list) else 1
    return "[\n    " + ",\n    ".join(", ".join(rows[i : i + many]) for i in range(0, len(rows), many)) + "\n  ]"


if __name__ == "__main__":
    arcs()
    frames()
    graph()
    component()
