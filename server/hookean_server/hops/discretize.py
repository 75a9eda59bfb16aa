"""Every operation of discretizing as a function of Hops, made from the table of operations."""

from __future__ import annotations

from typing import Any

import numpy as np

from hookean.errors import InputError
from hookean.values.mesh import Mesh
from hookean_server.hops.model import MANY, Function, Inputs, Parameter, item
from hookean_server.workers.discretize_task import OPERATIONS, Operation
from hookean_server.workers.task import Cancelled

_TAKES = {
    "curve": item("Curve", "C", "Curve", "A curve of any kind"),
    "surface": item("Surface", "S", "Surface", "A surface, extrusion or Brep"),
    "mesh": item("Mesh", "M", "Mesh", "A mesh of triangles and quads"),
    "meshes": Parameter("Meshes", "M", "Mesh", "Meshes of triangles and quads"),
    "lines": Parameter("Lines", "L", "Line", "Lines, or curves made of straight pieces"),
    "points": Parameter("Points", "Pt", "Point", "Points [model unit]"),
}
_NAMED = {"fold_angle": Parameter("Fold start", "P1", "Point", "Starts of the folds [model unit]")}
"""Inputs that have a name of their own, by operation."""


def _vertices(name: str, nickname: str, said: str) -> tuple[Parameter, ...]:
    """Vertices of a mesh, and their indices."""
    return (
        Parameter(name, nickname, "Point", f"{said} [model unit]"),
        Parameter(f"{name} indices", f"{nickname}i", "Integer", "Their indices in the mesh, from 0"),
    )


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
    "pattern": (Parameter("Pattern", "P", "Boolean", "Of each face, whether it has the second colour"),),
    "first": (Parameter("First", "A", "Integer", "Indices of the faces of the first colour, from 0"),),
    "second": (Parameter("Second", "B", "Integer", "Indices of the faces of the second colour, from 0"),),
    "start": _vertices("Fold start", "P1", "Starts of the folds"),
    "end": _vertices("Fold end", "P2", "Ends of the folds"),
    "tip_1": _vertices("Tip 1", "P3", "Tips of the triangles on the left of the folds"),
    "tip_2": _vertices("Tip 2", "P4", "Tips of the triangles on the right of the folds"),
    "angles": (Parameter("Angles", "A", "Number", "Fold angles, 0 flat, from -pi to pi [rad]"),),
    "neighbours": (
        Parameter("Neighbours", "N", "Integer", "Indices of the neighbours of one vertex after the other, from 0"),
        Parameter("Counts", "C", "Integer", "How many of them each vertex has"),
    ),
    "first_points": (Parameter("First", "A", "Point", "Ends in the first group [model unit]"),),
    "second_points": (Parameter("Second", "B", "Point", "Ends in the second group [model unit]"),),
    "strips": (Parameter("Strips", "S", "Integer", "Of each face the number of its strip, from 0"),),
    "densities": (Parameter("Densities", "D", "Number", "Force densities of the inner edges, about 1 [-]"),),
    "normals": (Parameter("Normals", "Z", "Vector", "Unit normals at the vertices [-]"),),
}
_DIRECT = {"points", "lines", "length", "mesh", "polylines", "warp_naked", "weft_naked", "pattern", "first", "second",
           "angles", "normals", "first_points", "second_points", "strips", "densities"}  # fmt: skip
