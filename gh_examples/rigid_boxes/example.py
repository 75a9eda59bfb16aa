"""A wall of loose bricks: how far it settles, what the slab carries, and that nothing moves aside or tilts."""

from pathlib import Path

import numpy as np

from hookean import relax
from hookean.commands.examples import Outcome, defaults, figure
from hookean.pictures.sheet import Graph, Panel


def run(folder: Path) -> Outcome:
    module = figure(folder)
    given = defaults(module.scene)
    scene = module.scene()
    result = relax(scene)
    start = np.asarray(scene.particles).reshape(-1, 8, 3)[1:]
    boxes = result.particles.reshape(-1, 8, 3)[1:]
    moved = boxes.mean(axis=1) - start.mean(axis=1)
    course = module.bricks(given["courses"], given["across"], given["gap"])[2]
    tilt = np.degrees(np.arctan(np.ptp(boxes[:, :4, 2], axis=1) / np.ptp(boxes[:, :4, 0], axis=1))).max()
    numbers = {
        "height of the wall": boxes[:, :, 2].max(),
        "sinking of the lowest course": -boxes[course == 0][:, :4, 2].mean(),
        "force on the slab": result.reactions["force"][:, 2].sum(),
        "movement aside, largest": np.abs(moved[:, :2]).max(),
        "tilt of a brick, largest": tilt,
    }
    depths = module.sinking(given["courses"], given["gap"], given["weight"], given["strength"])
    heights = [boxes[course == i][:, :4, 2].mean() for i in range(given["courses"])]
    tops = [0.0, *(boxes[course == i][:, 4:, 2].mean() for i in range(given["courses"] - 1))]
    graph = Graph(
        "k A d = the weight above", "course [-]", "depth in the one below [mm]",
        lines={"closed form": (np.arange(len(depths)) + 1.0, 1e3 * depths)},
        dots={"hookean": (np.arange(len(depths)) + 1.0, 1e3 * (np.array(tops) - heights))},
    )  # fmt: skip
    return Outcome(numbers, [Panel(result, scene, f"{len(boxes)} loose bricks at rest", view=(-60.0, 0.0)), graph])
