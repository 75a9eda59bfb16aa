"""The Basento study: a skin between feet and fingers in tension, and the same shape in compression."""

from pathlib import Path
from typing import Any

import numpy as np

from hookean import Result, Scene
from hookean.discretize import edges, mesh_surface, naked_edges
from hookean.files.rhino import threedm

CONCRETE = 5e6  # kN/m, a strut of concrete about 0.3 m by 1 m, 1.8 m long: E A / l with E = 30 GPa


def scene(
    skin: Any = None, feet: Any = None, fingers: Any = None, along: int = 32, across: int = 8,
    skin_density: float = 100.0, edge_density: float = 200.0,
) -> Scene:  # fmt: skip
    """A `skin`, a surface of rhino3dm or COMPAS, stretched between its `feet` and `fingers`, points [m]; without a skin
    all three are those of model.3dm.

    It has `along` by `across` faces. A string's force is its length times `skin_density`, along the rim
    `edge_density` more [kN/m].
    """
    if skin is None:
        skin, feet, fingers = drawn()
    mesh = mesh_surface(skin, along, across)
    nets = [
        {"kind": "springs", "name": name, "particles": pairs, "stiffness": density, "rest_factor": 0.0}
        for name, pairs, density in (("skin", edges(mesh), skin_density), ("edges", naked_edges(mesh), edge_density))
    ]
    return Scene(
        units={"force": "kN"},
        particles=mesh.vertices,
        forces=nets,
        anchors=[{"name": "feet", "points": feet}, {"name": "fingers", "points": fingers}],
        meshes={"skin": {"vertices": mesh.vertices, "faces": mesh.faces}},
        geometry=[{"name": "skin", "kind": "mesh", "mesh": "skin"}],
        settings={"tolerance": 1e-12},
    )


def drawn() -> tuple[Any, Any, Any]:
    """Skin, feet and fingers in model.3dm."""
    objects = threedm.read(Path(__file__).parent / "model.3dm").objects
    feet, fingers = (
        [(p.X, p.Y, p.Z) for p in (o.geometry.Location for o in objects if o.layer == layer)]
        for layer in ("feet", "fingers")
    )
    return next(o.geometry for o in objects if o.layer == "skin"), feet, fingers


def reverse(result: Result, concrete: float = CONCRETE, nudge: float = 0.0) -> Scene:
    """The found shape with every force turned round; the middle pressed down by `nudge` [m] to see what follows.

    For each cable a strut so much longer than its place that it pushes as hard as the cable pulled: rest length =
    length + tension / `concrete`, its stiffness [kN/m]. The feet stay. The deck, which held up the fingers, now presses
    down on them: the vertical part of what held them becomes a load, the horizontal part stays with the deck.
    """
    struts = [
        {"kind": "springs", "name": columns["name"], "particles": columns["particles"], "stiffness": concrete,
         "rest_length": columns["length"] + columns["force"] / concrete}
        for columns in result.forces
    ]  # fmt: skip
    held, names = result.reactions["particles"], np.array(result.reactions["names"])
    feet, fingers = held[names == "feet"], held[names == "fingers"]
    start = result.particles.copy()
    start[len(start) // 2, 2] -= nudge
    pressed = -result.reactions["force"][names == "fingers"] * [0, 0, 1]
    skin, *lines = result.geometry or [{"faces": np.zeros((0, 4), int)}]
    return Scene(
        units=result.units,
        particles=start,
        forces=[*struts, {"kind": "unary", "name": "deck", "particles": fingers, "vector": pressed}],
        anchors=[{"name": "feet", "particles": feet}, {"name": "fingers", "particles": fingers, "axes": "xy"}],
        meshes={"skin": {"vertices": start, "faces": skin["faces"]}},
        geometry=[
            {"name": "skin", "kind": "mesh", "mesh": "skin"},
            *({"name": line["name"], "kind": "lines", "lines": line["lines"]} for line in lines),
        ],
        settings={"tolerance": 1e-9, "max_iterations": 1000, "allow_unstable": True},
    )
