"""Figure 9.9: a cable with a third anchor, and one whose third anchor meets no particle."""

from pathlib import Path

import numpy as np

from hookean import relax
from hookean.commands.examples import Outcome, figure
from hookean.pictures.sheet import Panel

LEFT, RIGHT = (0.0, 0.0, 0.0), (10.0, 0.0, 0.0)


def run(folder: Path) -> Outcome:
    scene = figure(folder).scene
    three, two = scene(), scene(anchors=(LEFT, RIGHT))
    between = scene(anchors=(LEFT, (4.5, 0.0, 0.0), RIGHT), strict=False)
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
