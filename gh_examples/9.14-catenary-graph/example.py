"""Figures 9.14 and 9.15: y = a cosh(x / a) for several a, and a chain that hangs on the curve of one of them."""

from pathlib import Path

import numpy as np

from hookean import relax
from hookean.commands.examples import Outcome, figure
from hookean.discretize.catenary import catenary, catenary_of, parameter, sag, tensions
from hookean.pictures.sheet import Graph, Panel

TOP = 10.0  # m, where the graph ends


def run(folder: Path) -> Outcome:
    scene = figure(folder).scene()
    result = relax(scene)
    x, z = result.particles[:, 0], result.particles[:, 2]
    first, last = result.particles[0], result.particles[-1]
    span, length = last[0] - first[0], scene.forces[0].rest_length * len(scene.forces[0].particles)
    a = parameter(span, length)
    drawn = catenary(first, last, length, count=len(x) - 1)
    numbers = {
        "a = 2: y at x = 0": float(catenary_of(2.0, 0.0)),
        "a = 2: y at x = 3": float(catenary_of(2.0, 3.0)),
        "span 10, length 12: a": a,
        "span 10, length 12: sag": sag(span, length),
        "span 10, length 12: largest tension": tensions(first, last, length, weight=1.0).max(),
        "chain: sag": z[0] - z.min(),
        "chain: largest reaction": np.linalg.norm(result.reactions["force"], axis=1).max(),
        "chain: off the catenary": np.linalg.norm(result.particles - drawn, axis=1).max(),
    }
    lines = {f"a = {value:g} m": graph_of(value) for value in (1.0, 2.0, 3.0, a, 7.0)}
    some = slice(None, None, 6)
    curve = np.stack([drawn[:, 0], 0.0 * drawn[:, 0], catenary_of(a, drawn[:, 0])], axis=1)
    return Outcome(
        numbers,
        [
            Graph("Curves of several a", "x [m]", "y [m]", lines=lines, dots={"hanging chain": (x[some], z[some])}),
            Panel(result, scene, "A chain of 12 m", "front", {"start": scene.particles}, {f"a = {a:.6g} m": curve}),
        ],
        columns=2,
    )


def graph_of(a: float) -> tuple[np.ndarray, np.ndarray]:
    """The curve for x and y up to the ends of the graph."""
    widest = min(6.0, a * np.arccosh(TOP / a))
    x = np.linspace(-widest, widest, 201)
    return x, catenary_of(a, x)