"""Results that are outputs as they are."""
_OPTIONS = {
    "count": ("Count", "N", "Number of pieces"),
    "u": ("U", "U", "Faces along u"),
    "v": ("V", "V", "Faces along v"),
    "angle": ("Angle", "A", "Corners have an inside angle below this [rad]"),
    "order": ("Order", "O", "index: by the numbers of the vertices; boundary: along each boundary"),
    "tolerance": ("Tolerance", "T", "Points nearer than this become one [model unit]"),
    "strict": ("Strict", "S", "True: a mesh without two families is an error; False: the family reached first"),
    "degree": ("Degree", "D", "Degree of the curve"),
    "pattern": ("Pattern", "P", "both, one or other diagonal of each quad"),
    "level": ("Level", "L", "How many times faces are cut"),
    "smooth": ("Smooth", "S", "True: each level averages vertices; False: they stay in the faces of the mesh"),
    "direction": ("Direction", "D", "along the strips, or the family warp or weft: the edges that are halved"),
    "end": ("Fold end", "P2", "Ends of the folds [model unit]"),
    "tip_1": ("Tip 1", "P3", "Tips of the triangles on the left of the folds [model unit]"),
    "tip_2": ("Tip 2", "P4", "Tips of the triangles on the right of the folds [model unit]"),
    "vertices": ("Vertices", "V", "Indices of vertices, from 0; none: all"),
    "source": ("Source", "S", "Mesh near the points"),
    "target": ("Target", "T", "The same mesh, moved"),
    "distance": ("Distance", "D", "Factor of the heights over the mesh [-]"),
    "length": ("Length", "L", "Length of the edges that is wanted [model unit]"),
    "volume_factor": ("Volume factor", "V", "Factor on the volume of a closed mesh [-]; 0: open, free"),
    "feature_angle": ("Feature angle", "A", "Folds and turns of the boundary above this are kept [rad]"),
    "iterations": ("Iterations", "N", "Rounds of splitting, collapsing, flipping and smoothing"),
    "axis": ("Axis", "X", "Direction of the transformation [-]"),
    "centre": ("Centre", "C", "Centre of the circle that does not move [model unit]"),
    "radius": ("Radius", "R", "Radius of the circle that does not move, or of the pipes [model unit]"),
    "sides": ("Sides", "N", "Sides of each pipe"),
    "turns": ("Turns", "T", "Right angles that directions turn by"),
    "gap": ("Gap", "G", "Distance between strips [model unit]"),
    "turning_angle": ("Turning angle", "A", "Corners turn by more than this [rad]"),
}
_KINDS = {"count": "Integer", "whole": "Integer", "level": "Integer", "number": "Number", "flag": "Boolean"}
_GEOMETRY = {"mesh": "Mesh", "points": "Point", "indices": "Integer"}


def _input(name: str, kind: str, default: Any) -> Parameter:
    title, nickname, said = _OPTIONS[name]
    if kind in _GEOMETRY:
        most = 1 if kind == "mesh" else MANY
        return Parameter(title, nickname, _GEOMETRY[kind], said, 0 if default is not None else 1, most)
    if kind == "vectors":
        return Parameter(title, nickname, "Vector", said, 0, 1)
    low = {"count": 1, "whole": 1, "level": 0, "number": 0.0}
    bounds: dict[str, Any] = {"minimum": low[kind]} if kind in low and name not in ("distance", "angle") else {}
    if kind not in _KINDS:
        bounds["choices"] = tuple(kind.split())
    start = 10 if kind == "count" and default is None else default
    return item(title, nickname, _KINDS.get(kind, "Text"), said, start, **bounds)


def _function(name: str, operation: Operation, summary: str) -> Function:
    inputs = (_taking(name, operation), *(_input(n, *option) for n, option in operation.options.items()))
    outputs = tuple(parameter for gives in operation.gives for parameter in _GIVES[gives])

    def run(inputs: Inputs, cancelled: Cancelled) -> dict[str, Any]:
        return _run(name, operation, inputs)

    title = name.replace("_", " ").capitalize()
    return Function(title, title.title().replace(" ", ""), summary, inputs, outputs, run, "Discretize")


def _taking(name: str, operation: Operation) -> Parameter:
    return _NAMED.get(name) or _TAKES[operation.takes]


