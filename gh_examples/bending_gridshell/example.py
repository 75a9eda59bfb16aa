"""An elastic gridshell, and one rod against Euler's elastica and against bars link by link."""

from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

from hookean import Result, Scene, relax
from hookean.commands.examples import Outcome, defaults, figure
from hookean.pictures.sheet import Graph, Panel

STEP = 0.001  # parts of a length, to either side


def run(folder: Path) -> Outcome:
    module = figure(folder)
    given = defaults(module.scene)
    lines, _ = module.net(given["rods"], given["length"], given["bump"])
    scene = module.scene()
    result = relax(scene)
    rod = result.particles[lines[-1]]
    rise, thrust = elastica(given["shortened"], given["length"], given["bending"])
    less, more = (relax(module.scene(shortened=given["shortened"] + step)) for step in (-STEP, STEP))
    pushes = thrusts(result, scene)
    work = (more.energy["total"] - less.energy["total"]) / (2.0 * STEP * given["length"])
    shell = result.particles[: lines[-1, 0]]
    numbers = {
        "rod: rise": rod[:, 2].max(),
        "rod: thrust": pushes[-1],
        "rod: rise over that of the elastica": rod[:, 2].max() / rise,
        "rod: thrust over that of the elastica": pushes[-1] / thrust,
        "rods: energy by movement, over their thrusts": work / pushes.sum(),
        "net: reactions upwards, sum": float(result.reactions["force"][:, 2].sum()),
        "net: difference after a quarter turn, largest": turned(shell),
    }
    panel = Panel(result, scene, "ends a tenth closer", view=(-66.0, 26.0))
    return Outcome(numbers, [panel, graph(module, given, lines[-1])])


def elastica(shortened: float, length: float, bending: float) -> tuple[float, float]:
    """Rise [m] and thrust [N] of an inextensible rod between pins that are a part `shortened` closer than it is long:
    2 E(k) / K(k) - 1 of its length apart, P = 4 K^2 EI / L^2, rise k L / K (Euler, 1744; Love, 1927, article 262)."""
    m = brentq(lambda m: 2.0 * ellipe(m) / ellipk(m) - 2.0 + shortened, 1e-9, 0.9)
    return float(np.sqrt(m) * length / ellipk(m)), float(4.0 * ellipk(m) ** 2 * bending / length**2)


def thrusts(result: Result, scene: Scene) -> np.ndarray:
    """Of each rod [N], the single one last: what both of its ends are pushed inwards by, along the rod, halved."""
    held = dict(zip(result.reactions["particles"].tolist(), result.reactions["force"], strict=True))
    ends = np.asarray(scene.anchors[0].particles).reshape(-1, 2)
    along = result.particles[ends[:, 1]] - result.particles[ends[:, 0]]
    along /= np.linalg.norm(along, axis=1)[:, None]
    pushes = np.array([[held[a], held[b]] for a, b in ends.tolist()])
    return 0.5 * ((pushes[:, 0] - pushes[:, 1]) * along).sum(axis=1)


def turned(x: np.ndarray) -> float:
    """How far the furthest particle is from any, after a quarter turn about the axis [m]."""
    other = np.column_stack([-x[:, 1], x[:, 0], x[:, 2]])
    return float(np.linalg.norm(other[:, None] - x[None], axis=2).min(axis=1).max())


def graph(module: ModuleType, given: dict[str, Any], rod: np.ndarray) -> Graph:
    """Rise of the single rod by how much closer its ends are."""
    parts = np.linspace(0.002, 0.32, 160)
    closer = np.array([0.02, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3])
    shapes = [relax(module.scene(shortened=part)).particles for part in closer]
    rises = np.array([elastica(part, given["length"], given["bending"])[0] for part in parts])
    return Graph(
        "One rod rises as the elastica does", "ends closer, part of the length [-]", "rise [m]",
        lines={"elastica": (parts, rises)},
        dots={"single rod, hookean": (closer, np.array([x[rod, 2].max() for x in shapes]))},
    )  # fmt: skip
