"""A sail in a stream of wind: the load of every moment comes from a table of speeds."""

from pathlib import Path

import numpy as np

from hookean import Script, Simulation
from hookean.commands.examples import Outcome
from hookean.files.relax_file import read_scene
from hookean.pictures.sheet import Graph, Panel


def run(folder: Path) -> Outcome:
    scene = read_scene(folder / "model.3dm", folder / "recipe.toml")
    script = Script.read((folder / "script.toml").read_text(encoding="utf-8"))
    running = Simulation(scene, script, folder / "wind.csv")
    results = [running.result()]
    while not running.over:
        running.step()  # 0.1 s
        results.append(running.result())
    times = np.array([result.time for result in results])
    forces = np.array([result.force("edge")["force"].max() for result in results])
    loads = np.array([np.linalg.norm(result.force("wind")["force"], axis=1).max() for result in results])
    gust, last = int(forces.argmax()), results[-1]
    start = scene.meshes[scene.geometry[0].mesh].vertices
    middle = int(np.hypot(*(start[:, :2] - 3.0).T).argmin())
    numbers = {
        "largest load on a particle": loads.max(),
        "largest force in an edge, in the gust": forces[gust],
        "time of the largest force": times[gust],
        "height of the middle at a steady 12 m/s": last.particles[middle, 2],
        "largest force in an edge at a steady 12 m/s": forces[-1],
    }
    speed = np.loadtxt(folder / "wind.csv", delimiter=",", skiprows=1)
    steps = np.repeat(speed, 2, axis=0)
    lull = 120  # at 12 s
    panels = [
        Panel(results[lull], scene, f"In a lull, {times[lull]:.1f} s", view=(-60, 15)),
        Panel(
            results[gust],
            scene,
            f"In the gust, {times[gust]:.1f} s",
            view=(-60, 15),
            frames={"in the lull": results[lull].particles},
        ),
        Graph("The stream", "time [s]", "speed [m/s]", lines={"wind": (steps[1:, 0], steps[:-1, 1])}),
        Graph("What it does", "time [s]", "largest force [N]", lines={"in an edge": (times, forces)}),
    ]
    return Outcome(numbers, panels, columns=2)
