"""The chapter's figures of membranes as functions of Hops: squares of edges and diagonals, and a net in a frame."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from hookean.commands.examples import figure
from hookean.scene.scene import Scene
from hookean.values.mesh import Mesh
from hookean_server.hops import scenes
from hookean_server.hops.model import Function, Inputs, Parameter, count, item, optional

_MEMBRANE = figure("9.24-membrane").scene
_SHEET = figure("9.29-diagonals").scene
_WARP_AND_WEFT = figure("9.31-diagonal-patterns").warp_and_weft
_HYPAR = figure("9.28-rest-factor-zero").scene

_SIZE = item("Size", "L", "Number", "Side of the square [model unit]", minimum=1e-6, maximum=1e6)
_DIVISIONS = count("Divisions", "N", "Faces along each side", None, 150)
_HELD = item("Held", "H", "Text", "corners or rim", choices=("corners", "rim"))
_ANCHORS = optional(
    Parameter("Anchors", "A", "Point", "Vertices that are held instead, at [model unit]; default: as Held")
)
_SAG = item("Sag", "D", "Number", "How far the middle vertex lies below the plane z = 0 [model unit]")
_DEEPEST = item("Deepest", "Dm", "Number", "How far the lowest vertex lies below the plane z = 0 [model unit]")
_LEAST = item("Least force", "Fn", "Number", "The smallest force of a spring [N]")
_SHAPE = (scenes.MESH, scenes.SPRINGS, scenes.FORCES, scenes.REACTIONS, scenes.SUPPORTS, _SAG, _DEEPEST, scenes.LARGEST,
          _LEAST, scenes.LENGTH, scenes.STATUS)  # fmt: skip


def _shape(inputs: Inputs, scene: Scene, result: Any, *names: str) -> dict[str, Any]:
    """The outputs of a membrane, of the springs of these names."""
    names = names or ("membrane",)
    found = scenes.common(result, *names)
    z = result.particles[:, 2]
    return {
        **found,
        "Mesh": Mesh(result.particles, scene.meshes["membrane"].faces),
        "Sag": -z[len(z) // 2],
        "Deepest": -z.min(),
        "Largest force": found["Forces"].max(),
        "Least force": found["Forces"].min(),
        "Length": sum(float(result.force(name)["length"].sum()) for name in names),
    }


def _sheet(inputs: Inputs, scene: Scene, result: Any) -> dict[str, Any]:
    names = ["membrane"] if inputs.one("Diagonals") == "none" else ["membrane", "diagonals"]
    forces = [result.force(name)["force"].max() for name in names]
    return {
        **_shape(inputs, scene, result, *names),
        "Largest edge force": forces[0],
        "Largest diagonal force": [*forces, 0.0][1],
        "Energy": result.energy["springs"],
    }


def _warp_weft(inputs: Inputs, scene: Scene, result: Any) -> dict[str, Any]:
    return {
        **_shape(inputs, scene, result, "warp", "weft"),
        "Warp forces": result.force("warp")["force"],
        "Weft forces": result.force("weft")["force"],
    }


def _hypar(inputs: Inputs, scene: Scene, result: Any) -> dict[str, Any]:
    from hookean.discretize import area, edges

    found = Mesh(result.particles, scene.meshes["surface"].faces)
    side = inputs.one("Divisions") + 1
    return {
        "Mesh": found,
        "Lines": result.particles[edges(found)],
        "Area": area(found),
        "Height": result.particles.reshape(side, side, 3)[3 * side // 4, 3 * side // 4, 2],
        "Status": str(result.status),
    }


_SQUARE = (_SIZE, _DIVISIONS, scenes.STIFFNESS, scenes.REST_FACTOR, scenes.LOAD, _HELD, _ANCHORS)
_ACROSS = (
    item("Diagonals", "Di", "Text", "none, one, other or both of each face", choices=("none", "one", "other", "both")),
    item("Diagonal stiffness", "kd", "Number", "Stiffness of every diagonal [N/model unit]", minimum=0.0),
    replace(scenes.REST_FACTOR, name="Diagonal factor", nickname="Rd"),
)

FUNCTIONS: dict[str, Function] = {
    "membrane": scenes.relaxing(
        _MEMBRANE, _shape, "Membrane", "Membrane",
        "Figures 9.1, 9.24, 9.26 and 9.27: a square net held at its corners, its rim or points, under its loads",
        (
            *_SQUARE,
            item("Rise", "U", "Number", "How far two opposite corners go up; all four are held [model unit]"),
            item("Drop", "V", "Number", "How far the other two go down [model unit]"),
        ),
        _SHAPE,
        tolerance=1e-12,
    ),
    "membrane_with_diagonals": scenes.relaxing(
        _SHEET, _sheet, "Membrane with diagonals", "Diagonals",
        "Figures 9.29, 9.30 and 9.31: diagonals keep the faces of a membrane in shape, or fold them",
        (*_SQUARE, *_ACROSS),
        (
            *_SHAPE,
            item("Largest edge force", "Fe", "Number", "The largest force of an edge [N]"),
            item("Largest diagonal force", "Fd", "Number", "The largest force of a diagonal [N]"),
            item("Energy", "E", "Number", "Energy of the springs [N model unit]"),
        ),
    ),
    "membrane_of_warp_and_weft": scenes.relaxing(
        _WARP_AND_WEFT, _warp_weft, "Membrane of warp and weft", "WarpWeft",
        "Figure 9.31: the edges along x (warp) and along y (weft) differ",
        (
            _SIZE,
            _DIVISIONS,
            item("Warp stiffness", "ka", "Number", "Stiffness of edges along x [N/model unit]", minimum=0.0),
            replace(scenes.REST_FACTOR, name="Warp factor", nickname="Ra"),
            item("Weft stiffness", "ke", "Number", "Stiffness of edges along y [N/model unit]", minimum=0.0),
            replace(scenes.REST_FACTOR, name="Weft factor", nickname="Re"),
            scenes.LOAD,
            _HELD,
            _ANCHORS,
        ),
        (*_SHAPE, Parameter("Warp forces", "Fa", "Number", "Force of every edge along x [N]"),
         Parameter("Weft forces", "Fe", "Number", "Force of every edge along y [N]")),
    ),
    "hypar_net": scenes.relaxing(
        _HYPAR, _hypar, "Hypar net", "Hypar",
        "Figure 9.28: a net of rest factor 0, or a soap film, in the frame of a hypar z = x y",
        (
            _SIZE,
            _DIVISIONS,
            item("Film", "S", "Boolean", "A soap film instead of a net"),
            item("Tension", "T", "Number", "Of a film [N/model unit]; of a net the stiffness of its edges",
                 minimum=1e-9),
            scenes.REST_FACTOR,
            item("Bulge", "B", "Number", "How high the start bulges, in halves of the size [-]"),
        ),
        (
            scenes.MESH,
            Parameter("Lines", "L", "Line", "The edges"),
            item("Area", "A", "Number", "Area of the faces [model unit^2]"),
            item("Height", "H", "Number", "At three quarters of both sides [model unit]"),
            scenes.STATUS,
        ),
    ),
}  # fmt: skip
"""Functions by their names."""
