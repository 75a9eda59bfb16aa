"""Section 9.7: a mesh sphere falls onto the floor; springs alone crumple, with Shell it keeps its shape."""

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from hookean import Result, Scene, Simulation
from hookean.commands.examples import Outcome
from hookean.discretize import edges, remove_duplicate_lines, volume
from hookean.files.relax_file import read_scene
from hookean.pictures.sheet import Graph, Panel
from hookean.stability.time_steps import stable_time_step

SECONDS = 8.0
VIEW = (-30.0, 12.0)  # degrees


@dataclass
class Fall:
    """A fall frame by frame: time [s], height, volume and lowest point of the sphere [m, m3, m]."""

    scene: Scene
    time: list[float] = field(default_factory=list)
    height: list[float] = field(default_factory=list)
    volume: list[float] = field(default_factory=list)
    bottom: list[float] = field(default_factory=list)
    mass: float = 0.0
    critical_step: float = 0.0
    result: Result | None = None

    def run(self) -> "Fall":
        running = Simulation(self.scene)
        self.mass = running.system.mass.sum()
        self.critical_step = stable_time_step(running.system, running.state)
        while True:
            x, now = running.state.x, running.state.time
            self.time.append(now)
            self.height.append(np.ptp(x[:, 2]))
            self.volume.append(volume((x, self.scene.meshes["layer:sphere"].faces)))
            self.bottom.append(x[:, 2].min())
            if now > SECONDS - 1e-6:
                self.result = running.result()
                return self
            running.step()


def drawn_lines(scene: Scene) -> np.ndarray:
    """Edges, and the lines between opposite corners of each face: those of triangles, a b c c, lie on edges."""
    mesh = scene.meshes["layer:sphere"]
    opposite = mesh.faces[:, [[0, 2], [1, 3]]].reshape(-1, 2)
    return mesh.vertices[np.concatenate([edges((mesh.vertices, mesh.faces)), opposite])]


def too_fast(scene: Scene) -> tuple[bool, bool]:
    """Whether a step of 0.01 s is warned of before the start, and whether it explodes within a second."""
    running = Simulation(scene)
    running.patch({"settings": {"time_step": 0.01}})
    warned = any("/settings/time_step: 0.01 s is too large" in text for text in running.system.report.warnings)
    return warned, running.step(20) == "diverged"


def first_contact(fall: Fall) -> float:
    """Time [s] at which the lowest point reaches z = 0, by a parabola through the last three frames in the air.

    In the air each frame falls further than the one before; the first that does not has met the floor.
    """
    landed = 2 + int(np.argmax(np.diff(fall.bottom, 2) > 0.0))
    last = slice(landed - 3, landed)
    return float(np.polyfit(fall.bottom[last], fall.time[last], 2)[-1])


def run(folder: Path) -> Outcome:
    scenes = {"springs": "recipe-springs.toml", "shell": "recipe.toml"}
    falls = {name: Fall(read_scene(folder / "model.3dm", folder / recipe)).run() for name, recipe in scenes.items()}
    springs, shell = falls["springs"], falls["shell"]
    assert springs.result is not None and shell.result is not None
    lines = drawn_lines(springs.scene)
    warned, exploded = zip(*[too_fast(fall.scene) for fall in falls.values()], strict=True)
    numbers = {
        "springs": len(springs.result.force("edges")["force"]) + len(springs.result.force("diagonals")["force"]),
        "lines left without duplicates": len(remove_duplicate_lines(lines)),
        "duplicate lines": len(lines) - len(remove_duplicate_lines(lines)),
        "mass": springs.mass,
        "volume as drawn": springs.volume[0],
        "fallen after 1 s": springs.bottom[0] - springs.bottom[round(1.0 / 0.02)],
        "first contact": first_contact(springs),
        "critical step, springs alone": springs.critical_step,
        "critical step, with Shell": shell.critical_step,
        "runs warned of a step of 0.01 s": sum(warned),
        "runs that explode with it": sum(exploded),
        "height kept, springs alone": kept(springs.height),
        "volume kept, springs alone": kept(springs.volume),
        "height kept, with Shell": kept(shell.height),
        "volume kept, with Shell": kept(shell.volume),
    }
    return Outcome(numbers, panels(springs, shell), columns=2)


def kept(history: list[float]) -> float:
    """The last as a part of the first [%]."""
    return 100.0 * history[-1] / history[0]


def panels(springs: Fall, shell: Fall) -> list[Panel | Graph]:
    names = {"Springs alone, k = 5000 N/m": springs, "With Shell, strength 500 N m": shell}
    before = {"before the fall": springs.scene.meshes["layer:sphere"].vertices}
    seen: list[Panel | Graph] = [
        Panel(fall.result, fall.scene, title=f"{name}: after {SECONDS:g} s", view=VIEW, frames=before)
        for name, fall in names.items()
    ]
    for what, title in (("height", "Height kept"), ("volume", "Volume kept")):
        histories = {name: np.array(getattr(fall, what)) for name, fall in names.items()}
        seen.append(
            Graph(
                title=title,
                x_label="time [s]",
                y_label=f"{what} [% of the start]",
                lines={n: (np.array(names[n].time), 100.0 * h / h[0]) for n, h in histories.items()},
            )
        )
    return seen
