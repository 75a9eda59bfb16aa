"""Figures 9.7 and 9.8: an anchor of a running cable is moved, the form follows; then it is put back."""

from pathlib import Path

import numpy as np

from hookean import Script, Simulation
from hookean.commands.examples import Outcome
from hookean.files.relax_file import read_scene
from hookean.pictures.sheet import Graph, Panel


def run(folder: Path) -> Outcome:
    scene = read_scene(folder / "model.3dm", folder / "recipe.toml")
    running = Simulation(scene, Script.read((folder / "script.toml").read_text(encoding="utf-8")))
    times, lengths, results = [0.0], [length(running)], [running.result()]
    while running.status == "running":
        running.step()  # 0.2 s
        times.append(running.state.time)
        lengths.append(length(running))
        results.append(running.result())
    moved = results[120]  # at 24 s; it was still at rest at 10 s, frame 50
    numbers = {
        "length before": lengths[50],
        "length while moved": lengths[120],
        "lowest point while moved": moved.particles[:, 2].min(),
        "largest force while moved": moved.force("cable")["force"].max(),
        "length put back, change": abs(lengths[-1] - lengths[50]),
    }
    running.reset()  # in the original the supports would be lost now
    again = running.relax()
    numbers["reactions after a reset"] = again.reactions["force"][:, 2].sum()
    numbers["length after a reset, change"] = abs(length(running) - lengths[50])
    shown = {f"{times[i]:.1f} s": results[i].particles for i in (50, 54, 57, 60)}
    graph = Graph("The form follows and comes back", "time [s]", "length [m]", lines={"cable": (times, lengths)})
    return Outcome(numbers, [Panel(moved, scene, "Moved: at 24 s, and on the way", frames=shown), graph])


def length(running: Simulation) -> float:
    return float(np.asarray(running.result().force("cable")["length"]).sum())
