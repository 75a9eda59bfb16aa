"""Figure 9.11: springs nearer the supports of a loaded cable stretch more."""

from pathlib import Path

import numpy as np

from hookean import relax
from hookean.commands.examples import Outcome, figure
from hookean.pictures.sheet import Graph, Panel


def run(folder: Path) -> Outcome:
    scene = figure(folder).scene()
    result = relax(scene)
    cable = result.force("cable")
    longer = cable["length"] - 2.0
    by_hooke = scene.forces[0].stiffness * longer
    numbers = {
        "length": cable["length"].sum(),
        "extension": longer.sum(),
        "extension of spring 1": longer[0],
        "extension of spring 2": longer[1],
        "extension of spring 3": longer[2],
        "spring 1 over spring 2": longer[0] - longer[1],
        "spring 2 over spring 3": longer[1] - longer[2],
        "difference of force and stiffness x extension": np.abs(cable["force"] - by_hooke).max(),
    }
    along = np.array([1.0, 3.0, 5.0, 7.0, 9.0])
    even = np.full(2, 100.0 * longer.mean())
    extensions = Graph(
        "extension of each spring", "middle of the spring at the start, from the left support [m]", "extension [cm]",
        lines={"an even share": (np.array([0.0, 10.0]), even)}, dots={"each spring": (along, 100.0 * longer)},
    )  # fmt: skip
    shape = Panel(result, scene, "in equilibrium", view="front", frames={"start": scene.particles})
    return Outcome(numbers, [shape, extensions], columns=1)
