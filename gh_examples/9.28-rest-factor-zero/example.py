"""Figure 9.28: a net with rest factor 0, and the true soap film in the same frame. The net's area is not the least."""

from pathlib import Path

import numpy as np
from scipy.interpolate import CubicSpline

from hookean import relax
from hookean.commands.examples import Outcome
from hookean.discretize import area as area_of
from hookean.discretize import quads
from hookean.files.relax_file import read_scene
from hookean.pictures.sheet import Graph, Panel
from hookean.running.result import Result


def run(folder: Path) -> Outcome:
    scenes = {
        name: read_scene(folder / "model.3dm", folder / f"{recipe}.toml")
        for name, recipe in (("net", "recipe"), ("film", "recipe-film"), ("fine", "recipe-film-fine"))
    }
    net, film, fine = (relax(scene) for scene in scenes.values())
    x, y, z = net.particles.T
    net_area = without_error(area(net), area(net, every=2))
    film_area = without_error(area(fine), area(film))
    numbers = {
        "net: farthest from z = x y": np.abs(z - x * y).max(),
        "net: area": net_area,
        "film: area": film_area,
        "excess of the net's area": 100.0 * (net_area / film_area - 1.0),
        "net: height over (0.5, 0.5)": height(net, 0.5),
        "film: height over (0.5, 0.5)": without_error(height(fine, 0.5), height(film, 0.5)),
        "film: area of its 32 x 32 faces": area(film),
    }
    along = np.linspace(-1.0, 1.0, 101)
    below = 1000.0 * (height(net, along) - without_error(height(fine, along), height(film, along)))
    graph = Graph(
        "Film below net, over x = y", "x = y [m]", "net - film [mm]", {"difference in height": (along, below)}
    )
    panels = [
        Panel(net, scenes["net"], title=f"Net, rest factor 0: {net_area:.4f} m²", view=(-75.0, 22.0)),
        Panel(film, scenes["film"], title=f"Soap film: {film_area:.4f} m²", view=(-75.0, 22.0)),
        graph,
    ]
    return Outcome(numbers, panels)


def area(result: Result, every: int = 1) -> float:
    """Area of the carried mesh, a grid of particles; with `every` 2 only each second row and column of them counts."""
    n = int(np.sqrt(len(result.particles)))
    return area_of(quads(result.particles.reshape(n, n, 3)[::every, ::every]))


def height(result: Result, at):
    """Height over (at, at): a cubic spline through the particles on the diagonal x = y, the plane of symmetry."""
    n = int(np.sqrt(len(result.particles)))
    diagonal = result.particles.reshape(n, n, 3)[np.arange(n), np.arange(n)]
    return CubicSpline(diagonal[:, 0], diagonal[:, 2])(at)


def without_error(fine, coarse):
    """Richardson's extrapolation: flat faces are off by a part of their size squared, a quarter with half the size."""
    return (4.0 * fine - coarse) / 3.0
