"""The Basento study: a skin in tension, then the same geometry with every force reversed, in compression."""

from pathlib import Path

import numpy as np

from hookean import Result, relax
from hookean.commands.examples import Outcome, figure
from hookean.discretize import area
from hookean.files.relax_file import read_scene
from hookean.pictures.sheet import Panel


def forces(result: Result) -> np.ndarray:
    """Of every cable or strut, tension + [kN]."""
    return np.concatenate([columns["force"] for columns in result.forces if columns["kind"] == "springs"])


def work(result: Result) -> float:
    """Sum of force times length [kN m]."""
    return sum((c["force"] * c["length"]).sum() for c in result.forces if c["kind"] == "springs")


def run(folder: Path) -> Outcome:
    reverse = figure(folder).reverse
    scene = read_scene(folder / "model.3dm", folder / "recipe.toml")
    tension = relax(scene)
    reversed_scene = reverse(tension)
    compression = relax(reversed_scene)  # in equilibrium as it stands: nothing moves
    nudged = relax(reverse(tension, nudge=0.001))

    pull, push = forces(tension), forces(compression)
    held = tension.reactions["particles"]
    lift, press = tension.reactions["force"][:, 2], compression.reactions["force"][:, 2]
    foot = np.array(tension.reactions["names"]) == "feet"
    sideways = (tension.reactions["force"] + compression.reactions["force"])[:, :2]
    x = tension.particles
    middle = x[np.abs(x[:, 1]) < 1e-6]
    numbers = {
        "least tension": pull.min(),
        "greatest tension": pull.max(),
        "least compression": -push.max(),
        "greatest compression": -push.min(),
        "sum of a force and its reverse, largest": np.abs(pull + push).max(),
        "reactions and their reverse, largest sum": max(np.abs(sideways).max(), np.abs(lift + press)[foot].max()),
        "out of balance in compression": compression.out_of_balance,
        "iterations in compression": compression.iterations,
        "moved after a nudge of 1 mm": np.abs(nudged.particles - tension.particles).max(),
        "deck carried": -compression.force("deck")["force"][:, 2].sum(),
        "feet push up": press[foot].sum(),
        "force times length, in tension": work(tension),
        "force times length against Maxwell": work(tension) - (tension.reactions["force"] * x[held]).sum(),
        "area of the skin": area((x, tension.geometry[0]["faces"])),
        "height over the pier": middle[np.abs(middle[:, 0]).argmin(), 2],
        "lowest height on the middle line": middle[:, 2].min(),
    }
    view = (-64.0, 24.0)
    panels = [
        Panel(tension, scene, "stretched: every force a tension", view),
        Panel(compression, reversed_scene, "reversed: the same forces press, the deck rests on the fingers", view),
    ]
    return Outcome(numbers, panels, columns=1)
