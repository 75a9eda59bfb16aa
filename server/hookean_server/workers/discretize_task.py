"""Discretizing: the table of operations, and the task that runs one. Runs in a worker; no geometry of its own here."""

from __future__ import annotations

import importlib
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from pydantic import TypeAdapter, ValidationError

from hookean.discretize import nurbs
from hookean.errors import InputError
from hookean.files import compas_json
from hookean.scene.text import parse
from hookean.values.columns import Faces, Indices, Lines, Points, Reals, Table, Vectors
from hookean.values.mesh import Mesh
from hookean_server.http import answers
from hookean_server.workers.task import Cancelled, Clock, Done


@dataclass(frozen=True)
class Operation:
    """One operation: where its function is, what geometry it takes, its options and what it gives.

    `at`: `module:function`, of `hookean.discretize`, or of another room by `room.module:function`. `takes`:
    `curve`, `surface`, `mesh`, `meshes`, `lines` or `points`. `options`: name -> `count`, `whole`, `level`,
    `number`, `numbers`, `vectors`, `indices`, `flag`, one of the kinds that `takes` names, or the words to choose
    from; those with None as default must be given. `gives`: names of the function's results; their places are added
    to edges and vertices of a mesh, see `PLACES`. `made`: `module:function` that counts the faces or lines of the
    result before, from the same arguments.
    """

    at: str
    takes: str
    options: dict[str, tuple[str, Any]] = field(default_factory=dict)
    gives: tuple[str, ...] = ("points",)
    made: str = ""

    @property
    def function(self) -> Callable[..., Any]:
        """The function, imported when first used."""
        return _imported(self.at)

    def pieces(self, geometry: Any, given: dict[str, Any]) -> int:
        """How many faces the result will have, where that is to be checked; else 0."""
        return int(_imported(self.made)(geometry, **given)) if self.made else 0

    @property
    def summary(self) -> str:
        """The first line of the function's description."""
        return (self.function.__doc__ or "").strip().splitlines()[0]


def _imported(at: str) -> Callable[..., Any]:
    module, name = at.split(":")
    room = "" if "." in module else "discretize."
    found: Callable[..., Any] = getattr(importlib.import_module(f"hookean.{room}{module}"), name)
    return found


_GRID = {"u": ("count", None), "v": ("count", None)}
_NEAR = {"tolerance": ("number", 1e-6)}
_LEVEL = {"level": ("level", 1)}
_REMESH = {"length": ("number", None), "feature_angle": ("number", np.pi / 6), "iterations": ("whole", 15)}
_HANGING = {"length": ("numbers", None), "count": ("count", 50), "gravity": ("vectors", (0.0, 0.0, -1.0))}
_SMOOTH = {"count": ("count", None), "degree": ("whole", 3)}
_FAMILY = {"direction": ("warp weft", "warp")}
_TURN = {"angle": ("number", None), "axis": ("vectors", (0.0, 0.0, 1.0)), "centre": ("vectors", (0.0, 0.0, 0.0)),
         "radius": ("number", 1.0)}  # fmt: skip
PLACES = {"edges": "lines", "indices": "points", "naked": "naked_points", "clothed": "clothed_points",
          "warp": "warp_lines", "weft": "weft_lines", "start": "start_points", "end": "end_points",
          "tip_1": "tip_1_points", "tip_2": "tip_2_points"}  # fmt: skip
"""Results that are numbers of vertices, and the names of their coordinates."""

