"""Every operation of discretizing as a function of Hops, made from the table of operations."""

from __future__ import annotations

from typing import Any

import numpy as np

from hookean.errors import InputError
from hookean.values.mesh import Mesh
from hookean_server.hops.model import Function, Inputs, Parameter, item
from hookean_server.workers.discretize_task import OPERATIONS, Operation
from hookean_server.workers.task import Cancelled

_TAKES = {
    "curve": item("Curve", "C", "Curve", "A curve of any kind"),
    "surface": item("Surface", "S", "Surface", "A surface, extrusion or Brep"),
    "mesh": item("Mesh", "M", "Mesh", "A mesh of triangles and quads"),
    "lines": Parameter("Lines", "L", "Line", "Lines, or curves made of straight pieces"),
    "points": Parameter("Points", "Pt", "Point", "Points [model unit]"),
}
_GIVES: dict[str, tuple[Parameter, ...]] = {
    "points": (Parameter("Points", "Pt", "Point", "The points [model unit]"),),
    "lines": (Parameter("Lines", "L", "Line", "The lines"),),
    "length": (item("Length", "L", "Number", "The length [model unit]"),),
    "mesh": (item("Mesh", "M", "Mesh", "The mesh"),),
    "triangles": (item("Mesh", "M", "Mesh", "The same vertices with triangles alone"),),
    "edges": (
        Parameter("Lines", "L", "Line", "The lines"),
        Parameter("Starts", "A", "Integer", "Index of the vertex at the start of each, from 0"),
        Parameter("Ends", "B", "Integer", "Index of the vertex at the end of each, from 0"),
    ),
    "indices": (
        Parameter("Points", "Pt", "Point", "The vertices [model unit]"),
        Parameter("Indices", "i", "Integer", "Their indices in the mesh, from 0"),
    ),
    "polylines": (Parameter("Curves", "C", "Curve", "The curves as polylines"),),
    "naked": (
        Parameter("Naked", "N", "Point", "Vertices on the boundary [model unit]"),
        Parameter("Naked indices", "Ni", "Integer", "Their indices in the mesh, from 0"),
    ),
    "clothed": (
        Parameter("Clothed", "C", "Point", "Vertices inside [model unit]"),
        Parameter("Clothed indices", "Ci", "Integer", "Their indices in the mesh, from 0"),
    ),
    "warp": (Parameter("Warp", "Wa", "Line", "Edges of one family"),),
    "weft": (Parameter("Weft", "We", "Line", "Edges of the other family"),),
    "warp_naked": (Parameter("Naked warp", "WaN", "Boolean", "Of each edge of warp, whether it is on the boundary"),),
    "weft_naked": (Parameter("Naked weft", "WeN", "Boolean", "Of each edge of weft, whether it is on the boundary"),),
}
_OPTIONS = {
    "count": ("Count", "N", "Number of pieces"),
    "u": ("U", "U", "Faces along u"),
    "v": ("V", "V", "Faces along v"),
    "angle": ("Angle", "A", "Corners have an inside angle below this [rad]"),
    "tolerance": ("Tolerance", "T", "Points nearer than this become one [model unit]"),
    "strict": ("Strict", "S", "True: a mesh without two families is an error; False: the family reached first"),
    "degree": ("Degree", "D", "Degree of the curve"),
    "pattern": ("Pattern", "P", "both, one or other diagonal of each quad"),
}
_KINDS = {"count": "Integer", "whole": "Integer", "number": "Number", "flag": "Boolean"}


def _input(name: str, kind: str, default: Any) -> Parameter:
    title, nickname, said = _OPTIONS[name]
    bounds: dict[str, Any] = (
        {"minimum": 1} if _KINDS.get(kind) == "Integer" else {"minimum": 0.0} if kind == "number" else {}
    )
    if kind not in _KINDS:
        bounds["choices"] = tuple(kind.split())
    start = 10 if kind == "count" and default is None else default
    return item(title, nickname, _KINDS.get(kind, "Text"), said, start, **bounds)


