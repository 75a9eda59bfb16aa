"""Figures 9.17 to 9.20: a line that stretches misses the catenary; an arc that hardly does becomes it."""

from pathlib import Path

import numpy as np

from hookean import Result, Scene, relax
from hookean.commands.examples import Outcome
from hookean.discretize.catenary import catenary, catenary_of, parameter
from hookean.files.relax_file import read_scene
from hookean.pictures.sheet import Graph, Panel

ARC = 20.0  # m, the length of both arcs
RECIPES = {
    "line": "recipe-line.toml",
    "arc": "recipe.toml",
    "wide arc": "recipe-wide.toml",
    "arc, rest by arc length": "recipe-arc-length.toml",
    "wide arc, rest by arc length": "recipe-wide-arc-length.toml",
}


def run(folder: Path) -> Outcome:
    scenes = {name: read_scene(folder / "model.3dm", folder / recipe) for name, recipe in RECIPES.items()}
    results = {name: relax(scene) for name, scene in scenes.items()}
    segments = {name: result.force("cable")["length"] for name, result in results.items()}
    numbers = {}
    for name, result in results.items():
        numbers[f"{name}: length"] = segments[name].sum()
        numbers[f"{name}: sag"] = -result.particles[:, 2].min()
        numbers[f"{name}: off the catenary"] = np.abs(off(result, of(name, segments[name]))).max()
    numbers["arc: shortest segment"] = segments["arc"].min()
    numbers["arc: longest segment"] = segments["arc"].max()
    numbers["arc: largest change of a segment"] = np.abs(segments["arc"] - ARC / len(segments["arc"])).max()
    titles = {"line": "A line of 10 m that stretches", "arc": "An arc of 20 m that hardly does"}
    panels = [shown(results[n], scenes[n], title, of(n, segments[n])) for n, title in titles.items()]
    heights = {
        n: (results[n].particles[:, 0], off(results[n], of(n, segments[n]))) for n in ("line", "arc", "wide arc")
    }
    counted = {n: np.arange(1, len(lengths) + 1) for n, lengths in segments.items()}
    graphs = [
        Graph("How far it is from the catenary", "x [m]", "height over the catenary [m]", dots=heights),
        Graph("Segments stay near 0.4 m", "segment, from A to B", "length [m]",
              lines={"at the start": (counted["arc"], np.full(len(segments["arc"]), ARC / len(segments["arc"])))},
              dots={n: (counted[n], segments[n]) for n in ("arc", "wide arc")}),
    ]  # fmt: skip
    return Outcome(numbers, [*panels, *graphs], columns=2)


def of(name: str, segments: np.ndarray) -> float:
    """The length [m] of the catenary to compare with: a stretched line's own, or that of the arc as drawn."""
    return float(segments.sum()) if name == "line" else ARC


def off(result: Result, length: float) -> np.ndarray:
    """Heights [m] of the particles over the catenary of this length through A and B."""
    x, z = result.particles[:, 0], result.particles[:, 2]
    a = parameter(x[-1] - x[0], length)
    middle = 0.5 * (x[0] + x[-1])
    return (z - z[0]) - (catenary_of(a, x - middle) - catenary_of(a, x[0] - middle))


def shown(result: Result, scene: Scene, title: str, length: float) -> Panel:
    """The relaxed cable over its catenary and over what was drawn."""
    lines = scene.forces[0].lines
    start = np.vstack([lines[:, 0], lines[-1:, 1]])
    drawn = catenary(result.particles[0], result.particles[-1], length, count=200)
    return Panel(result, scene, title, "front", {"start": start}, {f"catenary of {length:.4g} m": drawn})
