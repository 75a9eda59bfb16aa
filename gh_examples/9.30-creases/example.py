"""Figure 9.30: a sheet, its edges and diagonals two tables of springs. Shorter diagonals fold its faces: creases."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from hookean import relax
from hookean.commands.examples import Outcome
from hookean.files.relax_file import read_scene
from hookean.pictures.sheet import Panel

RECIPES = {"1": "recipe.toml", "0.95": "recipe-creased.toml", "0.9": "recipe-sharper.toml"}


def run(folder: Path) -> Outcome:
    numbers, sheets, springs = {}, [], []
    for factor, recipe in RECIPES.items():
        scene = read_scene(folder / "model.3dm", folder / recipe)
        result = relax(scene)
        mesh = result.geometry[0]
        fold = folds(mesh["vertices"][mesh["faces"]])
        numbers |= {
            f"diagonals {factor}: energy of the springs": result.energy["springs"],
            f"diagonals {factor}: deepest sag": -result.particles[:, 2].min(),
            f"diagonals {factor}: mean fold of the faces": fold.mean(),
            f"diagonals {factor}: upward reactions together": result.reactions["force"][:, 2].sum(),
        }
        # halves of the faces, without springs in front of them, show the folds
        shown = replace(result, forces=[], geometry=[{**mesh, "faces": halves(mesh["faces"])}])
        title = f"Rest factor {factor}: folds of {fold.mean():.0f}°"
        sheets.append(Panel(shown, scene, title=title, view=(-70.0, 35.0)))
        springs.append(Panel(replace(result, geometry=[]), scene, title="Its springs, from above", view="top"))
    return Outcome(numbers, sheets + springs, columns=3)


def halves(faces: np.ndarray) -> np.ndarray:
    """Faces cut in two from their second to their fourth corner; a triangle repeats its last corner."""
    return np.concatenate([faces[:, [0, 1, 3, 3]], faces[:, [1, 2, 3, 3]]])


def folds(faces: np.ndarray) -> np.ndarray:
    """Fold angle [degrees] of faces (m, 4, 3) along the diagonal from their second to their fourth corner."""
    a, b, c, d = faces.swapaxes(0, 1)
    one, other = np.cross(b - a, d - a), np.cross(d - c, b - c)
    cosine = (one * other).sum(axis=1) / np.linalg.norm(one, axis=1) / np.linalg.norm(other, axis=1)
    return np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0)))
