"""A cloth on a ball: how it hangs, how the ball carries it, and that it is as symmetric as what it is made of."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from hookean import Result, relax
from hookean.commands.examples import Outcome, defaults, figure
from hookean.discretize import quads
from hookean.pictures.sheet import Graph, Panel


def run(folder: Path) -> Outcome:
    module = figure(folder)
    given = defaults(module.scene)
    scene = module.scene()
    result = relax(scene)
    count = given["divisions"] + 1
    x = result.particles[:-1]
    rows = x.reshape(count, count, 3)
    top = given["radius"] + module.THICK
    depth = top - np.linalg.norm(x, axis=1)
    pushes = np.asarray(result.force("ball")["force"])
    weight = given["weight"] * given["side"] ** 2
    turned = np.stack([-rows[..., 1], rows[..., 0], rows[..., 2]], axis=-1)
    numbers = {
        "depth of a corner under the top": top - rows[0, 0, 2],
        "depth of the middle of an edge under the top": top - rows[0, count // 2, 2],
        "width of the cloth, corner to corner": np.linalg.norm(rows[0, 0] - rows[-1, -1]),
        "energy of weight, threads, bending and contact": result.energy["total"],
        "deepest vertex, below the surface of the ball": depth.max(),
        "contact forces upwards, over the weight": pushes[:-1, 2].sum() / weight,
        "contact forces sideways, largest sum": np.abs(pushes[:-1, :2].sum(axis=0)).max(),
        "force on the holder of the top": np.linalg.norm(holder(result, len(x))),
        "difference after a quarter turn, largest": np.abs(np.rot90(rows, -1) - turned).max(),
    }
    panel = Panel(drawn(result, given["radius"]), title="at rest", view=(-68.0, 16.0))
    return Outcome(numbers, [panel, graph(rows, given["radius"])])


def holder(result: Result, cloth: int) -> np.ndarray:
    """What holds the middle of the cloth sideways [N]; the ball is the last particle."""
    held = np.asarray(result.reactions["particles"])
    return np.asarray(result.reactions["force"])[held < cloth]


def drawn(result: Result, radius: float) -> Result:
    """The result as its picture shows it: the ball, the cloth and the forces of its threads."""
    half = np.linspace(-0.5 * np.pi, 0.5 * np.pi, 21)
    turn, rise = np.meshgrid(np.linspace(0.0, 2.0 * np.pi, 41), half, indexing="ij")
    out = radius * np.cos(rise)
    ball = quads(np.stack([out * np.cos(turn), out * np.sin(turn), radius * np.sin(rise)], axis=-1))
    shown = {"name": "ball", "kind": "mesh", "vertices": ball.vertices, "faces": ball.faces}
    none = {name: rows[:0] for name, rows in result.reactions.items()}
    return replace(result, geometry=[*result.geometry, shown], forces=[result.force("threads")], reactions=none)


def graph(rows: np.ndarray, radius: float) -> Graph:
    """Sections of the cloth: along its middle thread and along its diagonal."""
    half = len(rows) // 2
    middle, diagonal = rows[half:, half], rows[np.arange(half, len(rows)), np.arange(half, len(rows))]
    turn = np.linspace(0.0, 0.5 * np.pi, 46)
    lines = {"ball": (radius * np.sin(turn), radius * np.cos(turn))}
    dots = {}
    for name, line in (("middle thread", middle), ("diagonal", diagonal)):
        dots[name] = lines[name] = (np.linalg.norm(line[:, :2], axis=1), line[:, 2])
    return Graph("Two sections", "distance from the axis [m]", "height over the centre [m]", lines=lines, dots=dots)
