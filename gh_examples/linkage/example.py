"""Chebyshev's linkage: five crank angles at once, the pen's line, and what the crank has to hold."""

from pathlib import Path

import numpy as np

from hookean import relax
from hookean.commands.examples import Outcome, defaults, figure
from hookean.pictures.sheet import Graph, Panel


def run(folder: Path) -> Outcome:
    module = figure(folder)
    angles = np.array(defaults(module.scene)["angles"])
    scene = module.scene()
    result = relax(scene)
    shape = result.particles.reshape(-1, 5, 3)
    pens = shape[:, 4]
    held = dict(zip(result.reactions["particles"].tolist(), result.reactions["force"], strict=True))
    torques = [np.cross(held[5 * i + 1], x[1] - x[0])[1] for i, x in enumerate(shape)]
    numbers = {
        **{f"height of the pen at {angle:g} degrees": pen[2] for angle, pen in zip(angles, pens, strict=True)},
        "length of the line": np.ptp(pens[:, 0]),
        **{f"torque of the crank at {angle:g} degrees": t for angle, t in zip(angles, torques, strict=True)},
        "change of a coupler, largest": changed(shape).max(),
    }
    turned = np.linspace(0.0, 360.0, 361)
    path = np.array([module.joints(angle)[4] for angle in turned])
    graph = Graph(
        "the pen's path", "x [m]", "height [m]", lines={"closed form": (path[:, 0], path[:, 2])},
        dots={"hookean": (pens[:, 0], pens[:, 2])},
    )  # fmt: skip
    line = {"path of the pen": path}
    return Outcome(numbers, [Panel(result, scene, "crank at 90 to 270 degrees", view="front", curves=line), graph])


def changed(shape: np.ndarray) -> np.ndarray:
    """How far from 2.5 m the halves of couplers are [m]."""
    ends = shape[:, [1, 2, 4]]
    return np.abs(np.linalg.norm(np.diff(ends, axis=1), axis=2) - 2.5)
