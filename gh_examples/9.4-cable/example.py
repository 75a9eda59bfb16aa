"""Figures 9.4 and 9.5: a line cut into ten springs, a cable under its loads."""

from pathlib import Path

import numpy as np

from hookean import relax
from hookean.commands.examples import Outcome
from hookean.files.relax_file import read_scene
from hookean.pictures.sheet import Panel


def run(folder: Path) -> Outcome:
    scene = read_scene(folder / "model.3dm", folder / "recipe.toml")
    result = relax(scene)
    cable = result.force("cable")
    lengths = cable["length"]
    lines = scene.forces[0].lines
    start = np.vstack([lines[:, 0], lines[-1:, 1]])
    numbers = {
        "springs": len(lengths),
        "length": lengths.sum(),
        "length of the first spring": lengths[0],
        "length of a middle spring": lengths[4],
        "first spring longer than a middle one": lengths[0] - lengths[4],
        "force in the first spring": cable["force"][0],
        "sag": -result.particles[:, 2].min(),
        "lift of an anchor": result.reactions["force"][0, 2],
    }
    return Outcome(numbers, [Panel(result, scene, view="front", frames={"start": start})])
