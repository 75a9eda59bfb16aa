"""The Basento study: a skin in tension, then the same geometry with every force reversed, in compression."""

from pathlib import Path

import numpy as np

from hookean import Result, Scene, relax
from hookean.commands.examples import Outcome
from hookean.files.relax_file import read_scene
from hookean.pictures.sheet import Panel

CONCRETE = 5e6  # kN/m, a strut of concrete about 0.3 m by 1 m, 1.8 m long: E A / l with E = 30 GPa


def reverse(result: Result, nudge: float = 0.0) -> Scene:
    """The found shape with every force turned round; the middle pressed down by `nudge` [m] to see what follows.

    For each cable a strut so much longer than its place that it pushes as hard as the cable pulled: rest length =
    length + tension / k. The feet stay. The deck, which held up the fingers, now presses down on them: the vertical
    part of what held them becomes a load, the horizontal part stays with the deck.
    """
    struts = [
        {
            "kind": "springs",
            "name": columns["name"],
            "particles": columns["particles"],
            "stiffness": CONCRETE,
            "rest_length": columns["length"] + columns["force"] / CONCRETE,
        }
        for columns in result.forces
    ]
    held, names = result.reactions["particles"], np.array(result.reactions["names"])
    feet, fingers = held[names == "feet"], held[names == "fingers"]
    start = result.particles.copy()
    start[len(start) // 2, 2] -= nudge
    pressed = -result.reactions["force"][names == "fingers"] * [0, 0, 1]
    return Scene(
        units=result.units,
        particles=start,
        forces=[*struts, {"kind": "unary", "name": "deck", "particles": fingers, "vector": pressed}],
        anchors=[{"name": "feet", "particles": feet}, {"name": "fingers", "particles": fingers, "axes": "xy"}],
        meshes={"skin": {"vertices": start, "faces": result.geometry[0]["faces"]}},
        geometry=[
            {"name": "skin", "kind": "mesh", "mesh": "skin"},
            {"name": "deck", "kind": "lines", "lines": result.geometry[1]["lines"]},
        ],
        settings={"tolerance": 1e-9, "max_iterations": 1000, "allow_unstable": True},
    )


def forces(result: Result) -> np.ndarray:
    """Of every cable or strut, tension + [kN]."""
    return np.concatenate([columns["force"] for columns in result.forces if columns["kind"] == "springs"])


def work(result: Result) -> float:
    """Sum of force times length [kN m]."""
    return sum((c["force"] * c["length"]).sum() for c in result.forces if c["kind"] == "springs")


def area(mesh: dict) -> float:
    """Of quads, each the mean of its two cuts into triangles [m2]."""
    a, b, c, d = np.asarray(mesh["vertices"])[mesh["faces"]].transpose(1, 0, 2)
    cuts = (np.cross(b - a, c - a), np.cross(c - a, d - a), np.cross(b - a, d - a), np.cross(c - b, d - b))
    return 0.25 * sum(np.linalg.norm(n, axis=1).sum() for n in cuts)


def run(folder: Path) -> Outcome:
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
        "area of the skin": area(tension.geometry[0]),
        "height over the pier": middle[np.abs(middle[:, 0]).argmin(), 2],
        "lowest height on the middle line": middle[:, 2].min(),
    }
    view = (-64.0, 24.0)
    panels = [
        Panel(tension, scene, "stretched: every force a tension", view),
        Panel(compression, reversed_scene, "reversed: the same forces press, the deck rests on the fingers", view),
    ]
    return Outcome(numbers, panels, columns=1)
