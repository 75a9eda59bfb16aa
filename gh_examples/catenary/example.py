"""Chains with a sliding support: a ring on a rail comes to rest where its chain is square to the rail."""

from pathlib import Path

import numpy as np

from hookean import relax
from hookean.commands.examples import Outcome, defaults, figure
from hookean.discretize.catenary import parameter
from hookean.pictures.sheet import Graph, Panel


def run(folder: Path) -> Outcome:
    module = figure(folder)
    given = defaults(module.scene)
    angles, weight, span = given["angles"], given["weight"], given["span"]
    scene = module.scene()
    result = relax(scene)
    shapes = result.particles.reshape(len(angles), -1, 3)
    tensions = result.force("chains")["force"].reshape(len(angles), -1)
    pushes = np.linalg.norm(result.force("rails")["force"], axis=1)
    numbers, middles = {}, []
    for angle, x, tension, push in zip(angles, shapes, tensions, pushes, strict=True):
        along = np.diff(x, axis=0) / np.linalg.norm(np.diff(x, axis=0), axis=1)[:, None]
        numbers[f"rail at {angle:g} degrees: depth of the ring"] = -x[-1, 2]
        numbers[f"rail at {angle:g} degrees: horizontal pull"] = tension[0] * along[0, 0]
        numbers[f"rail at {angle:g} degrees: force of the rail"] = push
        numbers[f"rail at {angle:g} degrees: lowest point"] = -x[:, 2].min()
        middles.append(0.5 * (x[1:, 2] + x[:-1, 2]))
    pole, a = shapes[0], parameter(2.0 * span, 2.0 * given["length"])
    numbers["pole: depth of the ring over the catenary's"] = -pole[-1, 2] / (a * np.cosh(span / a) - a)
    numbers["pole: horizontal pull over w a"] = numbers["rail at 90 degrees: horizontal pull"] / (weight * a)
    rises = [np.polyfit(z, tension, 1)[0] for z, tension in zip(middles, tensions, strict=True)]
    numbers["tension by height, over the weight, mean"] = float(np.mean(rises)) / weight
    return Outcome(numbers, [panel(result, scene, angles, span, shapes), graph(angles, middles, tensions, weight)])


def panel(result, scene, angles, span, shapes) -> Panel:  # type: ignore[no-untyped-def]
    """The chains one behind the other, with their rails."""
    rails = {}
    for angle, x in zip(angles, shapes, strict=True):
        turn = np.radians(angle)
        along = np.array([np.cos(turn), 0.0, np.sin(turn)])
        ends = np.array([[span, 0.0, 0.0], [span, 0.0, 0.0]]) + np.outer([0.3, x[-1, 2] / np.sin(turn) - 0.8], along)
        rails[f"rail at {angle:g} degrees"] = ends
    return Panel(result, scene, "from a nail to a ring on a rail", view="front", curves=rails)


def graph(angles, middles, tensions, weight) -> Graph:  # type: ignore[no-untyped-def]
    """Tension by height: w for each metre."""
    lines, dots = {}, {}
    for angle, z, tension in zip(angles, middles, tensions, strict=True):
        name = f"rail at {angle:g} degrees"
        lines[name] = (np.sort(z), tension.min() + weight * (np.sort(z) - z[np.argmin(tension)]))
        dots[name] = (z[::4], tension[::4])
    return Graph("Tension grows by 20 N a metre", "height [m]", "tension [N]", lines=lines, dots=dots)
