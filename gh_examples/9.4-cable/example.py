"""Figures 9.4 and 9.5: a cable of five springs under its loads."""

from pathlib import Path

from hookean import relax
from hookean.example import Outcome
from hookean.files.relax_file import read_scene
from hookean.sheet import Panel


def run(folder: Path) -> Outcome:
    scene = read_scene(folder / "scene.json")
    result = relax(scene)
    cable = result.force("cable")
    numbers = {
        "length": cable["length"].sum(),
        "length of the first spring": cable["length"][0],
        "length of the middle spring": cable["length"][2],
        "force in the first spring": cable["force"][0],
        "sag": -result.particles[:, 2].min(),
    }
    return Outcome(numbers, [Panel(result, scene)])