OPERATIONS: dict[str, Operation] = {
    "divide": Operation("curves:divide", "curve", {"count": ("count", None)}),
    "shatter": Operation("curves:shatter", "curve", {"count": ("count", None)}, ("lines",)),
    "explode": Operation("curves:explode", "curve", gives=("lines",)),
    "end_points": Operation("curves:end_points", "curve"),
    "length": Operation("curves:length", "curve", gives=("length",)),
    "arc": Operation("arcs:arc_through", "points", {"count": ("count", None)}),
    "interpolate": Operation("arcs:interpolate", "points", _SMOOTH),
    "catenary": Operation("catenary:catenaries", "lines", _HANGING, ("polylines",)),
    "mesh_surface": Operation("meshing:mesh_surface", "surface", _GRID, ("mesh",)),
    "mesh_faces": Operation("breps:mesh_faces", "surface", _GRID, ("mesh",)),
    "vertices": Operation("meshes:vertices", "mesh"),
    "edges": Operation("meshes:edges", "mesh", gives=("edges",)),
    "naked_edges": Operation("meshes:naked_edges", "mesh", gives=("edges",)),
    "naked_vertices": Operation("meshes:naked_vertices", "mesh", gives=("indices",)),
    "clothed_vertices": Operation("meshes:clothed_vertices", "mesh", gives=("indices",)),
    "boundary": Operation("meshes:boundary", "mesh", gives=("naked", "clothed")),
    "corners": Operation(
        "meshes:corners",
        "mesh",
        {"angle": ("number", 0.75 * np.pi), "order": ("index boundary", "index")},
        ("indices",),
    ),
    "warp_weft": Operation("warpweft:warp_weft", "mesh", {"strict": ("flag", True)}, ("warp", "weft")),
    "threads": Operation(
        "warpweft:threads", "mesh", {"strict": ("flag", True)}, ("warp", "weft", "warp_naked", "weft_naked")
    ),
    "diagonals": Operation("meshes:diagonals", "mesh", {"pattern": ("both one other", "both")}, ("edges",)),
    "triangles": Operation("meshes:triangles", "mesh", gives=("triangles",)),
    "weld": Operation("meshes:weld", "mesh", _NEAR, ("mesh",)),
    "clean": Operation("cleaning:clean", "meshes", {"tolerance": ("number", 0.01)}, ("mesh",)),
    "refine": Operation(
        *("subdivision:refine", "mesh", {**_LEVEL, "smooth": ("flag", False)}, ("mesh",)), "subdivision:refined_faces"
    ),
    "refine_strips": Operation(
        *("subdivision:refine_strips", "mesh", {**_LEVEL, "direction": ("along warp weft", "along")}, ("mesh",)),
        "subdivision:strip_faces",
    ),
    "diagonalize": Operation("subdivision:diagonalize", "mesh", gives=("mesh",)),
    "checkerboard": Operation(
        "adjacency:checkerboard", "mesh", {"strict": ("flag", True)}, ("pattern", "first", "second")
    ),
    "hinge_points": Operation("adjacency:hinge_points", "mesh", gives=("start", "end", "tip_1", "tip_2")),
    "fold_angle": Operation(
        "adjacency:fold_angle", "points", dict.fromkeys(("end", "tip_1", "tip_2"), ("points", None)), ("angles",)
    ),
    "vertex_neighbours": Operation(
        "adjacency:vertex_neighbours", "mesh", {"vertices": ("indices", ())}, ("neighbours", "normals")
    ),
    "remesh": Operation("remeshing:remesh", "mesh", _REMESH, ("mesh",), "remeshing:expected_faces"),
    "live_film": Operation(
        *("running.live:live_film", "mesh", {"length": ("number", None), "volume_factor": ("number", 0.0)}, ("mesh",)),
        "running.live:expected_faces",
    ),
    "mesh_map": Operation(
        "mapping:mesh_map", "points", {"source": ("mesh", None), "target": ("mesh", None), "distance": ("number", 1.0)}
    ),
    "split_at_corners": Operation(
        "polylines:split_at_corners", "curve", {"turning_angle": ("number", 1.0)}, ("points", "polylines")
    ),
    "interconnect_points": Operation("graphs:interconnect_points", "points", {}, ("lines",), "graphs:expected_lines"),
    "bipartite": Operation("graphs:bipartite", "lines", _NEAR, ("first_points", "second_points")),
    "moebius_transformation": Operation("moebius:moebius_transformation", "points", _TURN),
    "pipes": Operation(
        *("pipe_meshes:pipes", "lines", {"radius": ("number", None), "sides": ("whole", 6), **_NEAR}, ("mesh",)),
        "pipe_meshes:expected_faces",
    ),
    "align_quads": Operation("ladders:align_quads", "mesh", {"strict": ("flag", True)}, ("mesh",)),
    "turn_quads": Operation("ladders:turn_quads", "mesh", {"turns": ("whole", 1)}, ("mesh",)),
    "strips": Operation("ladders:strips", "mesh", _FAMILY, ("strips",)),
    "unroll_strips": Operation("ladders:unroll_strips", "mesh", {**_FAMILY, "gap": ("number", 0.0)}, ("mesh",)),
    "reciprocal_diagram": Operation("reciprocal:reciprocal_diagram", "mesh", gives=("lines", "densities")),
    "remove_duplicate_points": Operation("duplicates:remove_duplicate_points", "points", _NEAR),
    "remove_duplicate_lines": Operation("duplicates:remove_duplicate_lines", "lines", _NEAR, ("lines",)),
}
"""Every operation by the last part of its address; routes, description and tests walk this table."""


