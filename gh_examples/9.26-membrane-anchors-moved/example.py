"""Figure 9.26: the corners of a running membrane are led up and down; the form follows."""

from pathlib import Path

import numpy as np

from hookean import Script, Simulation
from hookean.commands.examples import Outcome
from hookean.files.relax_file import read_scene
from hookean.pictures.sheet import Panel


def run(folder: Path) -> Outcome:
    scene = read_scene(folder / "model.3dm", folder / "recipe.toml")
    running = Simulation(scene, Script.read((folder / "script.toml").read_text(encoding="utf-8")))
    shapes = {}
    for frame in range(1, 36):
        running.step()  # 0.2 s
        shapes[frame] = running.result()
    result = running.relax()  # what is left of the motion, to equilibrium
    start = scene.meshes[scene.geometry[0].mesh].vertices
    middle = np.hypot(*(start[:, :2] - 5.0).T).argmin()
    force = result.force("membrane")["force"]
    names, vertical = np.array(result.reactions["names"]), result.reactions["force"][:, 2]
    numbers = {
        "height of the middle": result.particles[middle, 2],
        "largest force": force.max(),
        "smallest force": force.min(),
        "carried by the rising corners": vertical[names == "rising"].sum(),
        "carried by all corners": vertical.sum(),
        "rising corners": result.particles[:, 2].max(),
    }
    panels = [Panel(shapes[i], scene, f"{shapes[i].time:.1f} s", view=(-60, 20)) for i in (10, 17, 25)]
    return Outcome(numbers, [*panels, Panel(result, scene, "in equilibrium", view=(-60, 20))], columns=2)
