"""The chapter's figures of membranes as functions of Hops: squares of edges and diagonals, and a net in a frame."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from hookean.values.mesh import Mesh
from hookean_server.hops import scenes
from hookean_server.hops.model import Function, Inputs, Parameter, count, item, optional
from hookean_server.workers.task import Cancelled

_SIZE = item("Size", "L", "Number", "Side of the square [model unit]", 10.0, minimum=1e-6, maximum=1e6)
_DIVISIONS = count("Divisions", "N", "Faces along each side", 20, 150)
_HELD = item("Held", "H", "Text", "corners or rim", "corners", choices=("corners", "rim"))
_ANCHORS = optional(
    Parameter("Anchors", "A", "Point", "Vertices that are held instead, at [model unit]; default: as Held")
)
_SAG = item("Sag", "D", "Number", "How far the middle vertex lies below the plane z = 0 [model unit]")
_DEEPEST = item("Deepest", "Dm", "Number", "How far the lowest vertex lies below the plane z = 0 [model unit]")
_LARGEST = item("Largest force", "Fm", "Number", "The largest force of a spring [N]")
_LEAST = item("Least force", "Fn", "Number", "The smallest force of a spring [N]")
_LENGTH = item("Length", "Lt", "Number", "Length of all springs [model unit]")
_SHAPE = (scenes.MESH, scenes.SPRINGS, scenes.FORCES, scenes.REACTIONS, scenes.SUPPORTS, _SAG, _DEEPEST, _LARGEST,
          _LEAST, _LENGTH, scenes.STATUS)  # fmt: skip


def _square(inputs: Inputs) -> Mesh:
    steps = np.linspace(0.0, inputs.one("Size"), inputs.one("Divisions") + 1)
    return scenes.grid(steps, steps)


def _held(inputs: Inputs, mesh: Mesh) -> list[dict[str, Any]]:
    """The corners of a square, its rim, or the given points."""
    from hookean.discretize.meshes import corners, naked_vertices

    given = inputs.points("Anchors")
    if len(given):
        return [{"points": given}]
    return [{"particles": naked_vertices(mesh) if inputs.one("Held") == "rim" else corners(mesh)}]


def _springs(name: str, pairs: Any, stiffness: float, factor: float) -> dict[str, Any]:
    return {"kind": "springs", "name": name, "particles": pairs, "stiffness": stiffness, "rest_factor": factor}


def _shape(result: Any, mesh: Mesh, *names: str) -> dict[str, Any]:
    """The outputs of a membrane."""
    found = scenes.common(result, *names)
    z = result.particles[:, 2]
    return {
        **found,
        "Mesh": Mesh(result.particles, mesh.faces),
        "Sag": -z[len(z) // 2],
        "Deepest": -z.min(),
        "Largest force": found["Forces"].max(),
        "Least force": found["Forces"].min(),
        "Length": sum(float(result.force(name)["length"].sum()) for name in names),
    }


def _membrane(inputs: Inputs, cancelled: Cancelled) -> dict[str, Any]:
    from hookean.discretize.meshes import edges

    mesh = _square(inputs)
    held = _held(inputs, mesh)
    rise, drop = inputs.one("Rise"), inputs.one("Drop")
    start = mesh.vertices.copy()
    if rise or drop:
        last, side = len(start) - 1, inputs.one("Divisions")
        targets = start[[0, last, last - side, side]] + [[0, 0, rise], [0, 0, rise], [0, 0, -drop], [0, 0, -drop]]
        held = [{"particles": [0, last, last - side, side], "targets": targets}]
    springs = _springs("edges", edges(mesh), inputs.one("Stiffness"), inputs.one("Rest factor"))
    scene = {
        "particles": start,
        "forces": [springs, scenes.particles_of(start, inputs.one("Load"))],
        "anchors": held,
        "settings": {"tolerance": 1e-12},
    }
    return _shape(scenes.relaxed(inputs, scene, cancelled), mesh, "edges")


def _sheet(inputs: Inputs, cancelled: Cancelled) -> dict[str, Any]:
    from hookean.discretize.meshes import diagonals, edges

    mesh, pattern = _square(inputs), inputs.one("Diagonals")
    forces = [_springs("edges", edges(mesh), inputs.one("Stiffness"), inputs.one("Rest factor"))]
    names = ["edges"]
    if pattern != "none":
        across = diagonals(mesh, pattern)
        forces.append(_springs("diagonals", across, inputs.one("Diagonal stiffness"), inputs.one("Diagonal factor")))
        names.append("diagonals")
    scene = {
        "particles": mesh.vertices,
        "forces": [*forces, scenes.particles_of(mesh.vertices, inputs.one("Load"))],
        "anchors": _held(inputs, mesh),
    }
    result = scenes.relaxed(inputs, scene, cancelled)
    across_force = result.force("diagonals")["force"] if pattern != "none" else np.zeros(1)
    return {
        **_shape(result, mesh, *names),
        "Largest edge force": result.force("edges")["force"].max(),
        "Largest diagonal force": across_force.max(),
        "Energy": result.energy["springs"],
    }


def _warp_weft(inputs: Inputs, cancelled: Cancelled) -> dict[str, Any]:
    from hookean.discretize.warpweft import warp_weft

    mesh = _square(inputs)
    forces = [
        _springs(name.lower(), pairs, inputs.one(f"{name} stiffness"), inputs.one(f"{name} factor"))
        for name, pairs in zip(("Warp", "Weft"), warp_weft(mesh), strict=True)
    ]
    scene = {
        "particles": mesh.vertices,
        "forces": [*forces, scenes.particles_of(mesh.vertices, inputs.one("Load"))],
        "anchors": _held(inputs, mesh),
    }
    result = scenes.relaxed(inputs, scene, cancelled)
    return {
        **_shape(result, mesh, "warp", "weft"),
        "Warp forces": result.force("warp")["force"],
        "Weft forces": result.force("weft")["force"],
    }


def _hypar(inputs: Inputs, cancelled: Cancelled) -> dict[str, Any]:
    from hookean.discretize.meshes import edges, naked_vertices

    half, bulge = 0.5 * inputs.one("Size"), inputs.one("Bulge")
    steps = np.linspace(-half, half, inputs.one("Divisions") + 1)
    t = steps / half
    hollow = (1.0 - t[:, None] ** 2) * (1.0 - t[None, :] ** 2)
    mesh = scenes.grid(steps, steps, half * (t[:, None] * t[None, :] + bulge * hollow))
    film = inputs.one("Film")
    scene: dict[str, Any] = {"particles": mesh.vertices, "anchors": [{"particles": naked_vertices(mesh)}]}
    if film:
        scene["meshes"] = {"film": {"vertices": mesh.vertices, "faces": mesh.faces}}
        scene["forces"] = [{"kind": "soapfilm", "name": "film", "mesh": "film", "tension": inputs.one("Tension")}]
        scene["settings"] = {"tolerance": 1e-8}
    else:
        scene["forces"] = [_springs("edges", edges(mesh), inputs.one("Tension"), inputs.one("Rest factor"))]
        scene["settings"] = {"tolerance": 1e-12}
    result = scenes.relaxed(inputs, scene, cancelled)
    found = Mesh(result.particles, mesh.faces)
    side = len(steps)
    return {
        "Mesh": found,
        "Lines": result.particles[edges(found)],
        "Area": scenes.area(found),
        "Height": result.particles.reshape(side, side, 3)[3 * side // 4, 3 * side // 4, 2],
        "Status": str(result.status),
    }


_SQUARE = (_SIZE, _DIVISIONS, scenes.stiffness(2000.0), scenes.rest_factor(1.0), scenes.load(20.0), _HELD, _ANCHORS)
_ACROSS = (
    item("Diagonals", "Di", "Text", "none, one, other or both of each face", "both",
         choices=("none", "one", "other", "both")),
    item("Diagonal stiffness", "kd", "Number", "Stiffness of every diagonal [N/model unit]", 1000.0, minimum=0.0),
    scenes.rest_factor(1.0, "Diagonal factor", "Rd"),
)  # fmt: skip

FUNCTIONS: dict[str, Function] = {
    "membrane": Function(
        "Membrane",
        "Membrane",
        "Figures 9.1, 9.24, 9.26 and 9.27: a square net held at its corners, its rim or points, under its loads",
        (
            *_SQUARE,
            item("Rise", "U", "Number", "How far two opposite corners go up; all four are held [model unit]", 0.0),
            item("Drop", "V", "Number", "How far the other two go down [model unit]", 0.0),
        ),
        _SHAPE,
        _membrane,
        "Figures",
    ),
    "membrane_with_diagonals": Function(
        "Membrane with diagonals",
        "Diagonals",
        "Figures 9.29, 9.30 and 9.31: diagonals keep the faces of a membrane in shape, or fold them",
        (_SIZE, replace(_DIVISIONS, default=10), *_SQUARE[2:], *_ACROSS),
        (
            *_SHAPE,
            item("Largest edge force", "Fe", "Number", "The largest force of an edge [N]"),
            item("Largest diagonal force", "Fd", "Number", "The largest force of a diagonal [N]"),
            item("Energy", "E", "Number", "Energy of the springs [N model unit]"),
        ),
        _sheet,
        "Figures",
    ),
    "membrane_of_warp_and_weft": Function(
        "Membrane of warp and weft",
        "WarpWeft",
        "Figure 9.31: the edges along x (warp) and along y (weft) differ",
        (
            _SIZE,
            replace(_DIVISIONS, default=10),
            item("Warp stiffness", "ka", "Number", "Stiffness of edges along x [N/model unit]", 4000.0, minimum=0.0),
            scenes.rest_factor(0.9, "Warp factor", "Ra"),
            item("Weft stiffness", "ke", "Number", "Stiffness of edges along y [N/model unit]", 1000.0, minimum=0.0),
            scenes.rest_factor(1.1, "Weft factor", "Re"),
            scenes.load(20.0),
            _HELD,
            _ANCHORS,
        ),
        (*_SHAPE, Parameter("Warp forces", "Fa", "Number", "Force of every edge along x [N]"),
         Parameter("Weft forces", "Fe", "Number", "Force of every edge along y [N]")),
        _warp_weft,
        "Figures",
    ),
    "hypar_net": Function(
        "Hypar net",
        "Hypar",
        "Figure 9.28: a net of rest factor 0, or a soap film, in the frame of a hypar z = x y",
        (
            replace(_SIZE, default=2.0),
            replace(_DIVISIONS, default=32),
            item("Film", "S", "Boolean", "A soap film instead of a net", False),
            item("Tension", "T", "Number", "Of a film [N/model unit]; of a net the stiffness of its edges", 100.0,
                 minimum=1e-9),
            scenes.rest_factor(0.0),
            item("Bulge", "B", "Number", "How high the start bulges, in halves of the size [-]", 0.5),
        ),
        (
            scenes.MESH,
            Parameter("Lines", "L", "Line", "The edges"),
            item("Area", "A", "Number", "Area of the faces [model unit^2]"),
            item("Height", "H", "Number", "At three quarters of both sides [model unit]"),
            scenes.STATUS,
        ),
        _hypar,
        "Figures",
    ),
}  # fmt: skip
"""Functions by their names."""
