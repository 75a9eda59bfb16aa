"""Figure 9.9: a cable with a third anchor, and one whose third anchor meets no particle."""

from pathlib import Path

import numpy as np

from hookean import Scene, relax
from hookean.commands.examples import Outcome
from hookean.files.relax_file import read_scene
from hookean.pictures.sheet import Panel


def run(folder: Path) -> Outcome:
    three = read_scene(folder / "scene.json")
    between = read_scene(folder / "scene-between.json")
    two = Scene.read({**three.model_dump(), "anchors": [three.anchors[0]]})
    held, stray, free = relax(three), relax(between), relax(two)
    (unmatched,) = stray.report.unmatched
    z = held.particles[:, 2]
    lift = dict(zip(held.reactions["particles"].tolist(), held.reactions["force"][:, 2], strict=True))
    third = sorted(lift)[1]
    numbers = {
        "sag with two anchors": -free.particles[:, 2].min(),
        "sag of the left part": -z[: third + 1].min(),
        "sag of the right part": -z[third:].min(),
        "lift of the third anchor": lift[third],
        "lift of all anchors": sum(lift.values()),
        "sag with an anchor between particles": -stray.particles[:, 2].min(),
        "distance of that anchor from a particle": unmatched.distance,
    }
    place = {"where the third anchor is": np.array([[4.5, 0.0, -0.4], [4.5, 0.0, 0.4]])}
    panels = [
        Panel(free, two, "two anchors", view="front"),
        Panel(held, three, "a third anchor at a particle", view="front"),
        Panel(
            stray, between, "third anchor between particles: no influence", view="front",
            frames={"start": between.particles}, curves=place,
        ),
    ]  # fmt: skip
    return Outcome(numbers, panels, columns=1)
