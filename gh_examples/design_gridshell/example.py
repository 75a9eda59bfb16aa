"""A gridshell of flat quadrilaterals and laths in stock: the search moves its nodes as little as it can."""

from pathlib import Path

import numpy as np

from hookean import design, sensitivity
from hookean.commands.examples import Outcome, figure
from hookean.pictures.sheet import Panel


def run(folder: Path) -> Outcome:
    """The surface as it is drawn, and the shell that can be built."""
    module = figure(folder)
    problem = module.problem()
    made, start = problem["scene"], sensitivity(problem)
    found = design(problem)
    before, after = start.result.force("laths")["length"], found.result.force("laths")["length"]
    numbers = {
        "drawn: diagonals of a face apart, most": 1000.0 * np.abs(start.values[1]).max(),
        "drawn: longest lath": before.max(),
        "drawn: shortest lath": before.min(),
        "diagonals of a face apart, most": 1000.0 * np.abs(found.goals[1]["value"]).max(),
        "longest lath": after.max(),
        "shortest lath": after.min(),
        "a node is moved by, most": np.linalg.norm(found.result.particles - made.particles, axis=1).max(),
    }
    apart = numbers["drawn: diagonals of a face apart, most"]
    slant = (-50.0, 24.0)
    panels = [
        Panel(start.result, made, f"drawn: faces up to {apart:.0f} mm off flat", slant),
        Panel(found.result, found.scene, f"built: {after.min():.2f} to {after.max():.2f} m, faces flat", slant),
    ]  # fmt: skip
    return Outcome(numbers, panels, columns=2)
