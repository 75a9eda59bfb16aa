"""A cable of prescribed sag: the search finds the length of each link."""

from pathlib import Path

import numpy as np

from hookean import design, relax
from hookean.commands.examples import Outcome, figure
from hookean.pictures.sheet import Panel


def run(folder: Path) -> Outcome:
    """The cable as it hangs with equal links, and as it was asked for."""
    module = figure(folder)
    start = relax(module.scene())
    found = design(module.problem())
    result, lengths = found.result, np.asarray(found.variables[0]["value"])
    x, z = result.particles[:, 0], result.particles[:, 2]
    parabola = -4.0 * 1.5 * (x / 10.0) * (1.0 - x / 10.0)
    numbers = {
        "sag": -z.min(),
        "horizontal thrust": np.abs(result.reactions["force"][0, 0]),
        "joints off equal steps, most": np.abs(x - np.linspace(0.0, 10.0, 21)).max(),
        "joints off the parabola, most": np.abs(z - parabola).max(),
        "rest length of the first link": lengths[0],
        "rest length of a link in the middle": lengths[9],
        "greatest force": result.force("cable")["force"].max(),
    }
    title = f"sag {numbers['sag']:.3f} m, thrust {numbers['horizontal thrust']:.2f} kN"
    panel = Panel(result, found.scene, title, "front", frames={"equal links": start.particles})
    return Outcome(numbers, [panel])
