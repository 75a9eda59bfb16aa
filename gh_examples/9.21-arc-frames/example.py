"""Figure 9.21: the positions an arc passes through on its way down to the catenary, in physical time."""

from pathlib import Path

import numpy as np

from hookean import relax, simulate
from hookean.commands.examples import Outcome
from hookean.discretize.catenary import catenary
from hookean.files.relax_file import read_scene
from hookean.pictures.sheet import Graph, Panel


def run(folder: Path) -> Outcome:
    scene = read_scene(folder / "model.3dm", folder / "recipe.toml")
    frames = list(simulate(scene, frames=150))  # 30 s
    result = relax(scene)
    drawn = catenary(result.particles[0], result.particles[-1], 20.0, count=200)
    half = len(scene.forces[0].lines) // 2
    middle = np.array([frame.particles[half, 2] for frame in frames])
    time = np.array([frame.time for frame in frames])
    numbers = {f"height of the middle after {t} s": np.interp(t, time, middle) for t in (4, 8, 12, 16, 20)}
    numbers["equilibrium: height of the middle"] = result.particles[half, 2]
    numbers["equilibrium: length"] = result.force("cable")["length"].sum()
    shown = {f"{round(f.time)} s": f.particles for f in frames[:80:10]}
    panels = [
        Panel(result, scene, "A position every 2 s, and equilibrium", "front", shown, {"catenary of 20 m": drawn}),
        Graph("The middle falls, overshoots and comes to rest", "time [s]", "height [m]",
              lines={"middle of the cable": (time, middle),
                     "equilibrium": (time, np.full(len(time), result.particles[half, 2]))}),
    ]  # fmt: skip
    return Outcome(numbers, panels, columns=2)
