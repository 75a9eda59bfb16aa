"""The vault's essay: a net hangs from nine columns and a chain from its ends; turned over, a vault and an arch."""

import numpy as np

from hookean import Result, Scene
from hookean.discretize import arc_of_length, edges, grid


def scene(
    length: float = 20.0, width: float = 14.0, along: int = 20, across: int = 14, length_factor: float = 1.1,
    stiffness: float = 1e4, weight: float = 0.5,
) -> Scene:  # fmt: skip
    """A flat net of `length` by `width` [m] in `along` by `across` faces, held at its corners, in its middle and in the
    middles of its sides.

    Its strings have a `stiffness` [kN/m] and are `length_factor` [-] as long as drawn; their `weight` is in kN/m.
    """
    mesh = grid(np.linspace(0.0, length, along + 1), np.linspace(0.0, width, across + 1))
    number = np.arange(len(mesh.vertices)).reshape(along + 1, across + 1)
    columns = number[np.ix_([0, along // 2, along], [0, across // 2, across])]
    strings = {"kind": "springs", "name": "net", "particles": edges(mesh), "stiffness": stiffness,
               "rest_factor": length_factor}  # fmt: skip
    return Scene(
        units={"force": "kN"},
        particles=mesh.vertices,
        forces=[strings, {"kind": "self_weight", "name": "weight", "particles": edges(mesh), "per_length": weight}],
        anchors=[{"name": "columns", "particles": np.unique(columns)}],
        meshes={"net": {"vertices": mesh.vertices, "faces": mesh.faces}},
        geometry=[{"name": "net", "kind": "mesh", "mesh": "net"}],
        settings={"tolerance": 1e-9},
    )


def chain(
    arc_length: float = 19.2, span: float = 16.0, links: int = 32, weight: float = 3.0, stiffness: float = 1e7
) -> Scene:
    """A chain of `arc_length` [m] between ends a `span` [m] apart, drawn as an arc, in `links` of equal length and of a
    `stiffness` [kN/m], which hardly stretches; its `weight` is in kN/m."""
    link = arc_length / links
    strings = {"kind": "springs", "name": "chain", "particles": np.arange(links)[:, None] + [0, 1],
               "stiffness": stiffness, "rest_length": link}  # fmt: skip
    weights = {"kind": "unary", "name": "weight", "particles": np.arange(1, links), "vector": [0, 0, -weight * link]}
    return Scene(
        units={"force": "kN"},
        particles=arc_of_length(arc_length, span, links) * [1.0, 1.0, -1.0],
        forces=[strings, weights],
        anchors=[{"name": "ends", "particles": [0, links]}],
        settings={"tolerance": 1e-9},
    )


def upside_down(result: Result, stiffness: float) -> Scene:
    """The hanging shape mirrored in the plane of its supports, under the same weight. Each strut is so much longer
    than its place that it pushes as hard as the string pulled: rest length = length + tension / `stiffness` [kN/m]."""
    strings, weight = result.forces
    struts = {"kind": "springs", "name": "struts", "particles": strings["particles"], "stiffness": stiffness,
              "rest_length": strings["length"] + strings["force"] / stiffness}  # fmt: skip
    loads = {"kind": "unary", "name": "weight", "particles": weight["particles"][:, 0], "vector": weight["force"]}
    standing = result.particles * [1, 1, -1]
    meshes = {g["name"]: {"vertices": standing, "faces": g["faces"]} for g in result.geometry}
    return Scene(
        units=result.units,
        particles=standing,
        forces=[struts, loads],
        anchors=[{"name": "supports", "particles": result.reactions["particles"]}],
        meshes=meshes,
        geometry=[{"name": name, "kind": "mesh", "mesh": name} for name in meshes],
        settings={"allow_unstable": True},  # a thrust line of hinged struts balances, as on a knife's edge
    )
