"""Figure 9.1: a square membrane of particles and springs, held at its corners."""

from pathlib import Path

import numpy as np

from hookean import relax
from hookean.commands.examples import Outcome, figure
from hookean.pictures.sheet import Panel


def run(folder: Path) -> Outcome:
    scene = figure(folder).scene()
    result = relax(scene)
    springs = result.force("membrane")
    numbers = {
        "sag in the middle": -result.particles[40, 2],
        "sag of an edge": -result.particles[4, 2],
        "largest force in a spring": springs["force"].max(),
        "least force in a spring": springs["force"].min(),
        "vertical reaction of a corner": result.reactions["force"][0, 2],
        "largest difference between mirror images": mirrored(result.particles),
        "largest imbalance of a particle": result.out_of_balance,
    }
    return Outcome(numbers, [Panel(result, scene, frames={"start": scene.particles})])


def mirrored(particles: np.ndarray) -> float:
    """How far heights differ from those with x and y exchanged, and from those with x turned round."""
    z = particles[:, 2].reshape(9, 9)
    return float(max(np.abs(z - z.T).max(), np.abs(z - z[::-1]).max()))
