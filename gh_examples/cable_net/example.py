"""A cable net: its form by force densities, and what snow does to it."""

from pathlib import Path
from types import ModuleType

import numpy as np

from hookean import relax
from hookean.commands.examples import Outcome, figure
from hookean.pictures.sheet import Graph, Panel

SNOWS = (0.0, 0.3, 0.6, 0.9, 1.2, 1.5)  # kN/m2


def run(folder: Path) -> Outcome:
    module = figure(folder)
    found = module.form()
    form = relax(found)
    scene = module.scene()
    result = relax(scene)
    middle = len(form.particles) // 2
    edge = module.form().meshes["net"].faces[:12, 0]  # vertices of the side x = 0
    load = scene.forces[2].vector
    numbers = {
        "form: height of the middle": form.particles[middle, 2],
        "form: sag of an edge in plan": form.particles[edge[6], 0],
        "form: largest force in an edge": form.force("edges")["force"].max(),
        "form: largest force in the net": form.force("net")["force"].max(),
        "no snow: largest movement": np.abs(relax(module.scene(snow=0.0)).particles - form.particles).max(),
        "snow: middle goes down by": form.particles[middle, 2] - result.particles[middle, 2],
        "snow: largest force in an edge": result.force("edges")["force"].max(),
        "snow: largest force in the net": result.force("net")["force"].max(),
        "snow: least force in the net": result.force("net")["force"].min(),
        "snow: reactions up less its weight": result.reactions["force"][:, 2].sum() + load[:, 2].sum(),
    }
    panel = Panel(
        result, scene, "under 0.6 kN/m2 of snow", view=(-62.0, 34.0), frames={"form, without snow": form.particles}
    )
    return Outcome(numbers, [panel, graph(module)])


def graph(module: ModuleType) -> Graph:
    """How far the middle goes down by snow and prestress."""
    dots = {}
    for part, name in ((0.5, "half the prestress"), (1.0, "as it is"), (2.0, "twice the prestress")):
        nets = [module.scene(snow=snow, density=10.0 * part, edge_density=150.0 * part) for snow in SNOWS]
        heights = np.array([relax(net).particles[len(net.particles) // 2, 2] for net in nets])
        dots[name] = (np.array(SNOWS), heights[0] - heights)
    return Graph("More prestress, less movement", "snow [kN/m2]", "middle goes down by [m]", lines=dots, dots=dots)
