"""Figure 9.29: diagonals keep the faces of a membrane from becoming diamonds. The same square without, with one and
with both."""

from pathlib import Path

import numpy as np

from hookean import relax
from hookean.commands.examples import Outcome
from hookean.files.relax_file import read_scene
from hookean.pictures.sheet import Panel

RECIPES = {"none": "recipe-edges.toml", "one": "recipe-one.toml", "both": "recipe.toml"}
TITLES = {"none": "No diagonals", "one": "One diagonal", "both": "Both"}


def run(folder: Path) -> Outcome:
    numbers, panels = {}, []
    for which, recipe in RECIPES.items():
        scene = read_scene(folder / "model.3dm", folder / recipe)
        result = relax(scene)
        mesh = result.geometry[0]
        skew = skewness(mesh["vertices"][mesh["faces"]])
        sag = -result.particles[:, 2].min()
        numbers |= {
            f"{which}: sag": sag,
            f"{which}: largest skew of a face": skew.max(),
            f"{which}: mean skew of the faces": skew.mean(),
            f"{which}: largest force in an edge": result.force("edges")["force"].max(),
            f"{which}: upward reactions together": result.reactions["force"][:, 2].sum(),
        }
        if which != "none":
            numbers[f"{which}: largest force in a diagonal"] = result.force("diagonals")["force"].max()
        title = f"{TITLES[which]}: skew up to {skew.max():.0f}°"
        panels.append(Panel(result, scene, title=title))
    return Outcome(numbers, panels, columns=3)


def skewness(faces: np.ndarray) -> np.ndarray:
    """By how many degrees the corner of a face (m, 4, 3) that is farthest from a right angle is off."""
    after, before = (np.roll(faces, turn, axis=1) - faces for turn in (-1, 1))
    cosine = (after * before).sum(axis=2) / np.linalg.norm(after, axis=2) / np.linalg.norm(before, axis=2)
    return np.abs(90.0 - np.degrees(np.arccos(cosine))).max(axis=1)