def _run(function: str, operation: Operation, inputs: Inputs) -> dict[str, Any]:
    takes = _taking(function, operation).name
    geometry = _taken(operation, inputs, takes)
    given = {name: _option(inputs, *option, _OPTIONS[name][0]) for name, option in operation.options.items()}
    made = len(geometry.Faces) if operation.at == "breps:mesh_faces" and hasattr(geometry, "Edges") else 1
    for name, (kind, _) in operation.options.items():
        if kind == "count":
            made *= given[name]
            inputs.makes(made, f"/{_OPTIONS[name][0]}")
    try:
        if faces := operation.pieces(geometry, given):
            inputs.makes(faces, f"/{_OPTIONS[next(iter(given))][0] if given else takes}")
        found = operation.function(geometry, **given)
    except InputError as error:
        first = error.pointer.lstrip("/").partition("/")[0]
        raise InputError(f"/{_OPTIONS[first][0] if first in given else takes}", error.sentence) from None
    values = found if len(operation.gives) > 1 else (found,)
    answer: dict[str, Any] = {}
    for gives, value in zip(operation.gives, values, strict=True):
        answer |= _given(gives, value, geometry)
    return answer


def _option(inputs: Inputs, kind: str, default: Any, name: str) -> Any:
    if kind == "points":
        return inputs.points(name)
    if kind == "vectors":
        return inputs.points(name)[0] if inputs.many(name) else default
    return inputs.many(name) if kind == "indices" else inputs.one(name)


def _taken(operation: Operation, inputs: Inputs, name: str) -> Any:
    if operation.takes == "lines":
        return inputs.lines(name)
    if operation.takes == "points":
        return inputs.points(name)
    if operation.takes == "meshes":
        return inputs.many(name)
    return inputs.surface(name) if operation.at == "surfaces:mesh_surface" else inputs.one(name)


def _given(gives: str, value: Any, geometry: Any) -> dict[str, Any]:
    """The outputs of one result of an operation."""
    if gives in _DIRECT:
        return {_GIVES[gives][0].name: value}
    if gives == "neighbours":
        return {"Neighbours": [index for ring in value for index in ring.tolist()], "Counts": [*map(len, value)]}
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
    "clean": "Several meshes as one, welded, without duplicate faces and unused vertices",
    "refine": "A mesh with each quad and each triangle cut into four",
    "refine_strips": "A mesh with each quad cut in two across one direction",
    "diagonalize": "A mesh with a face for each edge of another",
    "checkerboard": "The faces of a mesh in two colours",
    "hinge_points": "The four points of the hinge at each inner edge of a mesh",
    "fold_angle": "Angles between pairs of triangles about their common edges",
    "vertex_neighbours": "The neighbours of the vertices of a mesh, in their order round the normal",
    "remesh": "A mesh as triangles of one size, its boundary and folds kept",
    "live_film": "The soap film on a mesh, made again while it relaxes",
    "mesh_map": "Points near a mesh moved as the mesh is",
    "split_at_corners": "A polyline cut where it turns",
    "interconnect_points": "A line between every two points",
    "bipartite": "The ends of lines in two groups with lines only between these",
    "moebius_transformation": "Points moved so that spheres, circles and angles stay",
    "pipes": "Pipes about lines that meet in nodes, as one closed mesh",
    "align_quads": "A mesh whose quads have the same direction",
    "turn_quads": "A mesh with the direction of each quad turned by right angles",
    "strips": "The strip of each face of a mesh",
    "unroll_strips": "The strips of a mesh unrolled into a plane",
    "reciprocal_diagram": "The reciprocal figure of a flat mesh: the forces of its edges",
    "remove_duplicate_points": "Points without duplicates",
    "remove_duplicate_lines": "Lines without duplicates, in either direction",
}

FUNCTIONS: dict[str, Function] = {
    name: _function(name, operation, _SUMMARIES[name]) for name, operation in OPERATIONS.items() if name in _SUMMARIES
}
"""Functions by the names of their operations. The catenary has its own function."""
