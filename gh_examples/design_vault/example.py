"""A vault to a target surface: the search finds the forces that stand in it."""

from pathlib import Path

import numpy as np

from hookean import design, relax
from hookean.commands.examples import Outcome, figure
from hookean.pictures.sheet import Panel


def run(folder: Path) -> Outcome:
    """The net with equal force densities, and with those of the surface."""
    module = figure(folder)
    made = module.scene()
    start, found = relax(made), design(module.problem())
    result, target = found.result, module.surface(8.0, 2.0, 8)[0]
    density = np.asarray(found.variables[0]["value"])
    along, across = density[:56].reshape(7, 8), density[56:].reshape(7, 8)
    plain = np.delete(along, 3, axis=0)
    numbers = {
        "off the surface, most": np.abs(result.particles - target).max(),
        "equal densities: off the surface, most": np.abs(start.particles - target).max(),
        "least force, push of the vault": result.force("net")["force"].min(),
        "weight on the walls": -result.reactions["force"][:, 2].sum(),
        "density along the wall less that beside it": (along[3] - plain.mean()).mean(),
        "density along, spread on a line": np.ptp(along, axis=1).max(),
        "density along and across, sum": plain.mean() + across.mean(),
    }
    slant = (-50.0, 24.0)
    panels = [
        Panel(start, made, "equal densities", slant),
        Panel(result, found.scene, f"on the surface, {1000 * numbers['off the surface, most']:.3f} mm off", slant),
    ]
    return Outcome(numbers, panels, columns=2)
