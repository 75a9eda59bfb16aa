"""A pneumatic roof: the cap of a sphere on a round rim, and a cushion on a square frame."""

from pathlib import Path
from types import ModuleType

import numpy as np

from hookean import Result, relax
from hookean.commands.examples import Outcome, defaults, figure
from hookean.pictures.sheet import Graph, Panel

COARSE = {"rings": 6, "divisions": 8}  # half of the scene's: what both find gives the limit of fine meshes


def run(folder: Path) -> Outcome:
    module = figure(folder)
    given = defaults(module.scene)
    radius, tension = given["radius"], given["tension"]
    scene = module.scene()
    result, coarse = relax(scene), relax(module.scene(**COARSE))
    ball = 2.0 * tension / given["pressure"]
    cap, upper, lower = (vertices(result, name) for name in ("cap", "upper", "lower"))
    out = np.linalg.norm(cap + [0.0, 0.0, np.sqrt(ball**2 - radius**2)], axis=1)
    rise = [cap[:, 2].max(), vertices(coarse, "cap")[:, 2].max()]
    thick = vertices(coarse, "upper")[:, 2].max()
    held = np.asarray(result.reactions["force"])
    rim = np.linalg.norm(result.particles[result.reactions["particles"]][:, :2], axis=1) < 1.01 * radius
    area = 0.5 * 6 * given["rings"] * radius**2 * np.sin(np.pi / 3.0 / given["rings"])  # of the polygon of the rim
    numbers = {
        "cap: rise, in the limit of fine meshes": (4.0 * rise[0] - rise[1]) / 3.0,
        "cap: distance from the sphere, largest": np.abs(out - ball).max(),
        "cap: force on the rim over pressure times its plan": -held[rim, 2].sum() / (given["pressure"] * area),
        "cushion: rise of the upper film, in the limit of fine meshes": (4.0 * upper[:, 2].max() - thick) / 3.0,
        "cushion: upper and lower film, largest difference": np.abs(upper + lower)[:, 2].max(),
        "cushion: force on the frame upwards": held[~rim, 2].sum(),
    }
    panel = Panel(result, scene, "300 Pa in films of 1 kN/m", view=(-70.0, 20.0))
    return Outcome(numbers, [panel, graph(module, radius, tension)], columns=1)


def vertices(result: Result, name: str) -> np.ndarray:
    """Of a film, at rest [m]."""
    return np.asarray(next(item["vertices"] for item in result.geometry if item["name"] == name))


def graph(module: ModuleType, radius: float, tension: float) -> Graph:
    """Rise of the cap by pressure: up to half of a sphere, at p = 2 T / a."""
    pressure = np.linspace(1.0, 2.0 * tension / radius, 200)
    ball = 2.0 * tension / pressure
    dots = np.array([50.0, 100.0, 150.0, 200.0, 250.0, 300.0, 350.0, 390.0])
    rises = [vertices(relax(module.scene(rings=6, divisions=4, pressure=p)), "cap")[:, 2].max() for p in dots]
    return Graph(
        "The cap of a sphere of R = 2 T / p", "pressure [Pa]", "rise of the cap [m]",
        lines={"closed form": (pressure, ball - np.sqrt(np.maximum(ball**2 - radius**2, 0.0)))},
        dots={"hookean, six rings": (dots, np.array(rises))},
    )  # fmt: skip
