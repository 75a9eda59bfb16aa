"""A net of equal forces: the search finds the force density of each line."""

from pathlib import Path

import numpy as np

from hookean import design, relax
from hookean.commands.examples import Outcome, figure
from hookean.pictures.sheet import Panel


def run(folder: Path) -> Outcome:
    """The net with equal force densities, and with equal forces."""
    module = figure(folder)
    made = module.scene()
    start, found = relax(made), design(module.problem())
    before, after = start.force("net"), found.result.force("net")
    pulls = found.result.reactions["force"][np.isin(found.result.reactions["particles"], made.anchors[0].particles)]
    numbers = {
        "equal densities: greatest force / least": before["force"].max() / before["force"].min(),
        "least force": after["force"].min(),
        "greatest force": after["force"].max(),
        "pull at an outer end": np.linalg.norm(pulls, axis=1).max(),
        "angle between two lines off 120 degrees, most": off(found.result.particles, after["particles"]),
        "shortest line": after["length"].min(),
    }
    panels = [
        Panel(start, made, f"equal densities, {before['force'].min():.1f} to {before['force'].max():.1f} kN", "top"),
        Panel(found.result, found.scene, "equal forces, 10 kN", "top"),
    ]
    return Outcome(numbers, panels, columns=2)


def off(points: np.ndarray, lines: np.ndarray) -> float:
    """By how many degrees angles where three lines meet differ from 120, at most."""
    most = 0.0
    for i in np.flatnonzero(np.bincount(lines.ravel()) == 3):
        ways = points[lines[(lines == i).any(axis=1)].sum(axis=1) - i] - points[i]
        ways /= np.linalg.norm(ways, axis=1)[:, None]
        angles = np.degrees(np.arccos(np.clip((ways * np.roll(ways, 1, axis=0)).sum(axis=1), -1.0, 1.0)))
        most = max(most, float(np.abs(angles - 120.0).max()))
    return most