def discretize(options: dict[str, Any], body: bytes, cancelled: Cancelled) -> Done:
    """Run the operation `options["operation"]` on the geometry and options in `body`.

    Raises InputError with a pointer into the body.
    """
    operation = OPERATIONS[options["operation"]]
    clock = Clock()
    value = parse(body)
    if not isinstance(value, dict):
        raise InputError("/", "a JSON object is expected")
    given = _options(operation, value, options["largest"])
    if operation.takes not in value:
        raise InputError(f"/{operation.takes}", "this is required")
    geometry = _READERS[operation.takes](value[operation.takes], f"/{operation.takes}")
    if operation.takes == "lines" and "count" in operation.options:
        _check_many(len(geometry) * given.get("count", operation.options["count"][1]), "/count", options["largest"])
    clock.lap("decode")
    try:
        _check_many(
            operation.pieces(geometry, given), f"/{next(iter(operation.options), operation.takes)}", options["largest"]
        )
        found = operation.function(geometry, **given)
    except InputError as error:
        raise InputError(_placed(error.pointer, operation.takes), error.sentence) from None
    clock.lap("compute")
    arrays = options.get("arrays") or ("buffer" if answers.has_buffers(value) else "list")
    documents = options.get("meshes") or ("compas" if compas_json.is_document(value[operation.takes]) else "plain")
    text = answers.dump(_outputs(operation, found, geometry, documents), arrays)
    clock.lap("encode")
    return Done(text, timing=clock.parts)


def uses_rhino(body: bytes) -> bool:
    """Whether a body may hold encoded Rhino geometry, which only a worker that is then replaced may read."""
    return b"opennurbs" in body or b"\\u00" in body


def _placed(pointer: str, takes: str) -> str:
    """The place of a fault of a function's argument in the body."""
    first, _, rest = pointer.lstrip("/").partition("/")
    known = first in (takes, *_NAMES)
    return f"/{first}{'/' + rest if rest else ''}" if known else f"/{takes}"


def _options(operation: Operation, value: dict[str, Any], largest: int) -> dict[str, Any]:
    unknown = set(value) - {operation.takes, *operation.options}
    if unknown:
        name = sorted(unknown)[0]
        known = ", ".join((operation.takes, *operation.options))
        raise InputError(f"/{name}", f"unknown field; known: {known}")
    found = {}
    product = 1
    for name, (kind, default) in operation.options.items():
        if name not in value:
            if default is None:
                raise InputError(f"/{name}", "this is required")
            continue
        found[name] = _option(value[name], kind, f"/{name}", largest)
        if kind == "count":
            product *= found[name]
            _check_many(product, f"/{name}", largest)
    return found


def _check_many(pieces: int, pointer: str, largest: int) -> None:
    if pieces > largest:
        raise InputError(pointer, f"this makes {pieces} pieces; at most {largest} are allowed")


