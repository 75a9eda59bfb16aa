"""A hypar roof: the form, snow and wind on real cloth and ropes, what snow weighs and what carries it."""

from pathlib import Path

import numpy as np

from hookean import Result, load_cases
from hookean.commands.examples import Outcome
from hookean.files.relax_file import read_scene
from hookean.pictures.sheet import Panel

SNOW, DIVISIONS = 1.5 * 0.6, 16  # kN/m2, -


def plan(shape: Result) -> float:
    """The area inside of the edges [m2], seen from above: the shoelace formula."""
    x = shape.particles.reshape(DIVISIONS + 1, DIVISIONS + 1, 3)
    a, b = np.concatenate([x[:-1, 0], x[-1, :-1], x[:0:-1, -1], x[0, :0:-1]])[:, :2].T
    return 0.5 * abs(float(np.sum(a * np.roll(b, -1) - b * np.roll(a, -1))))


def run(folder: Path) -> Outcome:
    """Form, snow and wind."""
    scene = read_scene(folder / "model.3dm", folder / "recipe.toml")
    cases = load_cases(scene, ["ULS snow", "ULS wind"])
    form, snow, wind = cases.form, cases.cases["ULS snow"].result, cases.cases["ULS wind"].result
    edge = form.force("edge")
    loads, reactions = (snow.loads["resultant"].sum(axis=0), snow.reactions["force"].sum(axis=0))
    most = [np.linalg.norm(result.particles - form.particles, axis=1).max() for result in (snow, wind)]
    numbers = {
        "form: force density of a rope, least": (edge["force"] / edge["length"]).min(),
        "form: force density of a rope, largest": (edge["force"] / edge["length"]).max(),
        "snow: its sum / (q x plan)": -snow.force("snow")["force"][:, 2].sum() / (SNOW * plan(snow)),
        "snow: reactions and loads, sum": np.abs(reactions + loads).max(),
        "snow: use of a rope, largest": snow.force("edge")["utilisation"].max(),
    }
    slant = (-60.0, 20.0)
    panels = [
        Panel(form, scene, "the form under its prestress", slant),
        Panel(snow, scene, f"1.35 prestress, 1.5 snow: it moves by {most[0]:.2f} m", slant),
        Panel(wind, scene, f"1.5 wind along x: it moves by {most[1]:.2f} m", slant),
    ]
    return Outcome(numbers, panels, columns=3)