def _function(name: str, operation: Operation, summary: str) -> Function:
    inputs = (_TAKES[operation.takes], *(_input(n, *option) for n, option in operation.options.items()))
    outputs = tuple(parameter for gives in operation.gives for parameter in _GIVES[gives])

    def run(inputs: Inputs, cancelled: Cancelled) -> dict[str, Any]:
        return _run(operation, inputs)

    title = name.replace("_", " ").capitalize()
    return Function(title, title.title().replace(" ", ""), summary, inputs, outputs, run, "Discretize")


def _run(operation: Operation, inputs: Inputs) -> dict[str, Any]:
    takes = _TAKES[operation.takes].name
    geometry = _taken(operation, inputs, takes)
    given = {name: inputs.one(_OPTIONS[name][0]) for name in operation.options}
    made = len(geometry.Faces) if operation.at == "breps:mesh_faces" and hasattr(geometry, "Edges") else 1
    for name, (kind, _) in operation.options.items():
        if kind == "count":
            made *= given[name]
            inputs.makes(made, f"/{_OPTIONS[name][0]}")
    try:
        found = operation.function(geometry, **given)
    except InputError as error:
        first = error.pointer.lstrip("/").partition("/")[0]
        raise InputError(f"/{_OPTIONS[first][0] if first in given else takes}", error.sentence) from None
    values = found if len(operation.gives) > 1 else (found,)
    answer: dict[str, Any] = {}
    for gives, value in zip(operation.gives, values, strict=True):
        answer |= _given(gives, value, geometry)
    return answer


def _taken(operation: Operation, inputs: Inputs, name: str) -> Any:
    if operation.takes == "lines":
        return inputs.lines(name)
    if operation.takes == "points":
        return inputs.points(name)
    return inputs.surface(name) if operation.at == "surfaces:mesh_surface" else inputs.one(name)


def _given(gives: str, value: Any, geometry: Any) -> dict[str, Any]:
    """The outputs of one result of an operation."""
    if gives in ("points", "lines", "length", "mesh", "polylines", "warp_naked", "weft_naked"):
        return {_GIVES[gives][0].name: value}
    from hookean.discretize.meshes import as_mesh

    mesh = as_mesh(geometry)
    if gives == "triangles":
        return {"Mesh": Mesh(mesh.vertices, value)}
    rows = mesh.vertices[np.asarray(value, dtype=np.int64)]
    if len(_GIVES[gives]) == 2:
        return dict(zip((p.name for p in _GIVES[gives]), (rows, value), strict=True))
    if gives == "edges":
        return {"Lines": rows, "Starts": value[:, 0], "Ends": value[:, 1]}
    return {_GIVES[gives][0].name: rows}


_SUMMARIES = {
    "divide": "Points that cut a curve into pieces of equal length",
    "shatter": "Lines between the points that cut a curve into pieces of equal length",
    "explode": "The straight segments of a polyline",
    "end_points": "First and last point of a curve",
    "length": "Length of a curve",
    "arc": "Points at equal lengths on the arc through three points",
    "interpolate": "Points on a smooth curve through points, for display",
    "mesh_surface": "A surface as a mesh of u by v quads",
    "mesh_faces": "A Brep or extrusion as one mesh, u by v quads for each face",
    "vertices": "Vertices of a mesh",
    "edges": "All edges of a mesh, each once",
    "naked_edges": "Boundary edges of a mesh: those of one face only",
    "naked_vertices": "Vertices on the boundary of a mesh",
    "clothed_vertices": "Vertices inside a mesh",
    "boundary": "Vertices of a mesh, those on its boundary and those inside",
    "corners": "Vertices of the boundary of a mesh where it turns",
    "warp_weft": "The edges of a mesh of quads in two families",
    "threads": "The edges of a mesh of quads in two families, and which of them are on the boundary",
    "diagonals": "Diagonals of the quads of a mesh",
    "triangles": "A mesh with every quad cut along its shorter diagonal",
    "weld": "A mesh with near vertices merged",
    "remove_duplicate_points": "Points without duplicates",
    "remove_duplicate_lines": "Lines without duplicates, in either direction",
}

FUNCTIONS: dict[str, Function] = {
    name: _function(name, operation, _SUMMARIES[name]) for name, operation in OPERATIONS.items() if name in _SUMMARIES
}
"""Functions by the names of their operations. The catenary has its own function."""