def _option(value: Any, kind: str, pointer: str, largest: int) -> Any:
    if kind in _READERS:
        return _READERS[kind](value, pointer)
    if kind in ("count", "whole", "level"):
        low, high = {"count": (1, largest), "whole": (1, 1000), "level": (0, 30)}[kind]
        if type(value) is not int or not low <= value <= high:
            raise InputError(pointer, f"a whole number from {low} to {high} is expected")
    elif kind == "indices":
        return _checked(_INDICES, value, pointer)
    elif kind in ("numbers", "vectors"):
        return _checked(_REALS if kind == "numbers" else _VECTORS, value, pointer)
    elif kind == "number":
        if type(value) not in (int, float) or not abs(value) < 1e12:
            raise InputError(pointer, "a finite number is expected")
    elif kind == "flag":
        if type(value) is not bool:
            raise InputError(pointer, "true or false is expected")
    elif not isinstance(value, str) or value not in kind.split():
        raise InputError(pointer, f"one of {', '.join(kind.split())} is expected")
    return value


def _curve(value: Any, pointer: str) -> Any:
    if compas_json.is_document(value):
        document = compas_json.read(value, pointer)
        if document.kind not in ("line", "polyline", "polygon"):
            raise InputError(f"{pointer}/dtype", f"a {document.kind} is not a curve; give a Line, Polyline or Polygon")
        closing = document.points[:1] if document.kind == "polygon" else document.points[:0]
        return np.concatenate([document.points, closing])
    if isinstance(value, dict) and "knots" in value:
        return _nurbs(value, pointer, nurbs.nurbs_curve, ("degree", "points", "knots"))
    return decode(value, pointer) if _encoded(value) else _points(value, pointer)


def _surface(value: Any, pointer: str) -> Any:
    if isinstance(value, dict) and "knots_u" in value:
        return _nurbs(value, pointer, nurbs.nurbs_surface, ("degree_u", "degree_v", "points", "knots_u", "knots_v"))
    if not _encoded(value):
        raise InputError(pointer, "give a NURBS surface, or a Rhino surface or Brep as rhino3dm's Encode writes it")
    return decode(value, pointer)


def _nurbs(value: dict[str, Any], pointer: str, make: Any, needed: tuple[str, ...]) -> Any:
    if not set(needed) <= set(value) <= {*needed, "weights"}:
        raise InputError(pointer, f"a NURBS form has {', '.join(needed)}, and optionally weights, only")
    tables = [name for name in (*needed, "weights") if not name.startswith("degree") and value.get(name) is not None]
    read = {name: _checked(_TABLE, value[name], f"{pointer}/{name}") for name in tables}
    try:
        return make(**{**value, **read})
    except InputError as error:
        raise InputError(f"{pointer}/{error.pointer}", error.sentence) from None


def _mesh(value: Any, pointer: str) -> Any:
    if compas_json.is_document(value):
        value = compas_json.plain_mesh(value, pointer)[1]
    elif _encoded(value):
        return decode(value, pointer)
    if not isinstance(value, dict) or set(value) != {"vertices", "faces"}:
        raise InputError(pointer, "give vertices and faces, a COMPAS Mesh document or an encoded Rhino mesh")
    vertices = _checked(_POINTS, value["vertices"], f"{pointer}/vertices")
    faces = _checked(_FACES, value["faces"], f"{pointer}/faces")
    beyond = np.argwhere(faces >= len(vertices))
    if len(beyond):
        row, column = beyond[0]
        said = f"vertex {faces[row, column]} does not exist; the mesh has {len(vertices)}, counted from 0"
        raise InputError(f"{pointer}/faces/{row}/{column}", said)
    return Mesh(vertices, faces)


def _meshes(value: Any, pointer: str) -> Any:
    if not isinstance(value, list):
        raise InputError(pointer, "a list of meshes is expected")
    return [_mesh(one, f"{pointer}/{i}") for i, one in enumerate(value)]


