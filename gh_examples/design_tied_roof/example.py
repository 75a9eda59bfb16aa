"""A roof without thrust on its walls: the search finds the forces of arches and ties."""

from pathlib import Path

import numpy as np

from hookean import design, relax
from hookean.commands.examples import Outcome, figure
from hookean.pictures.sheet import Panel


def run(folder: Path) -> Outcome:
    """The arches without ties that work, and with them."""
    module = figure(folder)
    made = module.scene()
    start, found = relax(made), design(module.problem())
    result = found.result
    ties, density = result.force("ties")["force"], np.asarray(found.variables[0]["value"]).ravel()
    lengths = np.asarray(found.variables[1]["value"])
    crowns = result.particles[9 * np.arange(7) + 4, 2]
    numbers = {
        "without: thrust on a wall at an arch": np.abs(start.reactions["force"][:, 1]).max(),
        "thrust on a wall at an arch, most": np.abs(result.reactions["force"][:, 1]).max(),
        "rise of a crown off 2 m, most": np.abs(crowns - 2.0).max(),
        "first tie: force of the roof's": -ties[0],
        "last tie: force of the roof's": -ties[-1],
        "first arch: force density": density[0],
        "last arch: force density": density[-1],
        "last tie: length cut": lengths[-1],
        "weight on the walls": -result.reactions["force"][:, 2].sum(),
    }
    slant = (-50.0, 24.0)
    thrust = numbers["without: thrust on a wall at an arch"]
    panels = [
        Panel(start, made, f"ties of 8 m: each arch thrusts with {thrust:.0f} kN", slant),
        Panel(result, found.scene, f"ties pull {-ties[0]:.1f} to {-ties[-1]:.1f} kN, no thrust", slant),
    ]
    return Outcome(numbers, panels, columns=2)
