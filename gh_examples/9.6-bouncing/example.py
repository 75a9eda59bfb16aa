"""Figure 9.6: the cable of figure 9.4 in motion, in seconds; it bounces until it is at rest."""

from pathlib import Path

import numpy as np

from hookean import Simulation
from hookean.commands.examples import Outcome
from hookean.files.relax_file import read_scene
from hookean.pictures.sheet import Graph, Panel


def run(folder: Path) -> Outcome:
    scene = read_scene(folder / "model.3dm", folder / "recipe.toml")
    running = Simulation(scene)  # frames of 50 steps of 1 ms
    frames = [running.frame()]
    while running.status == "running":
        running.step()
        frames.append(running.frame())
    times = np.array([frame.time for frame in frames])
    lengths = np.array([length(frame.particles) for frame in frames])
    sags = np.array([-frame.particles[:, 2].min() for frame in frames])
    numbers = {f"length at {times[i]:.1f} s": lengths[i] for i in (6, 12, 18, 24, 36)}
    numbers |= {"sag at 0.9 s": sags[18], "length at rest": lengths[-1], "sag at rest": sags[-1]}
    seen = {f"{times[i]:.1f} s": frames[i].particles for i in range(0, 37, 6)}
    graph = Graph(
        "It bounces", "time [s]", "sag [m]",
        lines={"sag": (times[:201], sags[:201]), "at rest": (times[[0, 200]], sags[[-1, -1]])},
    )  # fmt: skip
    return Outcome(
        numbers,
        [Panel(running.result(), scene, "The first 1.8 s, and at rest", view="front", frames=seen), graph],
        columns=1,
    )


def length(particles: np.ndarray) -> float:
    return float(np.linalg.norm(np.diff(particles, axis=0), axis=1).sum())
