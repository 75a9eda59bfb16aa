"""Figure 9.32: the concert hall ribbon, a membrane stretched over two free-form beams and eleven arcs."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from hookean import Simulation
from hookean.commands.examples import Outcome
from hookean.discretize import area, quads
from hookean.files.relax_file import read_scene
from hookean.pictures.sheet import Panel

ARCS, BAY = 11, 6  # quads of a bay along the beams: `divide` of the recipe is 10 bays of 6


def run(folder: Path) -> Outcome:
    scene = read_scene(folder / "model.3dm", folder / "recipe.toml")
    ribbon = Simulation(scene)
    drawn = ribbon.result()
    result = ribbon.relax()
    # the particles of a surface come row by row: (along the beams, from beam to beam, 3)
    start, x = (np.reshape(r.particles, (BAY * (ARCS - 1) + 1, -1, 3)) for r in (drawn, result))
    force = {name: result.force(name)["force"] for name in ("across", "along")}
    numbers = {
        "area of the surface drawn": area(quads(start)),
        "area": area(quads(x)),
        "smallest force across": force["across"].min(),
        "largest force across": force["across"].max(),
        "smallest force along": force["along"].min(),
        "largest force along": force["along"].max(),
        "slack springs": sum((f <= 0.0).sum() for f in force.values()),
        "farthest from its beam or arc": 1000.0 * max(f["distance"].max() for f in result.forces if "distance" in f),
        "farthest from where it was drawn": np.linalg.norm(x - start, axis=2).max(),
        "farthest slid along a beam": np.linalg.norm(x - start, axis=2)[:, [0, -1]].max(),
        "saddle-shaped between the arcs": saddles(x),
        "saddle-shaped as drawn": saddles(start),
    }
    titles = (
        f"As drawn: beams, arcs and a surface through them, {area(quads(start)):.1f} m²",
        f"Relaxed: a saddle in every bay, {area(quads(x)):.1f} m², all springs in tension",
    )
    panels = [
        Panel(with_lines(shape, scene, start), scene, title=title, view=(-66.0, 32.0))
        for shape, title in zip((drawn, result), titles, strict=True)
    ]
    return Outcome(numbers, panels, columns=1, size=(1800, 1950))


def saddles(x):
    """How many particles between the arcs lie in a saddle [%]: the four angles around them exceed 360 degrees."""
    middle = x[1:-1, 1:-1]
    arms = [y - middle for y in (x[2:, 1:-1], x[1:-1, 2:], x[:-2, 1:-1], x[1:-1, :-2])]
    arms = [arm / np.linalg.norm(arm, axis=2, keepdims=True) for arm in arms]
    angles = sum(np.arccos((a * b).sum(axis=2)) for a, b in zip(arms, [*arms[1:], arms[0]], strict=True))
    between = np.arange(1, len(x) - 1) % BAY > 0
    return 100.0 * (angles[between] > 2.0 * np.pi).mean()


def with_lines(result, scene, start):
    """For the picture: the membrane with its beams and arcs as lines, not with the arrows of their pulls."""
    springs = [force for force in result.forces if force["kind"] == "springs"]
    none = {name: rows[:0] for name, rows in result.reactions.items()}
    drawn = [force.curve for force in scene.forces if force.kind == "pull_to_curve"]
    lines = [{"kind": "polyline", "points": points} for points in (*drawn, start[0], start[-1])]
    return replace(result, forces=springs, reactions=none, geometry=[*result.geometry, *lines])
