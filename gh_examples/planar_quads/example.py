"""Quads become flat: a roof near its drawing and without it, a surface of translation that stays, and a single quad."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from hookean import Result, relax
from hookean.commands.examples import Outcome, defaults, figure
from hookean.pictures.sheet import Graph, Panel

NEAR = (1.0, 0.3, 0.1, 0.03, 0.01, 0.003, 0.001, 0.0003, 0.0001)  # N/m


def run(folder: Path) -> Outcome:
    module = figure(folder)
    divisions = defaults(module.scene)["divisions"]
    count, vertices = divisions**2, (divisions + 1) ** 2
    scene = module.scene()
    drawn = np.asarray(scene.particles)
    faces = scene.meshes["quads"].faces
    result = relax(scene)
    free, near = relax(module.scene(nearness=0.0)), relax(module.scene(nearness=0.03))
    moved = np.linalg.norm(result.particles - drawn, axis=1)
    numbers = {
        "as drawn: largest distance of diagonals": apart(drawn, faces[:count]).max(),
        "near the drawing: largest distance of diagonals": apart(near.particles, faces[:count]).max(),
        "near the drawing: largest movement": np.linalg.norm(near.particles - drawn, axis=1)[:vertices].max(),
        "without the drawing: largest distance of diagonals": apart(free.particles, faces[:count]).max(),
        "without the drawing: angles of a quad, furthest from 360": np.abs(angles(free.particles, faces) - 360.0).max(),
        "translation: largest distance of diagonals": apart(result.particles, faces[count:-1]).max(),
        "translation: largest movement": moved[vertices:-4].max(),
        "single quad: distance of diagonals as drawn": apart(drawn, faces[-1:])[0],
        "single quad: movement of a corner": moved[-4:].max(),
    }
    frames = {"as drawn": drawn}
    title = "a roof, a surface of translation, a single quad"
    panel = Panel(replace(result, forces=[]), None, title, view=(-62.0, 32.0), frames=frames)
    results = [relax(module.scene(nearness=strength)) for strength in NEAR]
    return Outcome(numbers, [panel, graph(results, drawn, vertices, faces)], columns=1)


def apart(x: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """Distances between the diagonals of quads [m]: six times a tetrahedron over the area that they span."""
    a, b, c, d = (x[faces[:, i]] for i in range(4))
    normal = np.cross(c - a, d - b)
    return np.abs(((b - a) * normal).sum(axis=1)) / np.linalg.norm(normal, axis=1)


def angles(x: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """Sums of the four angles of quads [degrees]: 360 where they are flat, less elsewhere."""
    total = np.zeros(len(faces))
    for i in range(4):
        one, other = (x[faces[:, (i + k) % 4]] - x[faces[:, i]] for k in (1, 3))
        total += np.arctan2(np.linalg.norm(np.cross(one, other), axis=1), (one * other).sum(axis=1))
    return np.degrees(total)


def graph(results: list[Result], drawn: np.ndarray, vertices: int, faces: np.ndarray) -> Graph:
    """Flatness of the roof and its distance from the drawing, by what keeps it there."""
    roof = faces[: (len(faces) - 1) // 2]
    flat = np.array([apart(result.particles, roof).max() for result in results])
    moved = np.array([np.linalg.norm(result.particles - drawn, axis=1)[:vertices].max() for result in results])
    lines = {"distance of diagonals": (np.array(NEAR), flat), "movement": (np.array(NEAR), moved)}
    return Graph(
        "Flatter, and further from the drawing", "strength of the drawing [N/m], flatness 1 N/m",
        "largest in the roof [m]", lines=lines, dots=lines, x_log=True, y_log=True,
    )  # fmt: skip
