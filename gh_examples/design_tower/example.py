"""A tower of least load path: the search finds its feet and its forces."""

from pathlib import Path

import numpy as np

from hookean import design
from hookean.commands.examples import Outcome, figure
from hookean.pictures.sheet import Graph, Panel


def run(folder: Path) -> Outcome:
    """The tower found, and the load path of towers with other feet, which has a closed form."""
    module = figure(folder)
    found = design(module.problem())
    forces, feet = np.asarray(found.variables[0]["value"]), found.result.particles[:2, 0]
    top = found.result.reactions["force"][2]
    numbers = {
        "load path": found.goals[0]["value"],
        "left foot": feet[0],
        "right foot": feet[1],
        "force in the left leg": forces[0],
        "force in the right leg": forces[1],
        "hold that the top needs": np.hypot(top[0], top[2]),
    }
    narrow = np.linspace(4.0, 30.0, 60)
    paths = 30.0 * (12.0**2 + narrow**2) / narrow
    dot = (np.array([feet[1]]), np.array([numbers["load path"]]))
    graph = Graph(
        "The least load path", "feet from the axis [m]", "sum of |force| x length [kN m]",
        lines={"P (h² + b²) / b": (narrow, paths)}, dots={"found": dot},
    )  # fmt: skip
    return Outcome(numbers, [Panel(found.result, found.scene, "legs at 45 degrees", "front"), graph], columns=2)
