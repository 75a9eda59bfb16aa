"""Figure 9.10: a smooth curve through the particles of a cable, to look at; the cable itself has corners."""

from pathlib import Path

import numpy as np

from hookean import relax
from hookean.commands.examples import Outcome, figure
from hookean.discretize import interpolate
from hookean.pictures.sheet import Panel


def run(folder: Path) -> Outcome:
    scene = figure(folder).scene()
    result = relax(scene)
    x = result.particles
    curve = interpolate(x, 4000)
    numbers = {
        "largest distance of a particle from the curve": furthest(x, curve),
        "largest distance of the curve from the cable": furthest(curve, x),
        "length of the cable": result.force("cable")["length"].sum(),
        "length of the curve": np.linalg.norm(np.diff(curve, axis=0), axis=1).sum(),
        "turn of the cable at B": np.degrees(turn(x[1:4])),
    }
    shown = {"interpolated curve, for display only": curve[::20]}
    return Outcome(numbers, [Panel(result, scene, view="front", curves=shown)])


def furthest(points: np.ndarray, corners: np.ndarray) -> float:
    """The largest distance of any of the points from a polyline."""
    a, d = corners[:-1], np.diff(corners, axis=0)
    along = np.clip(((points[:, None] - a) * d).sum(axis=2) / (d * d).sum(axis=1), 0.0, 1.0)
    return float(np.linalg.norm(points[:, None] - a - along[..., None] * d, axis=2).min(axis=1).max())


def turn(corner: np.ndarray) -> float:
    """The angle [rad] by which the second of two springs turns away from the first."""
    first, second = np.diff(corner, axis=0)
    return float(np.arctan2(np.linalg.norm(np.cross(first, second)), first @ second))
