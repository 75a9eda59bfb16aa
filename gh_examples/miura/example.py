"""Origami: hinges in the level creases of a Miura sheet fold it; its panels stay rigid."""

from pathlib import Path

import numpy as np

from hookean import relax
from hookean.commands.examples import Outcome, defaults, figure
from hookean.pictures.sheet import Graph, Panel

FOLDS = (20.0, 40.0, 60.0, 75.0)  # degrees


def run(folder: Path) -> Outcome:
    module = figure(folder)
    given = defaults(module.scene)
    shape = [given[name] for name in ("rows", "columns", "side", "height", "angle")]
    scene = module.scene()
    faces = scene.meshes["sheet"].faces

    def sides(x: np.ndarray) -> np.ndarray:
        return np.linalg.norm(x[faces] - x[np.roll(faces, 1, axis=1)], axis=2)

    result = relax(scene)
    extents = np.array([np.ptp(relax(module.scene(fold=fold)).particles, axis=0) for fold in FOLDS])
    exact = module.folded(given["fold"], *shape)
    width, depth, height = np.ptp(result.particles, axis=0)
    numbers = {
        "width": width,
        "depth": depth,
        "height": height,
        "distance from Miura's sheet, largest": np.linalg.norm(result.particles - exact, axis=1).max(),
        "fold of the level creases": np.degrees(np.abs(result.force("creases")["angle"]).mean()),
        "change of a panel's side, largest": np.abs(sides(result.particles) - sides(np.asarray(scene.particles))).max(),
    }
    turned = np.linspace(1.0, 89.0, 89)
    known = np.array([np.ptp(module.folded(fold, *shape), axis=0) for fold in turned])
    names = ("width", "depth", "height")
    graph = Graph(
        "closed form and hookean", "lean of a panel [degrees]", "size of the sheet [m]",
        lines={name: (turned, known[:, i]) for i, name in enumerate(names)},
        dots={f"hookean, {name}": (np.array(FOLDS), extents[:, i]) for i, name in enumerate(names)},
    )  # fmt: skip
    before = {"start, 10 degrees": np.asarray(scene.particles)}
    title = f"panels lean by {given['fold']:g} degrees"
    return Outcome(numbers, [Panel(result, scene, title, view=(-60.0, 30.0), frames=before), graph])
