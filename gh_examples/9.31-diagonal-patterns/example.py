"""Figure 9.31: one diagonal in every face, one way (A) or the other (B), and edges that differ in warp and weft (C)."""

from pathlib import Path

import numpy as np

from hookean import relax
from hookean.commands.examples import Outcome
from hookean.files.relax_file import read_scene
from hookean.pictures.sheet import Panel
from hookean.running.result import Result

PATTERNS = {
    "A": ("recipe.toml", "A: diagonals one way"),
    "B": ("recipe-b.toml", "B: diagonals the other way"),
    "C": ("recipe-c.toml", "C: warp 0.9, weft 1.1"),
}


def run(folder: Path) -> Outcome:
    scenes = {name: read_scene(folder / "model.3dm", folder / recipe) for name, (recipe, _) in PATTERNS.items()}
    a, b, c = (relax(scene) for scene in scenes.values())
    mirror = a.particles.reshape(11, 11, 3)[::-1] * [-1.0, 1.0, 1.0] + [10.0, 0.0, 0.0]  # x to 10 - x
    numbers = {
        "A: deepest sag": -a.particles[:, 2].min(),
        "A: reaction at (0, 0)": reaction(a, 0.0),
        "A: reaction at (10, 0)": reaction(a, 10.0),
        "A: largest force in a diagonal": a.force("diagonals")["force"].max(),
        "B: reaction at (0, 0)": reaction(b, 0.0),
        "B: difference from the mirror image of A": np.abs(b.particles.reshape(11, 11, 3) - mirror).max(),
        "C: sag in the middle": -height(c, 5, 5),
        "C: sag of the rim along the warp": -height(c, 5, 0),
        "C: sag of the rim along the weft": -height(c, 0, 5),
        "C: largest force in the warp": c.force("warp")["force"].max(),
        "C: largest force in the weft": c.force("weft")["force"].max(),
    }
    panels = [
        Panel(result, scenes[name], title=PATTERNS[name][1], view=(-75.0, 35.0))
        for name, result in zip("ABC", (a, b, c), strict=True)
    ]
    return Outcome(numbers, panels, columns=3)


def reaction(result: Result, x: float) -> float:
    """Size of the reaction at the corner (x, 0)."""
    places = result.particles[result.reactions["particles"]]
    which = np.abs(places - [x, 0.0, 0.0]).sum(axis=1).argmin()
    return float(np.linalg.norm(result.reactions["force"][which]))


def height(result: Result, i: int, j: int) -> float:
    """Height of particle i along x, j along y."""
    return float(result.particles.reshape(11, 11, 3)[i, j, 2])
