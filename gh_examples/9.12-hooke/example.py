"""Figures 9.12 and 9.13: Hooke's law. A spring of 80 cm under several loads, of several stiffnesses and dampings."""

from pathlib import Path

import numpy as np

from hookean import Scene, Simulation, relax, simulate
from hookean.commands.examples import Outcome, figure
from hookean.pictures.sheet import Graph, Panel

STIFFNESSES = (1.0, 2.0, 4.0, 8.0)  # N/cm
DAMPINGS = {1.0: 5, 10.0: 20, 100.0: 80}  # N s/cm: time steps of 0.01 s in a frame, as slow as the motion


def run(folder: Path) -> Outcome:
    make = figure(folder).scene
    scene = make()
    running = Simulation(scene)
    loaded = running.relax()
    running.patch({"forces": {"weight": {"vector": [0, 0, 0]}}})
    unloaded = running.relax()
    row_scene = make(weight=(0.0, 25.0, 50.0, 75.0, 100.0))
    row = relax(row_scene)
    stretched = row.force("cable")["length"] - 80.0
    extensions = [length(relax(make(stiffness=k))) - 80.0 for k in STIFFNESSES]
    paths = {f"damping {c:g} N s/cm": path(make(damping=c, sub_iterations=steps)) for c, steps in DAMPINGS.items()}
    numbers = {
        "length under the load": length(loaded),
        "extension": length(loaded) - 80.0,
        "length without the load": length(unloaded),
        **{f"extension under {25 * i} N": stretched[i] for i in range(5)},
        **{f"extension at {k:g} N/cm": x for k, x in zip(STIFFNESSES, extensions, strict=True)},
        **{f"length at last, {name}": lengths[-1] for name, (_, lengths) in paths.items()},
        **{f"time to settle, {name}": settled(*both) for name, both in paths.items()},
    }
    k = np.linspace(0.8, 8.2, 200)
    law = Graph(
        "stiffness and extension under 100 N", "stiffness k [N/cm]", "extension X [cm]",
        lines={"X = F / k": (k, 100.0 / k)}, dots={"hookean": (np.array(STIFFNESSES), np.array(extensions))},
    )  # fmt: skip
    over_time = [
        Graph(title, "time [s]", "length [cm]", {name: (t[t <= end], x[t <= end]) for name, (t, x) in paths.items()})
        for title, end in (("the first 20 s", 20.0), ("300 s: the same end", 300.0))
    ]
    level = {"length without load, 80 cm": np.array([[-10.0, 0.0, -80.0], [130.0, 0.0, -80.0]])}
    hanging = Panel(row, row_scene, "2 N/cm under 0, 25, 50, 75 and 100 N", view="front", curves=level)
    return Outcome(numbers, [hanging, law, *over_time], columns=2)


def length(result) -> float:
    return float(result.force("cable")["length"][0])


def path(scene: Scene) -> tuple[np.ndarray, np.ndarray]:
    """Times [s] and lengths [cm] of the falling weight, until it is at rest or for 500 frames."""
    seen = [(frame.time, -frame.particles[1, 2]) for frame in simulate(scene, 500)]
    return np.array(seen).T[0], np.array(seen).T[1]


def settled(times: np.ndarray, lengths: np.ndarray) -> float:
    """The last time [s] at which the length is more than 0.5 cm away from 130 cm."""
    return float(times[np.abs(lengths - 130.0) > 0.5][-1])
