"""Figure 9.27: a membrane held at its naked vertices, and the same one held at its corners and inside."""

from pathlib import Path

from hookean import relax
from hookean.commands.examples import Outcome
from hookean.files.relax_file import read_scene
from hookean.pictures.sheet import Panel


def run(folder: Path) -> Outcome:
    numbers, panels = {}, []
    for held, recipe in (("rim", "recipe.toml"), ("points", "recipe-points.toml")):
        scene = read_scene(folder / "model.3dm", folder / recipe)
        result = relax(scene)
        anchors = result.reactions["particles"]
        upward = result.reactions["force"][:, 2]
        middle = len(result.particles) // 2  # of 21 x 21 particles
        inside = ((result.particles[anchors, :2] - 5.0) ** 2).sum(axis=1) < 10.0
        numbers |= {
            f"{held}: particles held": len(anchors),
            f"{held}: sag in the middle": -result.particles[middle, 2],
            f"{held}: deepest sag": -result.particles[:, 2].min(),
            f"{held}: largest force": result.force("membrane")["force"].max(),
            f"{held}: upward reactions together": upward.sum(),
        }
        if inside.any():
            numbers["points: part of the load on the four inside"] = upward[inside].sum() / upward.sum()
        said = "Naked vertices held" if held == "rim" else "Corners and inside held"
        panels.append(Panel(result, scene, title=f"{said}: {-result.particles[:, 2].min():.2f} m deep"))
    return Outcome(numbers, panels)
