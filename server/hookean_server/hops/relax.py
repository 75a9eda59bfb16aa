"""Relaxing what is drawn: lines or a mesh that become springs, and the catenary between two points."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from hookean.errors import InputError
from hookean.scene.scene import Scene
from hookean.values.mesh import Mesh
from hookean_server.hops import scenes
from hookean_server.hops.model import Function, Inputs, Parameter, count, item, optional
from hookean_server.workers.task import Cancelled


def _relax_lines(inputs: Inputs, cancelled: Cancelled) -> dict[str, Any]:
    from hookean.discretize.duplicates import unique_points

    lines = inputs.lines("Lines")
    kept, place = unique_points(lines.reshape(-1, 3), inputs.tolerance)
    springs = {"particles": place.reshape(-1, 2), "name": "lines"}
    result = _relaxed(inputs, lines.reshape(-1, 3)[kept], springs, inputs.points("Anchors"), cancelled)
    return scenes.common(result, "lines")


def _relax_mesh(inputs: Inputs, cancelled: Cancelled) -> dict[str, Any]:
    from hookean.discretize.meshes import edges, naked_vertices

    mesh = inputs.one("Mesh")
    anchors = inputs.points("Anchors")
    if not len(anchors):
        anchors = mesh.vertices[naked_vertices(mesh)]
    result = _relaxed(inputs, mesh.vertices, {"particles": edges(mesh), "name": "edges"}, anchors, cancelled)
    found = scenes.common(result, "edges")
    return {**found, "Mesh": Mesh(result.particles, mesh.faces), "Edges": found["Springs"]}


def _relaxed(inputs: Inputs, particles: Any, springs: Any, anchors: Any, cancelled: Cancelled) -> Any:
    stiffness, factor = inputs.one("Stiffness"), inputs.one("Rest factor")
    forces: list[dict[str, Any]] = [
        {"kind": "springs", "stiffness": stiffness, "rest_factor": factor, **springs},
        {"kind": "unary", "particles": np.arange(len(particles)), "vector": inputs.one("Load")},
    ]
    held = [{"points": anchors}] if len(anchors) else []
    scene = Scene.model_validate({"particles": particles, "forces": forces, "anchors": held})
    return scenes.relaxed(inputs, scene, cancelled, tolerance=1e-6)


def _catenary(inputs: Inputs, cancelled: Cancelled) -> dict[str, Any]:
    from hookean.discretize.catenary import catenary, parameter, tensions

    a, b = (np.array(inputs.one(name)) for name in "AB")
    gravity = np.array((inputs.many("Gravity") or [[0.0, 0.0, -1.0]])[0])
    length, pieces, weight = inputs.one("Length"), inputs.one("Pieces"), inputs.one("Weight")
    points = catenary(a, b, length, count=pieces, gravity=gravity)
    pull = tensions(a, b, length, count=pieces, gravity=gravity, weight=weight)
    chord = b - a
    rise = float(chord @ gravity / np.linalg.norm(gravity))
    shape = parameter(np.sqrt(max(chord @ chord - rise**2, 0.0)), length, rise)
    if not np.isfinite(shape):
        raise InputError(
            "/Length", f"{length:g} given, the distance of A and B: the cable is straight; give a longer one"
        )
    return {
        "Curve": points,
        "Points": points,
        "Parameter": shape,
        "Depth": pull[0] / weight - shape,
        "Tensions": pull,
        "Largest tension": pull.max(),
    }


_FORCED = (
    item("Load", "P", "Vector", "Force on every particle [N]"),
    replace(scenes.STIFFNESS, default=1000.0),
    replace(scenes.REST_FACTOR, default=1.0, maximum=None),
)
_FOUND = (scenes.FORCES, scenes.REACTIONS, scenes.SUPPORTS, scenes.STATUS)

FUNCTIONS: dict[str, Function] = {
    "relax": Function(
        "Relax",
        "Relax",
        "Lines become springs and go to equilibrium",
        (
            Parameter("Lines", "L", "Line", "Springs; ends that meet are one particle"),
            Parameter("Anchors", "A", "Point", "Where particles are held; each must be the end of a line"),
            *_FORCED,
        ),
        (scenes.PARTICLES, scenes.SPRINGS, *_FOUND),
        _relax_lines,
    ),
    "relax_mesh": Function(
        "Relax mesh",
        "RelaxMesh",
        "The edges of a mesh become springs and go to equilibrium",
        (
            item("Mesh", "M", "Mesh", "The mesh"),
            optional(Parameter("Anchors", "A", "Point", "Held vertices; default: those on the boundary")),
            *_FORCED,
        ),
        (scenes.MESH, Parameter("Edges", "L", "Line", "Springs in equilibrium"), *_FOUND),
        _relax_mesh,
    ),
    "catenary": Function(
        "Catenary",
        "Catenary",
        "The cable of a length that hangs from A to B: y = a cosh(x / a)",
        (
            item("A", "A", "Point", "Start of the cable [model unit]"),
            item("B", "B", "Point", "End of the cable [model unit]"),
            item("Length", "L", "Number", "Length of the cable [model unit], more than the distance of A and B", 12.0,
                 minimum=0.0, maximum=1e9),
            optional(Parameter("Gravity", "G", "Vector", "Direction in which it hangs [-]; default: down", most=1)),
            count("Pieces", "N", "Pieces of equal length", 60, 10_000),
            item("Weight", "W", "Number", "Weight [N/model unit]", 1.0, minimum=1e-9),
        ),
        (
            item("Curve", "C", "Curve", "The cable as a polyline"),
            Parameter("Points", "Pt", "Point", "Points at equal lengths along the cable [model unit]"),
            item("Parameter", "a", "Number", "a of the curve [model unit]; its horizontal pull is weight times a"),
            item("Depth", "D", "Number", "How far the lowest point of the curve lies below A [model unit]"),
            Parameter("Tensions", "T", "Number", "Tension at each point [N]"),
            item("Largest tension", "Tm", "Number", "The largest tension [N]"),
        ),
        _catenary,
        "Catenaries",
    ),
}  # fmt: skip
"""Functions by their names."""
