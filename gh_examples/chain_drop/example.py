"""A falling chain: its free end falls faster than a stone, and no energy is lost."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from hookean import Result, Scene, Simulation
from hookean.commands.examples import Outcome, defaults, figure
from hookean.pictures.sheet import Graph, Panel

SECONDS, FRAME = 1.2, 0.01
SEEN = (0.0, 0.6, 0.8, 1.0, 1.1)  # s: shapes in the picture
TIMES = (0.3, 0.6, 0.9, 1.2)


@dataclass
class Fall:
    """A fall frame by frame: times [s], shapes [m], velocity of the free end [m/s], energy [J]."""

    times: np.ndarray
    shapes: np.ndarray
    speeds: np.ndarray
    energies: np.ndarray
    result: Result

    def at(self, time: float) -> int:
        """Number of the frame at a time [s]."""
        return int(np.argmin(np.abs(self.times - time)))


def fall(scene: Scene) -> Fall:
    """Step through the fall, frame by frame."""
    running = Simulation(scene)
    rows = []
    while True:
        result, state = running.result(), running.state
        rows.append((state.time, state.x.copy(), state.v[-1].copy(), result.energy["total"]))
        if state.time > SECONDS - 0.5 * FRAME:
            times, shapes, speeds, energies = (np.array(column) for column in zip(*rows, strict=True))
            return Fall(times, shapes, speeds, energies, result)
        running.step()


def run(folder: Path) -> Outcome:
    module = figure(folder)
    given = defaults(module.scene)
    gravity = given["gravity"]
    scene = module.scene()
    fallen = fall(scene)
    depth = -fallen.shapes[:, -1, 2]
    stone = 0.5 * gravity * fallen.times**2
    weight = gravity * (given["links"] + 1)
    late = fallen.at(1.1)
    x = depth[late] / given["length"]
    narrow = np.sqrt(gravity * given["length"] * x * (2.0 - x) / (1.0 - x))
    numbers = {f"depth of the free end at {time:g} s": depth[fallen.at(time)] for time in TIMES}
    numbers |= {
        "ahead of a stone at 1.2 s": depth[-1] - stone[-1],
        "speed of the free end at 1.1 s": -fallen.speeds[late, 2],
        "speed of the free end at 1.1 s over that of a narrow fold": -fallen.speeds[late, 2] / narrow,
        "change of the energy, largest, over weight times length": np.abs(fallen.energies - fallen.energies[0]).max()
        / (weight * given["length"]),
    }
    frames = {f"{time:g} s": fallen.shapes[fallen.at(time)] for time in SEEN}
    shown = Panel(fallen.result, scene, "1.2 s after its release", view="front", frames=frames)
    return Outcome(numbers, [shown, graph(fallen, gravity, given["length"])])


def graph(fallen: Fall, gravity: float, length: float) -> Graph:
    """Depth by time: of the chain, of a stone, and of a chain whose fold has no width, by the energy of its arm:
    dt = ((L - x) / (g x (2 L - x)))^1/2 dx (Calkin and March, 1989), in steps of the root of x."""
    root = np.linspace(0.0, np.sqrt(length), 2001)
    rate = 2.0 * np.sqrt(np.maximum(length - root**2, 0.0) / (gravity * (2.0 * length - root**2)))
    times = np.concatenate([[0.0], np.cumsum(0.5 * (rate[1:] + rate[:-1]) * np.diff(root))])
    seen = slice(0, None, 6)
    return Graph(
        "Faster than a stone", "time [s]", "depth [m]",
        lines={
            "narrow fold, closed form": (times, root**2),
            "stone, g t2 / 2": (fallen.times, 0.5 * gravity * fallen.times**2),
        },
        dots={"free end, hookean": (fallen.times[seen], -fallen.shapes[seen, -1, 2])},
    )  # fmt: skip
