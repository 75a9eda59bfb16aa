"""Figures 9.23 to 9.25: a surface becomes a net, which hangs from its corners; its edges come back, or its faces."""

from dataclasses import replace
from pathlib import Path

from hookean import relax
from hookean.commands.examples import Outcome
from hookean.discretize import edges
from hookean.files.relax_file import read_scene
from hookean.pictures.sheet import Panel


def run(folder: Path) -> Outcome:
    scene = read_scene(folder / "model.3dm", folder / "recipe.toml")
    drawn = scene.meshes["layer:membrane"]
    result = relax(scene)
    springs = result.force("membrane")
    side = round(len(result.particles) ** 0.5)
    middle = len(result.particles) // 2
    numbers = {
        "vertices of the mesh": len(drawn.vertices),
        "edges of the mesh": len(edges((drawn.vertices, drawn.faces))),
        "sag in the middle": -result.particles[middle, 2],
        "largest force": springs["force"].max(),
        "least force": springs["force"].min(),
        "length of all springs": springs["length"].sum(),
        "upward reactions together": result.reactions["force"][:, 2].sum(),
        "difference between mirror images": mirrored(result.particles[:, 2].reshape(side, side)),
    }
    # the same result twice: without its carried mesh, and without its springs
    return Outcome(
        numbers,
        [
            Panel(replace(result, geometry=[]), scene, title="Edges out: springs, coloured by force"),
            Panel(replace(result, forces=[]), scene, title="Faces out: the mesh that rides along"),
        ],
    )


def mirrored(z) -> float:
    """How far heights differ from those with x turned round, and from those with x and y exchanged."""
    return float(max(abs(z - z[::-1]).max(), abs(z - z.T).max()))