def _points(value: Any, pointer: str) -> Any:
    return _checked(_POINTS, _documents(value, pointer, "points"), pointer)


def _lines(value: Any, pointer: str) -> Any:
    return _checked(_LINES, _documents(value, pointer, "lines"), pointer)


def _documents(value: Any, pointer: str, name: str) -> Any:
    """COMPAS documents, or a list of them, as arrays; anything else as it is."""
    if compas_json.is_document(value):
        return getattr(compas_json.read(value, pointer), name)
    if isinstance(value, list) and value and compas_json.is_document(value[0]):
        return np.concatenate([getattr(compas_json.read(v, f"{pointer}/{i}"), name) for i, v in enumerate(value)])
    return value


def _checked(adapter: TypeAdapter[Any], value: Any, pointer: str) -> Any:
    try:
        return adapter.validate_python(value)
    except ValidationError as error:
        context = error.errors(include_input=False, include_url=False)[0].get("ctx", {})
        raise InputError(pointer + str(context.get("at", "")), str(context.get("sentence", "faulty"))) from None


def _encoded(value: Any) -> bool:
    return isinstance(value, dict) and {"archive3dm", "opennurbs", "data"} <= set(value)


def decode(value: Any, pointer: str) -> Any:
    """Rhino geometry from what rhino3dm's `Encode` writes."""
    import rhino3dm

    plain = {k: value[k] for k in ("version", "archive3dm", "opennurbs", "data") if k in value}
    good = all(type(plain.get(k)) is int and abs(plain[k]) < 2**32 for k in ("version", "archive3dm", "opennurbs"))
    if not good or not isinstance(plain["data"], str):
        raise InputError(
            pointer, "this is not the output of rhino3dm's Encode: version, archive3dm, opennurbs and data"
        )
    try:
        found = rhino3dm.CommonObject.Decode(plain)  # type: ignore[attr-defined,unused-ignore]
    except Exception:
        found = None
    if found is None:
        raise InputError(f"{pointer}/data", "rhino3dm cannot decode this; encode the geometry again")
    return found


def _outputs(operation: Operation, found: Any, geometry: Any, documents: str) -> dict[str, Any]:
    values = found if isinstance(found, tuple) and len(operation.gives) > 1 else (found,)
    out: dict[str, Any] = {}
    for name, value in zip(operation.gives, values, strict=True):
        if name == "mesh" and documents == "compas":
            out[name] = compas_json.mesh(value.vertices, value.faces)
        elif name == "mesh":
            out[name] = {"vertices": value.vertices, "faces": value.faces}
        else:
            out[name] = value
    placed = [name for name in operation.gives if name in PLACES]
    if placed:
        from hookean.discretize.meshes import as_mesh

        vertices = as_mesh(geometry).vertices
        out.update({PLACES[name]: vertices[np.asarray(out[name], dtype=np.int64)] for name in placed})
    return out


_POINTS: TypeAdapter[Any] = TypeAdapter(Points, config={"arbitrary_types_allowed": True})
_LINES: TypeAdapter[Any] = TypeAdapter(Lines, config={"arbitrary_types_allowed": True})
_REALS: TypeAdapter[Any] = TypeAdapter(Reals, config={"arbitrary_types_allowed": True})
_INDICES: TypeAdapter[Any] = TypeAdapter(Indices, config={"arbitrary_types_allowed": True})
_TABLE: TypeAdapter[Any] = TypeAdapter(Table, config={"arbitrary_types_allowed": True})
_VECTORS: TypeAdapter[Any] = TypeAdapter(Vectors, config={"arbitrary_types_allowed": True})
_FACES: TypeAdapter[Any] = TypeAdapter(Faces, config={"arbitrary_types_allowed": True})
_NAMES = {name for operation in OPERATIONS.values() for name in operation.options}
_READERS: dict[str, Callable[[Any, str], Any]] = {
    "curve": _curve,
    "surface": _surface,
    "mesh": _mesh,
    "meshes": _meshes,
    "points": _points,
    "lines": _lines,
}
